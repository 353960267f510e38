"""Do rebounds end that are lower than what counts as closed, though they lose next to nothing?"""

from __future__ import annotations

import pytest
from moving_scenes import circle, ground

from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

RADIUS, ACCELERATION = 0.01, 10.0


def dropped(restitution, speed):
    """A disc that slides along y, pressed down, leaves the ground with that speed and would do so some 200 times."""
    disc = Body("disc", "slide", (0.0, RADIUS), axis=(0.0, 1.0), velocity=(speed,), mass=1.0, loops=(circle(RADIUS),))
    contacts = (Contact((Side("ground"), Side("disc")), 0.0, restitution),)
    duration = 400.0 * speed / ACCELERATION
    return Scene("hops", (ground(0.1), disc), torques=(Torque("disc", -ACCELERATION),), contacts=contacts, duration=duration)


@pytest.mark.parametrize("loss", [0.0, 1e-9, 1e-3, 0.5])
def test_a_hop_of_a_twentieth_of_a_picometre_ends(loss):
    run = simulate(dropped(1.0 - loss, 1e-6))
    assert len(run.events) < 40
    assert abs(run.u[-1]).max() == 0.0


def test_a_hop_of_a_micrometre_goes_on():
    run = simulate(dropped(1.0 - 1e-9, 5e-3))
    assert len(run.events) > 190
    assert abs(run.u[-1]).max() > 0.0
