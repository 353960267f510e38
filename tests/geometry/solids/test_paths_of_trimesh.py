"""Do outlines come back from trimesh's paths as they went there, and poses of pictures where bodies stand?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from trimesh.path import Path2D, entities

from watchsim.drawing.drawing import Profile
from watchsim.geometry.loops import Loop
from watchsim.geometry.meshes import _arc, _pose, edges_of, path2d
from watchsim.geometry.primitives import TURN, Arc, Edge, Line

SLOT = (
    Line(0.0, 0.0, 4e-3, 0.0),
    Arc(4e-3, 1e-3, 1e-3, -0.5 * math.pi, math.pi),
    Line(4e-3, 2e-3, 0.0, 2e-3),
    Arc(0.0, 1e-3, 1e-3, 0.5 * math.pi, math.pi),
)


@pytest.mark.parametrize(
    ("start", "sweep"), [(0.3, 1.0), (0.3, -1.0), (2.9, 2.0), (-3.0, -4.0), (1.0, 6.0), (1.0, -6.0), (0.0, 3.0)]
)
@pytest.mark.parametrize("size", [1e-3, 1.0, 50.0])
def test_an_arc_through_three_points_is_that_arc(start: float, sweep: float, size: float) -> None:
    arc = Arc(3.0 * size, -2.0 * size, size, start, sweep)
    found = _arc([arc.start, arc.point(0.5), arc.end], False, 7)
    assert (found.x, found.y, found.radius, found.sweep) == pytest.approx((arc.x, arc.y, arc.radius, sweep), rel=1e-9)
    for share in (0.0, 0.3, 1.0):
        assert found.point(share) == pytest.approx(arc.point(share), rel=1e-9)
    whole = _arc([arc.start, arc.point(0.3), arc.point(0.6)], True, 7)
    assert whole.sweep == math.copysign(TURN, sweep) and whole.start == pytest.approx(arc.start)
    with pytest.raises(ValueError, match="entity 7"):
        _arc([(0.0, 0.0), (size, size), (2 * size, 2 * size)], False, 7)


def test_outlines_come_back_with_their_layers() -> None:
    open_one: tuple[Edge, ...] = (Line(9e-3, 0.0, 9e-3, 1e-3), Line(9e-3, 1e-3, 8e-3, 2e-3))
    ring = Arc(1e-3, 1e-3, 5e-4, 0.4, -TURN)
    path = path2d([Loop(SLOT, "SLOT"), Loop((ring,), "HOLE"), Loop(open_one, "AXIS", False)])
    assert path.units == "mm" and len(path.vertices) == 4 + 2 + 3 + 3 and len(path.entities) == 4 + 1 + 2
    found = edges_of(path, 1e-3)
    assert [layer for layer, _ in found] == ["SLOT"] * 4 + ["HOLE"] + ["AXIS"] * 2
    for (_, (edge,)), given in zip(found, (*SLOT, ring, *open_one), strict=True):
        assert type(edge) is type(given) and edge.length == pytest.approx(given.length)
        for share in (0.0, 0.5, 1.0):
            assert edge.point(share) == pytest.approx(given.point(share), abs=1e-15)
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


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_a_pose_turns_and_then_shifts(angle: float) -> None:
    pose = _pose((2e-3, -3e-3), angle)
    c, s = math.cos(angle), math.sin(angle)
    assert pose @ [1.0, 0.0, 5.0, 1.0] == pytest.approx([2.0 + c, -3.0 + s, 5.0, 1.0])
    assert pose @ [0.0, 1.0, 0.0, 1.0] == pytest.approx([2.0 - s, -3.0 + c, 0.0, 1.0])


@pytest.mark.parametrize(("gap", "closes"), [(0.9, True), (9.5, True), (10.5, False), (50.0, False)])
def test_ends_of_a_path_are_joined_as_those_of_a_drawing_are(gap: float, closes: bool) -> None:
    """A micrometre is the same point; loose ends are joined up to ten."""
    corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 1e-3 * gap)]
    path = Path2D(entities=[entities.Line([k, k + 1]) for k in range(4)], vertices=np.array(corners), process=False)
    found = Profile.from_path2d(path, units="mm")
    assert (len(found.loops), len(found.chains)) == ((1, 0) if closes else (0, 1))
