"""Do maps of space put points where matrices put them, and shapes where their points go?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.drawing.projection import (
    Affine,
    Conic,
    Dot,
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
    shifted,
    turned_scaled,
    unit,
)
from watchsim.geometry.primitives import Arc, Line

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
