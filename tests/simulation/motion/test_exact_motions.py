"""Do simple mechanisms move as their closed forms say?"""

from __future__ import annotations

import math

import pytest
from reference import block, oscillator, pendulum, rolling

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Damping, Side, Spring, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

SLOPE = math.radians(20.0)
GROUND = Body("ground", "fixed", loops=(Loop((Line(9.0, 0.0, -9.0, 0.0),), closed=False),))


def turned_gravity(slope: float, gravity: float = 9.81) -> tuple[float, float]:
    """The plane lies along x, downhill towards +x."""
    return gravity * math.sin(slope), -gravity * math.cos(slope)


def run(scene: Scene) -> Trajectory:
    done = simulate(scene)
    assert done.stop == Stop.DURATION
    assert done.worst_penetration < 1e-9
    assert abs(done.energy["residual_relative"]) < 1e-8
    return done


@pytest.mark.parametrize("viscous", [1.5, 20.0, 31.0], ids=["underdamped", "critical", "overdamped"])
@pytest.mark.parametrize("tolerance", [1e-8, 1e-11])
def test_damped_oscillator(viscous: float, tolerance: float) -> None:
    truth = oscillator.Oscillator(2.0, 50.0, viscous, 3.0, 0.2)
    scene = Scene(
        "oscillator",
        (Body("rotor", angle=0.7, velocity=(-1.1,), inertia=truth.inertia),),
        springs=(Spring("rotor", truth.stiffness, truth.rest),),
        torques=(Torque("rotor", truth.torque),),
        damping=(Damping("rotor", truth.viscous),),
        duration=1.7,
        tolerance=tolerance,
    )
    q, u = run(scene).at(1.7)
    assert (q[0], u[0]) == pytest.approx(oscillator.motion(truth, 0.7, -1.1, 1.7), abs=10.0 * tolerance)


@pytest.mark.parametrize("amplitude", [0.3, 2.5])
def test_pendulum(amplitude: float) -> None:
    length = 0.02
    bob = Body("bob", angle=amplitude, mass=1e-3, inertia=1e-3 * length**2, centre_of_mass=(0.0, -length))
    done = run(Scene("pendulum", (bob,), gravity=(0.0, -9.81), duration=1.3, tolerance=1e-11))
    q, u = done.at(1.3)
    angle, rate = pendulum.swing(1.3, amplitude, math.sqrt(9.81 / length))
    assert q[0] == pytest.approx(angle, abs=1e-8)
    assert u[0] == pytest.approx(rate, abs=1e-7)


def brick(mass: float = 0.3, half_width: float = 0.05, half_height: float = 0.02, speed: float = 2.0) -> Body:
    """A block on its flat side, pushed uphill."""
    w, h = half_width, half_height
    corners = [(w, h), (-w, h), (-w, -h), (w, -h)]
    sides = tuple(Line(*corners[i], *corners[(i + 1) % 4]) for i in range(4))
    inertia = mass * (4.0 * w * w + 4.0 * h * h) / 12.0
    return Body("brick", "free", (0.0, h), velocity=(-speed, 0.0, 0.0), mass=mass, inertia=inertia, loops=(Loop(sides),))


@pytest.mark.parametrize(("mu", "stays"), [(0.5, True), (0.3, False), (0.0, False)])
def test_block_pushed_uphill(mu: float, stays: bool) -> None:
    """Two corners on one line: the forces are not unique, the motion is."""
    scene = Scene(
        "block",
        (brick(), GROUND),
        contacts=(Contact((Side("brick"), Side("ground")), friction=mu),),
        gravity=turned_gravity(SLOPE),
        duration=1.5,
    )
    done = run(scene)
    for t in (0.1, block.stops_at(2.0, mu, SLOPE), 0.6, 1.5):
        way, rate = block.block(t, 2.0, mu, SLOPE)
        q, u = done.at(t)
        assert -q[0] == pytest.approx(way, rel=1e-9, abs=1e-10)
        assert -u[0] == pytest.approx(rate, rel=1e-9, abs=1e-9)
        assert q[1] == pytest.approx(0.02, abs=1e-12)
        assert q[2] == pytest.approx(0.0, abs=1e-10)
    sticks = done.events[done.events["kind"] == EventKind.STICK]["t"]
    assert bool(len(sticks)) is stays
    if stays:
        assert sticks[0] == pytest.approx(block.stops_at(2.0, mu, SLOPE), rel=1e-9)


@pytest.mark.parametrize(("v0", "spin0"), [(2.0, 0.0), (0.0, 60.0), (0.5, -60.0)], ids=["pushed", "spun", "backspin"])
@pytest.mark.parametrize("slope", [0.0, SLOPE], ids=["level", "incline"])
def test_disc_slides_until_it_rolls(v0: float, spin0: float, slope: float) -> None:
    truth = rolling.Disc(0.05, 0.3, slope)
    disc = Body(
        "disc",
        "free",
        (0.0, truth.radius),
        velocity=(v0, 0.0, -spin0),
        mass=1.0,
        inertia=truth.kappa * truth.radius**2,
        loops=(Loop((Arc(0.0, 0.0, truth.radius, 0.0, TURN),)),),
    )
    scene = Scene(
        "disc",
        (disc, GROUND),
        contacts=(Contact((Side("disc"), Side("ground")), friction=truth.mu),),
        gravity=turned_gravity(slope),
        duration=1.5,
    )
    done = run(scene)
    for t in (0.1, 0.5, 1.5):
        q, u = done.at(t)
        state = rolling.motion(truth, v0, spin0, t)
        assert (q[0], -q[2], u[0], -u[2]) == pytest.approx(state, rel=1e-9, abs=1e-8)
    end = rolling.slip_ends(truth, v0, spin0)
    sticks = done.events[done.events["kind"] == EventKind.STICK]["t"]
    assert len(sticks) == 1
    assert sticks[0] == pytest.approx(end, rel=1e-8)
