"""Who does the work of a study?

One seam: something that answers numbered points of a question, in whatever order. In this process, in processes of this machine
(concurrent.futures), or on a cluster (dask.distributed, the extra `cluster`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Protocol

from watchsim.studies.axes import Value
from watchsim.studies.point import Question, Row, answer

Points = Sequence[tuple[int, Mapping[str, Value]]]
LOOK = 0.2  # s between looks at whether somebody wants to stop
AHEAD = 3  # points handed out per worker before one is finished


class WorkersLost(RuntimeError):
    """Those who worked were ended from outside."""


class Executor(Protocol):
    """Answers points; ends early, without the rows that are not finished, once `interrupted()` is true."""

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        """(number, row) of every point, as they are finished."""


class Here:
    """One point after another, in this process."""

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        for number, changes in points:
            if interrupted():
                return
            try:
                row = answer(question, changes, interrupted)
            except KeyboardInterrupt:
                if not interrupted():
                    raise
                return
            yield number, row


def finished(future: Any) -> tuple[int, Row] | None:
    """What a future of `worker.work` has made; None for a point that was cut short."""
    made: tuple[int, Row] | None = future.result()
    return made
