"""Is the share of the drive's work that reaches the oscillator what the account says, and when is there none?"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import Events, balance_only, lever_scene

from watchsim.analysis.efficiency import efficiency
from watchsim.scene.force import Damping, Torque
from watchsim.scene.scene import Scene

ENERGY: dict[str, Any] = {"in_J": 8e-6, "stored_J": 1e-6, "dissipated": {"damping": 2e-6, "friction": 5e-6}}


def share(scene: Scene, energy: dict[str, Any] = ENERGY, **changes: Any) -> float | None:
    return efficiency(replace(balance_only(Events(), 1.0, scene), energy=energy, **changes))


def damped(*names: str) -> Scene:
    return replace(lever_scene(), damping=tuple(Damping(name, 1e-9) for name in names))


def test_what_damping_takes_and_what_is_gained_over_the_work() -> None:
    assert share(damped("balance")) == pytest.approx(3.0 / 8.0, rel=1e-15)
    assert share(damped("balance"), ENERGY | {"stored_J": -1e-6}) == pytest.approx(1.0 / 8.0, rel=1e-15)
    assert share(lever_scene(), {"in_J": 8e-6}) == 0.0


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param(damped("balance", "lever"), id="damping of another body is in the same sum"),
        pytest.param(
            replace(damped("balance"), torques=(*lever_scene().torques, Torque("balance", 1e-9))), id="drives the balance, too"
        ),
        pytest.param(replace(damped("balance"), torques=()), id="no drive"),
        pytest.param(replace(damped("balance"), springs=()), id="no oscillator"),
        pytest.param(replace(damped("balance"), contacts=(), lift_angle=None), id="no lever"),
    ],
)
def test_where_it_cannot_be_told(scene: Scene) -> None:
    assert share(scene) is None


@pytest.mark.parametrize("work", [0.0, -1e-9])
def test_without_work_there_is_no_share(work: float) -> None:
    assert share(damped("balance"), ENERGY | {"in_J": work}) is None
    assert share(damped("balance"), {"stored_J": 1e-6, "dissipated": {"damping": 2e-6}}) is None


def test_what_weights_have_fallen_is_only_lent() -> None:
    """A lever off its balance falls by 4 µm: that work is taken from both sides."""
    scene = damped("balance")
    lever = replace(scene.body("lever"), mass=0.01, centre_of_mass=(4e-6, 0.0))
    scene = replace(scene, gravity=(0.0, -10.0), bodies=tuple(lever if b.name == "lever" else b for b in scene.bodies))
    end = np.array([0.0, -0.5 * np.pi, 0.0])
    fallen = 0.01 * 10.0 * 4e-6
    found = share(scene, end_q=end, end_u=np.zeros(3))
    assert found == pytest.approx((3e-6 - fallen) / (8e-6 - fallen), rel=1e-12)
    # Of a window the rows begin elsewhere.
    assert share(scene, end_q=end, end_u=np.zeros(3), t=np.ones(1), q=np.ones((1, 3))) == found


def test_where_no_motion_is_known_nothing_has_fallen() -> None:
    """Without rows, or without an end."""
    scene = replace(damped("balance"), gravity=(0.0, -10.0))
    run = balance_only(Events(), 1.0, scene)
    nothing = {name: getattr(run, name)[:0] for name in ("t", "q", "u", "a")}
    assert share(scene, **nothing) == pytest.approx(3.0 / 8.0, rel=1e-15)
    assert share(scene, **nothing, end_q=np.ones(3), end_u=np.ones(3)) == pytest.approx(3.0 / 8.0, rel=1e-15)
