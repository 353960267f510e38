"""What does a second core do for `watchsim run`, while a run is stepped and after it?

The loop is machine code that leaves Python to others: meanwhile a thread makes text of events and prepares plots. When the run
is over, a copy of the process draws them while the first one works out the numbers. Whatever goes wrong is done again by the
first, which writes the same bytes.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
import signal
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NoReturn

from watchsim import stopping
from watchsim.storage.destination import give_name, nameless

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from watchsim.render.kinematics_plot import Kinematics
    from watchsim.results.tables import EventLines
    from watchsim.scene.scene import Scene
    from watchsim.simulation.recording import Pair


Draws = Mapping[str, Callable[[Path | IO[bytes]], object]]  # by the name of the picture in the results folder
BUSY = 0.2  # s: at first the loop comes back to Python again and again, for cells that it meets for the first time
DIES_WITH_PARENT = 1  # PR_SET_PDEATHSIG of Linux


class Meanwhile:
    """What a thread does while a run is stepped, for results in `folder`; `panels` prepares plots."""

    def __init__(self, scene: Scene, folder: Path, panels: Callable[[], Kinematics] | None = None) -> None:
        self._scene, self._folder, self._prepare = scene, folder, panels if can_copy() else None
        self._lines: EventLines | None = None
        self._panels: Future[Kinematics] | None = None
        self._work: list[Future[None]] = []
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="meanwhile")
        self._begun, self._loads = time.perf_counter(), False

    def progress(self, *_: float) -> None:
        """To be called while the run goes on: the loop is running, so that a thread may."""
        if not self._loads and time.perf_counter() - self._begun > BUSY:
            self._loads = True
            self._thread.submit(_load)
            if self._prepare:
                self._panels = self._thread.submit(self._prepare)

    def follow(self, pairs: Sequence[Pair], events: NDArray[Any], _: Sequence[NDArray[Any]] = ()) -> None:
        """The next events of the run."""
        if not len(events):
            return
        from watchsim.results.tables import EventLines

        lines = self._lines = self._lines or EventLines(self._scene, pairs, self._folder)
        self._work.append(self._thread.submit(lines.add, events))

    def end(self) -> tuple[EventLines | None, Kinematics | None]:
        """Wait until it is done; the events as far as they were made into text, and empty panels; None for what failed."""
        self._thread.shutdown()
        lines = None if any(one.exception() for one in self._work) else self._lines
        return lines, None if self._panels is None or self._panels.exception() else self._panels.result()


def _load() -> None:
    """Load what works out the numbers of a run."""
    import watchsim.analysis.summary
    import watchsim.analysis.timeline  # noqa: F401


def can_copy() -> bool:
    """Whether a copy of this process is safe and of use: with two cores."""
    return stopping.may_fork() and len(os.sched_getaffinity(0)) > 1


def drawn_beside(draws: Draws, folder: Path) -> Draws:
    """The same plots, drawn from now on by a copy of this process into files in `folder` that have no name yet."""
    if not draws or not can_copy():
        return draws
    try:
        files = {name: nameless(folder) for name in draws}
        held = signal.pthread_sigmask(signal.SIG_BLOCK, set(signal.Signals))  # for good in the copy
        try:
            first, child = os.getpid(), os.fork()
            if child == 0:
                _draw(draws, files, first)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, held)
    except OSError:
        return draws
    drawn = functools.cache(lambda: os.waitpid(child, 0)[1] == 0)

    def write(name: str, target: Path | IO[bytes]) -> None:
        if isinstance(target, Path) and drawn():
            give_name(files[name], target)
        else:
            draws[name](target)

    return {name: functools.partial(write, name) for name in draws}


def _draw(draws: Draws, files: dict[str, IO[bytes]], first: int) -> NoReturn:
    """What the copy does, without a word; it ends with the process `first`, however that ends."""
    status = 1
    with contextlib.suppress(BaseException):
        ctypes.CDLL(None).prctl(DIES_WITH_PARENT, signal.SIGKILL)
        nowhere = os.open(os.devnull, os.O_RDWR)
        for number in range(3):
            os.dup2(nowhere, number)
        if os.getppid() == first:
            for name, draw in draws.items():
                draw(files[name])
                files[name].flush()
            status = 0
    os._exit(status)
