"""Which outlines are circles?"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import pytest

from watchsim.drawing.circles import circle_of, circle_reports
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line

RIGHT = Arc(1e-3, 2e-3, 5e-3, -math.pi / 2, math.pi)
LEFT = Arc(1e-3, 2e-3, 5e-3, math.pi / 2, math.pi)
THIRDS = tuple(Arc(1e-3, 2e-3, 5e-3, 1.0 - k * TURN / 3.0, -TURN / 3.0) for k in range(3))


@pytest.mark.parametrize("edges", [(RIGHT, LEFT), THIRDS, (Arc(1e-3, 2e-3, 5e-3, 0.7, TURN),)], ids=len)
def test_arcs_of_one_circle_are_that_circle(edges: tuple[Arc, ...]) -> None:
    found = circle_of(Loop(edges))
    assert found is not None and found.centre == (1e-3, 2e-3) and found.radius == 5e-3
    assert circle_of(replace(Loop(edges), closed=False)) is None
    rounded = (replace(edges[0], radius=5e-3 + 0.9e-9, x=1e-3 - 0.9e-9), *edges[1:])
    assert circle_of(Loop(rounded)) is not None


@pytest.mark.parametrize(
    "edges",
    [
        (RIGHT, replace(LEFT, radius=5e-3 + 2e-9)),
        (RIGHT, replace(LEFT, radius=5e-3 - 2e-9)),
        (RIGHT, replace(LEFT, x=1e-3 + 2e-9)),
        (RIGHT, replace(LEFT, y=2e-3 - 2e-9)),
        (RIGHT, Line(*RIGHT.end, *RIGHT.start)),
        (Line(*RIGHT.end, *RIGHT.start), RIGHT),
        (RIGHT,),
    ],
)
def test_anything_else_is_none(edges: tuple[Arc | Line, ...]) -> None:
    assert circle_of(Loop(edges)) is None


def test_what_is_said_of_circles_is_where_they_are() -> None:
    """In millimetres; a hole is said to be one, and other outlines are not told of."""
    square = tuple(Line(*a, *b) for a, b in pairwise([(0.0, 0.0), (1e-3, 0.0), (1e-3, 1e-3), (0.0, 0.0)]))
    loops = [Loop(THIRDS, layer="rim"), Loop(square), Loop((RIGHT, LEFT), layer="bore", hole=True)]
    where = {"x_mm": 1.0, "y_mm": 2.0, "radius_mm": 5.0}
    assert circle_reports(loops) == [{"layer": "rim", **where, "hole": False}, {"layer": "bore", **where, "hole": True}]
