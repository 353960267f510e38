"""Are missed beats counted and standing watches noticed?"""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from analysis.made_beats import DEGREE, lever_run, lever_scene
from render.fake_runs import disc_run, watch_run

from watchsim.analysis.summary import summary, summary_text
from watchsim.analysis.timing import escape_wheel
from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.escape_wheel import Advance, advance, missed_beats, progress
from watchsim.analysis.timing.rows_at_hand import is_recorded
from watchsim.analysis.timing.standstill import standstill
from watchsim.commands.common.run_pictures import filmed, last_beats
from watchsim.scene.roles import Roles, drive_direction, keeps_time, partners, roles


def test_roles_follow_from_springs_drives_and_contacts():
    scene = lever_scene()
    assert roles(scene) == Roles("balance", "wheel", "lever")
    assert drive_direction(scene, "wheel") == -1.0 and partners(scene, "lever") == {"wheel", "balance", "banking"}
    assert roles(replace(scene, contacts=scene.contacts[1:])) == Roles("balance", "wheel", None)
    assert roles(replace(scene, torques=())) == Roles("balance", None, None)
    assert roles(disc_run().scene) == Roles(None, None, None)


def test_a_drive_given_as_a_table():
    scene = lever_scene()
    table = replace(scene.torques[0], value=0.0, over="angle", table=((-1.0, -2e-6), (0.0, -1e-6)))
    assert drive_direction(replace(scene, torques=(table,)), "wheel") == -1.0


def test_the_wheel_goes_half_a_pitch_per_half_swing():
    run = lever_run(20)
    found = beats(run)
    moved = advance(run, "wheel", found)
    assert moved.half_pitch == pytest.approx(12.0 * DEGREE) and moved.steps == pytest.approx(np.ones(19), abs=1e-6)
    assert progress(run, "wheel", np.array([run.t[-1]]))[0] == pytest.approx(20 * 12.0 * DEGREE, rel=1e-9)
    assert missed_beats(run, "wheel", found) == 0 and standstill(run, found) is None


@pytest.mark.parametrize("missed", [(5,), (5, 6, 11), tuple(range(3, 9))])
def test_missed_beats(missed):
    run = lever_run(20, missed=missed)
    assert missed_beats(run, "wheel", beats(run)) == len(missed)


def test_beats_missed_before_the_recorded_window_are_counted():
    for missed in ((), (4, 5, 6, 9)):
        run = lever_run(40, missed=missed, rows_from=4.0)
        found = beats(run)
        assert len(found) == 39 and run.t[0] >= 4.0
        # Which side of the wheel's start the first half swing belongs to is not known: one beat may be forgiven.
        assert len(missed) - 1 <= missed_beats(run, "wheel", found) <= len(missed)


def test_what_is_not_recorded_is_said():
    run = lever_run(40, rows_from=4.0)
    assert is_recorded(run, np.array([0.0, 3.99, 4.5, 5.0, 5.1])).tolist() == [False, False, True, True, False]
    gap = (run.t < 4.2) | (run.t > 4.5)
    parts = replace(run, t=run.t[gap], q=run.q[gap], u=run.u[gap], a=run.a[gap])
    assert is_recorded(parts, np.array([4.1, 4.3, 4.6])).tolist() == [True, False, True]
    nothing = replace(run, t=run.t[:0], q=run.q[:0], u=run.u[:0], a=run.a[:0])
    assert not is_recorded(nothing, np.array([1.0])).any() and missed_beats(nothing, "wheel", beats(nothing)) is None


def test_a_wheel_without_teeth_misses_nothing_that_is_known():
    run = lever_run(20)
    bare = tuple(replace(body, loops=()) for body in run.scene.bodies)
    assert missed_beats(replace(run, scene=replace(run.scene, bodies=bare)), "wheel", beats(run)) is None


def test_a_watch_that_stops():
    run = lever_run(20, missed=range(12, 20))
    stands = standstill(run, beats(run))
    # The lock of beat 11 (from 0) is the last that moves the wheel.
    lock = 11.5 * 0.125 + math.asin(22.5 / 270.0) / (8.0 * math.pi)
    assert stands.since == pytest.approx(lock, abs=3e-3)
    assert stands.message.startswith("the escape wheel has stood still since t = 1.4")
    assert (
        "last amplitude 270°" in stands.message and "in contact: wheel.TEETH corner 3 / lever.STONES line 1" in stands.message
    )


def test_two_missed_beats_are_no_standstill():
    run = lever_run(20, missed=(18, 19))
    assert standstill(run, beats(run)) is None


def test_a_watch_that_stops_unseen():
    """Rows are not kept at the end: the passages tell."""
    ticking = lever_run(20)
    early = ticking.t < 1.0
    cut = replace(ticking, t=ticking.t[early], q=ticking.q[early], u=ticking.u[early], a=ticking.a[early])
    assert standstill(cut, beats(cut)) is None
    silent = replace(cut, events=cut.events[cut.events["t"] < 1.0])
    assert standstill(silent, beats(silent)).since == pytest.approx(0.9375)


def test_short_runs_and_other_mechanisms_do_not_stand():
    short = lever_run(2)
    assert standstill(short, beats(short)) is None
    free = replace(lever_run(20), scene=replace(lever_scene(), torques=()))
    assert standstill(free, beats(free)) is None
    assert not watch_run().scene.springs


def test_a_ratchet_that_rests_is_no_watch_that_stopped():
    """A driven wheel held by a sprung body alone: only a lever between them, or a lift angle, makes it an escapement."""
    run = lever_run(20, missed=range(12, 20))
    ratchet = replace(run.scene, contacts=run.scene.contacts[1:], lift_angle=None)
    assert keeps_time(run.scene) and not keeps_time(ratchet) and keeps_time(replace(ratchet, lift_angle=1.0))
    assert keeps_time(replace(ratchet, torques=())) and not keeps_time(replace(ratchet, springs=()))
    held = replace(run, scene=ratchet)
    assert standstill(held, beats(held)) is None and standstill(run, beats(run)) is not None
    told = {numbers["stopped"]: summary_text(one, numbers) for one in (held, run) for numbers in (summary(one),)}
    assert re.search(r"wheel +at −\d+\.\d+° at the end", told[False]) and "missed beats" not in told[False]
    assert "at the end" not in told[True] and "missed beats" in told[True]


def test_the_movie_of_a_run_shows_the_last_swing_or_all_of_a_ratchet():
    run = lever_run(20)
    (start, end), speed = filmed(run, 1 / 20)
    assert end == run.t[-1] and end - start == pytest.approx(1.1 * 0.25) and speed == 1 / 20
    ratchet = replace(run, scene=replace(run.scene, contacts=run.scene.contacts[1:], lift_angle=None))
    assert last_beats(ratchet) == (pytest.approx(0.9 * run.t[-1]), run.t[-1])
    (start, end), speed = filmed(ratchet, 1 / 20)
    assert (start, end) == (run.t[0], run.t[-1]) and (end - start) / speed == pytest.approx(10.0)


@pytest.mark.parametrize(("first", "missed"), [(5, 0), (4, 0), (6, 0), (2, 2), (7, 1), (8, 2)])
def test_beats_missed_before_the_first_window(monkeypatch: pytest.MonkeyPatch, first: int, missed: int) -> None:
    """At the fourth turning point the wheel should have come five half pitches, one more or less."""
    came = Advance(0.2, np.arange(4.0, 9.0), 0.2 * (first + np.arange(5.0)))
    monkeypatch.setattr(escape_wheel, "advance", lambda *_: came)
    run = lever_run(6)
    assert missed_beats(run, "wheel", beats(run)) == missed


@pytest.mark.parametrize(
    ("share", "word"), [(0.45, "balance swinging, now at −90°"), (0.55, "balance held at −90° since t = ")]
)
def test_a_balance_that_has_not_moved_for_half_a_period_is_held(share, word):
    run = lever_run(20, missed=range(12, 20))
    still = run.t > run.simulated - share * 0.25
    q = run.q.copy()
    q[:, 0] = np.where(still, -0.5 * math.pi, 0.0)
    held = replace(run, q=q)
    assert word in standstill(held, beats(held)).message


def test_of_no_instant_there_is_no_progress():
    run = lever_run(4)
    assert progress(run, "wheel", np.zeros(0)).shape == (0,)


@pytest.mark.parametrize("gap", range(4))
def test_wherever_rows_lie_far_apart_nothing_is_recorded_between(gap):
    """Also between the first two of them, and the last two."""
    run = lever_run(4)
    t = np.cumsum([0.0, *(0.9 if k == gap else 0.01 for k in range(4))])
    zeros = np.zeros((5, run.q.shape[1]))
    run = replace(run, t=t, q=zeros, u=zeros, a=zeros)
    middles = 0.5 * (t[:-1] + t[1:])
    assert is_recorded(run, middles).tolist() == [k != gap for k in range(4)] and is_recorded(run, t).all()
    assert not is_recorded(run, np.array([-1e-9, t[-1] + 1e-9])).any()
