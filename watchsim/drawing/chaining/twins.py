"""Which outlines nearly coincide?

What was drawn twice exactly is taken out before. A copy that is off by some nanometres is not: the smaller of the two would
count as a hole, and next to nothing would be left of the part.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from watchsim.drawing.chaining.open_ends import shown
from watchsim.drawing.chaining.track import Track
from watchsim.drawing.findings import Finding
from watchsim.geometry.extent import extents
from watchsim.geometry.loop import Loop

NEAR = 1e-6  # m: no part has a wall that thin
SMALL = 0.05  # of an outline's size; for tiny ones that is less
PROBES = (0.0, 0.5)  # of each edge
MOST = 64  # edges that are looked at, evenly spread


def twins(loops: Sequence[Loop]) -> list[Finding]:
    """An error for each closed outline of one layer that follows another one all along within NEAR."""
    if len(loops) < 2:
        return []
    boxes = np.array([extents([loop]) for loop in loops])
    order = np.argsort(boxes[:, 0], kind="stable")
    left = boxes[order, 0]
    found = []
    for place, k in enumerate(order.tolist()):
        size = max(boxes[k, 2] - boxes[k, 0], boxes[k, 3] - boxes[k, 1])
        near = min(NEAR, SMALL * size)
        stop = int(np.searchsorted(left, left[place] + near, side="right"))
        others = order[place + 1 : stop]
        alike = others[np.all(np.abs(boxes[others] - boxes[k]) <= near, axis=1)] if len(others) else others
        for other in alike.tolist():
            apart = distance(loops[k], loops[other], near)
            if apart <= near:
                found.append(finding(loops[k], apart))
    return found


def distance(one: Loop, other: Loop, enough: float) -> float:
    """How far one outline leaves the other at most (m), at the ends and middles of both their edges; inf beyond `enough`."""
    worst = 0.0
    for here, there in ((one, other), (other, one)):
        track = Track(there)
        for edge in here.edges[:: max(1, len(here.edges) // MOST)]:
            for probe in PROBES:
                worst = max(worst, track.side(edge.point(probe), 0.0, track.length)[0])
                if worst > enough:
                    return math.inf
    return worst


def finding(loop: Loop, apart: float) -> Finding:
    x, y = loop.edges[0].point(0.5)
    message = f"two outlines coincide within {1e9 * apart:.3g} nm all along, near {shown((x, y))} mm"
    return Finding("overlap", "error", message, "Leave only one of them.", loop.layer, 1e3 * x, 1e3 * y)
