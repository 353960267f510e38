"""Is what is lost at a kink between edges what the laws of contact say, from 1e-10 rad to 90 degrees?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from every_time import few
from kinked_scenes import ANGLES, FRICTIONS, RESTITUTIONS, TOLERANCES, bar_for, beyond, expected, kinked_scene, off
from reference.kinked_bar import obeys_laws

from watchsim.simulation.simulate import simulate


@pytest.mark.parametrize("convex", [False, True])
@pytest.mark.parametrize("friction", few(FRICTIONS, 1))
def test_kinks_lose_what_the_laws_say(convex: bool, friction: float) -> None:
    wrong = []
    for i, angle in enumerate(ANGLES[::2]):
        restitution, tolerance = RESTITUTIONS[i % len(RESTITUTIONS)], TOLERANCES[(i // 2) % len(TOLERANCES)]
        truth = expected(angle, convex, friction, restitution)
        found = off(bar_for(angle, convex, friction, restitution), truth, beyond(angle), tolerance)
        if found.wrong:
            wrong.append((angle, restitution, tolerance, found))
    assert not wrong


def test_a_plastic_impact_at_a_kink_loses_its_square() -> None:
    """m_f (u d)²/2 to first order, m_f the follower's mass as seen by the contact."""
    for angle in (1e-3, 1e-2):
        bar = bar_for(angle, False, 0.0, 0.0)
        run = simulate(kinked_scene(bar, 0.12, 1e-9))
        lost = 0.5 * bar.inertia / bar.arm**2 * (bar.speed * angle) ** 2
        assert run.energy["dissipated"]["impacts"] == pytest.approx(lost, rel=20.0 * angle)


@pytest.mark.parametrize("angle", [1e-6, 1e-4, 1e-3, 1e-2, 0.1])
def test_nothing_is_lost_without_friction_and_loss(angle: float) -> None:
    bar = bar_for(angle, False, 0.0, 1.0)
    run = simulate(kinked_scene(bar, 0.12, 1e-9))
    masses = np.array([bar.mass, bar.inertia])
    energy = 0.5 * float(masses @ run.end_u**2) - bar.torque * float(run.end_q[1])
    # What bounces within what counts as closed is ended: at most the energy of the impact itself.
    rest = 0.5 * bar.inertia / bar.arm**2 * (bar.speed * math.sin(angle)) ** 2 if angle < 1e-3 else 0.0
    assert energy == pytest.approx(0.5 * bar.mass * bar.speed**2, abs=1.01 * rest + 1e-11 * 5e-4)


def test_the_truth_itself_keeps_its_energy() -> None:
    """The reference against the balance of energy, which it does not use."""
    for convex in (False, True):
        bar = bar_for(0.05, convex, 0.0, 0.0)
        end, after = expected(0.05, convex, 0.0, 0.0).end, expected(0.05, convex, 0.0, 0.0).after
        masses = np.array([bar.mass, bar.inertia])
        begun = 0.5 * bar.mass * bar.speed**2 if after is None else 0.5 * float(masses @ after[2:] ** 2)
        assert 0.5 * float(masses @ end[2:] ** 2) - bar.torque * end[1] == pytest.approx(begun, rel=1e-11)


@pytest.mark.parametrize(("angle", "tolerance"), [(1e-3, 1e-7), (1e-4, 1e-9)])
def test_rebounds_that_are_ended_take_their_friction_with_them(angle: float, tolerance: float) -> None:
    """Rebounds that are over have given the contact what a plastic impact gives, friction included."""
    found = off(bar_for(angle, False, 0.3, 0.5), expected(angle, False, 0.3, 0.5), beyond(angle), tolerance)
    assert not found.wrong


def test_what_the_laws_leave_open_is_still_judged() -> None:
    """At 90°, with friction, both faces stop both bodies: the split of that is open, what follows from a split is not."""
    bar, truth = bar_for(ANGLES[-1], False, 0.3, 0.5), expected(ANGLES[-1], False, 0.3, 0.5)
    assert truth.is_open and truth.after is not None
    assert obeys_laws(bar, truth.before, truth.after)
    assert not obeys_laws(bar, truth.before, truth.after * [1.0, 1.0, 1.01, 1.0])
    assert not expected(ANGLES[-2], False, 0.1, 0.5).is_open
    found = off(bar, truth, beyond(ANGLES[-1]), 1e-9)
    assert found.speed == 0.0 and not found.wrong
