"""What do the bodies of the benchmarks look like?"""

from __future__ import annotations

from dataclasses import replace

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Arc, Line, Point
from watchsim.scene.body import Body


def circle(radius: float) -> Loop:
    """A full circle about the origin."""
    return Loop((Arc(0.0, 0.0, radius, 0.0, TURN),))


def polygon(*points: Point) -> Loop:
    """Closed, counter-clockwise."""
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True)))


def box(half_width: float, half_height: float) -> Loop:
    """A rectangle about the origin."""
    x, y = half_width, half_height
    return polygon((-x, -y), (x, -y), (x, y), (-x, y))


def ground(length: float = 1e4) -> Body:
    """A fixed plane along x with material below, `length` to both sides."""
    return Body("ground", "fixed", loops=(Loop((Line(length, 0.0, -length, 0.0),), closed=False),))


def shaped(body: Body, *loops: Loop) -> Body:
    """The body with these outlines."""
    return replace(body, loops=loops)
