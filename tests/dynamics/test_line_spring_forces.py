"""Do a spring and a damper between two points push every coordinate as their length says?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from pair_scenes import body_pose

from watchsim.dynamics.applied_forces import forces
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import LineSpring
from watchsim.scene.scene import Scene

_forces = callable_kernel(forces)
BODIES = (
    Body("wheel", "pivot", (0.3, 0.1), inertia=1.0),
    Body("slide", "slide", (-1.0, 0.4), 0.6, axis=(0.6, 0.8), mass=1.0),
    Body("free", "free", (1.0, -1.0), mass=1.0, inertia=1.0),
)
ENDS = {"wheel": (0.7, 0.2), "slide": (-0.1, 0.3), "free": (0.2, 0.5), None: (2.0, 2.0)}
STIFFNESS, LENGTH, VISCOUS = 3.0, 0.8, 0.4


def length(scene: Scene, pair: tuple[str, str | None], q: np.ndarray) -> float:
    """Between the two points at q, by plane geometry."""
    places = []
    for name in pair:
        (px, py), (x, y, turn) = ENDS[name], (0.0, 0.0, 0.0) if name is None else body_pose(scene, name, q)
        places.append((x + math.cos(turn) * px - math.sin(turn) * py, y + math.sin(turn) * px + math.cos(turn) * py))
    return math.dist(*places)


@pytest.mark.parametrize("pair", [("wheel", "slide"), ("free", "wheel"), ("slide", "free"), ("free", None)])
def test_the_force_is_the_slope_of_the_length_times_pull_and_drag(pair: tuple[str, str | None]) -> None:
    """-(k (L - L0) + c L') dL/dq, with quotients of the length."""
    spring = LineSpring(pair, (ENDS[pair[0]], ENDS[pair[1]]), STIFFNESS, LENGTH, VISCOUS)
    scene = Scene("springs", BODIES, line_springs=(spring,))
    model, rng, h = compile_scene(scene).model, np.random.default_rng(6), 1e-5
    for _ in range(5):
        q, u, out = rng.uniform(-1.0, 1.0, 5), rng.uniform(-2.0, 2.0, 5), np.zeros(5)
        steps = h * np.eye(5)
        slope = np.array([length(scene, pair, q + step) - length(scene, pair, q - step) for step in steps]) / (2.0 * h)
        _forces(model, 0.0, q, u, out)
        pull = STIFFNESS * (length(scene, pair, q) - LENGTH) + VISCOUS * float(slope @ u)
        assert out == pytest.approx(-pull * slope, abs=1e-8)
