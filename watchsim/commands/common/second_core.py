"""What does the second core of a machine do while a run is stepped, and while its numbers are worked out?

The loop is machine code that leaves Python to others: meanwhile a thread loads what plots need. When the motion is known, they are
drawn in a copy of the process, which has all that they show already, while the process itself goes on with numbers and tables.
"""

from __future__ import annotations

import contextlib
import functools
import os
import shutil
import signal
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, NoReturn

from watchsim import stopping

Draw = Callable[[Path | IO[bytes]], object]
PROMPT = 5e-4  # s that a thread may keep Python from another; the usual 5 ms would hold up every slice of the loop


class Meanwhile:
    """Something that a thread does from `begin` on, once; whatever goes wrong with it, it is done again where it is needed."""

    def __init__(self, work: Callable[[], object]) -> None:
        self._work = work
        self._thread: threading.Thread | None = None

    def begin(self) -> None:
        """Begin, unless that has been done."""
        if self._thread is None:
            self._before = sys.getswitchinterval()
            sys.setswitchinterval(PROMPT)
            self._thread = threading.Thread(target=self._quietly, daemon=True, name="meanwhile")
            self._thread.start()

    def end(self) -> None:
        """Wait until it is done."""
        if self._thread is not None:
            self._thread.join()
            sys.setswitchinterval(self._before)

    def _quietly(self) -> None:
        with contextlib.suppress(Exception):
            self._work()


def load_plots() -> None:
    """Load what plots need, fonts included."""
    from watchsim.render.figures.figure_style import figure
    from watchsim.render.figures.kinematics_plot import Kinematics

    assert Kinematics
    empty = figure()
    empty.text(0.5, 0.5, "0123456789 °/s", weight="bold")
    empty.canvas.draw()


def drawn_apart(draws: Mapping[str, Draw]) -> Mapping[str, Draw]:
    """The same pictures, being drawn in a copy of this process from now on; those that it cannot draw are drawn here.

    Only in a process of the command line, and where copies are safe: on macOS its own libraries forbid them.
    """
    if not (draws and stopping.installed() and sys.platform == "linux"):
        return draws
    try:
        files: dict[str, IO[bytes]] = {name: tempfile.TemporaryFile() for name in draws}  # noqa: SIM115 - as long as the run
        child = _copy_that(lambda: [draw(files[name]) for name, draw in draws.items()])
    except OSError:  # no room for another process, or for files
        return draws

    @functools.cache
    def is_done() -> bool:
        return os.waitpid(child, 0)[1] == 0

    def written(name: str, target: Path | IO[bytes]) -> None:
        if not (is_done() and isinstance(target, Path)):
            draws[name](target)
            return
        files[name].seek(0)
        with target.open("wb") as file:
            shutil.copyfileobj(files[name], file)

    return {name: functools.partial(written, name) for name in draws}


def _copy_that(work: Callable[[], object]) -> int:
    """The number of a copy of this process that does some work and ends, with status 0 where all went well."""
    signals = set(signal.Signals)
    held = signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    try:
        child = os.fork()
        if child == 0:
            _work_alone(work)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, held)
    return child


def _work_alone(work: Callable[[], object]) -> NoReturn:
    """What the copy does: signals are for the one it is a copy of, and so is what there is to say."""
    status = 1
    try:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        work()
        status = 0
    finally:
        os._exit(status)
