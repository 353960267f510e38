"""Do the books of springs between points close at any instant, with driven bodies at either end?"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import watchsim as ws
from watchsim.analysis.timeline.line_spring_rows import held_by_lines, line_spring_energies, line_spring_power
from watchsim.mechanism.compile import compile_scene

SCENE = """
[scene]
schema = 1
[bodies.slide]
motion = "driven"
circle = "1 mm"
axis = [0.6, 0.8]
velocity = "5 mm/s"
[bodies.rotor]
motion = "driven"
circle = "1 mm"
position = ["30 mm", "0 mm"]
swing = { amplitude = "30°", frequency = "3 Hz" }
[bodies.lever]
circle = "1 mm"
position = ["0 mm", "40 mm"]
inertia = "1 g·cm²"
[[line_springs]]
between = ["lever", "rotor"]
points = [["3 mm", "1 mm"], ["4 mm", "-7 mm"]]
stiffness = "20 N/m"
viscous = "3 N·s/m"
length = "12 mm"
[[line_springs]]
between = ["lever"]
points = [["-2 mm", "5 mm"], ["45 mm", "8 mm"]]
stiffness = "7 N/m"
viscous = "0.1 N·s/m"
tension = "0.02 N"
[[line_springs]]
between = ["lever", "slide"]
points = [["6 mm", "-2 mm"], ["0 mm", "9 mm"]]
stiffness = "11 N/m"
viscous = "2 N·s/m"
"""


def test_what_drives_supplies_what_is_stored_and_damped(tmp_path: Path) -> None:
    """E' + damping = power of the drives, while the lever stands; E' by five points. The lever by itself needs no drive."""
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    compiled = compile_scene(ws.load(tmp_path))
    model, rng = compiled.model, np.random.default_rng(5)
    free = compiled.slices["lever"].start
    q, u = rng.normal(size=(30, 3)) * 0.3, rng.normal(size=(30, 3))
    q[:, compiled.slices["slide"].start] *= 0.02
    u[:, compiled.slices["slide"].start] *= 0.02
    u[:, free] = 0.0
    h = 1e-3

    def stored(s: float) -> np.ndarray:
        return line_spring_energies(model, q + s * h * u)

    rate = (8.0 * (stored(1.0) - stored(-1.0)) - (stored(2.0) - stored(-2.0))) / (12.0 * h)
    assert held_by_lines(model) == {0, 1, 2}
    driven, damped = (power.sum(axis=1) for power in line_spring_power(model, dict(enumerate(q.T)), dict(enumerate(u.T))))
    assert driven == pytest.approx(rate + damped, abs=1e-9 * np.abs(driven).max())
    assert damped.min() > 0.0 and np.abs(damped).max() > 0.1 * np.abs(driven).max()
    alone = np.zeros_like(u)
    alone[:, free] = 1.0
    driven, damped = (power.sum(axis=1) for power in line_spring_power(model, dict(enumerate(q.T)), dict(enumerate(alone.T))))
    assert not driven.any() and damped.min() > 0.0
