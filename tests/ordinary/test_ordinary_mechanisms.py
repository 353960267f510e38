"""Do gears, cams, kinks and mechanisms in any orientation move as laws and closed forms say?"""

import itertools
import math

import numpy as np
import pytest
from every_time import few
from flat_cams import ANGLES, FRICTIONS, RESTITUTIONS, TOLERANCES, bar_for, beyond, compared, expected, kinked_scene, off
from gear_scenes import TEETH, contact_ratio, gear_scene, train
from mean_speed import mean_speed, tooth_times
from mechanisms import MECHANISMS, mechanism
from orientations import apart, posed, random_pose, seen
from reference.flat_cam import Curve, FlatCam, Harmonic, Oval
from reference.gear_friction import FASTEST, SLOWEST
from reference.gear_friction import mean_speed as exact_speed
from reference.kinked_bar import obeys_laws

from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop

# Does the motion converge with the number of arcs or chords a curve is drawn with?


@pytest.mark.parametrize("curve", [Oval(), Harmonic()])
@pytest.mark.parametrize(("chords", "order"), [(False, 3.0), (True, 1.0)])
@pytest.mark.parametrize("restitution", [0.0, 0.3])
def test_arcs_converge_at_third_and_chords_at_first_order(curve: Curve, chords: bool, order: float, restitution: float) -> None:
    runs = [compared(FlatCam(curve), count, chords, restitution) for count in (32, 128)]
    assert all(run.stop == "DURATION" and abs(run.residual) < 1e-6 for run in runs)
    assert runs[0].angle / runs[1].angle == pytest.approx(4.0**order, rel=0.3)
    assert runs[1].events / runs[1].passed < 1.1 * runs[0].events / runs[0].passed


@pytest.mark.parametrize("count", [2, 3, 5, 400])
def test_few_and_many_arcs_run_to_the_end(count: int) -> None:
    run = compared(FlatCam(Oval()), count, False, 0.2)
    assert run.stop == "DURATION" and abs(run.residual) < 1e-6


# Does a gear train's mean speed depend on the arcs its flanks are drawn with?

SHORT = 0.215  # modules off the tips: one pair of teeth at a time


def speed(arcs: int, friction: float, cut: float = 0.0, tolerance: float = 1e-9, duration: float = 0.2) -> float:
    run = simulate(gear_scene(arcs, friction, cut=cut), duration, tolerance=tolerance)
    assert run.stop == Stop.DURATION
    assert abs(run.energy["residual_relative"]) < 1e-6
    return mean_speed(run, 1, TEETH[1], 0.12)


def test_without_friction_the_speed_is_that_of_exact_involutes() -> None:
    assert speed(6, 0.0) == pytest.approx(exact_speed(train(0.0), FASTEST), rel=1e-4)


def test_one_pair_of_teeth_with_friction_turns_as_exact_involutes_do() -> None:
    assert contact_ratio(SHORT) == pytest.approx(1.0, abs=1e-4)
    assert speed(10, 0.1, SHORT) == pytest.approx(exact_speed(train(0.1, SHORT), SLOWEST), rel=1e-3)


def test_two_pairs_of_teeth_share_within_what_the_laws_leave_open() -> None:
    low, high = (exact_speed(train(0.1), share) for share in (SLOWEST, FASTEST))
    assert low < speed(6, 0.1) < high


@pytest.mark.slow
@pytest.mark.parametrize("arcs", [6, 10, 20])
def test_the_speed_does_not_depend_on_the_tolerance(arcs: int) -> None:
    speeds = [speed(arcs, 0.1, tolerance=tolerance) for tolerance in (1e-7, 1e-9, 1e-11)]
    assert max(speeds) / min(speeds) < 1.0 + 1e-5


@pytest.mark.slow
def test_one_tooth_is_like_the_next() -> None:
    run = simulate(gear_scene(10, 0.1), 0.3)
    times = tooth_times(run, 1, TEETH[1], 0.2)
    lasted = [b - a for a, b in itertools.pairwise(times)]
    assert max(lasted) / min(lasted) < 1.0 + 1e-7


# Is what is lost at a kink between edges what the laws of contact say, from 1e-10 rad to 90 degrees?


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


# Does a mechanism move the same way however it lies in the plane and however its parts are drawn?

SLOW = ("gears, two arcs a flank", "Swiss lever")


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow if name in SLOW else ()) for name in MECHANISMS])
def test_the_motion_does_not_depend_on_the_orientation(name: str) -> None:
    scene, rng = mechanism(name), np.random.default_rng(3)
    truth = seen(scene, 0.0, (0.0,) * len(scene.bodies))
    assert not truth.bad
    quarters = [(0.5 * math.pi * k, (0.0,) * len(scene.bodies)) for k in (1, 2)]
    for pose in [*quarters, *(random_pose(scene, rng) for _ in range(2))]:
        found = seen(scene, *pose)
        assert not found.bad
        assert apart(truth, found) < 1e-9, pose


def test_posing_moves_no_point_of_the_mechanism() -> None:
    """A point of each outline, placed by hand, before and after."""
    scene = mechanism("ratchet")
    world, drawn = 1.1, (0.7, -2.0)
    for body, moved in zip(scene.bodies, posed(scene, world, drawn).bodies, strict=True):
        before = complex(*body.position) + complex(*body.loops[0].edges[0].start) * np.exp(1j * body.angle)
        after = complex(*moved.position) + complex(*moved.loops[0].edges[0].start) * np.exp(1j * moved.angle)
        assert abs(after - before * np.exp(1j * world)) < 1e-15
