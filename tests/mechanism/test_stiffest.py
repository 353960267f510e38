"""Is the fastest natural frequency of a scene that of its stiffest coordinate?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import LineSpring
from watchsim.scene.scene import Scene

STIFFNESS, MASS, INERTIA = 30.0, 0.2, 5e-6


@pytest.mark.parametrize("arm", [(0.0, 0.0), (3e-3, -4e-3), (0.3, 0.4)])
@pytest.mark.parametrize("motion", ["free", "pivot", "slide"])
def test_of_a_spring_between_points(motion: str, arm: tuple[float, float]) -> None:
    """It resists a shift by its stiffness and a turn by that times the square of its arm, at most."""
    body = Body("body", motion, mass=MASS, inertia=INERTIA)
    spring = LineSpring(("body", None), (arm, (0.7, 0.1)), STIFFNESS, 0.2)
    compiled = compile_scene(Scene("", (body,), line_springs=(spring,)))
    shift, turn = STIFFNESS / MASS, STIFFNESS * math.hypot(*arm) ** 2 / INERTIA
    largest = {"free": max(shift, turn), "pivot": turn, "slide": shift}[motion]
    assert np.asarray(compiled.model.coordinates.rate) == pytest.approx(math.sqrt(largest) or 1.0, rel=1e-12)
