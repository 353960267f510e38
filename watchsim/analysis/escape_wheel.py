"""How far did the escape wheel go, and did it miss a beat?"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from watchsim.analysis.timing import Beats, holding_at_end, is_recorded, nominal_period
from watchsim.scene.roles import drive_direction, keeps_time, may_lock, only_presses, oscillators, pitch, roles
from watchsim.simulation.recording import FEWEST_TURNS, Events
from watchsim.simulation.state import EventKind
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
    if only_presses(run.scene) and not _passages(run, found):
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
    return f"no amplitude and rate of a watch: {parts.wheel} never touched anything, and {parts.oscillator} swings by itself"


def _passages(run: Trajectory, found: Beats) -> int:
    """Through the rest position, in the whole run."""
    return int((_own_events(run, found)["kind"] == EventKind.CROSS).sum())


def _own_events(run: Trajectory, found: Beats) -> Events:
    own = [body.name for body in run.scene.bodies].index(found.body)
    return rows_where(run.events, lambda part: part["body"] == own)


def _missing(run: Trajectory, found: Beats, start: float) -> str:
    """What is too little for a period: two passages in one direction and three turning points make one."""
    one = next((one for one in oscillators(run.scene) if one.body == found.body), None)
    if one is not None and one.hertz is None:
        return f"gravity topples {found.body} from its rest position"
    own = _own_events(run, found)
    rates, turns = own["value"][own["kind"] == EventKind.CROSS], int((own["kind"] == EventKind.TURN).sum())
    passages = len(rates)
    if found.angular and not turns and _went(run, found.body) > math.tau:
        return f"{found.body} goes round instead of swinging"
    if not passages and run.simulated > found.nominal_period:
        return f"{found.body} never passed its rest position"
    if passages and not turns and np.abs(rates).max() * found.nominal_period < AT_REST:
        return f"{found.body} stays in its rest position"
    if turns < FEWEST_TURNS and run.simulated > 2.0 * found.nominal_period:
        return f"{found.body} turned back {_times(turns)} in {run.simulated:.4g} s"
    if not len(found) and passages and turns >= FEWEST_TURNS:
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


@dataclass(frozen=True)
class Advance:
    """The wheel at recorded turning points: half swings since the run's first turning point, and how far it has come (rad)."""

    half_pitch: float
    half_swings: Array
    angle: Array

    @property
    def steps(self) -> Array:
        """Half pitches from each of these turning points to the next."""
        return np.diff(self.angle) / self.half_pitch


def progress(run: Trajectory, wheel: str, times: Array) -> Array:
    """Angle (rad) the wheel has turned since the start of the run in the sense of its drive, at recorded times (s)."""
    column = run.slices[wheel].start
    angles = [run.positions(part, [column])[:, 0] for (part,) in blocks(times)]
    return drive_direction(run.scene, wheel) * (np.concatenate(angles or [np.zeros(0)]) - run.scene.body(wheel).angle)


def advance(run: Trajectory, wheel: str, found: Beats) -> Advance | None:
    """The wheel's progress at all recorded turning points; None for a wheel without equal teeth or with none recorded."""
    whole = pitch(run.scene, wheel)
    if whole is None or len(found) == 0:
        return None
    times, half_swings = np.append(found.start[:1], found.end), found.before + np.arange(len(found) + 1.0)
    kept = is_recorded(run, times)
    if not kept.any():
        return None
    return Advance(0.5 * whole, half_swings[kept], progress(run, wheel, times[kept]))


def missed_beats(run: Trajectory, wheel: str, found: Beats) -> int | None:
    """Half swings in which the wheel did not advance by half a pitch, or half pitches it went too far; None where not known.

    Where it goes on by a whole pitch in every other half swing, as with a detent, whole pitches are counted. Between recorded
    windows, and from the start to the first of them, half swings and half pitches are only counted. There the first half swing
    is given the benefit of the doubt: the wheel may start on either side of it.
    """
    moved = advance(run, wheel, found)
    if moved is None:
        return None
    # 0 or 1: only the half swings of that parity give the wheel a step, of a whole pitch; None where all of them do.
    single = np.diff(moved.half_swings) == 1.0
    steps, parity = np.rint(moved.steps[single]), moved.half_swings[:-1][single] % 2.0
    usual = [np.median(steps[parity == k]) if (parity == k).any() else np.nan for k in (0.0, 1.0)]
    only = usual.index(2.0) if sorted(usual) == [0.0, 2.0] else None
    one = 1.0 if only is None else 2.0  # half pitches
    due = np.diff(moved.half_swings) if only is None else 2.0 * np.diff(_of_parity(moved.half_swings, only))
    missed = float(np.abs(np.rint(moved.steps) - due).sum()) / one
    if moved.half_swings[0] > 0:
        before = abs(np.rint(moved.angle[0] / moved.half_pitch) - (moved.half_swings[0] + 1.0))
        missed += max(0.0, before - one) / one
    return int(missed)


def _of_parity(half_swings: Array, parity: int) -> Array:
    """How many half swings of that parity there were before each of these."""
    return np.floor((half_swings + (1.0 - parity)) / 2.0)


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
        earlier = np.flatnonzero(np.abs(progress(run, parts.wheel, run.t) - last) > STILL * least)
        since = float(run.t[earlier[-1]]) if len(earlier) else float(run.t[0])
    else:
        crossings = rows_where(run.events, lambda part: part["kind"] == EventKind.CROSS)["t"]
        since = float(crossings[-1]) if len(crossings) else 0.0
        if since >= start:
            return None
    return Standstill(
        since, f"the escape wheel has stood still since t = {since:.4g} s" + _circumstances(run, found, parts.oscillator)
    )


def _circumstances(run: Trajectory, found: Beats, oscillator: str) -> str:
    """Where the oscillator is, how far it last swung, and what touches what."""
    words = ""
    if found.angular and is_recorded(run, np.array([run.simulated])).all():
        column = run.slices[oscillator].start
        angle = f"{math.degrees(run.q[-1, column]):.4g}°".replace("-", "−")
        moved = np.flatnonzero(np.abs(run.q[:, column] - run.q[-1, column]) > VISIBLE)
        held_since = float(run.t[moved[-1]]) if len(moved) else 0.0
        if run.simulated - held_since > 0.5 * found.nominal_period:
            words += f"; {oscillator} held at {angle} since t = {held_since:.4g} s"
        else:
            words += f"; {oscillator} swinging, now at {angle}"
    if len(found) and found.angular:
        words += f"; last amplitude {found.amplitude_deg[-1]:.3g}°"
    holding = holding_at_end(run)
    return words + (f"; in contact: {'; '.join(map(str, holding))}" if holding else "; nothing in contact")
