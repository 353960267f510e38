"""Does a pin-wheel escapement tick, stand still at rest, and follow Airy's formula?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from profiles.led_wheel import DAY, Led, work_and_rate
from profiles.running import check_running, of_profile, stepping_errors
from scipy.special import ellipk

import watchsim as ws
from watchsim import designs
from watchsim.construction.pin_wheel import PinAnchor, PinWheel
from watchsim.construction.registry import design


def test_a_minute():
    check_running(of_profile("pin_wheel", 60.0), 12.0, 60.0)


@pytest.mark.slow
def test_five_minutes():
    check_running(of_profile("pin_wheel", 300.0), 12.0, 300.0)


def test_the_wheel_stands_still_at_rest():
    """Both resting faces are arcs about the pivot."""
    run = of_profile("pin_wheel", 20.0)
    wheel = run.sample(np.linspace(10.0, 14.0, 40001))[0][:, run.slices["wheel"].start]
    assert float((wheel - np.minimum.accumulate(wheel)).max()) < 1e-7


def led(anchor: PinAnchor, scene: ws.Scene) -> list[tuple[np.ndarray, np.ndarray]]:
    """Both impulses, by the drawn outlines alone."""
    hands, found = Led(scene, "pendulum", {"PINS"}, {"PALLETS"}), []
    for side in (1, -1):
        start = -math.radians(anchor.locked(side)) - 5e-4
        ends = math.radians(side * anchor.unlocked), -math.radians(side * (anchor.released - 1e-4))
        found.append(hands.impulse(*ends, start, 121))
    return found


@pytest.mark.slow
def test_the_outlines_drive_as_far_as_they_are_drawn_to():
    anchor = PinAnchor(PinWheel())
    for swung, gone in led(anchor, designs.pin_wheel().scene()):
        assert math.degrees(gone[-1] - gone[0]) == pytest.approx(anchor.driven, abs=0.04)
        assert math.degrees(abs(swung[-1] - swung[0])) == pytest.approx(anchor.values.lift, abs=1e-3)


def test_amplitude_and_rate_as_airy_says():
    """A light wheel without friction: the drive's work is what damping takes, and the late impulse loses.

    Neither knows the wheel's catching up and the impact when it has: 3 % of the work, 10 % of the rate.
    """
    torque, q_factor = 90e-3, 50.0
    drawn = designs.pin_wheel(friction=0.0, wheel_inertia="8000 g·mm²", q_factor=q_factor, torque=f"{1e3 * torque} mN·m")
    scene, cycle = drawn.scene(), ws.steady(drawn.scene())
    pendulum = scene.body("pendulum")
    stiffness = pendulum.mass * 9.81 * math.hypot(*pendulum.centre_of_mass)
    swing = math.radians(cycle.amplitude_deg)
    work, airy = work_and_rate(led(PinAnchor(PinWheel()), scene), torque, stiffness, swing)
    assert math.pi * stiffness * swing**2 / q_factor == pytest.approx(work, rel=0.03)
    free = 2.0 / math.pi * ellipk(math.sin(swing / 2.0) ** 2)
    assert cycle.rate_s_per_d + DAY * (free - 1.0) + DAY / (8.0 * q_factor**2) == pytest.approx(airy, rel=0.1)


@pytest.mark.parametrize(
    ("chosen", "blamed"),
    [
        ({"lock": 2.0, "lift": 1.5}, "lock"),
        ({"start": 1.0}, "start"),
        ({"reach": 1.0}, "reach"),
        ({"pins": 60, "drop": 2.5}, "drop"),
        ({"pin_diameter": 9.0}, "pin_diameter"),
        ({"lift": 5.0, "drop": 4.0, "start": 3.5}, "lift"),
        ({"torque": 500.0}, "torque"),
        ({"torque": 1.0}, "torque"),
    ],
)
def test_conflicts_name_what_to_change_first(chosen, blamed):
    assert blamed in [one.dimension for one in design("pin_wheel").refusals(chosen)]


@pytest.mark.slow
def test_time_stepping_comes_to_the_same():
    coarse, fine = stepping_errors(designs.pin_wheel().scene(), 8.0, (1e-4, 2.5e-5))
    assert fine < 2e-5 and fine < coarse
