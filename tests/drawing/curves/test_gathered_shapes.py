"""Is every shape counted, measured and kept for what it is, on both sides of each limit?"""

from __future__ import annotations

import pytest

from watchsim.drawing.curves import _count, follow
from watchsim.drawing.projection import (
    MOST_STROKES,
    UNFOLDED,
    Conic,
    Dot,
    Gathering,
    Shape,
    Spline,
    Straight,
    TooLarge,
    circle,
    corner,
    emit,
    kind_of,
    most_strokes,
    reach,
    tilted,
)
from watchsim.drawing.splines import SAME
from watchsim.geometry.fitting import Fit
from watchsim.geometry.primitives import TURN, Arc, Line

MM = 1e-3


def bezier(*points: tuple[float, float, float]) -> Spline:
    return Spline(len(points) - 1, [0.0] * len(points) + [1.0] * len(points), list(points))


CURVE = bezier((0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (3.0, 0.0, 0.0))
OVAL = Conic((5.0, -7.0, 0.0), (3.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.0, TURN)


def gathered(*shapes: Shape, most: int = 1000) -> Gathering:
    found = Gathering(MM, 1e-6, most)
    for shape in shapes:
        emit(found, shape, "L", "it")
    return found


def test_each_shape_is_counted_as_what_it_is() -> None:
    line, arc = Straight((0.0, 0.0, 0.0), (3.0, 4.0, 0.0)), circle((1.0, 2.0, 0.0), 5.0, 0.0, 2.0)
    found = gathered(line, line, arc, circle((0.0, 0.0, 0.0), 1.0), OVAL, CURVE, Dot((7.0, 8.0, 9.0)))
    assert dict(found.kinds) == {"line": 2, "arc": 1, "circle": 1, "ellipse": 1, "spline": 1}
    assert [type(stroke.edge) for stroke in found.strokes] == [Line, Line, Arc, Arc]
    assert {(stroke.layer, stroke.source, stroke.run) for stroke in found.strokes} == {("L", "it", 0)}
    assert found.points == [("L", 7.0 * MM, 8.0 * MM)] and found.tilted == 0 and not found.findings
    assert found.drawn().length == pytest.approx(MM * (5.0 + 5.0 + 10.0 + TURN), rel=1e-14)


def test_what_has_no_length_is_kept_to_be_told_but_not_counted() -> None:
    found = gathered(Straight((1.0, 1.0, 0.0), (1.0, 1.0, 0.0)), circle((0.0, 0.0, 0.0), 0.0))
    assert not found.kinds and len(found.strokes) == 2
    assert gathered(Straight((1.0, 1.0, 0.0), (1.0, 1.001, 0.0))).kinds["line"] == 1  # a micrometre


def test_curves_wait_at_their_place_and_are_followed_in_order() -> None:
    line = Straight((0.0, 0.0, 0.0), (3.0, 4.0, 0.0))
    found = gathered(line, CURVE, OVAL, line, OVAL)
    assert [curve.before for curve in found.waiting] == [1, 1, 2]
    assert [curve.curves for curve in found.waiting] == [1, 1, 1]
    follow(found)
    assert not found.waiting and found.curves == 3
    lines = [k for k, stroke in enumerate(found.strokes) if isinstance(stroke.edge, Line)]
    assert lines[0] == 0 and 3 < lines[1] < len(found.strokes) - 3
    assert found.arcs == len(found.strokes) - 2 and 0.0 < found.deviation <= 1e-6
    first, second = found.strokes[1 : lines[1]], found.strokes[lines[1] + 1 :]
    for one, other in zip(first[-len(second) :], second, strict=True):  # the same oval
        assert one.edge.point(0.5) == pytest.approx(other.edge.point(0.5), rel=1e-9)


def test_what_a_curve_was_moved_is_taken_off_its_tolerance() -> None:
    found = Gathering(MM, 1e-6)
    emit(found, CURVE, "L", "it", 4, 3e-7)
    (curve,) = found.waiting
    assert curve.limit == pytest.approx(7e-7) and (curve.curves, curve.moved) == (4, 3e-7) and found.kinds["spline"] == 4
    follow(found)
    assert found.curves == 4 and 3e-7 < found.deviation <= 1e-6
    far = bezier((9e9, 0.0, 0.0), (9e9, 2.0, 0.0), (9e9 + 3.0, 0.0, 0.0))
    (rounded,) = gathered(far).waiting
    assert rounded.limit == pytest.approx(MM * 9e9 * 1e-11, rel=1e-6)  # a double holds no more so far out


def test_an_ellipse_seen_edge_on_is_told_at_its_centre() -> None:
    found = gathered(Conic((5.0, -7.0, 0.0), (3.0, 0.0, 0.0), (1.0, 0.0, 2.0), 0.0, TURN))
    (finding,) = found.findings
    assert (finding.code, finding.severity, finding.layer) == ("edge-on", "warning", "L")
    assert (finding.x_mm, finding.y_mm) == pytest.approx((5.0, -7.0)) and found.tilted == 1
    assert not found.strokes and not found.waiting and not found.kinds


@pytest.mark.parametrize("shape", [Straight((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), OVAL, CURVE], ids=["line", "oval", "spline"])
def test_a_drawing_may_hold_so_many_pieces_and_no_more(shape: Shape) -> None:
    gathered(*[shape] * 3, most=3)
    with pytest.raises(TooLarge):
        gathered(*[shape] * 4, most=3)


def test_a_curve_may_become_so_many_pieces_and_no_more() -> None:
    pieces = gathered(OVAL)
    follow(pieces)
    count = len(pieces.strokes)
    for most, fits in ((count, True), (count - 1, False)):
        found = gathered(OVAL, most=most)
        if fits:
            follow(found)
        else:
            with pytest.raises(TooLarge):
                follow(found)


def test_a_small_file_may_unfold_into_fewer_pieces_than_a_large_one() -> None:
    assert most_strokes(0) == UNFOLDED and most_strokes(1000) == UNFOLDED + 1000
    assert most_strokes(10 * MOST_STROKES) == MOST_STROKES


@pytest.mark.parametrize(("slope", "is_so"), [(0.0, False), (0.9e-6, False), (1.1e-6, True), (-1.1e-6, True), (2.0, True)])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_what_leaves_its_height_by_a_millionth_is_tilted(slope: float, is_so: bool, size: float) -> None:
    """Wherever it lies, and whichever of its parts climbs."""
    for x, y in ((3.0, 4.0), (-4.0, 3.0), (0.0, -5.0)):
        far, rise = (size * x, size * y), size * 5.0 * slope
        a, b = (7.0, -2.0, 40.0), (7.0 + far[0], -2.0 + far[1], 40.0 + rise)
        assert tilted(Straight(a, b)) is is_so and tilted(Straight(b, a)) is is_so
        assert tilted(bezier(a, (7.0 - far[0], -2.0, 40.0), b)) is is_so and tilted(bezier(a, b, a)) is is_so
        u, v = (*far, rise), (-far[1], far[0], 0.0)
        assert tilted(Conic(a, u, v, 0.0, TURN)) is is_so and tilted(Conic(a, v, u, 0.0, TURN)) is is_so


def test_a_narrow_ellipse_is_tilted_as_its_long_axis_is() -> None:
    for rise, is_so in ((1e-8, False), (4e-6, True)):
        for u, v in (((3.0, 0.0, 0.0), (0.0, 1e-3, rise)), ((0.0, 1e-3, rise), (3.0, 0.0, 0.0))):
            assert tilted(Conic((0.0, 0.0, 0.0), u, v, 0.0, TURN)) is is_so


@pytest.mark.parametrize(("share", "told"), [(0.5, False), (1.0 + 0.9 * SAME, False), (1.0 + 1.1 * SAME, True), (2.0, True)])
def test_a_curve_that_is_not_followed_within_its_tolerance_is_told(share: float, told: bool) -> None:
    """A copy of another curve may miss by its share more."""
    found = gathered(CURVE)
    (curve,) = found.waiting
    _count(found, curve, Fit((Arc(0.0, 0.0, 1.0, 0.0, 1.0), Line(0.0, 0.0, 1.0, 1.0)), share * curve.limit))
    assert [finding.code for finding in found.findings] == ["fit"] * told
    assert (found.curves, found.arcs) == (1, 1) and found.deviation == share * curve.limit


def test_the_first_point_and_the_reach_of_a_shape() -> None:
    line = Straight((1.0, -20.0, 99.0), (3.0, 4.0, 0.0))
    assert corner(line) == (1.0, -20.0, 99.0) and reach(line) == 20.0
    assert corner(OVAL) == (5.0, -7.0, 0.0) and reach(OVAL) == 10.0
    assert corner(CURVE) == (0.0, 0.0, 0.0) and reach(CURVE) == 3.0
    assert reach(Conic((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, -6.0, 0.0), 0.0, 1.0)) == 6.0
    assert reach(bezier((0.0, 0.0, 0.0), (-1.0, -8.0, 0.0), (3.0, 0.0, 0.0))) == 8.0


def test_a_whole_ellipse_is_no_arc() -> None:
    for sweep, kind in ((TURN, "ellipse"), (-TURN, "ellipse"), (TURN - 1e-9, "ellipse_arc"), (1.0, "ellipse_arc")):
        assert kind_of(Conic(OVAL.centre, OVAL.u, OVAL.v, 0.3, sweep)) == kind
    assert kind_of(CURVE) == "spline"
