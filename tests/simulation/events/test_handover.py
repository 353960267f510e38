"""Does a contact that slides or rolls from one primitive to the next keep going, with the force of the smooth outline?"""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest
from cam_scenes import DRIVE, ECCENTRIC, RATE, cam_scene
from moving_scenes import circle, polygon, touching
from reference.cam import follow, oval
from reference.valley import Path, force, height, incline, speed

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line
from watchsim.scene.body import Body
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EventKind, Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

OVAL = oval(0.6e-3, 1.5e-3, 0.4e-3)
AWAY = 1e-6  # m: rows nearer to a joint than that may be from either side of it
MASS = 1e-3


def contact_kinds(run: Trajectory) -> Counter[EventKind]:
    """How often each kind of contact event happened."""
    return Counter(EventKind(kind) for kind in run.events["kind"] if kind < EventKind.TURN)


@pytest.mark.parametrize(
    ("pieces", "cuts"),
    [(ECCENTRIC, 1), (ECCENTRIC, 10), (ECCENTRIC, 100), (OVAL, 1), (OVAL, 25)]
    + [pytest.param(*case, marks=pytest.mark.slow) for case in ((ECCENTRIC, 1000), (OVAL, 250))],
    ids=lambda value: str(value) if isinstance(value, int) else f"{len(value)}-arcs",
)
def test_a_cam_of_many_arcs_is_a_smooth_cam(pieces, cuts: int) -> None:
    """The roller neither leaves nor strikes the cam; force and motion are those of the smooth outline."""
    run = simulate(cam_scene(pieces, cuts, 0.25))
    assert run.stop == Stop.DURATION
    kinds = contact_kinds(run)
    assert set(kinds) <= {EventKind.CLOSE, EventKind.HANDOVER}
    assert kinds[EventKind.CLOSE] == 1
    rows = np.flatnonzero(np.diff(run.t, prepend=-1.0) > 0.0)
    truth = follow(pieces, DRIVE, 0.3, RATE, run.t[rows])
    turned = truth[-1].angle - truth[0].angle
    assert turned > 2.0
    if cuts > 1:
        assert kinds[EventKind.HANDOVER] == pytest.approx(turned * cuts * len(pieces) / (2.0 * math.pi), rel=0.3)
    assert run.q[rows, 0] == pytest.approx([row.angle for row in truth], abs=1e-10)
    rest = run.scene.springs[0].rest
    for i, row in zip(rows, truth, strict=True):
        if len(pieces) > 1 and min(abs(math.remainder(row.normal - piece.first, 2.0 * math.pi)) for piece in pieces) < 1e-6:
            continue  # the curvature steps here
        pressed = DRIVE.mass * run.a[i, 1] + DRIVE.stiffness * (run.q[i, 1] - rest)
        assert pressed / math.sin(row.normal + row.angle) == pytest.approx(row.force, rel=1e-10, abs=0.0)


def ground(slope: float, radius: float, cuts: int, length: float = 0.05) -> Loop:
    """A line, an arc that ends at the origin, a level line; material below. slope > 0: a valley, < 0: a crest."""
    turn, side = abs(slope), math.copysign(1.0, slope)
    edges: list[Edge] = [Line(length, 0.0, 0.0, 0.0)]
    first, step = -side * 0.5 * math.pi, -side * turn / cuts
    edges += [Arc(0.0, side * radius, radius, first + i * step, step) for i in range(cuts)]
    x, y = edges[-1].end
    edges.append(Line(x, y, x - length * math.cos(turn), y + side * length * math.sin(turn)))
    return Loop(tuple(edges), closed=False)


def start_on(outline: Loop, slope: float, before: float) -> tuple[float, float]:
    """The point on the inclined line that far before the arc."""
    x, y = outline.edges[-1].start
    return x - before * math.cos(abs(slope)), y + math.copysign(before * math.sin(abs(slope)), slope)


@pytest.mark.parametrize(
    ("slope", "radius", "cuts", "v0", "friction"),
    [
        (0.5, 5e-3, 1, 0.3, 0.0),
        (0.5, 5e-3, 20, 0.3, 0.0),
        (-0.3, 5e-3, 1, 0.24, 0.0),
        pytest.param(-0.3, 5e-3, 100, 0.24, 0.0, marks=pytest.mark.slow),
        (0.5, 5e-3, 10, 0.3, 1.5),
        (-0.3, 5e-3, 10, 0.22, 1.5),
        (0.5, 1.001e-3, 10, 0.3, 0.0),
    ],
    ids=["valley", "valley-20", "crest", "crest-100", "rolling-valley", "rolling-crest", "nearly-equal-radii"],
)
def test_a_disc_over_line_arc_line(slope: float, radius: float, cuts: int, v0: float, friction: float) -> None:
    """Sliding without friction, or rolling: speed and force are the closed form's at every row, with no impact."""
    outline, disc = ground(slope, radius, cuts), 1e-3
    side, turn = math.copysign(1.0, slope), abs(slope)
    x, y = start_on(outline, slope, 4e-3)
    along = (math.cos(turn), -side * math.sin(turn))
    place = (x + side * math.sin(turn) * disc, y + math.cos(turn) * disc)
    velocity = (v0 * along[0], v0 * along[1], -v0 / disc if friction else 0.0)
    inertia = 0.5 * MASS * disc**2
    bodies = (
        Body("disc", "free", place, velocity=velocity, mass=MASS, inertia=inertia, loops=(circle(disc),)),
        Body("ground", "fixed", loops=(outline,)),
    )
    contacts = touching("disc", "ground", friction=friction, restitution=0.5)
    run = simulate(Scene("ground", bodies, contacts=contacts, gravity=(0.0, -9.81), tolerance=1e-11), 0.035)
    assert run.stop == Stop.DURATION
    assert contact_kinds(run) == {EventKind.CLOSE: 1, EventKind.HANDOVER: cuts + 1}
    path = Path(slope, radius - side * disc)
    share = 2.0 / 3.0 if friction else 1.0
    joints = (0.0, -path.radius * math.sin(turn))
    for (px, py, _), (vx, vy, _), (ax, ay, _) in zip(run.q, run.u, run.a, strict=True):
        v = speed(path, px, run.q[0, 0], v0, share)
        assert math.hypot(vx, vy) == pytest.approx(v, rel=1e-10)
        assert py - disc == pytest.approx(height(path, px), abs=1e-13)
        if min(abs(px - joint) for joint in joints) > AWAY:
            tilt = incline(path, px)
            pressed = MASS * (math.cos(tilt) * (ay + 9.81) - math.sin(tilt) * ax)
            assert pressed == pytest.approx(force(path, px, v, MASS), rel=1e-9)


@pytest.mark.parametrize("radius", [1e-3, 1e-5, 1e-6])
@pytest.mark.parametrize("v0", [0.01, 1.0])
def test_a_knife_through_a_fillet_of_any_size(radius: float, v0: float) -> None:
    """A sled drives a follower with a sharp corner through a valley, down to a fillet of a micrometre: no energy is lost."""
    slope, mass, heavy = 0.5, 1e-3, 1e-2
    outline = ground(slope, radius, 3)
    x, y = start_on(outline, slope, 1e-3)
    knife = polygon((0.0, 0.0), (4e-4, 2e-3), (-4e-4, 2e-3))
    bodies = (
        Body("sled", "slide", (-x, 0.0), axis=(1.0, 0.0), velocity=(-v0,), mass=heavy, loops=(outline,)),
        Body("knife", "slide", (0.0, y), axis=(0.0, 1.0), velocity=(-v0 * math.tan(slope),), mass=mass, loops=(knife,)),
    )
    contacts = touching("knife", "sled", restitution=0.5)
    run = simulate(Scene("knife", bodies, contacts=contacts, gravity=(0.0, -9.81), tolerance=1e-11), 3e-3 / v0)
    assert contact_kinds(run) == {EventKind.CLOSE: 1, EventKind.HANDOVER: 4}
    energy = 0.5 * heavy * v0**2 + 0.5 * mass * (v0 * math.tan(slope)) ** 2 + mass * 9.81 * y
    assert run.u[-1] == pytest.approx((-math.sqrt(2.0 * energy / heavy), 0.0), rel=1e-9, abs=1e-9)


def test_an_egg_rocks_on_a_plane() -> None:
    """The joints are on the touching body: an oval of four arcs, cut into sixty, rocks without slip and without loss."""
    edges = []
    for piece in OVAL:
        step = (piece.last - piece.first) / 15
        edges += [Arc(piece.x, piece.y, piece.radius, piece.first + i * step, step) for i in range(15)]
    tilt = 1.1
    side = next(p for p in OVAL if (-0.5 * math.pi - tilt - p.first) % (2.0 * math.pi) <= p.last - p.first)
    up = -(math.sin(tilt) * side.x + math.cos(tilt) * side.y) + side.radius
    egg = Body("egg", "free", (0.0, up), tilt, (0.0, 0.0, 0.0), mass=MASS, inertia=3e-10, loops=(Loop(tuple(edges)),))
    plane = Body("plane", "fixed", loops=(Loop((Line(1.0, 0.0, -1.0, 0.0),), closed=False),))
    contacts = touching("egg", "plane", friction=20.0, restitution=0.5)
    run = simulate(Scene("egg", (egg, plane), contacts=contacts, gravity=(0.0, -9.81), tolerance=1e-11), 0.3)
    kinds = contact_kinds(run)
    assert set(kinds) <= {EventKind.CLOSE, EventKind.HANDOVER, EventKind.STICK}
    assert kinds[EventKind.HANDOVER] > 20
    energy = 0.5 * MASS * (run.u[:, 0] ** 2 + run.u[:, 1] ** 2) + 1.5e-10 * run.u[:, 2] ** 2 + MASS * 9.81 * run.q[:, 1]
    assert np.ptp(energy) < 1e-10 * MASS * 9.81 * up


def test_a_disc_turns_round_the_edge_of_a_table() -> None:
    """Without friction: from the table's top to its corner without impact, then round the corner until it lets go."""
    disc, v0 = 1e-3, 0.02
    table = polygon((0.0, 0.0), (-0.1, 0.0), (-0.1, -0.1), (0.0, -0.1))
    inertia = 0.5 * MASS * disc**2
    bodies = (
        Body("disc", "free", (-1e-3, disc), velocity=(v0, 0.0, 0.0), mass=MASS, inertia=inertia, loops=(circle(disc),)),
        Body("table", "fixed", loops=(table,)),
    )
    run = simulate(Scene("table", bodies, contacts=touching("disc", "table"), gravity=(0.0, -9.81), tolerance=1e-11), 0.1)
    assert contact_kinds(run) == {EventKind.CLOSE: 1, EventKind.HANDOVER: 1, EventKind.OPEN: 1}
    (let_go,) = (event["t"] for event in run.events if event["kind"] == EventKind.OPEN)
    q, _ = run.at(float(let_go))
    # It lets go where v²/r = g cos, with v² = v0² + 2 g r (1 - cos).
    assert q[1] / disc == pytest.approx((v0**2 / (9.81 * disc) + 2.0) / 3.0, rel=1e-8)
    assert math.hypot(q[0], q[1]) == pytest.approx(disc, rel=1e-12)
