"""Do the dead-beat escapement and the recoil anchor tick, and does their rate follow the drive as the books say?

The rate is taken against small swings; what a free pendulum would lose at that amplitude, 2 K(sin² A/2) / π - 1, and what
viscous damping costs, 1/(8 Q²), are known. The rest is the escapement's own error.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipk

import watchsim as ws
from watchsim import designs
from watchsim.construction.graham import Anchor, Graham
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

DAY = 86400.0


def of_profile(name: str, duration: float) -> Trajectory:
    return ws.simulate(ws.load(ws.profiles_dir() / name / "scene.toml"), duration=duration)


def beats(run: Trajectory) -> int:
    return int(np.count_nonzero(run.events["kind"] == EventKind.CROSS))


def check_ticking(run: Trajectory, seconds: float) -> None:
    """One half pitch of the wheel per beat, two beats a second."""
    assert run.stop.name == "DURATION"
    assert abs(beats(run) - 2.0 * seconds) <= 2
    assert abs((run.q[0, 0] - run.q[-1, 0]) / (math.pi / 30.0) - beats(run)) < 1.5
    assert run.worst_penetration < 1e-9
    assert ws.summary(run)["missed_beats"] == 0


@pytest.mark.parametrize("name", ["graham", "recoil_anchor"])
def test_a_minute(name):
    run = of_profile(name, 60.0)
    check_ticking(run, 60.0)
    assert abs(run.energy["residual_relative"]) < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("name", ["graham", "recoil_anchor"])
def test_five_minutes(name):
    check_ticking(of_profile(name, 300.0), 300.0)


def turned_back(run: Trajectory) -> float:
    """Most that the wheel turns back from a place that it had reached, rad."""
    t = np.linspace(20.0, 24.0, 40001)
    wheel = run.sample(t)[0][:, 0]
    return float((wheel - np.minimum.accumulate(wheel)).max())


def test_only_the_recoil_anchor_drives_the_wheel_back():
    """The dead faces are arcs about the pivot: with plastic impacts the wheel does not turn back at all."""
    assert turned_back(of_profile("graham", 24.0)) < 1e-7
    run = of_profile("recoil_anchor", 24.0)
    half_span = math.radians(45.0)
    swing = np.abs(run.q[run.t > 20.0, 1]).max()
    lean = math.tan(math.radians(20.0)) * math.tan(half_span)  # wheel by pendulum, on a face that leans by 20°
    assert turned_back(run) == pytest.approx(lean * (swing - math.radians(1.0)), rel=0.25)


def escapement_error(name: str, torque: float, q_factor: float, duration: float, **dimensions: object) -> tuple[float, float]:
    """Amplitude (°) and what the escapement adds to the rate (s/d)."""
    drawn = getattr(designs, name)(torque=f"{torque} mN·m", q_factor=q_factor, **dimensions)
    summary = ws.summary(ws.simulate(drawn.scene(), duration=duration))
    amplitude = summary["amplitude_deg"]
    free = 2.0 / math.pi * ellipk(math.sin(math.radians(amplitude) / 2.0) ** 2)
    assert summary["missed_beats"] == 0
    return amplitude, summary["rate_s_per_d"] + DAY * (free - 1.0) + DAY / (8.0 * q_factor**2)


def test_more_drive_makes_the_recoil_anchor_gain():
    weak, strong = (escapement_error("recoil_anchor", torque, 30.0, 25.0) for torque in (1.2, 2.4))
    assert strong[0] > weak[0] + 0.5
    assert strong[1] > weak[1] + 50.0 > 100.0


def bearing(anchor: Anchor, side: int, pendulum: np.ndarray) -> np.ndarray:
    """Of a tooth's tip on an impulse face, rad: where the face, turned with the pendulum, cuts the circle of the tips."""
    cos, sin = np.cos(pendulum), np.sin(pendulum)
    (ax, ay), (bx, by) = ((cos * x - sin * y, sin * x + cos * y + anchor.distance) for x, y in anchor.corners(side))
    dx, dy = bx - ax, by - ay
    square, half, rest = dx * dx + dy * dy, ax * dx + ay * dy, ax * ax + ay * ay - anchor.values.tip_radius**2
    roots = [(-half + sign * np.sqrt(half * half - square * rest)) / square for sign in (1.0, -1.0)]
    part = np.where(np.abs(roots[0] - 0.5) < np.abs(roots[1] - 0.5), *roots)
    return np.arctan2(ay + part * dy, ax + part * dx)


def airy(amplitude: float, q_factor: float) -> float:
    """Rate (s/d) by impulses without delay or friction: -(1 / 2π k A) times the integral of M sin φ.

    M is the wheel's torque times its turn by the pendulum's; the drive is such that its work makes up for damping, π k A² / Q.
    """
    anchor, swing, work, late = Anchor(Graham()), math.radians(amplitude), 0.0, 0.0
    for side in (1, -1):
        angle = np.radians(np.linspace(side * anchor.unlocked, -side * anchor.released, 4001))
        torque = -(bearing(anchor, side, angle + 1e-6) - bearing(anchor, side, angle - 1e-6)) / 2e-6
        work += np.trapezoid(torque, angle)
        late -= side * np.trapezoid(torque * angle / swing / np.sqrt(swing**2 - angle**2), angle)
    return -DAY * late / work * swing / (2.0 * q_factor)


@pytest.mark.parametrize("torque", [0.9, pytest.param(1.8, marks=pytest.mark.slow)])
def test_dead_beat_loses_as_airy_says(torque):
    """A late impulse loses; the formula knows neither the wheel's catching up nor the impact when it has."""
    light = {"wheel_inertia": "20 g·mm²", "friction": 0.0}
    amplitude, error = escapement_error("graham", torque, 50.0, 40.0, **light)
    assert error == pytest.approx(airy(amplitude, 50.0), rel=0.06)


def test_what_does_not_fit_is_told():
    for wrong, words in [
        ({"embraced": 7.0}, "whole number and a half"),
        ({"drop": "5 °", "teeth": 36, "embraced": 9.5}, "nothing would be left of the pallets"),
        ({"lock": "2.5 °"}, "must be less than the lift"),
        ({"start": "1 °"}, "no tooth is let off"),
        ({"undercut": "15 °"}, "thinner at its foot"),
        ({"teeth": 60, "embraced": 2.5}, "can be drawn"),
    ]:
        for design in (designs.graham, designs.recoil_anchor):
            with pytest.raises(ws.SceneError, match=words):
                design(**wrong)
