"""Do paper tape and tables hold what made-up beats and phases are?"""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import lever_run

from watchsim.analysis import beat_tables
from watchsim.analysis import tape as writing
from watchsim.analysis.beat_tables import beats_csv, phases_csv
from watchsim.analysis.tape import tape
from watchsim.analysis.timing import phases
from watchsim.analysis.timing.beats import Beats, beats

PERIOD = 0.4


def made(count: int, unheard: set[int]) -> tuple[Beats, np.ndarray]:
    """Half swings of some 0.2 s, and the interval from the first to the last loud noise of each, nan in every seventh."""
    rng = np.random.default_rng(count)
    tick = 3.0 + 0.5 * PERIOD * np.arange(count) + rng.uniform(-6e-3, 6e-3, count)
    tick[sorted(unheard)] = np.nan
    turns: Any = rng.uniform(3.0, 4.0, count + 1) * np.array([1.0, -1.0] * count)[: count + 1]
    unused = np.zeros(count)
    found = Beats("balance", True, PERIOD, unused, unused, unused, turns[:-1], turns[1:], tick, unused)
    return found, np.where(np.arange(count) % 7 == 5, np.nan, rng.uniform(0.01, 0.02, count))


@pytest.mark.parametrize(("count", "unheard"), [(30, {0, 8, 9, 17, 20}), (5, set()), (2, set()), (3, {1}), (1, set())])
def test_a_dot_for_each_beat(count: int, unheard: set[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """Rate and beat error only of two beats that follow one another without a gap."""
    found, between = made(count, unheard)
    monkeypatch.setattr(writing, "intervals", lambda run, found: between)
    run: Any = SimpleNamespace(scene=SimpleNamespace(lift_angle=0.9))
    got = tape(run, found)
    heard = [k for k in range(count) if k not in unheard]
    t = {k: float(found.tick[k]) for k in heard}
    assert got.t.tolist() == list(t.values()) and got.nominal_period == PERIOD
    assert got.gain_ms == pytest.approx([1e3 * (0.2 * (k - heard[0]) - (t[k] - t[heard[0]])) for k in heard], abs=1e-9)
    assert got.forward.tolist() == [bool(found.end_at[k] > found.start_at[k]) for k in heard]
    assert got.amplitude_deg == pytest.approx([90.0 / math.pi * abs(found.end_at[k] - found.start_at[k]) for k in heard])
    for i, k in enumerate(heard):
        if {k - 1, k - 2} <= set(heard):
            assert got.rate_s_per_d[i] == pytest.approx(86400.0 * (PERIOD / (t[k] - t[k - 2]) - 1.0), rel=1e-9)
            assert got.beat_error_ms[i] == pytest.approx(500.0 * abs(t[k] - 2.0 * t[k - 1] + t[k - 2]), rel=1e-6)
        else:
            assert math.isnan(got.rate_s_per_d[i]) and math.isnan(got.beat_error_ms[i])
        shown = math.degrees(0.9 / (2.0 * math.sin(math.pi * between[k] / PERIOD)))
        assert got.shown_deg[i] == pytest.approx(shown, nan_ok=True)
    run.scene.lift_angle = None
    assert np.isnan(tape(run, found).shown_deg).all()


def test_without_a_noise_there_is_no_tape() -> None:
    unused: Any = None
    with pytest.raises(ValueError, match="no beat of balance is heard"):
        tape(unused, made(3, {0, 1, 2})[0])


def test_beats_are_written_piece_by_piece(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every number reads back as it is, nothing where it is unknown."""
    monkeypatch.setattr(beat_tables, "ROWS_AT_ONCE", 4)
    found = replace(beats(lever_run(12)), before=30)
    tick, period = found.tick.copy(), found.period_s.copy()
    tick[6], period[7] = np.nan, np.inf
    found = replace(found, tick=tick, period_s=period)
    parts = list(beats_csv(found))
    assert [part.count("\n") for part in parts] == [1, 4, 4, 3]
    rows = list(csv.DictReader("".join(parts).splitlines()))
    columns = {"t_s": found.t, "tick_s": tick, "turn_s": found.end, "turn_at_deg": np.degrees(found.end_at), "period_s": period}
    columns |= {"amplitude_deg": found.amplitude_deg, "rate_s_per_d": found.rate_s_per_d, "beat_error_ms": found.beat_error_ms}
    assert [row["beat"] for row in rows] == [str(31 + k) for k in range(11)]
    for name, column in columns.items():
        for row, value in zip(rows, column.tolist(), strict=True):
            assert row[name] == "" if not math.isfinite(value) else float(row[name]) == pytest.approx(value, rel=1e-15)


def test_the_table_of_phases_comes_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Which together are the table of all beats at once, but for rounding of sums."""
    run = lever_run(12)
    found = beats(run)
    whole = list(csv.reader("".join(phases_csv(run, found)).splitlines()))
    monkeypatch.setattr(phases, "AT_ONCE", 3)
    header, *pieces = phases_csv(run, found)
    assert len(pieces) == 4 and header.startswith("beat,phase,")
    rows = list(csv.reader("".join([header, *pieces]).splitlines()))
    assert len(rows) > 40 and [row[:5] for row in rows] == [row[:5] for row in whole]
