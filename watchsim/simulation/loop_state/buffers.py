"""How far is the loop to run, and where does it write what is kept?"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import by_reference
from watchsim.model.named_fields import blank
from watchsim.model.records import Model, Records
from watchsim.simulation.event_kinds import EVENT_DTYPE

Array = NDArray[np.float64]


class Until:
    """How far the loop is to run."""

    slice_end: float  # s: it may come back after that
    end: float  # s: the run's end
    may_cut: int  # 1 if the step that reaches the end may be cut short by it
    steps: float  # counted down; it may come back when none is left


def new_until(slice_end: float = 0.0, end: float = 0.0, may_cut: bool = False, steps: float = 0.0) -> Until:
    """How far the loop is to run."""
    until = blank(Until)
    until.slice_end, until.end, until.may_cut, until.steps = slice_end, end, int(may_cut), steps
    return until


class Used:
    """How much of the buffers is filled."""

    rows: int
    events: int


class Record(NamedTuple):
    """Rows (t, q, u, a), events, and the times within which rows are kept."""

    rows: Array
    events: Records
    used: Used
    windows: Array  # (k, 2)


RecordRef = by_reference(Record, __name__)


def new_record(model: Model, rows: int, events: int, windows: Array) -> Record:
    """Empty buffers."""
    n = len(model.coordinates)
    return Record(np.zeros((rows, 1 + 3 * n)), np.zeros(events, EVENT_DTYPE).view(np.recarray), blank(Used), windows)
