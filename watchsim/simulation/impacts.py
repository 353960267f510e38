"""What happens at an impact?

All closed contacts of the island take part. The energy is checked; where the law would gain any, the documented rule applies
(docs/theory/method.md 2.7); rebounds that would accumulate within `accumulation_time` are ended by an inelastic solution, and
so is chatter between contacts (chatter.py).
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import BACKWARD, FORWARD, STICK, contact_kinematics, gap_acceleration, place
from watchsim.dynamics.acceleration import accelerate, decide_modes, solve_mode
from watchsim.dynamics.delassus import apply, contact_velocities, copy, drive_through_contacts
from watchsim.dynamics.impact import energy_change, impact, plastic_impact
from watchsim.jit import kernel
from watchsim.simulation.closed_contacts import kinetic_energy, refresh
from watchsim.simulation.modes import count_problems, decide, rounding_of, standing_bearings, track_peak_speed
from watchsim.simulation.scratch import keep_event
from watchsim.simulation.state import EventKind
from watchsim.tolerances import (
    CHATTER_BACK,
    CHATTER_GAIN,
    ENDLESS_REBOUNDS,
    ENERGY_GAIN,
    HIDDEN_REBOUND,
    REBOUND_ROUNDING,
    SAME_RATE,
    SHRUNK_PLAY,
    WITHIN_CONE,
)

# Does a contact rebound without end, because the play in which it does closes?
#
# A body that lies nearly flat and rocks from corner to corner is hit at one end and thrown back from the other. Where friction
# holds each end for the moment of its impact, an impact without loss sends it back the way it came: it rocks as fast as before,
# in a play that the drives close. The impacts come ever sooner and never end (docs/theory/method.md 2.9). What resists
# comes back faster: in half the time sqrt(2) times as fast, be it between walls or against a force.


@kernel
def stop_repeated_rebounds(state, m, options, event, room):
    """Take the restitution from those of the m closed contacts that would rebound without end; True if from any."""
    found = False
    for i in range(m):
        rate = event.closed.kin[i].gN_dot
        hit = rate < -event.zero[i] and room.restitution[i] > 0.0
        if hit and _comes_back_endlessly(state, options, event.closed.ids[i], rate):
            room.restitution[i], found = 0.0, True
    return found


@kernel
def _comes_back_endlessly(state, options, k, rate):
    """Note that contact k is hit at this gap rate; True if it is back ever sooner, though no faster.

    Within `accumulation_time` each time, `ENDLESS_REBOUNDS` times at least, and in the end in `SHRUNK_PLAY` of the first time.
    """
    seen, time = state.returning, state.clock.time
    away = time - seen.last
    if seen.contact != k or away == 0.0:
        if away > options.accumulation_time:  # nor does the other one come back as soon
            seen.contact, seen.last, seen.hits = k, time, 0
        return False
    seen.last = time
    if away > options.accumulation_time:
        seen.hits = 0
        return False
    if seen.hits == 0 or abs(rate - seen.rate) > SAME_RATE * abs(seen.rate):
        seen.hits, seen.away, seen.rate = 0, away, rate
    seen.hits += 1
    return seen.hits > ENDLESS_REBOUNDS and away <= SHRUNK_PLAY * seen.away


# When do impacts that alternate between contacts come to their end, and what is left then?
#
# A block that rocks from corner to corner, or a disc between two flanks, makes infinitely many impacts in a finite time, also
# without restitution: no single contact rebounds, so the rule for rebounds (collision.py) does not see it. A contact that the
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
def return_time(closed, i, a):
    """Time after which contact i, leaving at its rate under the accelerations a, is closed again, s; infinity if it is not."""
    closing = -gap_acceleration(closed, i, a)
    return 2.0 * closed.kin[i].gN_dot / closing if closing > 0.0 else math.inf


@kernel
def chatter_time(state, m, options, event):
    """(time until the contacts that leave are back, s; does one of them not come back by itself?).

    Infinity if one that does comes further than `gap_close`. The accelerations are in `state.a`.
    """
    latest, apart = 0.0, False
    for i in range(m):
        rate = event.closed.kin[i].gN_dot
        if rate <= event.zero[i]:
            continue
        back = return_time(event.closed, i, state.a)
        if back == math.inf:
            apart = True
        # It rises on a parabola, to a quarter of the way it would go at its first speed.
        elif 0.25 * rate * back > options.gap_close:
            return math.inf, apart
        else:
            latest = max(latest, back)
    return latest, apart


@kernel
def pressed_time(model, state, island, m, options, work, event, room):
    """The same of contacts that come back only once others have: a block on one that falls with it until that one lands.

    The forces that all m contacts had if none of them left say what presses each of them back then.
    """
    bearings = standing_bearings(event.label, island, room.grip, work.dry)
    if not decide_modes(model, event.closed, m, bearings, options.speed_zero, work, room.grip, room.mode):
        return math.inf
    latest = 0.0
    for i in range(m):
        rate, pressed = event.closed.kin[i].gN_dot, work.force[2 * i] * work.G[2 * i, 2 * i]
        if rate <= event.zero[i] or return_time(event.closed, i, state.a) < math.inf:
            continue
        if not 0.5 * rate * rate <= options.gap_close * pressed:
            return math.inf
        latest = max(latest, 2.0 * rate / pressed)
    return latest


@kernel
def end_chatter(model, state, m, ended, work, event, room):
    """Velocities at the end of a chatter: (found, how many contacts (`event.rest`) end in force).

    Where no end is found, velocities are unchanged. The impulses are left in `room.ending`.
    `ended`: (time that it lasts, kinetic energy that the impact has just taken).

    P are the impulses of the plastic impact with the rates that free motion over `time` would lead to, lambda the
    forces of the contacts that P finds in force. What lambda does will be integrated when that time passes; the rest
    is done now: u += M⁻¹ W (P - lambda time). Not done where that would gain more energy than the impact took. `work` holds h
    and the inverse masses of the last decision.
    """
    closed, rest, ending = event.closed, event.rest, room.ending
    time, taken = ended
    if not plastic_impact(model, closed, m, time, state.u, work):
        return False, 0
    r = 0
    for i in range(m):
        N, T = work.force[2 * i], work.force[2 * i + 1]
        if N <= 0.0:
            continue
        k = closed.ids[i]
        bound = model.laws[model.contacts[k].group].friction * N
        if abs(T) < (1.0 - WITHIN_CONE) * bound:
            room.mode[k] = STICK
        elif bound > 0.0:
            room.mode[k] = BACKWARD if T > 0.0 else FORWARD
        else:
            room.mode[k] = BACKWARD if closed.kin[i].gT_dot < 0.0 else FORWARD
        contact_kinematics(model, k, event.pose, r, rest)
        ending[2 * r], ending[2 * r + 1] = N, T
        r += 1
    solve_mode(model, rest, r, room.mode, state.now.lenience, work)
    for row in range(2 * r):
        ending[row] -= work.force[row] * time
    # Less pressure for a moment is less friction, which will come: of what the impact took, no more than that is given back.
    kinetic = kinetic_energy(model, state.u)
    if _gain(rest, r, state.u, ending, work) > max(CHATTER_GAIN * kinetic, min(taken, CHATTER_BACK * kinetic)):
        return False, 0
    apply(rest, r, ending, work.inverse, state.u)
    return True, r


@kernel
def _gain(rest, r, u, impulse, work):
    """Kinetic energy that the impulses add to the motion u, J."""
    contact_velocities(rest, r, u, work.b)
    gain = 0.0
    for row in range(2 * r):
        jump = 0.0
        for column in range(2 * r):
            jump += work.G[row, column] * impulse[column]
        gain += impulse[row] * (work.b[row] + 0.5 * jump)
    return gain


# What happens at an impact?


@kernel
def approaching(m, closed, zero):
    """True if a closed contact is about to penetrate; `zero`: the gap rates that count as none."""
    for i in range(m):
        if closed.kin[i].gN_dot < -zero[i]:
            return True
    return False


@kernel
def _law_restitution(model, closed, m, out_restitution):
    for i in range(m):
        out_restitution[i] = model.laws[model.contacts[closed.ids[i]].group].restitution


@kernel
def _least_restitution(m, restitution):
    least = 1.0
    for i in range(m):
        least = min(least, restitution[i])
    return least


@kernel
def _solve(model, state, m, jam, work, closed, room):
    """One impact with `room.restitution`; on an energy gain again with the smallest restitution, then with none.

    False if none is found: even without restitution an impact that gains energy is wrong.
    """
    kinetic = kinetic_energy(model, room.before)
    for attempt in range(3):
        copy(room.before, state.u)
        solved = impact(model, closed, m, room.restitution, jam, work, state.u)
        count_problems(state, work)
        if not solved:
            state.counts.lcp_failures += 1
            return False
        change, terms = energy_change(m, work)
        if change <= ENERGY_GAIN * kinetic:
            return True
        if attempt == 2:
            return bool(change <= ENERGY_GAIN * terms)
        state.counts.energy_rescues += 1
        least = _least_restitution(m, room.restitution) if attempt == 0 else 0.0
        for i in range(m):
            room.restitution[i] = least
    return False


@kernel
def _rebounds(i, options, event, room):
    """True if contact i leaves the impact on its own restitution, and slowly."""
    rate, share = event.closed.kin[i].gN_dot, room.restitution[i]
    return share > 0.0 and room.impulse[2 * i] > 0.0 and event.zero[i] < rate <= options.accumulation_speed


@kernel
def _see_rebounds(m, options, event, work, room):
    """Take nothing but rounding for zero where a contact rebounds at a rate that counts as zero: a rebound all the same.

    Where friction jams, a rate that counts as zero cannot be taken back, and the contact would leave and return for ever.
    """
    for i in range(m):
        rate = event.closed.kin[i].gN_dot
        slowly = room.restitution[i] > 0.0 and room.impulse[2 * i] > 0.0 and 0.0 < rate <= event.zero[i]
        if slowly and rate > _rounding(i, options, event, work, room):
            for j in range(m):
                event.zero[j] = _rounding(j, options, event, work, room)
            return


@kernel
def _rounding(i, options, event, work, room):
    """What is rounding in the gap rate of contact i after the impact, m/s: of speeds, and of what its impulse changed."""
    changed = room.impulse[2 * i] * work.G[2 * i, 2 * i]
    return rounding_of(event.closed, i, options, event.pace) + REBOUND_ROUNDING * changed


@kernel
def _accelerations(model, state, island, m, options, scratch):
    """Accelerations of the island after the impact into `state.a`; False if there are none."""
    work, event = scratch.work, scratch.event
    r, solved = decide(model, state, island, m, options, work, event, scratch.impact.grip)
    if not solved:
        return False
    accelerate(model, event.rest, r, work, state.a)
    return True


@kernel
def _end_rebounds(model, state, island, m, options, scratch):
    """Flag the rebounds that would end within `accumulation_time` (restitution 0); returns (any?, the latest end)."""
    event, room = scratch.event, scratch.impact
    latest, found, worth = 0.0, False, False
    _see_rebounds(m, options, event, scratch.work, room)
    for i in range(m):
        worth = worth or _rebounds(i, options, event, room)
    if not worth or not _accelerations(model, state, island, m, options, scratch):
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


@kernel
def collide(model, state, island, m, options, jam, scratch, record):
    """Resolve the impact of the island's m closed contacts: new velocities, kinematics, events. False if none is found.

    `jam` (m/s) is positive where nothing approaches, but a sliding contact needs an infinite force (Painlevé).
    """
    work, event, room = scratch.work, scratch.event, scratch.impact
    copy(state.u, room.before)
    _law_restitution(model, event.closed, m, room.restitution)
    ended, ends = jam == 0.0 and stop_repeated_rebounds(state, m, options, event, room), state.clock.time
    for _ in range(1 + m):
        if not _solve(model, state, m, jam, work, event.closed, room):
            copy(room.before, state.u)
            return False
        for row in range(2 * m):
            room.impulse[row] = work.force[row]
        place(model, state.q, state.u, event.pose)
        refresh(model, m, event.closed, event.pose)
        track_peak_speed(state.u, event.pace)
        found, end = _end_rebounds(model, state, island, m, options, scratch)
        if not found:
            break
        ended, ends = True, max(ends, end)
    _write(model, state, m, jam, event.closed, room, record, ended, ends)
    if jam == 0.0 and may_be_chatter(m, options, event, room) and _accelerations(model, state, island, m, options, scratch):
        time, apart = chatter_time(state, m, options, event)
        if apart and 0.0 < time < math.inf:
            time = max(time, pressed_time(model, state, island, m, options, work, event, room))
        if 0.0 < time < math.inf:
            _end_chatter(model, state, m, time, scratch, record)
    return True


@kernel
def _end_chatter(model, state, m, time, scratch, record):
    """End the chatter of the m closed contacts within `time`; its energy goes to the impacts."""
    work, event, room = scratch.work, scratch.event, scratch.impact
    before = kinetic_energy(model, state.u)
    taken = kinetic_energy(model, room.before) - before
    copy(state.u, room.before)
    found, r = end_chatter(model, state, m, (time, taken), work, event, room)
    count_problems(state, work)
    contact_velocities(event.closed, m, state.u, room.rates)
    for i in range(m):
        if not found or room.rates[2 * i] < -event.zero[i]:
            copy(room.before, state.u)
            return  # the impacts go on one by one
    for i in range(m):
        if event.closed.kin[i].gN_dot > event.zero[i]:
            back = state.clock.time + min(time, return_time(event.closed, i, state.a))
            keep_event(state, record, EventKind.ACCUMULATION, event.closed.ids[i], -1, back)
            state.counts.accumulations += 1
    place(model, state.q, state.u, event.pose)
    refresh(model, m, event.closed, event.pose)
    driven = drive_through_contacts(model, event.rest, r, room.ending, state.u)
    state.sums.drive += driven
    state.sums.impacts += before + driven - kinetic_energy(model, state.u)


@kernel
def _write(model, state, m, jam, closed, room, record, ended, ends):
    """Events and energy of the impact just solved; by contact, the loss is minus the impulse times the mean rate."""
    contact_velocities(closed, m, room.before, room.rates_before)
    contact_velocities(closed, m, state.u, room.rates)
    state.sums.drive += drive_through_contacts(model, closed, m, room.impulse, state.u)
    for i in range(m):
        N, T = 2 * i, 2 * i + 1
        if room.impulse[N] <= 0.0:
            continue
        lost = -0.5 * room.impulse[N] * (room.rates_before[N] + room.rates[N])
        lost -= 0.5 * room.impulse[T] * (room.rates_before[T] + room.rates[T])
        row = keep_event(state, record, EventKind.IMPACT, closed.ids[i], -1, room.rates_before[N])
        event = record.events[row]
        event.impulse_normal, event.impulse_tangential, event.energy_lost = room.impulse[N], room.impulse[T], lost
        state.sums.impacts += lost
        state.counts.impacts += 1
        if jam > 0.0 and abs(room.rates_before[N]) <= jam < abs(room.rates_before[T]):
            keep_event(state, record, EventKind.JAM, closed.ids[i], -1, room.rates_before[T])
            state.counts.jams += 1
        if ended and room.restitution[i] == 0.0 and model.laws[model.contacts[closed.ids[i]].group].restitution > 0.0:
            keep_event(state, record, EventKind.ACCUMULATION, closed.ids[i], -1, ends)
            state.counts.accumulations += 1
