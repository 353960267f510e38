"""Which gap rates count as zero?

As a rule those below `speed_zero`, which is what tolerances leave of a rate that is zero. But bodies may move on a pair of
nearly parallel faces whose gap rates are tiny and yet not zero: a follower that passes a shallow kink at v closes the gap to
the next face at v times the angle. Where taking small rates for zero contradicts itself, only what is rounding of the
velocities counts as zero (`exactly`), at that instant and in that island.
"""

from __future__ import annotations

from watchsim.contact.index_sets import OPEN
from watchsim.contact.kinematics import gap_acceleration
from watchsim.dynamics.acceleration import accelerate
from watchsim.jit import kernel
from watchsim.simulation.motion.drift_projection import find_correction, rate_left
from watchsim.tolerances import CONTRADICTING_RATE, DEPENDENT_AT_EVENTS, RATE_FLOOR, RATE_ROUNDING, TILT_ROUNDING


@kernel
def note_pace(u, out_pace):
    """Keep the largest magnitude of each velocity at this instant: rounding goes with what was before an impact, too."""
    for j in range(len(u)):
        out_pace[j] = max(out_pace[j], abs(u[j]))


@kernel
def rounding_of(closed, i, options, pace):
    """What counts as rounding in the gap rate of contact i, m/s."""
    terms, across = 0.0, 0.0
    for k in range(closed.slots[i]):
        terms += abs(closed.w_N[i, k]) * pace[closed.coord[i, k]]
        across += abs(closed.w_T[i, k]) * pace[closed.coord[i, k]]
    return RATE_ROUNDING * terms + TILT_ROUNDING * across + RATE_FLOOR * options.size


@kernel
def set_rate_zeros(closed, m, exactly, options, pace, out_zero):
    """For each of the m contacts the magnitude up to which its gap rate is zero, m/s."""
    for i in range(m):
        out_zero[i] = rounding_of(closed, i, options, pace) if exactly else options.speed_zero


@kernel
def contradicts(model, state, r, options, work, event):
    """True if the modes decided for the r contacts in `event.rest` show that their gap rates only seemed to be zero.

    Those in force cannot all have none, or the one that has just closed goes on closing. Writes to `state.a`.
    """
    if _sinks(model, state, r, options, work, event):
        return True
    rest = event.rest
    find_correction(rest, r, event.decided, DEPENDENT_AT_EVENTS, work)
    for i in range(r):
        left = abs(rate_left(rest, r, i, work)) if event.decided[rest.ids[i]] != OPEN else 0.0
        if left > CONTRADICTING_RATE * rounding_of(rest, i, options, event.pace):
            return True
    return False


@kernel
def _sinks(model, state, r, options, work, event):
    """True if the contact that has just closed opens, and would sink in by more than `gap_zero` before it is parted.

    It would close again at once, and again, since nothing takes its approach away.
    """
    rest = event.rest
    for i in range(r):
        rate = rest.kin[i].gN_dot
        if rest.ids[i] != state.now.touched or event.decided[rest.ids[i]] != OPEN:
            continue
        if rate < -rounding_of(rest, i, options, event.pace):
            accelerate(model, rest, r, work, state.a)
            room = max(rest.kin[i].g, 0.0) + options.gap_zero
            return rate * rate > 2.0 * room * gap_acceleration(rest, i, state.a)
    return False
