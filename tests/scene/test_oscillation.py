"""Does what swings swing as fast as the textbook says, by springs, by gravity and by both?"""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from scipy.optimize import brentq

from watchsim.cli import main
from watchsim.commands.console import FINE
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.roles import frequency, keeps_time, nominal_frequency, oscillators, roles

G = 9.81
HEAD = f'[scene]\nschema = 1\ngravity = ["0 m/s²", "-{G} m/s²"]\n'
# A disc of 50 mm and 2 kg, 1 m below the pivot, on a rod without weight: J = m (l² + r²/2).
PENDULUM = """
[bodies.pendulum]
inertia = "1e-9 kg·m²"
[bodies.bob]
on = "pendulum"
motion = "fixed"
position = ["0 mm", "-1000 mm"]
circle = "50 mm"
mass = "2 kg"
"""
J = 2.0 * (1.0 + 0.5 * 0.05**2) + 1e-9


def scene_of(folder: Path, text: str):
    (folder / "scene.toml").write_text(HEAD + text, encoding="utf-8")
    return load(folder)


def test_fixed_loads_count(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = scene_of(tmp_path, PENDULUM)
    assert frequency(scene) == pytest.approx(math.sqrt(2.0 * G / J) / math.tau, rel=1e-12)
    assert roles(scene).oscillator == "pendulum" and keeps_time(scene)
    assert main(["check", str(tmp_path)]) == FINE
    said = capsys.readouterr().out
    assert "pendulum makes small swings at 0.498" in said and "by gravity alone, 19.62 N·m/rad" in said
    assert "with bob: mass 2 kg" in said and "has no mass" not in said


def test_a_pendulum_hangs_where_gravity_pulls_it(tmp_path: Path) -> None:
    turned = PENDULUM.replace('["0 mm", "-1000 mm"]', '["600 mm", "-800 mm"]')
    (one,) = oscillators(scene_of(tmp_path, turned))
    assert one.rest == pytest.approx(-math.atan2(600.0, 800.0), rel=1e-12) and one.gravity == pytest.approx(2.0 * G)
    wound = turned.replace("inertia", 'angle = "700°"\ninertia', 1)
    (one,) = oscillators(scene_of(tmp_path, wound))
    assert one.rest == pytest.approx(2.0 * math.tau - math.atan2(600.0, 800.0), rel=1e-12)


@pytest.mark.parametrize("stiffness", [0.5, 15.0, 60.0])
def test_spring_and_gravity_add(stiffness: float, tmp_path: Path) -> None:
    """A spring at rest at 40° and gravity share the rest position; found by another root finder."""
    text = PENDULUM + f'[[springs]]\nbody = "pendulum"\nstiffness = "{stiffness} N·m/rad"\nrest = "40°"\n'
    (one,) = oscillators(scene_of(tmp_path, text))
    rest = brentq(lambda q: stiffness * (q - math.radians(40.0)) + 2.0 * G * math.sin(q), -0.1, 1.0, xtol=1e-15)
    assert one.rest == pytest.approx(rest, abs=1e-12)
    assert one.hertz == pytest.approx(math.sqrt((stiffness + 2.0 * G * math.cos(rest)) / J) / math.tau, rel=1e-12)


def test_an_inverted_pendulum_stands_on_a_strong_spring_only(tmp_path: Path) -> None:
    upright = PENDULUM.replace("-1000 mm", "1000 mm")
    spring = '[[springs]]\nbody = "pendulum"\nstiffness = "{} N·m/rad"\n'
    strong = scene_of(tmp_path, upright + spring.format(30.0))
    assert frequency(strong) == pytest.approx(math.sqrt((30.0 - 2.0 * G) / J) / math.tau, rel=1e-9)
    (weak,) = oscillators(scene_of(tmp_path, upright + spring.format(10.0)))
    assert 1.0 < abs(weak.rest) < math.pi and weak.hertz  # it leans over to where the two balance


def test_quality_is_that_of_weight_and_loads(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, PENDULUM + '[[damping]]\nbody = "pendulum"\nq_factor = 400\n')
    assert scene.damping[0].viscous == pytest.approx(math.sqrt(2.0 * G * J) / 400.0, rel=1e-12)


def test_a_frequency_is_that_of_the_loaded_body(tmp_path: Path) -> None:
    flat = PENDULUM + '[[springs]]\nbody = "pendulum"\nfrequency = "3 Hz"\n'
    (tmp_path / "scene.toml").write_text("[scene]\nschema = 1\n" + flat, encoding="utf-8")
    scene = load(tmp_path)
    assert scene.springs[0].stiffness == pytest.approx(J * (math.tau * 3.0) ** 2, rel=1e-12)
    assert frequency(scene) == pytest.approx(3.0, rel=1e-12)


def test_the_rate_is_measured_against_what_the_scene_says(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, PENDULUM + '[timegrapher]\nfrequency = "3600 vph"\n')
    assert nominal_frequency(scene) == 0.5 and frequency(scene) != 0.5
    with pytest.raises(SceneError, match=r"small swings at 0\.498.* Hz .* more than 10 % off"):
        scene_of(tmp_path, PENDULUM + '[timegrapher]\nfrequency = "28800 vph"\n')
    with pytest.raises(SceneError, match="more than 10 % off"):
        scene_of(tmp_path, PENDULUM + '[timegrapher]\nfrequency = "3200 vph"\n')
    # A vertical watch whose balance is not poised: the spring's own frequency, so that the poise error shows in the rate.
    sprung = scene_of(tmp_path, PENDULUM + '[[springs]]\nbody = "pendulum"\nfrequency = "4 Hz"\n')
    assert nominal_frequency(sprung) == pytest.approx(4.0, rel=1e-12) and frequency(sprung) > 4.01


@pytest.mark.parametrize("extra", ['[[torques]]\nbody = "pendulum"\nvalue = "1 N·m"\n', ""])
def test_what_is_driven_or_does_not_hang_is_no_pendulum(extra: str, tmp_path: Path) -> None:
    text = PENDULUM + extra if extra else PENDULUM.replace("-1000 mm", "0 mm")
    assert oscillators(scene_of(tmp_path, text)) == ()
