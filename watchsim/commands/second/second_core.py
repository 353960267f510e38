"""What does a second core do for the process itself while a run is stepped?

The loop is machine code that leaves Python to others: meanwhile a thread makes text of events. Plots are drawn elsewhere, see
`second_process`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from watchsim.results.tables import EventLines
    from watchsim.scene.scene import Scene
    from watchsim.simulation.record.trajectory import Pair

BUSY = 0.2  # s: at first the loop comes back to Python again and again, for cells that it meets for the first time


class Meanwhile:
    """What a thread does while a run is stepped: it makes events into text, in files in `folder`, and loads what comes next.

    Whatever goes wrong with it is done again where it is needed.
    """

    def __init__(self, scene: Scene, folder: Path) -> None:
        self._scene, self._folder = scene, folder
        self._lines: EventLines | None = None
        self._work: list[Future[object]] = []
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="meanwhile")
        self._begun, self._loads = time.perf_counter(), False

    def progress(self, *_: float) -> None:
        """To be called while the run goes on: the loop is running, so that a thread may."""
        if not self._loads and time.perf_counter() - self._begun > BUSY:
            self._loads = True
            self._do(_load)

    def follow(self, pairs: Sequence[Pair], events: NDArray[Any], _: Sequence[NDArray[Any]] = ()) -> None:
        """The next events of the run."""
        if not len(events):
            return
        from watchsim.results.tables import EventLines

        lines = self._lines = self._lines or EventLines(self._scene, pairs, self._folder)
        self._do(lambda: lines.add(events))

    def _do(self, work: Callable[[], object]) -> None:
        self._work.append(self._thread.submit(work))

    def end(self) -> EventLines | None:
        """Wait until it is done; the events as far as they were made into text, nothing of them where something failed."""
        self._thread.shutdown()
        return None if any(one.exception() for one in self._work) else self._lines


def _load() -> None:
    """Load what works out the numbers of a run."""
    import watchsim.analysis.summary
    import watchsim.analysis.timeline.timeline_table  # noqa: F401
