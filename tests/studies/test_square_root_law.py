"""Does the amplitude follow from the work that the fork is seen to give the balance?

With viscous damping alone a harmonic swing loses πcωA²/2 in half a period: A = √(2w/(πcω)). The work w per beat is read off
the balance's energy outside the lift, before and after; the solver's own account of work is not used.
That the impulse comes late in the swing is worth 1e-4, more at small amplitudes.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from every_time import few

import watchsim as ws

OUTSIDE = math.radians(35.0)  # the jewel is out of the fork: the lift angle is 51°


@pytest.fixture(scope="module")
def swiss():
    return ws.load(ws.profiles_dir() / "swiss_lever")


def work_per_beat(scene, run):
    column = run.slices["balance"].start
    angle, velocity = run.q[:, column], run.u[:, column]
    energy = 0.5 * scene.body("balance").inertia * velocity**2 + 0.5 * scene.springs[0].stiffness * angle**2
    inside = np.abs(angle) <= OUTSIDE
    starts = np.flatnonzero(~inside[:-1] & inside[1:])[-11:-1]
    works = []
    for start in starts:
        end = start + 1 + int(np.flatnonzero(~inside[start + 1 :])[0])
        middle = 0.5 * (velocity[start + 1 : end + 1] + velocity[start:end])
        air = scene.damping[0].viscous * np.sum(middle * np.diff(angle[start : end + 1]))
        works.append(energy[end] - energy[start] + air)
    assert len(works) == 10
    return np.mean(works)


@pytest.mark.parametrize("torque", few([-1.3e-6, -0.3e-6, -1.0e-6], 1))
def test_amplitude_is_the_root_of_the_measured_work(swiss, torque):
    scene = swiss.set("torques.0.value", torque)
    cycle = ws.steady(scene)
    run = ws.simulate(scene.set("bodies.balance.angle", f"-{cycle.amplitude_deg}°"), 20.0)
    lost = math.pi * scene.damping[0].viscous * 2.0 * math.pi / cycle.period_s
    assert math.degrees(math.sqrt(2.0 * work_per_beat(scene, run) / lost)) == pytest.approx(cycle.amplitude_deg, rel=3e-4)


def test_the_work_grows_with_the_torque(swiss):
    """The escapement passes on the same share of the wheel's work: the amplitude is the root of the torque, to 1e-3."""
    few, many = (ws.steady(swiss.set("torques.0.value", torque)).amplitude_deg for torque in (-0.4e-6, -1.2e-6))
    assert many / few == pytest.approx(math.sqrt(3.0), rel=1e-3)
