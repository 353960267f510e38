"""Are places, points and slopes of many curves at once those of each, and is no arc further away than its bound says?"""

import math
from itertools import pairwise

import numpy as np
import pytest
from curves import Known, quarter_ellipse, spiral, spline

from watchsim.geometry.biarcs import (
    LOOKS,
    PAUSE,
    ArcChain,
    Bundle,
    Curve,
    bernstein_sum,
    binomials,
    deviations,
    glances,
    halves,
)
from watchsim.geometry.fitting import BRISK, KINK, MOST, THOROUGH, Found, Search, fewest, fit_arcs
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.recognition import CLOSED, MEANT, Part, joined, parts_of, whole_circle

RNG = np.random.default_rng(4)


def curves(weighted: bool) -> list[Known]:
    weights = [[1.0, 2.0, 0.7, 1.4, 1.0], [1.0, 0.8, 3.0, 1.0], []] if weighted else [[], [], []]
    rows = [([0, 0, 0, 0, 1, 3, 3, 3, 3], 5), ([0, 0, 0, 0, 5, 5, 5, 5], 4), ([2, 2, 2, 2, 2.5, 4, 4, 6, 6, 6, 6], 7)]
    return [spline(3, knots, RNG.uniform(-1.0, 1.0, (n, 2)), w) for (knots, n), w in zip(rows, weights, strict=True)]


def own_parameter(curve: Curve, place: np.ndarray) -> np.ndarray:
    return np.interp(place, np.arange(len(curve.breaks)), curve.breaks)


@pytest.mark.parametrize("weighted", [False, True])
def test_places_count_the_spans_of_each_curve_behind_the_others(weighted: bool) -> None:
    several = curves(weighted)
    bundle = Bundle(several)
    assert len(bundle) == 3 and bundle.weighted is weighted and bundle.degree == 3
    assert bundle.begin.tolist() == [0, 3, 5] and bundle.end.tolist() == [2, 4, 8]
    assert bundle.owner.tolist() == [0, 0, 1, 2, 2, 2] and bundle.start_of.tolist() == [0, 1, 3, 5, 6, 7]
    for k, curve in enumerate(several):
        u = np.sort(np.append(RNG.uniform(0.0, len(curve.breaks) - 1, 20), [0.0, len(curve.breaks) - 1.0]))
        places, t = bundle.begin[k] + u, own_parameter(curve, u)
        assert bundle.points(places) == pytest.approx(curve.points(t), abs=1e-9)
        inner = np.abs(u - np.round(u)) > 1e-9
        span = np.floor(u[inner]).astype(int)
        slopes = curve.slopes(t[inner]) * np.diff(curve.breaks)[span][:, None]
        assert bundle.slopes(places[inner]) == pytest.approx(slopes, rel=1e-6, abs=1e-7)
        assert bundle.speeds(places[inner]) == pytest.approx(np.hypot(*curve.slopes(t[inner]).T), rel=1e-6)
        ways = curve.slopes(t[inner]) / np.hypot(*curve.slopes(t[inner]).T)[:, None]
        assert bundle.tangents(places[inner]) == pytest.approx(ways, abs=1e-6)
        for number, (low, high) in enumerate(zip(curve.breaks[:-1], curve.breaks[1:], strict=True)):
            corners = curve.points(np.linspace(low, high, LOOKS + 1))
            assert bundle.lengths[int(bundle.owner.tolist().index(k)) + number] == pytest.approx(
                np.hypot(*np.diff(corners, axis=0).T).sum()
            )
    usual = [bundle.lengths[bundle.owner == k].sum() / np.ptp(curve.breaks) for k, curve in enumerate(several)]
    assert bundle.usual_speed == pytest.approx(usual)


def test_where_a_curve_pauses_its_direction_is_that_beside() -> None:
    """A cubic whose first two control points are one, and another whose last two are."""
    start = spline(3, [0] * 4 + [1] * 4, [(0, 0), (0, 0), (1, 2), (3, 0)])
    stop = spline(3, [0] * 4 + [1] * 4, [(0, 0), (1, 2), (3, 0), (3, 0)])
    bundle = Bundle([start, stop])
    ways = bundle.tangents(np.array([0.0, 3.0, 0.5 * PAUSE, 0.5]))
    for way, towards in zip(ways[:3], ((1, 2), (2, -2), (1, 2)), strict=True):
        assert way == pytest.approx(np.array(towards) / math.hypot(*towards), abs=1e-3)


def test_intervals_are_cut_at_the_breaks() -> None:
    bundle = Bundle(curves(False))
    low, high, source = bundle.stretches(np.array([0.2, 5.5, 3.0]), np.array([1.7, 7.25, 4.0]))
    assert low.tolist() == [0.2, 1.0, 5.5, 6.0, 7.0, 3.0] and high.tolist() == [1.0, 1.7, 6.0, 7.0, 7.25, 4.0]
    assert source.tolist() == [0, 0, 1, 1, 1, 2]
    low, high, source = bundle.stretches(np.array([0.2, 1.0]), np.array([1.0, 1.5]))
    assert (low.tolist(), high.tolist(), source.tolist()) == ([0.2, 1.0], [1.0, 1.5], [0, 1])


@pytest.mark.parametrize("degree", [1, 2, 5])
def test_polynomials_in_pieces_and_sums(degree: int) -> None:
    control = RNG.uniform(-1.0, 1.0, (degree + 1, 3))
    whole, t = Curve(control[None], np.array([0.0, 2.0])), np.linspace(0.0, 1.0, 7)
    scaled = control * binomials(degree)[:, None]
    values = bernstein_sum(scaled[..., None], t).T
    expected = np.array(
        [sum(math.comb(degree, k) * u**k * (1 - u) ** (degree - k) * control[k] for k in range(degree + 1)) for u in t]
    )
    assert values == pytest.approx(expected, abs=1e-13)
    for cut in (0.25, 0.8):
        before, after = halves(control, cut)
        for part, place in ((before, cut * t), (after, cut + (1 - cut) * t)):
            found = bernstein_sum((part * binomials(degree)[:, None])[..., None], t)
            assert np.allclose(found, bernstein_sum(scaled[..., None], place), atol=1e-13)
        one, other = whole.split(cut)
        assert one.breaks.tolist() == [0.0, 2.0 * cut] and other.breaks.tolist() == [2.0 * cut, 2.0]
        assert np.array_equal(one.control, before[None]) and np.array_equal(other.control, after[None])


def test_a_curve_is_split_at_breaks_and_between_them() -> None:
    curve = curves(True)[2]
    for place, one_breaks, other_breaks in (
        (1.0, [2, 2.5], [2.5, 4, 6]),
        (2.0, [2, 2.5, 4], [4, 6]),
        (1.5, [2, 2.5, 3.25], [3.25, 4, 6]),
    ):
        one, other = curve.split(place)
        assert (one.breaks.tolist(), other.breaks.tolist()) == (one_breaks, other_breaks)
        assert one.ends[1] == pytest.approx(curve.points(np.array([one_breaks[-1]]))[0])
        assert one.ends[1] == pytest.approx(other.ends[0])
        assert one.ends[0] == pytest.approx(curve.ends[0]) and other.ends[1] == pytest.approx(curve.ends[1])
        for part in (one, other):
            middle = Bundle([part]).points(np.arange(len(part.control)) + 0.5)
            assert middle == pytest.approx(curve.points(0.5 * (part.breaks[1:] + part.breaks[:-1])), abs=1e-9)


@pytest.mark.parametrize(
    "curve",
    [
        spiral(2e-3, 0.3, 0.3),
        quarter_ellipse(3e-3, 1e-3),
        spline(3, [0] * 4 + [1] * 4, [(0, 0), (1e-3, 0), (2e-3, 1e-3), (2e-3, 3e-3)], [1, 1.5, 0.8, 1]),
    ],
    ids=["spiral", "ellipse", "weighted"],
)
@pytest.mark.parametrize("off", [1.0, 1.02])
def test_no_point_of_a_curve_is_further_from_its_arc_than_the_bound(curve: Known, off: float) -> None:
    """Arcs through three points of the curve, or of `off` times their curvature; mirrored, the other way round, far off."""
    for sign in (1.0, -1.0):
        control = curve.control * [1.0, sign, 1.0]
        bundle = Bundle([Curve(control, curve.breaks)])
        n = 12
        places = np.linspace(0.0, len(control), n + 1)
        low, high = places[:-1], places[1:]
        a, m, b = (bundle.points(p) for p in (low, 0.5 * (low + high), high))
        chord = b - a
        rise = (chord[:, 0] * (m - a)[:, 1] - chord[:, 1] * (m - a)[:, 0]) / np.hypot(*chord.T)
        half = -2.0 * np.arctan(2.0 * rise / np.hypot(*chord.T)) * off
        turn = np.arctan2(chord[:, 1], chord[:, 0])
        k = 2.0 * np.sin(half) / np.hypot(*chord.T)
        start, end = (
            np.column_stack((np.cos(turn - half), np.sin(turn - half))),
            np.column_stack((np.cos(turn + half), np.sin(turn + half))),
        )
        arcs = ArcChain(a, start, b, end, k)
        bound = deviations(bundle, low, high, arcs, np.arange(n))
        quick = glances(bundle, low, high, arcs)
        together = deviations(bundle, low, high, arcs, np.zeros(n, dtype=np.intp))
        for i in range(n):
            p = bundle.points(np.linspace(low[i], high[i] - 1e-12, 2001))
            centre = a[i] + np.array([-start[i, 1], start[i, 0]]) / k[i]
            worst = np.max(np.abs(np.hypot(*(p - centre).T) - 1.0 / abs(k[i])))
            assert worst <= bound[i] * (1 + 1e-9) + 1e-17 and bound[i] <= 1.05 * worst + 1e-12
            assert 0.8 * worst - 1e-15 <= quick[i] <= 1.001 * worst + 1e-15
        assert together.max() == pytest.approx(bound.max(), rel=0.02) and np.all(together >= bound * 0.97)


def ring(radius: float, turns: float = 1.0, spans: int = 8, stretch: float = 1.0) -> Curve:
    """Rational arcs round (1, 2) mm, `stretch` times as wide as high."""
    half = turns * math.pi / spans
    angles = half * np.arange(2 * spans + 1)
    odd = np.arange(2 * spans + 1) % 2 == 1
    points = (
        radius * np.where(odd, 1.0 / math.cos(half), 1.0)[:, None] * np.column_stack((stretch * np.cos(angles), np.sin(angles)))
    )
    if float(turns).is_integer():
        points[-1] = points[0]
    knots = [0, *np.repeat(np.arange(spans + 1), 2).tolist(), spans]
    return spline(2, knots, points + np.array([1e-3, 2e-3]), np.where(odd, math.cos(half), 1.0).tolist())


@pytest.mark.parametrize("turns", [1.0, -1.0])
@pytest.mark.parametrize(("wider", "is_one"), [(0.0, True), (0.9, True), (1.1, False)])
def test_a_closed_curve_within_the_tolerance_of_a_circle_is_one(turns: float, wider: float, is_one: bool) -> None:
    """An oval leaves the circle between its axes by half of what one is longer than the other."""
    tolerance = 1e-7
    for radius in (5e-4, 2e-3):
        fit = whole_circle(ring(radius, turns, stretch=1.0 + 2.0 * wider * tolerance / radius), tolerance)
        assert (fit is not None) is is_one
        if fit is not None:
            (arc,) = fit.edges
            assert isinstance(arc, Arc) and arc.sweep == math.copysign(TURN, turns)
            assert (arc.x, arc.y, arc.radius) == pytest.approx((1e-3, 2e-3, radius + wider * tolerance), rel=1e-6)
            assert arc.start == pytest.approx((1e-3 + radius + wider * tolerance, 2e-3), abs=2e-7)
            assert fit.deviation == pytest.approx(wider * tolerance, rel=0.01, abs=1e-12)


def test_what_is_not_once_round_is_no_whole_circle() -> None:
    assert whole_circle(ring(1e-3, 0.9), 1e-6) is None and whole_circle(ring(1e-3, 2.0, 16), 1e-6) is None
    angles = np.array([0.0, 1.0, 2.0, 1.5, 3.0, 4.0, 5.0, TURN])
    rows = []
    for a, b in pairwise(angles.tolist()):
        h = 0.5 * (b - a)
        rows += [
            (math.cos(a), math.sin(a), 1.0),
            (math.cos(a + h), math.sin(a + h), math.cos(h)),
            (math.cos(b), math.sin(b), 1.0),
        ]
    control = np.array(rows).reshape(-1, 3, 3)
    control[-1, -1] = control[0, 0]
    assert whole_circle(Curve(control, np.arange(8.0)), 1e-6) is None  # turns back on its way
    assert whole_circle(Curve(np.tile([0.0, 0.0, 1.0], (1, 3, 1)), np.arange(2.0)), 1e-6) is None


def test_arcs_are_joined_where_their_circles_are_nearly_one() -> None:
    spare, first = 1e-7, Arc(1e-3, 2e-3, 5e-3, 0.3, 1.0)
    for away, count in ((0.9, 1), (1.1, 2)):
        d = away * MEANT * spare
        for other in (
            Arc(1e-3 + d, 2e-3, 5e-3, 1.3, 2.0),
            Arc(1e-3, 2e-3 - d, 5e-3, 1.3, 2.0),
            Arc(1e-3, 2e-3, 5e-3 - d, 1.3, 2.0),
            Arc(1e-3 + d / 2, 2e-3, 5e-3 + d / 2, 1.3, 2.0),
        ):
            edges, moved = joined([first, other], spare)
            assert len(edges) == count and moved == (pytest.approx(d, rel=1e-6, abs=0.0) if count == 1 else 0.0)
            assert edges[0].start == pytest.approx(first.start) and edges[-1].end == pytest.approx(other.end, abs=1e-12)
    for sweep, count in ((-1.0, 2), (TURN - 1.0, 1), (TURN - 0.9, 2), (3.0, 1)):
        edges, _ = joined([first, Arc(1e-3, 2e-3, 5e-3, 1.3, sweep)], spare)
        assert len(edges) == count
        if count == 1:
            assert edges[0].length == pytest.approx(5e-3 * (1.0 + sweep)) and edges[0].point(0.5) == pytest.approx(
                Arc(1e-3, 2e-3, 5e-3, 0.3, 1.0 + sweep).point(0.5)
            )
    back = joined([first.reversed(), Arc(1e-3, 2e-3, 5e-3, 0.3, -2.0)], spare)[0]
    assert len(back) == 1 and isinstance(back[0], Arc) and back[0].sweep == pytest.approx(-3.0)
    line = Line(0.0, 0.0, 1.0, 0.0)
    assert joined([line, first, line], spare) == ([line, first, line], 0.0) and joined([], spare) == ([], 0.0)
    wide = 9.0 * KINK * 5e-3
    for away, count in ((wide, 1), (wide * 1.3, 2)):
        assert len(joined([first, Arc(1e-3 + away, 2e-3, 5e-3, 1.3, 2.0)], 1e9)[0]) == count


def polyline(*corners: tuple[float, float]) -> Curve:
    """Straight spans of degree two, millimetres."""
    p = 1e-3 * np.array(corners)
    control = np.ones((len(p) - 1, 3, 3))
    control[:, :, :2] = np.stack((p[:-1], 0.5 * (p[:-1] + p[1:]), p[1:]), axis=1)
    return Curve(control, np.arange(float(len(p))))


@pytest.mark.parametrize(
    ("corners", "lines"),
    [
        ([(0, 0), (1, 0), (3, 0), (4, 0)], 1),
        ([(0, 0), (1, 1), (3, 3)], 1),
        ([(0, 0), (1, 0), (3, 1e-5)], 2),
        ([(0, 0), (1, 0), (3, -1e-5)], 2),
        ([(0, 0), (2, 0), (1, 0)], 2),
        ([(0, 0), (2, 0), (2, 2), (2, 5)], 2),
    ],
)
def test_straight_spans_go_on_in_one_line(corners: list[tuple[float, float]], lines: int) -> None:
    for turned in (corners, [(-y, x) for x, y in corners], [(3 - x, 1 - y) for x, y in corners]):
        (parts,) = parts_of([polyline(*turned)], [1e-7])
        assert len(parts) == lines and all(isinstance(part.edge, Line) for part in parts)
        assert parts[0].edge.start == pytest.approx(np.array(turned[0]) * 1e-3) and parts[-1].edge.end == pytest.approx(
            np.array(turned[-1]) * 1e-3
        )  # type: ignore[union-attr]


@pytest.mark.parametrize("turns", [1.0, 0.99, 0.3, -0.6])
def test_round_spans_go_on_in_one_arc(turns: float) -> None:
    (parts,) = parts_of([ring(2e-3, turns, 6)], [1e-7])
    (part,) = parts
    assert isinstance(part.edge, Arc) and part.edge.sweep == pytest.approx(turns * TURN, rel=1e-9)
    assert (part.edge.x, part.edge.y, part.edge.radius) == pytest.approx((1e-3, 2e-3, 2e-3), rel=1e-9) and CLOSED < 1e-6


def test_a_straight_span_may_pause_at_its_ends_but_not_turn_back() -> None:
    for inner, lines in (((0.0, 0.0), 1), ((4.0, 3.0), 1), ((2.0, 1.5), 1), ((-0.4, -0.3), 0), ((4.4, 3.3), 0)):
        control = np.ones((1, 3, 3))
        control[0, :, :2] = 1e-3 * np.array([(0.0, 0.0), inner, (4.0, 3.0)])
        ((part,),) = parts_of([Curve(control, np.array([0.0, 1.0]))], [1e-7])
        assert isinstance(part.edge, Line) is bool(lines)


@pytest.mark.parametrize(("share", "is_one"), [(0.9, False), (1.1, True)])
def test_spans_shorter_than_twenty_tolerances_are_no_edges_of_their_own(share: float, is_one: bool) -> None:
    length = share * 20.0 * 1e-7
    ((bow,),) = parts_of([ring(1e-4, length / (1e-4 * TURN), 1)], [1e-7])
    ((line,),) = parts_of([polyline((0.0, 0.0), (600.0 * length, 800.0 * length))], [1e-7])
    assert (isinstance(bow.edge, Arc), isinstance(line.edge, Line)) == (is_one, is_one)
    assert is_one or bow.edge is line.edge is None


BOW = [(0, 0), (1, 3), (4, 3), (5, -1)]
FOUND = Found(ArcChain(*[None] * 5), 1e-9)  # type: ignore[arg-type]


def test_the_first_attempt_is_what_the_curvature_asks_for_and_a_brisk_one_has_more() -> None:
    assert [Search(count, THOROUGH).count for count in (1, 7, 100)] == [1, 7, 100]
    assert [Search(count, BRISK).count for count in (1, 7, 100)] == [2, 10, 130]


def test_what_seems_necessary_is_tried_next_and_more_where_that_fails_again() -> None:
    search = Search(100, THOROUGH)
    assert search.learn(120, None) and search.count == 120
    assert search.learn(119, None) and search.count == 120  # once more, laid better
    assert search.learn(118, None) and search.count == 121
    brisk = Search(100, BRISK)
    assert brisk.count == 130 and brisk.learn(110, None) and brisk.count == 131


def test_few_arcs_are_tried_more_often_since_each_counts_for_more() -> None:
    for count, times in ((1, MOST), (9, MOST), (10, 4), (12, 4), (16, 3), (24, 2), (96, 2)):
        search = Search(count, THOROUGH)
        for _ in range(times - 1):
            assert search.learn(count, None) and search.count == count
        assert search.learn(count, None) and search.count == count + 1
    assert Search(96, BRISK).enough_attempts(96) == 1 and Search(20, BRISK).enough_attempts(20) == 2


def test_a_search_without_success_ends_at_four_times_the_first_count() -> None:
    for needed, goes_on in ((56, True), (57, False)):
        assert Search(10, THOROUGH).learn(needed, None) is goes_on


@pytest.mark.parametrize(
    ("count", "needed", "goes_on", "following"),
    [
        (100, 90, True, 90),  # far fewer may do
        (100, 97, False, 97),  # within four per cent of what seems necessary
        (100, 96, True, 96),
        (104, 100, False, 100),
        (20, 20, False, 19),  # one fewer than necessary is no use
        (50, 50, False, 49),
        (2, 1, False, 1),  # a single arc is tried elsewhere
        (3, 2, True, 2),
        (3, 1, False, 1),
    ],
)
def test_after_a_success_fewer_are_tried_as_long_as_fewer_could_do(
    count: int, needed: int, goes_on: bool, following: int
) -> None:
    search = Search(count, THOROUGH)
    assert search.learn(needed, FOUND) is goes_on
    assert search.count == following and search.best is FOUND and search.fewest == count


def test_between_a_failure_and_a_success_nothing_is_left_to_try() -> None:
    search = Search(100, THOROUGH)
    assert search.learn(80, FOUND) and search.count == 80
    assert search.learn(95, None) and search.count == 95
    assert not search.learn(97, None) and search.fewest == 100
    again = Search(100, THOROUGH)
    assert again.learn(90, FOUND) and again.learn(90, None) and again.count == 90
    assert again.learn(90, None) and again.count == 91  # tried twice: one more
    better = Found(FOUND.arcs, 2e-9)
    assert not again.learn(90, better) and again.best is better and again.fewest == 91


def test_each_curve_is_searched_as_long_as_it_needs_whatever_the_others_do() -> None:
    easy, hard = (
        spline(3, [0] * 4 + [1] * 4, [(1e-3 * x, 1e-3 * y) for x, y in p]) for p in (BOW, [(0, 0), (3, 0), (2, 4), (5, 4)])
    )

    def counts(*curves: Curve) -> list[int]:
        found = fewest(Bundle(curves), np.array([1e-5, 1e-7][-len(curves) :]), 20)
        return [len(one.arcs.curvatures) for one in found if one is not None]

    one, other = counts(easy, hard)
    assert 2 <= one < 10 < other and [other] == counts(hard)


def parts(curve: Curve, tolerance: float) -> list[Part]:
    (result,) = parts_of([curve], [tolerance])
    return result


def rational_arc(radius: float, sweep: float, spans: int, decimals: int = 16) -> Curve:
    """A circular arc as `spans` rational parabolas with doubled knots, control points in metres, rounded in millimetres."""
    half = sweep / spans / 2.0
    angles = half * np.arange(2 * spans + 1)
    far = np.where(np.arange(2 * spans + 1) % 2 == 1, 1.0 / math.cos(half), 1.0)
    points = radius * far[:, None] * np.column_stack((np.cos(angles), np.sin(angles))) + np.array([3e-3, -1e-3])
    weights = np.where(np.arange(2 * spans + 1) % 2 == 1, math.cos(half), 1.0)
    knots = [0, *np.repeat(np.arange(spans + 1), 2).tolist(), spans]
    return spline(2, knots, np.round(1e3 * points, decimals) / 1e3, weights.tolist())


@pytest.mark.parametrize("spans", [3, 4, 5, 7, 12])
@pytest.mark.parametrize("decimals", [16, 8])
def test_full_circle_of_any_number_of_spans(spans: int, decimals: int) -> None:
    (part,) = parts(rational_arc(2e-3, TURN, spans, decimals), 1e-7)
    assert isinstance(part.edge, Arc) and part.edge.sweep == TURN
    assert (part.edge.x, part.edge.y, part.edge.radius) == pytest.approx(
        (3e-3, -1e-3, 2e-3), abs=1e-13 + 10.0 ** -(decimals + 2)
    )


@pytest.mark.parametrize("sweep", [0.3, 1.0, 3.5, 6.0, -0.3, -3.5])
def test_rational_arcs(sweep: float) -> None:
    (part,) = parts(rational_arc(2e-3, sweep, 3), 1e-7)
    assert isinstance(part.edge, Arc) and part.edge.sweep == pytest.approx(sweep, rel=1e-9)


def test_line_arc_line_in_one_spline() -> None:
    """A rounded corner as one quadratic spline."""
    h = math.sqrt(0.5)
    points = 1e-3 * np.array([(-3, -1), (-1.5, -1), (0, -1), (1, -1), (1, 0), (1, 2), (1, 4)])
    curve = spline(2, [0, 0, 0, 1, 1, 2, 2, 3, 3, 3], points, [1, 1, 1, h, 1, 1, 1])
    one, two, three = (part.edge for part in parts(curve, 1e-7))
    assert one == Line(-3e-3, -1e-3, 0.0, -1e-3) and three == Line(1e-3, 0.0, 1e-3, 4e-3)
    assert isinstance(two, Arc) and (two.radius, two.sweep) == pytest.approx((1e-3, math.pi / 2), rel=1e-12)


def four_cubics(radius: float) -> Curve:
    k = 0.5522847498307936
    quarter = [(1, 0), (1, k), (k, 1), (0, 1)]
    points = [(1, 0)]
    for turn in range(4):
        c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[turn]
        points += [(c * x - s * y, s * x + c * y) for x, y in quarter[1:]]
    return spline(3, [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 4], radius * np.array(points, dtype=float))


def test_four_cubics_within_the_tolerance_are_a_circle() -> None:
    """They bulge by 2.7253e-4 of the radius at most; the best circle halves that."""
    fit = whole_circle(four_cubics(5e-4), 1e-7)
    assert fit is not None
    (edge,) = fit.edges
    assert isinstance(edge, Arc) and abs(edge.sweep) == TURN
    assert edge.radius == pytest.approx(5e-4 * (1 + 1.5e-4), rel=1e-4)
    assert 0.5 * 2.7253e-4 * 5e-4 <= fit.deviation <= 1e-7


def test_four_cubics_beyond_the_tolerance_and_spirals_are_none() -> None:
    assert whole_circle(four_cubics(2e-3), 1e-7) is None
    assert whole_circle(spiral(2e-3, 1e-5, 1.0), 1e-7) is None
    assert all(part.edge is None for part in parts(spiral(2e-3, 1e-4, 1.0), 1e-7))


def uneven_circle(centre: tuple[float, float], radius: float, sweeps: list[float]) -> Curve:
    """A circle of rational parabolas, each with its own share of the turn (rad)."""
    borders = np.concatenate(([0.0], np.cumsum(sweeps)))
    angles, weights = [0.0], [1.0]
    for start, sweep in zip(borders, sweeps, strict=False):
        angles += [start + 0.5 * sweep, start + sweep]
        weights += [math.cos(0.5 * sweep), 1.0]
    points = np.column_stack((np.cos(angles), np.sin(angles))) * radius / np.array(weights)[:, None] + np.array(centre)
    knots = [0, *np.repeat(np.arange(len(sweeps) + 1), 2).tolist(), len(sweeps)]
    return spline(2, knots, points, weights)


def test_a_circle_is_known_by_its_points_however_they_crowd_on_one_side() -> None:
    fit = whole_circle(uneven_circle((3e-3, -1e-3), 2e-3, [0.2, 0.3, 0.5, 1.0, 2.0, TURN - 4.0]), 1e-9)
    assert fit is not None
    (edge,) = fit.edges
    assert isinstance(edge, Arc) and (edge.x, edge.y, edge.radius) == pytest.approx((3e-3, -1e-3, 2e-3), rel=1e-9)


def test_how_far_a_curve_is_open_is_measured_along_its_control_polygon() -> None:
    """Sides of 3 mm, 4 mm and 1 mm, the ends 2 mm and 4 mm apart; what has no length is open."""
    sides = spline(3, [0, 0, 0, 0, 1, 1, 1, 1], 1e-3 * np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 4.0), (2.0, 4.0)]))
    assert sides.open_by() == pytest.approx(math.hypot(2.0, 4.0) / 8.0, rel=1e-12)
    turned = spline(3, [0, 0, 0, 0, 1, 1, 1, 1], 1e-3 * np.array([(0.0, 0.0), (0.0, 3.0), (-4.0, 3.0), (-4.0, 2.0)]))
    assert turned.open_by() == pytest.approx(math.hypot(2.0, 4.0) / 8.0, rel=1e-12)
    assert spline(2, [0, 0, 0, 1, 1, 1], np.zeros((3, 2))).open_by() == math.inf


def test_joined_makes_one_circle_of_four_quarters() -> None:
    quarters = [Arc(1e-3, 2e-3, 5e-3, k * math.pi / 2, math.pi / 2) for k in range(4)]
    edges, moved = joined(quarters, 1e-7)
    assert edges == [Arc(1e-3, 2e-3, 5e-3, 0.0, TURN)] and moved == 0.0


def test_joined_keeps_different_circles() -> None:
    two = [Arc(0.0, 0.0, 5e-3, 0.0, 1.0), Arc(0.0, 0.0, 5.0001e-3, 1.0, 1.0), Line(0.0, 0.0, 1.0, 0.0)]
    assert joined(two, 1e-7)[0] == two


def test_straight_curve_that_turns_back_near_its_end_is_not_one_line() -> None:
    """It overshoots its end by 0.9 µm, between any samples that are looked at."""
    curve = spline(3, [0] * 4 + [1] * 4, 1e-3 * np.array([(0, 0), (1, 0), (3.05, 0), (3, 0)]))
    (part,) = parts(curve, 1e-7)
    assert part.edge is None
    furthest = float(np.max(curve.points(np.linspace(0.0, 1.0, 100_001))[:, 0]))
    ends = [edge.end[0] for edge in fit_arcs(curve, 1e-7).edges]
    assert max(ends) == pytest.approx(furthest, abs=1e-10) and furthest > 3.0008e-3
    assert ends[-1] == pytest.approx(3e-3, abs=1e-15)


def test_weights_along_a_straight_line_bend_nothing() -> None:
    points = 1e-3 * np.array([(0, 0), (1, 2), (2, 4), (5, 10)])
    (part,) = parts(spline(3, [0] * 4 + [1] * 4, points, [9.0, 1.0, 4.0, 0.2]), 1e-7)
    assert part.edge == Line(0.0, 0.0, 5e-3, 10e-3)
