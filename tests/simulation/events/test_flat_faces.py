"""Is the next face met where faces too flat to count have let a body sink in?

A bar slides under a disc about its own pivot, or past a fixed point, first on a face that rises by less than a millionth of
the way, which takes no part, then onto one that rises more. That one ends the way at its joint.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from moving_scenes import circle, polygon, touching

from watchsim.scene.body import Body
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

FLAT, SPEED, RADIUS, DURATION, KEPT = 0.03, 0.3, 0.003, 0.2, 0.5  # m, m/s, m, s, restitution


def bar(flat: float, kink: float) -> Body:
    """Slides to the left; its face rises by `flat` along 3 cm from the origin on, then by `kink`, rad."""
    rise, length = flat * FLAT, 0.005
    end = (FLAT + length * math.cos(kink), rise + length * math.sin(kink))
    shape = polygon((-0.04, -0.005), (0.04, -0.005), (0.04, end[1]), end, (FLAT, rise), (0.0, 0.0), (-0.04, 0.0))
    return Body("bar", "slide", axis=(1.0, 0.0), velocity=(-SPEED,), mass=0.05, loops=(shape,))


def passed(flat: float, kink: float, rider: Body) -> Scene:
    contacts = touching("bar", "rider", restitution=KEPT)
    return Scene("flat faces", (bar(flat, kink), rider), contacts=contacts, duration=DURATION)


def way_after(met: float) -> float:
    """Where the bar ends that goes to `met` and back with half its speed, m."""
    return met + KEPT * SPEED * (DURATION + met / SPEED)


@pytest.mark.parametrize("tolerance", [1e-9, 1e-11])
@pytest.mark.parametrize("flat", [1e-8, 3e-7, 9e-7])
@pytest.mark.parametrize("kink", [2e-6, 1e-5, 1e-4, 9e-4, 2e-3])
def test_a_disc_that_sank_in_meets_the_next_face(flat: float, kink: float, tolerance: float) -> None:
    disc = Body("rider", "pivot", (0.0, RADIUS), inertia=5e-6, loops=(circle(RADIUS),))
    run = simulate(passed(flat, kink, disc), tolerance=tolerance)
    # Where the foot on the next face is its joint, or before, where the disc still touches that face beyond it.
    sunk = flat * FLAT
    foot = RADIUS * math.tan(kink) if RADIUS * (1.0 / math.cos(kink) - 1.0) < sunk else 0.5 * RADIUS * kink + sunk / kink
    assert run.u[-1, 0] == pytest.approx(KEPT * SPEED, rel=1e-6)
    assert run.q[-1, 0] == pytest.approx(way_after(foot - FLAT), abs=1e-9)


@pytest.mark.parametrize("kink", [1.1e-3, 2e-3])
@pytest.mark.parametrize("depth", [3e-10, 8e-10])
def test_a_disc_that_sank_in_by_next_to_nothing_stops_at_the_joint(depth: float, kink: float) -> None:
    """Back to where it touched the next face it would go by 0.15 to 0.7 um, off that face."""
    disc = Body("rider", "pivot", (0.0, RADIUS), inertia=5e-6, loops=(circle(RADIUS),))
    sunk = RADIUS * (1.0 / math.cos(kink) - 1.0) + depth
    run = simulate(passed(sunk / FLAT, kink, disc))
    assert np.abs(np.diff(run.q, axis=0)[np.diff(run.t) == 0.0]).max() == 0.0
    assert run.worst_penetration == pytest.approx(depth, rel=1e-3, abs=0.0)
    assert run.q[-1, 0] == pytest.approx(way_after(RADIUS * math.tan(kink) - FLAT), abs=1e-9)


@pytest.mark.parametrize("kink", [2e-6, 1e-4, 2e-3, 0.3])
def test_a_point_that_slides_along_a_wall_does(kink: float) -> None:
    point = Body("rider", "fixed", loops=(polygon((0.0, 0.0), (0.002, 0.004), (-0.002, 0.004)),))
    run = simulate(passed(9e-7, kink, point))
    assert run.u[-1, 0] == pytest.approx(KEPT * SPEED, rel=1e-6)
    assert run.q[-1, 0] == pytest.approx(way_after(-FLAT), abs=2e-7)
