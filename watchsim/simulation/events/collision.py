"""What happens at an impact?

All closed contacts of the island take part. The energy is checked; where the law would gain any, the documented rule applies
(docs/theory/method.md 2.7); rebounds that would accumulate within `accumulation_time` are ended by an inelastic solution, and
so is chatter between contacts (chatter.py).
"""

from __future__ import annotations

import math

from watchsim.contact.poses import place
from watchsim.dynamics.acceleration import accelerate
from watchsim.dynamics.delassus import contact_velocities, drive_through_contacts
from watchsim.dynamics.impact import energy_change, impact
from watchsim.dynamics.small_systems import copy
from watchsim.jit import kernel
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.events.chatter import chatter_time, end_chatter, may_be_chatter, pressed_time, return_time
from watchsim.simulation.events.closed_contacts import refresh
from watchsim.simulation.events.impulse_check import kinetic_energy
from watchsim.simulation.events.mode_decision import count_problems, decide
from watchsim.simulation.events.shrinking_play import end_endless
from watchsim.simulation.events.zero_rates import note_pace, rounding_of
from watchsim.simulation.record.write_buffers import keep_event
from watchsim.tolerances import ENERGY_GAIN, HIDDEN_REBOUND, REBOUND_ROUNDING


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
    ended, ends = jam == 0.0 and end_endless(state, m, options, event, room), state.clock.time
    for _ in range(1 + m):
        if not _solve(model, state, m, jam, work, event.closed, room):
            copy(room.before, state.u)
            return False
        for row in range(2 * m):
            room.impulse[row] = work.force[row]
        place(model, state.q, state.u, event.pose)
        refresh(model, m, event.closed, event.pose)
        note_pace(state.u, event.pace)
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
