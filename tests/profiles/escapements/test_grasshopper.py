"""Does the grasshopper tick, with teeth and torque where its geometry says, and gain with drive as Airy's formula says?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from profiles.running import check_running, of_profile, stepping_errors

import watchsim as ws
from watchsim import designs

R, PITCH, RELEASE = 30.0, math.radians(6.0), math.radians(3.0)
STIFFNESS = 0.5 * 9.81 * 0.25  # N·m per rad of the pendulum


def held(pivot: np.ndarray, nib: np.ndarray) -> np.ndarray:
    """Directions from the wheel's axis of the place R away and as far from each `pivot` as `nib` is from the first (mm)."""
    length, far = math.dist(pivot[0], nib), np.hypot(*pivot.T)
    half = np.arccos((R**2 + far**2 - length**2) / (2.0 * R * far))
    return np.arctan2(pivot[:, 1], pivot[:, 0]) + half


def test_five_minutes_without_a_missed_beat() -> None:
    run = of_profile("grasshopper", 300.0)
    check_running(run, 6.0, 2.0 * 300.0 * ws.summary(run)["frequency_hz"])


def test_the_tooth_goes_as_a_link_with_two_pins() -> None:
    """Between the taking over of one pallet and the next the wheel's angle follows from the pendulum's alone."""
    scene = designs.grasshopper().scene()
    run = ws.simulate(scene, duration=6.0)
    times = np.linspace(5.0, 6.0, 2001)
    q, u = run.sample(times)
    swing, wheel = q[:, 1], q[:, 0]
    driving = (np.abs(swing) < 0.9 * RELEASE) & (u[:, 1] < 0.0)  # by the entry pallet, clockwise
    axis, arm = 1e3 * np.array(scene.body("pendulum").position), -1e3 * scene.body("entry").position[0]
    pivot = np.column_stack((axis[0] - arm * np.cos(swing), axis[1] - arm * np.sin(swing)))[driving]
    tip = wheel[driving] - PITCH * np.round((wheel[driving] - np.radians(133.5)) / PITCH)
    nib = R * np.array([math.cos(tip[0]), math.sin(tip[0])])
    assert driving.sum() > 300
    assert tip == pytest.approx(held(pivot, nib), abs=1e-8)
    # Over the whole swing from release to release it is half a pitch.
    ends = np.column_stack((axis[0] - arm * np.cos([RELEASE, -RELEASE]), axis[1] - arm * np.sin([RELEASE, -RELEASE])))
    start = np.radians(44.957456 + 90.0)
    gone = held(ends, R * np.array([math.cos(start), math.sin(start)]))
    assert gone[0] - gone[1] == pytest.approx(0.5 * PITCH, rel=3e-3)


@pytest.mark.slow
def test_it_gains_with_drive_as_airys_formula_says() -> None:
    """The torque m = T pitch / (4 release) changes its side at ±release: Δω/ω = 2 m √(1 - (release / A)²) / (π k A).

    The circular error and 1/(8Q²) are taken off. The rest is the ratio of the two angles, which is not quite even, and the
    friction of nibs that slide on their teeth while the pendulum swings beyond what the stops are set for.
    """
    gains = []
    for torque in (0.6, 0.7, 0.8):
        run = ws.simulate(designs.grasshopper(torque=f"{torque} mN·m").scene(), duration=300.0)
        told = ws.summary(run)
        A, m = math.radians(told["amplitude_deg"]), 1e-3 * torque * PITCH / (4.0 * RELEASE)
        airy = 2.0 * m * math.sqrt(1.0 - (RELEASE / A) ** 2) / (math.pi * STIFFNESS * A)
        found = told["rate_s_per_d"] / 86400.0 + A * A / 16.0 + 1.0 / (8.0 * 200.0**2)
        assert found == pytest.approx(airy, rel=0.1)
        gains.append(told["rate_s_per_d"])
    assert gains == sorted(gains)


def test_work_of_the_drive_and_amplitude() -> None:
    """Of the tooth's work nearly all reaches the pendulum: A² = T pitch Q / (π k), less friction and impacts."""
    run = of_profile("grasshopper", 120.0)
    told = ws.summary(run)
    lossless = math.degrees(math.sqrt(0.8e-3 * PITCH * 200.0 / (math.pi * STIFFNESS)))
    assert 0.97 * lossless < told["amplitude_deg"] < lossless
    lost = run.energy["dissipated"]
    assert lost["friction"] < 0.06 * run.energy["in_J"]
    assert lost["impacts"] < 0.01 * run.energy["in_J"]


@pytest.mark.slow
def test_time_stepping_agrees() -> None:
    off = stepping_errors(designs.grasshopper().scene(), 2.2, (1e-4, 5e-5))
    assert off[1] < 1e-5
    assert off[1] < 0.6 * off[0]


REFUSED = [
    ({"torque": "1.2 mN·m"}, "would sustain"),
    ({"torque": "0.4 mN·m"}, "would sustain"),
    ({"span": 30}, "puts the pallets"),
    ({"teeth": 58, "tip_radius": "24.9 mm", "span": 9, "release": "1.13°", "overswing": "0.8°"}, "cut into the teeth"),
    ({"span": 9}, "would swing into the teeth"),
    ({"nib": "1.15 mm"}, "stays among the teeth"),
    ({"nib": "1.4 mm"}, "meets the floor"),
    ({"overswing": "0.85°"}, "passes over its tooth"),
    ({"pallet_torque": "0.1 µN·m"}, "slow to clear the teeth"),
    ({"pallet_torque": "60 µN·m"}, "pulls the pallets off"),
    ({"height": "3 mm"}, "at this pitch"),
]


@pytest.mark.parametrize(("changed", "why"), REFUSED)
def test_what_does_not_fit_is_refused(changed: dict[str, str | float], why: str) -> None:
    with pytest.raises(ws.SceneError, match=why):
        designs.grasshopper(**changed)
