"""Is every touch found: grazes, thin blades, gaps that last, long steps past joints?"""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import late_touch
import numpy as np
import pytest
import shapely
from every_time import few
from moving_scenes import box, circle, ground, of_kind, polygon, tip, touching
from scipy.optimize import minimize_scalar

from watchsim import jit
from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.forces import Contact, Damping, Side, Spring
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop

# Is every touch found: grazes of a nanometre, thin blades hit fast, corners hit almost exactly?

NANOMETRE = 1e-9
QUADRATIC = 1e-16  # too weak to matter, but enough to take the exact flights away


def graze_of_two(depth: float, coupled: bool, speeds: tuple[float, float] = (7.0, -11.0)) -> tuple[Scene, float]:
    """The round pins of two rotors pass one another with this overlap at the closest point; scene and time of that."""
    shift, reach, arm = 2.3e-3, 1.0e-3, 1.5e-3

    def centre(t: float) -> float:
        """Distance of the pins' centres."""
        a, b = -2.0 + speeds[0] * t, math.pi + 3.1 + speeds[1] * t
        return math.hypot(shift + arm * math.cos(b) - reach * math.cos(a), arm * math.sin(b) - reach * math.sin(a))

    times = np.linspace(0.0, 0.6, 20001)
    near = times[np.argmin([centre(t) for t in times])]
    best = minimize_scalar(centre, bounds=(near - 1e-4, near + 1e-4), method="bounded", options={"xatol": 1e-15})
    small = 0.3 * best.fun
    pin = circle(best.fun - small + depth, (arm, 0.0))
    bodies = (
        Body("post", "pivot", (0.0, 0.0), -2.0, (speeds[0],), inertia=1e-12, loops=(circle(small, (reach, 0.0)),)),
        Body("pin", "pivot", (shift, 0.0), math.pi + 3.1, (speeds[1],), inertia=3e-12, loops=(pin,)),
    )
    damping = (Damping("post", 0.0, QUADRATIC * 1e-6),) if coupled else ()
    return Scene("graze", bodies, damping=damping, contacts=touching("post", "pin")), float(best.x)


@pytest.mark.parametrize("coupled", [False, True])
@pytest.mark.parametrize("depth", [-NANOMETRE, -1e-12, 1e-12, NANOMETRE])
def test_two_rotors_graze(depth: float, coupled: bool) -> None:
    """The pin misses by a nanometre, or picometre, or touches by as much."""
    scene, closest = graze_of_two(depth, coupled)
    done = simulate(scene, closest + 0.02)
    impacts = of_kind(done, EventKind.IMPACT)
    assert done.stop == Stop.DURATION
    assert done.worst_penetration < 1e-12
    if depth < 0.0:
        assert len(impacts) == 0
        assert done.u[-1] == pytest.approx(scene.bodies[0].velocity + scene.bodies[1].velocity, rel=1e-9)
    else:
        assert len(impacts) >= 1
        # It touches a little before the closest point: by sqrt(2 depth / relative acceleration).
        assert closest - 1e-3 < impacts[0]["t"] < closest


@pytest.mark.parametrize("coupled", [False, True])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_pin_strikes_a_thorn_and_stays_with_it(coupled: bool, restitution: float) -> None:
    """The pin of a fast rotor catches the flank of another one's thorn and pushes it away: time goes on."""
    bodies = (
        Body("thorn", "pivot", (0.0, 0.0), -2.0, (7.0,), inertia=1e-12, loops=(tip(1e-3),)),
        Body("pin", "pivot", (2.3e-3, 0.0), math.pi + 3.1, (-11.0,), inertia=3e-12, loops=(circle(0.1e-3, (1.5e-3, 0.0)),)),
    )
    damping = (Damping("thorn", 0.0, QUADRATIC * 1e-6),) if coupled else ()
    scene = Scene("catch", bodies, damping=damping, contacts=touching("thorn", "pin", restitution=restitution))
    done = simulate(scene, 2.0)
    assert done.stop == Stop.DURATION
    assert of_kind(done, EventKind.IMPACT)
    assert done.worst_penetration < 1e-12
    assert abs(done.energy["residual_J"]) < 1e-9 * 0.5 * (1e-12 * 49.0 + 3e-12 * 121.0)


@pytest.mark.parametrize("depth", [-NANOMETRE, NANOMETRE])
@pytest.mark.parametrize("amplitude", [0.3, 4.0])
def test_a_swinging_corner_grazes_a_line(depth: float, amplitude: float) -> None:
    """A sprung rotor brushes a fixed line with its thorn at full speed, half way through an exact flight."""
    reach = 1e-3
    fence = Loop((Line(reach + depth, 0.01, reach + depth, -0.01),), closed=False)
    rotor = Body("rotor", "pivot", (0.0, 0.0), -amplitude, (0.0,), inertia=1e-9, loops=(tip(reach),))
    scene = Scene(
        "fence",
        (rotor, Body("fence", "fixed", loops=(fence,))),
        springs=(Spring("rotor", 1e-9 * (8.0 * math.pi) ** 2),),
        contacts=touching("rotor", "fence"),
    )
    done = simulate(scene, 0.2)
    impacts = of_kind(done, EventKind.IMPACT)
    assert (len(impacts) > 0) == (depth < 0.0)
    if depth > 0.0:
        assert done.q[-1][0] == pytest.approx(-amplitude * math.cos(8.0 * math.pi * 0.2), rel=1e-12, abs=0.0)
    else:
        assert impacts[0]["t"] == pytest.approx(1.0 / 16.0, abs=1e-3)


def test_a_tangent_pass_of_a_sliding_body() -> None:
    """A slider's corner passes over a fixed round post by a nanometre, or brushes it."""
    for depth, hits in ((NANOMETRE, False), (-NANOMETRE, True)):
        knife = polygon((0.0, 0.0), (1e-4, 2e-3), (-1e-4, 2e-3))
        slider = Body("slider", "slide", (-0.01, 1e-3 + depth), velocity=(3.0,), mass=1e-3, loops=(knife,))
        scene = Scene("post", (slider, Body("post", "fixed", loops=(circle(1e-3),))), contacts=touching("slider", "post"))
        done = simulate(scene, 0.01)
        assert bool(of_kind(done, EventKind.IMPACT)) == hits
        if hits:
            # It meets the post where that is `depth` below the top: x = -sqrt(2 R depth).
            assert of_kind(done, EventKind.IMPACT)[0]["t"] == pytest.approx((0.01 - math.sqrt(2e-3 * -depth)) / 3.0, rel=1e-9)


@pytest.mark.parametrize("speed", [1.0, 30.0, 1000.0, 1e6])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_thin_blade_is_not_run_through(speed: float, restitution: float) -> None:
    """A blade of one micrometre, hit by a bullet's corner after a long flight in one step."""
    bullet = polygon((1e-3, 0.0), (-1e-3, 0.5e-3), (-1e-3, -0.5e-3))
    blade = box(1e-6, 4e-3)
    bodies = (
        Body("bullet", "slide", (-0.2, 1e-5), velocity=(speed,), mass=1e-3, loops=(bullet,)),
        Body("blade", "fixed", (0.0, 0.0), loops=(blade,)),
    )
    scene = Scene("blade", bodies, contacts=touching("bullet", "blade", restitution=restitution))
    done = simulate(scene, 0.5 / speed)
    hit = (0.2 - 1e-3 - 0.5e-6) / speed
    impacts = of_kind(done, EventKind.IMPACT)
    assert len(impacts) == 1
    assert impacts[0]["t"] == pytest.approx(hit, rel=1e-12)
    assert done.u[-1][0] == pytest.approx(-restitution * speed, rel=1e-12, abs=1e-15 * speed)
    assert done.worst_penetration < 1e-12


@pytest.mark.parametrize("coupled", [False, True])
def test_a_rotor_hits_a_thin_blade(coupled: bool) -> None:
    """At 2000 rad/s the thorn moves at 2 m/s and could cross the blade in half a microsecond."""
    blade = box(1e-6, 0.5e-3, (0.0, 0.9e-3))
    rotor = Body("rotor", "pivot", (0.0, 0.0), 0.0, (2000.0,), inertia=1e-10, loops=(tip(1e-3),))
    damping = (Damping("rotor", 0.0, 1e-22),) if coupled else ()
    scene = Scene(
        "blade",
        (rotor, Body("blade", "fixed", loops=(blade,))),
        damping=damping,
        contacts=touching("rotor", "blade", restitution=0.3),
    )
    done = simulate(scene, 1.2e-3)
    impacts = of_kind(done, EventKind.IMPACT)
    # The thorn's shoulder comes first.
    x, y = 0.7e-3, 0.1e-3
    assert impacts[0]["t"] == pytest.approx(
        (math.acos(0.5e-6 / math.hypot(x, y)) - math.atan2(y, x)) / 2000.0, rel=1e-9, abs=0.0
    )
    assert -600.01 < done.u[-1][0] <= -599.99


@pytest.mark.parametrize("aside", [-1e-10, -1e-11, -1e-12, 0.0, 1e-12, 1e-11, 1e-10])
def test_a_thorn_falls_on_a_corner(aside: float) -> None:
    """Corner on corner has no normal; lines beside it take over. Whatever is hit, nothing goes through."""
    thorn = polygon((0.0, 0.0), (0.4e-3, 1e-3), (-0.4e-3, 1e-3))
    post = Body("post", "fixed", loops=(box(1e-3, 1e-3, (-0.5e-3, -0.5e-3)),))
    body = Body("thorn", "slide", (aside, 2e-3), axis=(0.0, -1.0), velocity=(0.0,), mass=1e-6, loops=(thorn,))
    scene = Scene("corner", (body, post), contacts=touching("thorn", "post", restitution=0.2), gravity=(0.0, -9.81))
    done = simulate(scene, 0.1)
    impacts = of_kind(done, EventKind.IMPACT)
    assert impacts, "it fell through"
    assert impacts[0]["t"] == pytest.approx(math.sqrt(2.0 * 2e-3 / 9.81), rel=1e-6)
    # To the right of the post's corner the thorn's flank meets it a little lower.
    lowest = 2e-3 + max(0.0, aside) * 2.5
    assert done.q[:, 0].max() <= lowest + 1e-9
    assert done.u[-1][0] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("aside", [-1e-10, 0.0, 1e-10])
def test_a_disc_falls_on_a_corner(aside: float) -> None:
    """The corner's fan of normals begins where the faces' end: at the seam nothing may be lost or counted twice."""
    R, H = 1e-3, 5e-3
    disc = Body("disc", "free", (aside, R + H), mass=1e-6, inertia=0.5e-12, loops=(circle(R),))
    post = Body("post", "fixed", loops=(box(4e-3, 1e-3, (-2e-3, -0.5e-3)),))
    scene = Scene("seam", (disc, post), contacts=touching("disc", "post", restitution=0.5), gravity=(0.0, -9.81))
    fall = math.sqrt(2.0 * H / 9.81)
    done = simulate(scene, 1.5 * fall)
    impacts = of_kind(done, EventKind.IMPACT)
    assert impacts[0]["t"] == pytest.approx(fall, rel=1e-9)
    _, u = done.at(1.1 * fall)
    v = 9.81 * fall
    assert u[1] == pytest.approx(0.5 * v - 9.81 * 0.1 * fall, rel=1e-6)
    assert u[0] == pytest.approx(max(0.0, aside) / R * 1.5 * v, abs=1e-9 * v)


def test_many_balls_in_a_row_on_the_ground() -> None:
    """Every one of eight balls, dropped from different heights, bounces when it should."""
    heights = [0.01 * (k + 1) for k in range(8)]
    balls = tuple(
        Body(f"ball{k}", "free", (0.03 * k, 0.01 + h), mass=0.1, inertia=1e-5, loops=(circle(0.01),))
        for k, h in enumerate(heights)
    )
    contacts = tuple(touching(ball.name, "ground", restitution=0.8)[0] for ball in balls)
    done = simulate(Scene("balls", (*balls, ground()), contacts=contacts, gravity=(0.0, -9.81)), 0.3)
    for k, h in enumerate(heights):
        first = math.sqrt(2.0 * h / 9.81)
        mine = [event["t"] for event in of_kind(done, EventKind.IMPACT) if done.pairs[event["contact"]].body_a == f"ball{k}"]
        expected = [first * (1.0 + 2.0 * sum(0.8**j for j in range(1, n + 1))) for n in range(20)]
        expected = [t for t in expected if t < 0.3]
        assert mine == pytest.approx(expected, rel=1e-9)


LONG_FLIGHT = """
from moving_scenes import profile
from watchsim.contact import cells
from watchsim.simulation.simulate import simulate
cells.FEW_CONTACTS = 10**9
print(simulate(profile("bench_lever"), 0.05).stop.name)
"""


def test_the_search_always_advances() -> None:
    """Far down a long flight a gap closes by more within one rounding step of time than counts as zero: no endless loop.

    In a process of its own, since a compiled loop that stands still cannot be interrupted.
    """
    paths = f"import sys; sys.path[:0] = {sys.path!r}\n"
    done = subprocess.run([sys.executable, "-c", paths + LONG_FLIGHT], capture_output=True, text=True, timeout=600, check=True)
    assert done.stdout.split() == ["DURATION"]


def test_a_face_is_no_contact_from_behind() -> None:
    """Thrown up through an open floor from below, a ball meets nothing; falling back on it from above, it bounces."""
    radius, up, depth, g = 0.01, 5.0, 0.1, 9.81
    ball = Body("ball", "free", (0.0, -depth), velocity=(0.0, up, 0.0), mass=0.1, inertia=1e-5, loops=(circle(radius),))
    scene = Scene("floor", (ball, ground()), contacts=touching("ball", "ground", restitution=0.8), gravity=(0.0, -g))
    done = simulate(scene, 1.2)
    back = (up + math.sqrt(up**2 - 2.0 * g * (depth + radius))) / g
    (hit,) = of_kind(done, EventKind.IMPACT)
    assert hit["t"] == pytest.approx(back, rel=1e-9)
    assert done.u[-1][1] == pytest.approx(0.8 * math.sqrt(up**2 - 2.0 * g * (depth + radius)) - g * (1.2 - back), rel=1e-8)


# Does brute force at steps a thousand times finer find a touch that the simulation has missed?

DURATION, FINER = 1.0, 1000
CHORD = 5e-5  # how far the chords of an arc may stray, of outlines a metre across


def block(scale: float, bite: float) -> Loop:
    """A bar with a round nose and a round bite, about its origin."""
    s = scale
    return Loop(
        (
            Line(-0.5 * s, -0.2 * s, 0.3 * s, -0.2 * s),
            Arc(0.3 * s, 0.0, 0.2 * s, -0.5 * math.pi, math.pi),
            Line(0.3 * s, 0.2 * s, bite * s, 0.2 * s),
            Arc(0.0, 0.2 * s, bite * s, 0.0, -math.pi),
            Line(-bite * s, 0.2 * s, -0.5 * s, 0.2 * s),
            Line(-0.5 * s, 0.2 * s, -0.5 * s, -0.2 * s),
        )
    )


def spike(length: float) -> Loop:
    """A slender thorn about its origin."""
    points = [(length, 0.0), (-0.1 * length, 0.03 * length), (-0.1 * length, -0.03 * length)]
    return Loop(tuple(Line(*points[i], *points[(i + 1) % 3]) for i in range(3)))


def random_body(name: str, motion: str, rng: np.random.Generator) -> Body:
    place = (rng.uniform(0.4, 1.4), rng.uniform(-0.8, 0.8)) if name == "b" else (0.0, 0.0)
    direction = rng.uniform(-math.pi, math.pi)
    speeds = {"pivot": (rng.normal(0.0, 6.0),), "slide": (rng.normal(0.0, 2.0),), "fixed": ()}
    velocity = speeds.get(motion, (*rng.normal(0.0, 1.5, 2), rng.normal(0.0, 6.0)))
    loop = spike(rng.uniform(0.3, 0.8)) if rng.random() < 0.4 else block(rng.uniform(0.3, 1.0), rng.uniform(0.02, 0.15))
    return Body(
        name,
        motion,
        place,
        direction,
        velocity,
        axis=(math.cos(2.0 * direction), math.sin(2.0 * direction)),
        mass=0.0 if motion == "pivot" else 1.0,
        inertia=0.1,
        loops=(loop,),
    )


def outlines(body: Body, t: np.ndarray, gravity: tuple[float, float]) -> np.ndarray:
    """The body's polygon at every instant of its free motion."""
    fall = np.array(gravity)
    x, y, angle = (np.full(len(t), v) for v in (*body.position, body.angle))
    if body.motion == "pivot":
        angle = angle + body.velocity[0] * t
    elif body.motion == "slide":
        way = body.velocity[0] * t + 0.5 * float(fall @ np.array(body.axis)) * t**2
        x, y = x + way * body.axis[0], y + way * body.axis[1]
    elif body.motion == "free":
        x, y = (v + body.velocity[i] * t + 0.5 * fall[i] * t**2 for i, v in ((0, x), (1, y)))
        angle = angle + body.velocity[2] * t
    points = polyline(body.loops[0], CHORD)
    turned = (points[:, 0] + 1j * points[:, 1])[None, :] * np.exp(1j * angle)[:, None] + (x + 1j * y)[:, None]
    return shapely.polygons(np.stack([turned.real, turned.imag], axis=-1))


@pytest.mark.parametrize(
    "motions", few([("pivot", "pivot"), ("pivot", "fixed"), ("slide", "pivot"), ("free", "pivot"), ("free", "fixed")], 2)
)
@pytest.mark.parametrize("wanted", [1, pytest.param(20, marks=pytest.mark.slow)])
def test_the_first_touch_is_the_one_that_brute_force_sees(motions: tuple[str, str], wanted: int) -> None:
    rng = np.random.default_rng(sum(map(ord, "".join(motions))))
    met = missed = 0
    while met < wanted or missed < 1:
        a, b = (random_body(name, motion, rng) for name, motion in zip("ab", motions, strict=True))
        gravity = (0.0, float(rng.choice([0.0, -3.0])))
        start = np.zeros(1)
        if shapely.distance(outlines(a, start, gravity), outlines(b, start, gravity))[0] < 1e-3:
            continue
        scene = Scene("flight", (a, b), contacts=(Contact((Side("a"), Side("b")), 0.1, 0.5),), gravity=gravity)
        done = simulate(scene, DURATION)
        hits = done.events[done.events["kind"] == EventKind.IMPACT]
        told = float(hits["t"][0]) if len(hits) else math.inf
        steps = max(1, np.count_nonzero(done.t <= told))
        apart = min(told, DURATION) / steps / FINER
        t = np.arange(0.5 * apart, DURATION, apart)[: 8 * FINER]  # half a step off, so that none is `told` itself
        touching = shapely.intersects(outlines(a, t, gravity), outlines(b, t, gravity))
        if touching.any():
            assert told <= t[np.argmax(touching)], "the simulation went through"
        assert not touching[t < told - 1e-4].any()
        if told < math.inf:
            there = np.array([told])
            assert shapely.distance(outlines(a, there, gravity), outlines(b, there, gravity))[0] < 2.0 * CHORD
        met, missed = met + (told < math.inf), missed + (told == math.inf)


# Is a gap that stays at rounding looked at rarely, and is what it does in the end found at its time?

KEPT = Path(__file__).resolve().parents[1] / "data" / "hunt"
FALL, SPEED, HEIGHT = 9.81, 0.6, 4e-3  # m/s², m/s, m


def _polygon(*points: tuple[float, float]) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, (*points[1:], points[0]), strict=True)))


def _along_a_wall(lean: float, turn: float) -> Scene:
    """A block flies up along a wall that it touches; at `HEIGHT` above its corner the wall leans over by `lean`."""
    c, s = math.cos(turn), math.sin(turn)

    def turned(x: float, y: float) -> tuple[float, float]:
        return c * x - s * y, s * x + c * y

    half = 5e-3
    bend, top = 2.0 * half + HEIGHT, 0.04
    wall = _polygon((-half, -0.02), (0.0, -0.02), (0.0, bend), ((top - bend) * math.tan(lean), top), (-half, top))
    block = _polygon((-half, -half), (half, -half), (half, half), (-half, half))
    x, y = turned(half, half)
    vx, vy = turned(0.0, SPEED)
    bodies = (
        Body("wall", "fixed", (0.0, 0.0), turn, loops=(wall,)),
        Body("block", "free", (x, y), turn, (vx, vy, 0.0), mass=0.02, inertia=3e-7, loops=(block,)),
    )
    contact = Contact((Side("wall"), Side("block")), 0.0, 0.0)
    return Scene("wall", bodies, contacts=(contact,), gravity=turned(0.0, -FALL), duration=0.02)


@pytest.mark.parametrize("turn", [0.0, 0.7])
@pytest.mark.parametrize("lean", [1e-3, 0.2])
def test_a_block_that_flies_along_a_wall_meets_where_it_leans_over(lean: float, turn: float) -> None:
    run = simulate(_along_a_wall(lean, turn), tolerance=1e-11, prefilter=False)
    first = run.events[run.events["kind"] == EventKind.IMPACT]["t"][0]
    # The wall leans over HEIGHT above the block's upper corner.
    expected = (SPEED - math.sqrt(SPEED**2 - 2.0 * FALL * HEIGHT)) / FALL
    assert first == pytest.approx(expected, rel=1e-7)
    assert run.counts["gap_evaluations"] < 10_000  # 400 000 and more where accelerations are bounded one by one


def test_a_body_that_turns_about_a_corner_on_a_corner_is_looked_at_rarely() -> None:
    scene = load(KEPT / "boxed-77-2415.toml")
    counts = [simulate(scene, tolerance=tolerance, prefilter=False).counts for tolerance in (1e-9, 1e-7)]
    assert max(count["gap_evaluations"] for count in counts) < 60_000  # were 1.3 million, and 47 million turned by 219°


@pytest.mark.parametrize("tolerance", [1e-7, 1e-9, 1e-11])
def test_a_block_that_lands_flat_keeps_the_corner_on_which_it_stood(tolerance: float) -> None:
    """Drift of that corner's gap had turned the block past the end of the corner's normals: it was let go, and hit again."""
    run = simulate(load(KEPT / "blocks-77-1586.toml"), tolerance=tolerance)
    landing = run.events[np.isclose(run.events["t"], 0.1329445, atol=1e-7)]
    names = [str(run.pairs[k]) for k in landing["contact"]]
    assert all(EventKind(kind) != EventKind.OPEN for kind in landing["kind"]), names
    hit = {int(k) for k in landing[landing["kind"] == EventKind.IMPACT]["contact"]}
    assert len(hit) == 2


# Is a mode's end found in a long step, and is the next face met without a jump? On scenes that the hunt found.

FOUND = Path(__file__).parents[1] / "data" / "hunt"


@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 1e-9, 1e-11])
def test_a_block_tips_when_its_support_has_slid_from_below_its_centre(tolerance):
    """Block `a` slides below `b` without friction; a corner of `b` is let go when one of `a` has come below its centre."""
    scene = load(FOUND / "blocks-801-4472.toml")
    run = simulate(scene, tolerance=tolerance)
    a, b = (next(body for body in scene.bodies if body.name == name) for name in "ab")
    half_width = max(edge.start[0] for edge in a.loops[0].edges)
    tips = (a.position[0] + half_width - b.position[0]) / -a.velocity[0]
    let_go = run.events[run.events["kind"] == EventKind.OPEN]["t"][0]
    assert let_go == pytest.approx(tips, rel=1e-6)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-7, 1e-9])
def test_the_next_face_is_met_where_bodies_are(tolerance):
    """A roller on a wave of arcs: energy does not rise, and no event moves a body by more than the tolerance."""
    scene = load(FOUND / "wave-801-9913.toml")
    run = simulate(scene, tolerance=tolerance)
    masses = {body.name: (body.mass, body.inertia) for body in scene.bodies}
    (bar, _), (roller, inertia) = masses["bar"], masses["roller"]
    kinetic = 0.5 * run.u**2 @ np.array([bar, roller, roller, inertia])
    total = kinetic - roller * scene.gravity[1] * run.q[:, run.slices["roller"]][:, 1]
    rise = (total - np.minimum.accumulate(total)).max()
    assert rise < max(10.0 * tolerance, 1e-9) * kinetic.max()
    at_once = np.diff(run.t) == 0.0
    assert np.abs(np.diff(run.q, axis=0))[at_once][:, :3].max() < max(tolerance, 1e-9) * 0.1


# Does a step end where it says, when the contact that ended it cannot be found to have closed earlier?

PATHS = (Path(jit.__file__).resolve().parents[1], Path(__file__).resolve().parent)


@pytest.mark.slow  # a second: another interpreter
def test_a_touch_found_late_leaves_the_bodies_where_the_step_ends() -> None:
    """Newton's steps from there to when the contact closed are too few; the state was left at the last of them."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, PATHS)), "NUMBA_DISABLE_JIT": "1"}
    told = subprocess.run([sys.executable, late_touch.__file__], env=environment, check=True, capture_output=True, text=True)
    rows = json.loads(told.stdout)
    end, braking = late_touch.LATE, late_touch.FRICTION * late_touch.FALL
    at_end = rows["t"].index(end)
    x, _, _, fallen = rows["q"][at_end]
    assert x == pytest.approx((late_touch.SPEED - 0.5 * braking * end) * end, rel=1e-12)
    assert fallen == pytest.approx(-0.5 * late_touch.FALL * end**2, rel=1e-12)
    assert rows["u"][at_end][0] == pytest.approx(late_touch.SPEED - braking * end, rel=1e-12)
    assert rows["u"][at_end][3] == pytest.approx(-late_touch.FALL * end, rel=1e-12)
