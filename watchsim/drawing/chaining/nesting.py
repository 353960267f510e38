"""Which loops are holes?

A loop inside an odd number of others of its layer is a hole and runs clockwise; all others run counter-clockwise, so that
the material is on the left everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.boxes import Boxes
from watchsim.geometry.extent import extents
from watchsim.geometry.inside import Inside
from watchsim.geometry.loop import Loop
from watchsim.geometry.solids.mass import area

AT_ONCE = 2_000_000  # pairs of loops that may be looked at in one go, and
MOST = 30_000_000  # in all: more are a fault in the drawing


def nested(loops: Sequence[Loop]) -> list[Loop] | None:
    """The closed loops of one layer, oriented and with holes marked; same order. None where too many lie in each other."""
    areas = [area(loop) for loop in loops]
    found = depths(loops, np.abs(areas))
    if found is None:
        return None
    result = []
    for loop, size, depth in zip(loops, areas, found, strict=True):
        hole = depth % 2 == 1
        turned = loop.reversed() if (size > 0.0) == hole else loop
        result.append(replace(turned, hole=hole))
    return result


def depths(loops: Sequence[Loop], size: NDArray[np.float64]) -> list[int] | None:
    """In how many others each loop lies, by the middle of its first edge: one more than the smallest loop around it."""
    if len(loops) < 2:
        return [0] * len(loops)
    boxes = np.array([extents([loop]) for loop in loops])
    probes = np.array([loop.edges[0].point(0.5) for loop in loops])
    tree = Boxes(boxes)
    depth = [0] * len(loops)
    insides: dict[int, Inside] = {}
    largest_first = np.argsort(-size, kind="stable")
    step = max(1, AT_ONCE // len(loops))
    seen = 0
    for chosen in (largest_first[k : k + step] for k in range(0, len(loops), step)):
        which, outer = tree.holding(probes[chosen])
        seen += len(which)
        if seen > MOST:
            return None
        inner = chosen[which]
        around = np.all((boxes[outer, :2] <= boxes[inner, :2]) & (boxes[outer, 2:] >= boxes[inner, 2:]), axis=1)
        keep = np.flatnonzero(around & (size[outer] > size[inner]))
        keep = keep[np.lexsort((size[outer[keep]], which[keep]))]  # of each loop the smallest around it first
        found = outer[keep]
        starts = np.searchsorted(which[keep], np.arange(len(chosen) + 1))
        for number, k in enumerate(chosen.tolist()):
            for other in found[starts[number] : starts[number + 1]].tolist():
                if other not in insides:
                    insides[other] = Inside(loops[other])
                if insides[other].winding((float(probes[k, 0]), float(probes[k, 1]))) != 0:
                    depth[k] = depth[other] + 1
                    break
    return depth
