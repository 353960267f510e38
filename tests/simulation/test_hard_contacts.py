"""What happens at the edges of contact, and do heaps come to rest?"""

import dataclasses
import math

import numpy as np
import pytest
from moving_scenes import box, circle, ground, of_kind, on_slope, polygon, profile, touching
from scipy.integrate import solve_ivp

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Contact, Side, Spring
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Recording, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

# What happens at the edges of contact: grazing by a nanometre, hitting a corner, elastic motion run backwards?

NANO = (1e-9, 1e-10, 1e-11, 1e-12)


def impacts(run: Trajectory) -> np.ndarray:
    return run.events[run.events["kind"] == EventKind.IMPACT]


def passing(clearance: float) -> Scene:
    """A pin flies past a round post; at its nearest the gap would be `clearance`."""
    pin = Body(
        "pin", "free", (-2e-3, 1.5e-3 + clearance), velocity=(0.1, 0.0, 0.0), mass=1e-3, inertia=1e-10, loops=(circle(5e-4),)
    )
    post = Body("post", "fixed", loops=(circle(1e-3),))
    return Scene("passing", (pin, post), contacts=touching("pin", "post"), duration=0.04)


@pytest.mark.parametrize("size", NANO)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_graze_touches_or_not_as_the_sign_of_the_gap_says(size: float, sign: float) -> None:
    done = simulate(passing(sign * size))
    assert done.stop == Stop.DURATION
    found = impacts(done)
    if sign > 0.0:
        assert len(found) == 0
        assert done.q[-1, 1] == 1.5e-3 + size
        return
    # The touch comes sqrt(2 R size) before the middle, with the speed v sqrt(2 size / R), R the distance of the centres.
    assert len(found) == 1
    reach = 1.5e-3
    assert found["value"][0] == pytest.approx(-0.1 * math.sqrt(2.0 * size / reach), rel=1e-3)
    assert found["t"][0] == pytest.approx(0.02 - math.sqrt(2.0 * reach * size) / 0.1, abs=1e-9)
    # Without restitution the pin leaves along the tangent: it is never nearer than touching.
    distance = np.hypot(done.q[:, 0], done.q[:, 1])
    assert distance.min() > reach - 1e-15


def thorn_on_corner(aside: float) -> Scene:
    """A thorn slides diagonally towards the upper right corner of a block, `aside` to the right of it."""
    shape = polygon((0.0, 0.0), (4e-4, 2e-4), (4e-4, 6e-4), (2e-4, 4e-4))
    start, c = 1e-3, math.sqrt(0.5)
    thorn = Body(
        "thorn", "slide", (start + c * aside, start - c * aside), axis=(-c, -c), velocity=(0.05,), mass=1e-4, loops=(shape,)
    )
    block = Body("block", "fixed", loops=(box(2e-3, 2e-3, (-1e-3, -1e-3)),))
    return Scene("thorn on a corner", (thorn, block), contacts=touching("thorn", "block"), duration=0.05)


@pytest.mark.parametrize("aside", [*NANO, 0.0, *(-x for x in NANO)])
def test_a_thorn_meets_one_neighbour_of_a_corner_and_never_passes(aside: float) -> None:
    done = simulate(thorn_on_corner(aside))
    assert done.stop == Stop.DURATION
    found = impacts(done)
    assert len(found) >= 1
    faces = {(done.pairs[k].primitive_b, done.pairs[k].index_b) for k in found["contact"]}
    assert len(faces) == 1
    # Without restitution and friction it is stopped where it touches.
    assert done.u[-1, 0] == pytest.approx(0.0, abs=1e-12)
    assert done.q[-1, 0] == pytest.approx(math.sqrt(2.0) * 1e-3, abs=2e-9)


def test_a_thorn_beside_a_corner_meets_the_face_on_its_side() -> None:
    """1 nm to the right: the right face; 1 nm to the left: the top."""
    right, left = (simulate(thorn_on_corner(aside)) for aside in (1e-9, -1e-9))
    faces = [done.pairs[impacts(done)["contact"][0]].index_b for done in (right, left)]
    assert faces[0] != faces[1]


def billiards(count: int, gravity: float = -3.0) -> Scene:
    """Discs in a box, without friction, with restitution 1."""
    starts = ((0.011, 0.017, 0.21, 0.13), (-0.021, -0.012, -0.12, 0.31), (0.004, -0.027, 0.18, -0.07))[:count]
    balls = tuple(
        Body(f"ball{i}", "free", (x, y), velocity=(vx, vy, 0.0), mass=0.01, inertia=1e-7, loops=(circle(5e-3),))
        for i, (x, y, vx, vy) in enumerate(starts)
    )
    corners = ((-0.04, -0.05), (0.04, -0.05), (0.04, 0.05), (-0.04, 0.05))
    walls = tuple(Line(*b, *a) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))
    room = Body("room", "fixed", loops=(Loop(walls[::-1], hole=True),))
    contacts = [touching(ball.name, "room", restitution=1.0)[0] for ball in balls]
    contacts += [touching(f"ball{i}", f"ball{j}", restitution=1.0)[0] for i in range(count) for j in range(i)]
    return Scene("billiards", (*balls, room), contacts=tuple(contacts), gravity=(0.0, gravity), duration=2.0, tolerance=1e-12)


def backwards(scene: Scene, run: Trajectory) -> Scene:
    """The scene begun where the run ended, with all velocities turned round."""
    bodies = []
    for old in scene.bodies:
        body = old
        if body.motion == "free":
            q, u = run.q[-1][run.slices[body.name]], run.u[-1][run.slices[body.name]]
            velocity = tuple(float(-v) for v in u)
            body = dataclasses.replace(body, position=(float(q[0]), float(q[1])), angle=float(q[2]), velocity=velocity)
        elif body.motion == "pivot":
            q, u = run.q[-1][run.slices[body.name]], run.u[-1][run.slices[body.name]]
            body = dataclasses.replace(body, angle=float(q[0]), velocity=(-float(u[0]),))
        bodies.append(body)
    return dataclasses.replace(scene, bodies=tuple(bodies))


@pytest.mark.parametrize("count, duration, growth", [(1, 8.0, 1e2), (2, 2.0, 1e7)])
def test_elastic_motion_runs_backwards_to_its_start(count: int, duration: float, growth: float) -> None:
    """One ball between straight walls: rounding adds up over 100 impacts. Two balls: each impact between them magnifies it."""
    scene = billiards(count)
    there = simulate(scene, duration)
    back = simulate(backwards(scene, there), duration)
    assert len(impacts(there)) >= 20
    assert len(impacts(back)) == len(impacts(there))
    assert np.abs(back.q[-1] - there.q[0]).max() < growth * 1e-14
    assert there.energy["dissipated"]["impacts"] == pytest.approx(0.0, abs=1e-16)


@pytest.mark.parametrize("duration, count, worst", [(5e-3, 25, 1e-12), (1e-2, 60, 1e-9)])
def test_an_elastic_lever_runs_backwards_to_its_start(duration: float, count: int, worst: float) -> None:
    """The bench lever without damping and friction, knocked off its banking: lever and driven wheel hammer on each other."""
    scene = profile("bench_lever")
    bodies = tuple(
        dataclasses.replace(body, angle=body.angle + {"wheel": 0.02}.get(body.name, 0.0), velocity=velocity)
        for body, velocity in ((body, (-30.0,) if body.name == "lever" else body.velocity) for body in scene.bodies)
    )
    contacts = tuple(dataclasses.replace(one, friction=0.0, restitution=1.0) for one in scene.contacts)
    scene = dataclasses.replace(scene, bodies=bodies, contacts=contacts, damping=())
    there = simulate(scene, duration)
    back = simulate(backwards(scene, there), duration)
    assert len(impacts(there)) == len(impacts(back)) > count
    assert np.abs(back.q[-1] - there.q[0]).max() < worst
    kinetic = 0.5 * 4e-12 * 30.0**2
    assert abs(there.energy["dissipated"]["impacts"]) < 1e-11 * kinetic


def test_the_order_of_bodies_and_contacts_does_not_matter() -> None:
    """Renumbered, the bench lever makes the same events between the same parts, to rounding."""
    scene = profile("bench_lever")
    other = dataclasses.replace(scene, bodies=scene.bodies[::-1], contacts=scene.contacts[::-1])
    one, two = simulate(scene, 0.5), simulate(other, 0.5)
    for body in one.slices:
        assert two.q[-1][two.slices[body]] == pytest.approx(one.q[-1][one.slices[body]], abs=1e-10)
    assert one.counts["impacts"] == two.counts["impacts"]


def locked() -> Scene:
    """The bench lever with its balance standing still far outside the fork."""
    scene = profile("bench_lever")
    balance = scene.body("balance")
    still = dataclasses.replace(scene.springs[0], rest=balance.angle)
    return dataclasses.replace(scene, springs=(still,), duration=86400.0)


@pytest.mark.parametrize("duration", [600.0, pytest.param(86400.0, marks=pytest.mark.slow)])
def test_a_locked_lever_does_not_creep(duration: float) -> None:
    """After the first second not a bit of any coordinate changes, however long."""
    scene = dataclasses.replace(locked(), record=Recording(((0.0, 1.0), (duration - 1.0, duration))))
    done = simulate(scene, duration)
    assert done.stop == Stop.DURATION
    assert done.t[-1] == duration
    after = np.searchsorted(done.t, 0.9)
    assert np.array_equal(done.q[after], done.q[-1])
    assert np.all(done.u[-1] == 0.0)


def test_bodies_that_touch_without_a_force_travel_on_together() -> None:
    """Two discs side by side at one speed: nothing presses them, nothing parts them, time goes on."""
    discs = tuple(
        Body(f"disc{i}", "slide", (i * 0.01, 0.0), velocity=(0.3,), mass=0.01, loops=(circle(5e-3),)) for i in range(2)
    )
    done = simulate(Scene("two discs", discs, contacts=touching("disc0", "disc1"), duration=1.0))
    assert done.stop == Stop.DURATION
    assert done.q[-1] == pytest.approx([0.3, 0.3], rel=1e-14, abs=0.0)


@pytest.mark.parametrize("name", ["rocking", "rocking slowly", "groove"])
def test_accumulation_moves_nothing_beyond_the_stated_error(name: str) -> None:
    """A disc thrown into a groove, a block dropped on a corner: with restitution the end does not depend on the tolerance."""
    runs = [simulate(SETTLING[name](), tolerance=tolerance) for tolerance in (1e-9, 1e-12)]
    assert [run.stop for run in runs] == [Stop.DURATION, Stop.DURATION]
    assert runs[0].q[-1] == pytest.approx(runs[1].q[-1], abs=1e-8)
    assert np.abs(runs[0].u[-1]).max() < 1e-9
    assert all(0 < run.counts["impacts"] < 1000 for run in runs)
    assert all(run.energy["residual_relative"] < 200.0 * run.tolerance for run in runs)


def test_a_block_that_has_done_rocking_stands_still() -> None:
    """Slender, with friction enough to tip it: its last corners stop its slip too, else it would rock by that for ever."""
    width, height, spin = 2e-3, 40e-3, 0.05
    speeds = (0.5 * height * spin, 0.5 * width * spin, -spin)
    block = Body("block", "free", (0.0, 0.5 * height), velocity=speeds, mass=0.01, inertia=1.3e-6, loops=(box(width, height),))
    contact = touching("block", "ground", friction=1.0)
    for angle in (0.0, 0.02):
        done = simulate(Scene("block", (block, ground()), contacts=contact, gravity=on_slope(angle), duration=5.0))
        assert done.counts["accumulations"] == 1
        assert done.counts["impacts"] < 3000
        assert np.all(done.u[-1] == 0.0)
        assert abs(done.q[-1, 2]) < 1e-9


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-9, 1e-10, 1e-11])
@pytest.mark.parametrize("angle", [0.1, 0.103, -0.09, 0.2])
def test_a_block_that_lands_flat_does_not_fall_through(tolerance: float, angle: float) -> None:
    """The corner that lands comes within its primitives at the very moment at which its gap closes."""
    scene = dropped_block()
    block = dataclasses.replace(scene.bodies[0], angle=angle, position=(0.0, 0.0185))
    done = simulate(dataclasses.replace(scene, bodies=(block, scene.bodies[1])), tolerance=tolerance)
    assert done.stop == Stop.DURATION
    assert done.q[-1, 1] == pytest.approx(0.015, abs=1e-8)


def dropped_block() -> Scene:
    block = Body(
        "block", "free", (0.0, 0.016), angle=0.1, velocity=(0.0, 0.0, 0.5), mass=0.01, inertia=2e-6, loops=(box(0.02, 0.03),)
    )
    contact = touching("block", "ground", friction=0.6, restitution=0.3)
    return Scene("dropped block", (block, ground()), contacts=contact, gravity=(0.0, -9.81), duration=1.0)


def disc_in_groove() -> Scene:
    flanks = Loop((Line(0.1, 0.1, 0.0, 0.0), Line(0.0, 0.0, -0.08, 0.1)), closed=False)
    disc = Body("disc", "free", (0.004, 0.015), velocity=(0.1, 0.0, 5.0), mass=0.01, inertia=8e-8, loops=(circle(4e-3),))
    contact = touching("disc", "groove", friction=0.3, restitution=0.5)
    return Scene(
        "disc in a groove",
        (disc, Body("groove", "fixed", loops=(flanks,))),
        contacts=contact,
        gravity=(0.0, -9.81),
        duration=1.5,
    )


def slowly_rocking() -> Scene:
    """Weak gravity: the corners rise by less than the rounding of their gaps long before a rebound takes a microsecond."""
    scene = dropped_block()
    block = dataclasses.replace(scene.bodies[0], velocity=(0.0, 0.0, 0.02))
    return dataclasses.replace(scene, bodies=(block, scene.bodies[1]), gravity=(0.0, -0.01), duration=32.0)


SETTLING = {"rocking": dropped_block, "rocking slowly": slowly_rocking, "groove": disc_in_groove}


# Do free bodies that tumble onto each other, stick, slide and rock come to rest, or to the end of the run?

WIDE = 0.015  # m, half the width of the slot
PLACES = {
    "floor": ground(),
    "groove": Body("ground", "fixed", loops=(Loop((Line(0.1, 0.1, 0.0, 0.0), Line(0.0, 0.0, -0.1, 0.1)), closed=False),)),
    "slot": Body(
        "ground",
        "fixed",
        loops=(Loop((Line(WIDE, 1.0, WIDE, 0.0), Line(WIDE, 0.0, -WIDE, 0.0), Line(-WIDE, 0.0, -WIDE, 1.0)), closed=False),),
    ),
}


def falling(rng: np.random.Generator, name: str, bottom: float) -> tuple[Body, float]:
    """A disc or a block thrown from above `bottom`, and the height of its top."""
    width, height = rng.uniform(2e-3, 2e-2, 2)
    reach, inertia, loop = 0.5 * math.hypot(width, height), 0.01 * (width**2 + height**2) / 12.0, box(width, height)
    if rng.random() < 0.3:
        reach, inertia, loop = 0.5 * height, 0.005 * (0.5 * height) ** 2, circle(0.5 * height)
    y = bottom + reach + float(rng.uniform(1e-4, 2e-3))
    velocity = (0.1 * float(rng.normal()), 0.1 * float(rng.normal()), 5.0 * float(rng.normal()))
    body = Body(
        name,
        "free",
        (0.0, y),
        angle=float(rng.uniform(-1.0, 1.0)),
        velocity=velocity,
        mass=0.01,
        inertia=float(inertia),
        loops=(loop,),
    )
    return body, y + reach


def heap(rng: np.random.Generator, place: str, count: int) -> Scene:
    bodies, top = [], 0.02 if place == "groove" else 0.0
    for i in range(count):
        body, top = falling(rng, f"body{i}", top)
        bodies.append(body)
    names = [*(body.name for body in bodies), "ground"]
    friction, restitution = float(rng.choice([0.1, 0.3, 0.6, 1.0])), float(rng.choice([0.0, 0.2, 0.5]))
    contacts = tuple(
        Contact((Side(one), Side(other)), friction, restitution) for i, one in enumerate(names) for other in names[i + 1 :]
    )
    return Scene(f"{place} with {count}", (*bodies, PLACES[place]), contacts=contacts, gravity=(0.0, -9.81), duration=1.0)


MANY = 12  # scenes
SOME = [(place, count, (MANY, 2, 1)[count - 1]) for place in PLACES for count in (1, 2, 3) if (place, count) != ("groove", 3)]
ALL = [pytest.param(place, count, MANY, marks=pytest.mark.slow) for place, count, scenes in SOME if scenes < MANY]


@pytest.mark.parametrize(("place", "count", "scenes"), [*SOME, *ALL])
def test_a_heap_comes_to_the_end(place: str, count: int, scenes: int) -> None:
    """No hang, no stop, nothing runs into anything, and the energy ledger closes."""
    rng = np.random.default_rng(22)
    for number in range(scenes):
        run = simulate(heap(rng, place, count))
        assert run.stop == Stop.DURATION, number
        assert run.worst_penetration < 1e-9
        assert run.energy["residual_relative"] < 1e-6


def test_a_long_flight_does_not_make_short_looks() -> None:
    """A disc that leaves a corner with no force, and might fly for long: with bounds of the whole flight it took 63 million."""
    rng = np.random.default_rng(2)
    scene = [heap(rng, "floor", 3) for _ in range(10)][-1]
    run = simulate(scene, 0.4)
    assert run.stop == Stop.DURATION
    assert run.counts["gap_evaluations"] < 5_000_000


# Does what stands beside an unstable rest leave it when it must, and does what stands exactly at it stay?
#
# The times are those of the equation of motion, solved by scipy to 1e-12.

G = 9.81
DOWN = (0.0, -G)
BESIDE = [1e-3, 1e-6, 1e-9, 1e-11]  # rad


def time_of(start: float, square: float, end: float) -> float:
    """When an angle with angle'' = square sin(angle), let go at `start`, comes to `end`, s."""

    def there(t, z):
        return z[0] - end

    there.terminal = True
    law = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-30}
    found = solve_ivp(lambda t, z: [z[1], square * math.sin(z[0])], (0, 60), [start, 0], events=there, **law)
    return float(found.t[-1])


def on_hilltop(angle: float, hill: float = 0.05, disc: float = 0.005) -> Scene:
    """A smooth disc on top of a round hill."""
    arm = hill + disc
    place = arm * math.sin(angle), arm * math.cos(angle)
    body = Body("disc", "free", position=place, mass=0.01, inertia=1.25e-7, loops=(circle(disc),))
    bodies = (Body("hill", "fixed", loops=(circle(hill),)), body)
    return Scene("hilltop", bodies, contacts=touching("hill", "disc"), gravity=DOWN)


def upright(angle: float) -> Scene:
    """A pendulum above its pivot."""
    body = Body("pendulum", angle=angle, mass=0.1, inertia=1e-3, centre_of_mass=(0.0, 0.1))
    return Scene("upside down", (body,), gravity=DOWN)


def on_end(angle: float) -> Scene:
    """A rod that stands on its pointed end, 60 mm below its centre of mass; friction holds the point."""
    r = 0.06
    outline = polygon((0.0, -r), (0.002, -0.9 * r), (0.002, r), (-0.002, r), (-0.002, -0.9 * r))
    place = -r * math.sin(angle), r * math.cos(angle)
    body = Body("rod", "free", position=place, angle=angle, mass=0.02, inertia=2.4e-5, loops=(outline,))
    return Scene("on end", (body, ground()), contacts=touching("rod", "ground", friction=1.0), gravity=DOWN)


@pytest.mark.parametrize("angle", BESIDE)
def test_a_disc_leaves_the_top_of_a_hill(angle: float) -> None:
    """It loses touch where two thirds of the height are left (Newton's law with the speed that energy gives)."""
    due = time_of(angle, G / 0.055, math.acos(2.0 / 3.0 * math.cos(angle)))
    opened = of_kind(simulate(on_hilltop(angle), 1.02 * due), EventKind.OPEN)
    assert [event["t"] for event in opened] == [pytest.approx(due, abs=1e-12 / angle + 1e-7)]


@pytest.mark.parametrize("angle", BESIDE)
@pytest.mark.parametrize(("scene", "column", "square"), [(upright, 0, 0.1 * G * 0.1 / 1e-3), (on_end, 2, G / (0.06 + 0.02))])
def test_what_stands_upright_falls(scene, column: int, square: float, angle: float) -> None:
    due = time_of(angle, square, 0.2)
    run = simulate(scene(angle), due)
    assert run.end_q[column] == pytest.approx(0.2, abs=1e-11 / angle + 1e-6)


@pytest.mark.parametrize("scene", [on_hilltop, upright, on_end])
def test_what_stands_exactly_stays(scene) -> None:
    exact = scene(0.0)
    run = simulate(exact, 20.0)
    assert run.simulated == 20.0 and abs(run.q - run.q[0]).max() < 1e-15


# Is no gap between the ends of an arc passed unseen, however long the steps are?


@pytest.mark.parametrize("tolerance", [1e-5, 3e-6, 3e-7, 1e-7])
def test_a_duplex_goes_at_every_tolerance(tolerance: float) -> None:
    """A tooth that rested on the roller passed the notch in one step; at the other corner of the notch it held the balance."""
    scene = load(profiles_dir() / "duplex")
    coarse, fine = (simulate(scene, 1.0, tolerance=one) for one in (tolerance, 1e-9))
    assert coarse.q[-1] == pytest.approx(fine.q[-1], abs=3e-4)


@pytest.mark.parametrize("seed", range(24))
def test_a_point_leaves_a_turning_disc_where_its_arc_ends(seed: int) -> None:
    """Without friction the disc keeps its rate, so that the angle of the flat gives the time."""
    dice = np.random.default_rng([2026, seed])
    radius = 2e-3
    gap, rate = 10.0 ** dice.uniform(-2.0, 0.3), dice.choice([-1.0, 1.0]) * 10.0 ** dice.uniform(-1.0, 3.0)
    way = dice.uniform(0.05, 5.0)  # rad, from the start to the flat
    arc = Arc(0.0, 0.0, radius, 0.5 * gap, 2.0 * math.pi - gap)
    angle = 0.5 * math.pi + math.copysign(0.5 * gap + way, -rate)
    wedge = ((0.0, 0.0), (0.1 * radius, radius), (-0.1 * radius, radius))
    disc = Loop((arc, Line(*arc.end, *arc.start)))
    scene = Scene(
        "a disc with a flat",
        (
            Body("disc", "pivot", (0.0, 0.0), angle, velocity=(rate,), inertia=1e-8, loops=(disc,)),
            Body(
                "point",
                "slide",
                (0.0, radius),
                axis=(0.0, 1.0),
                mass=1e-5,
                loops=(Loop(tuple(Line(*wedge[i - 1], *wedge[i]) for i in range(3))),),
            ),
        ),
        springs=(Spring("point", 2.0, -2e-3),),
        contacts=(Contact((Side("point"), Side("disc")), 0.0, 0.0),),
        duration=30.0 / abs(rate),
    )
    run = simulate(scene, (way + 0.5 * gap) / abs(rate), tolerance=10.0 ** dice.uniform(-10.0, -3.0))
    ends = run.events["t"][np.isin(run.events["kind"], (EventKind.OPEN, EventKind.HANDOVER))]
    assert ends[0] == pytest.approx(way / abs(rate), rel=1e-9)
