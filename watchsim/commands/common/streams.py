"""What if nobody reads the output any more?

`watchsim run ... | head` closes the pipe after ten lines; a terminal may be closed. That is no reason to stop, or to say
anything: what is printed from then on goes nowhere. Nor is a full disk a reason to give up a run whose results have a place of
their own; but then output is missing, and the command says so in the end.
"""

from __future__ import annotations

import contextlib
import errno
import io
import os
import sys
from typing import Any

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
        stream = io.TextIOWrapper(io.BufferedWriter(raw), encoding="utf-8", errors="replace", line_buffering=lines)
        setattr(sys, name, stream)
