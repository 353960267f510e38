"""Does what stands beside an unstable rest leave it when it must, and does what stands exactly at it stay?

The times are those of the equation of motion, solved by scipy to 1e-12.
"""

import math

import pytest
from moving_scenes import circle, ground, of_kind, polygon, touching
from scipy.integrate import solve_ivp

from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind

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
