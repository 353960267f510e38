"""Is it told of every bore whether it lies in material, in none, or across an outline?"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.drawing.circles import lies
from watchsim.drawing.material import layer_roles
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line

MM = 1e-3


def disc(x: float, y: float, r: float, hole: bool = False) -> Loop:
    return Loop((Arc(MM * x, MM * y, MM * r, 0.3, -TURN if hole else TURN),), hole=hole)


def box(x0: float, y0: float, x1: float, y1: float) -> Loop:
    corners = [(MM * x0, MM * y0), (MM * x1, MM * y0), (MM * x1, MM * y1), (MM * x0, MM * y1)]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))


RING = (disc(0, 0, 5), disc(0, 0, 2, hole=True))
TARGET = (*RING, disc(0, 0, 1))  # with an island in its hole


def test_a_bore_in_material_is_taken() -> None:
    for bore in (disc(3.5, 0, 0.5), disc(3.5, 0, 0.5, hole=True), disc(0, 0, 0.5)):
        (lie,) = lies([bore], TARGET)
        assert lie.taken and lie.depth == 1


@pytest.mark.parametrize(("bore", "holes"), [(disc(9, 0, 1), 0), (disc(1.5, 0, 0.3), 1), (disc(5, 5, 1), 0)])
def test_a_bore_where_nothing_is_is_clear_but_not_taken(bore: Loop, holes: int) -> None:
    (lie,) = lies([bore], TARGET)
    assert lie.clear and not lie.taken and (lie.depth, lie.holes) == (0, holes)


@pytest.mark.parametrize("shift", [0.0, 5e-6, -5e-6], ids=lambda shift: f"{shift:g} mm")
@pytest.mark.parametrize("wider", [0.0, 5e-7, -5e-7, 2e-6, -2e-6], ids=lambda wider: f"by {wider:g} mm")
def test_a_bore_in_the_place_of_a_hole_lies_in_it_whatever_rounding_did(shift: float, wider: float) -> None:
    for hole in (False, True):
        (lie,) = lies([disc(shift, 0, 2 + wider, hole)], RING)
        assert lie.clear and (lie.outlines, lie.holes) == (1, 1)


@pytest.mark.parametrize(("inside", "taken"), [(-2e-5, False), (0.0, False), (0.5e-5, False), (1.5e-5, True), (0.01, True)])
def test_a_bore_as_large_as_the_outline_around_it_leaves_nothing(inside: float, taken: bool) -> None:
    """Ten nanometres of material are rounding; a hundredth of a millimetre is a ring."""
    (lie,) = lies([disc(0, 0, 5 - inside)], [disc(0, 0, 5)])
    assert lie.taken is taken and (lie.around is None) is taken and lie.crosses is None


def test_what_crosses_among_the_outlines_or_within_a_bore_is_no_matter_of_bores() -> None:
    (lie,) = lies([disc(-2, 0, 1)], [disc(0, 0, 5), disc(8, 0, 5)])
    assert lie.taken
    corners = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 1.5)]
    tie = Loop(
        tuple(Line(MM * a, MM * b, MM * c, MM * d) for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1], strict=True))
    )
    (lie,) = lies([tie], [disc(0, 0, 5)])
    assert lie.clear


def test_touching_is_no_crossing() -> None:
    plate = [box(0, 0, 4, 2)]
    slot, notch, round_one, beside = box(1, 0, 2, 1), box(3, 0, 4, 2), disc(2.5, 1.5, 0.5), disc(-0.5, 1, 0.5)
    found = lies([slot, notch, round_one, beside], plate)
    assert [lie.taken for lie in found] == [True, True, True, False]
    assert all(lie.clear for lie in found)


def test_a_crossing_is_told_with_its_place() -> None:
    (lie,) = lies([disc(5, 0, 3)], [disc(0, 0, 5)])
    assert lie.crosses is not None and not lie.clear
    x = 5.0 - 0.9  # two circles of 5 and 3 mm, centres 5 mm apart
    assert lie.crosses[0] == pytest.approx(MM * x, rel=1e-12)
    assert abs(lie.crosses[1]) == pytest.approx(MM * math.sqrt(25.0 - x * x), rel=1e-12, abs=0.0)


def test_a_bore_round_a_hole_or_an_island_is_not_clear() -> None:
    (round_hole,), (round_island,), (round_all,) = (lies([disc(0, 0, r)], TARGET) for r in (3.0, 1.5, 7.0))
    assert round_hole.around in TARGET[1:] and round_island.around == TARGET[2] and round_all.around in TARGET
    assert not (round_hole.clear or round_island.clear or round_all.clear)
    (instead,) = lies([disc(0, 0, 5)], [disc(0, 0, 5)])
    assert instead.around is not None


def test_bores_in_bores_and_across_bores() -> None:
    found = lies([disc(0, 0, 1), disc(0.2, 0, 0.5), disc(0, 0, 1), disc(3, 0, 0.5), disc(3.6, 0, 0.5)], [disc(0, 0, 9)])
    assert [lie.taken for lie in found] == [True, False, False, True, False]
    assert [lie.within for lie in (found[0], found[2], found[3])] == [None, 0, None] and found[1].within in (0, 2)
    assert found[4].meets is not None and found[4].meets[0] == 3
    assert found[4].meets[1][0] == pytest.approx(3.3 * MM, rel=1e-12)


def test_two_outlines_above_each_other_are_counted() -> None:
    (lie,) = lies([disc(0, 0, 1)], [disc(0, 0, 5), disc(1, 0, 5)])
    assert lie.depth == 2 and not lie.taken


def test_no_bores_need_no_plate() -> None:
    assert lies([], RING) == []
    assert lies([disc(0, 0, 1)], [])[0].depth == 0


@given(st.floats(-7, 7), st.floats(-7, 7), st.floats(0.05, 6))
def test_circles_in_a_ring_are_sorted_by_their_distances(x: float, y: float, r: float) -> None:
    """Against the plain inequalities of circles, for bores that do not just touch."""
    far = math.hypot(x, y)
    gaps = [abs(far - abs(R - r)) for R in (2.0, 5.0)] + [abs(far - (R + r)) for R in (2.0, 5.0)]
    if min(gaps) < 1e-3:
        return
    (lie,) = lies([disc(x, y, r)], RING)
    crosses = any(abs(R - r) < far < R + r for R in (2.0, 5.0))
    inside, in_hole, round_hole = far + r < 5.0, far + r < 2.0, far + 2.0 < r
    assert (lie.crosses is not None) == crosses
    if not crosses:
        assert lie.taken == (inside and not in_hole and not round_hole)
        assert (lie.around is not None) == (round_hole or far + 5.0 < r)


def test_a_layer_called_a_pivot_is_a_mark_only_while_it_holds_circles_alone() -> None:
    """An arbor drawn with a square is a part; bores are bores whatever their outline; alone, marks are the parts."""
    part, mark, square = (
        replace(one, layer=name)
        for one, name in ((box(0, 0, 9, 9), "PART"), (disc(1, 1, 1), "PIVOT"), (box(3, 3, 4, 4), "PIVOT"))
    )
    half = Loop((Arc(0.0, 0.0, MM, 0.0, math.pi), Line(-MM, 0.0, MM, 0.0)), "PIVOT")
    bore = replace(box(5, 5, 6, 6), layer="BORES")
    assert layer_roles([part, mark, bore]) == {"PART": "material", "PIVOT": "mark", "BORES": "bore"}
    for other in ([square], [mark, square], [square, mark], [half]):
        assert layer_roles([part, *other]) == {"PART": "material", "PIVOT": "material"}
    assert layer_roles([mark]) == {"PIVOT": "material"}
