"""Are ellipses cut at the ends of their axes, splines at their corners, and do made-up knots draw what was meant?"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import dxf_text as d
import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicSpline

from watchsim.drawing.curves import SLIVER, axis_cuts, ellipses_edges, mirrored, rational
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.dxf_records import DxfError
from watchsim.drawing.projection import Conic, Spline
from watchsim.drawing.splines import (
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
from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.solids import area

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
        *([[0, 1, 2], [2, 3]], [[0, 1, 2], [2, 3]], [[0, 1]], [[3, 4, 5]])
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


Reader = Callable[..., Drawing]


def spline(
    degree: int, knots: Sequence[float], points: Sequence[Sequence[float]], weights: Sequence[float] = (), flags: int = 8
) -> str:
    tags: list[d.Tag] = [(70, flags), (71, degree), (72, len(knots)), (73, len(points))]
    tags += [(40, repr(float(knot))) for knot in knots] + [(41, repr(float(w))) for w in weights]
    for p in points:
        tags += d.point(10, p)
    return d.record("SPLINE", *tags)


def distance_to(points: np.ndarray, loop: Loop) -> float:
    """The largest distance of points to the outline, by shapely on dense vertices."""
    shapely = pytest.importorskip("shapely")
    outline = shapely.LineString(polyline(loop, 1e-10))
    return float(np.max(shapely.distance(outline, shapely.points(points))))


def test_cubic_against_de_casteljau(read_bytes: Reader) -> None:
    control = np.array([(0, 0), (1, 3), (4, 3), (5, -1)], dtype=float)
    drawing = read_bytes(d.dxf(spline(3, (0, 0, 0, 0, 1, 1, 1, 1), control.tolist())))
    assert drawing.fitted_curves == 1 and 0.0 < drawing.fitted_deviation <= 1e-7
    t = np.linspace(0, 1, 3001)[:, None]
    level = [control[k] * np.ones_like(t) for k in range(4)]
    while len(level) > 1:
        level = [(1 - t) * a + t * b for a, b in pairwise(level)]
    (chain,) = drawing.open_chains
    measured = distance_to(1e-3 * level[0], chain)
    assert measured <= 1.002e-7
    assert drawing.fitted_deviation == pytest.approx(measured, rel=0.03)
    for one, other in zip(chain.edges, chain.edges[1:], strict=False):
        assert math.dist(one.end, other.start) < 1e-16
        assert math.dist(one.tangent(1.0), other.tangent(0.0)) < 1e-9


def test_rational_circle_becomes_one_exact_circle(read_bytes: Reader) -> None:
    """The usual nine control points, weights 1 and √½, knots doubled."""
    h = math.sqrt(0.5)
    square = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    weights = [1, h, 1, h, 1, h, 1, h, 1]
    points = [(3 + 2 * x, 1 + 2 * y) for x, y in square]
    drawing = read_bytes(d.dxf(spline(2, (0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4), points, weights)))
    ((edge,),) = [loop.edges for loop in drawing.loops]
    assert isinstance(edge, Arc) and drawing.fitted_curves == 0
    assert (edge.x, edge.y, edge.radius, abs(edge.sweep)) == pytest.approx((3e-3, 1e-3, 2e-3, TURN), rel=1e-13, abs=0.0)


def test_straight_spline_is_a_line(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(spline(2, (5, 5, 5, 9, 9, 9), [(0, 0), (1, 2), (2, 4)])))
    assert drawing.open_chains[0].edges == (Line(0.0, 0.0, 2e-3, 4e-3),)
    assert drawing.fitted_curves == 0


def test_corner_at_a_repeated_knot_stays_sharp(read_bytes: Reader) -> None:
    points = [(0, 0), (1, 2), (2, 0), (3, 2), (4, 0)]
    drawing = read_bytes(d.dxf(spline(2, (0, 0, 0, 1, 1, 2, 2, 2), points)))
    (chain,) = drawing.open_chains
    turns = [math.dist(a.tangent(1.0), b.tangent(0.0)) for a, b in zip(chain.edges, chain.edges[1:], strict=False)]
    assert sorted(turns)[-1] == pytest.approx(2 * 2 / math.sqrt(5), rel=1e-6)
    assert sorted(turns)[-2] < 1e-9
    assert any(math.dist(edge.end, (2e-3, 0.0)) < 1e-15 for edge in chain.edges)


def test_wrapped_uniform_spline_is_a_closed_smooth_loop(read_bytes: Reader) -> None:
    """Closed, unclamped: six points around, three repeated."""
    around = [(math.cos(TURN * k / 6) * (2 + k % 2), math.sin(TURN * k / 6) * (2 + k % 2)) for k in range(6)]
    drawing = read_bytes(d.dxf(spline(3, range(13), [*around, *around[:3]], flags=11)))
    (loop,) = drawing.loops
    assert not drawing.findings
    # independent: uniform cubic B-spline by its basis matrix, Gauss's area formula
    matrix = np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 0, 3, 0], [1, 4, 1, 0]]) / 6.0
    t = np.linspace(0, 1, 2000, endpoint=False)
    powers = np.column_stack((t**3, t**2, t, np.ones_like(t)))
    curve = np.concatenate([powers @ matrix @ np.array([around[(k + j) % 6] for j in range(4)]) for k in range(6)])
    x, y = 1e-3 * curve.T
    gauss = 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    assert area(loop) == pytest.approx(gauss, rel=5e-5, abs=0)
    assert distance_to(1e-3 * curve, loop) <= 1.002e-7
    gaps = [
        math.dist(a.tangent(1.0), b.tangent(0.0)) for a, b in zip(loop.edges, [*loop.edges[1:], loop.edges[0]], strict=True)
    ]
    assert max(gaps) < 1e-7


def test_fit_points_only(read_bytes: Reader) -> None:
    tags: list[d.Tag] = [(70, 8), (71, 3), (72, 0), (73, 0), (74, 4)]
    places = [(0, 0), (1, 1), (2, 0), (3, 1)]
    for p in places:
        tags += d.point(11, p)
    drawing = read_bytes(d.dxf(d.record("SPLINE", *tags)))
    (chain,) = drawing.open_chains
    assert distance_to(1e-3 * np.array(places, dtype=float), chain) < 1.01e-7
    assert chain.edges[0].start == pytest.approx((0, 0), abs=1e-15)
    assert chain.edges[-1].end == pytest.approx((3e-3, 1e-3), abs=1e-15)


def test_closed_through_fit_points_is_one_smooth_outline(read_bytes: Reader) -> None:
    """Flagged as closed, the first point not repeated: scipy's periodic spline with the chords' lengths as parameter."""
    places = np.array([(0, 0), (4, 1), (5, 4), (1, 5), (-1, 2)], dtype=float)
    tags: list[d.Tag] = [(70, 9), (71, 3), (72, 0), (73, 0), (74, 5)]
    (loop,) = read_bytes(d.dxf(d.record("SPLINE", *tags, *(tag for p in places for tag in d.point(11, p))))).loops
    around = np.vstack((places, places[:1]))
    t = np.append(0.0, np.cumsum(np.hypot(*np.diff(around, axis=0).T)))
    truth = CubicSpline(t, around, bc_type="periodic")
    assert distance_to(1e-3 * truth(np.linspace(0.0, t[-1], 2000)), loop) < 1.002e-7
    slopes = truth(t[0], 1) / np.hypot(*truth(t[0], 1))
    assert loop.edges[0].tangent(0.0) == pytest.approx(slopes, abs=1e-9)
    assert loop.edges[-1].tangent(1.0) == pytest.approx(slopes, abs=1e-9)


def test_pause_in_a_spline_does_not_hang(read_bytes: Reader) -> None:
    """Coincident control points: the curve stands still for a while, then goes on round a corner."""
    points = [(0, 0), (1, 0), (1, 0), (1, 0), (1, 0), (1, 1), (0, 1)]
    drawing = read_bytes(d.dxf(spline(3, (0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4), points)))
    (chain,) = drawing.open_chains
    assert drawing.fitted_deviation <= 1.01e-7
    assert len(chain.edges) < 200
    assert distance_to(np.array([(1e-3, 0.0)]), chain) < 1e-7


def test_polygon_spline_with_invisible_facets_becomes_arcs(read_bytes: Reader) -> None:
    """A half ellipse as 997 points: facets of a nanometre are a curve; its two corners stay."""
    t = np.linspace(0, math.pi, 997)
    points = np.column_stack((0.3 * np.cos(t), 0.2 * np.sin(t)))
    drawing = read_bytes(d.dxf(spline(1, [0, *range(997), 996], points.tolist()) + d.line((-0.3, 0), (0.3, 0))))
    (loop,) = drawing.loops
    assert drawing.fitted_curves == 1 and drawing.fitted_deviation <= 1e-7
    assert 6 <= drawing.fitted_arcs <= 30
    assert distance_to(1e-3 * points, loop) <= 1e-7
    assert not drawing.findings


def test_polygon_spline_with_real_corners_stays_lines(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(spline(1, (0, 0, 1, 2, 3, 3), [(0, 0), (1, 0), (1, 1), (0, 1)])))
    assert drawing.open_chains[0].edges == (Line(0, 0, 1e-3, 0), Line(1e-3, 0, 1e-3, 1e-3), Line(1e-3, 1e-3, 0, 1e-3))


@pytest.mark.parametrize(
    ("degree", "knots", "weights", "word"),
    [
        (3, (0, 0, 0, 1, 1, 1), (), "do not make a spline"),
        (0, (0, 0, 0, 0, 1, 1, 1, 1), (), "degree is 0"),
        (3, (0, 0, 0, 0, 1, 1, 0.5, 1), (), "do not ascend"),
        (3, (0, 0, 0, 0, 0, 0, 0, 0), (), "do not ascend"),
        (3, (0, 0, 0, 0, 1, 1, 1, 1), (1, 1, 0, 1), "weights"),
    ],
)
def test_impossible_splines_are_errors(
    read_bytes: Reader, degree: int, knots: Sequence[float], weights: Sequence[float], word: str
) -> None:
    drawing = read_bytes(d.dxf(d.circle(9, 9, 1) + spline(degree, knots, [(0, 0), (1, 1), (2, 0), (3, 1)], weights)))
    (finding,) = drawing.findings
    assert (finding.code, finding.severity) == ("damaged", "error")
    assert word in finding.message


def test_knots_that_differ_by_rounding_are_one_knot(read_bytes: Reader) -> None:
    """Double knots of a rational circle, written with the noise of a converted file."""
    h = math.sqrt(0.5)
    square = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    knots = (0, 1e-14, 0, 0.25, 0.25 + 2e-13, 0.5, 0.5 - 1e-13, 0.75, 0.75, 1, 1 - 1e-14, 1)
    drawing = read_bytes(d.dxf(spline(2, knots, square, [1, h, 1, h, 1, h, 1, h, 1])))
    ((edge,),) = [loop.edges for loop in drawing.loops]
    assert isinstance(edge, Arc) and abs(edge.sweep) == TURN and drawing.fitted_curves == 0


def test_four_cubics_within_the_tolerance_become_one_circle(read_bytes: Reader) -> None:
    """The usual approximation bulges by 2.7253e-4 of the radius; within half a micrometre that is a circle of 1 mm."""
    k = 0.5522847498307936
    around = [(1, 0), (1, k), (k, 1), (0, 1), (-k, 1), (-1, k), (-1, 0), (-1, -k), (-k, -1), (0, -1), (k, -1), (1, -k), (1, 0)]
    knots = (0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 4)
    drawing = read_bytes(d.dxf(spline(3, knots, around)), fit=5e-7)
    ((edge,),) = [loop.edges for loop in drawing.loops]
    assert isinstance(edge, Arc) and (edge.x, edge.y, edge.radius) == pytest.approx((0, 0, 1e-3), abs=1e-12)
    assert drawing.fitted_deviation == pytest.approx(2.7253e-7, rel=3e-3)
    assert len(read_bytes(d.dxf(spline(3, knots, around)), fit=1e-7).loops[0].edges) > 4


def test_fit_points_with_tangents_start_and_end_along_them(read_bytes: Reader) -> None:
    tags: list[d.Tag] = [(70, 8), (71, 3), (72, 0), (73, 0), (74, 3)]
    for code, p in ((12, (0, 1)), (13, (0, -1)), (11, (0, 0)), (11, (1, 1)), (11, (2, 0))):
        tags += d.point(code, p)
    (chain,) = read_bytes(d.dxf(d.record("SPLINE", *tags))).open_chains
    assert chain.edges[0].tangent(0.0) == pytest.approx((0, 1), abs=1e-9)
    assert chain.edges[-1].tangent(1.0) == pytest.approx((0, -1), abs=1e-9)


def test_spline_of_one_point_is_said(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + spline(3, (0, 0, 0, 0, 1, 1, 1, 1), [(2, 1)] * 4)))
    assert [finding.code for finding in drawing.findings] == ["zero-length"]


def test_weights_of_very_unlike_size_are_refused() -> None:
    """Up to a factor of a thousand million they are taken."""
    points = [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (2.0, 0.0, 0.0)]
    knots = [0.0] * 3 + [1.0] * 3
    assert spline_from(2, False, knots, [1.0, 0.9e9, 1.0], points, []).weights == [1.0, 0.9e9, 1.0]
    for weights in ([1.0, 1.1e9, 1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0]):
        with pytest.raises(DxfError, match="weights"):
            spline_from(2, False, knots, weights, points, [])


PLACES = [(0.0, 0.0), (1.0, 2.0), (3.0, 2.5), (4.0, 0.0), (3.0, -2.0), (1.0, -1.5)]


def knotless(*tags: tuple[int, object]) -> bytes:
    control = [tag for place in PLACES for tag in d.point(10, place)]
    return d.dxf(d.record("SPLINE", (71, 3), (73, len(PLACES)), *tags, *control))


def test_an_open_spline_without_knots_is_clamped_and_uniform(read_bytes: Callable[..., Drawing]) -> None:
    knots = [(40, float(knot)) for knot in (0, 0, 0, 0, 1, 2, 3, 3, 3, 3)]
    bare, told = read_bytes(knotless((70, 8))), read_bytes(knotless((70, 8), (72, len(knots)), *knots))
    assert bare.open_chains == told.open_chains and len(bare.open_chains) == 1


def test_a_closed_spline_without_knots_runs_round(read_bytes: Callable[..., Drawing]) -> None:
    """Between two spans a uniform cubic is (p + 4 q + r) / 6 of three neighbouring control points."""
    (loop,) = read_bytes(knotless((70, 9))).loops
    points = 1e3 * polyline(loop, 1e-8)
    for k in range(len(PLACES)):
        before, here, after = (np.array(PLACES[(k + shift) % len(PLACES)]) for shift in (-1, 0, 1))
        place = (before + 4.0 * here + after) / 6.0
        sides, offs = np.diff(points, axis=0), place - points[:-1]
        share = np.clip(np.sum(sides * offs, axis=1) / np.sum(sides * sides, axis=1), 0.0, 1.0)
        assert np.min(np.hypot(*(offs - share[:, None] * sides).T)) < 2e-4
