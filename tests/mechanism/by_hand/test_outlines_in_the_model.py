"""Which corners and edges does the model get of outlines, and which columns have bodies? By hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line
from watchsim.mechanism.compile import compile_scene, scene_size
from watchsim.mechanism.contact_features import features
from watchsim.mechanism.line_springs_of import coordinates_of_lines, line_springs
from watchsim.model.records import ARC, CORNER, LINE
from watchsim.scene.body import Body
from watchsim.scene.carriers import rides
from watchsim.scene.force import Contact, LineSpring, Side
from watchsim.scene.gear_trains import bonds
from watchsim.scene.gearing import Geared
from watchsim.scene.scene import Scene
from watchsim.tolerances import JOINT_RESOLUTION

SIZE = 0.01


def bent(turn: float, after: Edge | None = None) -> Loop:
    """Two lines of 3 mm and 4 mm, the second turned to the left."""
    end = (3e-3 + 4e-3 * math.cos(turn), 4e-3 * math.sin(turn))
    return Loop((Line(0.0, 0.0, 3e-3, 0.0), after or Line(3e-3, 0.0, *end)), closed=False)


@pytest.mark.parametrize(
    ("turn", "corner"),
    [
        (0.5e-3, True),
        (1.1, True),
        (1.1 * JOINT_RESOLUTION, True),
        (0.9 * JOINT_RESOLUTION, False),
        (-0.5e-3, False),
        (-1.1, False),
    ],
)
def test_a_convex_corner_is_one_however_flat(turn: float, corner: bool) -> None:
    """Down to what a joint leaves open; hollow ones are none."""
    rows = features(bent(turn), 7, SIZE)
    assert [row.kind for row in rows] == ([LINE, LINE, CORNER] if corner else [LINE, LINE]) and set(rows.body) == {7}
    if corner:
        assert (rows[2].x, rows[2].y, rows[2].length) == (3e-3, 0.0, SIZE)
        assert (rows[2].nx, rows[2].ny) == pytest.approx((math.sin(turn / 2), -math.cos(turn / 2)), abs=1e-15)
        assert (rows[2].half_cos, rows[2].half_sin) == pytest.approx((math.cos(turn / 2), math.sin(turn / 2)), abs=1e-15)
        assert (rows[0].after, rows[2].before, rows[2].after, rows[1].before) == (2, 0, 1, 2)
    else:
        smooth = turn > 0.0
        assert (rows[0].after, rows[1].before) == ((1, 0) if smooth else (-1, -1))
    assert (rows[0].before, rows[1].after) == (-1, -1)


@pytest.mark.parametrize(
    ("radius", "turn", "corner"),
    [(1.0, 0.9 * JOINT_RESOLUTION, True), (1.0, 0.02 * JOINT_RESOLUTION, True), (1.0, 0.8e-2 * JOINT_RESOLUTION, False)],
)
def test_on_flat_arcs_smaller_turns_are_corners(radius: float, turn: float, corner: bool) -> None:
    """A turn counts by how far it moves the end of the radius, against a share of the size."""
    exact = math.atan2(turn, 1.0)
    arc = Arc(3e-3 - radius * math.sin(exact), radius * math.cos(exact), radius, -0.5 * math.pi + exact, 1e-3)
    found = [row.kind for row in features(bent(0.0, arc), 0, SIZE)]
    assert found[:2] == [LINE, ARC] and (CORNER in found) is corner


def test_what_is_shorter_than_a_joint_has_no_primitive() -> None:
    joint = JOINT_RESOLUTION * SIZE
    for gap, count in ((0.9 * joint, 2), (1.2 * joint, 3)):
        step = Loop((Line(0.0, 0.0, 3e-3, 0.0), Line(3e-3, 0.0, 3e-3, -gap), Line(3e-3, -gap, 3e-3, -5e-3)), closed=False)
        assert [row.kind for row in features(step, 0, SIZE)].count(LINE) == count
        apart = Loop((Line(0.0, 0.0, 3e-3, 0.0), Line(3e-3 + gap, 0.0, 9e-3, -5e-3)), closed=False)
        assert [row.kind for row in features(apart, 0, SIZE)].count(LINE) == count


def test_corners_hide_hollows_of_more_than_half_a_turn() -> None:
    """What touches a corner may touch such a hollow too; it is no neighbour."""
    for sweep, neighbour in ((-3.1, True), (-3.2, False)):
        start = Arc(0.0, 0.0, 2e-3, 1.0, sweep)
        x, y = start.end
        (tx, ty), turn = start.tangent(1.0), 0.8
        way = (tx * math.cos(turn) - ty * math.sin(turn), tx * math.sin(turn) + ty * math.cos(turn))
        rows = features(Loop((start, Line(x, y, x + 1e-3 * way[0], y + 1e-3 * way[1])), closed=False), 0, SIZE)
        assert [row.kind for row in rows] == [ARC, LINE, CORNER]
        assert (rows[0].after, rows[2].before) == ((2, 0) if neighbour else (-1, -1)) and rows[1].before == 2


def test_the_size_is_the_farthest_of_what_moves() -> None:
    line = Loop((Line(3e-3, 4e-3, 1e-3, 0.0),), closed=False)
    far = Loop((Line(30e-3, 40e-3, 1e-3, 0.0),), closed=False)
    arc = Loop((Arc(1e-3, 0.0, 2e-3, -1.0, 2.0),), closed=False)
    still, moving = Body("a", "fixed", loops=(far,)), Body("b", inertia=1.0, loops=(line,))
    assert scene_size(Scene("t", (still, moving))) == pytest.approx(5e-3)
    assert scene_size(Scene("t", (still, Body("c", inertia=1.0, loops=(arc,))))) == pytest.approx(3e-3)
    assert scene_size(Scene("t", (still,))) == scene_size(Scene("t", (Body("d", inertia=1.0),))) == 1e-3


def test_sides_of_a_contact_are_the_layers_that_it_names() -> None:
    """All of a body, or one; of a body without outlines none."""
    loops = tuple(Loop(bent(turn).edges, name, closed=False) for turn, name in ((0.5, "L"), (-0.5, "X")))
    wide, other = Body("a", inertia=1.0, loops=loops), Body("b", "fixed", (9e-3, 0.0), loops=(bent(1.0),))
    bare = Body("c", inertia=1.0, position=(0.0, 9e-3))
    # Corners of the one with lines of the other: all of a has one corner and four lines, b one and two.
    for side, primitives, pairs in (
        (Side("a"), 5, 1 * 2 + 1 * 4),
        (Side("a", "L"), 3, 1 * 2 + 1 * 2),
        (Side("a", "X"), 2, 1 * 2),
    ):
        model = compile_scene(Scene("t", (wide, other, bare), contacts=(Contact((side, Side("b"))),))).model
        assert (len(model.primitives), len(model.contacts)) == (primitives + 3, pairs)
    none = compile_scene(Scene("t", (wide, other, bare), contacts=(Contact((Side("a"), Side("c"))),))).model
    assert len(none.contacts) == 0 and len(none.primitives) == 5


BODIES = (
    Body("still", "fixed", angle=0.5),
    Body("free", "free", mass=2.0, inertia=3.0, position=(1.0, 2.0), angle=0.25, velocity=(4.0, 5.0, 6.0)),
    Body("rack", "slide", mass=2.0, velocity=(7.0,), axis=(0.6, 0.8)),
    Body("pinion", inertia=3.0, angle=-0.5, velocity=(-14.0,), geared=Geared("rack", -2.0)),
    Body("wheel", inertia=3.0, angle=0.75, velocity=(8.0,)),
    Body("gear", inertia=3.0, angle=0.125, velocity=(24.0,), geared=Geared("wheel", 3.0)),
    Body("rider", inertia=3.0, angle=0.0625, velocity=(9.0,), on="wheel"),
)


def test_columns_of_all_kinds_of_bodies() -> None:
    compiled = compile_scene(Scene("t", BODIES))
    assert compiled.q.tolist() == [1.0, 2.0, 0.25, 0.0, 0.75, 0.8125] and compiled.u.tolist() == [4.0, 5.0, 6.0, 7.0, 8.0, 17.0]
    assert compiled.slices == {
        **{"free": slice(0, 3), "rack": slice(3, 4), "wheel": slice(4, 5), "rider": slice(5, 6)},
        **{"pinion": slice(6, 7), "gear": slice(7, 8)},
    }
    rows = compiled.relative(np.array([compiled.q, compiled.q + 1.0]))
    assert rows[0].tolist() == pytest.approx([1.0, 2.0, 0.25, 0.0, 0.75, 0.0625, -0.5, 0.125])
    assert rows[1].tolist() == pytest.approx([2.0, 3.0, 1.25, 1.0, 1.75, 0.0625, -2.5, 3.125])
    assert compiled.relative(compiled.u[None], rates=True)[0].tolist() == pytest.approx(
        [4.0, 5.0, 6.0, 7.0, 8.0, 9.0, -14.0, 24.0]
    )
    for number, angle, rate in ((3, -0.5, -14.0), (5, 0.125, 24.0), (6, 0.8125, 17.0)):
        assert compiled.own(number, compiled.q[None])[0] == pytest.approx(angle)
        assert compiled.own(number, compiled.u[None], rates=True)[0] == pytest.approx(rate)
    assert compiled.model.bodies.first.tolist() == [-1, 0, 3, 3, 4, 4, 5]
    assert compiled.model.bodies.carrier.tolist() == [-1, -1, -1, -1, -1, -1, -1]


def test_how_stiff_line_springs_hold_coordinates() -> None:
    """By the square of the arm and of the ratio; each coordinate of a free body, and nothing of what stands still."""
    springs = (
        LineSpring(("free", "still"), ((3.0, 4.0), (1.0, 1.0)), 10.0, 0.5, 0.25),
        LineSpring(("gear", "rack"), ((0.6, 0.8), (9.0, 9.0)), 7.0, 0.5),
        LineSpring(("pinion", None), ((0.0, 2.0), (1.0, 1.0)), 2.0, 0.5),
    )
    scene = Scene("t", BODIES, line_springs=springs)
    hung = rides(BODIES)
    records = line_springs(scene)
    assert [(row.a, row.b) for row in records] == [(1, 0), (5, 2), (3, -1)]
    assert (records[0].xa, records[0].ya, records[0].xb, records[0].yb, records[0].viscous) == (3.0, 4.0, 1.0, 1.0, 0.25)
    slices = {"free": slice(0, 3), "rack": slice(3, 4), "wheel": slice(4, 5), "rider": slice(5, 6)}
    found = coordinates_of_lines(scene, records, slices, bonds(BODIES, hung))
    assert found == [
        *((0, 10.0), (1, 10.0), (2, pytest.approx(250.0))),
        *((4, pytest.approx(63.0)), (3, 7.0)),
        (3, pytest.approx(2.0 * 16.0)),
    ]
