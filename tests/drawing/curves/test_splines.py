"""Are splines what they are: lines, circles, or curves followed within the tolerance?"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import dxf_text as d
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.dxf_records import DxfError
from watchsim.drawing.splines import spline_from
from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.solids import area

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
