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
from watchsim.jit import hot_kernel, kernel
from watchsim.model.records import LINE
from watchsim.simulation.events.handover import is_beside_active
from watchsim.simulation.first_closing.gap_bounds import body_bounds, centre_distance, gap_bounds, next_stretch
from watchsim.simulation.first_closing.lasting_gap import may_last, time_apart, time_still
from watchsim.simulation.first_closing.safe_times import (
    is_due,
    room_outside,
    safe_time,
    time_held,
    time_immovable,
    time_outside,
    time_to_touch,
    time_to_zero,
)
from watchsim.simulation.first_closing.sunk_level import sunk_level
from watchsim.simulation.first_closing.waiting_contacts import drop_first, put
from watchsim.simulation.loop_state.scratch import ask
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.sleeping import is_at_rest
from watchsim.simulation.motion.step_path import body_on_path
from watchsim.tolerances import FINE_LOOK, TIME_ROUNDING

LOOKS_AT_ONCE = 16  # at one contact, before one that could close earlier has its turn


@kernel
def _place(model, state, bodies, tau, step, path):
    """Bring two bodies to time tau of the step."""
    body_on_path(model, state, step, bodies[0], tau, path)
    body_on_path(model, state, step, bodies[1], tau, path)


@kernel
def _look(model, state, options, k, anew, level, path):
    """(gap of contact k above its level, rate, how far it is inside either primitive, level, which is found `anew` or kept)."""
    state.counts.gap_evaluations += 1
    gap, rate, inside_a, inside_b = placed_gap(model, k, path.pose)
    if anew:
        level = sunk_level(model, options, k, gap, inside_b, path)
    return gap - level, rate, inside_a + options.extent, inside_b + options.extent, level  # beyond their ends still counts


@kernel
def crossing(model, state, options, k, start, end, step, path):
    """(time, closes?): open contact k closes at that time within [start, end), or does not until then.

    After `LOOKS_AT_ONCE` looks the time may be short of `end`.
    """
    contact = model.contacts[k]
    body_a, body_b = model.primitives[contact.a].body, model.primitives[contact.b].body
    _place(model, state, (body_a, body_b), start, step, path)
    length, closing, bend, swing = next_stretch(model, options, k, end - start, step, path)
    if closing == 0.0 and length == end - start:
        return end, False
    tau, stretch = start, start + length
    # `outside`: on the free side; `clear`: has been further than rounding from it since. Gaps count from `level`.
    fresh, outside, clear, beside, level = True, True, False, 0.0, 0.0
    last_look = state.counts.gap_evaluations + LOOKS_AT_ONCE
    while tau < end and state.counts.gap_evaluations < last_look:
        if tau > start:
            _place(model, state, (body_a, body_b), tau, step, path)
        if tau >= stretch:
            length, closing, bend, swing = next_stretch(model, options, k, end - tau, step, path)
            stretch = tau + length
        anew = fresh or beside > 0.0  # what lay beside its primitives was no contact until now
        gap, rate, inside_a, inside_b, level = _look(model, state, options, k, anew, level, path)
        distance = centre_distance(model, k, path.pose)
        if fresh or not outside:
            outside, clear = gap >= -options.gap_zero, beside > 0.0
        fresh = True
        leaving = gap > options.gap_zero or rate > options.speed_zero
        clear = clear or (outside and leaving)  # a contact that has just rebounded returns to this gap by falling only
        beside = time_outside(model, k, inside_a, inside_b, (closing, swing), distance)
        # Positions jump where drift is taken back: a gap may have closed by that.
        near = gap <= options.gap_zero if outside else gap >= -options.behind
        if near and min(inside_a, inside_b) < 0.0:
            # At least the time in which the gap cannot pass through its rounding.
            wait = max(beside, options.gap_zero / closing)
            if wait < FINE_LOOK * (end - tau):
                way_in = -inside_b if model.primitives[contact.b].kind == LINE else 0.0
                wait = max(wait, time_still(model, state, k, max(options.gap_zero, way_in), end - tau, tau, step, path))
            tau += max(wait, TIME_ROUNDING * tau)
        elif is_due(gap, rate, outside, clear, options):
            wait = time_held(model, state, options, k, tau, rate, (closing, bend, swing, distance), path)
            if wait == 0.0:
                rest = time_to_touch(gap, rate, (closing, bend, distance), options) if outside and clear else 0.0
                time = tau + rest if tau + rest < end else tau
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


@hot_kernel
def _stays_open_for(model, state, options, k, length, first, bounds, path):
    """A time in which contact k cannot close, from one look at the current poses; infinity if it is `length` or more.

    `bounds` are the `body_bounds` of the pair's bodies, of body `first` and of the other one.
    """
    here = normal_gap(model, k, path.pose)
    gap, rate = here.gap, here.rate
    state.counts.gap_evaluations += 1
    if -options.behind <= gap <= options.gap_zero or sunk_level(model, options, k, gap, 0.0, path) < 0.0:
        return 0.0
    # Behind its primitive a contact must come out before it can close.
    room, approach = (gap, -rate) if gap > 0.0 else (-gap, rate)
    # The circle may be on either body of the pair.
    in_order = model.primitives[model.contacts[k].a].body == first
    closing, bend, _ = gap_bounds(model, k, length, bounds[0 if in_order else 1], bounds[1 if in_order else 0], path)
    if room > closing * length:
        return math.inf
    safe = safe_time(room, approach, closing, bend, centre_distance(model, k, path.pose))
    return math.inf if safe >= length else safe


@kernel
def _list(model, cells, state, options, p, span, count, step, path):
    """(known, number waiting): put the contacts of pair p that may close in its cell among those that wait.

    With them when the pair enters its next cell. `span`: the time at which it is in this cell, and the end of the search.
    """
    pair, waiting, tau, end = model.pairs[p], path.waiting, span[0], span[1]
    _place(model, state, (pair.a, pair.b), tau, step, path)
    until = min(end, tau + time_in_cell(model, p, path.q, path.u, step.bound))
    how, start, number = candidates(model, cells, p, path.q)
    if how == UNKNOWN:
        return False, count
    if how == LISTED:
        state.counts.cells_looked_up += 1
    bounds = (body_bounds(model, pair.a, until - tau, step, path), body_bounds(model, pair.b, until - tau, step, path))
    for place in range(start, start + number):
        k = candidate(model, cells, how, place)
        if state.mode[k] != OPEN or is_beside_active(model, state, k):
            continue
        stays = tau + _stays_open_for(model, state, options, k, until - tau, pair.a, bounds, path)
        if stays < until:
            count = put(waiting, count, k, p, (tau, until, stays))
    if until < end:
        count = put(waiting, count, NO_CONTACT, p, (until, until, until))
    return True, count


@kernel
def first_touch(model, cells, state, options, end, scratch):
    """(known, time, contact) of the first closing in [0, end) of the current step, or NO_CONTACT.

    `known` is False when a cell was met that nobody has asked about: it is then in `scratch.asked`. The contact that could
    close first is looked at next: what lies far off is not searched beyond the first closing, however long the step.
    """
    best, who, step, path = end, NO_CONTACT, scratch.step, scratch.path
    count, known = 0, True
    for p in range(len(model.pairs)):
        if is_at_rest(model, state, model.pairs[p].a) and is_at_rest(model, state, model.pairs[p].b):
            continue
        known, count = _list(model, cells, state, options, p, (0.0, end), count, step, path)
        if not known:
            ask(scratch.asked, p, path.q)
            return False, 0.0, NO_CONTACT
    while count > 0 and path.waiting[0].stays_open < best:
        first = path.waiting[0]
        k, p, start, until = first.contact, first.pair, first.start, first.until
        count = drop_first(path.waiting, count)
        if k == NO_CONTACT:
            known, count = _list(model, cells, state, options, p, (start, best), count, step, path)
            if not known:
                ask(scratch.asked, p, path.q)
                return False, 0.0, NO_CONTACT
            continue
        until = min(until, best)
        time, closes = crossing(model, state, options, k, start, until, step, path)
        if closes:
            best, who = time, k
        elif time < until:
            count = put(path.waiting, count, k, p, (time, until, time))
    return True, best, who
