"""Which contacts jam: slide such that a normal force on them pulls their bodies together (Painlevé)?

Where nothing presses such a contact, the laws have several solutions (docs/theory/method.md 2.6).
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.tolerances import ACCELERATION_ROUNDING, NUDGE, PAINLEVE


@kernel
def press_unloaded(model, closed, m, work):
    """Settle what happens where nothing presses a contact in whose direction of slip it would jam; True if any is pressed.

    There the laws have more than one solution, and the rounding of a load that is zero would choose between them. Without
    slip the contact holds, as it would under any load however small: it is pressed by next to nothing. With slip it goes
    on without a force.
    """
    pressed = False
    for i in range(m):
        if not _jams(work, m, i, PAINLEVE) or not _is_unloaded(model, closed, i, work):
            continue
        if work.tangent[i] < 0:
            work.rhs[i] = max(0.0, work.rhs[i])
        elif work.loaded[2 * i + 1] != 0.0:
            work.rhs[i] -= NUDGE * abs(work.loaded[2 * i + 1]) * work.unit[i]
            pressed = True
    return pressed


@kernel
def _is_unloaded(model, closed, i, work):
    """True if the gap of contact i does not accelerate without its force, but for rounding, that of its lever arms among it."""
    terms = closed.kin[i].bar_size
    for k in range(closed.slots[i]):
        j = closed.coord[i, k]
        arm = abs(closed.w_N[i, k]) + abs(closed.w_T[i, k])
        terms += arm * (abs(work.h[j]) + model.coordinates[j].load) * work.inverse[j]
    return abs(work.loaded[2 * i]) <= ACCELERATION_ROUNDING * terms


@kernel
def is_paradox(work, m, i, near=PAINLEVE):
    """True if contact i, all by itself, slides such that a normal force on it pulls its bodies together, or nearly so.

    Works with the G and drag of `solve_mode` and `decide_modes`. `near`: the share of G_N by which it may still part them.
    """
    return work.tangent[i] < 0 and _jams(work, m, i, near)


@kernel
def _jams(work, m, i, near):
    """The same of a contact without slip, in the direction in which it would begin to slide."""
    own = work.G[2 * i, 2 * i]
    if own == 0.0:
        return False
    if own - work.drag[i] * work.G[2 * i, 2 * i + 1] > near * own:
        return False
    for j in range(m):
        if j != i and (work.G[2 * i, 2 * j] != 0.0 or work.G[2 * i, 2 * j + 1] != 0.0 or work.G[2 * i + 1, 2 * j] != 0.0):
            return False
    return True
