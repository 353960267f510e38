"""What becomes of Béziers in a row: lines, splines that run through, circles, and nothing else?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import BSpline

from watchsim.drawing.curves import LONGEST, SAMPLES, bezier_points, circle_of, elevated, emit_row, joined, straightened
from watchsim.drawing.projection import Gathering, Spline, Straight
from watchsim.geometry.primitives import TURN, Arc

RNG = np.random.default_rng(3)
MM = 1e-3


def bezier(points: np.ndarray | Sequence[Sequence[float]]) -> Spline:
    count = len(points)
    return Spline(count - 1, [0.0] * count + [1.0] * count, [(float(x), float(y), 0.0) for x, y in points])


def curve_of(spline: Spline) -> BSpline:
    return BSpline(np.array(spline.knots), np.array(spline.points)[:, :2], spline.degree)


def cut(points: np.ndarray, shares: Sequence[float]) -> list[Spline]:
    """A Bézier cut at some parameters, by de Casteljau's rule."""
    made, done, rest = [], 0.0, points
    for share in shares:
        t, level, left, right = (share - done) / (1.0 - done), rest, [], []
        while len(level):
            left.append(level[0])
            right.append(level[-1])
            level = (1.0 - t) * level[:-1] + t * level[1:]
        made.append(bezier(np.array(left)))
        rest, done = np.array(right[::-1]), share
    return [*made, bezier(rest)]


def ring(
    count: int, radius: float, stretch: float = 1.0, turns: int = 1, shift: tuple[float, float] = (2.0, -1.0)
) -> list[Spline]:
    """Cubics round a circle; `stretch` makes their handles longer than those that meet it half-way."""
    step = TURN * turns / count
    pull = 4.0 / 3.0 * math.tan(0.25 * step) * stretch
    made = []
    for k in range(count):
        a, b = k * step, (k + 1) % count * step if turns == 1 else (k + 1) * step
        p, q = np.array([math.cos(a), math.sin(a)]), np.array([math.cos(b), math.sin(b)])
        made.append(
            bezier(shift + radius * np.array([p, p + pull * np.array([-p[1], p[0]]), q - pull * np.array([-q[1], q[0]]), q]))
        )
    return made


@pytest.mark.parametrize(
    "along",
    [
        (0.0, 4.0, 0.0),
        (0.0, 3.0, 1.0),
        (0.0, 5.0, -4.0, 1.0),
        (0.0, 0.0, 7.0, 0.0),
        (0.0, 1.0, 2.0, 9.0),
        (-1.0, 2.0, 2.0, -1.0, 3.0),
        (0.0, 9.0, -9.0, 9.0, -9.0, 0.0),
        (0.0, 2.0, 2.0, 0.0),
        (0.0, 11.0, 12.0),
        (0.0, 1.0, -1998.0),
    ],
    ids=str,
)
@pytest.mark.parametrize(("far", "size"), [(0.0, 1.0), (1e6, 1.0), (0.0, 1e-3)])
def test_a_straight_curve_is_the_lines_to_where_it_turns(along: tuple[float, ...], far: float, size: float) -> None:
    """As long as the way there and back is; on the line, from the first control point to the last."""
    along = tuple(size * x for x in along)
    for angle in (0.0, 0.9, 2.2):
        way = np.array([math.cos(angle), math.sin(angle)])
        base = far * np.array([-way[1], way[0]])
        curve = bezier(base + np.outer(along, way))
        lines = straightened(curve)
        assert all(isinstance(line, Straight) for line in lines)
        ends = np.array([lines[0].a, *(line.b for line in lines)])[:, :2]  # type: ignore[union-attr]
        dense = (curve_of(bezier(np.outer(along, [1.0, 0.0])))(np.linspace(0.0, 1.0, 20001)))[:, 0]
        assert np.sum(np.hypot(*np.diff(ends, axis=0).T)) == pytest.approx(np.sum(np.abs(np.diff(dense))), rel=1e-6)
        assert len(lines) == 1 + np.count_nonzero(np.diff(np.sign(np.diff(dense)[np.abs(np.diff(dense)) > 1e-9 * size])))
        assert np.allclose((ends - base) @ [-way[1], way[0]], 0.0, atol=1e-9 + 1e-15 * far)
        assert np.array_equal(ends[0], np.array(curve.points[0])[:2]) and np.array_equal(
            ends[-1], np.array(curve.points[-1])[:2]
        )


@pytest.mark.parametrize(("off", "is_so"), [(0.8e-9, True), (-0.8e-9, True), (1.2e-9, False), (-1.2e-9, False)])
@pytest.mark.parametrize("size", [1e-3, 1.0, 400.0])
def test_a_curve_is_straight_within_a_thousand_millionth_of_its_length(off: float, is_so: bool, size: float) -> None:
    for angle in (0.0, 0.7, 1.9, 4.0):
        turn = size * np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        for points in (
            [(0, 0), (0.3, off), (1, 0)],
            [(0, 0), (1, 0), (0.5, off), (0.2, 0)],
            [(0, 0), (0.2, 0), (0.5, off), (1, 0)],
        ):
            curve = bezier(np.array(points) @ turn)
            assert (straightened(curve) != (curve,)) is is_so


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 7])
def test_points_along_a_curve_are_those_of_its_polynomial(degree: int) -> None:
    curve = bezier(RNG.uniform(-5.0, 5.0, (degree + 1, 2)))
    expected = curve_of(curve)(np.arange(SAMPLES) / SAMPLES)
    assert bezier_points(curve) == pytest.approx(expected, abs=1e-12)


def test_a_quadratic_curve_is_a_cubic_one() -> None:
    for _ in range(4):
        curve = bezier(RNG.uniform(-5.0, 5.0, (3, 2)))
        t = np.linspace(0.0, 1.0, 9)
        assert elevated(curve).degree == 3 and curve_of(elevated(curve))(t) == pytest.approx(curve_of(curve)(t), abs=1e-12)
    for degree in (1, 3, 4):
        other = bezier(RNG.uniform(-5.0, 5.0, (degree + 1, 2)))
        assert elevated(other) is other


@pytest.mark.parametrize("shares", [(0.5,), (0.2, 0.5, 0.9), (0.01, 0.02), (0.3, 0.999)])
def test_a_curve_in_pieces_becomes_one_again(shares: tuple[float, ...]) -> None:
    for _ in range(3):
        points = RNG.uniform(-5.0, 5.0, (4, 2))
        (chain,) = joined(cut(points, shares), 1e-9)
        assert chain.curves == len(shares) + 1 and chain.moved < 1e-12 and chain.spline.degree == 3
        spline, t = curve_of(chain.spline), np.linspace(0.0, 1.0, 33)
        start, stop = chain.spline.knots[3], chain.spline.knots[-4]
        assert len(chain.spline.knots) == len(chain.spline.points) + 4
        assert spline(start + t * (stop - start)) == pytest.approx(curve_of(bezier(points))(t), abs=1e-9)
    quadratic = cut(RNG.uniform(-5.0, 5.0, (3, 2)), (0.4,))
    assert [chain.curves for chain in joined(quadratic, 1e-9)] == [2] and joined([], 1.0) == []


def meeting_curves(first: float, second: float, off: float = 0.0, bend: float = 0.0) -> list[Spline]:
    """Two cubics that meet at (0, off), with handles of these lengths along x."""
    before = bezier([(-9 * first, 4), (-5 * first, 4), (-first, 0), (0, off)])
    after = bezier([(0, off), (second, second * bend), (5 * second, 4), (9 * second, 4)])
    return [before, after]


@pytest.mark.parametrize("first", [1.0, 0.25])
def test_curves_that_meet_a_little_beside_their_handles_are_joined_within_the_slack(first: float) -> None:
    for second in (1.0, 3.0):
        row = meeting_curves(first, second, 1e-4)
        (chain,) = joined(row, 1.1e-4)
        assert chain.curves == 2 and chain.moved == pytest.approx(1e-4, rel=1e-6)
        assert [(part.curves, part.moved) for part in joined(row, 0.9e-4)] == [(1, 0.0), (1, 0.0)]
        assert [part.spline for part in joined(row, 0.9e-4)] == row
        assert len(joined(meeting_curves(first, second, 0.0, 0.5), 1e-3)) == 2  # a corner
    away = joined([*meeting_curves(1.0, 1.0, 1e-4), *meeting_curves(1.0, 1.0, 5e-5)], 1e-3)
    assert [(part.curves, round(part.moved, 9)) for part in away] == [(2, 1e-4), (2, 5e-5)]


def test_handles_of_no_length_or_of_very_unlike_length_end_a_spline() -> None:
    for ratio, count in ((0.9e6, 1), (1.1e6, 2)):
        assert len(joined(meeting_curves(1.0, ratio), 1e-9)) == count
        assert len(joined(meeting_curves(ratio, 1.0), 1e-9)) == count
    assert len(joined(meeting_curves(1.0, 0.0), 1.0)) == len(joined(meeting_curves(0.0, 1.0), 1.0)) == 2


def test_short_handles_are_handles() -> None:
    assert len(joined(meeting_curves(1e-3, 1.0), 1e-9)) == len(joined(meeting_curves(1.0, 1e-3), 1e-9)) == 1


def test_splines_grow_only_so_long() -> None:
    row = cut(np.array([(0.0, 0.0), (1.0, 2.0), (3.0, 2.0), (4.0, 0.0)]), [k / (LONGEST + 2) for k in range(1, LONGEST + 2)])
    assert [chain.curves for chain in joined(row, 1e-6)] == [LONGEST, 2]


@pytest.mark.parametrize(("off", "waiting"), [(0.8e-5, 1), (1.2e-5, 2)])
def test_a_hundredth_of_the_tolerance_is_the_slack_in_any_unit(off: float, waiting: int) -> None:
    for scale, tolerance in ((1e-3, 1e-6), (2.54e-2, 2.54e-5), (1.0, 1e-3)):
        found = Gathering(scale, tolerance)
        emit_row(found, meeting_curves(1.0, 1.0, off), "L", "it")
        assert len(found.waiting) == waiting and sum(curve.curves for curve in found.waiting) == 2
        assert max(curve.moved for curve in found.waiting) == (pytest.approx(off * scale) if waiting == 1 else 0.0)


def round_by(angles: Sequence[float], radius: float) -> list[Spline]:
    """Cubics on a circle about (2, -1) from angle to angle (degrees), forward and back."""
    made = []
    for a, b in pairwise(np.radians(angles).tolist()):
        pull = 4.0 / 3.0 * math.tan(0.25 * (b - a))
        p, q = np.array([math.cos(a), math.sin(a)]), np.array([math.cos(b), math.sin(b)])
        row = np.array([p, p + pull * np.array([-p[1], p[0]]), q - pull * np.array([-q[1], q[0]]), q])
        made.append(bezier((2.0, -1.0) + radius * row))
    return made


def test_joints_may_crowd_on_one_side_but_not_turn_back() -> None:
    crowded = [0.0, 5.0, 10.0, 20.0, 40.0, 120.0, 200.0, 280.0, 360.0]
    for angles in (crowded, crowded[::-1], np.linspace(0.0, 360.0, 421).tolist()):
        found = circle_of(round_by(angles, 3.0), MM)
        assert found is not None and math.copysign(1.0, found.arc.sweep) == math.copysign(1.0, angles[1] - angles[0])
        assert (found.arc.x, found.arc.y, found.arc.radius) == pytest.approx((2e-3, -1e-3, 3e-3), rel=1e-6)
    back = [0.0, 45.0, 90.0, 70.0, 135.0, 180.0, 225.0, 270.0, 315.0, 360.0]
    assert circle_of(round_by(back, 3.0), MM) is None and circle_of(round_by(back[::-1], 3.0), MM) is None


@pytest.mark.parametrize("count", [4, 5, 8])
@pytest.mark.parametrize("stretch", [1.0, 1.001, 0.999])
def test_a_ring_is_the_circle_through_its_joints(count: int, stretch: float) -> None:
    row = ring(count, 3.0, stretch)
    found = circle_of(row, MM)
    assert found is not None and found.arc.is_circle
    assert (found.arc.x, found.arc.y, found.arc.radius) == pytest.approx((2e-3, -1e-3, 3e-3), rel=1e-9)
    dense = MM * np.concatenate([curve_of(curve)(np.linspace(0.0, 1.0, 400)) for curve in row])
    worst = np.max(np.abs(np.hypot(*(dense - [found.arc.x, found.arc.y]).T) - found.arc.radius))
    assert worst * (1.0 - 1e-9) <= found.deviation <= 1.05 * worst
    assert found.arc.point(0.0) == pytest.approx(np.array(row[0].points[0][:2]) * MM, rel=1e-9)


def test_what_is_no_circle_is_none() -> None:
    assert circle_of(ring(4, 3.0, 1.01), MM) is None  # off by more than a thousandth
    assert circle_of(ring(8, 3.0, 1.0, 2), MM) is None  # twice round
    assert circle_of([bezier([(1, 1)] * 4)] * 3, MM) is None
    for scale in (1e-6, 1.0):
        assert circle_of(ring(4, 3.0), scale) is not None


@pytest.mark.parametrize(("radius", "kept"), [(1.0, True), (3.0, True), (4.2, False), (20.0, False)])
def test_a_ring_within_the_tolerance_is_a_circle_and_else_nearly_one(radius: float, kept: bool) -> None:
    """Four cubics leave their circle by 2.7e-4 of its radius; the tolerance is a micrometre."""
    found = Gathering(MM, 1e-6)
    emit_row(found, ring(4, radius), "L", "it")
    if kept:
        (stroke,) = found.strokes
        assert isinstance(stroke.edge, Arc) and stroke.edge.radius == pytest.approx(MM * radius, rel=1e-3)
        assert (found.kinds["spline"], found.curves, found.arcs, found.waiting) == (4, 4, 1, [])
        assert found.deviation == pytest.approx(2.73e-4 * MM * radius, rel=0.02)
        return
    (finding,) = found.findings
    assert (
        (finding.code, finding.severity, finding.layer) == ("near-circle", "notice", "L")
        and not found.strokes
        and found.waiting
    )
    assert (finding.x_mm, finding.y_mm) == pytest.approx((2.0, -1.0)) and f"radius {radius:g} mm" in finding.message
    leaves = float(finding.message.split(" by ")[1].split(" µm")[0])
    assert leaves == pytest.approx(0.273 * radius, rel=0.02)


def test_what_does_not_close_is_no_circle_and_far_away_rounding_counts() -> None:
    found = Gathering(MM, 1e-6)
    emit_row(found, ring(8, 1.0)[:7], "L", "it")
    assert not found.strokes and len(found.waiting) == 1
    for count, kept in ((4, False), (30, True)):  # leaves the circle by 0.3 µm, by 1.5 pm; 100 m away a nanometre is rounding
        found = Gathering(MM, 1e-12)
        emit_row(found, ring(count, 1.0, shift=(1e5, 0.0)), "L", "it")
        assert len(found.strokes) == kept
    near = Gathering(MM, 1e-12)
    emit_row(near, ring(30, 1.0), "L", "it")
    assert not near.strokes


def test_parabolas_in_the_plane_stay_in_it() -> None:
    found = Gathering(MM, 1e-6)
    emit_row(found, cut(np.array([(0.0, 0.0), (1.0, 2.0), (3.0, 0.0)]), (0.4,)), "L", "it")
    assert found.tilted == 0 and len(found.waiting) == 1


def test_lines_among_curves_keep_their_place() -> None:
    found = Gathering(MM, 1e-6)
    line = Straight((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    emit_row(found, [line, *meeting_curves(1.0, 1.0), line, bezier([(0, 0), (1, 1), (2, 2)]), *ring(4, 1.0)[:2]], "L", "it")
    assert len(found.strokes) == 3 and [curve.before for curve in found.waiting] == [1, 3]
    assert [curve.curves for curve in found.waiting] == [2, 2] and dict(found.kinds) == {"line": 3, "spline": 4}
