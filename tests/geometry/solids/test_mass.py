"""Are area, centroid and inertia those of the closed forms, and do they move as they must?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.solids import area, mass_properties, section

TINY = 1e-12


def polygon(corners: list[Point]) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)))


def disc(x: float, y: float, r: float) -> Loop:
    return Loop((Arc(x, y, r, 0.3, TURN),))


def sector(r: float, angle: float) -> Loop:
    end = (r * math.cos(angle), r * math.sin(angle))
    return Loop((Line(0.0, 0.0, r, 0.0), Arc(0.0, 0.0, r, 0.0, angle), Line(*end, 0.0, 0.0)))


def test_disc() -> None:
    r, x, y = 2.5e-3, 7e-3, -3e-3
    found = section([disc(x, y, r)])
    assert found.area == pytest.approx(math.pi * r**2, rel=TINY, abs=0.0)
    assert found.centroid == pytest.approx((x, y), rel=TINY, abs=0.0)
    assert found.about((x, y)).polar == pytest.approx(math.pi * r**4 / 2, rel=TINY, abs=0.0)
    assert found.about((0.0, 0.0)).polar == pytest.approx(
        math.pi * r**4 / 2 + math.pi * r**2 * (x * x + y * y), rel=TINY, abs=0.0
    )


def test_ring_of_two_circles() -> None:
    outer, inner = 3e-3, 2.9e-3
    found = section([disc(0, 0, outer), disc(0, 0, inner).reversed()])
    assert found.area == pytest.approx(math.pi * (outer**2 - inner**2), rel=TINY, abs=0.0)
    assert found.about((0.0, 0.0)).polar == pytest.approx(math.pi / 2 * (outer**4 - inner**4), rel=TINY, abs=0.0)


@pytest.mark.parametrize("angle", [1e-3, 0.1, 0.7, 1.39, 1.41, math.pi / 2, math.pi, 4.0, 6.2])
def test_sector(angle: float) -> None:
    r = 1.7e-3
    found = section([sector(r, angle)])
    distance = 4.0 * r * math.sin(angle / 2) / (3.0 * angle)
    assert found.area == pytest.approx(r * r * angle / 2, rel=TINY, abs=0.0)
    assert found.centroid == pytest.approx((distance * math.cos(angle / 2), distance * math.sin(angle / 2)), rel=1e-11, abs=0.0)
    assert found.about((0.0, 0.0)).polar == pytest.approx(angle * r**4 / 4, rel=TINY, abs=0.0)


@pytest.mark.parametrize("h", [1e-4, 1e-3, 0.02, 0.3, 0.6999, 0.7001, 1.2, 2.0, 3.0])
def test_circular_segment_against_high_precision(h: float) -> None:
    mpmath = pytest.importorskip("mpmath")
    with mpmath.workdps(50):
        s, c, a = mpmath.sin(h), mpmath.cos(h), mpmath.mpf(h)
        exact = (a - s * c, s - s**3 / 3 - a * c, a / 2 + a * c * c - 3 * s * c / 2)
    loop = Loop((Arc(0.0, 0.0, 1.0, -h, 2.0 * h), Line(math.cos(h), math.sin(h), math.cos(h), -math.sin(h))))
    middle = (math.cos(h), 0.0)
    found = section([loop]).about(middle)
    assert found.area == pytest.approx(float(exact[0]), rel=1e-11, abs=0.0)
    assert found.first_x == pytest.approx(float(exact[1]), rel=1e-9, abs=0.0)
    assert found.polar == pytest.approx(float(exact[2]), rel=1e-9, abs=0.0)


def test_rectangle_and_triangle() -> None:
    b, h = 3e-3, 1e-3
    plate = section([polygon([(0, 0), (b, 0), (b, h), (0, h)])])
    assert plate.area == pytest.approx(b * h, rel=TINY, abs=0.0)
    assert plate.about(plate.centroid).polar == pytest.approx(b * h * (b * b + h * h) / 12, rel=TINY, abs=0.0)
    triangle = section([polygon([(0, 0), (b, 0), (0, h)])])
    assert triangle.centroid == pytest.approx((b / 3, h / 3), rel=TINY, abs=0.0)
    assert triangle.about((0, 0)).polar == pytest.approx(b * h * (b * b + h * h) / 12, rel=TINY, abs=0.0)


def test_stadium_of_two_half_turns() -> None:
    a, r = 4e-3, 1e-3
    loop = Loop(
        (
            Line(-a, -r, a, -r),
            Arc(a, 0.0, r, -math.pi / 2, math.pi),
            Line(a, r, -a, r),
            Arc(-a, 0.0, r, math.pi / 2, math.pi),
        )
    )
    found = section([loop])
    assert found.area == pytest.approx(4 * a * r + math.pi * r * r, rel=TINY, abs=0.0)
    assert found.centroid == pytest.approx((0.0, 0.0), abs=1e-18)
    rectangle = 2 * a * 2 * r * (4 * a * a + 4 * r * r) / 12
    # Two half discs: about their circle's centre π r⁴/4 each, moved by way of their own centroid 4r/(3π) away from it.
    half, d = math.pi * r * r / 2, 4 * r / (3 * math.pi)
    ends = 2 * (math.pi * r**4 / 4 - half * d * d + half * (a + d) ** 2)
    assert found.about((0.0, 0.0)).polar == pytest.approx(rectangle + ends, rel=TINY, abs=0.0)


def test_concave_arc_takes_away() -> None:
    """A square with a quarter circle cut out of a corner."""
    a, r = 3e-3, 1e-3
    loop = Loop(
        (
            Line(0, 0, a, 0),
            Line(a, 0, a, a - r),
            Arc(a, a, r, -math.pi / 2, -math.pi / 2),
            Line(a - r, a, 0, a),
            Line(0, a, 0, 0),
        )
    )
    assert area(loop) == pytest.approx(a * a - math.pi * r * r / 4, rel=TINY, abs=0.0)


def test_huge_radius_keeps_its_digits() -> None:
    """A plate whose upper side is bent to a radius of a kilometre: the segment is a nanometre high."""
    width, r = 2e-3, 1e3
    h = math.asin(width / 2 / r)
    arc = Arc(0.0, -r * math.cos(h), r, math.pi / 2 - h, 2 * h)
    loop = Loop(
        (arc, Line(*arc.end, -width / 2, -1e-3), Line(-width / 2, -1e-3, width / 2, -1e-3), Line(width / 2, -1e-3, *arc.start))
    )
    assert area(loop) == pytest.approx(width * 1e-3 + 2.0 / 3.0 * width * (r * (1 - math.cos(h))), rel=1e-9, abs=0.0)


def test_polygons_converge_to_the_arc_with_the_square_of_the_step() -> None:
    exact = section([sector(1e-3, 2.0)])
    errors = []
    for n in (200, 400):
        rim = [(1e-3 * math.cos(2.0 * k / n), 1e-3 * math.sin(2.0 * k / n)) for k in range(n + 1)]
        fine = section([polygon([(0.0, 0.0), *rim])])
        errors.append(abs(fine.area / exact.area - 1.0))
        assert fine.about((0, 0)).polar == pytest.approx(exact.about((0, 0)).polar, rel=1e-4, abs=0.0)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=1e-3, abs=0.0)


def test_mass_of_a_brass_ring_about_any_point() -> None:
    outer, inner, t, rho = 5e-3, 4e-3, 0.2e-3, 8.4e3
    ring = mass_properties([disc(1e-3, 0, outer), disc(1e-3, 0, inner).reversed()], t, rho)
    mass = rho * t * math.pi * (outer**2 - inner**2)
    own = 0.5 * mass * (outer**2 + inner**2)
    assert ring.mass == pytest.approx(mass, rel=TINY, abs=0.0)
    assert ring.centre == pytest.approx((1e-3, 0.0), rel=TINY, abs=1e-17)
    assert ring.inertia == pytest.approx(own + mass * 1e-6, rel=TINY, abs=0.0)
    assert ring.inertia_about((1e-3, 0.0)) == pytest.approx(own, rel=1e-11, abs=0.0)
    assert ring.inertia_about((4e-3, -4e-3)) == pytest.approx(own + mass * 25e-6, rel=1e-11, abs=0.0), "3 mm and 4 mm away"


def test_no_area_is_refused() -> None:
    with pytest.raises(ValueError, match="enclose no area"):
        mass_properties([disc(0, 0, 1e-3).reversed()], 1e-4, 8000.0)


def test_trimesh_solid_of_the_same_outline() -> None:
    trimesh = pytest.importorskip("trimesh")
    shapely = pytest.importorskip("shapely")
    n, r, t, rho = 2000, 2e-3, 0.1e-3, 7.85e3
    rim = [(r * math.cos(TURN * k / n), r * math.sin(TURN * k / n)) for k in range(n)]
    hole = [(0.4e-3, -0.4e-3), (0.4e-3, 0.5e-3), (-0.5e-3, 0.5e-3)]
    solid = trimesh.creation.extrude_polygon(shapely.Polygon(rim, [hole]), t)
    solid.density = rho
    ours = mass_properties([disc(0, 0, r), polygon(hole) if area(polygon(hole)) < 0 else polygon(hole[::-1])], t, rho)
    assert solid.mass == pytest.approx(ours.mass, rel=3e-6, abs=0.0)
    assert solid.center_mass[:2] == pytest.approx(ours.centre, rel=3e-5, abs=0.0)
    assert solid.moment_inertia[2, 2] == pytest.approx(ours.inertia_about(ours.centre), rel=6e-6, abs=0.0)


@st.composite
def outlines(draw: st.DrawFn) -> Loop:
    """A star-shaped closed outline of lines and arcs, millimetre size, anywhere."""
    n = draw(st.integers(3, 9))
    radii = [draw(st.floats(0.5e-3, 3e-3)) for _ in range(n)]
    x, y = draw(st.floats(-0.05, 0.05)), draw(st.floats(-0.05, 0.05))
    corners = [(x + r * math.cos(TURN * k / n), y + r * math.sin(TURN * k / n)) for k, r in enumerate(radii)]
    edges: list[Edge] = []
    for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
        sweep = draw(st.sampled_from((0.0, 0.01, 0.4, -0.3, 1.5, 3.0)))
        edges.append(arc_between(a, b, sweep) if sweep else Line(*a, *b))
    return Loop(tuple(edges))


def arc_between(a: Point, b: Point, sweep: float) -> Arc:
    dx, dy = b[0] - a[0], b[1] - a[1]
    lift = 0.5 / math.tan(0.5 * sweep)
    cx, cy = 0.5 * (a[0] + b[0]) - lift * dy, 0.5 * (a[1] + b[1]) + lift * dx
    return Arc(cx, cy, math.hypot(a[0] - cx, a[1] - cy), math.atan2(a[1] - cy, a[0] - cx), sweep)


@given(outlines(), st.floats(-7, 7), st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
def test_rigid_motion_changes_nothing_but_the_place(loop: Loop, angle: float, dx: float, dy: float) -> None:
    before, after = section([loop]), section([loop.moved(angle, (dx, dy))])
    # Coordinates are up to 0.15 m and the part is a few millimetres: their rounding, 3e-17 m, is 1e-14 of it.
    assert after.area == pytest.approx(before.area, rel=1e-11, abs=0.0)
    x, y = before.centroid
    c, s = math.cos(angle), math.sin(angle)
    assert after.centroid == pytest.approx((c * x - s * y + dx, s * x + c * y + dy), abs=1e-14)
    own = before.about(before.centroid).polar
    assert after.about(after.centroid).polar == pytest.approx(own, rel=1e-10, abs=0.0)


@given(outlines())
def test_reversed_counts_negative(loop: Loop) -> None:
    one, other = section([loop]), section([loop.reversed()])
    p = loop.edges[0].start
    assert other.area == pytest.approx(-one.area, rel=1e-12, abs=0.0)
    assert other.about(p).polar == pytest.approx(-one.about(p).polar, rel=1e-11, abs=0.0)


@settings(max_examples=25)
@given(outlines())
def test_against_fine_polygon(loop: Loop) -> None:
    """Independent of the closed forms: sampled outline, Gauss's formula in numpy."""
    t = np.linspace(0.0, 1.0, 2000, endpoint=False)
    points = np.concatenate([np.array([edge.point(k) for k in t]) for edge in loop.edges])
    x, y = (points - points.mean(axis=0)).T
    gauss = 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    assert area(loop) == pytest.approx(gauss, rel=2e-6, abs=0.0)


@given(outlines(), st.floats(-3.0, 3.0), st.floats(-0.01, 0.01))
def test_mirror_images_have_the_same_moments(loop: Loop, angle: float, x: float) -> None:
    """Across any line, with the material still on the left; the image of the image is the outline itself."""
    line = ((x, -2.0 * x), (math.cos(angle), math.sin(angle)))
    image = loop.reflected(*line)
    one, other = section([loop]), section([image])
    assert other.area == pytest.approx(one.area, rel=1e-11, abs=0.0)
    assert other.about(other.centroid).polar == pytest.approx(one.about(one.centroid).polar, rel=1e-10, abs=0.0)
    for edge, back in zip(loop.edges, image.reflected(*line).edges, strict=True):
        assert back.start == pytest.approx(edge.start, abs=1e-15) and back.end == pytest.approx(edge.end, abs=1e-15)


def test_a_gap_between_two_edges_is_bridged_by_a_straight_bit() -> None:
    """The same as with the bit drawn; also between the last edge and the first."""
    p = [(0.0, 0.0), (4e-3, 0.0), (4e-3, 1e-3), (3e-3, 3e-3), (1e-3, 3e-3), (0.0, 2e-3)]
    whole = Loop(tuple(Line(*a, *b) for a, b in zip(p, [*p[1:], p[0]], strict=True)))
    for missing in range(6):
        torn = Loop(tuple(edge for k, edge in enumerate(whole.edges) if k != missing))
        assert area(torn) == pytest.approx(area(whole), rel=1e-13, abs=0.0)
        one, other = (mass_properties([loop], 1e-3, 7850.0) for loop in (torn, whole))
        assert one.centre == pytest.approx(other.centre, rel=1e-12, abs=0.0)
        assert one.inertia_about((1.0, 2.0)) == pytest.approx(other.inertia_about((1.0, 2.0)), rel=1e-12, abs=0.0)
