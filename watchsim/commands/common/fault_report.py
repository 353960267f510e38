"""Whose fault is an error, and what is needed to mend it?"""

from __future__ import annotations

import dis
import os
import platform
import shlex
import sys
import tempfile
import time
import traceback
from pathlib import Path
from types import TracebackType

PACKAGE = Path(__file__).resolve().parents[2]


def is_refusal(error: Exception) -> bool:
    """True for a ValueError that this package raised itself: it says in words what cannot be used.

    One out of a library, or out of a function such as math.sqrt, comes from what this package should have checked.
    """
    return isinstance(error, ValueError) and _is_raised_here(error.__traceback__)


def _is_raised_here(trace: TracebackType | None) -> bool:
    """True if the last thing that was done is a `raise` in this package."""
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    if trace is None:
        return False
    code = trace.tb_frame.f_code
    raised = code.co_code[trace.tb_lasti] == dis.opmap["RAISE_VARARGS"]
    return raised and PACKAGE in Path(code.co_filename).resolve().parents


def report(error: Exception, argv: list[str]) -> str:
    """Write a file to send, and say where it is."""
    words = f"{type(error).__name__}: {error}".strip().splitlines()[0][:300]
    told = f"This is a fault of watchsim, not of its input ({words})."
    text = report_text(error, argv)
    for folder in (Path.cwd, lambda: Path(tempfile.gettempdir())):
        try:
            path = folder() / f"watchsim-fault-{time.strftime('%Y%m%d-%H%M%S')}-{os.urandom(2).hex()}.txt"
            path.write_text(text, encoding="utf-8", errors="replace")
        except OSError:
            continue
        return f"{told}\nPlease send {path} to its authors; it holds the command, the versions and where it happened."
    return f"{told}\n{text}"


def report_text(error: Exception, argv: list[str]) -> str:
    """The command, the versions, and where it happened."""
    from watchsim.results.provenance import versions

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
