"""Does Moreau's time stepping know every law of a scene: dry bearings, tangential restitution, no gain of energy?"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import short_runs
from every_time import few
from moving_scenes import box, circle, ground, profile, touching
from test_dry_bearings import driven, rotor

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Damping, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop


def stepped(scene: Scene, duration: float, step: float) -> Trajectory:
    run = simulate(scene, duration, method="moreau", step=step)
    assert run.stop == Stop.DURATION
    assert run.counts["lcp_failures"] == 0
    return run


@pytest.mark.parametrize(
    "scene, duration, worst",
    [
        pytest.param(rotor(angle=2.0, viscous=1.5), 2.0, 0.4, id="sprung rotor"),
        pytest.param(rotor(stiffness=0.0, rate=4.0), 4.0, 0.1, id="running out"),
        pytest.param(driven(0.05), 1.0, 0.05, id="arm that holds"),
        pytest.param(driven(5.0), 0.3, 0.05, id="arm that yields"),
    ],
)
def test_dry_bearings_at_first_order(scene: Scene, duration: float, worst: float) -> None:
    """As by events, which is checked against closed forms, to a share of the step; what holds stands still."""
    exact = simulate(scene, duration)
    for step in (1e-3, 1e-4):
        run = stepped(scene, duration, step)
        assert np.abs(run.q[-1] - exact.q[-1]).max() < worst * step
        assert run.energy["dissipated"]["damping"] == pytest.approx(exact.energy["dissipated"]["damping"], rel=20.0 * step)
        assert run.energy["residual_relative"] < 1e-10
    still = exact.u[-1] == 0.0
    assert np.all(np.abs(run.u[-1][still]) < 1e-14)


def test_a_held_rotor_does_not_creep() -> None:
    """Inside its dead zone: not a bit in 10^5 steps, in the event-driven run neither."""
    scene = rotor(angle=0.05)
    for run in (stepped(scene, 10.0, 1e-4), simulate(scene, 10.0)):
        assert np.all(run.q == 0.05)


def test_a_watch_with_dry_bearings() -> None:
    scene = profile("bench_lever")
    dry = tuple(Damping(body.name, coulomb=2e-9) for body in scene.bodies if body.motion == "pivot")
    scene = dataclasses.replace(scene, damping=(*scene.damping, *dry))
    exact = simulate(scene, 0.3)
    errors = [np.abs(stepped(scene, 0.3, step).q[-1] - exact.q[-1]).max() for step in (4e-5, 1e-5)]
    assert errors[1] < 5e-4
    assert errors[1] < 0.6 * errors[0]


LAWS = [("coulomb", 0.0, 0.0), ("shifted", 0.4, 0.0), ("pg1996", 0.7, 0.0), ("pg1996", 1.0, 0.5)]


def thrown(rng: np.random.Generator, law: str, tangential: float, nu: float) -> Scene:
    """A block that lands flat: its corners meet two planes with friction of their own. No gravity, so nothing follows.

    One plane gives way along itself: else both would hold the block in one line, and how they share that would be open.
    """
    width, height, friction = rng.uniform(0.02, 0.1), rng.uniform(0.02, 0.1), rng.uniform(0.0, 1.0, 2)
    block = Body(
        "block",
        "free",
        position=(0.0, 0.5 * height),
        velocity=(float(rng.normal()), -1.0, 0.0),
        mass=1.0,
        inertia=float(10.0 ** rng.uniform(-4.5, -2.5)),
        loops=(box(width, height),),
    )
    left = Body("left", "fixed", loops=(Loop((Line(0.0, 0.0, -1.0, 0.0),), closed=False),))
    mass = float(rng.uniform(0.1, 3.0))
    right = Body("right", "slide", (0.0, 0.0), mass=mass, loops=(Loop((Line(1.0, 0.0, 0.0, 0.0),), closed=False),))
    back = rng.uniform(tangential if law == "shifted" else 0.0, 1.0, 2)
    contacts = tuple(
        Contact((Side("block"), Side(name)), float(mu), float(share), tangential)
        for name, mu, share in zip(("left", "right"), friction, back, strict=True)
    )
    return Scene("thrown", (block, left, right), contacts=contacts, tangential_law=law, nu=nu)


@pytest.mark.parametrize("law, tangential, nu", few(LAWS, 1, several=True))
def test_impacts_with_two_contacts_are_those_of_the_complementarity_problems(law: str, tangential: float, nu: float) -> None:
    """Two algorithms without a common line: relaxation and pivoting give the same velocities."""
    rng = np.random.default_rng(11)
    for _ in range(40):
        scene = thrown(rng, law, tangential, nu)
        exact, run = simulate(scene, 1e-4), stepped(scene, 1e-4, 1e-5)
        scale = np.abs(exact.u).max()
        assert np.abs(run.u[-1] - exact.u[-1]).max() < 1e-8 * scale
        assert run.counts["energy_rescues"] == exact.counts["energy_rescues"]


@pytest.mark.parametrize("law", ["pg1996", "shifted"])
def test_a_superball_reverses_slip_and_spin(law: str) -> None:
    ball = Body("ball", "free", (0.0, 0.0101), velocity=(0.3, -1.0, 5.0), mass=1.0, inertia=4e-5, loops=(circle(0.01),))
    contacts = tuple(
        dataclasses.replace(one, tangential_restitution=1.0)
        for one in touching("ball", "ground", friction=1.0, restitution=1.0)
    )
    run = stepped(Scene("superball", (ball, ground()), contacts=contacts, tangential_law=law), 1e-3, 1e-5)
    u = run.u[-1]
    assert u[1] == pytest.approx(1.0, rel=1e-12)
    assert u[0] + 0.01 * u[2] == pytest.approx(-(0.3 + 0.01 * 5.0), rel=1e-9)
    assert run.energy["dissipated"]["impacts"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    "friction, size, inertia, mass, speeds",
    [
        pytest.param((0.4236, 2.6724), (0.042427, 0.140554), 1.0421e-5, 0.10798, (0.37467, -0.38049), id="once"),
        pytest.param((2.6338, 1.9834), (0.052707, 0.190510), 3.2068e-4, 0.012141, (0.52649, 2.72817), id="strong friction"),
    ],
)
def test_what_would_gain_energy_is_thrown_back_less(
    friction: tuple[float, float], size: tuple[float, float], inertia: float, mass: float, speeds: tuple[float, float]
) -> None:
    """Poisson's law with unequal restitution at two contacts with friction: the gain is noticed and counted, as by events."""
    plain = thrown(np.random.default_rng(0), "coulomb", 0.0, 0.0)
    block, left, right = plain.bodies
    position, velocity = (0.0, 0.5 * size[1]), (speeds[0], -1.0, 0.0)
    block = dataclasses.replace(block, position=position, velocity=velocity, inertia=inertia, loops=(box(*size),))
    right = dataclasses.replace(right, mass=mass, velocity=(speeds[1],))
    pairs = zip(plain.contacts, friction, (0.0, 1.0), strict=True)
    contacts = tuple(dataclasses.replace(one, friction=mu, restitution=back) for one, mu, back in pairs)
    scene = dataclasses.replace(plain, bodies=(block, left, right), contacts=contacts)
    exact, run = simulate(scene, 1e-5), stepped(scene, 1e-5, 1e-6)
    assert run.counts["energy_rescues"] == exact.counts["energy_rescues"] == 1
    assert run.energy["dissipated"]["impacts"] > 0.0
    assert run.u[-1] == pytest.approx(exact.u[-1], rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("name", ["superball", "Painlevé 1", "Painlevé 2", "pin on roller 1", "wedge 1", "cradle", "groove"])
def test_hard_cases_at_first_order(name: str) -> None:
    """Impacts of several contacts, accumulating ones, jams: the mean difference is below five steps' share of the way."""
    scene, duration, _ = short_runs.short_runs()[name]
    times = np.linspace(0.0, duration, 1001)
    exact = simulate(scene, duration).sample(times)[0]
    way = np.abs(exact - exact[0]).max()
    for count in (500, 5000):
        run = simulate(scene, duration, method="moreau", step=duration / count)
        assert run.counts["lcp_failures"] == 0
        assert np.abs(run.sample(times)[0] - exact).mean() < 5.0 * way / count
