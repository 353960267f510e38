"""Do arcs follow curves within the tolerance, smoothly, and with nearly the fewest arcs possible?"""

import math
from itertools import pairwise

import numpy as np
import pytest
from curves import Known, involute, least_arcs, quarter_ellipse, smooth, spiral, spline
from hypothesis import given
from hypothesis import strategies as st
from naive.fewest_arcs import fewest_arcs
from numpy.polynomial import Polynomial
from scipy.interpolate import BPoly, BSpline

from watchsim.geometry import fitting as smooth_of_smooth_parts
from watchsim.geometry.biarcs import PAUSE, Bundle, Curve, arc_from, arcs_from, beziers, biarc_joints
from watchsim.geometry.fitting import Fit, bend, cut_at, fit_all, fit_arcs, jumps, pauses, slowest, smooth_parts
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.recognition import parts_of, whole_circle

KNOTS = [0, 0, 0, 0, 1, 2, 3, 3, 3, 3]
CURVES = {
    "quarter ellipse": quarter_ellipse(5e-3, 2e-3),
    "cubic": spline(3, [0] * 4 + [1] * 4, 1e-3 * np.array([(0, 0), (1, 3), (4, 3), (5, -1)])),
    "cubic with inflection": spline(3, [0] * 4 + [1] * 4, 1e-3 * np.array([(0, 0), (3, 0), (2, 4), (5, 4)])),
    "three spans": spline(3, KNOTS, 1e-3 * np.array([(0, 0), (1, 2), (3, 2), (4, -1), (6, 0), (7, 2)])),
    "involute": involute(1e-3, 0.5, 2.0),
}


def true_distance(curve: Known, fit: Fit, low: float, high: float) -> float:
    """Brute force: the largest of the distances of dense curve points to the nearest edge, ends of edges respected."""
    points = curve.points(np.linspace(low, high, 6001))
    nearest = np.full(len(points), np.inf)
    for edge in fit.edges:
        ends = np.array([edge.start, edge.end])
        gap = np.min(np.hypot(*(points[:, None] - ends[None]).transpose(2, 0, 1)), axis=1)
        if isinstance(edge, Arc):
            dx, dy = points[:, 0] - edge.x, points[:, 1] - edge.y
            along = np.mod((np.arctan2(dy, dx) - edge.start_angle) * math.copysign(1.0, edge.sweep), 2 * math.pi)
            gap = np.where(along <= abs(edge.sweep), np.abs(np.hypot(dx, dy) - edge.radius), gap)
        else:
            tx, ty = edge.tangent(0.0)
            dx, dy = points[:, 0] - edge.x0, points[:, 1] - edge.y0
            inside = (dx * tx + dy * ty >= 0.0) & (dx * tx + dy * ty <= edge.length)
            gap = np.where(inside, np.abs(dy * tx - dx * ty), gap)
        nearest = np.minimum(nearest, gap)
    return float(np.max(nearest))


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 1e-8])
def test_bound_holds_and_is_sharp(name: str, tolerance: float) -> None:
    curve = CURVES[name]
    low, high = float(curve.breaks[0]), float(curve.breaks[-1])
    fit = fit_arcs(curve, tolerance)
    measured = true_distance(curve, fit, low, high)
    assert measured <= fit.deviation * (1.0 + 1e-9) <= tolerance * (1.0 + 2e-9)
    assert fit.deviation == pytest.approx(measured, rel=0.03)
    for one, other in pairwise(fit.edges):
        assert math.dist(one.end, other.start) < 1e-15
        assert math.dist(one.tangent(1.0), other.tangent(0.0)) < 1e-9
    p, q = curve.points(np.array([low, high]))
    ways = curve.slopes(np.array([low, high]))
    assert fit.edges[0].start == pytest.approx(p, abs=1e-16) and fit.edges[-1].end == pytest.approx(q, abs=1e-16)
    assert fit.edges[0].tangent(0.0) == pytest.approx(ways[0] / np.hypot(*ways[0]), abs=1e-9)
    assert fit.edges[-1].tangent(1.0) == pytest.approx(ways[1] / np.hypot(*ways[1]), abs=1e-9)


@pytest.mark.parametrize("name", CURVES)
def test_number_of_arcs_against_the_best_biarcs_and_the_limit(name: str) -> None:
    """All biarcs with the curve's tangents on a fine grid, by dynamic programming; and the limit for chains of any kind."""
    curve, tolerance = CURVES[name], 1e-7
    grid = np.linspace(curve.breaks[0], curve.breaks[-1], 401)
    count = len(fit_arcs(curve, tolerance).edges)
    assert count <= fewest_arcs(lambda t: curve.points(t) @ np.array([1.0, 1.0j]), grid, tolerance)
    # Taking the curve's tangent at both ends costs an arc or two.
    assert count <= 1.2 * least_arcs(curve, tolerance) + 2.0


@pytest.mark.parametrize("name", CURVES)
def test_number_of_arcs_grows_with_the_cube_root(name: str) -> None:
    """Slope of the logarithms, and for small tolerances nearly the least number that is possible."""
    tolerances = 1e-8 / 8.0 ** np.arange(5)
    counts = [len(fit_arcs(CURVES[name], float(tolerance)).edges) for tolerance in tolerances]
    slope = np.polyfit(np.log(tolerances), np.log(counts), 1)[0]
    assert slope == pytest.approx(-1.0 / 3.0, rel=0.05)
    least = least_arcs(CURVES[name], float(tolerances[-1]))
    assert 0.99 * least <= counts[-1] <= 1.12 * least


@pytest.mark.slow
def test_many_curves_at_once_are_followed_like_each_alone() -> None:
    """Of several degrees, with and without weights and cusps, with different tolerances."""
    rng = np.random.default_rng(3)
    curves = [*CURVES.values(), spiral(2e-3, 1e-2, 1.5), involute(1e-3, 0.0, 1.0)]
    for _ in range(25):
        points = 1e-3 * rng.uniform(-1.0, 1.0, (4, 2))
        curves.append(spline(3, [0] * 4 + [1] * 4, points))
        curves.append(spline(3, [0] * 4 + [1] * 4, points, rng.uniform(0.2, 5.0, 4).tolist()))
        curves.append(spline(3, [0] * 4 + [1] * 4, points[[0, 0, 2, 3]]))
        curves.append(spline(2, [0] * 3 + [1] * 3, points[:3]))
    tolerances = (1e-7 * 10.0 ** rng.uniform(-1.0, 1.0, len(curves))).tolist()
    for curve, tolerance, fit in zip(curves, tolerances, fit_all(curves, tolerances), strict=True):
        # Places beside others are rounded otherwise, which may just tip the scales.
        assert abs(len(fit.edges) - len(fit_arcs(curve, tolerance).edges)) <= 1
        measured = true_distance(curve, fit, float(curve.breaks[0]), float(curve.breaks[-1]))
        assert measured <= fit.deviation * (1.0 + 1e-6) + 1e-15 and fit.deviation <= tolerance


@pytest.mark.slow
def test_very_many_curves_are_followed_with_a_few_more_arcs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The shorter search keeps the tolerance just as well."""
    rng = np.random.default_rng(4)
    curves = [spline(3, [0] * 4 + [1] * 4, 1e-3 * rng.uniform(-1.0, 1.0, (4, 2))) for _ in range(100)]
    thorough = fit_all(curves, [1e-7] * len(curves))
    monkeypatch.setattr("watchsim.geometry.fitting.MANY_SPANS", len(curves) - 1)
    brisk = fit_all(curves, [1e-7] * len(curves))
    for curve, fit in zip(curves, brisk, strict=True):
        measured = true_distance(curve, fit, float(curve.breaks[0]), float(curve.breaks[-1]))
        assert measured <= fit.deviation * (1.0 + 1e-6) + 1e-15 and fit.deviation <= 1e-7
    counts = [sum(len(fit.edges) for fit in fits) for fits in (thorough, brisk)]
    assert counts[0] < counts[1] < 1.1 * counts[0]


def test_involute_from_its_cusp() -> None:
    """At the base circle the involute starts with no speed; its direction there is the limit."""
    curve = involute(1e-3, 0.0, 1.0)
    fit = fit_arcs(curve, 1e-7)
    assert fit.deviation <= 1e-7
    assert true_distance(curve, fit, 0.0, 1.0) <= 1e-7


def test_a_circle_is_found_again() -> None:
    (edge,) = fit_arcs(quarter_ellipse(2e-3, 2e-3), 1e-7).edges
    assert isinstance(edge, Arc) and edge.radius == pytest.approx(2e-3, rel=1e-12)


def test_straight_curve_gives_a_line() -> None:
    fit = fit_arcs(spline(3, [0] * 4 + [1] * 4, [(0, 0), (1e-3, 2e-3), (2e-3, 4e-3), (5e-3, 10e-3)]), 1e-7)
    assert fit.edges == (Line(0.0, 0.0, 5e-3, 10e-3),)
    assert fit.deviation < 1e-16


@pytest.mark.parametrize("shift", [0.0, 0.123])
def test_cusp_inside_stays_a_cusp(shift: float) -> None:
    """x = t², y = t³ turns back at t = 0, in the middle or not."""

    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return 1e-3 * np.column_stack((t**2, t**3)), 1e-3 * np.column_stack((2 * t, 3 * t**2))

    curve = smooth(at, -1.0, 1.0 + shift, degree=3)
    fit = fit_arcs(curve, 1e-7)
    assert fit.deviation <= 1e-7
    assert true_distance(curve, fit, -1.0, 1.0 + shift) <= 1e-7
    assert len(fit.edges) < 40
    turns = [math.dist(a.tangent(1.0), b.tangent(0.0)) for a, b in pairwise(fit.edges)]
    assert max(turns) == pytest.approx(2.0, abs=1e-6) and sorted(turns)[-2] < 1e-4


def test_spiral_is_no_circle() -> None:
    fit = fit_arcs(spiral(2e-3, 1e-3, 2.0), 1e-7)
    assert len(fit.edges) > 5 and fit.deviation <= 1e-7
    radii = np.array([edge.radius for edge in fit.edges if isinstance(edge, Arc)])
    angles = 2 * math.pi * 2.0 * (np.arange(len(radii)) + 0.5) / len(radii)
    assert radii == pytest.approx(2e-3 * (1.0 + 1e-3 * angles), rel=1e-3)


def test_jump_of_curvature_is_an_end_of_arcs() -> None:
    """A parabola runs on into another one that bends the other way: arcs end where they meet."""
    curve = spline(2, [0, 0, 0, 1, 2, 2, 2], 1e-3 * np.array([(0, 0), (1, 0), (3, 2), (4, 2)]))
    fit = fit_arcs(curve, 1e-7)
    (middle,) = curve.points(np.array([1.0]))
    assert any(math.dist(edge.end, middle) < 1e-16 for edge in fit.edges)
    assert true_distance(curve, fit, 0.0, 2.0) <= fit.deviation * (1.0 + 1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_bound_holds_for_high_degree_and_unequal_weights(seed: int) -> None:
    """Where weight and distance have terms beyond the cubic, which are only bounded."""
    rng = np.random.default_rng(seed)
    points = 1e-3 * np.column_stack((np.arange(7.0), rng.uniform(-1.0, 1.0, 7)))
    curve = spline(6, [0] * 7 + [1] * 7, points, (10.0 ** rng.uniform(-1.0, 1.0, 7)).tolist())
    for tolerance in (1e-4, 1e-6):
        fit = fit_arcs(curve, tolerance)
        measured = true_distance(curve, fit, 0.0, 1.0)
        assert measured <= fit.deviation * (1.0 + 1e-6) <= tolerance * (1.0 + 2e-6)
        assert fit.deviation <= 1.1 * measured


NEAR_ENDS = [0.001, 0.0071, 0.0156, 0.0157, 0.0312, 0.0313, 0.5, 0.9687, 0.9688, 0.9843, 0.9844, 0.9929, 0.999]


def cusped(u: float) -> Curve:
    """A cubic Bézier whose slope, (t - u)(6 - 2t, 1 + 5t) mm, falls to nothing at u and nowhere else from 0 to 1."""
    rows = []
    for factor in (Polynomial([6e-3, -2e-3]), Polynomial([1e-3, 5e-3])):
        _, a, b, c = (Polynomial([-u, 1.0]) * factor).integ().coef
        rows.append([0.0, a / 3.0, (2.0 * a + b) / 3.0, a + b + c])
    return Curve(np.array([*rows, [1.0] * 4]).T[None], np.array([0.0, 1.0]))


@pytest.mark.parametrize("u", NEAR_ENDS)
def test_a_curve_is_cut_at_its_cusp(u: float) -> None:
    parts = smooth_parts([cusped(u)], np.array([1e-6]))[0]
    assert [float(part.breaks[-1]) for part in parts] == pytest.approx([u, 1.0], rel=0.0, abs=1e-9)


def test_cusps_of_many_curves_are_found_at_once() -> None:
    found = pauses(Bundle([cusped(u) for u in NEAR_ENDS]))
    assert found == pytest.approx(2.0 * np.arange(len(NEAR_ENDS)) + NEAR_ENDS, rel=0.0, abs=1e-9)


@pytest.mark.parametrize("u", [0.006, 0.987])
def test_a_cusp_near_an_end_costs_two_arcs_more_at_most_than_one_at_the_end(u: float) -> None:
    at_the_end = len(fit_arcs(cusped(float(round(u))), 1e-7).edges)
    assert len(fit_arcs(cusped(u), 1e-7).edges) <= at_the_end + 2


Corners = list[list[tuple[float, float]]]


def curve_of(spans: Corners, breaks: list[float] | None = None) -> Curve:
    """Béziers with such control points, metres."""
    p = np.array(spans, dtype=float)
    control = np.concatenate((p, np.ones((*p.shape[:2], 1))), axis=2)
    return Curve(control, np.arange(len(p) + 1.0) if breaks is None else np.array(breaks))


# Quadratic and cubic spans with the same tangents where they meet, of uneven lengths and bends.
FIRST: Corners = [
    [(0, 0), (1, 0.2), (2, 0.6), (3, 1.2)],
    [(3, 1.2), (3.5, 1.5), (3.8, 1.9), (3.9, 2.6)],
    [(3.9, 2.6), (4.0, 3.3), (4.4, 5.0), (6.0, 6.0)],
]
SECOND: Corners = [[(0, 0), (0, 1), (-0.5, 2), (-1.5, 2.4)], [(-1.5, 2.4), (-2.0, 2.6), (-2.6, 2.7), (-4.0, 2.4)]]


def measured(span: list[tuple[float, float]]) -> tuple[float, float, float]:
    """Mean curvature from a thousandth to two of the span, the same before its end, and its length by eight chords."""
    p = BPoly(np.array(span)[:, None, :], [0.0, 1.0])
    slope = p.derivative()

    def mean(a: float, b: float) -> float:
        one, other = slope(a), slope(b)
        turn = math.atan2(one[0] * other[1] - one[1] * other[0], one @ other)
        return turn / math.dist(p(a), p(b))

    chords = np.diff(p(np.linspace(0.0, 1.0, 9)), axis=0)
    return mean(1e-3, 2e-3), mean(1.0 - 2e-3, 1.0 - 1e-3), float(np.hypot(*chords.T).sum())


def worth(spans: Corners, tolerance: float) -> list[float]:
    """For each inner break how often the jump is worth an end there."""
    rows = [measured(span) for span in spans]
    reach = []
    for one, other, length in rows:
        arc = (216.0 / math.sqrt(3.0) * tolerance * length / abs(other - one)) ** (1.0 / 3.0)
        reach.append(min(length, arc))
    return [
        abs(rows[k + 1][0] - rows[k][1]) * min(reach[k], reach[k + 1]) ** 2 / (4.0 * tolerance) for k in range(len(rows) - 1)
    ]


@pytest.mark.parametrize(("number", "which"), [(0, 0), (0, 1), (1, 0)])
def test_a_jump_of_curvature_counts_from_four_tolerances_on(number: int, which: int) -> None:
    """The tolerance at which the jump just counts is looked for by halving; a little beside it the answer changes."""
    spans = (FIRST, SECOND)[number]
    low, high = 1e-9, 10.0
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if worth(spans, middle)[which] > 1.0 else (low, middle)
    place = [[1.0, 2.0], [5.0]][number][which]
    for factor in (1.0 - 1e-6, 1.0 + 1e-6):
        tolerance = np.array([1e-4, 1e-4])
        tolerance[number] = low * factor
        expected = [place + k - which for k, times in enumerate(worth(spans, float(tolerance[number]))) if times > 1.0]
        found = [
            t for t in jumps(Bundle([curve_of(FIRST), curve_of(SECOND)]), tolerance).tolist() if (t > 3.5) == (number == 1)
        ]
        assert found == expected and (place in found) == (factor < 1.0)


def test_where_there_are_no_inner_breaks_nothing_jumps() -> None:
    found = jumps(Bundle([curve_of(FIRST[:1]), curve_of(SECOND[:1])]), np.array([1e-9, 1e-9]))
    assert found.shape == (0,)


def test_the_mean_curvature_is_the_turn_over_the_chord() -> None:
    curve = curve_of([[(0, 0), (0.5, 0), (1, 1)], [(1, 1), (1, 1), (1, 1)]])  # the second span stands still
    found = bend(Bundle([curve]), np.array([0.2, 0.9, 1.3]), np.array([0.5, 0.6, 1.4]))
    # x = t, y = t²: slopes (1, 2t).
    turn = math.atan(1.0) - math.atan(0.4), math.atan(1.2) - math.atan(1.8)
    chords = math.hypot(0.3, 0.21), math.hypot(0.3, 0.45)
    assert found == pytest.approx([turn[0] / chords[0], turn[1] / chords[1], 0.0], rel=1e-12, abs=0.0)


def cusp(at: float, slowest_speed: float = 0.0) -> Curve:
    """x = (t - a)², y = v t, so that its speed is v at a, the least; from 0 to 1."""
    a, v = at, slowest_speed
    return curve_of([[(a * a, 0.0), (a * a - a, 0.5 * v), ((1.0 - a) ** 2, v)]])


def test_a_pause_is_found_where_it_is() -> None:
    bundle = Bundle([cusp(0.37), cusp(0.25), cusp(0.9), cusp(0.04), cusp(0.96)])
    assert pauses(bundle) == pytest.approx([0.37, 2.25, 4.9, 6.04, 8.96], abs=1e-8)
    assert pauses(Bundle([cusp(0.25)])).tolist() == [0.25]


@pytest.mark.parametrize(("share", "count"), [(0.97, 1), (1.03, 0)])
def test_what_is_faster_than_a_share_of_the_usual_speed_does_not_pause(share: float, count: int) -> None:
    usual = Bundle([cusp(0.37)]).usual_speed[0]
    assert len(pauses(Bundle([cusp(0.37, share * PAUSE * usual)]))) == count


def test_speed_is_measured_by_the_curves_own_parameter() -> None:
    """A span ten times as wide as its neighbours is slow all along but pauses nowhere."""
    line = curve_of([[(0, 0), (1, 0), (2, 0)], [(2, 0), (3, 0), (4, 0)], [(4, 0), (5, 0), (6, 0)]], [0.0, 1.0, 2e6, 2e6 + 1.0])
    assert len(pauses(Bundle([line]))) == 0


def test_ends_that_pause_are_no_pauses_inside() -> None:
    assert len(pauses(Bundle([cusp(1.0), cusp(0.0), cusp(1.0)]))) == 0


def test_a_corner_at_points_that_coincide_is_a_pause() -> None:
    corner = curve_of([[(0, 0), (1, 0), (1, 0)], [(1, 0), (1, 0), (1, 3)]])
    assert pauses(Bundle([curve_of([[(0, 0), (1, 1), (2, 0)]]), corner])).tolist() == [3.0]


def test_the_slowest_place_between_two_others() -> None:
    bundle = Bundle([cusp(0.37, 0.1), cusp(0.8, 0.2)])
    found = slowest(bundle, np.array([0.3, 2.1]), np.array([0.6, 2.9]))
    assert found == pytest.approx([0.37, 2.8], abs=2e-7)
    assert slowest(bundle, np.array([0.5]), np.array([0.6])) == pytest.approx([0.5], abs=1e-9)
    assert len(slowest(bundle, np.empty(0), np.empty(0))) == 0


def test_a_curve_is_cut_at_ascending_places_several_of_them_in_one_span() -> None:
    curve = curve_of(FIRST, [0.0, 2.0, 3.0, 7.0])
    parts = cut_at(curve, [0.25, 1.0, 2.3, 2.4, 2.9])
    breaks = [0.0, 0.5], [0.5, 2.0], [2.0, 3.0, 4.2], [4.2, 4.6], [4.6, 6.6], [6.6, 7.0]
    for part, expected in zip(parts, breaks, strict=True):
        assert part.breaks == pytest.approx(expected, rel=1e-12)
    whole = Bundle([curve])
    at = whole.points(np.array([0.0, 0.25, 1.0, 2.3, 2.4, 2.9, 3.0]))
    for part, start, end in zip(parts, at[:-1], at[1:], strict=True):
        assert part.ends == pytest.approx(np.array([start, end]), rel=1e-12)
    assert cut_at(curve, []) == [curve]


def test_each_curve_is_cut_at_its_own_places_but_not_into_slivers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three spans from 0 on, two from 4 on, two from 7 on."""
    places = [
        *(1.1e-4, 1.3, 1.3 + 0.9e-4, 1.3 + 1.1e-4, 2.0 - 0.9e-4, 2.0 + 0.9e-4, 3.0 - 0.9e-4, 7.0 + 0.9e-4, 8.5, 9.0 - 1.1e-4)
    ]
    monkeypatch.setattr(smooth_of_smooth_parts, "jumps", lambda *_: np.array([8.5, *places[:6]]))
    monkeypatch.setattr(smooth_of_smooth_parts, "pauses", lambda *_: np.array([*places[6:], 1.3, 2.0]))
    curves = [curve_of(FIRST), curve_of(SECOND), curve_of(SECOND)]
    one, two, three = smooth_parts(curves, np.array([1e-7, 1e-7, 1e-7]))
    assert [part.breaks[-1] for part in one] == pytest.approx([1.1e-4, 1.3, 1.3 + 1.1e-4, 2.0, 3.0], abs=1e-12)
    assert two == [curves[1]]
    assert [part.breaks[-1] for part in three] == pytest.approx([1.5, 2.0 - 1.1e-4, 2.0], abs=1e-12)


def bow(sweep: float, radius: float, stretch: float = 1.0) -> list[tuple[float, float, float]]:
    """Control points of an arc about (1, 2) from 0.4 rad on, stretched along x."""
    h, rows = 0.5 * sweep, []
    for angle, w in ((0.4, 1.0), (0.4 + h, math.cos(h)), (0.4 + sweep, 1.0)):
        rows.append((w + stretch * radius * math.cos(angle), 2.0 * w + radius * math.sin(angle), w))
    return rows


def off_round(sweep: float, stretch: float) -> float:
    """How far seven points are off their mean distance from the centre of three of them, over 1e-5 of the rise."""
    w = math.cos(0.5 * sweep)
    points = []
    for k in range(7):
        u = k / 6.0
        a, b, c = (1.0 - u) ** 2, 2.0 * u * (1.0 - u), u * u
        rows = bow(sweep, 3.0, stretch)
        weight = a + b * w + c
        points.append([(a * rows[0][j] + b * rows[1][j] + c * rows[2][j]) / weight for j in (0, 1)])
    (ax, ay), (bx, by), (cx, cy) = points[0], points[2], points[4]
    matrix = np.array([(2.0 * (bx - ax), 2.0 * (by - ay)), (2.0 * (cx - ax), 2.0 * (cy - ay))])
    x, y = np.linalg.solve(matrix, [bx**2 - ax**2 + by**2 - ay**2, cx**2 - ax**2 + cy**2 - ay**2])
    distances = [math.dist(p, (x, y)) for p in points]
    mean = math.fsum(distances) / 7.0
    return max(abs(d - mean) for d in distances) / (1e-5 * mean * min(1.0, sweep * sweep / 8.0))


@pytest.mark.parametrize("sweep", [0.7, 1.6, -1.6, 2.6, 3.0, -3.0])
def test_a_span_is_round_within_a_hundred_thousandth_of_its_rise(sweep: float) -> None:
    """The rise of small arcs is an eighth of the square of the angle, of large ones their radius at most."""
    low, high = 1.0, 1.01
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if off_round(sweep, middle) > 1.0 else (middle, high)
    for share, is_round in ((0.98, True), (1.02, False)):
        control = np.array([bow(sweep, 3.0, 1.0 + share * (low - 1.0))])
        ((part,),) = parts_of([Curve(control, np.array([0.0, 1.0]))], [1e-2])
        assert isinstance(part.edge, Arc) is is_round


@pytest.mark.parametrize("sweep", [3e-3, -3e-3, 0.02, 1.0])
def test_flat_arcs_are_round(sweep: float) -> None:
    ((part,),) = parts_of([Curve(np.array([bow(sweep, 3.0)]), np.array([0.0, 1.0]))], [1e-6])
    assert isinstance(part.edge, Arc)
    assert (part.edge.radius, part.edge.sweep) == pytest.approx((3.0, sweep), rel=1e-6)


def test_each_edge_comes_with_its_part_of_the_curve() -> None:
    """Two spans in line, one and two others round the corner; and two that are neither straight nor round."""
    corners = [(0, 0), (1, 0), (3, 0), (3, 2), (3, 5), (3, 6)]
    rows = [[(*a, 1.0), (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 1.0), (*b, 1.0)] for a, b in pairwise(corners)]
    rows += [[(3, 6, 1), (3, 8, 1), (5, 9, 1)], [(5, 9, 1), (7, 10, 1), (7.5, 14, 1)]]
    curve = Curve(np.array(rows, dtype=float), np.arange(8.0) ** 2)
    alone = Curve(curve.control[5:], curve.breaks[5:])
    (whole, rest) = parts_of([curve, alone], [1e-7, 1e-7])
    breaks = [0.0, 1.0, 4.0], [4.0, 9.0, 16.0, 25.0], [25.0, 36.0, 49.0]
    for part, expected in zip(whole, breaks, strict=True):
        assert part.curve.breaks.tolist() == expected and len(part.curve.control) == len(expected) - 1
    assert [part.edge for part in whole] == [Line(0.0, 0.0, 3.0, 0.0), Line(3.0, 0.0, 3.0, 6.0), None]
    assert len(rest) == 1 and rest[0].edge is None and rest[0].curve is alone


@pytest.mark.parametrize("radius", [5e-5, 3.0])
def test_small_circles_and_large_ones(radius: float) -> None:
    rows = []
    for k in range(4):
        h = TURN / 8
        for angle, w in ((2 * k * h, 1.0), ((2 * k + 1) * h, math.cos(h)), ((2 * k + 2) * h, 1.0)):
            rows.append((radius * math.cos(angle), radius * math.sin(angle), w))
    control = np.array(rows).reshape(-1, 3, 3)
    control[-1, -1] = control[0, 0]
    fit = whole_circle(Curve(control, np.arange(5.0)), 1e-4 * radius)
    assert fit is not None and isinstance(fit.edges[0], Arc)
    assert fit.edges[0].radius == pytest.approx(radius, rel=1e-9, abs=0.0) and fit.deviation < 1e-9 * radius


@pytest.mark.parametrize("degree", [1, 2, 3, 5, 11, 24])
@pytest.mark.parametrize("clamped", [True, False])
def test_beziers_against_scipy(degree: int, clamped: bool) -> None:
    rng = np.random.default_rng(degree)
    inner = np.sort(rng.uniform(0.0, 1.0, 6))
    inner[3] = inner[2]  # a double knot
    outer = np.zeros(degree), np.ones(degree)
    if not clamped:
        outer = -0.1 * np.arange(degree, 0, -1), 1.0 + 0.1 * np.arange(1, degree + 1)
    knots = np.concatenate((outer[0], [0.0], inner, [1.0], outer[1]))
    points = np.column_stack(
        (rng.uniform(-1.0, 1.0, (len(knots) - degree - 1, 2)), rng.uniform(0.5, 2.0, len(knots) - degree - 1))
    )
    starts = np.array([i for i in range(degree, len(points)) if knots[i] < knots[i + 1]])
    control = beziers(degree, knots, points, starts, starts)
    breaks = np.array([*knots[starts], knots[starts[-1] + 1]])
    whole = BSpline(knots, points, degree)
    bundle = Bundle([Curve(control, breaks)])
    for k, (low, high) in enumerate(pairwise(breaks)):
        u = np.linspace(0.0, 1.0, 7)[:-1]
        h = whole(low + u * (high - low))
        assert bundle.points(k + u) == pytest.approx(h[:, :2] / h[:, 2:], abs=1e-11)


def test_coincident_points_stay_one_point() -> None:
    point = (0.1, 0.7, 1.0)
    control = beziers(
        3, np.array([0.0, 0.0, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0, 1.0]), np.array([point] * 5), *[np.array([3, 4])] * 2
    )
    assert np.all(control == point)


def test_arc_from_semicircle_and_line() -> None:
    arc = arc_from((0.0, 0.0), (0.0, -1.0), (2.0, 0.0))
    assert isinstance(arc, Arc)
    assert (arc.x, arc.y, arc.radius, arc.sweep) == pytest.approx((1.0, 0.0, 1.0, math.pi))
    assert isinstance(arc_from((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), Line)


@pytest.mark.parametrize("direction", [0.0, 0.5, math.pi / 2, 3.0, -math.pi / 2])
def test_an_arc_of_a_radius_above_a_million_chords_is_a_line(direction: float) -> None:
    """Where it leaves its chord at an angle ε, that is twice ε of a chord over the radius."""
    end = (1.0 + 3e-3 * math.cos(direction), 2.0 + 3e-3 * math.sin(direction))
    for off, kind in ((4.9e-7, Line), (-4.9e-7, Line), (5.1e-7, Arc), (-5.1e-7, Arc)):
        assert type(arc_from((1.0, 2.0), (math.cos(direction + off), math.sin(direction + off)), end)) is kind


@given(st.floats(-1.2, 1.2), st.floats(-1.2, 1.2), st.floats(1e-6, 10.0), st.floats(-3.2, 3.2), st.floats(0.2, 5.0))
def test_biarc_meets_points_and_tangents(u: float, v: float, length: float, turn: float, ratio: float) -> None:
    p, q = np.array([[0.3, -0.2]]), np.array([[0.3 + length * math.cos(turn), -0.2 + length * math.sin(turn)]])
    tp, tq = (np.array([[math.cos(turn + w), math.sin(turn + w)]]) for w in (u, v))
    joint, along = biarc_joints(p, tp, q, tq, np.array([ratio]))
    arcs = arcs_from(np.concatenate((p, joint)), np.concatenate((tp, along)), np.concatenate((joint, q)))
    first, second = arcs.edges()
    assert first.start == pytest.approx(p[0], abs=1e-9 * length) and second.end == pytest.approx(q[0], abs=1e-9 * length)
    assert first.end == pytest.approx(second.start, abs=1e-9 * length)
    assert first.tangent(0.0) == pytest.approx(tp[0], abs=3e-6) and second.tangent(1.0) == pytest.approx(tq[0], abs=3e-6)
    assert first.tangent(1.0) == pytest.approx(second.tangent(0.0), abs=3e-6)
    assert arcs.end_tangents[0] == pytest.approx(first.tangent(1.0), abs=1e-9)
    for edge, curvature in zip((first, second), arcs.curvatures, strict=True):
        assert abs(curvature) == pytest.approx(1.0 / edge.radius if isinstance(edge, Arc) else 0.0, rel=1e-9)
