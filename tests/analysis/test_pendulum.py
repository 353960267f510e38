"""Is a pendulum told of as a clock's: amplitude, circular error, decay, beat error, against exact solutions?"""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from scipy.special import ellipk

from watchsim.analysis.summary import summary, summary_text
from watchsim.analysis.timing.beats import DAY, beats
from watchsim.cli import main
from watchsim.commands.common.console import FINE
from watchsim.scene.errors import SceneError
from watchsim.scene.file.load import load
from watchsim.simulation.simulate import simulate

TEXT = """
[scene]
schema = 1
gravity = ["0 m/s²", "-9.81 m/s²"]
[bodies.pendulum]
circle = "20 mm"
pivot = ["0 mm", "250 mm"]
mass = "0.5 kg"
angle = "{angle}°"
{more}
[run]
duration = "{duration} s"
"""
LENGTH, RADIUS = 0.25, 0.02
SMALL = math.tau * math.sqrt((LENGTH**2 + 0.5 * RADIUS**2) / (9.81 * LENGTH))


def pendulum(folder: Path, angle: float, duration: float = 12.0, more: str = ""):
    (folder / "scene.toml").write_text(TEXT.format(angle=angle, duration=duration, more=more), encoding="utf-8")
    return load(folder)


@pytest.mark.parametrize("method, allowed", [("pfeiffer-glocker", 1e-3), ("moreau", 0.3)])
@pytest.mark.parametrize("angle", [3.0, 40.0])
def test_circular_error(angle: float, method: str, allowed: float, tmp_path: Path) -> None:
    """T = 4 K(sin(A/2)) / w: the complete elliptic integral."""
    step = 1e-4 if method == "moreau" else None
    numbers = summary(simulate(pendulum(tmp_path, angle), method=method, step=step))
    period = SMALL * 2.0 / math.pi * float(ellipk(math.sin(0.5 * math.radians(angle)) ** 2))
    assert numbers["amplitude_deg"] == pytest.approx(angle, rel=1e-6 if method != "moreau" else 1e-4)
    assert numbers["rate_s_per_d"] == pytest.approx(DAY * (SMALL / period - 1.0), abs=allowed)
    assert numbers["beat_error_ms"] == pytest.approx(0.0, abs=1e-2)
    assert numbers["timing_message"] is None


def test_decay_by_the_quality_factor(tmp_path: Path) -> None:
    more = '[[damping]]\nbody = "pendulum"\nq_factor = 100\n'
    found = beats(simulate(pendulum(tmp_path, 1.0, 12.0, more)))
    ratio = math.exp(-0.5 * math.pi / 100.0)  # from one half swing to the next, at small angles
    assert found.amplitude[1:] / found.amplitude[:-1] == pytest.approx(ratio, rel=1e-5)


def test_out_of_beat_against_a_stop_of_its_own(tmp_path: Path) -> None:
    """Hung askew, its rest position is where gravity pulls it, not the angle zero of the drawing."""
    more = ""
    scene = pendulum(tmp_path, 10.0, 12.0, more).set("bodies.pendulum.pivot", [0.15, 0.2])
    run = simulate(scene)
    found = beats(run)
    rest = math.atan2(0.15, 0.2)  # the centre of mass lies at (-150, -200) mm from the pivot
    assert found.amplitude_deg == pytest.approx(abs(10.0 - math.degrees(rest)), rel=1e-6)
    assert found.beat_error_ms[3:] == pytest.approx(0.0, abs=1e-4)


def test_spring_and_gravity_together(tmp_path: Path) -> None:
    more = '[[springs]]\nbody = "pendulum"\nstiffness = "2 N·m/rad"\nrest = "0°"\n'
    found = beats(simulate(pendulum(tmp_path, 0.05, 6.0, more)))
    inertia = 0.5 * (LENGTH**2 + 0.5 * RADIUS**2)
    assert found.period_s[2:] == pytest.approx(math.tau * math.sqrt(inertia / (2.0 + 0.5 * 9.81 * LENGTH)), rel=1e-6)


@pytest.mark.parametrize(
    ("angle", "duration", "change", "words"),
    [
        (3.0, 0.4, "", "no amplitude and rate: the run of 0.4 s is too short: pendulum needs 2.0"),
        (3.0, 12.0, "damped", "no amplitude and rate: pendulum never passed its rest position"),
        (3.0, 5.0, "gravity", "no amplitude and rate: no body has a spring, and there is no gravity"),
        (3.0, 5.0, "inertia", "no body has a spring, and none that is not driven hangs beside its pivot"),
    ],
)
def test_without_amplitude_or_rate_it_says_why(angle: float, duration: float, change: str, words: str, tmp_path: Path) -> None:
    more = '[[damping]]\nbody = "pendulum"\nq_factor = 0.3\n' if change == "damped" else ""
    scene = pendulum(tmp_path, angle, duration, more)
    if change == "gravity":
        scene = scene.set("scene.gravity", [0.0, 0.0])
    if change == "inertia":
        text = (tmp_path / "scene.toml").read_text(encoding="utf-8")
        (tmp_path / "scene.toml").write_text(text.replace('mass = "0.5 kg"', 'inertia = "1 g·cm²"'), encoding="utf-8")
        scene = load(tmp_path)
    run = simulate(scene)
    assert words in summary(run)["timing_message"] and words in summary_text(run)


def test_the_commands_tell_of_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pendulum(tmp_path, 3.0)
    assert main(["run", str(tmp_path), "--no-plots", "-o", str(tmp_path / "out")]) == FINE
    said = capsys.readouterr()
    assert "amplitude    3.000" in said.out and "rate         −14.8" in said.out
    assert "frequency" in said.out and "Note:" not in said.err
    assert (tmp_path / "out" / "beats.csv").is_file()
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["notes"] == []


def test_a_clock_that_hangs_still_has_no_rate(tmp_path: Path) -> None:
    """Gravity's rounding makes it swing by less than can be told."""
    place = tmp_path / "scene.toml"
    place.write_text(TEXT.format(angle=0, duration=10, more=""), encoding="utf-8")
    run = simulate(load(place))
    numbers = summary(run)
    assert len(beats(run)) == 0 and numbers["amplitude_deg"] is None and numbers["rate_s_per_d"] is None
    assert "pendulum stays in its rest position" in summary_text(run) or "never passed its rest position" in summary_text(run)


def test_what_is_not_read_causes_no_second_complaint(tmp_path: Path) -> None:
    place = tmp_path / "scene.toml"
    more = '[[damping]]\nbody = "pendulum"\nq_factor = 100'
    text = TEXT.format(angle=5, duration=1, more=more).replace('pivot = ["0 mm", "250 mm"]', 'pivot = ["0", "250 mm"]')
    place.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as told:
        load(place)
    assert "a bare number needs a unit here" in str(told.value) and "quality factor" not in str(told.value)
