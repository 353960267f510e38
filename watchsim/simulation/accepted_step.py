"""Where are the bodies at the end of a coupled step, and when is that?

The path of a step drifts off the contacts in force. Drift is taken back, and a contact that ends the step closes where that
has been done (docs/theory/method.md 2.10): the next one of two nearly parallel faces would be met late otherwise.
"""

from __future__ import annotations

from watchsim.contact.gaps import normal_gap
from watchsim.contact.index_sets import OPEN
from watchsim.contact.poses import place
from watchsim.jit import kernel
from watchsim.simulation.events.closed_contacts import refresh
from watchsim.simulation.events.impulse_check import is_explained, kinetic_energy
from watchsim.simulation.loop_state.scratch import SUMS
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.contact_islands import place_contacts
from watchsim.simulation.motion.coupled_motion import motion
from watchsim.simulation.motion.dense_output import dense_value
from watchsim.simulation.motion.drift_projection import project_positions, project_velocities
from watchsim.simulation.motion.free_motion import flow
from watchsim.tolerances import DEPENDENT_IN_STEPS, HIDDEN_REBOUND, RATES_TURNED

NEWTON_STEPS = 6


@kernel
def accept_coupled(model, state, options, end, touched, scratch):
    """Bring the state to time `end` of a coupled step, or to when `touched` closes: sums, positions and velocities.

    Returns (that time, True; False where drift is no rounding).
    """
    before = _follow_step(model, state, options, end, scratch)
    if touched != NO_CONTACT:
        end, before = _follow_to_touch(model, state, options, (end, before), touched, scratch)
    smooth = scratch.smooth
    n = len(model.coordinates)
    state.sums.drive += smooth.y[2 * n]
    state.sums.damping += smooth.y[2 * n + 1]
    state.sums.friction += smooth.y[2 * n + 2]
    for i in range(n):
        state.a[i] = smooth.dy[n + i]
    state.worst.kinetic_energy = max(state.worst.kinetic_energy, before)
    return end, is_explained(model, options, before, kinetic_energy(model, state.u), state.worst.kinetic_energy)


@kernel
def _follow_to_touch(model, state, options, followed, touched, scratch):
    """Bring the state, which is where a coupled step ends, to where contact `touched` closes on the way without drift.

    `followed` and what is returned: (time, kinetic energy before drift is taken back, J). The end of the step stays the end
    where the contact does not close before. Between nearly parallel faces the drift of a contact in force is a long way to the
    next face.
    """
    pose, (end, before) = scratch.smooth.pose, followed
    tau, kinetic = end, before
    for _ in range(NEWTON_STEPS):
        place(model, state.q, state.u, pose)
        look = normal_gap(model, touched, pose)
        if abs(look.gap) <= HIDDEN_REBOUND * options.gap_zero:
            return tau, kinetic
        if (tau == end and look.gap > 0.0) or look.rate >= 0.0:
            break
        earlier = min(tau - look.gap / look.rate, end)
        if earlier <= 0.0:
            break
        tau, kinetic = earlier, _follow_step(model, state, options, earlier, scratch)
    if tau < end:
        _follow_step(model, state, options, end, scratch)
    return end, before


@kernel
def _follow_step(model, state, options, end, scratch):
    """Positions and velocities at time `end` of a coupled step, drift taken back; returns the kinetic energy before that, J."""
    step, work, smooth = scratch.step, scratch.work, scratch.smooth
    closed, pose = smooth.closed, smooth.pose
    n = len(model.coordinates)
    for i in range(2 * n + SUMS):
        value = dense_value(step, i, end) if end < step.span.length else step.y1[i]
        smooth.y[i] = value
        if i < n:
            state.q[i] = value
        elif i < 2 * n:
            state.u[i - n] = value
    for i in range(n):
        coordinate = model.coordinates[i]
        if coordinate.driven and coordinate.linear:  # known in closed form: no error of steps adds up
            state.q[i], state.u[i] = flow(coordinate, OPEN, step.y0[i], step.y0[n + i], end)
            smooth.y[i], smooth.y[n + i] = state.q[i], state.u[i]
    motion(model, state, options, step.span.start + end, work, smooth)
    before = kinetic_energy(model, state.u)
    first = 0
    while first < state.now.awake_contacts:
        m = place_contacts(model, state.active, first, state.upto[first], pose, closed)
        deepest = project_positions(closed, m, True, options.behind, work, state.q)
        state.worst.penetration = max(state.worst.penetration, deepest)
        if _turns_rates(model, state, options, m, closed):
            place(model, state.q, state.u, pose)
            refresh(model, m, closed, pose)
        project_velocities(closed, m, state.mode, DEPENDENT_IN_STEPS, work, state.u)
        first += m
    return before


@kernel
def _turns_rates(model, state, options, m, closed):
    """True if taking back the gaps of the m contacts changes their rates, by the gap times how fast bodies turn."""
    furthest, fastest = 0.0, 0.0
    for i in range(m):
        furthest = max(furthest, abs(closed.kin[i].g))
    for i in range(len(state.u)):
        fastest = max(fastest, abs(state.u[i]) / model.coordinates[i].scale)
    return furthest * fastest > RATES_TURNED * options.speed_zero
