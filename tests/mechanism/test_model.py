"""Which coordinates, outlines and contacts does the model get of a scene? By hand and by two loops."""

import math
from collections.abc import Callable

import mpmath
import numpy as np
import pytest
from reference.flat_cam import Piece
from simulation.moving_scenes import ECCENTRIC, cam_scene, profile

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, moved
from watchsim.mechanism.compile import Compiled, compile_scene, scene_size
from watchsim.mechanism.contacts import FLAT, coordinates_of_lines, features, line_springs
from watchsim.model import ARC, CORNER, LINE
from watchsim.scene.forces import Contact, Damping, LineSpring, Side, Spring, Torque
from watchsim.scene.scene import Body, Geared, Prescribed, Scene
from watchsim.scene.trains import bonds, rides
from watchsim.tolerances import JOINT_RESOLUTION

# Which coordinates have forces and joints, and with what numbers?

DOWN = (2.0, -9.0)


def test_a_carried_body_is_poised_to_the_last_digit() -> None:
    """On the first body of the scene or on another: what rounding leaves of its moment pulls at nothing."""
    carrier = Body("c", inertia=3.0, mass=1.0)
    load = Body("b", inertia=1.0, mass=2.0, centre_of_mass=(1e-12, 0.0), position=(0.5, 0.0), on="c")
    for bodies in ((carrier, load), (Body("x", inertia=1.0), carrier, load)):
        rows = compile_scene(Scene("poised", bodies, gravity=DOWN)).model.coordinates
        assert rows.weight_x[-1] == rows.weight_y[-1] == 0.0 and rows.weight_x[-2] == pytest.approx(2.0 * 0.5 * 2.0)
        assert rows.weight_y[-2] == pytest.approx(2.0 * 0.5 * -9.0) and rows.linear[-1] == 1


def test_gravity_on_each_kind_of_body() -> None:
    """A pendulum's moment, turned a quarter, is its torque; along the axis of a slide; on both places of a free body."""
    bodies = (
        Body("p", inertia=7.0, mass=3.0, centre_of_mass=(0.25, -0.5)),
        Body("s", "slide", axis=(0.6, 0.8), mass=5.0),
        Body("f", "free", mass=4.0, inertia=6.0),
        Body("d", "pivot", inertia=7.0, mass=3.0, centre_of_mass=(0.25, -0.5)),
    )
    rows = compile_scene(Scene("heavy", bodies, gravity=DOWN)).model.coordinates
    assert rows.mass.tolist() == [7.0, 5.0, 4.0, 4.0, 6.0, 7.0]
    assert rows.force.tolist() == pytest.approx([0.0, 5.0 * (0.6 * 2.0 - 0.8 * 9.0), 8.0, -36.0, 0.0, 0.0])
    sx, sy = 0.75, -1.5
    assert (rows.weight_x[0], rows.weight_y[0]) == pytest.approx((sx * 2.0 + sy * -9.0, sx * -9.0 - sy * 2.0))
    for q in (0.0, 0.7, -2.0):  # the torque of the weight at the angle q
        x, y = sx * math.cos(q) - sy * math.sin(q), sx * math.sin(q) + sy * math.cos(q)
        torque = x * -9.0 - y * 2.0
        assert math.cos(q) * rows.weight_y[0] - math.sin(q) * rows.weight_x[0] == pytest.approx(torque)


@pytest.mark.parametrize("first", ["free", "pivot"])
def test_a_joint_with_a_free_carrier_acts_on_its_angle(first: str) -> None:
    """The third coordinate of the free body, the only one of the pivoted; the load's comes behind."""
    carrier = Body("c", first, mass=5.0, inertia=3.0, angle=0.4)
    load = Body("b", inertia=2.0, on="c", angle=0.3)
    forces = {"springs": (Spring("b", 8.0, 0.25),), "damping": (Damping("b", 3.0, 5.0),), "torques": (Torque("b", 7.0),)}
    compiled = compile_scene(Scene("joint", (Body("x", inertia=1.0), carrier, load), **forces))  # type: ignore[arg-type]
    (joint,) = compiled.model.joints
    number = 3 if first == "free" else 1
    assert (joint.coordinate, joint.on, joint.watched) == (number + 1, number, 1)
    assert (joint.stiffness, joint.rest, joint.viscous, joint.quadratic, joint.force) == (8.0, 0.25, 3.0, 5.0, 7.0)
    assert compiled.fastest == pytest.approx(math.sqrt(8.0 * (1.0 / 3.0 + 1.0 / 2.0)))


def test_several_springs_on_one_coordinate_are_one() -> None:
    springs = (Spring("a", 3.0, 0.5), Spring("b", 1.0, 9.0), Spring("a", 5.0, -0.75), Spring("a", 2.0, 4.0))
    rows = compile_scene(Scene("sprung", (Body("b", inertia=4.0), Body("a", inertia=0.5)), springs=springs)).model.coordinates
    assert rows.stiffness.tolist() == [1.0, 10.0]
    assert rows.rest.tolist() == pytest.approx([9.0, (1.5 - 3.75 + 8.0) / 10.0])
    assert rows.rate.tolist() == [pytest.approx(math.sqrt(20.0))] * 2


def test_without_springs_the_rate_is_that_of_the_strongest_push() -> None:
    bodies = (Body("a", inertia=4.0), Body("s", "slide", axis=(1.0, 0.0), mass=0.5))
    torques = (Torque("a", 12.0), Torque("a", -3.0), Torque("s", 2e-3))
    compiled = compile_scene(Scene("pushed", bodies, torques=torques))
    assert compiled.size == 1e-3 and compiled.fastest == 0.0
    assert compiled.model.coordinates.force.tolist() == [9.0, 2e-3]
    assert compiled.model.coordinates.rate.tolist() == [pytest.approx(math.sqrt(2e-3 / (0.5 * 1e-3)))] * 2
    assert compile_scene(Scene("idle", bodies)).model.coordinates.rate.tolist() == [1.0, 1.0]


def test_between_two_bodies_a_joint_takes_the_difference() -> None:
    """Of the angles as the scene gives them; its rest as well."""
    bodies = (Body("c", inertia=3.0, angle=0.4), Body("e", inertia=6.0, angle=-0.1))
    scene = Scene("two", bodies, springs=(Spring("e", 8.0, 0.25, against="c"),), damping=(Damping("e", 3.0, against="c"),))
    compiled = compile_scene(scene)
    (joint,) = compiled.model.joints
    assert (joint.coordinate, joint.on, joint.stiffness, joint.rest, joint.viscous) == (1, 0, 8.0, 0.25, 3.0)
    assert compiled.fastest == pytest.approx(math.sqrt(8.0 * (1.0 / 3.0 + 1.0 / 6.0)))


def test_a_driven_body_gives_way_to_nothing() -> None:
    """A spring between it and another swings that one alone; so does a torque, without springs."""
    bodies = (Body("c", inertia=3.0, prescribed=Prescribed()), Body("e", inertia=6.0))
    sprung = compile_scene(Scene("two", bodies, springs=(Spring("e", 8.0, against="c"),)))
    assert sprung.fastest == pytest.approx(math.sqrt(8.0 / 6.0), rel=1e-12)
    pushed = compile_scene(Scene("two", bodies, torques=(Torque("e", 12.0, against="c"),)))
    assert pushed.fastest == 0.0 and pushed.model.coordinates.rate.tolist() == [pytest.approx(math.sqrt(2.0))] * 2


@pytest.mark.parametrize("over", ["angle", "time"])
def test_tables_follow_one_another(over: str) -> None:
    """With their coordinates; abscissae of an angle in the movement, on a plate that is turned."""
    tables = (((1.0, 3.0), (2.0, 5.0)), ((0.5, -1.0), (4.0, 2.0), (9.0, 3.0)))
    torques = (Torque("a", over=over, table=tables[0]), Torque("b", over=over, table=tables[1], period=None))
    bodies = (Body("plate", "fixed", angle=0.25), Body("b", inertia=4.0), Body("a", inertia=0.5, on="plate"))
    model = compile_scene(Scene("tables", bodies, torques=torques)).model
    assert [(row.coordinate, row.on, row.start, row.count) for row in model.tables] == [(1, -1, 0, 2), (0, -1, 2, 3)]
    shift = 0.25 if over == "angle" else 0.0
    expected = [(1.0 + shift, 3.0), (2.0 + shift, 5.0), (0.5, -1.0), (4.0, 2.0), (9.0, 3.0)]
    assert [tuple(knot) for knot in model.knots.tolist()] == [pytest.approx(knot) for knot in expected]
    assert model.coordinates.linear.tolist() == [0, 0]


# Which corners and edges does the model get of outlines, and which columns have bodies? By hand.

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


# Are the primitives of an outline where its edges are, to the last digit where arcs are flat?

SIZE_CONTACT_FEATURES, LENGTH = 0.01, 2e-3  # m


@pytest.mark.parametrize("radius", [1.25 * FLAT * SIZE_CONTACT_FEATURES, 1.0, 1e3, 1e6])
def test_the_middle_of_a_flat_arc_is_rounded_once(radius: float) -> None:
    """In coordinates of millimetres, though the centre is a kilometre away: against mpmath with 50 digits."""
    for number in range(20):
        start = 0.3 + 0.31 * number
        with mpmath.workdps(50):
            away = mpmath.mpf(start) + mpmath.mpf(LENGTH / radius) / 2
            centre = (float(1.3e-3 - radius * mpmath.cos(away)), float(0.7e-3 - radius * mpmath.sin(away)))
            edge = Arc(*centre, radius, start, LENGTH / radius)
            truth = [float(c + mpmath.mpf(radius) * f(away)) for c, f in zip(centre, (mpmath.cos, mpmath.sin), strict=True)]
        (row,) = (row for row in features(Loop((edge,), closed=False), 0, SIZE_CONTACT_FEATURES) if row.kind == ARC)
        assert [float(row.px), float(row.py)] == truth


# Are the declared contacts those that two loops over all primitives find, in the same order and with the same bits?

TWO_PIECES = (Piece(0.2e-3, 0.05e-3, 1.1e-3, 0.0, math.pi), Piece(0.2e-3, 0.05e-3, 1.1e-3, math.pi, 2.0 * math.pi))


def gear(teeth: int, arcs: int, radius: float, layer: str) -> Loop:
    """Teeth whose flanks are hollow and round by turns, cut into arcs of their own radii, with flat tops and roots."""
    step = 2.0 * math.pi / teeth
    edges: list[Arc | Line] = []
    for k in range(teeth):
        root, top = radius, 1.3 * radius
        x, y, reach = root, 0.0, 0.4 * step * root / arcs
        for i in range(arcs):
            sweep = 1.0 if i % 2 == 0 else -1.0
            r = reach * (1.0 + 0.1 * i)
            edges.append(moved(Arc(x - r, y, r, 0.0, sweep), k * step, (0.0, 0.0)))
            x, y = x - r + r * math.cos(sweep), y + r * math.sin(sweep)
        edges.append(moved(Line(x, y, top * math.cos(0.5 * step), top * math.sin(0.5 * step)), k * step, (0.0, 0.0)))
        end = (root * math.cos(step), root * math.sin(step))
        edges.append(moved(Line(top * math.cos(0.5 * step), top * math.sin(0.5 * step), *end), k * step, (0.0, 0.0)))
    return Loop(tuple(edges), layer)


def gears(twice: bool) -> Scene:
    """Two of them; `twice`: contacts of some layers are declared again by others, in another order of the bodies."""
    small = Body("small", "pivot", (4e-3, 0.0), 0.3, inertia=1e-9, loops=(gear(6, 3, 1e-3, "T"), gear(6, 2, 0.8e-3, "S")))
    large = Body("large", "pivot", inertia=1e-9, loops=(gear(15, 4, 2e-3, "T"),))
    contacts = [Contact((Side("small"), Side("large")), 0.1, 0.2)]
    if twice:
        contacts += [Contact((Side("large", "T"), Side("small", "S")), 0.3, 0.0), Contact((Side("small", "T"), Side("large")))]
    return Scene("gears", (small, large), contacts=tuple(contacts))


SCENES: dict[str, Callable[[], Scene]] = {
    "swiss lever": lambda: profile("swiss_lever"),
    "bench lever": lambda: profile("bench_lever"),
    "carriage": lambda: profile("carriage"),
    "cam": lambda: cam_scene(ECCENTRIC, 40, 1.0),
    "cam of two": lambda: cam_scene(TWO_PIECES, 7, 1.0),
    "gears": lambda: gears(False),
    "gears declared twice": lambda: gears(True),
}


def sides(scene: Scene, compiled: Compiled, side: Side) -> list[int]:
    layers = scene.body(side.body).layers if side.layer is None else (side.layer,)
    named = zip(compiled.owners, compiled.layers, strict=True)
    return [i for i, (owner, layer) in enumerate(named) if owner == side.body and layer in layers]


def plays_circle(rows: list[dict[str, float]], a: int, b: int, first: bool) -> bool:
    """Does primitive a, of the first side or not, play the circle against b?"""
    one, two = rows[a], rows[b]
    if one["kind"] == LINE or (one["kind"] == ARC and one["side"] < 0.0) or two["kind"] == CORNER:
        return False
    if two["kind"] == LINE:
        return True
    if two["side"] < 0.0:
        return one["radius"] < two["radius"]
    if one["kind"] == CORNER:
        return True
    return one["radius"] <= two["radius"] if first else one["radius"] < two["radius"]


@pytest.mark.parametrize("name", SCENES)
def test_contacts_are_those_of_two_loops(name: str) -> None:
    scene = SCENES[name]()
    compiled = compile_scene(scene)
    model = compiled.model
    fields = ("kind", "side", "radius", "body")
    rows = [dict(zip(fields, row, strict=True)) for row in zip(*(model.primitives[f].tolist() for f in fields), strict=True)]
    by_bodies: dict[tuple[int, int], set[tuple[int, int, int]]] = {}
    for group, contact in enumerate(scene.contacts):
        first, last = (sides(scene, compiled, side) for side in contact.sides)
        key = tuple(sorted((rows[first[0]]["body"], rows[last[0]]["body"])))
        found = by_bodies.setdefault(key, set())
        found |= {(a, b, group) for a in first for b in last if plays_circle(rows, a, b, True)}
        found |= {(a, b, group) for a in last for b in first if plays_circle(rows, a, b, False)}
    expected = [contact for found in by_bodies.values() for contact in sorted(found)]
    contacts = model.contacts
    assert list(zip(contacts.a.tolist(), contacts.b.tolist(), contacts.group.tolist(), strict=True)) == expected
    assert len(expected) >= 14
    ends = [(a, b, start, stop) for a, b, start, stop in model.pairs[["a", "b", "start", "stop"]].tolist()]
    count = 0
    for (bodies, found), end in zip(by_bodies.items(), ends, strict=True):
        assert end == (*bodies, count, count + len(found))
        count += len(found)
    for (a, b, _), curvature, reduced in zip(expected, contacts.curvature.tolist(), contacts.reduced.tolist(), strict=True):
        r, big, side = rows[a]["radius"], rows[b]["radius"], rows[b]["side"]
        if rows[b]["kind"] == LINE:
            assert (curvature, reduced) == (0.0, r)
        else:
            assert (curvature, reduced) == (side / (big + side * r), r * big / (big + side * r))


def test_no_contact_is_no_fault() -> None:
    compiled = compile_scene(Scene("bare", (Body("wheel", "pivot", inertia=1.0, loops=(gear(5, 2, 1e-3, "T"),)),)))
    assert [len(part) for part in (compiled.model.contacts, compiled.model.pairs, compiled.model.near)] == [0, 0, 0]


# Is the fastest natural frequency of a scene that of its stiffest coordinate?

STIFFNESS, MASS, INERTIA = 30.0, 0.2, 5e-6


@pytest.mark.parametrize("arm", [(0.0, 0.0), (3e-3, -4e-3), (0.3, 0.4)])
@pytest.mark.parametrize("motion", ["free", "pivot", "slide"])
def test_of_a_spring_between_points(motion: str, arm: tuple[float, float]) -> None:
    """It resists a shift by its stiffness and a turn by that times the square of its arm, at most."""
    body = Body("body", motion, mass=MASS, inertia=INERTIA)
    spring = LineSpring(("body", None), (arm, (0.7, 0.1)), STIFFNESS, 0.2)
    compiled = compile_scene(Scene("", (body,), line_springs=(spring,)))
    shift, turn = STIFFNESS / MASS, STIFFNESS * math.hypot(*arm) ** 2 / INERTIA
    largest = {"free": max(shift, turn), "pivot": turn, "slide": shift}[motion]
    assert np.asarray(compiled.model.coordinates.rate) == pytest.approx(math.sqrt(largest) or 1.0, rel=1e-12)
