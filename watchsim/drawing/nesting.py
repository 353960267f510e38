"""Which loops are holes?

A loop inside an odd number of others of its layer is a hole and runs clockwise; all others run counter-clockwise, so that
the material is on the left everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from watchsim.geometry.boxes import holding
from watchsim.geometry.extent import extents
from watchsim.geometry.inside import Inside
from watchsim.geometry.loop import Loop
from watchsim.geometry.mass import area


def nested(loops: Sequence[Loop]) -> list[Loop]:
    """The closed loops of one layer, oriented and with holes marked; same order."""
    areas = [area(loop) for loop in loops]
    result = []
    for loop, size, depth in zip(loops, areas, depths(loops, [abs(size) for size in areas]), strict=True):
        hole = depth % 2 == 1
        turned = loop.reversed() if (size > 0.0) == hole else loop
        result.append(replace(turned, hole=hole))
    return result


def depths(loops: Sequence[Loop], areas: Sequence[float]) -> list[int]:
    """In how many others each loop lies, by the middle of its first edge: one more than the smallest loop around it."""
    if len(loops) < 2:
        return [0] * len(loops)
    boxes = np.array([extents([loop]) for loop in loops])
    probes = [loop.edges[0].point(0.5) for loop in loops]
    size = np.array(areas)
    inner, outer = holding(boxes, np.array(probes))
    around = np.all((boxes[outer, :2] <= boxes[inner, :2]) & (boxes[outer, 2:] >= boxes[inner, 2:]), axis=1)
    keep = around & (size[outer] > size[inner])
    inner, outer = inner[keep], outer[keep]
    order = np.lexsort((size[outer], inner))
    inner, outer = inner[order], outer[order]
    starts = np.searchsorted(inner, np.arange(len(loops) + 1))
    depth = [0] * len(loops)
    insides: dict[int, Inside] = {}
    for k in np.argsort(-size, kind="stable").tolist():
        for other in outer[starts[k] : starts[k + 1]].tolist():
            if other not in insides:
                insides[other] = Inside(loops[other])
            if insides[other].winding(probes[k]) != 0:
                depth[k] = depth[other] + 1
                break
    return depth
