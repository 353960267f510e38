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
from watchsim.simulation.record.trajectory import EventKind, Trajectory

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
    assert abs(run.energy["residual_relative"]) < 1e-8


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


def airy(amplitude: float, q_factor: float, lift: float, lock: float) -> float:
    """Rate (s/d) by an even impulse from (lift - lock)/2 before the middle to (lift + lock)/2 after it, which makes up for damping.

    Airy: -(1 / 2π k A) times the integral of M sin φ over a period; the work M (lift) per beat is π k A² / 2Q.
    """
    before, after = (lift - lock) / 2.0, (lift + lock) / 2.0
    late = math.sqrt(amplitude**2 - before**2) - math.sqrt(amplitude**2 - after**2)
    return -DAY * late / (2.0 * q_factor * lift)


@pytest.mark.parametrize("torque", [0.9, pytest.param(1.8, marks=pytest.mark.slow)])
def test_dead_beat_loses_as_airy_says(torque):
    """A late impulse loses. The wheel, light here, still follows late: the loss is up to a fifth above that of the even impulse."""
    light = {"wheel_inertia": "20 g·mm²", "friction": 0.0}
    amplitude, error = escapement_error("graham", torque, 50.0, 40.0, **light)
    expected = airy(amplitude, 50.0, 2.0, 0.4)
    assert 1.2 * expected < error < 0.95 * expected


def test_what_does_not_fit_is_told():
    for wrong, words in [
        ({"embraced": 7.0}, "whole number and a half"),
        ({"drop": "5 °", "teeth": 36, "embraced": 9.5}, "nothing would be left of the pallets"),
        ({"lock": "2.5 °"}, "must be less than the lift"),
        ({"start": "1 °"}, "no tooth is let off"),
        ({"undercut": "15 °"}, "thinner at its foot"),
        ({"teeth": 60}, "can be drawn"),
    ]:
        for design in (designs.graham, designs.recoil_anchor):
            with pytest.raises(ws.SceneError, match=words):
                design(**wrong)
