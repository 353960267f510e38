"""How does a script with nothing but a few places to read or write answer --help?"""

import argparse


def arguments(doc: str | None, **known: tuple[object, str]) -> argparse.Namespace:
    """The command line of a script: `known` is name=(default, what it is), in order; without a default (...) it must be given.

    A value has the type of its default, without one it is a text.
    """
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, (default, what) in known.items():
        if default is ...:
            parser.add_argument(name, help=what)
        else:
            parser.add_argument(name, nargs="?", default=default, type=type(default), help=f"{what} (default {default})")
    return parser.parse_args()
