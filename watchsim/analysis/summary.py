"""What are the headline numbers of a run?

One mapping for programs, with the names of summary.json; the text for people and the tables beside it are made from the same.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from watchsim.analysis.escape_wheel import missed_beats, never_touched, standstill, why_no_timing
from watchsim.analysis.flows import efficiency
from watchsim.analysis.headlines import beats_csv, doubts, headlines, phases_csv
from watchsim.analysis.timegrapher import timegrapher
from watchsim.analysis.timing import Averages, averages, beats, last_window, whole_run
from watchsim.analysis.verdict import NOTHING_LOCKS, RUNS_THROUGH, verdict
from watchsim.analysis.verdict_kinds import NOTHING, Verdict
from watchsim.mechanism.check import notes
from watchsim.results.folder import versions
from watchsim.results.tables import plain
from watchsim.scene.keys import ALIKE
from watchsim.scene.read_settings import FUNCTION
from watchsim.scene.roles import keeps_time, roles, swings, timekeeper
from watchsim.scene.scene import Expectation
from watchsim.simulation import MOREAU
from watchsim.simulation.runner import Progress
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory, frames, speeds
from watchsim.storage.columns import LongText
from watchsim.units import known_unit

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


# Keys are watch quantities (amplitude, rate, period, beat_error, frequency) or dotted names of the summary, such as
# "bodies.disc.x_m" or "energy.residual_relative". Units come from the ends of these names.

WATCH_KEYS = {
    "amplitude": "amplitude_deg",
    "rate": "rate_s_per_d",
    "period": "period_s",
    "beat_error": "beat_error_ms",
    "frequency": "frequency_hz",
    **{name: f"function.{name}_deg" for name in FUNCTION},
}
# Longest first: "_s_per_d" must not pass for "_d".
ENDINGS = {
    **{"_rad_per_s": "rad/s", "_m_per_s": "m/s", "_s_per_d": "s/d"},
    **{"_deg": "°", "_rad": "rad", "_vph": "vph", "_hz": "Hz", "_ms": "ms", "_s": "s", "_m": "m", "_J": "J"},
}
ERROR = "_error"
KNOWN = f"Known names: {', '.join(WATCH_KEYS)} and the names in summary.json."
MOST_ADVISED = 20  # wrong keys for which a similar one is looked for: each takes a hundredth of a second


def judged(expectations: Sequence[Expectation], numbers: Mapping[str, Any]) -> list[dict[str, Any]]:
    """{key, expected, tolerance, got, ok, unit, message} of each, in the unit of the promise; `message`: why `got` is None."""
    known = dict(_numbers(numbers))
    return [_judged(expectation, known) for expectation in expectations]


def _judged(expectation: Expectation, known: Mapping[str, float | None]) -> dict[str, Any]:
    got, message = _found(expectation, known)
    low, high = expectation.bounds
    if got is not None and expectation.low is expectation.high:
        ok: bool | None = abs(got - expectation.value) <= expectation.tolerance
    else:
        ok = got is not None and low <= got <= high
    return {
        "key": expectation.key,
        "expected": expectation.value,
        "tolerance": expectation.tolerance,
        **({} if expectation.low is expectation.high else {"min": expectation.low, "max": expectation.high}),
        "got": got,
        "ok": None if expectation.key in FUNCTION else ok,
        "unit": expectation.unit,
        "message": message,
    }


def not_judged(entry: Mapping[str, Any], changed: Sequence[str]) -> dict[str, Any]:
    """An entry of `judged` without a verdict (`ok` is null): options made the run another than the scene's own."""
    return {**entry, "ok": None, "message": f"not checked: changed by {' and '.join(changed)}"}


def unit_of(name: str) -> str:
    """The unit a dotted name of the summary ends with; "" for plain numbers."""
    if name.startswith("energy.dissipated."):
        return "J"
    last = name.removesuffix(ERROR)
    return next((unit for ending, unit in ENDINGS.items() if last.endswith(ending)), "")


def mistakes(expectations: Sequence[Expectation], numbers: Mapping[str, Any]) -> list[str]:
    """Of each what is wrong with the key or the unit, whatever the run; "" for nothing. What is null may hold numbers later."""
    known = dict(_numbers(numbers))
    found: list[str] = []
    wrong = 0
    for expectation in expectations:
        found.append(_mistake(expectation, known, advised=wrong < MOST_ADVISED))
        wrong += bool(found[-1])
    return found


def _mistake(expectation: Expectation, known: Mapping[str, float | None], advised: bool = True) -> str:
    name = _name(expectation)
    if name not in known and expectation.key not in FUNCTION and not _within_null(name, known):
        return f'"{expectation.key}" is not a number in the results. {_advice(expectation.key, known) if advised else KNOWN}'
    source = unit_of(name)
    if expectation.unit and known_unit(source).powers != known_unit(expectation.unit).powers:
        return f'"{expectation.key}" is in {source or "plain numbers"}, which cannot be compared with {expectation.unit}'
    return ""


def _within_null(name: str, known: Mapping[str, float | None]) -> bool:
    """Whether something above the dotted name is null, and may hold numbers in another run."""
    parts = name.split(".")
    return any(known.get(".".join(parts[:k]), 0.0) is None for k in range(1, len(parts)))


def _name(expectation: Expectation) -> str:
    return WATCH_KEYS.get(expectation.key, expectation.key)


def _found(expectation: Expectation, known: Mapping[str, float | None]) -> tuple[float | None, str]:
    """The number in the expectation's unit, or None and what is wrong."""
    if message := _mistake(expectation, known):
        return None, message
    value = known.get(_name(expectation))
    if expectation.key in FUNCTION:
        return None, "not checked: watchsim tolerance measures the geometry of function"
    if value is None:
        return None, f'this run gives no "{expectation.key}"'
    if not expectation.unit:
        return value, ""
    return value * known_unit(unit_of(_name(expectation))).factor / known_unit(expectation.unit).factor, ""


def _numbers(mapping: Mapping[str, Any], above: str = "") -> list[tuple[str, float | None]]:
    """(dotted name, value) of all numbers and of what is null."""
    found: list[tuple[str, float | None]] = []
    for key, value in mapping.items():
        name = f"{above}{key}"
        if isinstance(value, Mapping):
            found += _numbers(value, f"{name}.")
        elif value is None:
            found.append((name, None))
        elif isinstance(value, (int, float)):
            found.append((name, float(value) if math.isfinite(value) else None))
    return found


def _advice(key: str, known: Mapping[str, Any]) -> str:
    names = [*WATCH_KEYS, *known]
    near = difflib.get_close_matches(key, names, n=1, cutoff=ALIKE)
    return f'Did you mean "{near[0]}"?' if near else KNOWN


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
    idle = _keeps_nothing_going(run, judged.message)
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


def _keeps_nothing_going(run: Trajectory, judged: str | None) -> str | None:
    """Why amplitude and rate are not those of a watch: nothing touched, or the wheel runs through; None where it may be one."""
    parts, idle = roles(run.scene), never_touched(run)
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
