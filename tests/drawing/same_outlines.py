"""Are two sets of outlines the same to 1e-12: loop by loop, edge by edge, and in area and moment?"""

import math

import pytest

from watchsim.geometry.loops import Loop, extents
from watchsim.geometry.primitives import Arc, Line
from watchsim.geometry.solids import section

TINY = 1e-12


def compare(before: tuple[Loop, ...], after: tuple[Loop, ...]) -> None:
    """Each loop has one twin, whatever edge that begins with."""
    box = extents(before)
    assert box is not None and len(before) == len(after)
    size = max(map(abs, box))
    for loop in before:
        twins = [other for other in after if other.layer == loop.layer and same_edges(loop, other, size)]
        assert len(twins) == 1, loop
        assert (twins[0].hole, twins[0].closed) == (loop.hole, loop.closed)
    one, other = section(before), section(after).about(section(before).origin)
    assert (other.area, other.polar) == pytest.approx((one.area, one.polar), rel=TINY, abs=0.0)


def same_edges(one: Loop, other: Loop, size: float) -> bool:
    """The same lines and arcs in the same order, begun anywhere, within 1e-12 of `size`."""
    slack = TINY * size
    count = len(one.edges)
    return count == len(other.edges) and any(
        all(same_edge(one.edges[i], other.edges[(i + shift) % count], slack) for i in range(count)) for shift in range(count)
    )


def same_edge(a: Line | Arc, b: Line | Arc, slack: float) -> bool:
    if type(a) is not type(b):
        return False
    if isinstance(a, Line):
        return math.dist(a.start, b.start) <= slack and math.dist(a.end, b.end) <= slack
    if a.is_circle and b.is_circle:
        return math.dist((a.x, a.y), (b.x, b.y)) <= slack and abs(a.radius - b.radius) <= slack and a.sweep * b.sweep > 0.0
    ends = math.dist(a.start, b.start) <= slack * 4 and math.dist(a.end, b.end) <= slack * 4
    # Relative to the arc's own size: a flat arc of a few millimetres may have a radius of a metre.
    own = TINY * max(a.radius, slack / TINY)
    return ends and math.dist((a.x, a.y), (b.x, b.y)) <= own and abs(a.radius - b.radius) <= own
