"""What happens at an impact?

All closed contacts of the island take part (`collide`). The energy is checked; where the law would gain any, the documented
rule applies (docs/theory/method.md 2.7). Rebounds that would accumulate within `accumulation_time` are ended by an inelastic
solution, so are rebounds in a play that shrinks, and so is chatter between contacts (docs/theory/method.md 2.9).
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import BACKWARD, FORWARD, STICK, contact_kinematics, gap_acceleration
from watchsim.dynamics.acceleration import accelerate, decide_modes, solve_mode
from watchsim.dynamics.bearings import begin_loads
from watchsim.dynamics.delassus import apply, contact_velocities, copy, drive_through_contacts
from watchsim.dynamics.friction import law_of
from watchsim.dynamics.impact import energy_gain, impact, plastic_impact
from watchsim.dynamics.lcp import Level
from watchsim.jit import kernel
from watchsim.simulation.closed_contacts import kinetic_energy
from watchsim.simulation.modes import (
    count_problems,
    decide,
    hold_gaps,
    rate_rounding,
    replace,
    standing_bearings,
    track_peak_speed,
)
from watchsim.simulation.scratch import keep_event
from watchsim.simulation.state import EventKind
from watchsim.tolerances import (
    CHATTER_BACK,
    CHATTER_GAIN,
    ENDLESS_REBOUNDS,
    ENERGY_GAIN,
    HIDDEN_REBOUND,
    NO_IMPULSE,
    REBOUND_ROUNDING,
    SAME_RATE,
    SHRUNK_PLAY,
    WITHIN_CONE,
)


@kernel
def approaching(m, closed, zero):
    """True if a closed contact is about to penetrate; `zero`: the gap rates that count as none, m/s."""
    for i in range(m):
        if closed.kin[i].gN_dot < -zero[i]:
            return True
    return False


@kernel
def collide(model, state, island, m, options, jam_speed, scratch, record):
    """Resolve the impact of the island's m closed contacts: new velocities, kinematics, events. False if none is found.

    `jam_speed` (m/s) is positive where nothing approaches, but a sliding contact needs an infinite force (Painlevé).
    """
    work, event, room = scratch.work, scratch.event, scratch.impact
    copy(state.u, room.before)
    begin_loads(model, state.clock.time, state.q, state.u, work.system)
    for i in range(m):
        room.restitution[i] = law_of(model, event.closed.ids[i]).restitution
    ended, ends = False, state.clock.time
    if jam_speed == 0.0:
        ended = stop_repeated_rebounds(state.returning, state.clock.time, m, options, event, room.restitution)
    for _ in range(1 + m):
        if not _solve(model, m, (jam_speed, options.speed_rest), work, event.closed, room, state.u, state.counts):
            copy(room.before, state.u)
            return False
        for row in range(2 * m):
            room.impulse[row] = work.phases.impulse[row]
        replace(model, state.q, state.u, m, event)
        track_peak_speed(state.u, event.peak_speed)
        found, end = _end_rebounds(model, state, island, m, options, scratch)
        if not found:
            break
        ended, ends = True, max(ends, end)
    for i in range(len(state.u)):
        state.sums.damping -= 0.5 * work.phases.bearing[i] * (room.before[i] + state.u[i])
    jam = (jam_speed, work.problem.last.seized == 1)
    _write(model, state, m, jam, event.closed, room, record, ended, ends)
    if jam_speed == 0.0 and may_be_chatter(m, options, event, room):
        _end_chatter(model, state, island, m, options, scratch, record)
    return True


@kernel
def _solve(model, m, speeds, work, closed, room, out_u, out_counts):
    """One impact with `room.restitution`; again with the smallest restitution, then with none, if it gains energy.

    So, too, where its expansion has no solution. False if none is found: one without restitution that gains energy is wrong.
    """
    kinetic, system, phases = kinetic_energy(model, room.before), work.system, work.phases
    for attempt in range(3):
        copy(room.before, out_u)
        solved = impact(model, closed, m, room.restitution, speeds, system, work.problem, phases, out_u)
        count_problems(work.problem, out_counts)
        if solved:
            gain, terms = energy_gain(2 * m + work.problem.last.bearings, system.G, phases.rates, phases.impulse)
            if gain <= ENERGY_GAIN * kinetic:
                return True
            if attempt == 2:
                return bool(gain <= ENERGY_GAIN * terms)
        elif work.problem.last.level != Level.EXPANSION:
            break
        out_counts.energy_rescues += 1
        least = 1.0 if attempt == 0 else 0.0
        for i in range(m):
            least = min(least, room.restitution[i])
        for i in range(m):
            room.restitution[i] = least
    out_counts.lcp_failures += 1
    return False


@kernel
def _write(model, state, m, jam, closed, room, record, ended, ends):
    """Events and energy of the impact just solved; by contact, the loss is minus the impulse times the mean rate.

    `jam`: (`jam_speed`, has a bearing seized?).
    """
    jam_speed, seized = jam
    contact_velocities(closed, m, room.before, room.rates_before)
    contact_velocities(closed, m, state.u, room.rates)
    state.sums.drive += drive_through_contacts(model, closed, m, room.impulse, state.u)
    largest = 0.0
    for i in range(m):
        largest = max(largest, room.impulse[2 * i])
    for i in range(m):
        N, T, k = 2 * i, 2 * i + 1, closed.ids[i]
        if room.impulse[N] <= NO_IMPULSE * largest:
            continue
        lost = -0.5 * room.impulse[N] * (room.rates_before[N] + room.rates[N])
        lost -= 0.5 * room.impulse[T] * (room.rates_before[T] + room.rates[T])
        row = keep_event(record, state.clock, state.counts, EventKind.IMPACT, k, -1, room.rates_before[N])
        event = record.events[row]
        event.impulse_normal, event.impulse_tangential, event.energy_lost = room.impulse[N], room.impulse[T], lost
        state.sums.impacts += lost
        state.counts.impacts += 1
        stops = seized or abs(room.rates_before[T]) > jam_speed
        if jam_speed > 0.0 and abs(room.rates_before[N]) <= jam_speed and stops:
            keep_event(record, state.clock, state.counts, EventKind.JAM, k, -1, room.rates_before[T])
            state.counts.jams += 1
        if ended and room.restitution[i] == 0.0 and law_of(model, k).restitution > 0.0:
            keep_event(record, state.clock, state.counts, EventKind.ACCUMULATION, k, -1, ends)
            state.counts.accumulations += 1


# Rebounds: those that would end within `accumulation_time` are ended, with restitution 0.


@kernel
def return_time(closed, i, a):
    """Time after which contact i, leaving at its rate under the accelerations a, is closed again, s; infinity if it is not."""
    closing = -gap_acceleration(closed, i, a)
    return 2.0 * closed.kin[i].gN_dot / closing if closing > 0.0 else math.inf


@kernel
def _rebounds(i, options, event, room):
    """True if contact i leaves the impact on its own restitution, and slowly."""
    rate, share = event.closed.kin[i].gN_dot, room.restitution[i]
    return share > 0.0 and room.impulse[2 * i] > 0.0 and event.zero[i] < rate <= options.accumulation_speed


@kernel
def _see_rebounds(m, options, G, impulse, restitution, event):
    """Take nothing but rounding for zero where a contact rebounds at a rate that counts as zero: a rebound all the same.

    Where friction jams, a rate that counts as zero cannot be taken back, and the contact would leave and return for ever.
    """
    for i in range(m):
        rate = event.closed.kin[i].gN_dot
        slowly = restitution[i] > 0.0 and impulse[2 * i] > 0.0 and 0.0 < rate <= event.zero[i]
        if slowly and rate > _rounding(i, options, G, impulse, event):
            for j in range(m):
                event.zero[j] = _rounding(j, options, G, impulse, event)
            return


@kernel
def _rounding(i, options, G, impulse, event):
    """What is rounding in the gap rate of contact i after the impact, m/s: of speeds, and of what its impulse changed."""
    changed = impulse[2 * i] * G[2 * i, 2 * i]
    return rate_rounding(event.closed, i, options, event.peak_speed) + REBOUND_ROUNDING * changed


@kernel
def _accelerations(model, state, island, m, options, scratch):
    """Accelerations of the island after the impact into `state.a`; False if there are none."""
    work, event = scratch.work, scratch.event
    r, solved = decide(model, state, island, m, options, work.system, work.problem, event, scratch.impact.grip)
    if solved:
        accelerate(model, event.rest, r, work.system, state.a)
    return solved


@kernel
def _end_rebounds(model, state, island, m, options, scratch):
    """Flag the rebounds that would end within `accumulation_time` (restitution 0); returns (any?, the latest end)."""
    event, room = scratch.event, scratch.impact
    latest, found, any_rebounds = 0.0, False, False
    _see_rebounds(m, options, scratch.work.system.G, room.impulse, room.restitution, event)
    for i in range(m):
        any_rebounds = any_rebounds or _rebounds(i, options, event, room)
    if not any_rebounds or not _accelerations(model, state, island, m, options, scratch):
        return False, latest
    for i in range(m):
        if not _rebounds(i, options, event, room):
            continue
        back, share = return_time(event.closed, i, state.a), room.restitution[i]
        if back == math.inf:
            continue
        ending = back / (1.0 - share) if share < 1.0 else math.inf
        # A rebound that rises by no more than rounding is none, whatever its restitution: it would go on by rounding alone.
        # One that loses next to nothing would go on for ever: it is none where it stays within what counts as closed.
        lowest = min(options.gap_close, HIDDEN_REBOUND * options.gap_zero / (1.0 - share)) if share < 1.0 else options.gap_close
        hidden = 0.25 * event.closed.kin[i].gN_dot * back <= lowest
        if ending < options.accumulation_time or hidden:
            room.restitution[i] = 0.0
            found, latest = True, max(latest, state.clock.time + (ending if share < 1.0 else back))
    return found, latest


# Shrinking play: a body that lies nearly flat and rocks from corner to corner is hit at one end and thrown back from the other.
# Where friction holds each end for the moment of its impact, an impact without loss sends it back the way it came: it rocks as
# fast as before, in a play that the drives close. The impacts come ever sooner and never end. What resists comes back faster:
# in half the time sqrt(2) times as fast, be it between walls or against a force.


@kernel
def stop_repeated_rebounds(watch, time, m, options, event, out_restitution):
    """Take the restitution from those of the m closed contacts that would rebound without end; True if from any."""
    found = False
    for i in range(m):
        rate = event.closed.kin[i].gN_dot
        hit = rate < -event.zero[i] and out_restitution[i] > 0.0
        if hit and _comes_back_endlessly(watch, time, options, event.closed.ids[i], rate):
            out_restitution[i], found = 0.0, True
    return found


@kernel
def _comes_back_endlessly(watch, time, options, k, rate):
    """Note in `watch` that contact k is hit at this gap rate; True if it is back ever sooner, though no faster.

    Within `accumulation_time` each time, `ENDLESS_REBOUNDS` times at least, and in the end in `SHRUNK_PLAY` of the first time.
    """
    away = time - watch.last
    if watch.contact != k or away == 0.0:
        if away > options.accumulation_time:  # nor does the other one come back as soon
            watch.contact, watch.last, watch.hits = k, time, 0
        return False
    watch.last = time
    if away > options.accumulation_time:
        watch.hits = 0
        return False
    if watch.hits == 0 or abs(rate - watch.rate) > SAME_RATE * abs(watch.rate):
        watch.hits, watch.away, watch.rate = 0, away, rate
    watch.hits += 1
    return watch.hits > ENDLESS_REBOUNDS and away <= SHRUNK_PLAY * watch.away


# Chatter: a block that rocks from corner to corner, or a disc between two flanks, makes infinitely many impacts in a finite
# time, also without restitution: no single contact rebounds, so the rule for rebounds does not see it. A contact that the
# others' impulses lift by less than `gap_close`, the distance at which contacts count as closed, is not lifted at all.
#
# What is left is found from the contacts' plastic impact over the time until all of them are back, forces acting: it tells
# which of them carry something then, and which leave after all. Nothing is stopped that these impulses cannot stop.


@kernel
def may_be_chatter(m, options, event, room):
    """True if after an impact some contact is slowly leaving, and none of those that were hit keeps all its energy."""
    found = False
    for i in range(m):
        rate = event.closed.kin[i].gN_dot
        if rate > options.accumulation_speed:
            return False
        hit = room.impulse[2 * i] > 0.0
        if hit and room.restitution[i] == 1.0:
            return False
        # Where only contacts leave that rebound, their own rule knows when that would end.
        if rate > event.zero[i] and not (hit and room.restitution[i] > 0.0):
            found = True
    return found


@kernel
def chatter_time(m, a, options, event):
    """(time until the contacts that leave under the accelerations a are back, s; does one of them not come back by itself?).

    Infinity if one that does comes further than `gap_close`.
    """
    latest, apart = 0.0, False
    for i in range(m):
        rate = event.closed.kin[i].gN_dot
        if rate <= event.zero[i]:
            continue
        back = return_time(event.closed, i, a)
        if back == math.inf:
            apart = True
        # It rises on a parabola, to a quarter of the way it would go at its first speed.
        elif 0.25 * rate * back > options.gap_close:
            return math.inf, apart
        else:
            latest = max(latest, back)
    return latest, apart


@kernel
def pressed_time(model, a, island, m, options, system, problem, event, room):
    """The same of contacts that come back only once others have: a block on one that falls with it until that one lands.

    The forces that all m contacts had if none of them left say what presses each of them back then.
    """
    bearings = standing_bearings(event.label, island, room.grip, problem.bearing)
    if not decide_modes(model, event.closed, m, bearings, options.speed_zero, system, problem, room.grip, room.mode):
        return math.inf
    latest = 0.0
    for i in range(m):
        rate, pressed = event.closed.kin[i].gN_dot, system.force[2 * i] * system.G[2 * i, 2 * i]
        if rate <= event.zero[i] or return_time(event.closed, i, a) < math.inf:
            continue
        if not 0.5 * rate * rate <= options.gap_close * pressed:
            return math.inf
        latest = max(latest, 2.0 * rate / pressed)
    return latest


@kernel
def end_chatter(model, u, m, duration, still, lenience, work, event, room):
    """Find what ends a chatter: (found?, how many contacts, in `event.rest`, end in force).

    `duration`: (`time` that it lasts, s, and what the impact has `taken`, J); slips up to `still` (m/s) are rest. The impulses
    are left in `room.ending`. P are the impulses of the plastic impact with the rates that free motion over `time` would lead
    to, lambda the forces of the contacts that P finds in force. What lambda does will be integrated when that time passes; the
    rest is done now: u += M⁻¹ W (P - lambda time). Not done where that would gain more energy than the impact has just taken.
    `work.system` holds h and the inverse masses of the last decision.
    """
    time, taken = duration
    closed, rest, ending, system, phases = event.closed, event.rest, room.ending, work.system, work.phases
    if not plastic_impact(model, closed, m, time, still, u, system, work.problem, phases):
        return False, 0
    r = 0
    for i in range(m):
        N, T = phases.impulse[2 * i], phases.impulse[2 * i + 1]
        if N <= 0.0:
            continue
        k = closed.ids[i]
        bound = work.problem.drag[i] * N
        if abs(T) < (1.0 - WITHIN_CONE) * bound:
            room.mode[k] = STICK
        elif bound > 0.0:
            room.mode[k] = BACKWARD if T > 0.0 else FORWARD
        else:
            room.mode[k] = BACKWARD if closed.kin[i].gT_dot < 0.0 else FORWARD
        contact_kinematics(model, k, event.pose, r, rest)
        ending[2 * r], ending[2 * r + 1] = N, T
        r += 1
    solve_mode(model, rest, r, room.mode, lenience, system, work.modes)
    for row in range(2 * r):
        ending[row] -= system.force[row] * time
    # Less pressure for a moment is less friction, which will come: of what the impact took, no more than that is given back.
    kinetic = kinetic_energy(model, u)
    contact_velocities(rest, r, u, phases.rates)
    gain, _ = energy_gain(2 * r, system.G, phases.rates, ending)
    return not gain > max(CHATTER_GAIN * kinetic, min(taken, CHATTER_BACK * kinetic)), r


@kernel
def _end_chatter(model, state, island, m, options, scratch, record):
    """End the chatter of the island's m closed contacts, if it is one; its energy goes to the impacts."""
    work, event, room = scratch.work, scratch.event, scratch.impact
    if not _accelerations(model, state, island, m, options, scratch):
        return
    time, apart = chatter_time(m, state.a, options, event)
    if apart and 0.0 < time < math.inf:
        time = max(time, pressed_time(model, state.a, island, m, options, work.system, work.problem, event, room))
    if not 0.0 < time < math.inf:
        return
    before = kinetic_energy(model, state.u)
    taken = kinetic_energy(model, room.before) - before
    copy(state.u, room.before)
    terms = (time, taken), options.speed_rest, state.instant.lenience
    found, r = end_chatter(model, state.u, m, *terms, work, event, room)
    count_problems(work.problem, state.counts)
    if found:
        apply(event.rest, r, room.ending, work.system.inverse, state.u)
    contact_velocities(event.closed, m, state.u, room.rates)
    for i in range(m):
        if not found or room.rates[2 * i] < -event.zero[i]:
            copy(room.before, state.u)
            return  # the impacts go on one by one
    for i in range(m):
        if event.closed.kin[i].gN_dot > event.zero[i]:
            back = state.clock.time + min(time, return_time(event.closed, i, state.a))
            keep_event(record, state.clock, state.counts, EventKind.ACCUMULATION, event.closed.ids[i], -1, back)
            state.counts.accumulations += 1
    replace(model, state.q, state.u, m, event)
    driven = drive_through_contacts(model, event.rest, r, room.ending, state.u)
    _hold_hidden(model, state, island, m, options, scratch)
    state.sums.drive += driven
    state.sums.impacts += before + driven - kinetic_energy(model, state.u)


@kernel
def _hold_hidden(model, state, island, m, options, scratch):
    """Hold those of the m closed contacts that leave a chatter so slowly that they rise by no more than rounding.

    Gaps are found closed up to `gap_zero` behind where they are: a fall from there would keep the chatter going for ever.
    """
    closed, event, r, hidden = scratch.event.closed, scratch.event, 0, False
    if not _accelerations(model, state, island, m, options, scratch):
        return
    for i in range(m):
        rate = closed.kin[i].gN_dot
        if rate > event.zero[i]:
            if not 0.25 * rate * return_time(closed, i, state.a) <= HIDDEN_REBOUND * options.gap_zero:
                continue
            hidden = True
        contact_kinematics(model, closed.ids[i], event.pose, r, event.rest)
        r += 1
    if hidden:
        hold_gaps(model, r, options, scratch.work.system, event, scratch.projection, state.u)
        replace(model, state.q, state.u, m, event)
