"""Random closed outlines of lines and arcs for the tests of writing and reading."""

import math
from collections.abc import Sequence

from hypothesis import strategies as st

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point

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
