"""What are the headline numbers of a run?

One mapping for programs, with the names of summary.json; the text for people and the tables beside it are made from the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.beat_tables import beats_csv, phases_csv
from watchsim.analysis.doubts import doubts
from watchsim.analysis.efficiency import efficiency
from watchsim.analysis.expectations import judged
from watchsim.analysis.headlines import headlines
from watchsim.analysis.timing.averages import Averages, averages, last_window
from watchsim.analysis.timing.beats import Beats, beats
from watchsim.analysis.timing.escape_wheel import missed_beats
from watchsim.analysis.timing.no_timing import why_no_timing
from watchsim.analysis.timing.standstill import standstill
from watchsim.analysis.timing.timegrapher import timegrapher
from watchsim.analysis.timing.whole_run import whole_run
from watchsim.analysis.verdicts.verdict import verdict
from watchsim.analysis.verdicts.verdict_kinds import NOTHING, Verdict
from watchsim.mechanism.notes import notes
from watchsim.results.provenance import versions
from watchsim.results.tables import plain
from watchsim.scene.roles import keeps_time, roles, swings
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.body_frames import frames, speeds
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.long_text import LongText

AVERAGED = ("amplitude_deg", "period_s", "rate_s_per_d", "beat_error_ms")
LEDGER = {"in_J": 0.0, "dissipated": {}, "stored_J": 0.0, "residual_J": 0.0, "residual_relative": 0.0}


def summary(run: Trajectory) -> dict[str, Any]:
    """The numbers of summary.json and of `run --json`, null for what the run does not give.

    `forces_unique` is False where contacts were redundant at some event: motion and energy are unique then, the forces of
    single contacts are the smallest possible ones.

    Besides the promised names: `frequency_hz`, `vph`, `window_s` (over which was averaged), `beats` (half swings in all),
    `whole_run` (mean, spread and extremes of all, see analysis/timing/whole_run.py), `kept` (all, events or statistics),
    `verdict`, `verdict_message` and `verdict_details` (what the watch does, see analysis/verdicts/verdict.py; null where
    nothing keeps time), `missed_beats`, `stopped` and `stopped_message` (the wheel stands), `scene_file`, `stop_message`,
    `events_by_kind`, `counts`, `overlap` (what looking at the outlines found, see simulation/record/overlap_watch.py),
    `step_s` (of a method with fixed steps), `worst_complementarity_residual` (worst violation of a complementarity condition,
    as a share of the problem's largest term), `warnings` (sentences, see analysis/doubts.py), `notes` (what the scene leaves
    unsaid or says without effect, see mechanism/notes.py), `timing_message` (why there is no amplitude or rate), `efficiency`
    (share of the drive's work that reaches the oscillator).
    """
    numbers: dict[str, Any] = {**_about(run), "bodies": _bodies(run), **_counts(run), **_timing(run)}
    numbers["efficiency"] = efficiency(run)
    numbers["expect"] = judged(run.scene.expect, numbers)
    numbers["warnings"] = list(doubts(run))
    numbers["notes"] = [finding.message for finding in notes(run.scene)]
    numbers["versions"] = versions()
    clean: dict[str, Any] = plain(numbers)
    return clean


def summary_text(run: Trajectory, numbers: Mapping[str, Any] | None = None) -> str:
    """The same for people, in watchmakers' units; `numbers` as from `summary(run)` where already at hand."""
    return headlines(run, summary(run) if numbers is None else numbers)


def tables(run: Trajectory, folder: Path | None = None) -> dict[str, LongText]:
    """The tables of a results folder besides events.csv: name -> text, in files in `folder` where it is long."""
    if not swings(run.scene):
        return {}
    found = beats(run)
    return {"beats.csv": LongText(beats_csv(found), folder), "phases.csv": LongText(phases_csv(run, found), folder)}


def _about(run: Trajectory) -> dict[str, Any]:
    return {
        "scene": run.scene.title,
        "scene_file": str(run.scene.path) if run.scene.path else None,
        "method": run.method,
        "tolerance": run.tolerance,
        "step_s": run.step,
        "simulated_s": run.simulated,
        "wall_s": run.wall,
        "compile_s": run.compile,
        "realtime_factor": run.simulated / run.wall if run.wall > 0.0 else None,
        "kept": run.keep,
        "stop": run.stop,
        "stop_message": run.stop_message,
    }


def _bodies(run: Trajectory) -> dict[str, dict[str, float]]:
    """Pose and velocities of every body in the movement at the end."""
    if run.end is None:
        return {}
    q, u = run.end
    places, rates = frames(run.scene, run.slices, q[None]), speeds(run.scene, run.slices, q[None], u[None])
    return {body.name: _state(places[body.name][0], rates[body.name][0]) for body in run.scene.bodies}


def _state(place: NDArray[np.float64], rate: NDArray[np.float64]) -> dict[str, float]:
    (x, y, angle), (v_x, v_y, spin) = place.tolist(), rate.tolist()
    return {"angle_rad": angle, "x_m": x, "y_m": y, "angle_rad_per_s": spin, "x_m_per_s": v_x, "y_m_per_s": v_y}


def _counts(run: Trajectory) -> dict[str, Any]:
    kinds = run.sums.get("events_by_kind") or {kind.name.lower(): int((run.events["kind"] == kind).sum()) for kind in EventKind}
    return {
        "impacts": run.counts.get("impacts", kinds["impact"]),
        "events": run.counts.get("events", len(run.events)),
        "lcp_failures": run.counts.get("lcp_failures", 0),
        "events_by_kind": kinds,
        "forces_unique": run.counts.get("redundant_sets", 0) == 0,
        "counts": dict(run.counts),
        "worst_penetration_m": run.worst_penetration,
        "worst_overlap_m": run.worst_overlap,
        "overlap": dict(run.overlap),
        "worst_complementarity_residual": run.worst_residual,
        "energy": {**LEDGER, **run.energy},
    }


def _timing(run: Trajectory) -> dict[str, Any]:
    """Amplitude, period, rate, beat error and what follows from them; null where nothing oscillates."""
    if not swings(run.scene):
        nothing = {
            "beats": 0,
            "whole_run": None,
            "timegrapher": None,
            "missed_beats": None,
            "stopped": False,
            "stopped_message": None,
            **_judgement(NOTHING),
        }
        values = _timing_of(None) | nothing
        return {**values, "timing_message": why_no_timing(run, None, values)}
    found = beats(run)
    window = last_window(run, found.nominal_period)
    stands = standstill(run, found)
    values = _timing_of(averages(found, window))
    return {
        **values,
        "timing_message": why_no_timing(run, found, values, window[0]),
        "beats": found.before + len(found),
        "whole_run": whole_run(run, found),
        "timegrapher": timegrapher(run, found, window),
        "missed_beats": _missed(run, found),
        "stopped": stands is not None,
        "stopped_message": stands.message if stands else None,
        **_judgement(verdict(run, found)),
    }


def _judgement(found: Verdict) -> dict[str, Any]:
    about = {"t_s": found.t, "body": found.body, "pair": found.pair, "torque_Nm": found.torque, "count": found.count}
    return {
        "verdict": found.name,
        "verdict_message": found.message,
        "verdict_details": None if found.name is None else {**about, "works": found.works},
    }


def _timing_of(means: Averages | None) -> dict[str, Any]:
    values = asdict(means) if means else {}
    period = values.get("period_s")
    return {
        **{key: values.get(key) for name in AVERAGED for key in (name, f"{name}_error")},
        "frequency_hz": 1.0 / period if period else None,
        "vph": 7200.0 / period if period else None,
        "window_s": [means.start_s, means.end_s] if means else None,
    }


def _missed(run: Trajectory, found: Beats) -> int | None:
    wheel = roles(run.scene).wheel
    return missed_beats(run, wheel, found) if wheel and keeps_time(run.scene) else None
