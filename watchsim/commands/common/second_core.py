"""What does the second core of a machine do while a run is stepped, and while its numbers are worked out?

The loop is machine code that leaves Python to others: meanwhile a thread makes panels of plots, and text of events. When
the motion is known, the plots are drawn in a copy of the process, which has all that they show, and the process itself
goes on with numbers and tables.
"""

from __future__ import annotations

import functools
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple, NoReturn, TypeVar

from watchsim import stopping

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from watchsim.render.figures.kinematics_plot import Kinematics
    from watchsim.results.tables import EventLines
    from watchsim.scene.scene import Scene
    from watchsim.simulation.record.trajectory import Pair

Done = TypeVar("Done")
Draw = Callable[[Path | IO[bytes]], object]
PROMPT = 5e-4  # s that a thread may keep Python from another; the usual 5 ms would hold up every slice of the loop


class Begun(NamedTuple):
    """What was done meanwhile: the events as far as they were made into text, and the empty panels of the plots."""

    lines: EventLines | None = None
    panels: Kinematics | None = None


class Meanwhile:
    """What a thread does while a run is stepped: makes its events into text, in files in `folder`, and `panels` for its plots.

    Whatever goes wrong with it is done again where it is needed.
    """

    def __init__(self, scene: Scene, folder: Path, panels: Callable[[], Kinematics] | None = None) -> None:
        self._scene, self._folder, self._panels = scene, folder, panels
        self._lines: EventLines | None = None
        self._made: list[Future[Kinematics]] = []  # the panels, once they were asked for
        self._work: list[Future[Any]] = []
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="meanwhile")
        self._before = sys.getswitchinterval()

    def progress(self, *_: float) -> None:
        """To be called while the run goes on: the loop is running, so that a thread may."""
        if not self._work:
            self._do(_load)
        if self._panels and not self._made:
            self._made.append(self._do(self._panels))

    def follow(self, pairs: Sequence[Pair], events: NDArray[Any]) -> None:
        """The next events of the run."""
        from watchsim.results.tables import EventLines

        lines = self._lines = self._lines or EventLines(self._scene, pairs, self._folder)
        self._do(lambda: lines.add(events))

    def _do(self, work: Callable[[], Done]) -> Future[Done]:
        sys.setswitchinterval(PROMPT)
        begun = self._thread.submit(work)
        self._work.append(begun)
        return begun

    def end(self) -> Begun:
        """Wait until it is done; nothing of it where something failed."""
        self._thread.shutdown()
        sys.setswitchinterval(self._before)
        if any(one.exception() for one in self._work):
            return Begun()
        return Begun(self._lines, self._made[0].result() if self._made else None)


def _load() -> None:
    """Load what works out the numbers of a run."""
    import watchsim.analysis.summary
    import watchsim.analysis.timeline.timeline_table  # noqa: F401


def drawn_apart(draws: Mapping[str, Draw]) -> Mapping[str, Draw]:
    """The same pictures, being drawn in a copy of this process from now on; those that it cannot draw are drawn here.

    Only in a process of the command line, and where copies are safe: on macOS its own libraries forbid them.
    """
    if not (draws and stopping.installed() and sys.platform == "linux"):
        return draws
    try:
        files: dict[str, IO[bytes]] = {name: tempfile.TemporaryFile() for name in draws}  # noqa: SIM115 - as long as the run
        child = _copy_that(lambda: [(draw(files[name]), files[name].flush()) for name, draw in draws.items()])
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
