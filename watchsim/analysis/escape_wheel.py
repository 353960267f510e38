"""How far did the escape wheel go, and did it miss a beat?"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from watchsim.analysis.timing import Beats, holding_at_end, is_recorded, nominal_period
from watchsim.scene.roles import (
    drive_direction,
    frequency,
    keeps_time,
    may_lock,
    only_presses,
    oscillators,
    partners,
    pitch,
    roles,
    timekeeper,
)
from watchsim.simulation.recording import FEWEST_TURNS, tail_length
from watchsim.simulation.state import EventKind
from watchsim.simulation.tally import sums_of
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.columns import blocks, rows_where


def why_no_timing(run: Trajectory, found: Beats | None, numbers: Mapping[str, Any], start: float = 0.0) -> str | None:
    """A sentence for people; None where amplitude and rate are known, or where nothing could keep time anyway.

    The averages were taken from `start` (s) on.
    """
    if numbers["amplitude_deg"] is not None and numbers["rate_s_per_d"] is not None:
        return None
    if found is None:
        scene = run.scene
        if not any(body.motion == "pivot" for body in scene.bodies):
            return None
        hanging = "and there is no gravity" if not any(scene.gravity) else "and none that is not driven hangs beside its pivot"
        return f"no amplitude and rate: no body has a spring, {hanging}"
    if only_presses(run.scene) and not sums_of(run)["passages"]:
        return None
    what = "rate" if numbers["amplitude_deg"] is not None or not found.angular else "amplitude and rate"
    if numbers["rate_s_per_d"] is not None:
        return f"no amplitude in degrees: {found.body} slides"
    return f"no {what}: {_missing(run, found, start)}"


def never_touched(run: Trajectory) -> str | None:
    """A sentence where the scene has a driven wheel and an oscillator, and nothing in it touched anything in the whole run."""
    parts, kinds = roles(run.scene), run.sums.get("events_by_kind", {})
    if not may_lock(run.scene) or not kinds or kinds.get("impact") or kinds.get("close"):
        return None
    kind = timekeeper(run.scene)
    return f"no amplitude and rate of a {kind}: {parts.wheel} never touched anything, and {parts.oscillator} swings by itself"


def not_held(run: Trajectory) -> str | None:
    """A sentence where a body that its spring should press on another one swings through its rest position instead.

    Its swing is no beat: a rate is that of an oscillator that an escapement lets beat, or that swings by itself.
    """
    if not only_presses(run.scene) or not sums_of(run)["passages"]:
        return None
    own = roles(run.scene).oscillator or ""
    others = " and ".join(sorted(partners(run.scene, own))) or "nothing"
    return f"{own}, which its spring presses on {others}, is not held there and swings to and fro: look at where it stands"


def _missing(run: Trajectory, found: Beats, start: float) -> str:
    """What is too little for a period: two passages in one direction and three turning points make one."""
    one = next((one for one in oscillators(run.scene) if one.body == found.body), None)
    if one is not None and one.hertz is None:
        return f"gravity topples {found.body} from its rest position"
    passages, turns, fastest = (sums_of(run)[name] for name in ("passages", "turns", "fastest"))
    if found.angular and not turns and _went(run, found.body) > math.tau:
        return f"{found.body} goes round instead of swinging"
    if not passages and run.simulated > found.nominal_period:
        return f"{found.body} never passed its rest position"
    if passages and not turns and fastest * found.nominal_period < AT_REST:
        return f"{found.body} stays in its rest position"
    if turns < FEWEST_TURNS and run.simulated > 2.0 * found.nominal_period:
        return f"{found.body} turned back {_times(turns)} in {run.simulated:.4g} s"
    if not found.before + len(found) and passages and turns >= FEWEST_TURNS:
        return f"{found.body} stays in its rest position"
    need = 2.0 * found.nominal_period
    if run.simulated < need:
        return f"the run of {run.simulated:.4g} s is too short: {found.body} needs {need:.4g} s for two oscillations"
    return f"the last {run.simulated - start:.4g} s hold too few whole swings of {found.body}"


AT_REST = 1e-12  # rad (m) in a period: what gravity's rounding may move a body that hangs still


def _went(run: Trajectory, body: str) -> float:
    """How far it has turned from the start to the end, rad."""
    return 0.0 if run.end is None else abs(float(run.end[0][run.slices[body]][0]) - run.scene.body(body).angle)


def _times(count: int) -> str:
    return {0: "not once", 1: "only once", 2: "only twice"}.get(count, f"only {count} times")


def progress(run: Trajectory, wheel: str, times: Array) -> Array:
    """Angle (rad) the wheel has turned since the start of the run in the sense of its drive, at recorded times (s)."""
    column = run.slices[wheel].start
    angles = [run.positions(part, [column])[:, 0] for (part,) in blocks(times)]
    return drive_direction(run.scene, wheel) * (np.concatenate(angles or [np.zeros(0)]) - run.scene.body(wheel).angle)


def missed_beats(run: Trajectory) -> int | None:
    """Half swings in which the wheel did not advance by half a pitch, or half pitches it went too far; None where not known."""
    missed: int | None = sums_of(run).get("wheel", {}).get("missed")
    return missed


HALF_SWINGS = 3  # without any advance of the wheel: the watch stands
SMALLEST_ADVANCE = 0.01  # rad, for a wheel whose pitch is not known
STILL = 0.1  # of the advance that counts: less is trembling
VISIBLE = 1e-4  # rad; an oscillator that moved less for half a period is held


@dataclass(frozen=True, slots=True)
class Standstill:
    """`since`, s, and a sentence for people."""

    since: float
    message: str


def standstill(run: Trajectory, found: Beats) -> Standstill | None:
    """None while the watch ticks, where the run is shorter than three half swings, or where there is no escapement.

    The watch stands if the wheel did not advance (by half of what a beat takes) in the last three half swings, or four; where
    that was not recorded, if the oscillator did not pass its rest position in that time.
    """
    parts = roles(run.scene)
    if parts.oscillator is None or parts.wheel is None or not keeps_time(run.scene):
        return None
    start = run.simulated - HALF_SWINGS * 0.5 * nominal_period(run, parts.oscillator)
    if start <= 0.0:
        return None
    whole = pitch(run.scene, parts.wheel)
    least = SMALLEST_ADVANCE if whole is None else 0.25 * whole
    # Where it only goes to and fro, it has advanced in an odd number of half swings, and not in an even one.
    ends = np.array([max(0.0, start - 0.5 * nominal_period(run, parts.oscillator)), start, run.simulated])
    if is_recorded(run, ends).all():
        *first, last = progress(run, parts.wheel, ends)
        if last - max(first) >= least:
            return None
        late = run.t[run.t >= run.simulated - tail_length(frequency(run.scene))]  # what every recording holds
        earlier = np.flatnonzero(np.abs(progress(run, parts.wheel, late) - last) > STILL * least)
        since = float(late[earlier[-1]]) if len(earlier) else _moved(run)
    else:
        crossings = rows_where(run.events, lambda part: part["kind"] == EventKind.CROSS)["t"]
        since = float(crossings[-1]) if len(crossings) else 0.0
        if since >= start:
            return None
    return Standstill(
        since, f"the escape wheel has stood still since t = {since:.4g} s" + _circumstances(run, found, parts.oscillator)
    )


def _moved(run: Trajectory) -> float:
    """The end (s) of the half swing in which the wheel last moved; the first row where it never did."""
    moved = sums_of(run).get("wheel", {}).get("moved")
    return float(run.t[0]) if moved is None else float(moved)


def _circumstances(run: Trajectory, found: Beats, oscillator: str) -> str:
    """Where the oscillator is, how far it last swung, and what touches what."""
    words = ""
    if found.angular and is_recorded(run, np.array([run.simulated])).all():
        column = run.slices[oscillator].start
        angle = f"{math.degrees(run.q[-1, column]):.4g}°".replace("-", "−")
        late = run.t >= run.simulated - tail_length(frequency(run.scene))
        moved = np.flatnonzero(late & (np.abs(run.q[:, column] - run.q[-1, column]) > VISIBLE))
        held_since = float(run.t[moved[-1]]) if len(moved) else float(sums_of(run)["turned"])
        if run.simulated - held_since > 0.5 * found.nominal_period:
            words += f"; {oscillator} held at {angle} since t = {held_since:.4g} s"
        else:
            words += f"; {oscillator} swinging, now at {angle}"
    late = sums_of(run)["late"]
    if late and found.angular:
        words += f"; last amplitude {math.degrees(late[-1]):.3g}°"
    holding = holding_at_end(run)
    return words + (f"; in contact: {'; '.join(map(str, holding))}" if holding else "; nothing in contact")
