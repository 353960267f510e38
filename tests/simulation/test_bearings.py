"""Does the friction of a bearing go with the weight that it carries, by position?"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import watchsim as ws
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Scene
from watchsim.simulation.state import EventKind

MASS, INERTIA, STIFFNESS, START, G = 50e-6, 1.2e-9, 7.58e-7, 4.0, 9.80665
FRICTION, RADIUS, FLAT = 0.12, 0.05e-3, 0.02e-3


def balance(folder: Path, scene: str = "", bearing: str = "") -> Scene:
    """A poised balance on its spring, with the bearing described, in a file."""
    described = bearing or f'body = "balance"\nradius = "{RADIUS * 1e3} mm"\nfriction = {FRICTION}\nflat = "{FLAT * 1e3} mm"'
    file = folder / "scene.toml"
    file.write_text(f"""{scene}
[bodies.balance]
mass = "{MASS} kg"
inertia = "{INERTIA} kg·m²"
angle = "{START} rad"

[bodies.post]
motion = "fixed"
[[springs]]
body = "balance"
stiffness = "{STIFFNESS} N·m/rad"
[[bearings]]
{described}
[run]
duration = "4 s"
tolerance = 1e-12
""")
    return ws.load(file)


@pytest.mark.parametrize(
    ("scene", "arm"),
    [
        ("", FLAT),  # without gravity in the plane the balance lies flat, on its cap stone
        ('[scene]\ngravity = ["0 m/s²", "-9.80665 m/s²"]', RADIUS),
        ('[scene]\ngravity = ["9.80665 m/s²", "0 m/s²"]', RADIUS),
        ('[watch]\nposition = "CH"', FLAT),
        ('[watch]\nposition = "3H"', RADIUS),
        ('[scene]\ngravity = ["0 m/s²", "-5 m/s²"]', (RADIUS * 5.0 + FLAT * math.sqrt(G * G - 25.0)) / G),
    ],
)
def test_each_half_swing_loses_twice_the_friction_over_the_stiffness(tmp_path: Path, scene: str, arm: float) -> None:
    """Coulomb's oscillator: turning points A₀ − 2 n T / k, with T = μ m g times the radius that carries the weight."""
    run = ws.simulate(balance(tmp_path, scene))
    turns = np.abs(run.events["value"][run.events["kind"] == EventKind.TURN])
    lost = 2.0 * FRICTION * MASS * G * arm / STIFFNESS
    assert len(turns) > 20
    assert turns == pytest.approx(START - lost * np.arange(1, len(turns) + 1), rel=1e-9)
    assert run.energy["residual_relative"] < 1e-9


def test_time_stepping_loses_as_much(tmp_path: Path) -> None:
    scene = balance(tmp_path, '[scene]\ngravity = ["0 m/s²", "-9.80665 m/s²"]')
    exact, errors = ws.simulate(scene).energy["dissipated"]["damping"], []
    for step in (4e-5, 2e-5):
        errors.append(abs(ws.simulate(scene, method="moreau", step=step).energy["dissipated"]["damping"] / exact - 1.0))
    assert errors[1] < 1e-4


@pytest.mark.parametrize(
    ("bearing", "said"),
    [
        ('radius = "0.05 mm"\nfriction = 0.1', "body"),
        ('body = "balance"\nfriction = 0.1', "missing: radius"),
        ('body = "balance"\nradius = "0.05 mm"', "missing: friction"),
        ('body = "balance"\nradius = "0 mm"\nfriction = 0.1', "above zero"),
        ('body = "balance"\nradius = "0.05 mm"\nfriction = -0.1', "negative friction"),
        ('body = "balance"\nradius = "0.05 mm"\nfriction = 0.1\nflat = "-1 mm"', "must not be negative"),
        ('body = "post"\nradius = "0.05 mm"\nfriction = 0.1', "post"),
        ('body = "balnce"\nradius = "0.05 mm"\nfriction = 0.1', 'Did you mean "balance"'),
    ],
)
def test_a_bearing_that_cannot_be_meant_is_refused_with_its_place(tmp_path: Path, bearing: str, said: str) -> None:
    with pytest.raises(SceneError, match=said) as caught:
        balance(tmp_path, bearing=bearing)
    assert "bearings.0" in str(caught.value)
