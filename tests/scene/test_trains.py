"""What comes of a mainspring's torque, and of its train's inertia, at the body that they drive?"""

from __future__ import annotations

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim.mechanism.words import force_lines
from watchsim.scene.errors import SceneError
from watchsim.studies.steady import steady

WHEEL = """
[scene]
schema = 1

[bodies.wheel]
circle   = "2 mm"
angle    = "30°"
inertia  = "0.05 mg·cm²"

[[torques]]
body       = "wheel"
over       = "barrel"
table      = [["0 rev", "10 mN·m"], ["2 rev", "8 mN·m"], ["6 rev", "2 mN·m"]]
ratio      = {ratio}
efficiency = 0.8
run_down   = "{turned} rev"
train      = [{{ ratio = 10, inertia = "2 mg·cm²" }}, {{ ratio = -50, inertia = "30 mg·cm²" }}]

[run]
duration  = "{seconds} s"
tolerance = 1e-11
"""


def wheel(tmp_path, ratio=-100.0, turned=0.0, seconds=0.01):
    (tmp_path / "scene.toml").write_text(WHEEL.format(ratio=ratio, turned=turned, seconds=seconds), encoding="utf-8")
    return ws.load(tmp_path)


@pytest.mark.parametrize(
    "turned, at_barrel", [(0.0, 10e-3), (1.0, 9e-3), (2.0, 8e-3), (5.0, 3.5e-3), (9.0, 2e-3), (-1.0, 10e-3)]
)
@pytest.mark.parametrize("ratio", [-100.0, 250.0])
def test_torque_and_inertia_at_the_wheel(tmp_path, ratio, turned, at_barrel):
    """T = η T_barrel / i; I = I_wheel + Σ I_k / i_k²."""
    scene = wheel(tmp_path, ratio, turned)
    torque = scene.torques[0]
    assert torque.value == pytest.approx(0.8 * at_barrel / ratio, rel=1e-12, abs=0.0)
    angle = scene.body("wheel").angle
    assert np.interp(angle, *np.transpose(torque.table)) == pytest.approx(torque.value, rel=1e-9, abs=0.0)
    assert torque.mainspring.inertia == pytest.approx(2e-10 / 100.0 + 30e-10 / 2500.0, rel=1e-12)
    assert scene.body("wheel").inertia == pytest.approx(0.05e-10 + torque.mainspring.inertia, rel=1e-12)


def test_a_wheel_that_runs_down_swings_up_by_the_work_of_the_spring(tmp_path):
    """½ I ω² = η ∫ T dφ over two turns of the barrel, past a corner of its curve."""
    scene = wheel(tmp_path, -100.0, 1.0, 0.5)
    run = ws.simulate(scene)
    turns = (scene.body("wheel").angle - run.q[:, 0]) / 100.0
    at = int(np.searchsorted(turns, 2.0 * math.tau))
    assert 0 < at < len(turns)
    barrel = np.linspace(math.tau, math.tau + turns[at], 200001)
    spring = np.interp(barrel / math.tau, [0.0, 2.0, 6.0], [10e-3, 8e-3, 2e-3])
    work = 0.8 * float(np.trapezoid(spring, barrel))
    assert 0.5 * scene.body("wheel").inertia * run.u[at, 0] ** 2 == pytest.approx(work, rel=1e-7)


def test_a_limit_cycle_is_that_of_the_torque_at_that_hour(tmp_path):
    text = """
[design]
of = "swiss_lever"

[[torques]]
body       = "wheel"
over       = "barrel"
table      = [["0 rev", "10 mN·m"], ["7 rev", "5 mN·m"]]
ratio      = -6400
efficiency = 0.8
run_down   = "2.8 rev"
"""
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    scene = ws.load(tmp_path)
    wound, plain = steady(scene), steady(ws.designs.swiss_lever(torque="1 µN·m").scene())
    assert wound.amplitude_deg == pytest.approx(plain.amplitude_deg, abs=1e-7)
    assert wound.rate_s_per_d == pytest.approx(plain.rate_s_per_d, abs=1e-7)
    table = ws.sweep(scene, {"torques.0.run_down": [0.0, 5.6 * math.tau]})
    assert np.square(table.column("amplitude")) == pytest.approx(
        np.square(plain.amplitude_deg) * np.array([1.25, 0.75]), rel=2e-3
    )


@pytest.mark.parametrize(
    "key, value, why",
    [
        ("torques.0.ratio", 0.0, "must not be 0"),
        ("torques.0.efficiency", 1.2, "share of the work"),
        ("torques.0.efficiency", 0.0, "share of the work"),
        ("torques.0.over", "angle", 'belongs to a table with over = "barrel"'),
        ("torques.0.train.0.ratio", 0.0, "must not be 0"),
        ("torques.0.train.1.inertia", "-1 mg·cm²", "above zero"),
        ("torques.0.run_down", "3 s", "time"),
        ("torques.0.train.2.ratio", 3, "no wheel 2"),
    ],
)
def test_what_makes_no_train_is_refused(tmp_path, key, value, why):
    with pytest.raises(SceneError, match=why):
        wheel(tmp_path).set(key, value)


@pytest.mark.parametrize(
    "old, new, why",
    [
        ("ratio      = -100.0\n", "", "missing: ratio"),
        ("{ ratio = 10, inertia", "{ ratoi = 10, inertia", "ratio"),
        ('train      = [{ ratio = 10, inertia = "2 mg·cm²" }, { ratio = -50, inertia = "30 mg·cm²" }]', "train = 3", "a list"),
        ('{ ratio = -50, inertia = "30 mg·cm²" }', "-50", "an entry for each wheel"),
    ],
)
def test_a_slip_in_a_train_is_reported(tmp_path, old, new, why):
    text = WHEEL.format(ratio=-100.0, turned=0.0, seconds=1)
    assert old in text
    (tmp_path / "scene.toml").write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(SceneError, match=why):
        ws.load(tmp_path)


def test_check_says_where_the_torque_comes_from(tmp_path):
    shown = "\n".join(force_lines(wheel(tmp_path, turned=1.0)))
    assert "from 9 mN·m at the barrel 1 turns from full wind" in shown
    assert "0.032 mg·cm²" in shown


def test_a_plain_value_takes_its_place(tmp_path):
    scene = wheel(tmp_path).set("torques.0.value", "-1 µN·m")
    assert scene.torques[0].mainspring is None
    assert scene.torques[0].value == pytest.approx(-1e-6)
    assert scene.body("wheel").inertia == pytest.approx(0.05e-10)
