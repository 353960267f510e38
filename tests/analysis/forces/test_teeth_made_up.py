"""Do the forces of teeth have the moments that they must have, wherever a planet is, and are the right racks asked?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.mesh_forces import Loads, _of_racks, _on_the_planet
from watchsim.mechanism.backlash import rack_ways
from watchsim.scene.body import Body
from watchsim.scene.carriers import Ride, rides
from watchsim.scene.force import Contact, Side, Spring
from watchsim.scene.gearing import Gear
from watchsim.scene.scene import Scene

TORQUES = np.array([2e-3, -2e-3, 5e-4])
TURNED = np.array([0.0, 0.7, -2.5])


def on_the_planet(ratio: float, place: tuple[float, float], angle: float = 0.35) -> list[Any]:
    hung = (Ride(0), Ride(1, 0, place, 0))
    compiled: Any = SimpleNamespace(own=lambda body, q: {0: q[:, 0], 1: q[:, 1]}[body])
    motion: Any = SimpleNamespace(q=np.column_stack((TURNED, 9.0 + TURNED)))
    gear: Any = SimpleNamespace(pressure_angle=angle)
    scene: Any = None
    return list(_on_the_planet(scene, compiled, motion, gear, (0, 1), TORQUES, ratio, hung))


@pytest.mark.parametrize("place", [(1e-3, 0.0), (0.0, 4e-3), (-3e-3, -4e-3)])
@pytest.mark.parametrize("ratio", [2.0, 1.0, 0.25, -3.0, -1.5, 0.001 - 1.0])
def test_teeth_of_a_fixed_wheel_turn_a_planet_and_press_it_away(ratio: float, place: tuple[float, float]) -> None:
    """At the pitch point, which divides the arm as the numbers of teeth do: within a ring it lies beyond the planet."""
    (found,) = on_the_planet(ratio, place)
    assert found.body == 1
    for turned, torque, force in zip(TURNED, TORQUES, found.force, strict=True):
        arm = complex(*place) * np.exp(1j * turned)
        away, pushed = arm / abs(arm), complex(*force)
        lever = -away * abs(arm) / (1.0 + ratio)  # from the planet's centre to the pitch point
        assert (lever.conjugate() * pushed).imag == pytest.approx(torque, rel=1e-9, abs=0.0)
        radial, across = (away.conjugate() * pushed).real, (away.conjugate() * pushed).imag
        outside = math.copysign(1.0, 1.0 + ratio)
        assert radial == pytest.approx(outside * math.tan(0.35) * abs(across), rel=1e-9, abs=0.0)


def test_where_teeth_have_no_pitch_point_no_force_is_told() -> None:
    """On one axis, or where the planet keeps its direction in the movement."""
    assert on_the_planet(2.0, (0.0, 0.0)) == [] and on_the_planet(-1.0, (1e-3, 0.0)) == []


@pytest.mark.parametrize("efficiency", [1.0, 0.9])
@pytest.mark.parametrize("k", [0, 1])
def test_racks_are_told_from_other_contacts(k: int, efficiency: float) -> None:
    """They come after declared contacts and stops of springs, two bodies for each pair of gears with play."""
    bodies = (Body("a"), Body("b", position=(10e-3, 0.0)), Body("c", position=(0.0, 6e-3)), Body("arm"))
    gears = (Gear(("a", "b"), -1.5, 3e-3, efficiency=efficiency), Gear(("a", "c"), -2.0, 3e-3, efficiency=efficiency))
    contacts = (Contact((Side("a"), Side("arm"))), Contact((Side("b"), Side("arm"))))
    springs = (Spring("arm", 1.0), Spring("arm", 1.0, stop=0.5), Spring("arm", 1.0))
    scene = Scene("gears", bodies, springs, contacts=contacts, gears=gears)
    # Contacts by their groups: two declared, a stop, the first pair of racks, the second twice, on either rack.
    group, first = np.array([0, 1, 2, 3, 4, 4]), np.array([0, 1, 2, 3, 4, 5])
    racks = 4 + 2  # four bodies, and two for the stop, come before the racks
    owner = np.array([0, 1, 4, racks, racks + 2, racks + 3])
    model = SimpleNamespace(
        contacts=SimpleNamespace(group=group, a=first), primitives=SimpleNamespace(body=owner), bodies=[None] * (racks + 4)
    )
    pressed = np.random.default_rng(6).normal(size=(3, 6, 2))
    compiled: Any = SimpleNamespace(model=model, size=1.0)
    found = _of_racks(scene, compiled, k, Loads(np.arange(6), np.zeros((3, 6, 2)), pressed))
    force = pressed[:, 3] if k == 0 else pressed[:, 4] - pressed[:, 5]
    ways = rack_ways(scene, rides(bodies), gears[k], 1.0)
    for torque, sign, way, askew in zip(found, (1.0, -1.0), ways.far, (1.0, -1.0), strict=True):
        slope = askew if efficiency < 1.0 else 0.0
        assert torque == pytest.approx(sign * way * ways.reach * (force @ np.array([1.0, slope])), rel=1e-12)
