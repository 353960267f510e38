"""How do rows and events read in the coordinates of the scene?

The loop counts all angles in the movement; a scene gives those of carried bodies relative to their carriers.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.row_selection import columns_of

Array = NDArray[np.float64]


def rows_of_scene(compiled: Compiled, rows: Array) -> tuple[Array, ...]:
    """t, q, u, a of rows of the loop."""
    t, q, u, a = columns_of(rows)
    relative = compiled.relative
    return t, relative(q), relative(u, rates=True), relative(a, rates=True)


def events_of_scene(compiled: Compiled, events: NDArray[Any]) -> NDArray[Any]:
    """The events, angles of turning points in the coordinates of the scene."""
    turned = [(compiled.model.coordinates[own].body, angle) for own, _, angle in compiled.against if angle != 0.0]
    events = events.copy() if turned else events
    for body, angle in turned:
        events["value"][(events["kind"] == EventKind.TURN) & (events["body"] == body)] -= angle
    return events
