"""Are the phases of a beat those that were put into it?"""

from __future__ import annotations

import csv
import math
from dataclasses import replace

import numpy as np
import pytest
from analysis.made_beats import BANKED, CATCH, DEGREE, DROP, ENTRY, LOCK, OMEGA, UNLOCKED, lever_run, lever_scene
from render.fake_runs import disc_run

from watchsim.analysis.beat_tables import PHASE_COLUMNS, beats_csv, phases_csv
from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.phases import phases

NAMES = ("unlock", "catch-up", "impulse", "drop", "run to banking", "locked")
PLACES = (ENTRY, UNLOCKED, CATCH, DROP, LOCK, BANKED)


def time_of(place: float, middle: float) -> float:
    return middle + math.asin(place / 270.0) / OMEGA


def test_phases_of_the_made_lever():
    run = lever_run(12)
    found = beats(run)
    rows = phases(run, found)
    assert [row.name for row in rows] == [*NAMES * 11][:-1]  # the last beat is not followed by another
    assert [row.beat for row in rows[:7]] == [1] * 6 + [2]
    for first in (0, 6, 30):
        middle = found.t[rows[first].beat - 1]
        starts = [time_of(place, middle) for place in PLACES]
        assert [row.start for row in rows[first : first + 6]] == pytest.approx(starts, abs=1e-12)
        assert [row.end for row in rows[first : first + 6]] == pytest.approx([*starts[1:], starts[0] + 0.125], abs=1e-12)


def test_angles():
    """The wheel turns clockwise: recoil is positive, everything else negative."""
    rows = phases(lever_run(12))
    wheel = [math.degrees(row.turns[0]) for row in rows[:6]]
    assert wheel == pytest.approx([0.25, -0.75, -9.5, -2.0, 0.0, 0.0], abs=1e-6)
    # Beat 1 of the table is the run's second half swing: the balance swings back.
    assert math.degrees(rows[0].angles[2]) == pytest.approx(-ENTRY, abs=1e-6)
    assert math.degrees(rows[0].turns[2]) == pytest.approx(ENTRY - UNLOCKED, abs=1e-6)
    lever = [math.degrees(row.angles[1]) for row in rows[:7]]
    assert lever[0] == pytest.approx(-5.0, abs=1e-6) and lever[5] == pytest.approx(5.0, abs=1e-6)
    assert lever == sorted(lever)
    assert math.degrees(rows[6].angles[0]) == pytest.approx(-24.0, abs=1e-6)


def test_a_dead_beat_wheel_waits_and_does_not_recoil():
    run = lever_run(12)
    start = np.round(run.q[:, 2] / (-12.0 * DEGREE)) * (-12.0 * DEGREE)
    q, u = run.q.copy(), run.u.copy()
    recoiling = (q[:, 2] > start + 1e-9) & (q[:, 2] < start + 0.3 * DEGREE)
    q[recoiling, 2], u[:, 2] = start[recoiling], np.where(recoiling, 0.0, u[:, 2])
    rows = phases(replace(run, q=q, u=u))
    assert [row.name for row in rows[:6]] == list(NAMES)
    assert rows[1].start == pytest.approx(time_of(UNLOCKED, beats(run).t[0]), abs=1e-12)


def test_missed_beats_have_no_phases():
    run = lever_run(12, missed=(4, 7))
    numbers = {row.beat for row in phases(run)}
    assert numbers == set(range(1, 12)) - {4, 7}


def test_only_recorded_beats_have_phases():
    run = lever_run(24, rows_from=2.0)
    rows = phases(run)
    assert rows and min(row.start for row in rows) >= 2.0
    assert {row.beat for row in rows} == set(range(16, 24))


def test_other_mechanisms_have_none():
    assert phases(disc_run()) == []
    run = lever_run(6)
    assert phases(replace(run, scene=replace(lever_scene(), torques=()))) == []
    silent = replace(run, events=run.events[run.events["contact"] < 0])
    assert phases(silent) == []


def test_tables():
    run = lever_run(6)
    found = beats(run)
    rows = list(csv.DictReader("".join(beats_csv(found)).splitlines()))
    assert len(rows) == 5 and rows[0]["beat"] == "1" and rows[0]["period_s"] == "" and rows[0]["beat_error_ms"] == ""
    assert float(rows[3]["amplitude_deg"]) == pytest.approx(270.0) and float(rows[3]["t_s"]) == found.t[3]
    assert float(rows[3]["turn_at_deg"]) == pytest.approx(270.0) and float(rows[4]["rate_s_per_d"]) == pytest.approx(
        0.0, abs=1e-6
    )
    table = list(csv.DictReader("".join(phases_csv(run, found)).splitlines()))
    assert tuple(table[0]) == PHASE_COLUMNS and len(table) == 29
    drop = table[3]
    assert drop["phase"] == "drop" and float(drop["wheel_turn_deg"]) == pytest.approx(-2.0, abs=1e-6)
    assert float(drop["duration_ms"]) == pytest.approx(1e3 * (time_of(LOCK, 0.0) - time_of(DROP, 0.0)), rel=1e-9)


def test_a_table_of_beats_goes_on_from_those_before_and_knows_what_slides() -> None:
    """Metres instead of degrees."""
    found = beats(lever_run(6))
    turning, sliding = (
        list(csv.DictReader("".join(beats_csv(replace(found, angular=angular, before=41))).splitlines()))
        for angular in (True, False)
    )
    assert [row["beat"] for row in turning] == [str(k) for k in range(42, 42 + len(found))]
    for row, other in zip(turning, sliding, strict=True):
        for name in ("turn_at", "amplitude"):
            assert float(row[f"{name}_deg"]) == pytest.approx(math.degrees(float(other[f"{name}_m"])), rel=1e-12)
    assert [float(row["amplitude_m"]) for row in sliding] == found.amplitude.tolist()
