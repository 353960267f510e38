"""How much of a run is kept?"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

Window = tuple[float, float]

ALL, EVENTS, STATISTICS = "all", "events", "statistics"
KEPT = (ALL, EVENTS, STATISTICS)
EVERY = "every"  # "every 10": every tenth row
WHOLE_RUN: tuple[Window, ...] = ((-math.inf, math.inf),)


@dataclass(frozen=True, slots=True)
class Recording:
    """Which rows and events of a run are kept; sums over the whole run are made in any case.

    windows  (s, s) in which rows are kept; none means the whole run where `keep` is "all"
    keep     "all": rows within the windows, and all events;
             "events": the same, but without windows only the rows of the last seconds;
             "statistics": rows and events within the windows and in the last seconds, so that memory does not grow with time
    stride   every n-th row within the windows is kept; interpolation across rows that are left out is not exact
    """

    windows: tuple[Window, ...] = ()
    keep: str = ALL
    stride: int = 1

    def __post_init__(self) -> None:
        if self.keep not in KEPT:
            raise ValueError(f'"{self.keep}" cannot be kept; choose from {", ".join(KEPT)}')
        if self.stride < 1:
            raise ValueError(f"every row or every n-th row can be kept; n must be at least 1, not {self.stride}")
        for start, end in self.windows:
            if not start < end:
                raise ValueError(f"a window runs from an earlier to a later time, not from {start:g} s to {end:g} s")

    @property
    def has_tail(self) -> bool:
        """True if the last seconds of the run are kept whatever the windows say."""
        return self.keep != ALL

    @property
    def row_windows(self) -> tuple[Window, ...]:
        """The windows, or the whole run where none are given and everything is kept."""
        return self.windows or (WHOLE_RUN if self.keep == ALL else ())


EVERYTHING = Recording()


def as_recording(what: Recording | str | Iterable[Window] | None) -> Recording | None:
    """From what is convenient in Python: a word such as "statistics", or windows in seconds."""
    if what is None or isinstance(what, Recording):
        return what
    if isinstance(what, str):
        return Recording(keep=what)
    return Recording(tuple((float(start), float(end)) for start, end in what))
