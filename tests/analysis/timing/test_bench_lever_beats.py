"""What is read from a simulated lever escapement, against other engines and against the drawing?

The bench lever is drawn with 2.0° of lock and 0.5° of run at the lever, 5.5° from the middle to the bank, 15 pointed teeth;
three other engines found 283.01° and 0.25007014 s between 1 s and 3 s (at 0.04° from each other), 290.73° and 0.25006568 s
between 13 s and 15 s.
"""

from __future__ import annotations

import json
import math
from itertools import pairwise

import numpy as np
import pytest

import watchsim as ws
from watchsim.analysis.summary import summary, summary_text, tables
from watchsim.analysis.timing.averages import mean_over
from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.phases import phases
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.simulation.simulate import simulate

NAMES = ["unlock", "catch-up", "impulse", "drop", "run to banking", "locked"]


def test_beats_agree_with_other_engines(bench_lever):
    means = mean_over(bench_lever, (1.0, 3.0))
    assert means.amplitude_deg == pytest.approx(283.01, abs=0.6)  # it still grows by 3° within the window
    assert means.period_s == pytest.approx(0.25007014, abs=1e-6)
    assert means.amplitude_deg_error > 0.6  # and says so


@pytest.mark.slow
def test_the_settled_window():
    run = simulate(load(profiles_dir() / "bench_lever" / "scene.toml"), duration=15.0)
    means = mean_over(run, (13.0, 15.0))
    assert means.amplitude_deg == pytest.approx(290.73, abs=0.05) and means.amplitude_deg_error < 0.02
    assert means.period_s == pytest.approx(0.25006568, abs=1e-6) and means.period_s_error < 1e-8
    assert summary(run)["missed_beats"] == 0


def test_amplitudes_are_those_of_the_recorded_motion(bench_lever):
    found = beats(bench_lever)
    column = bench_lever.slices["balance"].start
    assert bench_lever.sample(found.end)[0][:, column] == pytest.approx(found.end_at, abs=1e-9)
    assert bench_lever.sample(found.end)[1][:, column] == pytest.approx(0.0, abs=1e-6)
    assert bench_lever.sample(found.t)[0][:, column] == pytest.approx(0.0, abs=1e-8)


def test_every_beat_is_heard_counted_and_told(bench_lever):
    found = ws.beats(bench_lever)
    assert len(found) == 22 and np.isfinite(found.tick).all() and np.diff(found.t).max() < 0.126
    numbers = summary(bench_lever)
    assert numbers["missed_beats"] == 0 and not numbers["stopped"]
    assert numbers["beat_error_ms"] < 0.02 and numbers["timegrapher"]["amplitude_deg"] > numbers["amplitude_deg"]
    assert json.loads(json.dumps(numbers, allow_nan=False)) == numbers
    assert "missed beats none in 22 half swings" in summary_text(bench_lever, numbers)
    assert len(str(tables(bench_lever)["beats.csv"]).splitlines()) == 23


def test_phases_have_the_angles_of_the_drawing(bench_lever):
    rows = phases(bench_lever)
    assert [row.name for row in rows[:120]] == NAMES * 20
    degrees = {name: [[math.degrees(x) for x in row.turns] for row in rows if row.name == name] for name in NAMES}
    # Total lock, 2.0°, is what the lever turns to unlock; impulse, drop and run bring it to the other bank, 11.0° in all.
    assert [abs(turn[1]) for turn in degrees["unlock"]] == pytest.approx([2.0] * 22, abs=1e-4)
    assert all(turn[0] > 0.2 for turn in degrees["unlock"])  # draw makes the wheel recoil
    for first in range(0, 120, 6):
        beat = rows[first : first + 6]
        assert sum(math.degrees(row.turns[0]) for row in beat) == pytest.approx(-12.0, abs=0.06)  # half a pitch
        assert abs(sum(math.degrees(row.turns[1]) for row in beat)) == pytest.approx(11.0, abs=1e-6)
        assert all(a.end == b.start for a, b in pairwise(beat))
    assert max(abs(turn[1]) for turn in degrees["locked"]) < 1e-9


def test_energy_of_the_run(bench_lever):
    assert bench_lever.energy["residual_relative"] < 1e-8
    wheel = bench_lever.slices["wheel"].start
    assert bench_lever.energy["in_J"] == pytest.approx(
        6e-6 * abs(bench_lever.q[-1, wheel] - bench_lever.q[0, wheel]), rel=1e-9, abs=0.0
    )


def test_a_balance_out_of_beat_by_one_and_a_half_degrees():
    """(T1 - T2)/2 = 2 asin(offset/amplitude)/w, 0.42 ms here."""
    scene = load(profiles_dir() / "bench_lever" / "scene.toml").set("springs.0.rest", "1.5°")
    means = mean_over(simulate(scene, duration=3.0), (2.0, 3.0))
    expected = 1e3 * 2.0 * math.asin(1.5 / means.amplitude_deg) / (8.0 * math.pi)
    assert means.beat_error_ms == pytest.approx(expected, rel=0.04)
    assert means.beat_error_ms_error < 0.01 * expected
