"""Which events and rows of a run need not be passed once more when it is over?

Those that have settled, as long as they are few: what one process has passed by then, the other one holds.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from watchsim.simulation.record.trajectory import Trajectory

    Rows = Sequence[NDArray[Any]]  # t, q, u, a

MOST = 64e6  # bytes: minutes of a watch


class Passed:
    """How much the first process has passed."""

    def __init__(self) -> None:
        self._rows = self._events = 0
        self._bytes = 0

    def add(self, events: NDArray[Any], rows: Rows) -> None:
        self._rows, self._events = self._rows + len(rows[0]), self._events + len(events)
        self._bytes += _size(events, rows)

    def rest(self, run: Trajectory) -> Trajectory:
        """The run without what the other process holds."""
        if self._bytes > MOST:
            return run
        columns = {name: getattr(run, name)[self._rows :] for name in ("t", "q", "u", "a")}
        return dataclasses.replace(run, events=run.events[self._events :], **columns)


class Settled:
    """The same in the other process: what was passed, until it is more than `MOST`."""

    def __init__(self) -> None:
        self.time = 0.0  # s, that the run has reached
        self._parts: list[tuple[NDArray[Any], ...]] = []  # events and rows
        self._bytes = 0

    @property
    def is_held(self) -> bool:
        return self._bytes <= MOST

    def add(self, events: NDArray[Any], rows: Rows) -> None:
        self._bytes += _size(events, rows)
        if len(rows[0]):
            self.time = float(rows[0][-1])
        self._parts = [*self._parts, (events, *rows)] if self.is_held else []

    def columns(self, *behind: tuple[NDArray[Any], ...]) -> tuple[NDArray[Any], ...]:
        """Events, t, q, u, a: what is held, and what is given behind it."""
        import numpy as np

        return tuple(np.concatenate(column) for column in zip(*self._parts, *behind, strict=True))

    def whole(self, rest: Trajectory) -> Trajectory:
        """The run of which `rest` was passed at the end."""
        if not self._parts:
            return rest
        events, t, q, u, a = self.columns((rest.events, rest.t, rest.q, rest.u, rest.a))
        return dataclasses.replace(rest, events=events, t=t, q=q, u=u, a=a)


def _size(events: NDArray[Any], rows: Rows) -> int:
    return events.nbytes + sum(column.nbytes for column in rows)
