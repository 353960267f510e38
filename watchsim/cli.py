"""What can be typed, and what is said of an option that a command does not have? Parse, call, print."""

from __future__ import annotations

import argparse
import difflib
import importlib
import re
import sys
from collections.abc import Iterable, Sequence
from typing import Any

from watchsim import __version__, stopping
from watchsim.commands.console import BAD_INPUT, FAULT, INTERRUPTED, InputError, say


class CommandParser(argparse.ArgumentParser):
    """The parser of one command. What it does not know is refused with its own usage, not with that of `watchsim`."""

    def parse_known_args(self, args: Sequence[str] | None = None, namespace: Any = None) -> tuple[Any, list[str]]:  # type: ignore[override]
        """Unknown options come first: that something is missing may only follow from them."""
        words = _joined(args or ())
        takes_all = any(action.nargs == argparse.REMAINDER for action in self._actions)
        for word in () if takes_all else words:
            self._check(word)
        found, unknown = super().parse_known_args(words, namespace)
        for word in unknown:
            self._check(word)
        several = next((action for action in self._actions if not action.option_strings and action.nargs in ("*", "+")), None)
        if several is not None:  # argparse takes those before the first option only
            setattr(found, several.dest, [*(getattr(found, several.dest) or ()), *unknown])
        elif unknown:
            changes = "=" in unknown[0] and "--set" in self._option_string_actions
            cure = (
                f'Each change has its own --set: --set "{unknown[0]}"'
                if changes
                else "Put quotes around a value that contains spaces"
            )
            self.error(f'unexpected argument "{unknown[0]}". {cure}.')
        return found, []

    def _check(self, word: str) -> None:
        """Ends the program where the word is an option, but none of this command; options may be shortened."""
        name = word.partition("=")[0]
        begun = name if name.startswith("--") else name[:2]
        if word[:1] != "-" or " " in word or not begun.strip("-")[:1].isalpha():
            return
        if not any(option.startswith(begun) for option in self._option_string_actions):
            self.error(f"there is no option {name}.{meant(name, self._option_string_actions)}")


def _joined(words: Sequence[str]) -> list[str]:
    """The words, a negative quantity such as "-5 µm" or "-30°" as the value of the option before it."""
    found: list[str] = []
    for word in words:
        if re.match(r"[-−][.\d]", word) and found and found[-1].startswith("--") and "=" not in found[-1]:
            found[-1] += f"={word}"
        else:
            found.append(word)
    return found


def meant(word: str, known: Iterable[str]) -> str:
    """' Did you mean --force?' where one is near."""
    plain = {one.lstrip("-"): one for one in known}
    near = difflib.get_close_matches(word.lstrip("-").lower(), plain, n=1)
    return f" Did you mean {plain[near[0]]}?" if near else ""


# Exit status: 0 fine; 1 ran, but an expectation was missed or the watch does not work; 2 bad input, or nowhere to write; 3 the
# solver gave up; 4 a fault of the program itself; 130, 143 stopped by Ctrl-C, SIGTERM.

COMMANDS = (
    "demo",
    "new",
    "inspect",
    "check",
    "run",
    "plot",
    "movie",
    "report",
    "card",
    "live",
    "sound",
    "listen",
    "steady",
    "compare",
    "sweep",
    "positions",
    "shock",
    "tolerance",
    "merge",
    "improve",
    "fit",
    "verify",
    "bench",
    "export",
    "schema",
)


def parser() -> argparse.ArgumentParser:
    """The whole command line; importing nothing heavy."""
    top = argparse.ArgumentParser(
        prog="watchsim",
        description="From a designer's drawing to the true motion of a watch mechanism.",
        epilog="watchsim COMMAND --help shows its options.",
    )
    top.add_argument("--version", action="version", version=f"watchsim {__version__}")
    commands = top.add_subparsers(dest="command", metavar="COMMAND", required=True, parser_class=CommandParser)
    for name in COMMANDS:
        module = importlib.import_module(f"watchsim.commands.{name}")
        sub = commands.add_parser(name, help=module.HELP, description=module.__doc__)
        module.options(sub)
        sub.set_defaults(run=module.run, top=top)  # the whole, of which one makes completions
    return top


def main(argv: list[str] | None = None) -> int:
    """Run one command; returns its exit status."""
    for stream in (sys.stdout, sys.stderr):
        # µ, ° and · must reach a file or pipe whatever the locale says.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="replace")
    argv = sys.argv[1:] if argv is None else argv
    args = _parsed(argv)
    try:
        status = int(args.run(args))
    except KeyboardInterrupt:
        say("Interrupted.")
        status = INTERRUPTED
    except MemoryError:
        say("There is not enough memory for this. A shorter run, a coarser picture, or --record statistics needs less.")
        status = BAD_INPUT
    except Exception as error:
        status = _failed(error, argv)
    return stopping.status() if stopping.requested() else status


def _parsed(argv: list[str]) -> argparse.Namespace:
    """What was typed; ends the program where it cannot be parsed."""
    if argv[:1] == ["--completion"]:  # as a command of its own would be typed
        argv = ["schema", *argv]
    top, first = parser(), next((word for word in argv if not word.startswith("-")), "")
    if first and first not in COMMANDS:
        hint = meant(first, COMMANDS) or f" Commands: {', '.join(COMMANDS)}."
        top.error(f'there is no command "{first}".{hint}')
    return top.parse_args(argv)


def _failed(error: Exception, argv: list[str]) -> int:
    """Say what is wrong, and whose fault it is."""
    from watchsim.commands.console import is_refusal, report

    if isinstance(error, BrokenPipeError):  # the reader of our output has gone: leave without a word
        return BAD_INPUT
    if isinstance(error, (InputError, OSError)) or is_refusal(error):
        say(str(error))
        return BAD_INPUT
    say(report(error, argv))
    return FAULT
