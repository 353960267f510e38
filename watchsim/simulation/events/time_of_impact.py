"""When, within the current step, does an open contact close first? None may be missed.

Conservative advancement of second order: time advances by what the bounds of the gap's motion (gap_bounds.py) call safe
(safe_times.py). Near a contact this is Newton's method from the safe side (it converges quadratically and never jumps over a
root); far from it, one evaluation covers the whole stretch.
"""

from __future__ import annotations

import math

from watchsim.candidates.cell_lookup import LISTED, UNKNOWN, candidate, candidates, time_in_cell
from watchsim.contact.gaps import normal_gap, placed_gap
from watchsim.contact.index_sets import OPEN
from watchsim.jit import kernel
from watchsim.model.records import LINE
from watchsim.simulation.events.gap_bounds import body_bounds, centre_distance, gap_bounds, next_stretch
from watchsim.simulation.events.handover import is_beside_active
from watchsim.simulation.events.lasting_gap import may_last, time_apart, time_still
from watchsim.simulation.events.safe_times import (
    is_due,
    room_outside,
    safe_time,
    time_held,
    time_immovable,
    time_outside,
    time_to_zero,
)
from watchsim.simulation.loop_state.scratch import ask
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.sleeping import is_at_rest
from watchsim.simulation.motion.step_path import body_on_path
from watchsim.tolerances import FINE_LOOK, TIME_ROUNDING

LOOKS_AT_ONCE = 64  # at one contact, before the others have their turn


@kernel
def crossing(model, state, options, k, start, end, step, path):
    """(time, closes?): open contact k closes at that time within [start, end), or does not until then.

    After `LOOKS_AT_ONCE` looks the time may be short of `end`. The two bodies must stand where they are at `start`.
    """
    contact = model.contacts[k]
    body_a, body_b = model.primitives[contact.a].body, model.primitives[contact.b].body
    length, closing, bend, swing = next_stretch(model, options, k, end - start, step, path)
    if closing == 0.0 and length == end - start:
        return end, False
    zero = options.gap_zero
    tau, stretch = start, start + length
    # `outside`: on the free side; `clear`: has been further than rounding from it since.
    fresh, outside, clear, beside = True, True, False, 0.0
    last_look = state.counts.gap_evaluations + LOOKS_AT_ONCE
    while tau < end and state.counts.gap_evaluations < last_look:
        if tau > start:
            body_on_path(model, state, step, body_a, tau, path)
            body_on_path(model, state, step, body_b, tau, path)
        if tau >= stretch:
            length, closing, bend, swing = next_stretch(model, options, k, end - tau, step, path)
            stretch = tau + length
        gap, rate, inside_a, inside_b = placed_gap(model, k, path.pose)
        distance = centre_distance(model, k, path.pose)
        state.counts.gap_evaluations += 1
        if fresh or not outside:
            outside, clear = gap >= -zero, beside > 0.0  # what lay beside its primitives was no contact until now
        fresh = True
        leaving = gap > zero or rate > options.speed_zero
        clear = clear or (outside and leaving)  # a contact that has just rebounded returns to this gap by falling only
        inside_a, inside_b = inside_a + options.extent, inside_b + options.extent  # beyond their ends still counts
        beside = time_outside(model, k, inside_a, inside_b, (closing, swing), distance)
        # Positions jump where drift is taken back: a gap may have closed by that.
        near = gap <= zero if outside else gap >= -options.behind
        if near and min(inside_a, inside_b) < 0.0:
            # At least the time in which the gap cannot pass through its rounding.
            wait = max(beside, zero / closing)
            if wait < FINE_LOOK * (end - tau):
                way_in = -inside_b if model.primitives[contact.b].kind == LINE else 0.0
                wait = max(wait, time_still(model, state, k, max(zero, way_in), end - tau, tau, step, path))
            tau += max(wait, TIME_ROUNDING * tau)
        elif is_due(gap, rate, outside, clear, options):
            wait = time_held(model, state, options, k, tau, rate, (closing, bend, swing, distance), path)
            if wait == 0.0:
                soon = outside and clear and gap > 0.0 and rate * (end - tau) < -gap
                time = min(end, tau + gap / -rate) if soon else tau
                return time, time < end
            tau += wait
        else:
            clear = clear and leaving if outside else clear
            safe = time_to_zero(gap, rate, outside, (closing, bend, distance), options)
            if outside and safe < FINE_LOOK * (end - tau):
                room = room_outside(gap, rate, options)
                if may_last(room, rate, safe):
                    safe = max(safe, time_apart(model, state, k, room, end - tau, tau, step, path))
            safe = max(safe, time_immovable(model, options, k, rate, bend, path) if near and not leaving else 0.0)
            # Beside its primitives the gap may pass through zero: which side it is on afterwards is found anew.
            fresh = beside > safe
            # Never less than the rounding of time itself.
            tau += beside if fresh else max(safe, TIME_ROUNDING * tau)
        if stretch < end:
            tau = min(tau, stretch)
    return min(tau, end), False


@kernel
def _stays_open(model, state, options, k, length, first, bounds, path):
    """True if one look at the current poses shows that contact k cannot close in the next `length` seconds.

    `bounds` are the `body_bounds` of the pair's bodies, of body `first` and of the other one.
    """
    here = normal_gap(model, k, path.pose)
    gap, rate = here.gap, here.rate
    state.counts.gap_evaluations += 1
    if -options.behind <= gap <= options.gap_zero:
        return False
    # Behind its primitive a contact must come out before it can close.
    room, approach = (gap, -rate) if gap > 0.0 else (-gap, rate)
    # The circle may be on either body of the pair.
    in_order = model.primitives[model.contacts[k].a].body == first
    closing, bend, _ = gap_bounds(model, k, length, bounds[0 if in_order else 1], bounds[1 if in_order else 0], path)
    return room > closing * length or safe_time(room, approach, closing, bend, centre_distance(model, k, path.pose)) >= length


@kernel
def _place_pair(model, state, pair, tau, step, path):
    body_on_path(model, state, step, pair.a, tau, path)
    body_on_path(model, state, step, pair.b, tau, path)


@kernel
def _first_of(model, cells, state, options, p, tau, until, step, path):
    """(known, time up to which all is found, time, contact) of the first closing in [tau, until) of pair p in one cell."""
    pair = model.pairs[p]
    best, who, reached = until, NO_CONTACT, until
    how, start, count = candidates(model, cells, p, path.q)
    if how == UNKNOWN:
        return False, tau, until, NO_CONTACT
    if how == LISTED:
        state.counts.cells_looked_up += 1
    bounds = (body_bounds(model, pair.a, until - tau, step, path), body_bounds(model, pair.b, until - tau, step, path))
    doubts = 0
    for place in range(start, start + count):
        k = candidate(model, cells, how, place)
        if state.mode[k] != OPEN or is_beside_active(model, state, k):
            continue
        if not _stays_open(model, state, options, k, until - tau, pair.a, bounds, path):
            path.doubt[doubts] = k
            doubts += 1
    for j in range(doubts):
        if j > 0:
            _place_pair(model, state, pair, tau, step, path)
        reached, closes = crossing(model, state, options, path.doubt[j], tau, reached, step, path)
        if closes:
            best, who = reached, path.doubt[j]
    return True, reached, best, who


@kernel
def _search(model, cells, state, options, p, first, step, path):
    """(known, time, contact): the first closing known when pair p has had its turn; `first`: the one known before.

    Goes on from where the last turn ended, `path.searched`, to the first closing, or to where a contact has had its looks.
    """
    pair, tau = model.pairs[p], path.searched[p]
    best, who = first
    looking = True
    while looking and tau < best:
        _place_pair(model, state, pair, tau, step, path)
        until = min(best, tau + time_in_cell(model, p, path.q, path.u, step.bound))
        known, tau, root, k = _first_of(model, cells, state, options, p, tau, until, step, path)
        if not known:
            return False, best, who
        if k >= 0:
            best, who = root, k
        looking = tau == until
    path.searched[p] = tau
    return True, best, who


@kernel
def first_touch(model, cells, state, options, end, scratch):
    """(known, time, contact) of the first closing in [0, end) of the current step, or NO_CONTACT.

    `known` is False when a cell was met that nobody has asked about: it is then in `scratch.asked`. Pairs take turns: looks
    that a slow gap needs until the end are wasted where another one closes long before.
    """
    best, who, step, path = end, NO_CONTACT, scratch.step, scratch.path
    for p in range(len(model.pairs)):
        pair = model.pairs[p]
        rests = is_at_rest(model, state, pair.a) and is_at_rest(model, state, pair.b)
        path.searched[p] = math.inf if rests else 0.0
    unfinished = True
    while unfinished:
        unfinished = False
        for p in range(len(model.pairs)):
            if path.searched[p] >= best:
                continue
            known, best, who = _search(model, cells, state, options, p, (best, who), step, path)
            if not known:
                ask(scratch.asked, p, path.q)
                return False, 0.0, NO_CONTACT
            unfinished = unfinished or path.searched[p] < best
    return True, best, who
