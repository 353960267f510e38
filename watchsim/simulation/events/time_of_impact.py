"""When, within the current step, does an open contact close first? None may be missed.

Safe steps: with a bound B of |g''| over a stretch of time the gap stays above g + g' d - B d²/2, so time may advance to that
parabola's zero. Near a contact this is Newton's method from the safe side (it converges quadratically and never jumps over
a root); far from it, one evaluation covers the whole stretch. The bounds hold for the motion as computed (step_path.py).
"""

from __future__ import annotations

import math

from watchsim.candidates.cell_lookup import LISTED, UNKNOWN, candidate, candidates, time_in_cell
from watchsim.contact.gaps import normal_gap, placed_gap
from watchsim.contact.index_sets import OPEN
from watchsim.contact.kinematics import contact_kinematics
from watchsim.jit import kernel
from watchsim.model.records import FIXED, LINE, SLIDE
from watchsim.simulation.events.gap_bounds import body_bounds, centre_distance, gap_bounds, next_stretch, safe_time
from watchsim.simulation.events.handover import is_beside_active, room_beside_active
from watchsim.simulation.events.immovable import is_immovable
from watchsim.simulation.events.lasting_gap import time_apart, time_still
from watchsim.simulation.loop_state.scratch import ask
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.sleeping import is_at_rest
from watchsim.simulation.motion.step_path import body_on_path
from watchsim.simulation.tolerances import FINE_LOOK, IMMOVABLE, NEIGHBOUR_STRIDE, SLOWEST_CLOSING, TIME_ROUNDING


@kernel
def _time_outside(model, k, inside_a, inside_b, motion, distance):
    """A time for which a contact stays outside its primitives, from how far inside each it is; 0 if it is inside both."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    closing, swing = motion
    near = 0.5 * distance
    turn = swing + closing / near  # of the normal in either body, while the centres keep half their distance
    time = 0.0
    if inside_a < 0.0:
        time = -inside_a / (turn * max(a.radius, a.length)) if turn > 0.0 else math.inf
    if inside_b < 0.0:
        time = max(time, -inside_b / (closing if b.kind == LINE else turn * b.radius))
    return min(time, near / closing)


@kernel
def _is_due(gap, rate, outside, clear, options):
    """True if a gap that comes from outside has closed, or one that lies within the rounding behind it goes on closing."""
    zero, band = options.gap_zero, options.behind
    if outside:
        return gap <= zero and ((clear and rate < 0.0) or gap < -zero)
    return gap >= -band and (rate < -options.speed_zero or (rate < 0.0 and gap <= zero - band))


@kernel
def _time_to_zero(gap, rate, outside, bounds, options):
    """A time within which a gap, now at some distance from zero, is not due. `bounds`: closing, bend, distance."""
    closing, bend, distance = bounds
    if not outside:
        safe = safe_time(-gap, rate, closing, bend, distance)
        if gap >= -options.behind:
            safe = min(safe, safe_time(gap + options.behind, -rate, closing, bend, distance))
        return safe
    return safe_time(_room_outside(gap, rate, options), -rate, closing, bend, distance)


@kernel
def _room_outside(gap, rate, options):
    """How far a gap on the free side may fall before it is due."""
    leaving = gap > options.gap_zero or rate > options.speed_zero
    return max(gap, 0.0) if leaving else gap + 2.0 * options.gap_zero


@kernel
def _time_beside(model, state, options, k, inside_b, wait, span, step, path):
    """For how long contact k, without a gap and beside its primitives, needs no look: `wait`, or as long as it hardly moves."""
    if wait >= FINE_LOOK * (span[1] - span[0]):
        return wait
    way = -inside_b if model.primitives[model.contacts[k].b].kind == LINE else 0.0
    return max(wait, time_still(model, state, k, max(options.gap_zero, way), span, step, path))


@kernel
def _time_open(model, state, options, k, gap, rate, safe, span, step, path):
    """For how long contact k, on the free side, cannot close: `safe`, or more where that would be one of many looks."""
    if safe >= FINE_LOOK * (span[1] - span[0]):
        return safe
    return max(safe, time_apart(model, state, k, _room_outside(gap, rate, options), span, step, path))


@kernel
def _root_at(gap, rate, tau, end, clear):
    """When a contact that is due closes: where it will within rounding."""
    soon = clear and gap > 0.0 and rate * (end - tau) < -gap
    return min(end, tau + gap / -rate) if soon else tau


@kernel
def _time_immovable(model, options, k, rate, bend, path):
    """Until when contact k, without a gap, need not be looked at because no motion closes it; 0 where one does.

    It may begin to close when its lever arms grow: it is looked at before it is further behind than counts as touching.
    """
    contact_kinematics(model, k, path.pose, 0, path.probe)
    if not is_immovable(model, path.probe, 0):
        return 0.0
    b = model.primitives[model.contacts[k].b]
    motion = model.bodies[b.body].motion
    if b.kind == LINE and motion in (FIXED, SLIDE):
        bend *= math.sqrt(IMMOVABLE)  # the line does not turn: bodies accelerate along it, too
    steady = 0.25 * options.behind / max(-rate, SLOWEST_CLOSING)
    return min(steady, math.sqrt(0.5 * options.behind / max(bend, SLOWEST_CLOSING)))


@kernel
def crossing(model, state, options, k, start, end, step, path):
    """First time in [start, end) at which open contact k closes inside its primitives; infinity if it does not.

    The two bodies must stand where they are at `start`.
    """
    contact = model.contacts[k]
    length, closing, bend, swing = next_stretch(model, options, k, end - start, step, path)
    if closing == 0.0 and length == end - start:
        return math.inf
    zero, tau, stretch = options.gap_zero, start, start + length
    # `outside`: on the free side; `clear`: has been further than rounding from it since.
    fresh, outside, clear, beside = True, True, False, 0.0
    while tau < end:
        if tau > start:
            body_on_path(model, state, step, model.primitives[contact.a].body, tau, path)
            body_on_path(model, state, step, model.primitives[contact.b].body, tau, path)
        if tau >= stretch:
            length, closing, bend, swing = next_stretch(model, options, k, end - tau, step, path)
            stretch = tau + length
        gap, rate, inside_a, inside_b = placed_gap(model, k, path.pose)
        distance = centre_distance(model, k, path.pose)
        state.counts.gap_evaluations += 1
        if fresh or not outside:
            outside, clear = gap >= -zero, beside > 0.0  # what lay beside its primitives was no contact until now
        fresh = False
        leaving = gap > zero or rate > options.speed_zero
        clear = clear or (outside and leaving)  # a contact that has just rebounded returns to this gap by falling only
        # The extent beyond their ends still counts.
        inside_a, inside_b = inside_a + options.extent, inside_b + options.extent
        beside = _time_outside(model, k, inside_a, inside_b, (closing, swing), distance)
        # Positions jump where drift is taken back: a gap may have closed by that.
        near = gap <= zero if outside else gap >= -options.behind
        if near and min(inside_a, inside_b) < 0.0:
            # At least the time in which the gap cannot pass through its rounding.
            wait = _time_beside(model, state, options, k, inside_b, max(beside, zero / closing), (tau, end), step, path)
            tau += max(wait, TIME_ROUNDING * tau)
            fresh = True
        elif _is_due(gap, rate, outside, clear, options):
            # Where a smooth outline goes on, its next piece has no gap either, and closes only when its turn comes.
            way, turn = room_beside_active(model, state, options, k, path.pose)
            if way < 0.0:
                wait = _time_immovable(model, options, k, rate, bend, path)
                if wait > 0.0:
                    tau += max(wait, TIME_ROUNDING * tau)
                    fresh = True
                    continue
                return _root_at(gap, rate, tau, end, outside and clear)
            # It is the same contact at least until points or normals could have come apart.
            turning = swing + closing / (0.5 * distance)
            same = 0.5 * min(way / closing, turn / turning if turning > 0.0 else math.inf)
            tau += max(same, NEIGHBOUR_STRIDE * options.extent / closing)
            fresh = True
        else:
            clear = clear and leaving if outside else clear
            safe = _time_to_zero(gap, rate, outside, (closing, bend, distance), options)
            if outside:
                safe = _time_open(model, state, options, k, gap, rate, safe, (tau, end), step, path)
            safe = max(safe, _time_immovable(model, options, k, rate, bend, path) if near and not leaving else 0.0)
            # Beside its primitives the gap may pass through zero: which side it is on afterwards is found anew.
            fresh = beside > safe
            # Never less than the rounding of time itself.
            tau += beside if fresh else max(safe, TIME_ROUNDING * tau)
        if stretch < end:
            tau = min(tau, stretch)
    return math.inf


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
    """(known, time, contact) of the first closing in [tau, until) among the candidates of pair p in one cell."""
    pair = model.pairs[p]
    best, who = until, NO_CONTACT
    how, start, count = candidates(model, cells, p, path.q)
    if how == UNKNOWN:
        return False, 0.0, NO_CONTACT
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
        root = crossing(model, state, options, path.doubt[j], tau, best, step, path)
        if root < best:
            best, who = root, path.doubt[j]
    return True, best, who


@kernel
def first_touch(model, cells, state, options, end, scratch):
    """(known, time, contact) of the first closing in [0, end) of the current step, or NO_CONTACT.

    `known` is False when a cell was met that nobody has asked about: it is then in `scratch.asked`.
    """
    best, who, step, path = end, NO_CONTACT, scratch.step, scratch.path
    for p in range(len(model.pairs)):
        pair = model.pairs[p]
        if is_at_rest(model, state, pair.a) and is_at_rest(model, state, pair.b):
            continue
        tau = 0.0
        while tau < best:
            _place_pair(model, state, pair, tau, step, path)
            until = min(best, tau + time_in_cell(model, p, path.q, path.u, step.bound))
            known, root, k = _first_of(model, cells, state, options, p, tau, until, step, path)
            if not known:
                ask(scratch.asked, p, path.q)
                return False, 0.0, NO_CONTACT
            if k >= 0:
                best, who = root, k
                break
            tau = until
    return True, best, who
