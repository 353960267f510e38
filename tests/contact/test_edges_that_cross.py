"""Are two edges that cross twice found to do so, where both ends of one lie on the same side of the other?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from plain_kernels import in_python
from test_edge_distance import _to_edge, along, apart, checked, drawn, in_millimetres, one

from watchsim.contact import edge_distance
from watchsim.geometry.primitives import Arc, Edge, Line

_crossing = in_python(edge_distance._crossing)


def crossings(a: Edge, b: Edge) -> int:
    """How often a crosses b, by the signs of many points of a; only what is well inside both counts."""
    points = along(a, np.linspace(0.003, 0.997, 401))
    if isinstance(b, Line):
        side = ((points - along(b, 0.0)) / (along(b, 1.0) - along(b, 0.0))).imag
    else:
        side = np.abs(points - complex(b.x, b.y)) - b.radius
    near = apart(b, points) < 0.02
    return int(np.count_nonzero((side[:-1] * side[1:] < 0.0) & near[1:] & near[:-1]))


def crossing_twice(count: int) -> list[tuple[Edge, Edge]]:
    rng = np.random.default_rng(5)
    found: list[tuple[Edge, Edge]] = []
    while len(found) < count:
        a, b = drawn(rng), drawn(rng)
        if crossings(a, b) == 2:
            found.append((a, b))
    return found


@pytest.mark.parametrize(("a", "b"), crossing_twice(40))
def test_those_that_cross_twice_are_found(a: Edge, b: Edge) -> None:
    assert checked(a, b) == checked(b, a) == (0.0, True)
    small = in_millimetres(a), in_millimetres(b)
    assert checked(*small) == checked(*small[::-1]) == (0.0, True)


def test_so_are_very_flat_arcs() -> None:
    """A metre of a circle four kilometres wide, a sixth of its rise below its top."""
    arc = Arc(0.0, -2000.0, 2000.0, 0.5 * math.pi - 2.5e-4, 5e-4)
    for line in (Line(-0.7, -1e-5, 0.9, -1e-5), Line(0.9, -1e-5, -0.7, -1e-5)):
        for a, b in ((arc, line), (line, arc)):
            distance, _, _, crossing = _to_edge(one(a), one(b))
            assert (distance, crossing) == (0.0, True)


@pytest.mark.parametrize("end", [0.0, 1e-9])
def test_an_end_that_lies_on_the_other_is_no_crossing(end: float) -> None:
    """The distance of the ends is asked for itself; what goes over by a billionth crosses."""
    line, slope = one(Line(-2.0, 0.0, 2.0, 0.0)), one(Line(-1.0, -1.0, end, end))
    assert _crossing(slope, line, math.inf)[0] is (end > 0.0)
