"""Do a spring and a damper between two points push every coordinate as their length says?"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pair_scenes import body_pose
from plain_kernels import in_python

from watchsim.dynamics.applied_forces import forces
from watchsim.dynamics.line_springs import add_line_springs, line_spring_damping, line_spring_energies, line_spring_powers
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import LineSpring
from watchsim.scene.prescribed import swing
from watchsim.scene.scene import Scene

_forces = callable_kernel(forces)
BODIES = (
    Body("wheel", "pivot", (0.3, 0.1), inertia=1.0),
    Body("slide", "slide", (-1.0, 0.4), 0.6, axis=(0.6, 0.8), mass=1.0),
    Body("free", "free", (1.0, -1.0), mass=1.0, inertia=1.0),
)
ENDS = {"wheel": (0.7, 0.2), "slide": (-0.1, 0.3), "free": (0.2, 0.5), None: (2.0, 2.0)}
STIFFNESS, LENGTH, VISCOUS = 3.0, 0.8, 0.4
LINE = LineSpring(("wheel", "slide"), (ENDS["wheel"], ENDS["slide"]), STIFFNESS, LENGTH, VISCOUS)


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


@pytest.mark.parametrize("body", [0, 1])
@pytest.mark.parametrize("ratio", [1.0, -2.5, 0.4])
def test_a_geared_body_feels_the_spring_by_its_ratio(body: int, ratio: float) -> None:
    model = compile_scene(Scene("springs", BODIES, line_springs=(LINE,))).model
    bodies = model.bodies.copy()
    bodies["ratio"][body] = ratio
    model = model._replace(bodies=bodies)
    q, u, out, h = np.array([0.4, -0.3, 0.1, 0.2, 0.5]), np.zeros(5), np.zeros(5), 1e-5
    in_python(add_line_springs)(model, q, u, out)
    energies = np.zeros(10)
    in_python(line_spring_energies)(model, q + h * np.concatenate((np.eye(5), -np.eye(5))), energies)
    slope = (energies[:5] - energies[5:]) / (2.0 * h)
    assert out == pytest.approx(-slope, abs=1e-8) and np.all(np.abs(out[:2]) > 0.01)


def test_power_taken_held_and_given_to_bodies_is_what_the_energy_of_all_springs_loses() -> None:
    """dE/dt by quotients; the slide is driven, so what its spring does is held against, not felt."""
    driven = replace(BODIES[1], prescribed=swing(0.0, 1.0, 1.0, 0.0)[0])
    springs = tuple(
        LineSpring(pair, (ENDS[pair[0]], ENDS[pair[1]]), STIFFNESS * (1 + k), LENGTH, VISCOUS / (1 + k))
        for k, pair in enumerate([("wheel", "slide"), ("free", "wheel"), ("slide", None), ("free", "slide")])
    )
    scene = Scene("springs", (BODIES[0], driven, BODIES[2]), line_springs=springs)
    model, rng, h = compile_scene(scene).model, np.random.default_rng(7), 1e-6
    free = np.flatnonzero(model.coordinates.driven == 0)
    q, u = rng.uniform(-1.0, 1.0, (6, 5)), rng.uniform(-2.0, 2.0, (6, 5))
    energies = np.zeros((3, 6))
    for row, shift in enumerate((-h, 0.0, h)):
        in_python(line_spring_energies)(model, q + shift * u, energies[row])
    taken, held, felt = np.zeros((6, 4)), np.zeros(6), np.zeros((6, 5))
    in_python(line_spring_powers)(model, q, u, taken, held)
    for row in range(6):
        in_python(add_line_springs)(model, q[row], u[row], felt[row])
        rates = [
            (length(scene, one.between, q[row] + h * u[row]) - length(scene, one.between, q[row] - h * u[row])) / (2.0 * h)
            for one in springs
        ]
        assert taken[row] == pytest.approx([one.viscous * rate**2 for one, rate in zip(springs, rates, strict=True)], abs=1e-7)
        assert in_python(line_spring_damping)(model, q[row], u[row]) == pytest.approx(taken[row].sum())
        stretched = [0.5 * one.stiffness * (length(scene, one.between, q[row]) - one.length) ** 2 for one in springs]
        assert energies[1, row] == pytest.approx(sum(stretched))
    given = (felt[:, free] * u[:, free]).sum(axis=1)
    assert (energies[2] - energies[0]) / (2.0 * h) == pytest.approx(held - given - taken.sum(axis=1), abs=1e-6)
    assert np.abs(held).min() > 0.01 and len(free) == 4 and np.all(felt[:, np.setdiff1d(range(5), free)] == 0.0)
