"""Which outline, with which holes, and which edge does a place choose?"""

from __future__ import annotations

import math

import pytest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.placing import lines_near, part_near, parts_of


def square(x: float, y: float, half: float, hole: bool = False) -> Loop:
    corners = [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)]
    corners = corners[::-1] if hole else corners
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), hole=hole)


def circle(x: float, y: float, radius: float, hole: bool = False) -> Loop:
    return Loop((Arc(x, y, radius, 0.0, -math.tau if hole else math.tau),), hole=hole)


OPEN = Loop((Line(-9.0, -9.0, 9.0, -9.0), Line(9.0, -9.0, 9.0, 9.0), Line(9.0, 9.0, -9.0, 9.0)), closed=False)


def test_holes_go_with_the_smallest_outline_around_them() -> None:
    """Not with open lines about them; a hole with nothing around it stands alone."""
    large, small = square(0.0, 0.0, 4.0), square(2.0, 0.0, 1.0)
    inner, outer = circle(2.0, 0.0, 0.5, True), circle(-2.0, 0.0, 0.5, True)
    far = square(20.0, 0.0, 1.0, True)
    loops = [OPEN, inner, large, outer, small, far]
    assert sorted(parts_of(loops)) == [(0,), (2, 3), (4, 1), (5,)]
    assert sorted(parts_of([*loops, circle(2.0, 0.7, 0.1, True)])) == [(0,), (2, 3), (4, 1, 6), (5,)]


@pytest.mark.parametrize("order", [1, -1])
def test_the_part_that_holds_the_place_or_is_nearest(order: int) -> None:
    """Clearly so where the next one is more than twice as far."""
    left, right = square(-2.0, 0.0, 1.0), circle(2.0, 0.0, 1.0)
    loops, chosen = [left, right][::order], [0, 1][::order]
    assert part_near(loops, (-1.5, 0.5)) == ((chosen[0],), True) and part_near(loops, (2.5, 0.0)) == ((chosen[1],), True)
    # Between -1 and 1 lies nothing: 0.6 from the one and 1.4 from the other, 0.7 and 1.3.
    assert part_near(loops, (-0.4, 0.0)) == ((chosen[0],), True) and part_near(loops, (0.4, 0.0)) == ((chosen[1],), True)
    assert part_near(loops, (-0.3, 0.0)) == ((chosen[0],), False)
    assert part_near([left], (9.0, 9.0)) == ((0,), True) and part_near([], (0.0, 0.0)) == ((), False)


def test_within_open_lines_nothing_is() -> None:
    """They are as near as their edges."""
    assert part_near([OPEN, square(0.0, 0.0, 1.0)], (0.0, 3.0)) == ((1,), True)
    assert part_near([OPEN, square(0.0, 0.0, 1.0)], (0.0, 8.5)) == ((0,), True)


@pytest.mark.parametrize(("aside", "count"), [(0.0, 2), (0.9e-8, 2), (1.1e-8, 1), (-0.9e-8, 2), (-1.1e-8, 1)])
def test_edges_that_a_place_cannot_tell_apart(aside: float, count: int) -> None:
    """On the diagonal of a corner both are equally near; from beside it, one is nearer by so much."""
    found = lines_near([square(0.0, 0.0, 1.0), circle(0.9, 0.9, 0.05)], (0.9 + aside, 0.9))
    assert len(found) == count
    nearest, fraction = found[0] if aside >= 0.0 or count == 2 else found[-1]
    assert fraction == pytest.approx(0.95 if nearest.start[0] == nearest.end[0] else 0.05, abs=1e-6)
    (bottom,) = lines_near([square(0.0, 0.0, 1.0)], (-0.5, -2.0))
    assert bottom[0].start == (-1.0, -1.0) and bottom[1] == pytest.approx(0.25)
