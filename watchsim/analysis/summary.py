"""What are the headline numbers of a run?

One mapping for programs, with the names of summary.json; the text for people and the tables beside it are made from the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from watchsim.analysis.escape_wheel import missed_beats, never_touched, not_held, standstill, why_no_timing
from watchsim.analysis.expectations import judged
from watchsim.analysis.flows import efficiency
from watchsim.analysis.headlines import beats_csv, doubts, headlines, phases_csv
from watchsim.analysis.timegrapher import timegrapher
from watchsim.analysis.timing import Averages, averages, beats, last_window, whole_run
from watchsim.analysis.verdict import NOTHING_LOCKS, RUNS_THROUGH, verdict
from watchsim.analysis.verdict_kinds import NOTHING, Verdict
from watchsim.mechanism.check import notes
from watchsim.results.folder import versions
from watchsim.results.tables import plain
from watchsim.scene.roles import keeps_time, roles, swings, timekeeper
from watchsim.simulation import MOREAU
from watchsim.simulation.runner import Progress
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory, frames, speeds
from watchsim.storage.columns import LongText

# The run is done again, a hundred times more exactly (by events) or with half the step (Moreau, where the error of the first
# run is then twice the difference, since it goes with the step). What moves is the error of the computation. That a watch has
# not settled yet is another error; of the two the larger is given.

TIGHTER, TIGHTEST = 0.01, 1e-13
NUMBERS = ("amplitude_deg", "period_s", "rate_s_per_d", "beat_error_ms")


def more_exact(run: Trajectory, progress: Progress | None = None, stream: Path | None = None) -> Trajectory:
    """The same motion once more, more exactly."""
    if run.method == MOREAU and run.step is not None:
        step = 0.5 * run.step
        return simulate(run.scene, run.simulated, run.tolerance, progress=progress, method=MOREAU, step=step, stream=stream)
    return simulate(run.scene, run.simulated, max(TIGHTER * run.tolerance, TIGHTEST), progress=progress, stream=stream)


def with_error_bars(numbers: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """The summary `numbers` with the differences to `other`, the summary of the more exact run, as errors.

    Each `..._error` becomes at least the difference (where beats are too few to show their scatter, it stays None: how exactly
    they were computed, `differences` says), every end state gets an error beside it, and `error_bars` says what was
    compared; its `complete` is False where the more exact run did not come to its end, and no error is given then.
    """
    share = 2.0 if numbers["method"] == MOREAU else 1.0
    said = {name: other[name] for name in ("tolerance", "step_s", "stop", "wall_s")}
    if other["stop"] != Stop.DURATION.name:
        return {**numbers, "error_bars": {**said, "complete": False}}
    out = dict(numbers)
    moved = {}
    for name in NUMBERS:
        if numbers[name] is None or other[name] is None:
            continue
        moved[name] = share * abs(numbers[name] - other[name])
        if numbers[f"{name}_error"] is not None:
            out[f"{name}_error"] = max(moved[name], numbers[f"{name}_error"])
    out["bodies"] = {
        body: {**state, **{f"{name}_error": share * abs(value - other["bodies"][body][name]) for name, value in state.items()}}
        for body, state in numbers["bodies"].items()
    }
    out["error_bars"] = {**said, "complete": True, "differences": moved}
    return out


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
    (share of the drive's work that reaches the oscillator, over `window_s`; `energy` is of the whole run).
    """
    numbers: dict[str, Any] = {**_about(run), "bodies": _bodies(run), **_counts(run), **_timing(run)}
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
    found = {}
    for body in run.scene.bodies:
        (x, y, angle), (v_x, v_y, spin) = places[body.name][0].tolist(), rates[body.name][0].tolist()
        pose, motion = {"angle_rad": angle, "x_m": x, "y_m": y}, {"angle_rad_per_s": spin, "x_m_per_s": v_x, "y_m_per_s": v_y}
        found[body.name] = pose | motion
    return found


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
        unknown = dict.fromkeys(("whole_run", "timegrapher", "missed_beats"))
        nothing = {"beats": 0, **unknown, "stopped": False, "stopped_message": None}
        values = {**_timing_of(None), **nothing, **_judgement(NOTHING)}
        return {**values, "timing_message": why_no_timing(run, None, values), "efficiency": None}
    found = beats(run)
    window = last_window(run, found.nominal_period)
    stands, judged = standstill(run, found), verdict(run, found)
    idle = _keeps_nothing_going(run, judged)
    values = _timing_of(None if idle else averages(found, window))
    return {
        **values,
        "timing_message": idle or why_no_timing(run, found, values, window[0]),
        "beats": found.before + len(found),
        "whole_run": whole_run(run, found),
        "timegrapher": None if idle else timegrapher(run, found, window),
        "missed_beats": None if idle else _missed(run),
        "stopped": stands is not None,
        "stopped_message": stands.message if stands else None,
        **_judgement(judged),
        "efficiency": None if idle else efficiency(run, found, window),
    }


def _keeps_nothing_going(run: Trajectory, found: Verdict) -> str | None:
    """Why amplitude and rate are not those of a watch: nothing touched, or the wheel runs through; None where it may be one."""
    parts, idle, judged = roles(run.scene), never_touched(run), found.message
    if idle is None and found.name is None and (why := not_held(run)) is not None:
        return f"no amplitude and rate: {why}"
    if idle is None and judged and RUNS_THROUGH in judged:
        kind = timekeeper(run.scene)
        why = f"nothing locks {parts.wheel}, and {parts.oscillator} swings by itself"
        if NOTHING_LOCKS not in judged:
            why = f"{parts.wheel} {RUNS_THROUGH} when it is unlocked"
        return f"no amplitude and rate of a {kind}: {why}"
    return idle


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


def _missed(run: Trajectory) -> int | None:
    return missed_beats(run) if roles(run.scene).wheel and keeps_time(run.scene) else None
