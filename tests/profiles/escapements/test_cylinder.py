"""Does a cylinder escapement tick, rest inside and outside, and follow Airy's formula and the friction at rest?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from every_time import few
from profiles.led_wheel import DAY, Led, work_and_rate
from profiles.running import check_running, of_profile, stepping_errors

import watchsim as ws
from watchsim import designs
from watchsim.construction.cylinder import Cylinder, Shell, shell
from watchsim.construction.registry import design


def test_twenty_seconds():
    check_running(of_profile("cylinder", 20.0), 24.0, 100.0)


@pytest.mark.slow
def test_five_minutes():
    check_running(of_profile("cylinder", 300.0), 24.0, 1500.0)


def led(made: Shell, scene: ws.Scene) -> list[tuple[np.ndarray, np.ndarray]]:
    """Both impulses, by the drawn outlines alone; at wheel angle 0 a tooth is in the middle of the cylinder."""
    hands, half = Led(scene, "balance", {"TEETH"}, {"SHELL"}), made.values.tooth_width / 2.0
    right = made.left_lip - made.span
    ways = (
        (made.entry[0] - made.left_lip, made.entry[1] - made.left_lip + 2e-3, made.rests_outside),
        (made.exit[0] - right, made.exit[1] - right - 2e-3, made.rests_inside),
    )
    return [
        hands.impulse(math.radians(first), math.radians(last), -math.radians(rests + half) - 5e-4)
        for first, last, rests in ways
    ]


@pytest.mark.parametrize("chosen", few([{}, {"tooth_width": 9.5, "drop": 1.6, "lift": 34.0}], 1))
def test_led_by_hand_the_drops_are_those_chosen(chosen):
    """What two impulses leave of a pitch are the two drops."""
    values = design("cylinder").chosen(chosen)
    made = shell(values)
    scene = designs.cylinder(**{name: design("cylinder").dimension(name).shown(x) for name, x in chosen.items()}).scene()
    gone = [math.degrees(wheel[-1] - wheel[0]) for _, wheel in led(made, scene)]
    assert gone == pytest.approx(made.driven, abs=0.03)
    assert (made.pitch - sum(gone)) / 2.0 == pytest.approx(values.drop, abs=0.03)
    assert sum(made.lifts) / 2.0 == pytest.approx(values.lift, abs=1e-9)
    assert min(made.locks) == pytest.approx(values.lock, abs=1e-9)


@pytest.mark.slow
def test_amplitude_and_rate_as_airy_says():
    """A light wheel without friction: the drive's work is what damping takes; impulse after the middle loses.

    Neither knows the wheel's catching up and the impact when it has: 4 % of the work, 12 % of the rate.
    """
    torque, q_factor = 0.15e-6, Cylinder().q_factor
    drawn = designs.cylinder(friction=0.0, wheel_inertia="0.02 mg·cm²", torque=f"{1e6 * torque} µN·m")
    cycle = ws.steady(drawn.scene())
    stiffness = 1e-10 * Cylinder().balance_inertia * (math.pi * Cylinder().frequency / 3600.0) ** 2
    swing = math.radians(cycle.amplitude_deg)
    work, airy = work_and_rate(led(shell(Cylinder()), drawn.scene()), torque, stiffness, swing)
    assert math.pi * stiffness * swing**2 / q_factor == pytest.approx(work, rel=0.04)
    assert cycle.rate_s_per_d + DAY / (8.0 * q_factor**2) == pytest.approx(airy, rel=0.12)


def test_friction_at_rest_takes_what_coulomb_says():
    """A tooth at rest presses along the radius of the shell, which rubs along it: moments about the wheel's axis give N."""
    values = Cylinder(friction=0.15, torque=0.2)
    made, scene = shell(values), designs.cylinder(friction=0.15, torque="0.2 µN·m").scene()
    run = ws.simulate(scene, duration=0.2)
    contact = math.radians(made.rests_outside)
    point = 1e-3 * made.point_radius * np.array([-math.sin(contact), math.cos(contact)])
    normal = (1e3 * point - np.array(made.balance)) / made.outer
    arm = abs(normal[0] * point[1] - normal[1] * point[0])
    # The friction on the point, μ N along the shell, turns the wheel, too: it is with the drive or against it.
    along = np.array([-normal[1], normal[0]])
    lever = point[0] * along[1] - point[1] * along[0]
    t = np.linspace(0.01, 0.05, 21)
    forces = ws.forces(run, t)
    torque = values.torque * 1e-6
    expected = sorted(torque / (arm + sign * values.friction * lever) for sign in (1.0, -1.0))
    press = np.asarray(forces.normal).sum(axis=1)
    assert press.max() == pytest.approx(press.min(), rel=1e-3)
    assert min(abs(press[0] / one - 1.0) for one in expected) < 1e-3


def test_friction_lowers_amplitude_and_rate():
    """Frictional rest: the loss grows with the drive, so that twice the drive gives far less than √2 of the amplitude."""
    weak, strong = (ws.steady(designs.cylinder(torque=f"{torque} µN·m").scene()) for torque in (0.2, 0.4))
    assert 1.2 < strong.amplitude_deg / weak.amplitude_deg < 1.35
    assert abs(strong.rate_s_per_d - weak.rate_s_per_d) < 2.0
    rough = ws.steady(designs.cylinder(friction=0.15).scene())
    assert rough.amplitude_deg < strong.amplitude_deg - 25.0 and rough.rate_s_per_d < strong.rate_s_per_d


@pytest.mark.parametrize(
    ("chosen", "blamed"),
    [
        ({"tooth_width": 11.0}, "tooth_width"),
        ({"tooth_width": 10.55}, "tooth_width"),
        ({"drop": 1.0}, "drop"),
        ({"lift": 20.0, "friction": 0.25}, "lift"),
        ({"start": 40.0, "lift": 70.0}, "start"),
        ({"torque": 5.0}, "torque"),
        ({"torque": 0.004}, "torque"),
    ],
)
def test_conflicts_name_what_to_change_first(chosen, blamed):
    assert blamed in [one.dimension for one in design("cylinder").refusals(chosen)]


@pytest.mark.slow
def test_time_stepping_comes_to_the_same():
    coarse, fine = stepping_errors(designs.cylinder().scene(), 2.0, (1.6e-5, 4e-6))
    assert fine < 3e-3 and fine < 0.5 * coarse
