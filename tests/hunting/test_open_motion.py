"""Does the judge know how far Coulomb's law leaves a motion open?

Two blocks slide side by side down a slope, only the lower one rubs on it, and they rub on each other. What the upper one lays
on the lower one is open between ± μ of what presses them together; the friction of the slope goes with it. Closed form: with
the share s = μ μ' m' / (m + m') an acceleration lies between (a₀ ∓ s g sin θ) / (1 ∓ s), a₀ being that without any friction
between the two.
"""

from __future__ import annotations

import math

import hunt_path  # noqa: F401
import numpy as np
import pytest
from hunt.energies import masses
from hunt.generator.parts import fixed, free
from hunt.generator.shapes import box
from hunt.impulses import Touches
from hunt.open_motion import open_accelerations, open_motion

from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

SLOPE, BELOW, BETWEEN, LOWER, UPPER, G = 0.33, 0.3, 0.55, 0.05, 0.024, 9.81


def blocks(between: float) -> Scene:
    """Gravity leans, so that the slope is level."""
    bodies = (
        fixed("floor", box(0.2, 0.02, (0.0, -0.01))),
        free("lower", box(0.015, 0.009), (0.0, 0.0045), LOWER),
        free("upper", box(0.015, 0.009), (0.015, 0.0045), UPPER),
    )
    contacts = (
        Contact((Side("floor"), Side("lower")), BELOW, 0.0),
        Contact((Side("floor"), Side("upper")), 0.0, 0.0),
        Contact((Side("lower"), Side("upper")), between, 0.0),
    )
    gravity = (-G * math.sin(SLOPE), -G * math.cos(SLOPE))
    return Scene("blocks", bodies, contacts=contacts, gravity=gravity, duration=0.05)


@pytest.mark.parametrize("between", [BETWEEN, 0.0])
def test_blocks_side_by_side(between):
    scene = blocks(between)
    run = simulate(scene)
    row = len(run.t) // 2
    found = open_accelerations(run, row, Touches(scene, run.slices, masses(scene), 1e-6))
    alone = G * math.sin(SLOPE) - BELOW * LOWER * G * math.cos(SLOPE) / (LOWER + UPPER)
    share = BELOW * between * UPPER / (LOWER + UPPER)
    least, most = ((alone - way * share * G * math.sin(SLOPE)) / (1.0 - way * share) for way in (1.0, -1.0))
    assert least - 1e-6 <= -run.a[row, 0] <= most + 1e-6
    assert found[[0, 3]] == pytest.approx([most - least] * 2, abs=1e-6)
    assert np.abs(found[[1, 2, 4, 5]]).max() < 1e-4
    far = 0.5 * (most - least) * 0.05**2
    assert open_motion(run, 0.05, np.array([1.0, 1.0, 0.01] * 2)) == pytest.approx(far, abs=1e-8)
