"""Do bodies come to rest by friction, stay at rest, and move again when they must?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from every_time import few
from moving_scenes import box, circle, ground, of_kind, on_slope, profile, tip, touching
from reference import rolling
from reference.block import block, stops_at
from reference.rolling import Disc

from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Damping, Spring, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.motion.sleeping import _share_terms
from watchsim.simulation.record.trajectory import EventKind
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

SIDE = 0.1


@pytest.mark.parametrize("friction", few([0.15, 0.0], 1))
@pytest.mark.parametrize("quadratic", [0.0, 1e-12])
def test_a_rotor_pressed_on_a_stop_stays(friction: float, quadratic: float) -> None:
    """For a minute, with something else swinging; with and without an exact solution of its free motion."""
    bodies = (
        Body("rotor", "pivot", (0.0, 0.0), 0.0, (3.0,), inertia=4e-12, loops=(tip(2e-3),)),
        Body("stop", "fixed", (2e-3 * math.cos(0.1), 2e-3 * math.sin(0.1) + 0.3e-3), loops=(circle(0.2e-3),)),
        Body("balance", "pivot", (1.0, 1.0), 1.0, inertia=1e-9),
    )
    scene = Scene(
        "stop",
        bodies,
        springs=(Spring("balance", 1e-9 * (8.0 * math.pi) ** 2),),
        torques=(Torque("rotor", 1e-6),),
        damping=(Damping("rotor", 0.0, quadratic),),
        contacts=touching("rotor", "stop", friction=friction, restitution=0.2),
    )
    done = simulate(scene, 60.0, record=((0.1, 0.2), (59.9, 60.0)))
    assert done.stop == Stop.DURATION
    angle = done.q[:, 0]
    assert np.ptp(angle) < 1e-12
    assert np.all(done.u[:, 0] == 0.0)
    assert done.q[-1][2 - 1] == pytest.approx(math.cos(8.0 * math.pi * 60.0), abs=1e-9)
    assert not [event for event in done.events if event["t"] > 0.1 and event["kind"] < EventKind.TURN]


@pytest.mark.slow
def test_the_locked_lever_of_the_bench_stays() -> None:
    """No balance: the wheel draws the lever onto its banking and both stand still for a minute."""
    whole = profile("bench_lever")
    bodies = tuple(body for body in whole.bodies if body.name != "balance")
    contacts = tuple(c for c in whole.contacts if "balance" not in (side.body for side in c.sides))
    scene = Scene("locked", bodies, torques=whole.torques, contacts=contacts)
    done = simulate(scene, 60.0, record=((0.5, 0.6), (59.9, 60.0)))
    assert done.stop == Stop.DURATION
    assert np.ptp(done.q, axis=0).max() < 1e-12


def block_scene(slope: float, mu: float, speed: float) -> Scene:
    """A block on an incline that falls towards +x, thrown uphill (-x)."""
    body = Body("block", "free", (0.0, 0.5 * SIDE), velocity=(-speed, 0.0, 0.0), mass=2.0, inertia=2.0 * SIDE**2 / 6.0)
    body = Body(**{**body.__dict__, "loops": (box(2.0 * SIDE, SIDE),)})
    return Scene("block", (body, ground()), contacts=touching("block", "ground", friction=mu), gravity=on_slope(slope))


@pytest.mark.parametrize(("slope", "mu"), [(0.3, 0.4), (0.3, 0.2), (0.0, 0.3), (0.3, 0.0)])
def test_a_block_thrown_uphill(slope: float, mu: float) -> None:
    """It slides up, stops, and stays (friction angle above the slope) or comes back."""
    done = simulate(block_scene(slope, mu, 1.5), 1.2)
    assert done.stop == Stop.DURATION
    for t in (0.1, stops_at(1.5, mu, slope) if mu + slope else 0.5, 0.9, 1.2):
        way, speed = block(t, 1.5, mu, slope)
        q, u = done.at(t)
        assert (-q[0], -u[0]) == pytest.approx((way, speed), abs=1e-8)
        assert abs(q[1] - 0.5 * SIDE) + abs(q[2]) < 1e-12
    assert done.energy["residual_relative"] < 1e-9


@pytest.mark.parametrize(("share", "stays"), [(0.999, True), (1.001, False)])
def test_a_block_at_its_friction_angle(share: float, stays: bool) -> None:
    mu = 0.3
    slope = share * math.atan(mu)
    done = simulate(block_scene(slope, mu, 0.0), 10.0)
    a = 9.81 * (math.sin(slope) - mu * math.cos(slope))
    assert done.q[-1][0] == pytest.approx(0.0 if stays else 0.5 * a * 100.0, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(("v", "spin"), [(2.0, 0.0), (0.0, 60.0), (2.0, -60.0), (-1.0, 10.0)])
@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_a_disc_slides_until_it_rolls(v: float, spin: float, slope: float) -> None:
    """`rolling` counts the angle in the sense of rolling downhill, +x; ours is the opposite."""
    disc = Disc(0.05, 0.25, slope)
    body = Body("disc", "free", (0.0, 0.05), 0.0, (v, 0.0, -spin), mass=1.0, inertia=0.5 * 0.05**2, loops=(circle(0.05),))
    scene = Scene("disc", (body, ground()), contacts=touching("disc", "ground", friction=0.25), gravity=on_slope(slope))
    done = simulate(scene, 2.0)
    assert done.stop == Stop.DURATION
    for t in (0.05, 0.5, 2.0):
        truth = rolling.motion(disc, v, spin, t)
        q, u = done.at(t)
        assert (q[0], -q[2], u[0], -u[2]) == pytest.approx(tuple(truth), abs=2e-8)
    ends = rolling.slip_ends(disc, v, spin)
    sticks = of_kind(done, EventKind.STICK)
    assert [event["t"] for event in sticks] == pytest.approx([ends], abs=1e-8)


def test_a_sleeper_wakes_when_it_is_hit() -> None:
    """A rotor rests on a stop; two seconds later a ball falls on it."""
    bodies = (
        Body("rotor", "pivot", (0.0, 0.0), 0.0, (0.0,), inertia=1e-3, loops=(box(0.4, 0.02, (0.25, 0.0)),)),
        Body("stop", "fixed", (0.4, -0.02), loops=(circle(0.01),)),
        Body("ball", "slide", (0.2, 0.02 + 19.62), axis=(0.0, -1.0), velocity=(0.0,), mass=0.01, loops=(circle(0.01),)),
    )
    contacts = touching("rotor", "stop", restitution=0.5) + touching("rotor", "ball", restitution=0.5)
    scene = Scene("wake", bodies, torques=(Torque("rotor", -0.1),), contacts=contacts, gravity=(0.0, -9.81))
    done = simulate(scene, 2.5)
    assert np.all(done.q[done.t < 2.0, 0] == done.q[0, 0])
    impacts = [event["t"] for event in of_kind(done, EventKind.IMPACT)]
    assert impacts[0] == pytest.approx(2.0, rel=1e-9)
    assert done.u[-1][1] < 9.81 * 2.4


def test_a_sleeper_under_a_changing_torque_moves_when_that_turns() -> None:
    """Held on its stop by a torque that falls through zero at t = 1 s and pulls it away from then on."""
    bodies = (
        Body("rotor", "pivot", (0.0, 0.0), 0.0, (0.0,), inertia=1e-3, loops=(box(0.4, 0.02, (0.25, 0.0)),)),
        Body("stop", "fixed", (0.4, -0.02), loops=(circle(0.01),)),
    )
    torque = Torque("rotor", over="time", table=((0.0, -0.1), (2.0, 0.1)))
    done = simulate(Scene("pull", bodies, torques=(torque,), contacts=touching("rotor", "stop")), 1.5)
    opened = of_kind(done, EventKind.OPEN)
    assert [event["t"] for event in opened] == pytest.approx([1.0], abs=1e-6)
    # From then on angle'' = 100 (t - 1): angle = 100/6 (t - 1)³.
    assert done.q[-1][0] == pytest.approx(100.0 / 6.0 * 0.5**3, rel=1e-6)


def test_what_stands_still_is_woken_by_a_force_that_is_yet_to_change() -> None:
    """Pressed on a stop for five seconds, then drawn away on time."""
    bodies = (
        Body("rotor", "pivot", (0.0, 0.0), 0.0, inertia=4e-12, loops=(tip(2e-3),)),
        Body("stop", "fixed", (2e-3 * math.cos(0.1), 2e-3 * math.sin(0.1) + 0.3e-3), loops=(circle(0.2e-3),)),
    )
    table = ((0.0, 0.0), (0.2, 1e-6), (5.0, 1e-6), (5.001, -1e-6))
    torque = Torque("rotor", over="time", table=table)
    scene = Scene("pressed", bodies, torques=(torque,), damping=(Damping("rotor", 1e-9),), contacts=touching("rotor", "stop"))
    held = simulate(scene, 4.9)
    assert np.all(held.u[-1] == 0.0)
    assert simulate(scene, 5.01).end_q[0] < held.end_q[0] - 1e-4


def test_the_three_coordinates_of_a_free_body_share_their_rounding() -> None:
    """The largest of the three, each seen as a force: a torque counts by the radius of gyration. Others keep theirs."""
    bodies = (
        Body("wheel", "pivot", (0.0, 0.0), inertia=2.0),
        Body("one", "free", (1.0, 0.0), mass=2.0, inertia=8.0),
        Body("slide", "slide", (0.0, 3.0), mass=1.0),
        Body("other", "free", (5.0, 0.0), mass=1.0, inertia=0.25),
    )
    model = compile_scene(Scene("terms", bodies)).model
    terms = np.array([7.0, 1.0, 3.0, 10.0, 9.0, 1.0, 2.0, 2.0])
    callable_kernel(_share_terms)(model, terms)
    assert terms == pytest.approx([7.0, 5.0, 5.0, 10.0, 9.0, 4.0, 4.0, 2.0])
