"""Are area, centroid and inertia those of the closed forms, and do they move as they must?"""

import math
from itertools import pairwise
from pathlib import Path

import mpmath
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.measure_lever import moments
from strangers import PIN_LEVER, marks

from watchsim.drawing.read import read
from watchsim.geometry.hairspring import CHORDS, SHARE, Spiral, drawn_strip, ribbon, spiral_of_length
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.solids import Section, Turned, area, mass_properties, reach, section, turned, upright

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
        (Line(-a, -r, a, -r), Arc(a, 0.0, r, -math.pi / 2, math.pi), Line(a, r, -a, r), Arc(-a, 0.0, r, math.pi / 2, math.pi))
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


X_AXIS = ((0.0, 0.0), (1.0, 0.0))


def polygon_revolution(*corners: Point) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)))


def numbers(found: Turned) -> tuple[float, float, float, float]:
    return found.volume, found.centre, found.axial, found.transverse


def test_cylinder_away_from_the_foot_of_the_axis() -> None:
    r, length, start = 0.25e-3, 0.4e-3, 4.8e-3
    box = polygon_revolution((start, 0.0), (start + length, 0.0), (start + length, r), (start, r))
    volume = math.pi * r * r * length
    expected = (volume, start + length / 2, volume * r * r / 2, volume * (3 * r * r + length * length) / 12)
    assert numbers(turned([box], *X_AXIS)) == pytest.approx(expected, rel=TINY, abs=0.0)


def test_cone() -> None:
    r, h = 0.6e-3, 2e-3
    volume = math.pi * r * r * h / 3
    expected = (volume, h / 4, 0.3 * volume * r * r, volume * 3 / 80 * (4 * r * r + h * h))
    assert numbers(turned([polygon_revolution((0.0, 0.0), (h, 0.0), (0.0, r))], *X_AXIS)) == pytest.approx(
        expected, rel=TINY, abs=0.0
    )


def test_ball_of_a_half_circle() -> None:
    r, x = 1.5e-3, 0.7e-3
    half = Loop((Line(x - r, 0.0, x + r, 0.0), Arc(x, 0.0, r, 0.0, math.pi)))
    volume = 4.0 / 3.0 * math.pi * r**3
    expected = (volume, x, 0.4 * volume * r * r, 0.4 * volume * r * r)
    assert numbers(turned([half], *X_AXIS)) == pytest.approx(expected, rel=TINY, abs=0.0)


def test_torus() -> None:
    a, b = 5e-3, 1e-3
    volume = 2 * math.pi**2 * a * b * b
    expected = (volume, 3e-3, volume * (a * a + 0.75 * b * b), volume * (a * a / 2 + 5 / 8 * b * b))
    ring = Loop((Arc(3e-3, a, b, 0.3, TURN),))
    assert numbers(turned([ring], *X_AXIS)) == pytest.approx(expected, rel=TINY, abs=0.0)


def test_open_lines_are_no_part_of_the_profile() -> None:
    """Not even where they cross the axis."""
    box = Loop(tuple(Line(*a, *b) for a, b in pairwise([(1.0, 0.0), (2.0, 0.0), (2.0, 3.0), (1.0, 3.0), (1.0, 0.0)])))
    stray = Loop((Line(0.0, -9.0, 0.0, 9.0),), closed=False)
    assert upright([stray, box], (0.0, 0.0), (1.0, 0.0)) == upright([box], (0.0, 0.0), (1.0, 0.0))
    assert reach([stray, box], (0.0, 0.0), (1.0, 0.0)) == 3.0


def test_a_bore_is_taken_out() -> None:
    """A tube: the half profile and a rectangular hole of it that reaches the axis are as good as the wall alone."""
    outer = polygon_revolution((0.0, 0.0), (3e-3, 0.0), (3e-3, 2e-3), (0.0, 2e-3))
    groove = polygon_revolution((1e-3, 0.5e-3), (1e-3, 1e-3), (2e-3, 1e-3), (2e-3, 0.5e-3))
    found = turned([outer, groove], *X_AXIS)
    full, gone = math.pi * 4e-6 * 3e-3, math.pi * (1e-6 - 0.25e-6) * 1e-3
    assert found.volume == pytest.approx(full - gone, rel=TINY, abs=0.0)
    assert found.axial == pytest.approx(full * 4e-6 / 2 - gone * (1e-6 + 0.25e-6) / 2, rel=TINY, abs=0.0)


@pytest.mark.parametrize("sweep", [1e-4, 0.02, 1.3, -0.02, -1.3, 3.0])
def test_a_bulging_side_against_quadrature_of_high_precision(sweep: float) -> None:
    """A drum with a side bent outward or inward, against ∫ π y² dx and its like of the formula of the side."""
    half, y0 = 1e-3, 3e-3
    h = 0.5 * abs(sweep)
    radius = half / math.sin(h)
    side = math.copysign(1.0, sweep)
    centre = y0 - side * radius * math.cos(h)
    arc = Arc(0.0, centre, radius, side * (math.pi / 2 - h), side * 2 * h)
    loop = Loop((Line(-half, 0.0, half, 0.0), Line(half, 0.0, *arc.start), arc, Line(*arc.end, -half, 0.0)))
    with mpmath.workdps(40):
        b, r, c = mpmath.mpf(half), mpmath.mpf(half) / mpmath.sin(mpmath.mpf(h)), 0
        c = mpmath.mpf(y0) - side * r * mpmath.cos(mpmath.mpf(h))

        def y(x: mpmath.mpf) -> mpmath.mpf:
            return c + side * mpmath.sqrt(r * r - x * x)

        ends = mpmath.linspace(-b, b, 9)
        volume = mpmath.quad(lambda x: mpmath.pi * y(x) ** 2, ends)
        axial = mpmath.quad(lambda x: mpmath.pi / 2 * y(x) ** 4, ends)
        along = mpmath.quad(lambda x: mpmath.pi * y(x) ** 2 * x * x, ends)
        expected = [float(value) for value in (volume, axial, axial / 2 + along)]
    found = turned([loop], *X_AXIS)
    assert [found.volume, found.axial, found.transverse] == pytest.approx(expected, rel=1e-11, abs=0.0)
    assert abs(found.centre) < 1e-15 * (1.0 + radius)


STAFF = (
    *((-2.0, 0.0), (2.1, 0.0), (2.1, 0.06), (1.9, 0.06), (1.5, 0.3), (0.8, 0.3), (0.8, 0.7)),
    *((0.1, 0.7), (0.1, 0.5), (-1.4, 0.35), (-1.6, 0.05), (-2.0, 0.05)),
)


def test_trimesh_solid_converges_to_it_with_the_square_of_the_step() -> None:
    profile = polygon_revolution(*((1e-3 * x, 1e-3 * y) for x, y in STAFF))
    exact = turned([profile], *X_AXIS)
    errors = []
    for sections in (64, 128, 256):
        solid = trimesh.creation.revolve(np.array([(y, x) for x, y in (*STAFF[::-1], STAFF[-1])]), sections=sections)
        found = np.array([solid.volume, solid.moment_inertia[2, 2], solid.moment_inertia[0, 0]])
        whole = np.array([exact.volume * 1e9, exact.axial * 1e15, exact.transverse * 1e15])
        errors.append(found / whole - 1.0)
        assert solid.is_watertight
        assert solid.center_mass[2] == pytest.approx(exact.centre * 1e3, rel=1e-9, abs=0.0)
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx(2.0, abs=0.01)


@given(st.floats(-3.0, 3.0), st.floats(-0.05, 0.05), st.floats(-0.05, 0.05), st.booleans())
def test_the_solid_does_not_depend_on_where_it_is_drawn(angle: float, dx: float, dy: float, below: bool) -> None:
    drum = Loop((Line(-1e-3, 1e-3, 1e-3, 1e-3), Arc(0.0, 1e-3, 1e-3, 0.0, math.pi)))
    drum = drum.reflected((0.0, 0.0), (1.0, 0.0)) if below else drum
    there = turned([drum.moved(angle, (dx, dy))], (dx, dy), (math.cos(angle), math.sin(angle)))
    here = turned([drum], *X_AXIS)
    assert [there.volume, there.axial, there.transverse] == pytest.approx(
        [here.volume, here.axial, here.transverse], rel=1e-10, abs=0.0
    )
    assert abs(there.centre) < 1e-14


def test_what_cannot_be_turned_is_refused() -> None:
    with pytest.raises(ValueError, match="both sides of its axis"):
        turned([polygon_revolution((0.0, -1e-3), (1e-3, -1e-3), (0.0, 1e-3))], *X_AXIS)
    with pytest.raises(ValueError, match="encloses no area"):
        turned([polygon_revolution((0.0, 0.0), (1e-3, 0.0), (0.0, 1e-3)).reversed()], *X_AXIS)
    with pytest.raises(ValueError, match="encloses no area"):
        turned([], *X_AXIS)


def polygon_small_and_far_solids(*corners: tuple[float, float], closed: bool = True) -> Loop:
    ends = corners[1:] + corners[:1]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, ends, strict=True)), closed=closed)


def test_what_encloses_nothing_has_no_moments() -> None:
    triangle = (0.0, 0.0), (3.0, 0.0), (3.0, 4.0)
    nothing = section([polygon_small_and_far_solids(*triangle, closed=False), Loop(())])
    assert nothing == Section((0.0, 0.0), 0.0, 0.0, 0.0, 0.0)
    whole = section([polygon_small_and_far_solids(*triangle, closed=False), polygon_small_and_far_solids(*triangle), Loop(())])
    assert whole.area == pytest.approx(6.0) and whole.centroid == pytest.approx((2.0, 4.0 / 3.0))
    with pytest.raises(ValueError, match="no area"):
        mass_properties([Loop(())], 1e-3, 7800.0)


@pytest.mark.parametrize("turns", [8.0, 8.3, 0.4])
def test_the_picture_of_a_spiral_has_48_chords_a_turn_on_either_side(turns: float) -> None:
    spiral, width = Spiral(1e-3, 3e-3, turns), 5e-5
    edges, steps = spiral.outline(width).edges, math.ceil(48 * turns)
    assert CHORDS == 48 and len(edges) == 2 * (steps + 1)
    for k in (0, 1, steps - 1, steps):
        angle, r = math.tau * turns * k / steps, 1e-3 + 2e-3 * k / steps
        outside, inside = edges[k].start, edges[2 * steps + 1 - k].start
        for point, radius in ((outside, r + 0.5 * width), (inside, r - 0.5 * width)):
            assert point == pytest.approx((radius * math.cos(angle), radius * math.sin(angle)), rel=1e-9, abs=1e-15)


def test_a_spring_counts_as_poised_about_its_axis() -> None:
    strip = Spiral(1e-3, 3e-3, 5.0).strip(1e-4)
    assert strip.origin == (0.0, 0.0) and strip.centroid == (0.0, 0.0)


def test_a_spring_held_at_one_end_counts_by_the_square_of_how_far_it_follows() -> None:
    n = 1000
    assert sum(((k + 0.5) / n) ** 2 for k in range(n)) / n == pytest.approx(SHARE, rel=1e-6)


@pytest.mark.parametrize("length", [1.0000001e-3, 1.01e-3, 5e-3, 0.2])
def test_a_spiral_is_found_for_short_and_long_strips(length: float) -> None:
    assert spiral_of_length(1e-3, 2e-3, length).length == pytest.approx(length, rel=1e-10, abs=0.0)


@pytest.mark.parametrize("sweep", [5e-4, -5e-4, 1.3, -1.3])
def test_a_strip_along_an_arc_is_a_part_of_a_ring_however_short(sweep: float) -> None:
    arc, width = Arc(1e-3, -2e-3, 3e-3, 0.4, sweep), 2e-4
    loop = ribbon(arc, width)
    assert area(loop) == pytest.approx(width * 3e-3 * abs(sweep), rel=1e-9, abs=0.0)
    polar = abs(sweep) / 4.0 * ((3e-3 + 1e-4) ** 4 - (3e-3 - 1e-4) ** 4)
    assert drawn_strip(Loop((arc,), closed=False), width).about((1e-3, -2e-3)).polar == pytest.approx(polar, rel=1e-9, abs=0.0)


@pytest.mark.parametrize(("width", "refused"), [(5.99e-3, False), (6.01e-3, True)])
def test_a_strip_is_at_most_twice_as_wide_as_its_radius(width: float, refused: bool) -> None:
    if refused:
        with pytest.raises(ValueError, match=r"6\.01 mm wide cannot follow an arc of radius 3 mm"):
            ribbon(Arc(0.0, 0.0, 3e-3, 0.0, 1.0), width)
    else:
        assert area(ribbon(Arc(0.0, 0.0, 3e-3, 0.0, 1.0), width)) > 0.0


def test_a_turned_part_far_along_its_axis_is_the_same_as_near() -> None:
    """Of lengths that binary numbers hold exactly, 17 m away; a cone frustum by Gauss's rule in place of closed forms."""
    u = 1.0 / 1024.0
    near, far = (polygon_small_and_far_solids((x, 0.0), (x + 3 * u, 0.0), (x + 3 * u, 2 * u), (x, 5 * u)) for x in (0.0, 17.0))
    one, other = (turned([loop], (0.0, 0.0), (1.0, 0.0)) for loop in (near, far))
    assert (other.volume, other.axial, other.transverse) == pytest.approx(
        (one.volume, one.axial, one.transverse), rel=2e-12, abs=0.0
    )
    assert other.centre - 17.0 == pytest.approx(one.centre, rel=1e-9)
    n, h = 4000, 3 * u / 4000
    slices = [(5 * u - 3 * u * (k + 0.5) / n, (k + 0.5) * h) for k in range(n)]
    volume = sum(math.pi * r * r * h for r, _ in slices)
    centre = sum(math.pi * r * r * h * x for r, x in slices) / volume
    axial = sum(0.5 * math.pi * r**4 * h for r, _ in slices)
    transverse = sum(math.pi * r * r * h * (0.25 * r * r + (x - centre) ** 2) for r, x in slices)
    assert (one.volume, one.centre, one.axial, one.transverse) == pytest.approx(
        (volume, centre, axial, transverse), rel=1e-6, abs=0.0
    )


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("across", [0.9e-6, 1.1e-6])
def test_a_profile_may_cross_its_axis_by_a_millionth(side: float, across: float) -> None:
    """Along a slanted axis through a foot; on whichever side it lies it is put above."""
    foot, (c, s) = (3e-3, -1e-3), (0.6, 0.8)
    corners = [(1e-3, -across * 2e-3), (4e-3, -across * 2e-3), (4e-3, 2e-3), (1e-3, 1e-3)]
    placed = [(foot[0] + c * x - s * side * y, foot[1] + s * x + c * side * y) for x, y in corners]
    if across > 1e-6:
        with pytest.raises(ValueError, match="both sides of its axis"):
            upright([polygon_small_and_far_solids(*placed)], foot, (c, s))
        return
    (loop,) = upright([polygon_small_and_far_solids(*placed)], foot, (c, s))
    found = sorted(edge.start for edge in loop.edges)
    for point, expected in zip(found, sorted(corners), strict=True):
        assert point == pytest.approx(expected, abs=1e-12)
    assert reach([polygon_small_and_far_solids(*placed)], foot, (c, s)) == pytest.approx(2e-3, rel=1e-9)


ROOT = Path(__file__).resolve().parents[2]


WHEELS = {
    "club teeth": ROOT / "profiles" / "swiss_lever" / "escape_wheel.dxf",
    "lever": ROOT / "profiles" / "swiss_lever" / "lever.dxf",
    "pointed teeth": ROOT / "profiles" / "bench_lever" / "wheel.dxf",
    "pin lever wheel": PIN_LEVER / "siconos_pin_lever_wheel.dxf",
    "pin lever": PIN_LEVER / "siconos_pin_lever_lever.dxf",
}


def ring(outer: float, inner: float) -> tuple[Loop, ...]:
    return (Loop((Arc(0, 0, outer, 0.3, TURN),)), Loop((Arc(0, 0, inner, 0.1, -TURN),), hole=True))


def test_the_quadrature_knows_a_ring_and_a_sector() -> None:
    area, polar = moments(ring(3e-3, 2e-3))
    assert float(area) == pytest.approx(math.pi * 5e-6, rel=1e-15, abs=0.0)
    assert float(polar) == pytest.approx(math.pi / 2 * (81e-12 - 16e-12), rel=1e-15, abs=0.0)
    r, a = 2e-3, 1.1
    sector = Loop((Line(0, 0, r, 0), Arc(0, 0, r, 0, a), Line(r * math.cos(a), r * math.sin(a), 0, 0)))
    assert float(moments([sector])[1]) == pytest.approx(a * r**4 / 4, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("name", [pytest.param(name, marks=marks(path)) for name, path in WHEELS.items()])
def test_real_parts(name: str) -> None:
    loops = read(WHEELS[name], units="mm").loops
    found = section(loops).about((0.0, 0.0))
    area, polar = moments(loops)
    assert (found.area, found.polar) == pytest.approx((float(area), float(polar)), rel=1e-12, abs=0.0)
