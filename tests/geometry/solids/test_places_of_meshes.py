"""Where do meshes stand, what is written of them, and which points stand for arcs?"""

from __future__ import annotations

import json
import math
import struct
from typing import Any

import numpy as np
import pytest
import trimesh
from trimesh.path import entities

from watchsim.geometry.loops import Loop
from watchsim.geometry.meshes import Piece, Placed, edges_of, glb, laid, path2d, plate, revolved, turned_about, united
from watchsim.geometry.primitives import TURN, Arc, Line

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
    file = glb([Placed("lever", [Piece("FORK", tetrahedron(), "#102030", 0.7)], (4e-3, -7e-3), 0.6)])
    c, s = math.cos(0.6), math.sin(0.6)
    expected = [c, -s, 0.0, 4e-3, s, c, 0.0, -7e-3, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    assert matrix_of(file, "lever") == pytest.approx(expected, abs=1e-9)
    assert matrix_of(file, "lever.FORK") == pytest.approx(np.eye(4).ravel().tolist(), abs=1e-12)
    (accessor,) = (
        a for a in described(file)["accessors"] if a["type"] == "VEC3" and a["max"][0] == pytest.approx(2e-3, rel=1e-6)
    )
    assert accessor["min"] == pytest.approx([-0.6e-3, -0.4e-3, -3e-3], rel=1e-6)


def test_a_body_stands_at_the_origin_unless_said_otherwise() -> None:
    file = glb([Placed("frame", [Piece("PLATE", tetrahedron(), "#102030", 0.7)])])
    assert matrix_of(file, "frame") == pytest.approx(np.eye(4).ravel().tolist(), abs=1e-15)


def test_the_file_says_how_a_piece_looks() -> None:
    (material,) = described(glb([Placed("lever", [Piece("FORK", tetrahedron(), "#10a0f3", 0.7)])]))["materials"]
    looks = material["pbrMetallicRoughness"]
    assert looks["baseColorFactor"] == pytest.approx([0x10 / 255, 0xA0 / 255, 0xF3 / 255, 1.0], abs=1e-6)
    assert (looks["metallicFactor"], looks["roughnessFactor"]) == (0.7, 0.45)


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
