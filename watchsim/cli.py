"""What can be typed? Parse, call, print.

Exit status: 0 fine; 1 ran, but an expectation was missed or the watch does not work; 2 bad input, or nowhere to write; 3 the
solver gave up; 4 a fault of the program itself; 130, 143 stopped by Ctrl-C, SIGTERM.
"""

from __future__ import annotations

import argparse
import importlib
import sys

from watchsim import __version__, stopping
from watchsim.commands.common.command_parser import CommandParser, meant
from watchsim.commands.common.console import BAD_INPUT, FAULT, INTERRUPTED, InputError, say

COMMANDS = (
    "demo",
    "new",
    "inspect",
    "check",
    "run",
    "plot",
    "movie",
    "report",
    "sound",
    "steady",
    "sweep",
    "verify",
    "bench",
    "export",
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
        sub.set_defaults(run=module.run)
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
    top, first = parser(), next((word for word in argv if not word.startswith("-")), "")
    if first and first not in COMMANDS:
        hint = meant(first, COMMANDS) or f" Commands: {', '.join(COMMANDS)}."
        top.error(f'there is no command "{first}".{hint}')
    return top.parse_args(argv)


def _failed(error: Exception, argv: list[str]) -> int:
    """Say what is wrong, and whose fault it is."""
    from watchsim.commands.common.fault_report import is_refusal, report

    if isinstance(error, BrokenPipeError):  # the reader of our output has gone: leave without a word
        return BAD_INPUT
    if isinstance(error, (InputError, OSError)) or is_refusal(error):
        say(str(error))
        return BAD_INPUT
    say(report(error, argv))
    return FAULT
