"""Which loops are holes?

A loop inside an odd number of others of its layer is a hole and runs clockwise; all others run counter-clockwise, so that
the material is on the left everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from watchsim.geometry.extent import Box, extents
from watchsim.geometry.inside import winding
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
    """In how many others each loop lies, by the middle of its first edge.

    The boxes are swept from left to right: only those that are open at a loop's test point are looked at.
    """
    boxes = [extents([loop]) or (0.0, 0.0, 0.0, 0.0) for loop in loops]
    probes = [loop.edges[0].point(0.5) for loop in loops]
    depth = [0] * len(loops)
    by_left = sorted(range(len(loops)), key=lambda k: boxes[k][0])
    active: list[int] = []
    opened = 0
    for k in sorted(range(len(loops)), key=lambda k: probes[k][0]):
        x = probes[k][0]
        while opened < len(by_left) and boxes[by_left[opened]][0] <= x:
            active.append(by_left[opened])
            opened += 1
        active = [other for other in active if boxes[other][2] >= x]
        depth[k] = sum(holds(loops, boxes, areas, other, k) and winding(loops[other], probes[k]) != 0 for other in active)
    return depth


def holds(loops: Sequence[Loop], boxes: Sequence[Box], areas: Sequence[float], other: int, k: int) -> bool:
    """Can loop `other` contain loop `k`: it is larger, and its box reaches around?"""
    a, b = boxes[other], boxes[k]
    return other != k and areas[other] > areas[k] and a[0] <= b[0] and a[1] <= b[1] and a[2] >= b[2] and a[3] >= b[3]
