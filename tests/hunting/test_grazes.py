"""Does the judge tell a graze, which a run may make or miss, from a slow impact, which it must make?"""

from __future__ import annotations

import hunt_path  # noqa: F401
import numpy as np
import pytest
from hunt.generator.parts import sliding
from hunt.generator.shapes import box
from hunt.grazes import grazed

from watchsim.scene.force import Contact, Side, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

SPEED, PULL, MASS = 3e-4, 1.0, 0.02
DEPTH = 0.5 * SPEED**2 * MASS / PULL  # how far the block would come beyond the other's face: 0.9 nm
TIMES = np.linspace(0.0, 0.02, 11)


def approach(pull: float):
    """A block reaches another one after 10 ms slowly, pulled back (or pushed on) by a force."""
    ahead = SPEED * 0.01 + 0.5 * pull / MASS * 0.01**2  # with the speed at the start, backwards in time
    bodies = (
        sliding("a", box(0.01, 0.01), (-0.01 - ahead, 0.0), 0.0, SPEED + pull / MASS * 0.01, MASS),
        sliding("b", box(0.01, 0.01), (0.0, 0.0), 0.0, 0.0, MASS),
    )
    scene = Scene(
        "blocks", bodies, torques=(Torque("a", -pull),), contacts=(Contact((Side("a"), Side("b")), 0.0, 0.0),), duration=0.02
    )
    run = simulate(scene)
    assert run.events["value"][0] == pytest.approx(-SPEED, rel=1e-3)
    return run


def test_a_gap_that_opens_again():
    run = approach(PULL)
    moved = grazed(run, 1.1 * DEPTH, np.ones(2), TIMES)
    # The plastic impact gives each block half of the speed.
    assert moved == pytest.approx(0.5 * SPEED * np.maximum(TIMES - 0.01, 0.0), rel=1e-3, abs=1e-9)
    assert not grazed(run, 0.2 * DEPTH, np.ones(2), TIMES).any()


def test_a_gap_that_does_not():
    assert not grazed(approach(-3e-4), 3.0 * DEPTH, np.ones(2), TIMES).any()
