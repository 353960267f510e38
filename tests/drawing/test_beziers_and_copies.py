"""What becomes of Béziers in a row: lines, splines that run through, circles, and nothing else?"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import dxf_text as d
import numpy as np
import pytest
from scipy.interpolate import BSpline
from shapely import LineString, distance
from shapely import points as shapely_points

from watchsim.drawing.curves import LONGEST, SAMPLES, bezier_points, chained, circle_of, elevated, emit_row, straightened
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.projection import (
    Affine,
    Conic,
    Dot,
    Gathering,
    Shape,
    Spline,
    Straight,
    bulge,
    cosine_sine,
    cross,
    edge_on,
    exact_edge,
    forward,
    object_plane,
    reach,
    shifted,
    turned_scaled,
    unit,
)
from watchsim.drawing.splines import Follower, motion_between
from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import TURN, Arc, Line

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
        (chain,) = chained(cut(points, shares), 1e-9)
        assert chain.curves == len(shares) + 1 and chain.moved < 1e-12 and chain.spline.degree == 3
        spline, t = curve_of(chain.spline), np.linspace(0.0, 1.0, 33)
        start, stop = chain.spline.knots[3], chain.spline.knots[-4]
        assert len(chain.spline.knots) == len(chain.spline.points) + 4
        assert spline(start + t * (stop - start)) == pytest.approx(curve_of(bezier(points))(t), abs=1e-9)
    quadratic = cut(RNG.uniform(-5.0, 5.0, (3, 2)), (0.4,))
    assert [chain.curves for chain in chained(quadratic, 1e-9)] == [2] and chained([], 1.0) == []


def meeting_curves(first: float, second: float, off: float = 0.0, bend: float = 0.0) -> list[Spline]:
    """Two cubics that meet at (0, off), with handles of these lengths along x."""
    before = bezier([(-9 * first, 4), (-5 * first, 4), (-first, 0), (0, off)])
    after = bezier([(0, off), (second, second * bend), (5 * second, 4), (9 * second, 4)])
    return [before, after]


@pytest.mark.parametrize("first", [1.0, 0.25])
def test_curves_that_meet_a_little_beside_their_handles_are_joined_within_the_slack(first: float) -> None:
    for second in (1.0, 3.0):
        row = meeting_curves(first, second, 1e-4)
        (chain,) = chained(row, 1.1e-4)
        assert chain.curves == 2 and chain.moved == pytest.approx(1e-4, rel=1e-6)
        assert [(part.curves, part.moved) for part in chained(row, 0.9e-4)] == [(1, 0.0), (1, 0.0)]
        assert [part.spline for part in chained(row, 0.9e-4)] == row
        assert len(chained(meeting_curves(first, second, 0.0, 0.5), 1e-3)) == 2  # a corner
    away = chained([*meeting_curves(1.0, 1.0, 1e-4), *meeting_curves(1.0, 1.0, 5e-5)], 1e-3)
    assert [(part.curves, round(part.moved, 9)) for part in away] == [(2, 1e-4), (2, 5e-5)]


def test_handles_of_no_length_or_of_very_unlike_length_end_a_spline() -> None:
    for ratio, count in ((0.9e6, 1), (1.1e6, 2)):
        assert len(chained(meeting_curves(1.0, ratio), 1e-9)) == count
        assert len(chained(meeting_curves(ratio, 1.0), 1e-9)) == count
    assert len(chained(meeting_curves(1.0, 0.0), 1.0)) == len(chained(meeting_curves(0.0, 1.0), 1.0)) == 2


def test_short_handles_are_handles() -> None:
    assert len(chained(meeting_curves(1e-3, 1.0), 1e-9)) == len(chained(meeting_curves(1.0, 1e-3), 1e-9)) == 1


def test_splines_grow_only_so_long() -> None:
    row = cut(np.array([(0.0, 0.0), (1.0, 2.0), (3.0, 2.0), (4.0, 0.0)]), [k / (LONGEST + 2) for k in range(1, LONGEST + 2)])
    assert [chain.curves for chain in chained(row, 1e-6)] == [LONGEST, 2]


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


Reader = Callable[..., Drawing]
CONTROL = np.array([0.3 + 0.1j, 1.0 + 2.0j, 2.5 - 1.5j, 4.0 + 0.7j])  # mm
KNOTS = [0.0] * 4 + [1.0] * 4
MOTIONS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "shifted": lambda z: z + (7 - 3j),
    "turned": lambda z: np.exp(0.7j) * z + (1 + 9j),
    "turned by half": lambda z: -z,
    "mirrored": lambda z: z.conjugate(),
    "mirrored and turned": lambda z: np.exp(2.1j) * z.conjugate() - 5,
}


def spline(control: np.ndarray) -> Spline:
    return Spline(3, KNOTS, [(z.real, z.imag, 0.0) for z in control])


def furthest(control: np.ndarray, loop: Loop) -> float:
    """The largest distance (m) of a cubic, by its Bernstein polynomials, from a chain."""
    t = np.linspace(0.0, 1.0, 2001)
    z = 1e-3 * sum(math.comb(3, k) * t**k * (1 - t) ** (3 - k) * control[k] for k in range(4))
    return float(np.max(distance(LineString(polyline(loop, 1e-10)), shapely_points(z.real, z.imag))))


@pytest.mark.parametrize("name", MOTIONS)
def test_a_copy_has_the_arcs_of_the_first_and_lies_on_its_own_curve(name: str) -> None:
    image = MOTIONS[name](CONTROL)
    follower = Follower(1e-3)
    (one, _), (other, fitted) = follower.edges([spline(CONTROL), spline(image)], [1e-7, 1e-7])
    assert len(follower.places) == 1 and fitted
    assert [edge.radius for edge in one.edges] == [edge.radius for edge in other.edges]
    assert furthest(image, Loop(other.edges, closed=False)) <= other.deviation * 1.001 <= 1.002e-7
    assert math.dist(other.edges[0].start, (1e-3 * image[0].real, 1e-3 * image[0].imag)) < 1e-15
    assert math.dist(other.edges[-1].end, (1e-3 * image[-1].real, 1e-3 * image[-1].imag)) < 1e-15


def test_copies_in_the_decimals_of_a_drawing_are_copies_and_what_they_miss_by_is_told() -> None:
    image = np.round(MOTIONS["turned"](CONTROL), 8)
    follower = Follower(1e-3)
    (one, _), (other, _) = follower.edges([spline(CONTROL), spline(image)], [1e-7, 1e-7])
    assert len(follower.places) == 1
    assert one.deviation < other.deviation < one.deviation + 1e-11


@pytest.mark.parametrize("change", [1e-6j, 1.001, 0.5])
def test_other_curves_are_followed_by_themselves(change: complex) -> None:
    image = CONTROL.copy()
    image[2] = image[2] + change if isinstance(change, complex) else image[2] * change
    follower = Follower(1e-3)
    _, (other, _) = follower.edges([spline(CONTROL), spline(image)], [1e-7, 1e-7])
    assert len(follower.places) == 2
    assert furthest(image, Loop(other.edges, closed=False)) <= 1.002e-7


def test_another_tolerance_or_size_is_no_copy() -> None:
    follower = Follower(1e-3)
    results = follower.edges([spline(CONTROL), spline(CONTROL + 1), spline(2.0 * CONTROL)], [1e-7, 1e-8, 1e-7])
    assert len(follower.places) == 3
    few, many, larger = (len(fit.edges) for fit, _ in results)
    assert many > 1.6 * few and larger > few


def test_blocks_turned_and_mirrored_lie_where_they_are_inserted(read_bytes: Reader) -> None:
    tags: list[d.Tag] = [(70, 8), (71, 3), (72, 8), (73, 4), *((40, knot) for knot in KNOTS)]
    body = d.record("SPLINE", *tags, *(tag for z in CONTROL for tag in d.point(10, (z.real, z.imag))))
    inserts = d.insert("B", (0, 0)) + d.insert("B", (10, 0), (50, 30.0)) + d.insert("B", (0, 10), (41, -1.0))
    drawing = read_bytes(d.dxf(inserts + d.insert("B", (10, 10), (42, 2.0)), blocks=d.block("B", body)))
    images = [
        CONTROL,
        10 + np.exp(1j * math.pi / 6) * CONTROL,
        10j - CONTROL.conjugate(),
        10 + 10j + CONTROL.real + 2j * CONTROL.imag,
    ]
    assert len(drawing.open_chains) == len(images)
    for image, loop in zip(images, drawing.open_chains, strict=True):
        assert furthest(image, loop) <= 1.002e-7
    assert drawing.fitted_curves == 4 and drawing.fitted_deviation <= 1e-7 * (1 + 1e-6)


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("turn", [1.0, 1j, -1.0])
def test_the_motion_between_points_is_found(name: str, turn: complex) -> None:
    """Whichever of them lies furthest out."""
    z = turn * CONTROL
    motion, away = motion_between(z, MOTIONS[name](z), "mirrored" in name)
    assert away < 1e-14 * 10.0 and abs(motion.turn) == pytest.approx(1.0)
    assert motion_between(z, 1.01 * MOTIONS[name](z), "mirrored" in name)[1] > 5e-3


def test_a_map_that_is_not_told_leaves_everything_where_it_is() -> None:
    assert Affine().direction((1.0, 2.0, 3.0)) == (1.0, 2.0, 3.0)
    assert Affine().origin == (0.0, 0.0, 0.0)


Triple = tuple[float, float, float]
DRAWN = np.random.default_rng(7).uniform(-7.0, 7.0, (5, 8, 3)).tolist()  # five times eight vectors
VECTORS = [[tuple(vector) for vector in row] for row in DRAWN]


def matrix(affine: Affine) -> np.ndarray:
    """As it stands in books: four columns, of which the last shifts."""
    whole = np.eye(4)
    whole[:3] = np.column_stack(affine)
    return whole


def on(conic: Conic, share: float) -> np.ndarray:
    t = conic.start + share * conic.sweep
    return np.array(conic.centre) + math.cos(t) * np.array(conic.u) + math.sin(t) * np.array(conic.v)


@pytest.mark.parametrize("v", VECTORS)
def test_maps_are_matrices(v: list[Triple]) -> None:
    outer, inner, p = Affine(*v[:4]), Affine(*v[4:]), v[3]
    assert outer.point(p) == pytest.approx((matrix(outer) @ [*p, 1.0])[:3], abs=1e-9)
    assert outer.direction(p) == pytest.approx((matrix(outer) @ [*p, 0.0])[:3], abs=1e-9)
    assert np.allclose(matrix(outer.after(inner)), matrix(outer) @ matrix(inner), atol=1e-8)


@pytest.mark.parametrize("v", VECTORS)
def test_cross_products_and_unit_vectors(v: list[Triple]) -> None:
    assert cross(v[0], v[1]) == pytest.approx(np.cross(v[0], v[1]), abs=1e-9)
    assert unit((0.0, 0.0, 0.0)) == (0.0, 0.0, 1.0) and unit((3e-9, 0.0, -4e-9)) == pytest.approx((0.6, 0.0, -0.8))
    assert unit(v[0]) == pytest.approx(np.array(v[0]) / np.linalg.norm(v[0]), abs=1e-12)


@pytest.mark.parametrize("v", VECTORS)
def test_scaled_first_and_then_turned(v: list[Triple]) -> None:
    angle, scale = v[0][0], v[1]
    c, s = math.cos(angle), math.sin(angle)
    expected = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.diag(scale)
    assert np.allclose(matrix(turned_scaled(angle, scale))[:3, :3], expected, atol=1e-10)
    assert turned_scaled(angle, scale).origin == (0.0, 0.0, 0.0)
    assert np.array_equal(matrix(shifted(scale)), np.block([[np.eye(3), np.array(scale)[:, None]], [0.0, 0.0, 0.0, 1.0]]))


@pytest.mark.parametrize("turns", [-5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7])
def test_quarter_turns_are_exact_and_what_is_a_little_off_is_not(turns: int) -> None:
    exact = {0: (1.0, 0.0), 1: (0.0, 1.0), 2: (-1.0, 0.0), 3: (0.0, -1.0)}[turns % 4]
    assert cosine_sine(turns * 0.5 * math.pi) == exact
    for off in (1e-9, -1e-9):
        angle = turns * 0.5 * math.pi + off
        assert cosine_sine(angle) == (math.cos(angle), math.sin(angle)) != exact


@pytest.mark.parametrize(
    "normal",
    [
        (0.3, -0.4, 0.5),
        (0.0, 0.0, -2.0),
        (1.0, 0.0, 0.0),
        (0.0, -3.0, 0.0),
        (0.01, 0.01, 1.0),
        (1e-3, 0.0, 1.0),
        (0.0, 1e-3, 1.0),
    ],
)
def test_object_planes_are_square_and_right_handed(normal: Triple) -> None:
    plane = matrix(object_plane(normal))[:3, :3]
    assert np.allclose(plane.T @ plane, np.eye(3), atol=1e-14) and np.linalg.det(plane) == pytest.approx(1.0)
    assert plane[:, 2] == pytest.approx(np.array(normal) / np.linalg.norm(normal))


@pytest.mark.parametrize(
    ("slant", "level"),
    [
        ((0.9, 0.9), False),
        ((-0.9, -0.9), False),
        ((1.1, 0.0), True),
        ((0.0, -1.1), True),
        ((-1.1, 0.5), True),
        ((0.5, -1.1), True),
    ],
)
def test_the_x_axis_is_level_where_the_normal_is_not_nearly_upright(slant: tuple[float, float], level: bool) -> None:
    """DXF reference, arbitrary axis algorithm: within 1/64 of z the y axis of the world is taken for the cross product."""
    x, y = slant[0] / 64.0, slant[1] / 64.0
    ax = object_plane((x, y, math.sqrt(1.0 - x * x - y * y))).ax
    assert (ax[2] == 0.0) is level
    assert (ax[1] == 0.0) is not level or x == 0.0


@pytest.mark.parametrize("v", VECTORS)
def test_mapped_shapes_are_shapes_of_mapped_points(v: list[Triple]) -> None:
    move, (a, b, c) = Affine(*v[:4]), v[4:7]
    shapes: list[Shape] = [Straight(a, b), Dot(a), Spline(1, [0.0, 0.0, 1.0, 1.0], [a, b], [1.0, 2.0])]
    line, dot, spline = (shape.mapped(move) for shape in shapes)
    assert isinstance(line, Straight) and (line.a, line.b) == (move.point(a), move.point(b))
    assert isinstance(dot, Dot) and dot.at == move.point(a)
    assert isinstance(spline, Spline) and spline.points == [move.point(a), move.point(b)]
    assert (spline.degree, spline.knots, spline.weights) == (1, [0.0, 0.0, 1.0, 1.0], [1.0, 2.0])
    conic = Conic(a, b, c, 0.4, 2.0)
    for share in (0.0, 0.3, 1.0):
        assert on(conic.mapped(move), share) == pytest.approx(np.array(move.point(tuple(on(conic, share)))), abs=1e-8)


@pytest.mark.parametrize("v", VECTORS)
@pytest.mark.parametrize("amount", [0.1, -0.7, 1.0, -1.0, 3.0])
def test_a_bulge_is_twice_the_height_of_the_arc_over_its_chord(v: list[Triple], amount: float) -> None:
    """Positive: from a to b counter-clockwise, so that the arc lies on the right of the chord."""
    a, b = v[0][:2], v[1][:2]
    arc = bulge((*a, 3.0), (*b, 3.0), amount)
    assert isinstance(arc, Conic)
    assert on(arc, 0.0) == pytest.approx(np.array([*a, 3.0]), abs=1e-7) and on(arc, 1.0)[:2] == pytest.approx(
        np.array(b), abs=1e-7
    )
    chord = np.subtract(b, a)
    height = 0.5 * amount * np.array([chord[1], -chord[0]])
    assert on(arc, 0.5)[:2] == pytest.approx(np.add(a, b) / 2.0 + height, abs=1e-7)
    assert arc.sweep * amount > 0.0 and abs(arc.sweep) <= math.tau


@pytest.mark.parametrize("amount", [0.0, 9e-9, -9e-9])
def test_a_bulge_below_rounding_is_none(amount: float) -> None:
    assert bulge((1.0, 2.0, 0.0), (4.0, 2.0, 0.0), amount) == Straight((1.0, 2.0, 0.0), (4.0, 2.0, 0.0))
    for least in (1.1e-8, -1.1e-8, 1e-3):
        assert isinstance(bulge((1.0, 2.0, 0.0), (4.0, 2.0, 0.0), least), Conic)
    for b in ((1.0, 5.0, 0.0), (4.0, 2.0, 0.0)):
        assert isinstance(bulge((1.0, 2.0, 0.0), b, 0.5), Conic)
    assert bulge((1.0, 2.0, 0.0), (1.0, 2.0, 0.0), 0.5) == Straight((1.0, 2.0, 0.0), (1.0, 2.0, 0.0))


@pytest.mark.parametrize("mirror", [1.0, -1.0])
@pytest.mark.parametrize("sweep", [2.0, -2.0, math.tau])
@pytest.mark.parametrize("angle", [0.7, 1.3, 4.0])
def test_circles_seen_straight_on_are_arcs(mirror: float, sweep: float, angle: float) -> None:
    turn = turned_scaled(angle, (3.0, 3.0 * mirror, 1.0))
    conic = Conic((2.0, 5.0, 1.0), turn.direction((1.0, 0.0, 0.0)), turn.direction((0.0, 1.0, 0.0)), 0.4, sweep)
    arc = exact_edge(conic, 1e-3)
    assert isinstance(arc, Arc)
    for share in (0.0, 0.25, 0.5, 1.0):
        assert arc.point(share) == pytest.approx(1e-3 * on(conic, share)[:2], rel=1e-12, abs=0.0)
    line = exact_edge(Straight((1.0, 2.0, 9.0), (3.0, 5.0, 7.0)), 1e-3)
    assert line == Line(1e-3 * 1.0, 1e-3 * 2.0, 1e-3 * 3.0, 1e-3 * 5.0)


@pytest.mark.parametrize(("part", "round_one"), [(0.8e-9, True), (-0.8e-9, True), (1.2e-9, False), (-1.2e-9, False)])
def test_axes_that_differ_by_a_thousand_millionth_make_an_ellipse(part: float, round_one: bool) -> None:
    for turned in (0.0, 1.0, 2.0):
        c, s = math.cos(turned), math.sin(turned)
        longer = Conic(
            (0.0, 0.0, 0.0), (5.0 * c, 5.0 * s, 0.0), (-5.0 * (1.0 + part) * s, 5.0 * (1.0 + part) * c, 0.0), 0.0, 1.0
        )
        skew = Conic((0.0, 0.0, 0.0), (5.0, 0.0, 0.0), (5.0 * math.sin(part), 5.0 * math.cos(part), 0.0), 0.0, 1.0)
        assert [exact_edge(conic, 1.0) is not None for conic in (longer, skew)] == [round_one, round_one]


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_an_ellipse_is_seen_edge_on_where_it_has_no_width(size: float) -> None:
    for width, narrow in ((0.8e-9, True), (-0.8e-9, True), (1.2e-9, False), (-1.2e-9, False)):
        lying = [((1.0, 0.0), (0.3, width)), ((0.0, width), (1.0, 0.3 * width)), ((0.6, 0.8), (-0.8 * width, 0.6 * width))]
        for u, v in [*lying, ((width, 0.0), (0.3 * width, 1.0))]:
            conic = Conic((0.0, 0.0, 0.0), (size * u[0], size * u[1], 4.0), (size * v[0], size * v[1], 0.0), 0.0, 1.0)
            largest = max(math.hypot(*u), math.hypot(*v)) ** 2
            assert edge_on(conic) is (abs(u[0] * v[1] - u[1] * v[0]) <= 1e-9 * largest) is narrow


@pytest.mark.parametrize("sweep", [1.5, 5e-4, -1.5, -math.tau])
def test_a_curve_told_forward_is_the_same_curve(sweep: float) -> None:
    conic = Conic((1.0, 2.0, 3.0), (4.0, 1.0, 0.5), (-1.0, 2.0, 0.25), 0.3, sweep)
    told = forward(conic)
    assert told.sweep == abs(sweep)
    for share in (0.0, 0.4, 1.0):
        assert on(told, share) == pytest.approx(on(conic, share), abs=1e-12)


KAPPA = 4.0 / 3.0 * (math.sqrt(2.0) - 1.0)  # of the radius: the usual Béziers of a quarter


def quarters(radius: float, way: float) -> list[Spline]:
    """Four Béziers round the point (1, 2); `way` 1 counter-clockwise, -1 clockwise."""
    made = []
    for k in range(4):
        a, b = way * 0.5 * math.pi * k, way * 0.5 * math.pi * (k + 1)
        (ca, sa), (cb, sb) = (math.cos(a), math.sin(a)), (math.cos(b), math.sin(b))
        r, pull = radius, way * KAPPA * radius
        points = [
            (r * ca, r * sa),
            (r * ca - pull * sa, r * sa + pull * ca),
            (r * cb + pull * sb, r * sb - pull * cb),
            (r * cb, r * sb),
        ]
        made.append(Spline(3, [0.0] * 4 + [1.0] * 4, [(1.0 + x, 2.0 + y, 0.0) for x, y in points], []))
    return made


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_circle_of_beziers_keeps_its_sense(way: float) -> None:
    found = circle_of(quarters(3.0, way), 1e-3)
    assert found is not None
    assert math.isclose(found.arc.sweep, way * math.tau)
    assert math.isclose(found.arc.radius, 3e-3, rel_tol=1e-3) and math.isclose(found.arc.y, 2e-3, rel_tol=1e-6)


def test_what_turns_back_is_no_circle() -> None:
    there = quarters(3.0, 1.0)
    assert circle_of([*there[:2], *quarters(3.0, -1.0)[:2]], 1e-3) is None


def test_a_direction_without_length_is_straight_up() -> None:
    assert unit((0.0, 0.0, 0.0)) == (0.0, 0.0, 1.0)
    assert unit((0.0, 3.0, 4.0)) == (0.0, 0.6, 0.8)


def test_rounding_is_that_of_the_largest_coordinate() -> None:
    """Of all control points in both directions; a circle reaches beyond its centre by its radius."""
    assert reach(Spline(2, [0.0] * 3 + [1.0] * 3, [(1.0, 2.0, 0.0), (-900.0, 3.0, 0.0), (5.0, 70.0, 0.0)], [])) == 900.0
    assert reach(Conic((4.0, -50.0, 0.0), (0.0, 3.0, 0.0), (-3.0, 0.0, 0.0), 0.0, math.tau)) == 53.0
    assert reach(Straight((1.0, -2.0, 0.0), (9.0, 0.0, 0.0))) == 2.0
