"""A mainspring runs down: at every torque, and at none, a lever runs or stands, and the solver finds its way."""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.mechanism.load import load
from watchsim.profiles_path import profiles_dir
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

TORQUES = [0.0, *np.geomspace(1e-3, 10.0, 20).tolist(), -0.5]


@pytest.mark.parametrize("name", ["bench_lever", "swiss_lever"])
def test_every_torque_runs_to_the_end(name: str) -> None:
    scene = load(profiles_dir() / name / "scene.toml")
    given_up = []
    for torque in TORQUES:
        run = simulate(scene.set("torques.0.value", f"{-torque:.6g} µN·m"), 2.0)
        if run.stop != Stop.DURATION:
            given_up.append((torque, run.stop))
    assert given_up == []
