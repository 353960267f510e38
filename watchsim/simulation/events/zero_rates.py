"""Which gap rates count as zero?

As a rule those below `speed_zero`, which is what tolerances leave of a rate that is zero. But bodies may move on a pair of
nearly parallel faces whose gap rates are tiny and yet not zero: a follower that passes a shallow kink at v closes the gap to
the next face at v times the angle. Where taking small rates for zero contradicts itself, only what is rounding of the
velocities counts as zero (`exactly`), at that instant and in that island.
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.tolerances import RATE_FLOOR, RATE_ROUNDING, TILT_ROUNDING


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
