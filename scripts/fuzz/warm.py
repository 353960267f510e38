"""How are thousands of commands tried in minutes?

Each one in a forked copy of this process, which has loaded everything and run every command once: a fifth of the time of a
fresh process, half of whose life is loading. What a copy does from its first instruction on is what `watchsim` does.
"""

from __future__ import annotations

import atexit
import contextlib
import io
import os
import shutil
import signal
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SIGNALS = (signal.SIGINT, signal.SIGTERM)


def load(commands: Mapping[str, Sequence[str]], made: Path, place: Path) -> None:
    """Run every command once in this process, each in a copy `place` of the folder `made`: nothing is left to be loaded."""
    from watchsim.cli import main

    before = Path.cwd()
    try:
        for arguments in commands.values():
            os.chdir(before)
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(made, place)
            os.chdir(place)
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
                status = main(list(arguments))
            if status != 0:
                raise SystemExit(f"{' '.join(arguments)}: {status} {said.getvalue()}")
    finally:
        os.chdir(before)


class Forked:
    """A watchsim command in a copy of this process; what it says goes to the file `said`."""

    def __init__(self, arguments: Sequence[str], place: Path, said: Path) -> None:
        self.said = said
        self.returncode: int | None = None
        sys.stdout.flush()
        # Signals wait until the command hears them, as they do for a process whose interpreter has begun with them held back.
        signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
        self.pid = os.fork()
        if self.pid == 0:
            self._become(arguments, place)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)

    def _become(self, arguments: Sequence[str], place: Path) -> None:
        try:
            atexit._clear()  # what is to be done at the end of the parent is not to be done here
            os.chdir(place)
            output = os.open(self.said, os.O_CREAT | os.O_WRONLY | os.O_TRUNC)
            os.dup2(output, 1)
            os.dup2(output, 2)
            sys.argv = ["watchsim", *arguments]
            from watchsim.process import process

            process()
        finally:
            os._exit(99)

    def poll(self) -> int | None:
        """The exit status, as of a subprocess; None while it runs."""
        if self.returncode is None:
            number, status = os.waitpid(self.pid, os.WNOHANG)
            self._ended(status if number else None)
        return self.returncode

    def send_signal(self, which: int) -> None:
        if self.poll() is None:
            os.kill(self.pid, which)

    def communicate(self) -> tuple[str, str]:
        """Wait for the end; what was said."""
        if self.returncode is None:
            self._ended(os.waitpid(self.pid, 0)[1])
        return self.said.read_text(errors="replace"), ""

    def _ended(self, status: int | None) -> None:
        if status is not None:
            self.returncode = os.waitstatus_to_exitcode(status)
