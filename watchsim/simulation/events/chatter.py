"""When do impacts that alternate between contacts come to their end, and what is left then?

A block that rocks from corner to corner, or a disc between two flanks, makes infinitely many impacts in a finite time, also
without restitution: no single contact rebounds, so the rule for rebounds (collision.py) does not see it. A contact that the
others' impulses lift by less than `gap_close`, the distance at which contacts count as closed, is not lifted at all.

What is left is found from the contacts' plastic impact over the time until all of them are back, forces acting: it tells
which of them carry something then, and which leave after all. Nothing is stopped that these impulses cannot stop.
"""

from __future__ import annotations

import math

from watchsim.contact.index_sets import BACKWARD, FORWARD, STICK
from watchsim.contact.kinematics import contact_kinematics, gap_acceleration
from watchsim.dynamics.acceleration import decide_modes, solve_mode
from watchsim.dynamics.delassus import apply, contact_velocities
from watchsim.dynamics.impact import plastic_impact
from watchsim.jit import kernel
from watchsim.simulation.events.impulse_check import kinetic_energy
from watchsim.simulation.events.mode_decision import standing_bearings
from watchsim.tolerances import CHATTER_BACK, CHATTER_GAIN, WITHIN_CONE


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
