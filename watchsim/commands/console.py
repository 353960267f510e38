"""How does the tool talk to a terminal, what did somebody type, and whose fault is an error?"""

from __future__ import annotations

import argparse
import contextlib
import dis
import errno
import io
import json
import math
import os
import platform
import re
import shlex
import sys
import tempfile
import textwrap
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from watchsim.units import Dimension


# What if nobody reads the output any more?
#
# `watchsim run ... | head` closes the pipe after ten lines; a terminal may be closed. That is no reason to stop, or to say
# anything: what is printed from then on goes nowhere. Nor is a full disk a reason to give up a run whose results have a place
# of their own; but then output is missing, and the command says so in the end.

GONE = (errno.EPIPE, errno.EIO, errno.EBADF, errno.ESHUTDOWN)


class _Patient(io.FileIO):
    """A stream whose reader may go, and whose disk may be full."""

    lost = ""  # why something of it could not be written, where somebody may be waiting for it

    def write(self, content: Any) -> int:
        """All of it, somewhere or nowhere."""
        try:
            return super().write(content)
        except OSError as error:
            if error.errno not in GONE:
                self.lost = error.strerror or str(error)
            with contextlib.suppress(OSError):
                nowhere = os.open(os.devnull, os.O_WRONLY)
                os.dup2(nowhere, self.fileno())
                os.close(nowhere)
            return len(memoryview(content))


# Names in drawings and scenes are others': a character that turns a line round or moves the cursor (all controls, marks of
# direction and invisible ones but the joiners of words and emoji) is printed by its number, as JSON and TOML write it, too.
# A carriage return is our own at either end of what is written.
UNSEEN = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\xad\u061c\u180e\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb]"
    "|(?<!^)\r(?!\n?$)"
)


class _Escaped(io.TextIOWrapper):
    """Text whose characters all are seen, and whose sentences are broken between words where a terminal is narrower."""

    def write(self, text: str) -> int:
        shown = UNSEEN.sub(lambda one: f"\\u{ord(one[0]):04x}", text)
        wide = columns(self)
        if wide < LEAST_COLUMNS or "\r" in text or text[:1] in ("{", "["):  # no terminal, progress, JSON
            return super().write(shown)
        return super().write("\n".join(folded(line, wide) for line in shown.split("\n")))


LEAST_COLUMNS = 40  # of a terminal in which lines are broken
LABEL = re.compile(r"\s*(?:\S+(?: \S+)* {2,})?")  # what stands left of a sentence: blanks, or a label and blanks


def columns(stream: TextIO) -> int:
    """How many characters a line of the terminal behind a stream takes; 0 where there is none."""
    try:
        return os.get_terminal_size(stream.fileno()).columns
    except (OSError, ValueError, AttributeError):
        return 0


def folded(line: str, wide: int) -> str:
    """A line broken between words at that many characters, its rest under its beginning; the rows of tables are left whole."""
    if len(line) <= wide:
        return line
    head = LABEL.match(line)
    label = head[0] if head and len(head[0]) <= wide // 2 else ""
    if "  " in line[len(label) :]:
        return line
    under = " " * len(label)
    return textwrap.fill(line[len(label) :], wide, initial_indent=label, subsequent_indent=under, **WHOLE_WORDS)


WHOLE_WORDS: dict[str, Any] = {"break_long_words": False, "break_on_hyphens": False}  # paths and keys can be copied


def lost_output() -> str:
    """Why not all that was printed could be written; empty where it was."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    raw = getattr(getattr(sys.stdout, "buffer", None), "raw", None)
    return str(getattr(raw, "lost", ""))


def open_streams() -> None:
    """Make stdout and stderr such streams."""
    for name, number in (("stdout", 1), ("stderr", 2)):
        old = getattr(sys, name)
        try:
            raw = _Patient(number, "w", closefd=False)
        except OSError:  # closed from the start
            raw = _Patient(os.devnull, "w")
        lines = old is not None and (raw.isatty() or name == "stderr")
        stream = _Escaped(io.BufferedWriter(raw), encoding="utf-8", errors="replace", line_buffering=lines)
        setattr(sys, name, stream)


# How does the tool talk to a terminal?
#
# Results go to stdout. Everything else goes to stderr, and progress is quiet where stderr is no terminal.

SEEN = 1.0  # s, of progress that is seen before the time left is estimated
NARROWEST, WIDEST = 0.06, 0.42  # m, of pictures for print
FINE, MISSED, BAD_INPUT, GAVE_UP, FAULT, INTERRUPTED = 0, 1, 2, 3, 4, 130


class InputError(ValueError):
    """Something the user gave that cannot be used; the text says what, why, and what to do."""


@contextlib.contextmanager
def all_at_once(wrong: list[str]) -> Iterator[Callable[..., Any]]:
    """A function that calls others and keeps what they complain of; with what is `wrong` already, all is raised at the end."""
    from watchsim.scene.errors import SceneError

    def also(call: Callable[..., Any], *arguments: Any) -> Any:
        try:
            return call(*arguments)
        except (InputError, SceneError) as error:
            wrong.append(str(error))
            return None

    yield also
    if wrong:
        raise InputError("\n".join(wrong))


def say(words: str) -> None:
    """A line for people, on stderr; where nobody reads it any more, nothing stops for that."""
    with contextlib.suppress(OSError, ValueError):
        print(words, file=sys.stderr, flush=True)


def print_json(value: Any) -> None:
    """One JSON value on stdout."""
    print(json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False), flush=True)


class Progress:
    """One line on a terminal that shows how far something has come and how long it will still take."""

    def __init__(self, words: str) -> None:
        self._words = words
        self._start = time.monotonic()
        self._shown = 0.0
        self._first: tuple[float, float] | None = None
        self._quiet = not sys.stderr.isatty()
        self._wide = min((columns(sys.stderr) or 80) - 1, 79)
        self._crowd = ""

    def crowded(self, words: str) -> None:
        """Say on a line of its own why it crawls, once each time that it begins to."""
        if words and not self._crowd and not self._quiet:
            self._show(f"\r{words:<{self._wide}}\n")
        self._crowd = words

    def __call__(self, done: float, whole: float) -> None:
        now = time.monotonic()
        if self._quiet or now - self._shown < 0.1:
            return
        self._shown = now
        elapsed = now - self._start
        first, begun = self._first = self._first or (done, now)
        known = whole < math.inf  # else nobody knows how many there will be
        words = f"\r{self._words}  {done:.4g}{f' of {whole:.4g}' if known else ''}   {_clock(elapsed)} elapsed"
        if known and now - begun > SEEN and done > first:  # what came before, such as compiling, does not come again
            words += f", {_clock((now - begun) * (whole - done) / (done - first))} left"
        self._show(f"{words[: self._wide + 1]:<{self._wide + 1}}")

    def close(self) -> None:
        if not self._quiet and self._shown:
            self._show("\r" + " " * self._wide + "\r")

    def _show(self, words: str) -> None:
        try:
            print(words, end="", file=sys.stderr, flush=True)
        except OSError:  # the terminal was closed
            self._quiet = True


def _clock(seconds: float) -> str:
    if seconds < 60.0:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02d}:{rest:02d}" if minutes >= 60 else f"{minutes}:{rest:02d} min"


def announce_compile(kernel: str = "event_loop.advance", what: str = "the solver", wait: str = "half a minute") -> None:
    """Say so when the solver has to be compiled first: it is the longest wait a newcomer meets."""
    from watchsim.jit import is_cached

    if not is_cached(kernel):
        say(f"Compiling {what} for this machine: once after installation, about {wait} ...")


def parse_window(text: str | None, option: str = "--window") -> tuple[float, float] | None:
    """The two times of a text such as "179.4 s:179.75 s", in seconds; `option` is what it was given with."""
    if text is None:
        return None
    from watchsim.units import TIME, UnitError, parse

    parts = text.split(":")
    if len(parts) != 2:
        raise InputError(f'{option} "{text}": write two times with a colon between them, such as "179.4 s:179.75 s".')
    try:
        start, end = (parse(part.strip(), TIME) for part in parts)
    except UnitError as error:
        raise InputError(f'{option} "{text}": {error}') from error
    if not end > start:
        raise InputError(f'{option} "{text}": the second time must be later than the first.')
    return start, end


def check_picture(target: str, source: str) -> None:
    """InputError unless --png names a file that a picture may be written to, which is not the input's."""
    path = Path(target)
    if path.is_dir():
        raise InputError(f"--png {target}: is a folder; a picture needs the name of a file in it, such as picture.png.")
    if path.suffix.lower() != ".png":
        raise InputError(f"--png {target}: the picture is a PNG, so its name must end in .png.")
    if path.resolve() == Path(source).resolve():
        raise InputError(f"--png {target}: is the input itself, which would be lost. Choose another name.")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"--png {target}: the folder {path.parent} cannot be made: {error.strerror}.") from error


def parse_width(text: str) -> float:
    """The width of a picture for print (--width), m."""
    from watchsim.units import LENGTH

    width = parse_positive("--width", text, LENGTH)
    if not NARROWEST <= width <= WIDEST:
        raise InputError(f'--width "{text}": a picture for print is {1e3 * NARROWEST:g} mm to {1e3 * WIDEST:g} mm wide.')
    return width


def check_tolerance(tolerance: float | None) -> None:
    """InputError where --tol is given and lies outside what a run may be asked for."""
    from watchsim.tolerances import COARSEST_TOLERANCE, FINEST_TOLERANCE

    if tolerance is not None and not FINEST_TOLERANCE <= tolerance <= COARSEST_TOLERANCE:
        raise InputError(f"--tol {tolerance:g}: must lie between {FINEST_TOLERANCE:g} and {COARSEST_TOLERANCE:g}.")


def parse_names(text: str | None) -> list[str] | None:
    """The names in a text such as "wheel,lever"."""
    return [name.strip() for name in text.split(",") if name.strip()] if text else None


def add_study_options(parser: argparse.ArgumentParser) -> None:
    """The options of every study that writes a results folder."""
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change a value of the scene")
    parser.add_argument(
        "--tol", "--tolerance", metavar="X", type=float, help="relative error per step (default: the scene's, 1e-9)"
    )
    parser.add_argument("--workers", metavar="N", type=int, help="processes (default: as many as there are processors)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of dask.distributed, such as tcp://127.0.0.1:8786")
    parser.add_argument("--resume", action="store_true", help="continue with what the results folder holds")
    parser.add_argument("--force", action="store_true", help="replace the study in a results folder that exists")
    parser.add_argument("--no-plots", action="store_true", help="write no plots")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def parse_quantity(option: str, text: str, dimension: Dimension) -> float:
    """The value of a command-line option such as `--section "0.15 mm"` in SI units."""
    from watchsim.units import UnitError, parse

    try:
        return parse(text, dimension)
    except UnitError as error:
        raise InputError(f'{option} "{text}": {error}') from error


def parse_positive(option: str, text: str, dimension: Dimension) -> float:
    """The same, above zero."""
    value = parse_quantity(option, text, dimension)
    if not value > 0.0:
        raise InputError(f'{option} "{text}": must be positive.')
    return value


# Whose fault is an error, and what is needed to mend it?

PACKAGE = Path(__file__).resolve().parents[1]


def is_refusal(error: Exception) -> bool:
    """True for a ValueError that this package raised itself: it says in words what cannot be used.

    One out of a library, or out of a function such as math.sqrt, comes from what this package should have checked.
    """
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    if trace is None or not isinstance(error, ValueError):
        return False
    code = trace.tb_frame.f_code
    raised = code.co_code[trace.tb_lasti] == dis.opmap["RAISE_VARARGS"]
    return raised and PACKAGE in Path(code.co_filename).resolve().parents


def report(error: Exception, argv: list[str]) -> str:
    """Write a file to send, and say where it is."""
    words = f"{type(error).__name__}: {error}".strip().splitlines()[0][:300]
    fault = f"This is a fault of watchsim, not of its input ({words})."
    text = report_text(error, argv)
    for folder in (Path.cwd, lambda: Path(tempfile.gettempdir())):
        try:
            path = folder() / f"watchsim-fault-{time.strftime('%Y%m%d-%H%M%S')}-{os.urandom(2).hex()}.txt"
            path.write_text(text, encoding="utf-8", errors="replace")
        except OSError:
            continue
        return f"{fault}\nPlease send {path} to its authors; it holds the command, the versions and where it happened."
    return f"{fault}\n{text}"


def report_text(error: Exception, argv: list[str]) -> str:
    """The command, the versions, and where it happened."""
    from watchsim.results.folder import versions

    return "\n".join(
        (
            f"command    watchsim {shlex.join(argv)}",
            f"system     {platform.platform()}, {platform.machine()}",
            f"python     {sys.version}",
            *(f"{name:<10} {version}" for name, version in versions().items() if name != "python"),
            "",
            "".join(traceback.format_exception(error)),
        )
    )
