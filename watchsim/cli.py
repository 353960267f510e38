"""What can be typed? Parse, call, print.

Exit status: 0 fine; 1 ran, but an expectation was missed or the watch stopped; 2 bad input; 3 the solver gave up.
"""

from __future__ import annotations

import argparse
import gc
import importlib
import sys

from watchsim import __version__
from watchsim.commands.console import BAD_INPUT, INTERRUPTED, InputError, say

COMMANDS = ("demo", "inspect", "check", "run", "plot", "movie", "verify", "bench", "export")
GARBAGE = 500_000  # objects that may pile up, some 50 MB


def parser() -> argparse.ArgumentParser:
    """The whole command line; importing nothing heavy."""
    top = argparse.ArgumentParser(
        prog="watchsim",
        description="From a designer's drawing to the true motion of a watch mechanism.",
        epilog="watchsim COMMAND --help tells more.",
    )
    top.add_argument("--version", action="version", version=f"watchsim {__version__}")
    commands = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name in COMMANDS:
        module = importlib.import_module(f"watchsim.commands.{name}")
        sub = commands.add_parser(name, help=module.HELP, description=module.__doc__)
        module.options(sub)
        sub.set_defaults(run=module.run)
    return top


def process() -> int:
    """`main` as a process of its own.

    Nearly all objects of a short run are imported modules, which stay to the end: looking for garbage among them every few
    hundred objects, and once more at the end, would take a sixth of its time.
    """
    gc.set_threshold(GARBAGE)
    status = main()
    gc.freeze()
    return status


def main(argv: list[str] | None = None) -> int:
    """Run one command; returns its exit status."""
    for stream in (sys.stdout, sys.stderr):
        # µ, ° and · must reach a file or pipe whatever the locale says.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="replace")
    args = parser().parse_args(argv)
    try:
        return int(args.run(args))
    except (InputError, ValueError, OSError) as error:
        if isinstance(error, BrokenPipeError):
            return _closed_pipe()
        say(str(error))
        return BAD_INPUT
    except KeyboardInterrupt:
        say("Interrupted.")
        return INTERRUPTED


def _closed_pipe() -> int:
    """The reader of our output has gone (`watchsim ... | head`): leave without a word."""
    import os

    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return BAD_INPUT


if __name__ == "__main__":
    sys.exit(main())
