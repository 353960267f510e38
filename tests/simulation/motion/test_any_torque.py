"""A mainspring runs down: at every torque, and at none, a lever runs or stands, and the solver finds its way."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from every_time import few

from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.scene.force import Damping
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

TORQUES = [0.0, *np.geomspace(1e-3, 10.0, 20).tolist(), -0.5]


@pytest.mark.parametrize("name", few(["bench_lever", "swiss_lever"], 1))
def test_every_torque_runs_to_the_end(name: str) -> None:
    scene = load(profiles_dir() / name / "scene.toml")
    given_up = []
    for torque in TORQUES:
        run = simulate(scene.set("torques.0.value", f"{-torque:.6g} µN·m"), 2.0)
        if run.stop != Stop.DURATION:
            given_up.append((torque, run.stop))
    assert given_up == []


@pytest.mark.parametrize(
    "dry, torque, tolerance",
    [
        pytest.param(0.0, 1.65848e-4, 1e-9, id="two slips turn back at once"),
        pytest.param(0.0, 1.97815e-4, 1e-9, id="two slips turn back at once, again"),
        pytest.param(2e-9, 1.59062e-2, 1e-6, id="a slip too slow to count, against the mode"),
        pytest.param(2e-9, 1.33655e-4, 1e-6, id="a jam whose gaps open slowly"),
        pytest.param(2e-9, 1.41825e-4, 1e-6, id="a jam whose gaps open slowly, again"),
    ],
)
def test_a_lever_without_torque_comes_to_stand(dry: float, torque: float, tolerance: float) -> None:
    """The last moments of a watch run down: everything slides, sticks and jams at once, at speeds next to none."""
    scene = load(profiles_dir() / "bench_lever" / "scene.toml").set("torques.0.value", f"{-torque:.6g} µN·m")
    if dry:
        bearings = tuple(Damping(body.name, coulomb=dry) for body in scene.bodies if body.motion == "pivot")
        scene = dataclasses.replace(scene, damping=(*scene.damping, *bearings))
    run = simulate(scene, 5.0, tolerance=tolerance)
    assert run.stop == Stop.DURATION
    assert run.energy["residual_relative"] < 1e3 * tolerance
