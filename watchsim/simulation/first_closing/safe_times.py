"""For how long can a gap certainly not close?

With a bound B of |g''| over a stretch of time the gap stays above g + g' d - B d²/2, so time may advance to that parabola's
zero; and what lies outside its primitives, cannot move, or goes on from a contact in force need not be looked at for a while.
"""

from __future__ import annotations

import math

from watchsim.contact.kinematics import contact_kinematics
from watchsim.jit import kernel
from watchsim.model.records import FIXED, LINE, SLIDE
from watchsim.simulation.events.handover import room_beside_active
from watchsim.simulation.events.immovable import is_immovable
from watchsim.tolerances import IMMOVABLE, NEIGHBOUR_STRIDE, SLOWEST_CLOSING, TIME_ROUNDING


@kernel
def safe_time(room, approach, closing, bend, distance):
    """A time within which a gap with this much room, closing now at rate `approach`, cannot close."""
    straight = room / closing
    if distance < math.inf:
        # Over this time the centres stay at least half as far apart as now.
        limit = 0.5 * distance / closing
        if distance > 0.0:
            bend += closing * closing / (0.5 * distance)
    else:
        limit = math.inf
    root = math.sqrt(approach * approach + 2.0 * bend * room)
    curved = math.inf
    if approach > 0.0:
        curved = 2.0 * room / (approach + root)
    elif bend > 0.0:
        curved = (root - approach) / bend
    return max(straight, min(curved, limit))


@kernel
def time_outside(model, k, inside_a, inside_b, motion, distance):
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
def is_due(gap, rate, outside, clear, options):
    """True if the gap crosses zero from the free side, or lies within the rounding behind it and goes on closing."""
    zero, band = options.gap_zero, options.behind
    if outside:
        return gap <= zero and ((clear and rate < 0.0) or gap < -zero)
    return gap >= -band and (rate < -options.speed_zero or (rate < 0.0 and gap <= zero - band))


@kernel
def time_to_zero(gap, rate, outside, bounds, options):
    """A time within which a gap, now at some distance from zero, is not due. `bounds`: closing, bend, distance."""
    closing, bend, distance = bounds
    if not outside:
        safe = safe_time(-gap, rate, closing, bend, distance)
        if gap >= -options.behind:
            safe = min(safe, safe_time(gap + options.behind, -rate, closing, bend, distance))
        return safe
    return safe_time(room_outside(gap, rate, options), -rate, closing, bend, distance)


@kernel
def time_to_touch(gap, rate, bounds, options):
    """In how long a gap closes that is zero to rounding and falls: where its tangent vanishes, unless it could be deeper then.

    A gap that has only begun to fall has a tangent that vanishes much later. `bounds`: closing, bend, distance.
    """
    closing, bend, distance = bounds
    if gap <= 0.0:
        return 0.0
    time = gap / -rate
    return time if 0.5 * bend * time * time <= options.gap_zero else safe_time(gap, -rate, closing, bend, distance)


@kernel
def room_outside(gap, rate, options):
    """How far a gap on the free side may fall before it is due."""
    leaving = gap > options.gap_zero or rate > options.speed_zero
    return max(gap, 0.0) if leaving else gap + 2.0 * options.gap_zero


@kernel
def time_immovable(model, options, k, rate, bend, path):
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
def time_held(model, state, options, k, tau, rate, bounds, path):
    """For how long a contact that is due need not close: 0 if it closes now. `bounds`: closing, bend, swing, distance."""
    closing, bend, swing, distance = bounds
    # Where a smooth outline goes on, its next piece has no gap either, and closes only when its turn comes.
    way, turn = room_beside_active(model, state, options, k, path.pose)
    if way < 0.0:
        wait = time_immovable(model, options, k, rate, bend, path)
        return max(wait, TIME_ROUNDING * tau) if wait > 0.0 else 0.0
    # It is the same contact at least until points or normals could have come apart.
    turning = swing + closing / (0.5 * distance)
    same = 0.5 * min(way / closing, turn / turning if turning > 0.0 else math.inf)
    return max(same, NEIGHBOUR_STRIDE * options.extent / closing)
