"""What are the numbers of many edges, column by column?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Arc, Edge

Floats = NDArray[np.float64]

QUARTER = 0.5 * np.pi


class Table(NamedTuple):
    """Edges as columns, metres and radians: ends, boxes (n, 4), and for arcs centre, radius, start angle and sweep."""

    start: Floats
    end: Floats
    box: Floats
    arc: NDArray[np.bool_]
    centre: Floats
    radius: Floats
    start_angle: Floats
    sweep: Floats


def table_of(edges: Sequence[Edge]) -> Table:
    """The edges in columns; what only arcs have is 0 for lines."""
    rows = [
        (e.x, e.y, e.radius, e.start_angle, e.sweep) if isinstance(e, Arc) else (e.x0, e.y0, e.x1, e.y1, 0.0) for e in edges
    ]
    columns = np.array(rows, dtype=float).reshape(-1, 5)
    arc = np.array([isinstance(edge, Arc) for edge in edges], dtype=bool)
    start, end = columns[:, :2].copy(), columns[:, 2:4].copy()
    columns[~arc] = 0.0
    centre, (radius, angle, sweep) = columns[:, :2], columns[:, 2:].T
    for corner, at in ((start, angle), (end, angle + sweep)):
        corner[arc] = (centre + radius[:, None] * np.column_stack((np.cos(at), np.sin(at))))[arc]
    low, high = np.minimum(angle, angle + sweep) / QUARTER, np.maximum(angle, angle + sweep) / QUARTER
    box = np.hstack((np.minimum(start, end), np.maximum(start, end)))
    # An arc reaches furthest along an axis where it passes a whole quarter turn: 0 to 3, or any number of turns later.
    for quarter, (column, furthest) in enumerate(((2, np.maximum), (3, np.maximum), (0, np.minimum), (1, np.minimum))):
        passes = arc & (4.0 * np.ceil((low - quarter) / 4.0) + quarter <= high)
        side = centre[:, column % 2] + radius * (1.0 if column > 1 else -1.0)
        box[passes, column] = furthest(box[passes, column], side[passes])
    return Table(start, end, box, arc, centre, radius, angle, sweep)
