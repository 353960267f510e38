"""Where do meshes stand, what is written of them, and which points stand for arcs?"""

import io
import json
import math
import struct
from itertools import pairwise
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from strangers import PIN_LEVER, marks
from trimesh.path import Path2D, entities

from watchsim.drawing.drawing import Profile
from watchsim.drawing.read import read
from watchsim.geometry.hairspring import Coil, Spiral, drawn_strip, ribbon, spiral_of_length
from watchsim.geometry.loops import Loop
from watchsim.geometry.meshes import Piece, Placed, edges_of, glb, laid, path2d, plate, revolved, stl, turned_about, united
from watchsim.geometry.primitives import TURN, Arc, Edge, Line
from watchsim.geometry.solids import mass_properties, turned

CORNERS = np.array([(0.3, 0.7, 1.1), (2.0, -0.4, 0.9), (-0.6, 1.5, 2.3), (0.2, 0.1, -3.0)])


def tetrahedron() -> trimesh.Trimesh:
    return trimesh.Trimesh(CORNERS, [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)], process=False)


def box(x0: float, y0: float, x1: float, y1: float, hole: bool = False) -> Loop:
    """Millimetres."""
    p = [(1e-3 * x, 1e-3 * y) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    return Loop(tuple(Line(*a, *b) for a, b in zip(p, p[1:] + p[:1], strict=True)), hole=hole)


def described(file: bytes) -> dict[str, Any]:
    """The JSON part of a binary glTF file."""
    (length,) = struct.unpack("<I", file[12:16])
    found: dict[str, Any] = json.loads(file[20 : 20 + length])
    return found


def matrix_of(file: bytes, name: str) -> list[float]:
    """By rows; a node without one stands at the origin."""
    (node,) = (node for node in described(file)["nodes"] if node["name"] == name)
    return np.reshape(node.get("matrix", np.eye(4)), (4, 4)).T.ravel().tolist()


def test_the_file_says_where_a_body_stands_in_metres() -> None:
    file = glb([Placed("lever", [Piece("FORK", tetrahedron(), "#102030", True)], (4e-3, -7e-3), 0.6)])
    c, s = math.cos(0.6), math.sin(0.6)
    expected = [c, -s, 0.0, 4e-3, s, c, 0.0, -7e-3, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    assert matrix_of(file, "lever") == pytest.approx(expected, abs=1e-9)
    assert matrix_of(file, "lever.FORK") == pytest.approx(np.eye(4).ravel().tolist(), abs=1e-12)
    (accessor,) = (
        a for a in described(file)["accessors"] if a["type"] == "VEC3" and a["max"][0] == pytest.approx(2e-3, rel=1e-6)
    )
    assert accessor["min"] == pytest.approx([-0.6e-3, -0.4e-3, -3e-3], rel=1e-6)


def test_a_body_stands_at_the_origin_unless_said_otherwise() -> None:
    file = glb([Placed("frame", [Piece("PLATE", tetrahedron(), "#102030", True)])])
    assert matrix_of(file, "frame") == pytest.approx(np.eye(4).ravel().tolist(), abs=1e-15)


def test_the_file_says_how_a_piece_looks() -> None:
    """Colours as light, by the sRGB formula of IEC 61966-2-1; metal as such, and stones not."""
    pieces = [Piece("FORK", tetrahedron(), "#10a0f3", True), Piece("STONE", tetrahedron(), "#10a0f4", False)]
    fork, stone = (each["pbrMetallicRoughness"] for each in described(glb([Placed("lever", pieces)]))["materials"])
    assert fork["baseColorFactor"] == pytest.approx([0.00518152, 0.35153260, 0.89626935, 1.0], abs=1e-7)
    assert (fork["metallicFactor"], fork["roughnessFactor"]) == (1.0, 0.3)
    assert (stone["metallicFactor"], stone["roughnessFactor"]) == (0.0, 0.1)


def test_a_turned_part_is_laid_with_its_height_along_the_axis() -> None:
    """What was along x stands up; what was along y lies to the right of the axis."""
    ux, uy = math.cos(2.1), math.sin(2.1)
    found = laid(tetrahedron(), (4e-3, -7e-3), (ux, uy), 0.9e-3)
    expected = [(4.0 + uy * y + ux * z, -7.0 - ux * y + uy * z, 0.9 + x) for x, y, z in CORNERS.tolist()]
    assert found.vertices == pytest.approx(np.array(expected), rel=1e-12)


def test_a_copy_is_turned_about_its_pivot() -> None:
    mesh = tetrahedron()
    found = turned_about(mesh, (2e-3, -3e-3), 0.7)
    c, s = math.cos(0.7), math.sin(0.7)
    expected = [(2.0 + c * (x - 2.0) - s * (y + 3.0), -3.0 + s * (x - 2.0) + c * (y + 3.0), z) for x, y, z in CORNERS.tolist()]
    assert found.vertices == pytest.approx(np.array(expected), rel=1e-12, abs=0.0) and np.array_equal(mesh.vertices, CORNERS)


def test_layers_make_one_plate_each_with_its_own_holes() -> None:
    """3 × 2 without 1 × 1, and 2 × 3 of which the former covers 1 × 1 with no hole of its own."""
    one = [box(0, 0, 3, 2), box(0.5, 0.5, 1.5, 1.5, hole=True)]
    found = united([one, [box(2, 1, 4, 4)], [box(7, 7, 8, 9)]], 0.3e-3, 0.2e-3, 1e-6)
    assert found is not None
    assert found.volume == pytest.approx(0.2 * (6.0 - 1.0 + 6.0 - 1.0 + 2.0), rel=1e-9)
    assert found.bounds == pytest.approx(np.array([(0.0, 0.0, 0.3), (8.0, 9.0, 0.5)]), abs=1e-12)
    assert plate([], 0.0, 1e-3, 1e-6) is None


def test_a_profile_is_turned_with_so_many_chords_as_its_widest_part_needs() -> None:
    """A bush from 1 mm to 2 mm of radius and from -0.5 mm to 2.5 mm of height."""
    found = revolved([box(-0.5, 1, 2.5, 2)], 1e-5)
    assert found is not None and found.is_watertight
    assert found.bounds[:, 2] == pytest.approx([-0.5, 2.5])
    radii = np.hypot(found.vertices[:, 0], found.vertices[:, 1])
    assert (radii.min(), radii.max()) == pytest.approx((1.0, 2.0))
    n = math.ceil(math.pi / math.acos(1.0 - 1e-5 / 2e-3))
    assert found.volume == pytest.approx(3.0 * (4.0 - 1.0) * 0.5 * n * math.sin(TURN / n), rel=1e-9)


def test_a_profile_a_little_beyond_its_axis_ends_there() -> None:
    found = revolved([box(0, -1e-4, 3, 2)], 1e-5)
    assert found is not None and found.bounds[:, 0] == pytest.approx([-2.0, 2.0], rel=1e-2)
    assert revolved([box(0, -2, 3, -1)], 1e-5) is None


def test_arcs_go_into_paths_by_three_points_and_share_those_where_edges_meet() -> None:
    arc = Arc(1e-3, 2e-3, 5e-3, 0.3, 2.0)
    line = Line(*arc.end, *arc.start)
    path = path2d([Loop((arc, line), "A"), Loop((Line(0.0, 0.0, 1e-3, 3e-3), Line(1e-3, 3e-3, 4e-3, 5e-3)), "B", closed=False)])
    curved, back, one, two = path.entities
    assert isinstance(curved, entities.Arc) and [entity.layer for entity in path.entities] == ["A", "A", "B", "B"]
    turn = [(1.0 + 5.0 * math.cos(a), 2.0 + 5.0 * math.sin(a)) for a in (0.3, 1.3, 2.3)]
    assert path.vertices[curved.points] == pytest.approx(np.array(turn))
    assert (back.points[0], back.points[-1]) == (curved.points[-1], curved.points[0])
    assert path.vertices[[*one.points, *two.points]] == pytest.approx(np.array([(0, 0), (1, 3), (1, 3), (4, 5)]))
    assert one.points[-1] == two.points[0] and path.units == "mm" and len(path.vertices) == 6
    (_, (found,)), *_ = edges_of(path, 1e-3)
    assert isinstance(found, Arc)
    assert (found.x, found.y, found.radius, found.start_angle, found.sweep) == pytest.approx((1e-3, 2e-3, 5e-3, 0.3, 2.0))


@pytest.mark.parametrize(("apart", "shared"), [(0.9e-12, True), (1.1e-12, False)])
def test_edges_share_a_point_where_they_meet_within_a_millionth_of_a_micrometre(apart: float, shared: bool) -> None:
    edges = (Line(0.0, 0.0, 0.0, 3e-3), Line(apart, 3e-3, 2e-3, 0.0), Line(2e-3, 0.0, apart, 0.0))
    one, two, three = path2d([Loop(edges, "A")]).entities
    assert bool(one.points[1] == two.points[0]) is shared and bool(three.points[1] == one.points[0]) is shared


def test_the_widest_loop_of_a_profile_says_how_many_chords_there_are() -> None:
    """Rings of 1 mm and 2 mm of radius; none wider than nothing is turned, however thin one is."""
    found = revolved([box(0, 0.5, 3, 1), box(4, 1.5, 5, 2)], 1e-5)
    assert found is not None
    top = found.vertices[found.vertices[:, 2] < 3.5]
    angles = np.unique(np.round(np.arctan2(top[:, 1], top[:, 0]) % TURN, 6))
    assert len(angles) == math.ceil(math.pi / math.acos(1.0 - 1e-5 / 2e-3))
    assert revolved([Loop(tuple(box(0, 0.5, 3, 1).edges), closed=False)], 1e-5) is None


ROOT = Path(__file__).resolve().parents[2]
WHEELS = {"club_teeth": ROOT / "profiles/swiss_lever/escape_wheel.dxf", "pin_lever": PIN_LEVER / "siconos_pin_lever_wheel.dxf"}
HALF_DISC = Loop((Arc(0.0, 0.0, 1e-3, 0.0, math.pi), Line(-1e-3, 0.0, 1e-3, 0.0)), "BALL")


def loops_of(path: Path) -> tuple[Loop, ...]:
    return read(path, units="mm").loops


@pytest.mark.parametrize("path", [pytest.param(path, id=name, marks=marks(path)) for name, path in WHEELS.items()])
def test_a_real_escape_wheel_converges_to_the_closed_form(path: Path) -> None:
    """The mesh of chords errs by their height: a quarter of the deviation, a quarter of the error, in mass as in inertia."""
    loops, thickness, density = loops_of(path), 0.12e-3, 7850.0
    exact = mass_properties(loops, thickness, density)
    errors = []
    for deviation in (4e-6, 1e-6, 0.25e-6):
        mesh = plate(loops, 0.0, thickness, deviation)
        assert mesh is not None and mesh.is_watertight
        mesh.density = density * 1e-9  # kg/mm³
        errors.append(
            (mesh.mass / exact.mass - 1.0, mesh.moment_inertia[2, 2] * 1e-6 / exact.inertia_about(exact.centre) - 1.0)
        )
    ratios = np.array(errors[:-1]) / np.array(errors[1:])
    assert np.max(np.abs(errors[-1])) < 1e-3
    # Holes err the other way and chords come in whole numbers: the ratio is 4 on the whole, not at each step.
    assert np.all((ratios[0] * ratios[1] > 9.0) & (ratios[0] * ratios[1] < 30.0)), errors


def test_holes_are_kept() -> None:
    loops = loops_of(ROOT / "profiles/swiss_lever/escape_wheel.dxf")
    mesh = plate(loops, 0.0, 0.1e-3, 1e-6)
    assert mesh is not None
    holes = sum(loop.hole for loop in loops)
    assert holes == 5 and mesh.euler_number == 2 - 2 * holes


def test_a_plate_lies_where_it_was_asked_for() -> None:
    mesh = plate([Loop((Arc(1e-3, 2e-3, 0.5e-3, 0.0, TURN),))], 0.3e-3, 0.2e-3, 1e-7)
    assert mesh is not None
    assert mesh.bounds == pytest.approx(np.array([[0.5, 1.5, 0.3], [1.5, 2.5, 0.5]]), abs=2e-4)
    assert plate([Loop((Line(0.0, 0.0, 1e-3, 0.0),), closed=False)], 0.0, 1e-4, 1e-6) is None


def test_a_turned_part_with_a_groove_converges() -> None:
    groove = Loop((Arc(0.0, 0.5e-3, 0.2e-3, 0.0, -TURN),), "BALL", hole=True)
    exact = turned([HALF_DISC, groove], (0.0, 0.0), (1.0, 0.0))
    errors = []
    for deviation in (4e-6, 1e-6, 0.25e-6):
        mesh = revolved([HALF_DISC, groove], deviation)
        assert mesh is not None and mesh.is_watertight
        errors.append(abs(mesh.volume * 1e-9 / exact.volume - 1.0))
    assert errors[0] > 10.0 * errors[2] and errors[2] < 1e-3
    assert mesh.moment_inertia[2, 2] * 1e-15 == pytest.approx(exact.axial, rel=2e-3, abs=0.0)
    assert revolved([], 1e-6) is None


def test_a_lying_part_points_along_its_axis() -> None:
    rod = Loop((Line(1e-3, 0, 3e-3, 0), Line(3e-3, 0, 3e-3, 2e-4), Line(3e-3, 2e-4, 1e-3, 2e-4), Line(1e-3, 2e-4, 1e-3, 0)))
    mesh = revolved([rod], 1e-7)
    assert mesh is not None
    angle = 0.6
    lying = laid(mesh, (5e-3, 0.0), (math.cos(angle), math.sin(angle)), 0.4e-3)
    assert lying.center_mass == pytest.approx((5 + 2 * math.cos(angle), 2 * math.sin(angle), 0.4), abs=1e-9)
    assert lying.volume == pytest.approx(mesh.volume)
    assert turned_about(lying, (5e-3, 0.0), -angle).center_mass == pytest.approx((7.0, 0.0, 0.4), abs=1e-9)


def test_files_read_back_where_the_body_stands() -> None:
    """GLB in metres with the pose of the body, STL in millimetres in the frame of the body."""
    disc = plate([Loop((Arc(1e-3, 0.0, 0.5e-3, 0.0, TURN),))], 0.0, 0.2e-3, 1e-7)
    assert disc is not None
    body = Placed("wheel", [Piece("TEETH", disc, "#dcb862", True)], (4e-3, 1e-3), math.pi / 2)
    scene = trimesh.load(io.BytesIO(glb([body])), file_type="glb")
    assert set(scene.geometry) == {"wheel.TEETH"} and "wheel" in scene.graph.nodes
    mesh = scene.to_mesh()
    assert mesh.center_mass == pytest.approx((4e-3, 2e-3, 1e-4), abs=1e-8)
    colour = next(iter(scene.geometry.values())).visual.material.baseColorFactor
    assert colour[:3] / 255 == pytest.approx((0.7156, 0.4793, 0.1221), abs=0.5 / 255 + 1e-4)  # trimesh reads in steps of 1/255
    back = trimesh.load(io.BytesIO(stl(body)), file_type="stl")
    assert back.is_watertight and back.center_mass == pytest.approx((1.0, 0.0, 0.1), abs=1e-6)


SLOT = (
    Line(0.0, 0.0, 4e-3, 0.0),
    Arc(4e-3, 1e-3, 1e-3, -0.5 * math.pi, math.pi),
    Line(4e-3, 2e-3, 0.0, 2e-3),
    Arc(0.0, 1e-3, 1e-3, 0.5 * math.pi, math.pi),
)


def test_outlines_come_back_with_their_layers() -> None:
    open_one: tuple[Edge, ...] = (Line(9e-3, 0.0, 9e-3, 1e-3), Line(9e-3, 1e-3, 8e-3, 2e-3))
    ring = Arc(1e-3, 1e-3, 5e-4, 0.4, -TURN)
    path = path2d([Loop(SLOT, "SLOT"), Loop((ring,), "HOLE"), Loop(open_one, "AXIS", False)])
    assert path.units == "mm" and len(path.vertices) == 4 + 2 + 3 + 3 and len(path.entities) == 4 + 1 + 2
    found = edges_of(path, 1e-3)
    assert [layer for layer, _ in found] == ["SLOT"] * 4 + ["HOLE"] + ["AXIS"] * 2
    for (_, (edge,)), source in zip(found, (*SLOT, ring, *open_one), strict=True):
        assert type(edge) is type(source) and edge.length == pytest.approx(source.length)
        for share in (0.0, 0.5, 1.0):
            assert edge.point(share) == pytest.approx(source.point(share), abs=1e-15)
    assert [entity.closed for entity in path.entities][4] and path.entities[3].points[-1] == path.entities[0].points[0]
    assert path.entities[6].points[0] == path.entities[5].points[-1] != path.entities[6].points[-1]


def test_a_gap_keeps_both_its_ends() -> None:
    gap = (Line(0.0, 0.0, 1e-3, 0.0), Line(1.1e-3, 0.0, 1e-3, 1e-3), Line(1e-3, 1e-3, 0.0, 1e-4))
    path = path2d([Loop(gap, "L")])
    assert len(path.vertices) == 5
    assert [edge for _, edges in edges_of(path, 1e-3) for edge in edges] == [
        Line(*(pytest.approx(value, abs=1e-18) for value in (edge.x0, edge.y0, edge.x1, edge.y1))) for edge in gap
    ]


def test_lines_through_many_points_lose_their_doubles_and_other_things_are_refused() -> None:
    vertices = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 2.0)])
    path = Path2D(entities=[entities.Line([0, 1, 2, 3])], vertices=vertices, process=False)
    assert edges_of(path, 2.0) == [("0", [Line(0.0, 0.0, 2.0, 0.0), Line(2.0, 0.0, 2.0, 4.0)])]
    with pytest.raises(ValueError, match="entity 0 of the path is a Bezier"):
        edges_of(Path2D(entities=[entities.Bezier([0, 1, 3])], vertices=vertices, process=False), 1.0)


@pytest.mark.parametrize(("gap", "closes"), [(0.9, True), (9.5, True), (10.5, False), (50.0, False)])
def test_ends_of_a_path_are_joined_as_those_of_a_drawing_are(gap: float, closes: bool) -> None:
    """A micrometre is the same point; loose ends are joined up to ten."""
    corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 1e-3 * gap)]
    path = Path2D(entities=[entities.Line([k, k + 1]) for k in range(4)], vertices=np.array(corners), process=False)
    found = Profile.from_path2d(path, units="mm")
    assert (len(found.loops), len(found.chains)) == ((1, 0) if closes else (0, 1))


SPRING = Spiral(0.6e-3, 2.6e-3, 12.0)


def test_length_and_second_moment_against_quadrature_of_high_precision() -> None:
    with mpmath.workdps(30):
        a, inner, end = mpmath.mpf(SPRING.pitch) / (2 * mpmath.pi), mpmath.mpf(SPRING.inner), 24 * mpmath.pi
        ends = mpmath.linspace(0, end, 13)
        length = mpmath.quad(lambda p: mpmath.sqrt((inner + a * p) ** 2 + a * a), ends)
        second = mpmath.quad(lambda p: (inner + a * p) ** 2 * mpmath.sqrt((inner + a * p) ** 2 + a * a), ends)
    assert SPRING.length == pytest.approx(float(length), rel=1e-13, abs=0.0)
    assert SPRING.second == pytest.approx(float(second), rel=1e-13, abs=0.0)


def test_strip_against_a_fine_grid_of_its_area() -> None:
    """Integrated over the strip itself, point by point along the true normals: no formula for spirals in it."""
    width, turns = 0.08e-3, 6.0
    spiral = Spiral(0.5e-3, 2e-3, turns)
    a = spiral.pitch / math.tau
    nodes, weights = np.polynomial.legendre.leggauss(8)
    along = np.concatenate([0.5 * (nodes + 1) + k for k in range(400)]) * math.tau * turns / 400
    step = np.tile(weights, 400) * 0.5 * math.tau * turns / 400
    r = spiral.inner + a * along
    speed = np.hypot(r, a)
    curvature = (r * r + 2 * a * a) / speed**3
    area = polar = 0.0
    for node, weight in zip(nodes, weights, strict=True):
        n = 0.5 * width * node  # along the left normal, toward the axis
        jacobian = (1 - curvature * n) * speed * step * 0.5 * width * weight
        square = r * r - 2 * n * r * r / speed + n * n
        area += float(jacobian.sum())
        polar += float((jacobian * square).sum())
    strip = spiral.strip(width)
    assert strip.area == pytest.approx(area, rel=1e-12, abs=0.0)
    assert strip.polar == pytest.approx(polar, rel=1e-8, abs=0.0)


def test_spiral_of_a_given_length() -> None:
    found = spiral_of_length(SPRING.inner, SPRING.outer, SPRING.length)
    assert found.turns == pytest.approx(SPRING.turns, rel=1e-12, abs=0.0)
    straight = spiral_of_length(1e-3, 2e-3, 1.0001e-3)
    assert straight.length == pytest.approx(1.0001e-3, rel=1e-9, abs=0.0)
    with pytest.raises(ValueError, match="does not even reach"):
        spiral_of_length(1e-3, 2e-3, 1e-3)


def test_drawn_strip_of_half_circles_is_a_ring_section() -> None:
    """Two half circles of one radius make a ring; a straight end of the strip is a bar."""
    r, b, length = 2e-3, 0.1e-3, 1e-3
    chain = Loop(
        (Arc(0.0, 0.0, r, 0.0, math.pi), Arc(0.0, 0.0, r, math.pi, math.pi), Line(r, 0.0, r, length)), "SPRING", closed=False
    )
    found = drawn_strip(chain, b).about((0.0, 0.0))
    ring = math.pi / 2 * ((r + b / 2) ** 4 - (r - b / 2) ** 4)
    bar = b * length * ((b * b + length * length) / 12 + r * r + length * length / 4)
    assert found.area == pytest.approx(b * (math.tau * r + length), rel=1e-12, abs=0.0)
    assert found.polar == pytest.approx(ring + bar, rel=1e-12, abs=0.0)


def test_drawn_arcs_come_near_the_spiral_they_follow() -> None:
    """Quarter turns about centres on a small square: a draughtsman's spiral of the same pitch."""
    pitch, count = SPRING.pitch, 48
    x, y, radius, arcs = 0.0, 0.0, 0.6e-3, []
    for k in range(count):
        arcs.append(Arc(x, y, radius, k * math.pi / 2, math.pi / 2))
        radius += pitch / 4
        angle = (k + 1) * math.pi / 2
        x, y = x - pitch / 4 * math.cos(angle), y - pitch / 4 * math.sin(angle)
    ends = [math.dist(a.end, b.start) for a, b in pairwise(arcs)]
    assert max(ends) < 1e-15
    strip, spiral = drawn_strip(Loop(tuple(arcs), closed=False), 0.03e-3), SPRING.strip(0.03e-3)
    assert strip.area == pytest.approx(spiral.area, rel=0.02, abs=0.0)
    assert strip.about((0.0, 0.0)).polar == pytest.approx(spiral.polar, rel=0.04, abs=0.0)


def test_a_strip_wider_than_its_bend_is_refused() -> None:
    with pytest.raises(ValueError, match="cannot follow an arc of radius"):
        ribbon(Arc(0.0, 0.0, 0.04e-3, 0.0, 1.0), 0.1e-3)


def test_the_picture_is_a_strip_of_the_spiral() -> None:
    """Its area is width times length, its corners lie half a width off the centre line, and it winds as often as it should."""
    spiral = Spiral(1e-3, 3e-3, 8.0)
    strip = spiral.outline(5e-5)
    x, y = np.array([edge.start for edge in strip.edges]).T
    area = 0.5 * abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))))
    assert area == pytest.approx(5e-5 * spiral.length, rel=2e-2, abs=0.0)
    turned = np.abs(np.diff(np.unwrap(np.arctan2(y, x)))).sum() / math.tau
    assert turned == pytest.approx(2.0 * spiral.turns, rel=1e-6, abs=0.0)
    r = np.hypot(x, y)
    assert (r.min(), r.max()) == pytest.approx((1e-3 - 2.5e-5, 3e-3 + 2.5e-5))


def test_a_strip_along_a_slanted_line_is_a_rectangle() -> None:
    """Counter-clockwise, its corners half a width to either side of the ends."""
    loop = ribbon(Line(1e-3, 2e-3, 4e-3, 6e-3), 1e-3)
    corners = [(1.4e-3, 1.7e-3), (4.4e-3, 5.7e-3), (3.6e-3, 6.3e-3), (0.6e-3, 2.3e-3)]
    for edge, here, there in zip(loop.edges, corners, [*corners[1:], corners[0]], strict=True):
        assert edge.start == pytest.approx(here) and edge.end == pytest.approx(there)


COIL = Coil(0.55e-3, 2.8e-3, 13.0, math.radians(70.0), 3e-5)
FINE = 20_000
AMPLITUDE = math.radians(330.0)

turned_coil = st.floats(-AMPLITUDE, AMPLITUDE)


def length(points: np.ndarray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def test_at_rest_it_is_the_spiral_that_has_mass() -> None:
    line = COIL.line(0.0, FINE)
    assert length(line) == pytest.approx(Spiral(COIL.inner, COIL.outer, COIL.turns).length, rel=1e-6, abs=0.0)
    radius, angle = np.hypot(*line.T), np.unwrap(np.arctan2(line[:, 1], line[:, 0]))
    pitch = (COIL.outer - COIL.inner) / COIL.turns
    assert np.allclose(radius, COIL.inner + pitch * (angle - angle[0]) / math.tau, atol=1e-12)
    assert angle[-1] - angle[0] == pytest.approx(math.tau * COIL.turns)


@given(turned_coil)
def test_the_collet_turns_and_the_stud_stays(angle: float) -> None:
    line, rest = COIL.line(angle, 400), COIL.line(0.0, 400)
    c, s = math.cos(angle), math.sin(angle)
    assert line[0] == pytest.approx(np.array([[c, -s], [s, c]]) @ rest[0], abs=1e-12)
    assert line[-1] == pytest.approx(COIL.outer * np.array([math.cos(COIL.stud), math.sin(COIL.stud)]), abs=1e-12)


@given(turned_coil)
def test_its_length_stays_and_its_coils_never_cross(angle: float) -> None:
    line = COIL.line(angle, FINE)
    assert length(line) == pytest.approx(length(COIL.line(0.0, FINE)), rel=1e-4, abs=0.0)
    assert np.all(np.diff(np.hypot(*line.T)) > 0.0)


def test_it_widens_as_it_unwinds_and_narrows_as_it_is_wound_up() -> None:
    mean = [np.hypot(*COIL.line(angle, FINE).T).mean() for angle in np.linspace(-AMPLITUDE, AMPLITUDE, 9)]
    assert np.all(np.diff(mean) > 0.0)


@given(st.floats(1e-8, 1e-3), turned_coil)
def test_chords_stray_no_further_than_asked(deviation: float, angle: float) -> None:
    count = COIL.chords(deviation)
    if count >= 180 * COIL.turns:  # as fine as it gets
        return
    line, fine = COIL.line(angle, count), COIL.line(angle, 8 * count)
    middle = 0.5 * (line[1:] + line[:-1])
    off = np.hypot(*(middle - fine[4::8]).T)
    assert off.max() <= 1.3 * max(deviation, 1e-12)  # coils that bulge reach a little beyond the stud's radius


def test_even_a_spring_turned_too_far_is_drawn() -> None:
    short = Coil(1e-3, 2e-3, 1.0, 0.0, 1e-5)
    for angle in (-100.0, 100.0):
        line = short.line(angle, 50)
        assert np.isfinite(line).all() and np.all(np.diff(np.hypot(*line.T)) > 0.0)


def test_chords_of_a_turn_are_neither_too_few_nor_too_many() -> None:
    assert [COIL.chords(deviation) for deviation in (1e-2, 1e-12)] == [24 * 13, 180 * 13]
    half = COIL.outer * (1.0 - math.cos(math.pi / 60.0))  # how far a sixtieth of a turn lies from its chord
    assert COIL.chords(half) == pytest.approx(60 * 13, rel=2e-3, abs=0.0)
