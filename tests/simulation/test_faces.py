"""Does contact pass from one face to the next, along flat, open and flush ones, and through lines of centres?"""

import math
from collections import Counter
from pathlib import Path as Path_of_pathlib

import dxf_text as d
import numpy as np
import pytest
from moving_scenes import DRIVE, ECCENTRIC, RATE, box, cam_scene, circle, polygon, touching, turned
from reference import pendulum
from reference.flat_cam import follow, oval
from reference.valley import Path, force, height, incline, speed

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line
from watchsim.scene.forces import Contact, Side, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

# Does a contact that slides or rolls from one primitive to the next keep going, with the force of the smooth outline?

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
        *(pytest.param(-0.3, 5e-3, 100, 0.24, 0.0, marks=pytest.mark.slow), (0.5, 5e-3, 10, 0.3, 1.5)),
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


# Is the next face met where faces too flat to count have let a body sink in?

FLAT, SPEED, RADIUS, DURATION, KEPT = 0.03, 0.3, 0.003, 0.2, 0.5  # m, m/s, m, s, restitution


def bar(flat: float, kink: float) -> Body:
    """Slides to the left; its face rises by `flat` along 3 cm from the origin on, then by `kink`, rad."""
    rise, length = flat * FLAT, 0.005
    end = (FLAT + length * math.cos(kink), rise + length * math.sin(kink))
    shape = polygon((-0.04, -0.005), (0.04, -0.005), (0.04, end[1]), end, (FLAT, rise), (0.0, 0.0), (-0.04, 0.0))
    return Body("bar", "slide", axis=(1.0, 0.0), velocity=(-SPEED,), mass=0.05, loops=(shape,))


def passed(flat: float, kink: float, rider: Body) -> Scene:
    contacts = touching("bar", "rider", restitution=KEPT)
    return Scene("flat faces", (bar(flat, kink), rider), contacts=contacts, duration=DURATION)


def way_after(met: float) -> float:
    """Where the bar ends that goes to `met` and back with half its speed, m."""
    return met + KEPT * SPEED * (DURATION + met / SPEED)


@pytest.mark.parametrize("tolerance", [1e-9, 1e-11])
@pytest.mark.parametrize("flat", [1e-8, 3e-7, 9e-7])
@pytest.mark.parametrize("kink", [2e-6, 1e-5, 1e-4, 9e-4, 2e-3])
def test_a_disc_that_sank_in_meets_the_next_face(flat: float, kink: float, tolerance: float) -> None:
    disc = Body("rider", "pivot", (0.0, RADIUS), inertia=5e-6, loops=(circle(RADIUS),))
    run = simulate(passed(flat, kink, disc), tolerance=tolerance)
    # Where the foot on the next face is its joint, or before, where the disc still touches that face beyond it.
    sunk = flat * FLAT
    foot = RADIUS * math.tan(kink) if RADIUS * (1.0 / math.cos(kink) - 1.0) < sunk else 0.5 * RADIUS * kink + sunk / kink
    assert run.u[-1, 0] == pytest.approx(KEPT * SPEED, rel=1e-6)
    assert run.q[-1, 0] == pytest.approx(way_after(foot - FLAT), abs=1e-9)


@pytest.mark.parametrize("kink", [1.1e-3, 2e-3])
@pytest.mark.parametrize("depth", [3e-10, 8e-10])
def test_a_disc_that_sank_in_by_next_to_nothing_stops_at_the_joint(depth: float, kink: float) -> None:
    """Back to where it touched the next face it would go by 0.15 to 0.7 um, off that face."""
    disc = Body("rider", "pivot", (0.0, RADIUS), inertia=5e-6, loops=(circle(RADIUS),))
    sunk = RADIUS * (1.0 / math.cos(kink) - 1.0) + depth
    run = simulate(passed(sunk / FLAT, kink, disc))
    assert np.abs(np.diff(run.q, axis=0)[np.diff(run.t) == 0.0]).max() == 0.0
    assert run.worst_penetration == pytest.approx(depth, rel=1e-3, abs=0.0)
    assert run.q[-1, 0] == pytest.approx(way_after(RADIUS * math.tan(kink) - FLAT), abs=1e-9)


@pytest.mark.parametrize("kink", [2e-6, 1e-4, 2e-3, 0.3])
def test_a_point_that_slides_along_a_wall_does(kink: float) -> None:
    point = Body("rider", "fixed", loops=(polygon((0.0, 0.0), (0.002, 0.004), (-0.002, 0.004)),))
    run = simulate(passed(9e-7, kink, point))
    assert run.u[-1, 0] == pytest.approx(KEPT * SPEED, rel=1e-6)
    assert run.q[-1, 0] == pytest.approx(way_after(-FLAT), abs=2e-7)


# Does a ball move on an open chain of a drawing as the closed forms say?

GRAVITY, BOWL, BALL = 9.81, 30e-3, 2e-3
SCENE = """
[scene]
gravity = ["0 m/s²", "-9.81 m/s²"]
[bodies.ground]
drawing = "ground.dxf"
motion = "fixed"
material = ["0 mm", "-40 mm"]
[bodies.ball]
circle = "2 mm"
motion = "free"
mass = "1 g"
position = ["{x!r} mm", "{y!r} mm"]
[[contacts]]
between = ["ground", "ball"]
[run]
duration = "{duration!r} s"
tolerance = 1e-11
"""


@pytest.mark.parametrize("forward", [True, False])
def test_a_ball_in_an_open_bowl_swings_like_a_pendulum(tmp_path: Path_of_pathlib, forward: bool) -> None:
    """Without friction its centre runs on a circle of the difference of the radii."""
    reach = 1e3 * BOWL * math.sin(1.2)
    height = -1e3 * BOWL * math.cos(1.2)
    bulge = math.tan(0.6) if forward else -math.tan(0.6)
    ends = [(-reach, height, bulge), (reach, height)] if forward else [(reach, height, bulge), (-reach, height)]
    (tmp_path / "ground.dxf").write_bytes(d.dxf(d.lwpolyline(ends, False)))
    length, start = BOWL - BALL, 0.6
    x, y = 1e3 * length * math.sin(start), -1e3 * length * math.cos(start)
    (tmp_path / "scene.toml").write_text(SCENE.format(x=x, y=y, duration=1.0), encoding="utf-8")
    done = simulate(load(tmp_path / "scene.toml"))
    assert done.stop == Stop.DURATION
    for t in (0.1, 0.37, 1.0):
        q, _ = done.at(t)
        angle, _ = pendulum.swing(t, start, math.sqrt(GRAVITY / length))
        assert math.atan2(q[0], -q[1]) == pytest.approx(angle, abs=1e-6)
        assert math.hypot(q[0], q[1]) == pytest.approx(length, abs=1e-9)


def test_a_ball_slides_down_a_line_and_off_its_end(tmp_path: Path_of_pathlib) -> None:
    """Down the slope with g sin α, then along a parabola."""
    slope, way = math.radians(30.0), 10e-3
    foot = (0.0, 0.0)
    head = (-50.0 * math.cos(slope), 50.0 * math.sin(slope))
    (tmp_path / "ground.dxf").write_bytes(d.dxf(d.line(foot, head)))
    x = -way * math.cos(slope) + BALL * math.sin(slope)
    y = way * math.sin(slope) + BALL * math.cos(slope)
    (tmp_path / "scene.toml").write_text(SCENE.format(x=1e3 * x, y=1e3 * y, duration=0.2), encoding="utf-8")
    done = simulate(load(tmp_path / "scene.toml"))
    leaves = math.sqrt(2.0 * way / (GRAVITY * math.sin(slope)))
    speed = GRAVITY * math.sin(slope) * leaves
    q, _ = done.at(0.5 * leaves)
    assert q[0] == pytest.approx(x + 0.25 * way * math.cos(slope), abs=1e-9)
    q, u = done.at(leaves)
    assert math.hypot(u[0], u[1]) == pytest.approx(speed, rel=1e-6)
    assert q[0] == pytest.approx(BALL * math.sin(slope), abs=1e-8)
    assert speed * speed / BALL > GRAVITY * math.cos(slope), "too fast to turn about the end of the line: it flies"
    after = 0.2 - leaves
    q, _ = done.at(0.2)
    assert q[0] == pytest.approx(BALL * math.sin(slope) + speed * math.cos(slope) * after, abs=1e-7)
    assert q[1] == pytest.approx(
        BALL * math.cos(slope) - speed * math.sin(slope) * after - 0.5 * GRAVITY * after * after, abs=1e-7
    )


# Is motion smooth where friction has no lever arm, or one parallel to that of the normal force, in every orientation?

MM = 1e-3


def turned_line_of_centres(points: list[tuple[float, float]], angle: float) -> Loop:
    """A polygon (mm), turned in its own frame."""
    c, s = math.cos(angle), math.sin(angle)
    corners = [(MM * (x * c - y * s), MM * (x * s + y * c)) for x, y in points]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))


def blade(tilt: float, drawn: tuple[float, float] = (0.0, 0.0), friction: float = 0.12) -> Scene:
    """A tooth's tip pushes a radial blade past the line of centres; `tilt` turns all, `drawn` each outline in its own frame."""
    wheel = turned_line_of_centres([(0.0, 2.4), (-0.3, 1.8), (-0.05, 1.8)], drawn[0])
    face = turned_line_of_centres([(0.0, -1.08), (0.1, -1.08), (0.1, -0.6), (0.0, -0.6)], drawn[1])
    apart, eight, five = 3.372e-3, math.radians(8.0), math.radians(-5.0)
    bodies = (
        Body("wheel", "pivot", (0.0, 0.0), eight + tilt - drawn[0], inertia=5e-12, loops=(wheel,)),
        Body(
            "balance",
            "pivot",
            (-apart * math.sin(tilt), apart * math.cos(tilt)),
            five + tilt - drawn[1],
            velocity=(math.radians(3000.0),),
            inertia=1.2e-9,
            loops=(face,),
        ),
    )
    touching = (Contact((Side("wheel"), Side("balance")), friction, 0.0),)
    return Scene("blade", bodies, torques=(Torque("wheel", -1e-5),), contacts=touching, duration=0.015)


@pytest.mark.parametrize("friction", [0.0, 0.12])
def test_a_blade_passes_the_line_of_centres_alike_in_all_orientations(friction: float) -> None:
    rng = np.random.default_rng(7)
    reference = simulate(blade(0.0, friction=friction))
    assert reference.stop == Stop.DURATION
    assert abs(reference.energy["residual_relative"]) < 1e-8
    for _ in range(25):
        tilt, *drawn = rng.uniform(0.0, 2.0 * math.pi, 3)
        done = simulate(blade(tilt, (drawn[0], drawn[1]), friction))
        assert done.stop == Stop.DURATION
        np.testing.assert_allclose(done.end_u, reference.end_u, rtol=1e-8)
        turn = done.end_q - done.q[0]
        np.testing.assert_allclose(turn, reference.end_q - reference.q[0], rtol=1e-8)


def test_friction_takes_only_what_its_lever_arm_allows() -> None:
    """Near the line of centres friction does no work: the balance ends as fast as without it to first order of the arm."""
    with_friction, without = (simulate(blade(0.0, friction=mu)).end_u[1] for mu in (0.12, 0.0))
    assert with_friction == pytest.approx(without, rel=0.02)
    assert with_friction != without


def sliders(mirrored: bool, restitution: float, friction: float = 0.5) -> Scene:
    """Two sliders on parallel axes whose tilted faces meet: slip is a multiple of approach."""
    sign = -1.0 if mirrored else 1.0
    one = Body(
        "one", "slide", (-8e-3, 0.0), velocity=(0.3,), mass=2e-2, loops=(turned_line_of_centres(order(left_tip(sign)), 0.0),)
    )
    two = Body(
        "two",
        "slide",
        (8e-3, 0.0),
        mass=2e-2,
        loops=(turned_line_of_centres(order([(-x, -y) for x, y in left_tip(sign)]), 0.0),),
    )
    return Scene("sliders", (one, two), contacts=(Contact((Side("one"), Side("two")), friction, restitution),), duration=0.1)


def left_tip(sign: float) -> list[tuple[float, float]]:
    """A slider whose right end is cut off at 30 degrees, upwards or downwards."""
    cut = 5.0 * math.tan(math.radians(30.0))
    return [(-5.0, -5.0), (cut * sign, -5.0), (-cut * sign, 5.0), (-5.0, 5.0)]


def order(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Counter-clockwise."""
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1], strict=True))
    return points if area > 0.0 else points[::-1]


@pytest.mark.parametrize("restitution", [0.0, 0.4, 0.9])
def test_tilted_faces_on_parallel_axes_rebound_by_routh(restitution: float) -> None:
    """Friction acts against the slip in both phases: e' = e (cos - mu sin) / (cos + mu sin), mirrored or not."""
    mu, slope = 0.5, math.radians(30.0)
    back = restitution * (math.cos(slope) - mu * math.sin(slope)) / (math.cos(slope) + mu * math.sin(slope))
    for mirrored in (False, True):
        done = simulate(sliders(mirrored, restitution, mu))
        assert np.count_nonzero(done.events["kind"] == EventKind.IMPACT) >= 1
        np.testing.assert_allclose(done.end_u, [0.15 * (1.0 - back), 0.15 * (1.0 + back)], rtol=1e-9)


def test_a_disc_about_its_own_pivot_lets_a_bar_pass() -> None:
    """No motion changes their gap: nothing is corrected, nothing stops."""
    disc = Loop((Arc(0.0, 0.0, 3e-3, 0.0, 2.0 * math.pi),))
    bar = turned_line_of_centres([(-40.0, -5.0), (40.0, -5.0), (40.0, 0.0), (-40.0, 0.0)], 0.0)
    bodies = (
        Body("disc", "pivot", (0.0, 3e-3), inertia=1e-7, loops=(disc,)),
        Body("bar", "slide", (0.0, 0.0), velocity=(0.1,), mass=0.1, loops=(bar,)),
    )
    done = simulate(Scene("disc", bodies, contacts=(Contact((Side("disc"), Side("bar")), 0.3, 0.2),), duration=0.2))
    assert done.stop == Stop.DURATION
    np.testing.assert_allclose(done.end_q, [0.0, 0.02], atol=1e-12)


# Which of two gaps is closed where a body's one coordinate cannot close both?

NEAR, FAR, OFF = 1e-3, 22.4e-3, 1.557e-9  # m from the pivot to both corners, rad


@pytest.mark.parametrize("drawn", [1.11 * k for k in range(6)])
def test_the_corner_that_is_met_first_is_closed(drawn: float) -> None:
    """A flap lands on a bar that slides below it, its face off by OFF: the far corner touches, the near one stays OFF above it.

    Closing the near one instead would press the far one in by OFF (FAR - NEAR), past the ends of the fans of normals.
    """
    run = simulate(turned(_flap(0.05), drawn))
    assert not run.stop.gave_up
    assert run.q[-1, 1] - drawn == pytest.approx(OFF, abs=1e-13)
    assert run.worst_penetration < 1e-13


@pytest.mark.parametrize("drawn", [0.0, 2.0])
def test_the_other_one_takes_no_part(drawn: float) -> None:
    """The bar slides out from under the near corner: nothing happens, since that one stays above it.

    Taken for closed it would be lifted and hit again every few nanoseconds by the edge of the bar.
    """
    run = simulate(turned(_flap(0.16), drawn))
    assert run.q[run.t > 0.05, 1] - drawn == pytest.approx(OFF, abs=1e-13)
    assert run.q[-1, 0] > 0.05 + NEAR
    assert len(run.events) < 10


def _flap(duration: float) -> Scene:
    bar = Body("bar", "slide", velocity=(0.4,), mass=0.014, loops=(box(0.1, 0.005, (0.0, -0.0025)),))
    face = polygon((NEAR, 0.0), (FAR, -OFF * FAR), (FAR, 0.002), (NEAR, 0.002))
    flap = Body("flap", "pivot", (0.0, 0.0), 0.35, (0.0,), mass=0.02, inertia=3.4e-6, loops=(face,))
    contacts = (Contact((Side("bar"), Side("flap")), 0.0, 0.0),)
    return Scene("flap", (bar, flap), torques=(Torque("flap", -2e-3),), contacts=contacts, duration=duration)
