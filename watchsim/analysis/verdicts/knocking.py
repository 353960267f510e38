"""Does the oscillator swing so far that it strikes the lever from outside?"""

from __future__ import annotations

import math

import numpy as np

from watchsim.analysis.timing.averages import averages, last_window
from watchsim.analysis.timing.body_contacts import Events
from watchsim.analysis.verdicts.equilibrium.lever_arms import arms
from watchsim.analysis.verdicts.verdict_kinds import KNOCKS, Verdict, degrees, times, torque_text, when
from watchsim.analysis.verdicts.watch import Watch
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Array

OUTSIDE = math.pi  # rad from rest: so far round the impulse pin cannot be in the slot
SQUARE = (
    0.05  # of the distance from the staff: with less of an arm a blow does not turn the oscillator back (a dart on its roller)
)


def knocking(watch: Watch) -> Verdict | None:
    """In the second half of the run, or its last window: a blow by the lever more than half a turn from rest, or by a stop."""
    blows = knocks(watch)
    start, end = last_window(watch.run, watch.found.nominal_period)
    if not len(blows) or blows["t"][-1] < min(start, 0.5 * end):
        return None
    swing = np.unique(np.searchsorted(watch.found.t, blows["t"]))
    t = float(blows["t"][0])
    pair = watch.run.pairs[int(blows["contact"][0])]
    drive, means = watch.drive(t), averages(watch.found, (start, end))
    where = degrees(abs(float(_angles(watch, blows["t"][-1:])[0])))
    other = pair.body_a if pair.body_b == watch.oscillator else pair.body_b
    words = (
        f"{when(t)}  the watch knocks: {watch.oscillator} strikes {other} from outside at {where}, {times(len(swing))} ({pair})"
    )
    words += f", under {torque_text(drive)} at {watch.wheel}"
    if means.rate_s_per_d is not None and means.rate_s_per_d > 0.0:
        words += f"; the watch gallops, {means.rate_s_per_d:+.3g} s/d"
    return Verdict(KNOCKS, words, t, watch.oscillator, str(pair), drive, len(swing))


def knocks(watch: Watch) -> Events:
    """The impacts that turn the oscillator back from outside, in order of time."""
    if not len(watch.found):
        return watch.run.events[:0]
    others = watch.fixed | ({watch.lever} if watch.lever else set())
    blows = watch.events(watch.oscillator, others, EventKind.IMPACT)
    blows = blows[(blows["t"] >= watch.found.start[0]) & (blows["t"] <= watch.found.end[-1])]
    stops = {number for number in np.unique(blows["contact"]).tolist() if _stop(watch, number)}
    blows = blows[(np.abs(_angles(watch, blows["t"])) > OUTSIDE) | np.isin(blows["contact"], list(stops))]
    square = {number for number in np.unique(blows["contact"]).tolist() if _turns_back(watch, blows, number)}
    return blows[np.isin(blows["contact"], list(square))]


def _stop(watch: Watch, number: int) -> bool:
    pair = watch.run.pairs[number]
    return bool({pair.body_a, pair.body_b} & watch.fixed)


def _turns_back(watch: Watch, blows: Events, number: int) -> bool:
    """Has the normal of this contact an arm on the oscillator? Judged at one of its blows; believed where none was recorded."""
    at = blows["t"][blows["contact"] == number]
    at = at[watch.recorded(at)]
    if not len(at) or not watch.has_shapes:
        return True
    found = arms(watch.run, watch.compiled, float(at[0]), [number])
    x, y, _ = found.places[watch.oscillator]
    far = math.hypot(found.point[0, 0] - x, found.point[0, 1] - y)
    return abs(found.of(0, watch.oscillator)[0]) > SQUARE * far


def _angles(watch: Watch, times: Array) -> Array:
    """How far the oscillator is from rest at times within its half swings, rad: these taken for sines."""
    found = watch.found
    i = np.searchsorted(found.end, times)
    late = times >= found.t[i]
    reach, turn = np.where(late, found.end_at[i], found.start_at[i]), np.where(late, found.end[i], found.start[i])
    share = np.minimum((times - found.t[i]) / np.where(turn == found.t[i], np.inf, turn - found.t[i]), 1.0)
    angles: Array = (reach - watch.rest) * np.sin(0.5 * math.pi * share)
    return angles
