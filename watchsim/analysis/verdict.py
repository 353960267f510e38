"""Does the watch tick, and if not, what does it do instead?

From recorded events, contacts and roles alone, so that it holds for any names, orientation and direction of rotation.

backwards   the wheel turns against its drive, or its drive turns it against its teeth
overbanks   the lever went over while the impulse pin was away; the pin now strikes the fork from outside
stops       the wheel stands: set on lock, on impulse, or the swing is too small to unlock
trips       the wheel passed more teeth than the lever let go, or teeth come to rest on an impulse face
knocks      the impulse pin strikes the outside of the fork near the turning point (rebanking), or blows end the swings
unsettled   it ticks, but its amplitude has yet to settle, or the run is too short to tell
ticks       none of these
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from watchsim.analysis.escape_wheel import missed_beats, standstill
from watchsim.analysis.flows import LOSSES
from watchsim.analysis.timing import Beats, Bits, Events, averages, beats, involves, last_window
from watchsim.analysis.verdict_kinds import (
    BACKWARDS,
    KNOCKS,
    NOTHING,
    OVERBANKS,
    STOPS,
    TICKS,
    TRIPS,
    UNSETTLED,
    Verdict,
    degrees,
    times,
    torque_text,
    when,
)
from watchsim.analysis.watch import Arms, Face, Watch, arms, arms_at, at_lever, face, in_force, unlocked, watch_of
from watchsim.escapement.measure import banks_of, wrong_way
from watchsim.scene.roles import is_driven, keeps_time, swings, timekeeper
from watchsim.scene.scene import ALL
from watchsim.simulation.knock_tally import ANGLE, CONTACT, FIRST, LAST, PLACE, TOGETHER
from watchsim.simulation.state import EventKind
from watchsim.simulation.tally import sums_of
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.simulation.wheel_tally import FAST, trips_of
from watchsim.storage.columns import rows_where
from watchsim.units import rounded, show

# An amplitude settles like an exponential. Of three equal stretches of time in a row, with mean amplitudes a, b, c, what is
# still to come after the last is (c - b) r / (1 - r) with r = (c - b) / (b - a) (Aitken).

FEWEST = 12  # half swings that three stretches take
SETTLED = 2e-3  # of the amplitude: how far it may still have to go
SURE = 3.0  # standard errors, beyond which a drift is one
SLOWEST = 0.98  # ratio of steps, beyond which no end is foretold


def unsettled(watch: Watch) -> Verdict | None:
    """None where the amplitude will change by less than 0.2 %."""
    amplitude = np.degrees(sums_of(watch.run)["late"])  # those before may be another motion
    if len(amplitude) < FEWEST:
        words = f"not settled yet: {len(amplitude)} half swings are too few to tell how the watch goes"
        return Verdict(UNSETTLED, words, body=watch.oscillator)
    stretch = 2 * (len(amplitude) // 6)  # half swings of both directions in each
    parts = amplitude[-3 * stretch :].reshape(3, stretch)
    steps, error = np.diff(parts.mean(axis=1)), _error(parts)
    if abs(steps[1]) <= SURE * error:
        return None
    ratio = steps[1] / steps[0] if steps[0] else np.inf
    last, whole = float(amplitude[-1]), float(parts[2].mean())
    to_come = steps[1] * ratio / (1.0 - ratio) if 0.0 < ratio < SLOWEST else None
    goal = None if to_come is None else whole + to_come
    left = abs(steps[1]) if goal is None else abs(goal - last)
    if left <= SETTLED * whole:
        return None
    per_second = steps[1] / (stretch * 0.5 * watch.found.nominal_period)
    words = f"not settled yet: the amplitude {'rises' if per_second > 0.0 else 'falls'} by {abs(per_second):.2g}° per second"
    words += f", on its way to about {goal:.{_decimals(abs(goal - last))}f}°" if goal is not None and goal > 0.0 else ""
    words += _rate(watch)
    return Verdict(UNSETTLED, words, float(watch.found.t[-1]), watch.oscillator, torque=watch.drive(watch.run.simulated))


def _decimals(way: float) -> int:
    """So many that what is still to come can be seen."""
    return max(0, -math.floor(math.log10(way)))


def _error(parts: Array) -> float:
    """Standard error of the difference of two means, by the scatter about the straight lines through the stretches."""
    pairs = parts.reshape(3, -1, 2).mean(axis=2)
    if pairs.shape[1] < 3:
        return 0.0
    place = np.arange(pairs.shape[1]) - 0.5 * (pairs.shape[1] - 1)
    slopes = pairs @ place / (place @ place)
    rest = pairs - pairs.mean(axis=1, keepdims=True) - slopes[:, None] * place
    return float(np.sqrt(2.0 * rest.var() / pairs.shape[1]))


def _rate(watch: Watch) -> str:
    """How sure the rate is, where it is known."""
    means = averages(watch.found, last_window(watch.run, watch.found.nominal_period))
    return "" if means.rate_s_per_d is None else "; amplitude and rate are those of this moment, not of the watch"


RUNS_THROUGH, NOTHING_LOCKS = "runs through", "and nothing locks it"
BETWEEN = 0.1  # of the time, at least: a wheel that stands so long is locked between
STANDS = 0.1  # of a pitch in a period: a wheel that goes on more slowly, or recoils, is locked


def running_free(watch: Watch) -> tuple[float, str] | None:
    """Since when (s) and a few words, where in the last window the wheel passed far more teeth than there are beats."""
    start, end = last_window(watch.run, watch.found.nominal_period)
    ends = np.array([start, end])
    if watch.pitch is None or not watch.recorded(ends).all():
        return None
    first, last = watch.progress(ends)
    let_go = (end - start) / watch.found.nominal_period + 1.0
    if last - first <= FAST * let_go * watch.pitch:
        return None
    rows = watch.run.t[(watch.run.t >= start) & (watch.run.t <= end)]  # what every recording holds
    behind = watch.progress(rows) - FAST * watch.pitch / watch.found.nominal_period * rows
    start, least = sums_of(watch.run)["wheel"]["least"]  # from there on it gained
    if behind.min() < least:
        start, least = float(rows[np.argmin(behind)]), float(behind.min())
    turns = (last - least - FAST * watch.pitch / watch.found.nominal_period * start) / (2.0 * np.pi)
    stood, waits = np.diff(watch.progress(rows)), np.diff(rows)
    locked = float(waits[stood <= STANDS * watch.pitch / watch.found.nominal_period * waits].sum())
    how, whole = NOTHING_LOCKS, float(waits.sum())
    if locked > BETWEEN * whole:
        how = f"but between it is locked, for {100.0 * locked / whole:.0f} % of the last {rounded(whole)} s"
    return start, f"{watch.wheel} {RUNS_THROUGH}, {rounded(turns)} turns from {when(start)} to {when(end)}, {how}"


def backwards(watch: Watch) -> Verdict | None:
    """The wheel went back against its drive in the last window; or it goes the way its teeth do not lean, and nothing locks."""
    return _against_drive(watch) or _against_teeth(watch)


def _against_drive(watch: Watch) -> Verdict | None:
    start, end = last_window(watch.run, watch.found.nominal_period)
    ends = np.array([start, end])
    if not watch.recorded(ends).all():
        return None
    first, last = watch.progress(ends)
    if first - last < 2.0 * watch.least_advance:
        return None
    drive = watch.drive(end)
    words = f"{when(start)}  the watch runs backwards: since then {watch.wheel} has turned by {np.degrees(first - last):.3g}° "
    words += f"against its drive of {torque_text(drive)}" if is_driven(watch.run.scene) else "and nothing drives it"
    return Verdict(BACKWARDS, words, start, watch.wheel, torque=drive)


def _against_teeth(watch: Watch) -> Verdict | None:
    leans = 0.0 if watch.teeth is None else watch.teeth.direction * watch.direction
    free, found = (running_free(watch), unlocked(watch)) if leans < 0.0 else (None, [])
    t, pair = found[0][:2] if found and free is None else (0.0 if free is None else free[0], None)
    drive = torque_text(watch.drive(t))
    if free is not None or found:
        how = f"they do not lock but push {watch.lever} off its banking ({pair})" if free is None else free[1]
        why = f"its drive of {drive} turns {watch.wheel} against the lean of its teeth; {how}. Change the sign of the torque"
    elif (said := wrong_way(watch.run.scene)) is not None:
        why = said
    else:
        return None
    return Verdict(
        BACKWARDS, f"{when(t)}  the watch runs backwards: {why}", t, watch.wheel, pair, watch.drive(t), len(found) or None
    )


def overbanking(watch: Watch) -> Verdict | None:
    """The oscillator no longer passes its rest position, since it presses the lever onto the banking it stands at."""
    run = watch.run
    if watch.lever is None or not watch.has_banking:
        return None
    own = [body.name for body in run.scene.bodies].index(watch.oscillator)
    passed = rows_where(run.events, lambda part: (part["body"] == own) & (part["kind"] == EventKind.CROSS))["t"]
    since = float(passed[-1]) if len(passed) else 0.0
    if run.simulated - since < watch.found.nominal_period:
        return None
    met = watch.events(watch.lever, {watch.oscillator}, EventKind.IMPACT, EventKind.CLOSE, EventKind.HANDOVER)
    met = met[met["t"] > since]
    if not len(met) or not watch.recorded(met["t"][-1:])[0]:
        return None
    t, contact = float(met["t"][-1]), int(met["contact"][-1])
    bankings = watch.contacts(watch.lever, watch.fixed)
    banked = [number for number in in_force(run, [t])[0] if number in bankings]
    if not banked or not watch.has_shapes or not _pressed_on(arms(run, watch.compiled, t, [contact, *banked]), watch.lever):
        return None
    if _stayed(watch):
        return None
    over, pair, free = _went_over(watch), str(run.pairs[contact]), running_free(watch)
    drive = watch.drive(over)
    wheel = f"{watch.wheel}, under {torque_text(drive)}, is not unlocked"
    if free is not None:
        wheel = f"{free[1]}, under {torque_text(drive)}"
    angle = degrees(float(watch.angle(watch.oscillator, np.array([t]))[0]) - watch.rest)
    words = (
        f"{when(over)}  the watch overbanks: {watch.lever} went over while {watch.oscillator} was away, which now strikes "
        f"it from outside at {angle} ({pair}); {wheel}. "
        f"No guard pin or horn kept {watch.lever} at its banking"
    )
    return Verdict(OVERBANKS, words, over, watch.lever, pair, drive)


def _pressed_on(found: Arms, lever: str) -> bool:
    """Does the first contact turn the lever against all others?"""
    turned, *held = (found.of(row, lever)[0] for row in range(len(found.pairs)))
    return all(turned * arm < 0.0 for arm in held)


def _stayed(watch: Watch) -> bool:
    """Was the lever on one side of the line of centres, midway between its banks, throughout a run of which all is known?"""
    assert watch.lever is not None
    banks = banks_of(watch.run.scene) if watch.run.keep == ALL else None
    if banks is None:
        return False
    off = watch.run.q[:, watch.run.slices[watch.lever].start] - 0.5 * sum(banks)
    return bool(off.min() * off.max() > 0.0)


def _went_over(watch: Watch) -> float:
    """When the lever last left the other half of its way, s; 0 where it never was there."""
    assert watch.lever is not None
    angles = watch.run.q[:, watch.run.slices[watch.lever].start]
    away = np.flatnonzero(np.abs(angles - angles[-1]) > 0.5 * np.ptp(angles))
    return float(watch.run.t[away[-1]]) if len(away) and np.ptp(angles) > 0.0 else 0.0


SQUARE = (
    0.05  # of the distance from the staff: with less of an arm a blow does not turn the oscillator back (a dart on its roller)
)


def knocking(watch: Watch) -> Verdict | None:
    """In the second half of the run, or its last window: a blow by the lever more than half a turn from rest, or by a stop; or
    at every other turning point of that window a blow of whatever kind, as of a pallet that runs into the wheel's teeth."""
    blows, window = knocks(watch), last_window(watch.run, watch.found.nominal_period)
    if blows is None or blows.last < min(window[0], 0.5 * window[1]):
        blows = _stopped_short(watch, window[0])
    if blows is None:
        return None
    drive, means = watch.drive(blows.first), averages(watch.found, window)
    pair, where = watch.run.pairs[blows.contact], degrees(abs(blows.angle))
    other = pair.body_a if pair.body_b == watch.oscillator else pair.body_b
    words = f"{when(blows.first)}  the watch knocks: {watch.oscillator} strikes {other} from outside at {where}, "
    if blows.swings:
        words = f"{when(blows.first)}  the watch knocks: {watch.oscillator} strikes {other} at {where}, which ends its swing, "
    words += f"{times(blows.count)} {f'in {blows.swings} half swings ' * bool(blows.swings)}({pair}), "
    words += f"under {torque_text(drive)} at {watch.wheel}"
    if means.rate_s_per_d is not None and means.rate_s_per_d > 0.0:
        words += f"; the watch gallops, +{rounded(means.rate_s_per_d)} s/d"
    return Verdict(KNOCKS, words, blows.first, watch.oscillator, str(pair), drive, blows.count)


AT_ONCE = 1e-9  # s: rounding puts a blow that turns the oscillator back a little before the turning point, or after it


def blows_that_turn(events: Events, touching: Bits, turned: Array) -> tuple[Events, Bits]:
    """Those with which the oscillator turned back, and at which of the times `turned` (s, rising) it did so; `touching`: by
    contact, whether it is its own.

    What turns back by itself is at rest then, and strikes nothing.
    """
    blows: Events = events[np.isin(events["kind"], LOSSES) & touching[events["contact"]]]
    near = np.searchsorted(turned, blows["t"] - AT_ONCE), np.searchsorted(turned, blows["t"] + AT_ONCE, side="right")
    at_once = near[0] < near[1]
    return blows[at_once], np.isin(np.arange(len(turned)), near[0][at_once])


def _stopped_short(watch: Watch, start: float) -> Knocks | None:
    """None where fewer than half of the swings from `start` (s) on end with a blow."""
    run, found = watch.run, watch.found
    touching = np.array([*map(involves(watch.oscillator), run.pairs), False])
    blows, met = blows_that_turn(run.events, touching, found.end)
    late = met[found.end >= start]
    if not late.any() or 2 * late.sum() + 1 < len(late):  # every other one, of an odd number
        return None
    ended = np.flatnonzero(met)
    hardest = blows[np.argmax(np.where(blows["t"] >= found.end[ended[-1]] - AT_ONCE, blows["impulse_normal"], -np.inf))]
    first, last = found.end[ended[[0, -1]]].tolist()
    angle = float(found.end_at[ended[-1]]) - watch.rest
    return Knocks(first, int(hardest["contact"]), last, angle, len(ended), len(found) - int(ended[0]))


@dataclass(frozen=True, slots=True)
class Knocks:
    """The impacts that turn the oscillator back from outside: the first with its contact, the last with how far from rest (rad)
    that was, at how many turning points, and of how many from the first on where blows of any kind are counted; s."""

    first: float
    contact: int
    last: float
    angle: float
    count: int
    swings: int = 0


def knocks(watch: Watch) -> Knocks | None:
    """None where there are none."""
    sums = sums_of(watch.run)["knocks"]
    rows = [row for row in sums["contacts"] if _turns_back(watch, int(row[CONTACT]), np.array(row[PLACE:]))]
    if not rows:
        return None
    first, last = min(rows, key=lambda row: row[FIRST]), max(rows, key=lambda row: row[LAST])
    square = {int(row[CONTACT]) for row in rows}
    count = sum(row[TOGETHER] for row in sums["together"] if square.intersection(row[:TOGETHER]))
    return Knocks(first[FIRST], int(first[CONTACT]), last[LAST], last[ANGLE], count)


def _turns_back(watch: Watch, number: int, place: Array) -> bool:
    """Has the normal of this contact an arm on the oscillator, at the coordinates of its first blow? Believed where unknown."""
    if not watch.has_shapes or not len(place) or not np.isfinite(place).all():
        return True
    found = arms_at(watch.run, watch.compiled, 0.0, place, [number])
    x, y, _ = found.places[watch.oscillator]
    far = math.hypot(found.point[0, 0] - x, found.point[0, 1] - y)
    return abs(found.of(0, watch.oscillator)[0]) > SQUARE * far


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
    words = f"{when(t)}  the watch trips: {how}, under {torque_text(drive)}"
    return Verdict(TRIPS, words, t, watch.wheel, None, drive)


def _run_past(watch: Watch) -> Verdict | None:
    trips = trips_of(sums_of(watch.run))
    if trips is None:
        return None
    pair = None if trips.contact < 0 else str(watch.run.pairs[trips.contact])
    drive = watch.drive(trips.t)
    words = f"{when(trips.t)}  the watch trips: {watch.wheel} ran past {watch.lever or watch.oscillator} {times(trips.count)}"
    words += (f", first from {pair}" if pair else "") + f", under {torque_text(drive)}"
    return Verdict(TRIPS, words, trips.t, watch.wheel, pair, drive, trips.count)


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


HELD = 1e-4  # rad: an oscillator that moved less for half a period is held


def standing(watch: Watch) -> Verdict | None:
    """The wheel has not advanced for three half swings: on what it rests, and why that does not go on."""
    stands = standstill(watch.run, watch.found)
    if stands is None:
        return None
    why, pair = "", None
    if watch.lever is not None and watch.has_shapes and watch.recorded(np.array([watch.run.simulated]))[0]:
        why, pair = _why(watch, watch.lever)
    late = sums_of(watch.run)["late"]
    last = f". Last amplitude {math.degrees(late[-1]):.3g}°" if late else ""
    words = f"{when(stands.since)}  the watch stands: " + (why + last if why else stands.message)
    return Verdict(STOPS, words, stands.since, watch.wheel, pair, watch.drive(watch.run.simulated))


def _why(watch: Watch, lever: str) -> tuple[str, str | None]:
    """A sentence, and the contact of wheel and lever in words."""
    run, end = watch.run, watch.run.simulated
    holding = sums_of(run)["holding"]
    sides = {number: {run.pairs[number].body_a, run.pairs[number].body_b} for number in holding}
    teeth = [number for number in holding if sides[number] == {watch.wheel, lever}]
    pins = [number for number in holding if sides[number] == {watch.oscillator, lever}]
    if not teeth:
        held = not watch.has_modes or any(watch.wheel in both for both in sides.values())
        return "" if held else f"{watch.wheel} touches nothing that holds it", None
    if len(teeth) > 1:
        return _caught(watch, lever, arms(run, watch.compiled, end, teeth)), str(run.pairs[teeth[0]])
    found = arms(run, watch.compiled, end, [teeth[0], *pins])
    rests, pair = face(watch, found, 0), str(found.pairs[0])
    moving = _still_moving(watch)
    if not pins or moving:
        return f"{rests}; {_without_pin(watch, moving, rests)}", pair
    why = _torques(watch, lever, found, rests)
    return (f"{rests}; {why}", pair) if why else ("", pair)


def _caught(watch: Watch, lever: str, found: Arms) -> str:
    """Two contacts of the wheel hold the lever: as where, for want of drop, the recoiling wheel meets the other pallet."""
    places = [f"{face(watch, found, row)} ({pair})" for row, pair in enumerate(found.pairs)]
    held = [name for name, way in (("anticlockwise", 1.0), ("clockwise", -1.0)) if not _passes(watch.wheel, lever, found, way)]
    end = f": as {lever} turns {' or '.join(held)}, {watch.wheel} cannot make way for both" if held else ""
    return " and ".join(places) + end


def _passes(wheel: str, lever: str, found: Arms, way: float) -> bool:
    """Whether some turn of the wheel keeps all gaps open as the lever begins to turn one way."""
    least, most = -np.inf, np.inf
    for row in range(len(found.pairs)):
        opens, by_wheel = found.of(row, lever)[0] * way, found.of(row, wheel)[0]
        if by_wheel > 0.0:
            least = max(least, -opens / by_wheel)
        elif by_wheel < 0.0:
            most = min(most, -opens / by_wheel)
        elif opens < 0.0:
            return False
    return bool(least <= most)


def _still_moving(watch: Watch) -> bool:
    run = watch.run
    late = run.t >= run.simulated - 0.5 * watch.found.nominal_period
    return bool(np.ptp(run.q[late, run.slices[watch.oscillator].start], axis=0) > HELD)


def _without_pin(watch: Watch, moving: bool, rests: Face) -> str:
    at = degrees(float(watch.angle(watch.oscillator, np.array([watch.run.simulated]))[0]) - watch.rest)
    if moving:
        why = f"and {watch.wheel} does not drive it on" if rests.impulse else "but too little to unlock it"
        return f"{watch.oscillator} still swings, now at {at}, {why}"
    return f"{watch.oscillator} is at rest at {at} and does not touch {watch.lever}"


def _torques(watch: Watch, lever: str, found: Arms, rests: Face) -> str:
    """What the one side gives at the lever, and what the other needs: on lock the oscillator drives, on impulse the wheel.

    "" where that would be enough: then something else holds the lever.
    """
    by_wheel = at_lever(found, 0, watch.wheel, lever, rests.out)
    by_pin = [at_lever(found, row, watch.oscillator, lever, rests.out) for row in range(1, len(found.pairs))]
    if by_wheel is None:
        return "friction jams it there"
    given = max((value for value in by_pin if value is not None), key=abs, default=0.0)
    if rests.impulse:
        if abs(by_wheel) > abs(given):
            return ""
        less, more = _told_apart(by_wheel, given)
        needed = f"is below the {more} needed to move {watch.oscillator} (set on impulse)"
        return f"the torque of {watch.wheel} at {lever}, {less}, {needed}"
    if given <= 0.0:
        return f"{watch.oscillator} does not push {lever} out (set on lock)"
    if given > abs(by_wheel):
        return ""
    less, more = _told_apart(given, by_wheel)
    return f"the torque of {watch.oscillator} at {lever}, {less}, is below the {more} needed to unlock (set on lock)"


def _told_apart(first: float, second: float) -> tuple[str, str]:
    """In the unit of the larger, with as many digits as it takes."""
    unit = torque_text(max(first, second, key=abs)).split()[-1]
    for digits in (2, 3, 5):
        texts = show(abs(first), unit, digits), show(abs(second), unit, digits)
        if texts[0] != texts[1]:
            break
    return texts


# In this order: what comes first is the cause of what comes after it.
QUESTIONS = (backwards, overbanking, standing, tripping, knocking, unsettled)


def verdict(run: Trajectory, found: Beats | None = None) -> Verdict:
    """What the watch of a run does at its end; `found` are its beats, where already at hand.

    Its name is None where nothing keeps time: no oscillator, or no driven wheel that keeps it going. A run whose rows were
    not kept is judged by its events alone, as far as these go.
    """
    if not swings(run.scene):
        return NOTHING
    watch = watch_of(run, beats(run) if found is None else found)
    if watch is None:
        return NOTHING
    judged = _judged(watch)
    kind = timekeeper(run.scene)
    kind = kind if kind == "clock" or keeps_time(run.scene) else "mechanism"  # a click may pass its rest position
    return replace(judged, message=judged.message and judged.message.replace("the watch", f"the {kind}"))


def _judged(watch: Watch) -> Verdict:
    for question in QUESTIONS:
        answer = question(watch)
        if answer is not None:
            return answer
    return Verdict(TICKS, "the watch ticks" + "".join(f", {one}" for one in _but(watch)))


def _but(watch: Watch) -> Iterator[str]:
    """What did not go well before."""
    blows = knocks(watch)
    if blows is not None:
        yield f"after it knocked until {when(blows.last)}"
    missed = missed_beats(watch.run)
    if missed:
        yield f"but missed {missed} {'beat' if missed == 1 else 'beats'}"
