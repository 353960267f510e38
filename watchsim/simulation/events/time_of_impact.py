"""When, within the current step, does an open contact close first? None may be missed.

Safe steps: with a bound B of |g''| over a stretch of time the gap stays above g + g' d - B d²/2, so time may advance to that
parabola's zero. Near a contact this is Newton's method from the safe side (it converges quadratically and never jumps over
a root); far from it, one evaluation covers the whole stretch. The bounds hold for the motion as computed (step_path.py).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from watchsim.candidates.cell_lookup import LISTED, UNKNOWN, candidate, candidates, time_in_cell
from watchsim.contact.gaps import normal_gap, placed_gap
from watchsim.contact.kinematics import contact_kinematics
from watchsim.jit import kernel
from watchsim.model.records import FIXED, LINE, SLIDE
from watchsim.simulation.events.gap_bounds import body_bounds, centre_distance, gap_bounds, next_stretch
from watchsim.simulation.events.handover import is_beside_active, room_beside_active
from watchsim.simulation.events.immovable import is_immovable
from watchsim.simulation.motion.sleeping import is_at_rest
from watchsim.simulation.motion.step_path import body_on_path
from watchsim.simulation.scratch import ask
from watchsim.simulation.state import NO_CONTACT
from watchsim.simulation.tolerances import IMMOVABLE, NEIGHBOUR_STRIDE, SLOWEST_CLOSING, TIME_ROUNDING


@kernel
def _safe(room, approach, closing, bend, distance):
    """A time within which a gap with this much room, closing now at rate `approach`, cannot close."""
    straight = room / closing
    if distance < math.inf:
        # Over this time the centres stay at least half as far apart as now.
        limit = 0.5 * distance / closing
        bend += closing * closing / (0.5 * distance) if distance > 0.0 else 0.0
    else:
        limit = math.inf
    root = math.sqrt(approach * approach + 2.0 * bend * room)
    if approach > 0.0:
        curved = 2.0 * room / (approach + root)
    else:
        curved = (root - approach) / bend if bend > 0.0 else math.inf
    return max(straight, min(curved, limit))


@kernel
def _time_outside(model, k, seen, motion):
    """A time for which a contact stays outside its primitives, from how far inside each it is; 0 if it is inside both.

    `motion`: bounds of the closing speed and of the relative turning.
    """
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    closing, swing = motion
    near, inside_a, inside_b = 0.5 * seen.distance, seen.inside_a, seen.inside_b
    turn = swing + closing / near  # of the normal in either body, while the centres keep half their distance
    time = 0.0
    if inside_a < 0.0:
        time = -inside_a / (turn * max(a.radius, a.length)) if turn > 0.0 else math.inf
    if inside_b < 0.0:
        time = max(time, -inside_b / (closing if b.kind == LINE else turn * b.radius))
    return min(time, near / closing)


@kernel
def _is_due(seen, outside, clear, options):
    """True if the gap crosses zero from the free side, or lies within the rounding behind it and goes on closing."""
    gap, rate, zero, band = seen.gap, seen.rate, options.gap_zero, options.behind
    if outside:
        return gap <= zero and ((clear and rate < 0.0) or gap < -zero)
    return gap >= -band and (rate < -options.speed_zero or (rate < 0.0 and gap <= zero - band))


@kernel
def _time_to_zero(seen, outside, closing, bend, options):
    """A time within which a gap, now at some distance from zero, is not due."""
    gap, rate, distance = seen.gap, seen.rate, seen.distance
    if not outside:
        safe = _safe(-gap, rate, closing, bend, distance)
        if gap >= -options.behind:
            safe = min(safe, _safe(gap + options.behind, -rate, closing, bend, distance))
        return safe
    return _safe(max(gap, 0.0) if _is_leaving(seen, options) else gap + 2.0 * options.gap_zero, -rate, closing, bend, distance)


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


class Seen(NamedTuple):
    """A contact at one time."""

    gap: float  # m
    rate: float  # m/s
    inside_a: float  # how far inside each of its primitives it lies, the extent that still counts included, m
    inside_b: float
    distance: float  # of the two centres, m


@kernel
def _look(model, state, options, k, pose):
    """Contact k at the current poses."""
    state.counts.gap_evaluations += 1
    gap, rate, inside_a, inside_b = placed_gap(model, k, pose)
    return Seen(gap, rate, inside_a + options.extent, inside_b + options.extent, centre_distance(model, k, pose))


@kernel
def _is_leaving(seen, options):
    """True if the gap is open beyond rounding, or opens."""
    return seen.gap > options.gap_zero or seen.rate > options.speed_zero


@kernel
def _time_as_one(seen, closing, swing, room, options):
    """A time for which a contact stays the same as the one in force beside it; `room`: see `room_beside_active`."""
    way, turn = room
    turning = swing + closing / (0.5 * seen.distance)
    same = 0.5 * min(way / closing, turn / turning if turning > 0.0 else math.inf)
    return max(same, NEIGHBOUR_STRIDE * options.extent / closing)


@kernel
def _time_of_due(seen, crosses, tau, end):
    """When a gap that is due at `tau` closes: at once, but that of a contact that `crosses` zero slowly where it gets there."""
    soon = crosses and seen.gap > 0.0 and seen.rate * (end - tau) < -seen.gap
    return min(end, tau + seen.gap / -seen.rate) if soon else tau


@kernel
def time_of_impact(model, state, options, k, start, end, step, path):
    """First time in [start, end) at which open contact k closes inside its primitives; infinity if it does not.

    Conservative advancement: from each look to the next no gap can close. The two bodies must stand where they are at `start`.
    """
    length, closing, bend, swing = next_stretch(model, options, k, end - start, step, path)
    tau, stretch = start, start + length
    # `outside`: on the free side; `clear`: has been further than rounding from it since.
    fresh, outside, clear, beside = True, True, False, 0.0
    while tau < end:
        if tau > start:
            _place_contact(model, state, k, tau, step, path)
        if tau >= stretch:
            length, closing, bend, swing = next_stretch(model, options, k, end - tau, step, path)
            stretch = tau + length
        seen = _look(model, state, options, k, path.pose)
        if fresh or not outside:
            outside, clear = seen.gap >= -options.gap_zero, beside > 0.0  # what lay beside was no contact until now
        leaving = _is_leaving(seen, options)
        clear = clear or (outside and leaving)  # a contact that has just rebounded returns to this gap by falling only
        beside = _time_outside(model, k, seen, (closing, swing))
        # Positions jump where drift is taken back: a gap may have closed by that.
        near = seen.gap <= options.gap_zero if outside else seen.gap >= -options.behind
        fresh = True
        if near and min(seen.inside_a, seen.inside_b) < 0.0:
            # At least the time in which the gap cannot pass through its rounding.
            tau += max(beside, options.gap_zero / closing)
        elif _is_due(seen, outside, clear, options):
            # Where a smooth outline goes on, its next piece has no gap either, and closes only when its turn comes.
            room = room_beside_active(model, state, options, k, path.pose)
            if room[0] < 0.0:
                wait = _time_immovable(model, options, k, seen.rate, bend, path)
                if not wait > 0.0:
                    return _time_of_due(seen, outside and clear, tau, end)
                tau += max(wait, TIME_ROUNDING * tau)
                continue
            tau += _time_as_one(seen, closing, swing, room, options)
        else:
            clear = clear and leaving if outside else clear
            safe = _time_to_zero(seen, outside, closing, bend, options)
            safe = max(safe, _time_immovable(model, options, k, seen.rate, bend, path) if near and not leaving else 0.0)
            # Beside its primitives the gap may pass through zero: which side it is on afterwards is found anew.
            fresh = beside > safe
            # Never less than the rounding of time itself.
            tau += beside if fresh else max(safe, TIME_ROUNDING * tau)
        if stretch < end:
            tau = min(tau, stretch)
    return math.inf


@kernel
def _place_contact(model, state, k, tau, step, path):
    """Bring both bodies of contact k to time tau of the step."""
    contact = model.contacts[k]
    body_on_path(model, state, step, model.primitives[contact.a].body, tau, path)
    body_on_path(model, state, step, model.primitives[contact.b].body, tau, path)


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
    return room > closing * length or _safe(room, approach, closing, bend, centre_distance(model, k, path.pose)) >= length


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
        if state.mode[k] != 0 or is_beside_active(model, state, k):
            continue
        if not _stays_open(model, state, options, k, until - tau, pair.a, bounds, path):
            path.doubt[doubts] = k
            doubts += 1
    for j in range(doubts):
        if j > 0:
            _place_pair(model, state, pair, tau, step, path)
        root = time_of_impact(model, state, options, path.doubt[j], tau, best, step, path)
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
