"""Does the wheel pass more teeth than the lever lets go?"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.timing.escape_wheel import advance
from watchsim.analysis.verdicts.running_free import running_free
from watchsim.analysis.verdicts.unlocked import unlocked
from watchsim.analysis.verdicts.verdict_kinds import TRIPS, Verdict, times, torque_text, when
from watchsim.analysis.verdicts.watch import Watch
from watchsim.simulation.event_kinds import EventKind

AHEAD = 1  # half pitches gained within two half swings


def tripping(watch: Watch) -> Verdict | None:
    """A beat is half a pitch, or a pitch in every other half swing: what is more was tripped, whatever was missed before.

    Besides: teeth that come to rest on an impulse face, though they do not run past it (mislocking).
    """
    return _running_free(watch) or _run_past(watch) or _mislocked(watch)


def _running_free(watch: Watch) -> Verdict | None:
    free = running_free(watch)
    if free is None:
        return None
    t, how = free
    drive = watch.drive(t)
    words = f"{when(t)}  the watch trips: {how}, and nothing locks it, under {torque_text(drive)}"
    return Verdict(TRIPS, words, t, watch.wheel, None, drive)


def _run_past(watch: Watch) -> Verdict | None:
    moved = advance(watch.run, watch.wheel, watch.found)
    if moved is None or len(moved.angle) < 2:
        return None
    gained = np.rint((moved.angle - moved.angle[0]) / moved.half_pitch) - moved.half_swings
    before = np.maximum(gained[1:-1], gained[:-2])
    tripped = np.flatnonzero(gained[2:] - before >= AHEAD) + 2
    if gained[1] - gained[0] >= 2 * AHEAD:
        tripped = np.append(1, tripped)
    if not len(tripped):
        return None
    ends = watch.found.end[(moved.half_swings[tripped] - watch.found.before).astype(int) - 1]
    starts = watch.found.start[(moved.half_swings[tripped] - watch.found.before).astype(int) - 1]
    t, pair = _slip(watch, float(starts[0]), float(ends[0]))
    drive = watch.drive(t)
    words = f"{when(t)}  the watch trips: {watch.wheel} ran past {watch.lever or watch.oscillator} {times(len(tripped))}"
    words += (f", first from {pair}" if pair else "") + f", under {torque_text(drive)}"
    return Verdict(TRIPS, words, t, watch.wheel, pair, drive, len(tripped))


def _slip(watch: Watch, start: float, end: float) -> tuple[float, str | None]:
    """The last contact that the wheel lost before it had gone too far between two turning points (s)."""
    held = watch.events(watch.wheel, {watch.lever or watch.oscillator}, EventKind.OPEN, EventKind.IMPACT)
    held = held[(held["t"] >= start) & (held["t"] <= end)]
    if not len(held) or watch.pitch is None:
        return start, None
    way = watch.progress(held["t"]) - watch.progress(np.array([start]))[0]
    within = held[way <= 0.75 * watch.pitch]
    last = within[-1] if len(within) else held[0]
    return float(last["t"]), str(watch.run.pairs[int(last["contact"])])


def _mislocked(watch: Watch) -> Verdict | None:
    found = unlocked(watch)
    if not found:
        return None
    t, pair, face = found[0]
    drive = watch.drive(t)
    words = (
        f"{when(t)}  the watch trips, {times(len(found))} since: {face} ({pair}) while {watch.oscillator} is away, and drives "
        f"{watch.lever} off its banking with {torque_text(drive)} at {watch.wheel}. The lock there is too shallow"
    )
    return Verdict(TRIPS, words, t, watch.wheel, pair, drive, len(found))
