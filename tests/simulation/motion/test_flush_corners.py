"""Which of two gaps is closed where a body's one coordinate cannot close both?"""

from __future__ import annotations

import pytest
from moving_scenes import box, polygon, turned

from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

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
