"""Random closed outlines of lines and arcs for the tests of writing and reading."""

import math
from collections.abc import Sequence

import pytest
from hypothesis import strategies as st

from watchsim.geometry.loops import Loop, extents
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.solids import section

SWEEPS = (0.0, 0.0, 0.004, 0.3, -0.3, 1.5, math.pi)


def arc_between(a: Point, b: Point, sweep: float) -> Arc:
    dx, dy = b[0] - a[0], b[1] - a[1]
    lift = 0.5 / math.tan(0.5 * sweep)
    x, y = 0.5 * (a[0] + b[0]) - lift * dy, 0.5 * (a[1] + b[1]) + lift * dx
    return Arc(x, y, math.hypot(a[0] - x, a[1] - y), math.atan2(a[1] - y, a[0] - x), sweep)


def closed(corners: Sequence[Point], sweeps: Sequence[float], layer: str) -> Loop:
    """A counter-clockwise loop through the corners, bent by the sweeps."""
    edges: list[Edge] = []
    for a, b, sweep in zip(corners, [*corners[1:], corners[0]], sweeps, strict=True):
        edges.append(arc_between(a, b, sweep) if sweep else Line(*a, *b))
    return Loop(tuple(edges), layer)


@st.composite
def parts(draw: st.DrawFn) -> tuple[Loop, ...]:
    """Outer outlines a few millimetres wide on one or two layers, each with or without a round hole, anywhere within 50 mm."""
    found: list[Loop] = []
    for number in range(draw(st.integers(1, 3))):
        layer = draw(st.sampled_from(("TEETH", "ARM µ")))
        x, y = 0.02 * number + draw(st.floats(-0.03, 0.03 - 0.02)), draw(st.floats(-0.05, 0.05))
        x = 0.02 * number + math.fmod(x, 0.004)
        n = draw(st.integers(3, 8))
        turn = draw(st.floats(0.0, 6.0))
        radii = [draw(st.floats(1.5e-3, 4e-3)) for _ in range(n)]
        corners = [(x + r * math.cos(turn + TURN * k / n), y + r * math.sin(turn + TURN * k / n)) for k, r in enumerate(radii)]
        found.append(closed(corners, [draw(st.sampled_from(SWEEPS[:5])) for _ in range(n)], layer))
        if draw(st.booleans()):
            found.append(Loop((Arc(x, y, draw(st.floats(0.05e-3, 0.3e-3)), 0.0, -TURN),), layer, hole=True))
    return tuple(found)


# Are two sets of outlines the same to 1e-12: loop by loop, edge by edge, and in area and moment?

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
