"""Are ellipses cut at the ends of their axes, splines at their corners, and do made-up knots draw what was meant?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicSpline

from watchsim.drawing.curves import SLIVER, axis_cuts, ellipses_edges, mirrored, rational
from watchsim.drawing.dxf_records import DxfError
from watchsim.drawing.projection import Conic, Spline
from watchsim.drawing.splines import (
    _bezier_spans,
    around,
    cleaned,
    corners,
    pieces_of,
    polygon_edges,
    smooth,
    spline_from,
    splines_edges,
    through,
    uniform,
)
from watchsim.geometry.primitives import TURN, Arc, Line

RNG = np.random.default_rng(5)
QUARTER = 0.25 * TURN


def on(conic: Conic, t: np.ndarray | float) -> np.ndarray:
    c, u, v = (np.array(one[:2]) for one in (conic.centre, conic.u, conic.v))
    return c + np.cos(t)[..., None] * u + np.sin(t)[..., None] * v


@pytest.mark.parametrize(
    ("u", "v"), [((3.0, 1.0), (-0.5, 1.0)), ((1.0, 0.2), (2.0, 3.0)), ((2.0, 0.0), (0.0, 1.0)), ((0.3, -2.0), (1.0, 1.0))]
)
@pytest.mark.parametrize(("start", "sweep"), [(0.1, TURN), (-2.0, 4.0), (1.0, 0.3), (5.0, 3.2)])
def test_an_ellipse_is_cut_where_it_is_nearest_to_its_centre_and_farthest(
    u: tuple, v: tuple, start: float, sweep: float
) -> None:
    conic = Conic((5.0, -3.0, 0.0), (*u, 0.0), (*v, 0.0), start, sweep)
    first, cuts = axis_cuts(conic)
    t = np.linspace(start, start + sweep, 200001)
    far = np.hypot(*(on(conic, t) - [5.0, -3.0]).T)
    turning = t[1:-1][(np.diff(far)[1:] > 0.0) != (np.diff(far)[:-1] > 0.0)]
    kept = turning[(turning > start + SLIVER) & (turning < start + sweep - SLIVER)]
    assert (cuts[0], cuts[-1]) == (start, start + sweep) and cuts[1:-1] == pytest.approx(kept, abs=1e-4)
    assert abs(math.remainder(first - (turning if len(turning) else np.array([first]))[0], QUARTER)) < 1e-4


@pytest.mark.parametrize(("past", "cut"), [(0.9 * SLIVER, False), (1.1 * SLIVER, True)])
def test_no_sliver_is_cut_off_at_an_end(past: float, cut: bool) -> None:
    for start, stop in ((-past, 1.0), (QUARTER - 1.0, QUARTER + past), (0.5, TURN + past)):
        cuts = axis_cuts(Conic((0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (0.0, 1.0, 0.0), start, stop - start))[1]
        inner = [k * QUARTER for k in range(-1, 6) if start + SLIVER < k * QUARTER < stop - SLIVER]
        near = [c for c in (0.0, QUARTER, TURN) if min(abs(c - start), abs(c - stop)) == pytest.approx(past)]
        assert cuts[1:-1] == pytest.approx(inner) and (near[0] in inner) is cut


@pytest.mark.parametrize(("low", "high"), [(0.0, QUARTER), (0.3, 1.2), (-1.0, -0.2), (4.0, 4.1)])
def test_a_part_of_an_ellipse_is_a_rational_parabola(low: float, high: float) -> None:
    a, b = np.array([3.0, 1.0]), np.array([-0.5, 1.5])
    curve = rational(a, b, low, high)
    (p0, p1, p2), t = curve.control[0], np.linspace(0.0, 1.0, 11)[:, None]
    whole = (1 - t) ** 2 * p0 + 2 * t * (1 - t) * p1 + t**2 * p2
    inner = np.linalg.solve(np.column_stack((a, b)), (whole[:, :2] / whole[:, 2:]).T)
    assert np.hypot(*inner) == pytest.approx(np.ones(11), rel=1e-13, abs=0.0)
    assert np.arctan2(inner[1], inner[0])[[0, -1]] == pytest.approx(
        [math.remainder(low, TURN), math.remainder(high, TURN)], rel=1e-12, abs=1e-15
    )
    assert curve.breaks.tolist() == [0.0, 1.0]


def test_an_edge_mirrored_loses_its_part_along_an_axis() -> None:
    for axis in (np.array([3.0, 4.0]), np.array([-1.0, 0.2])):
        unit = axis / np.hypot(*axis)
        for edge in (Line(1.0, 2.0, -3.0, 0.5), Arc(1.0, 2.0, 3.0, 0.4, 1.3)):
            for share in (0.0, 0.5, 1.0):
                p = np.array(edge.point(share))
                assert mirrored(edge, axis).point(share) == pytest.approx(p - 2.0 * (p @ unit) * unit, abs=1e-12)


@pytest.mark.parametrize(("start", "sweep"), [(0.0, TURN), (0.7, TURN), (0.2, 4.0), (-QUARTER, 2 * QUARTER), (2.0, 0.4)])
def test_arcs_follow_an_ellipse_from_its_start_to_its_end(start: float, sweep: float) -> None:
    turned = np.array([[math.cos(0.6), math.sin(0.6)], [-math.sin(0.6), math.cos(0.6)]])
    u, v = (np.array([4.0, 0.0]) @ turned).tolist(), (np.array([0.0, 2.5]) @ turned).tolist()
    conics = [Conic((x, 1.0, 0.0), (*u, 0.0), (*v, 0.0), start, sweep) for x in (2.0, -7.0)]
    fits = ellipses_edges(conics, 1e-3, [1e-6, 1e-5])
    assert len(fits[0].edges) > len(fits[1].edges) - (sweep < 1.0)
    for conic, fit, tolerance in zip(conics, fits, (1e-6, 1e-5), strict=True):
        ends = 1e-3 * on(conic, np.array([start, start + sweep]))
        assert fit.edges[0].start == pytest.approx(ends[0], abs=2e-9) and fit.edges[-1].end == pytest.approx(ends[1], abs=2e-9)
        dense = np.array([edge.point(share) for edge in fit.edges for share in np.linspace(0.0, 1.0, 60).tolist()])
        local = np.linalg.solve(np.column_stack((u, v)), (1e3 * dense - np.array(conic.centre[:2])).T)
        angles = np.unwrap(np.arctan2(local[1], local[0]))
        gap = 1e-3 * np.hypot(*((np.hypot(*local) - 1.0) * local / np.hypot(*local)).T[:, ::1].T) * 2.5
        assert gap.max() <= 1.05 * tolerance and fit.deviation <= tolerance
        assert np.all(np.diff(angles) > -1e-6) and angles[-1] - angles[0] == pytest.approx(sweep, abs=1e-4)
        assert all(math.dist(a.end, b.start) < 1e-12 for a, b in pairwise(fit.edges))


@pytest.mark.parametrize("count", [3, 4, 7])
def test_a_spline_round_through_points_is_the_periodic_one(count: int) -> None:
    """Against scipy's, with the chords as parameter; a point that is given twice is one."""
    points = RNG.uniform(-3.0, 3.0, (count, 3))
    once = [tuple(p) for p in points.tolist()]
    cubic = through([*once[:2], once[1], *once[2:]], (), True)
    ring = np.vstack((points, points[:1]))
    s = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1)))
    truth = CubicSpline(s, ring, bc_type="periodic")
    spline = BSpline(np.array(cubic.knots), np.array(cubic.points), cubic.degree)
    t = np.linspace(0.0, s[-1], 50)
    assert spline(t) == pytest.approx(truth(t), abs=1e-9)
    assert len(cubic.knots) == len(cubic.points) + 4 and around(once) == cubic
    twice = [*once, once[0], (9.0, 9.0, 0.0)]  # comes by its first point once more before it ends
    assert through(twice, (), True) == around(twice)


def test_what_is_not_round_runs_from_end_to_end() -> None:
    p = [(0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (3.0, 1.0, 0.0)]
    for points, closed in ((p, False), ([*p, p[0]], True), (p[:2], True)):
        cubic = through(points, (), closed)
        ends = [*points[0], *points[-1]]
        assert [*cubic.points[0], *cubic.points[-1]] == pytest.approx(ends, rel=1e-12, abs=1e-15)
    assert (
        through(p, (), True).points[-1] == pytest.approx(p[0])
        or through(p, (), True).points[0] == through(p, (), True).points[-1]
    )
    for few in ([], p[:1]):
        with pytest.raises(DxfError, match="at least two fit points"):
            through(few, (), False)


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_made_up_knots_are_clamped_or_run_round(degree: int) -> None:
    points = [tuple(p) for p in RNG.uniform(-3.0, 3.0, (degree + 4, 3)).tolist()]
    weights = RNG.uniform(1.0, 2.0, degree + 4).tolist()
    knots, same, kept = uniform(degree, False, points, weights)
    assert (same, kept) == (points, weights) and np.all(np.diff(knots[degree:-degree]) == 1.0)
    spline = BSpline(np.array(knots), np.array(points), degree)
    assert spline(knots[0]) == pytest.approx(points[0]) and spline(knots[-1]) == pytest.approx(points[-1])
    knots, wrapped, more = uniform(degree, True, points, weights)
    assert (
        wrapped == points + points[:degree]
        and more == weights + weights[:degree]
        and uniform(degree, True, points, ())[2] == []
    )
    spline = BSpline(np.array(knots), np.array(wrapped), degree)
    start, stop = knots[degree], knots[-degree - 1]
    assert stop - start == len(points) and np.all(np.diff(knots) == 1.0)
    for order in range(degree):
        assert spline(start, order) == pytest.approx(spline(stop, order), abs=1e-9)
    few = uniform(degree, False, points[: degree + 1], ())
    assert few[0] == [0.0] * (degree + 1) + [1.0] * (degree + 1)
    assert few[0] == uniform(degree, False, points[:degree], ())[0]


def test_knots_that_differ_by_rounding_are_the_same_and_those_that_fall_are_refused() -> None:
    for scale in (1e-3, 1.0, 1e5):
        given = [scale * k for k in (0.0, 0.0, 0.8e-9, 5.0, 5.0 + 1.2e-9, 10.0, 10.0 - 0.8e-9)]
        assert cleaned(given) == [given[0], given[0], given[0], given[3], given[4], given[5], given[5]]
        with pytest.raises(DxfError, match="do not ascend"):
            cleaned([scale * k for k in (0.0, 5.0, 5.0 - 1.2e-9, 10.0)])


@pytest.mark.parametrize(
    ("change", "fits"),
    [
        *(({}, True), ({"degree": 0}, False), ({"degree": 4}, False), ({"knots": [0.0] * 4 + [1.0] * 3}, False)),
        *(
            ({"knots": [0.0] * 5 + [1.0] * 4}, False),
            ({"weights": [1.0] * 3}, False),
            ({"weights": [1.0, 1.0, 1.0, 0.0]}, False),
        ),
        *(
            ({"weights": [1.0, 1.0, 1.0, 0.9e9]}, True),
            ({"weights": [1.0, 1.0, 1.0, 1.1e9]}, False),
            ({"weights": [-1.0] * 4}, False),
        ),
        *(({"knots": [0.0] * 8}, False), ({"knots": []}, True), ({"knots": [0.0] * 3 + [1.0] * 5}, False)),
        *(({"knots": [0.0] * 4 + [1.0, 1.0, 1.0, 2.0]}, True), ({"knots": [-1.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]}, False)),
    ],
)
def test_what_makes_a_spline(change: dict, fits: bool) -> None:
    parts = {"degree": 3, "closed": False, "knots": [0.0] * 4 + [1.0] * 4, "weights": [], "fit_points": []}
    parts["points"] = [(0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (3.0, 2.0, 0.0), (4.0, 0.0, 0.0)]
    if fits:
        assert spline_from(**{**parts, **change}).degree == 3
    else:
        with pytest.raises(DxfError):
            spline_from(**{**parts, **change})


@pytest.mark.parametrize(("degree", "fits"), [(24, True), (25, False)])
def test_degrees_beyond_two_dozen_are_refused(degree: int, fits: bool) -> None:
    points = [(float(k), float(k % 2), 0.0) for k in range(degree + 1)]
    if fits:
        assert spline_from(degree, False, [], [], points, []).degree == degree
    else:
        with pytest.raises(DxfError, match="its degree is 25"):
            spline_from(degree, False, [], [], points, [])


def test_splines_are_cut_where_a_knot_is_as_often_there_as_the_degree() -> None:
    """Splines of several degrees together, weighted or not; every piece lies on its own spline."""
    rows = [
        (2, [0, 0, 0, 1, 2, 2, 3, 3, 3]),
        (3, [0, 0, 0, 0, 1, 1, 2, 2, 2, 3, 3, 3, 3]),
        (2, [0, 0, 0, 1, 1, 1]),
        (3, [0, 1, 2, 3, 4, 5, 6, 7, 8]),
    ]
    splines = []
    for degree, knots in rows:
        count = len(knots) - degree - 1
        weights = [] if degree == 2 and count == 3 else RNG.uniform(1.0, 2.0, count).tolist()
        splines.append(
            Spline(degree, [float(k) for k in knots], [tuple(p) for p in RNG.uniform(-3, 3, (count, 3)).tolist()], weights)
        )
    cut = pieces_of(splines, 1e-3)
    assert [[piece.breaks.tolist() for piece in row] for row in cut] == [
        *([[0, 1, 2], [2, 3]], [[0, 1, 2], [2, 3]], [[0, 1]], [[3, 4, 5]]),
    ]
    for spline, row in zip(splines, cut, strict=True):
        weights = np.array(spline.weights or [1.0] * len(spline.points))[:, None]
        whole = BSpline(
            np.array(spline.knots), np.hstack((1e-3 * np.array(spline.points)[:, :2] * weights, weights)), spline.degree
        )
        for piece in row:
            for (low, high), control in zip(pairwise(piece.breaks.tolist()), piece.control, strict=True):
                n = spline.degree
                for t in (0.0, 0.3, 1.0):
                    p = sum(math.comb(n, k) * t**k * (1 - t) ** (n - k) * control[k] for k in range(n + 1))
                    q = whole(min(low + t * (high - low), high - 1e-13))
                    assert p[:2] / p[2] == pytest.approx(q[:2] / q[2], abs=1e-12)


def test_points_lines_and_curves_in_one_go() -> None:
    at_once = [
        Spline(3, [0.0] * 4 + [1.0] * 4, [(2.0, 5.0, 0.0)] * 4),
        Spline(1, [0.0, 0.0, 1.0, 1.0], [(2.0, 5.0, 0.0), (4.0, 6.0, 0.0)]),
        Spline(3, [0.0] * 4 + [1.0] * 4, [(0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (3.0, 2.0, 0.0), (4.0, 0.0, 0.0)]),
    ]
    (point, no), (line, neither), (fit, fitted) = splines_edges(at_once, 1e-3, [1e-6] * 3)
    assert point.edges == (Line(2e-3, 5e-3, 2e-3, 5e-3),) and line.edges == (Line(2e-3, 5e-3, 4e-3, 6e-3),)
    assert (no, neither, fitted) == (False, False, True) and all(isinstance(edge, Arc) for edge in fit.edges)
    assert 0.0 < fit.deviation <= 1e-6 and point.deviation == line.deviation == 0.0
    assert fit.edges[0].start == pytest.approx((0.0, 0.0), abs=1e-9) and fit.edges[-1].end == pytest.approx(
        (4e-3, 0.0), abs=1e-9
    )


def test_powers_become_control_points() -> None:
    s = np.array([0.0, 0.7, 2.0, 2.5])
    curve = CubicSpline(s, RNG.uniform(-2.0, 2.0, (4, 2)))
    for span, control in enumerate(_bezier_spans(curve.c, np.diff(s))):
        assert np.all(control[:, 2] == 1.0)
        for t in (0.0, 0.4, 1.0):
            p = sum(math.comb(3, k) * t**k * (1 - t) ** (3 - k) * control[k, :2] for k in range(4))
            assert p == pytest.approx(curve(s[span] + t * (s[span + 1] - s[span])), abs=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1.0])
def test_the_rise_over_the_longer_side_tells_corners_from_facets(unit: float) -> None:
    """An arc that turns by φ over a chord of length l rises by l φ / 8; half the tolerance is allowed."""
    for turn in (0.01, -0.05):
        for one, other in ((1.0, 1.0), (1.0, 0.3), (0.3, 1.0)):
            points = unit * np.array([(-one, 0.0), (0.0, 0.0), (other * math.cos(turn), other * math.sin(turn))])
            rise = unit * max(one, other) * abs(turn) / 8.0
            assert corners(points, 2.02 * rise) == [0, 2] and corners(points, 1.98 * rise) == [0, 1, 2]
    for degrees, sharp in ((9.9, False), (10.1, True), (-10.1, True), (120.0, True)):
        t = math.radians(degrees)
        points = unit * np.array([(-1.0, 0.0), (0.0, 0.0), (math.cos(t), math.sin(t))])
        assert (corners(points, 9.0 * unit) == [0, 1, 2]) is sharp


@pytest.mark.parametrize(("facets", "fitted"), [(7, False), (8, True), (30, True)])
def test_eight_fine_facets_are_a_curve(facets: int, fitted: bool) -> None:
    t = np.linspace(0.3, 0.3 + 0.002 * facets, facets + 1)
    points = 5e-3 * np.column_stack((np.cos(t), np.sin(t)))
    doubled = np.repeat(points, 2, axis=0)  # points that were written twice
    for given in (points, doubled):
        fit, is_so = polygon_edges(given, 1e-6)
        assert is_so is fitted and (len(fit.edges) == facets) is not fitted
        assert fit.edges[0].start == pytest.approx(points[0], abs=1e-9) and fit.edges[-1].end == pytest.approx(
            points[-1], abs=1e-9
        )
        sagitta = 5e-3 * (1.0 - math.cos(0.001))
        assert fit.deviation == (pytest.approx(sagitta, rel=1e-4, abs=0.0) if fitted else 0.0) and fit.deviation <= 1e-6
    swing = smooth(points, 1e-6)
    assert swing is not None and swing.deviation >= 0.9 * sagitta
