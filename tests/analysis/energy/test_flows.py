"""Are work and losses between rows the integrals of their powers, whatever forces act?"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.analysis.timeline.flows import _position, _velocity, flows
from watchsim.analysis.weights_fallen import work_of_gravity
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.file.load import load
from watchsim.simulation.simulate import simulate

SCENE = """
[scene]
title = "A plate on its corner, with everything that acts on it"
schema = 1
gravity = ["1.5 m/s²", "-9.81 m/s²"]
[bodies.plate]
polygon = [["0 mm", "0 mm"], ["30 mm", "0 mm"], ["30 mm", "20 mm"], ["0 mm", "20 mm"]]
position = ["0 mm", "0 mm"]
mass = "10 g"
inertia = "50 g·cm²"
angle = "-20°"
velocity = "300 °/s"
[[springs]]
body = "plate"
stiffness = "5 mN·m/rad"
rest = "-60°"
"""
MORE = """
[[torques]]
body = "plate"
over = "angle"
table = [["-200°", "0.3 mN·m"], ["0°", "-0.2 mN·m"], ["200°", "0.4 mN·m"]]
[[damping]]
body = "plate"
viscous = "20 nN·m·s/rad"
quadratic = "3 nN·m·s²/rad²"
coulomb = "40 µN·m"
"""
NUMBERS = st.lists(st.floats(-2.0, 2.0), min_size=6, max_size=6)


@given(NUMBERS, st.floats(0.01, 3.0), st.floats(0.0, 1.0))
def test_between_rows_stand_the_quintic_and_the_cubic(numbers: list[float], h: float, s: float) -> None:
    """A polynomial of degree five (of velocities: three) comes back as it was."""
    p, v = np.polynomial.Polynomial(numbers), np.polynomial.Polynomial(numbers[:4])
    ends = np.array([0.0, h])

    def column(polynomial: np.polynomial.Polynomial, order: int = 0) -> np.ndarray:
        return polynomial.deriv(order)(ends)[:, None] if order else polynomial(ends)[:, None]

    scale = 1.0 + max(abs(p(np.linspace(0.0, h, 9))).max(), abs(v(np.linspace(0.0, h, 9))).max())
    where = _position(np.array([[h]]), (column(p), column(p, 1), column(p, 2)), [0])(s)[0]
    assert where[0] == pytest.approx(p(s * h), abs=1e-11 * scale * (1.0 + h) ** 5)
    fast = _velocity(np.array([h]), (column(v), column(v, 1)), [0])(s)[0]
    assert fast[0] == pytest.approx(v(s * h), abs=1e-11 * scale * (1.0 + h) ** 3)


def test_work_and_losses_are_those_of_the_ledger(tmp_path: Path) -> None:
    """The solver sums powers as it steps, with its own steps and rules, those of weights among what is put in."""
    place = tmp_path / "scene.toml"
    place.write_text(SCENE + MORE, encoding="utf-8")
    scene = load(place)
    run = simulate(scene, 1.0)
    found = flows(run, compile_scene(scene))
    assert run.energy["in_J"] != 0.0 and run.energy["dissipated"]["damping"] > 1e-6
    fallen = work_of_gravity(run)
    assert abs(fallen) > 1e-4
    assert found.drive[-1] + fallen == pytest.approx(run.energy["in_J"], rel=1e-7)
    assert found.damped[-1].sum() == pytest.approx(run.energy["dissipated"]["damping"], rel=1e-7)
    assert found.stored[-1] - found.stored[0] + fallen == pytest.approx(run.energy["stored_J"], rel=1e-7)


def test_gravity_lends_what_the_centre_of_mass_has_fallen(tmp_path: Path) -> None:
    place = tmp_path / "scene.toml"
    place.write_text(SCENE, encoding="utf-8")
    run = simulate(load(place), 0.3)
    turned = run.end_q[0] if run.end_q[0] != run.q[0, 0] else None
    assert turned is not None
    centre = np.array([15e-3 + 10e-3j]) * np.exp(1j * np.array([run.q[0, 0], turned]))
    fallen = 10e-3 * (1.5 * np.diff(centre.real)[0] - 9.81 * np.diff(centre.imag)[0])
    assert work_of_gravity(run) == pytest.approx(fallen, rel=1e-12)
    assert run.energy["in_J"] == pytest.approx(fallen, rel=1e-7)


LINE = """
[scene]
title = "a slide between two springs"
[bodies.slide]
motion = "slide"
axis = [1.0, 0.0]
mass = "3 g"
[bodies.shaker]
motion = "{shaker}"
axis = [1.0, 0.0]
{moves}
[[line_springs]]
between = ["slide"]
points = [["-1 mm", "0 mm"], ["-11 mm", "0 mm"]]
stiffness = "20 N/m"
length = "7 mm"
viscous = "0.05 N·s/m"
[[line_springs]]
between = ["slide", "shaker"]
points = [["1 mm", "0 mm"], ["15 mm", "0 mm"]]
stiffness = "8 N/m"
length = "14 mm"
viscous = "0.02 N·s/m"
[run]
duration = "0.3 s"
"""


def test_damping_of_springs_between_points_is_no_friction(tmp_path: Path) -> None:
    """What a damped swing in a line has lost, by its closed form; the shaker stands still."""
    path = tmp_path / "scene.toml"
    path.write_text(LINE.format(shaker="fixed", moves="").replace("axis = [1.0, 0.0]\n\n", "\n"), encoding="utf-8")
    scene = load(path)
    found = flows(simulate(scene), compile_scene(scene))
    m, k, c, off = 3e-3, 28.0, 0.07, 3e-3 * 20.0 / 28.0  # the left one begins 3 mm too long, the right one without force
    decay, w = 0.5 * c / m, np.sqrt(k / m - (0.5 * c / m) ** 2)
    t = found.t
    x = off * np.exp(-decay * t) * (np.cos(w * t) + decay / w * np.sin(w * t))
    v = -off * np.exp(-decay * t) * (k / m) / w * np.sin(w * t)
    lost = 0.5 * k * off**2 - 0.5 * (k * x**2 + m * v**2)
    assert found.damped.sum(axis=1) == pytest.approx(lost, abs=1e-7 * lost[-1])
    assert np.abs(found.drive).max() == 0.0


def test_what_shakes_a_spring_between_points_drives_it(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    moves = 'swing = { amplitude = "2 mm", frequency = "15 Hz" }\n'
    path.write_text(LINE.format(shaker="driven", moves=moves), encoding="utf-8")
    scene = load(path)
    run = simulate(scene)
    found = flows(run, compile_scene(scene))
    gained = found.stored - found.stored[0] + found.damped.sum(axis=1)
    assert found.drive == pytest.approx(gained, abs=1e-7 * found.damped.sum(axis=1)[-1])
    assert found.damped[-1].sum() == pytest.approx(run.energy["dissipated"]["damping"], rel=1e-6)
