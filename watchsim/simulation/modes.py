"""Which contacts of an island stay closed now, which of them stick, and which of its bearings does dry friction hold?"""

from __future__ import annotations

from watchsim.contact.gaps import BACKWARD, FORWARD, OPEN, STICK, gap_acceleration, place
from watchsim.dynamics.acceleration import accelerate, decide_modes, solve_mode
from watchsim.dynamics.delassus import LARGEST, fill_inverse, inverse_mass
from watchsim.dynamics.forces import add_drag, forces, set_grips
from watchsim.dynamics.lcp import Solver
from watchsim.jit import kernel
from watchsim.simulation.closed_contacts import kinetic_energy, refresh, resting
from watchsim.simulation.coupled_motion import find_correction, grip_left, normal_margin, project_velocities, rate_left
from watchsim.simulation.scratch import keep_change, keep_event
from watchsim.simulation.state import EventKind
from watchsim.tolerances import (
    BEGIN_SLACK,
    CONTRADICTING_RATE,
    DEAD_CENTRE,
    DEPENDENT_AT_EVENTS,
    FORCE_NOISE,
    LENIENCE_STEP,
    MOST_LENIENT,
    RATE_FLOOR,
    RATE_ROUNDING,
    TILT_ROUNDING,
    VELOCITY_ROUNDING,
)

# Which gap rates count as zero?
#
# As a rule those below `speed_zero`, which is what tolerances leave of a rate that is zero. But bodies may move on a pair of
# nearly parallel faces whose gap rates are tiny and yet not zero: a follower that passes a shallow kink at v closes the gap to
# the next face at v times the angle. Where taking small rates for zero contradicts itself, only what is rounding of the
# velocities counts as zero (`exactly`), at that instant and in that island.


@kernel
def track_peak_speed(u, out_pace):
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


# Has this set of modes been decided at this instant before?
#
# Decisions are made from accelerations, modes end by forces, slips and ways, and where all of these are rounding the two can
# contradict each other for ever. So no set of modes is decided twice at one instant on the same terms: at the second time what
# counts as zero for forces and slips is made ten times larger, until time has gone on. There are finitely many sets of modes
# and
# finitely many such terms, so that every instant comes to an end (docs/theory/method.md 3.5).

BASE, MODULUS = 1000003, 2147483647


@kernel
def begin_instant(state):
    """Forget what was decided before."""
    state.now.decisions, state.now.lenience = 0, 1.0


@kernel
def forget_decisions(state):
    """After an impact the same modes may be decided again: the velocities are others."""
    state.now.decisions = 0


@kernel
def key_of_modes(state):
    """A number for the modes of all contacts in force and the grips of all bearings."""
    key = 1
    for j in range(state.now.awake_contacts + state.now.sleeping_contacts):
        k = state.active[j]
        key = (key * BASE + 4 * int(k) + int(state.mode[k]) + 1) % MODULUS
    for i in range(len(state.grip)):
        key = (key * BASE + int(state.grip[i]) + 1) % MODULUS
    return key


@kernel
def decide_once(state):
    """Note the modes just decided; False if they come back on the most lenient terms there are."""
    key, known = key_of_modes(state), state.now.decisions
    for j in range(known):
        if state.decided[j] == key:
            state.now.decisions = 0
            state.now.lenience *= LENIENCE_STEP
            return state.now.lenience <= MOST_LENIENT
    if known < len(state.decided):
        state.decided[known] = key
        state.now.decisions = known + 1
    return True


# Which contacts cannot hold with the forces that their modes ask for?
#
# The complementarity problem decides by accelerations, what ends a mode by forces. Where a force moves its own contact by next
# to nothing, or where several contacts share it, the two may differ: a mode would end as soon as it began, and begin again.


@kernel
def _weakest(model, state, m, options, work, rest):
    """(does any not hold? row of the contact that is furthest from holding, does it pull?)."""
    zero = BEGIN_SLACK * state.now.lenience * options.force_zero
    worst, found, row, pulls, largest = 0.0, False, 0, False, 0.0
    for i in range(m):
        largest = max(largest, work.force[2 * i])
    for i in range(m):
        left = normal_margin(work, i, zero) - FORCE_NOISE * largest
        if left <= worst:
            worst, found, row, pulls = left, True, i, True
        friction = model.laws[model.contacts[rest.ids[i]].group].friction
        if friction > 0.0 and state.mode[rest.ids[i]] == STICK:
            left = grip_left(friction, work, i, zero)
            if left <= worst:
                worst, found, row, pulls = left, True, i, False
    return found, row, pulls


@kernel
def release_pulling(model, state, m, options, work, event, record):
    """Forces of the m contacts in `event.rest`, without those that would pull; those that cannot stick slide.

    The forces are left in `work`. Returns (number of contacts in force, are their forces unique?).
    """
    rest = event.rest
    unique = solve_mode(model, rest, m, state.mode, state.now.lenience, work)
    for _ in range(2 * m):
        found, i, pulls = _weakest(model, state, m, options, work, rest)
        if not found:
            break
        k = rest.ids[i]
        old = state.mode[k]
        if pulls:
            state.mode[k] = OPEN
            m -= 1
            for j in range(i, m):
                rest.ids[j] = rest.ids[j + 1]
            refresh(model, m, rest, event.pose)
        else:
            state.mode[k] = FORWARD if work.force[2 * i + 1] < 0.0 else BACKWARD
        keep_change(state, record, k, old)
        unique = solve_mode(model, rest, m, state.mode, state.now.lenience, work)
    return m, unique


# What is made of velocities before contacts are taken for jammed: no rounding of an impact, and gaps that do not open.
#
# A contact jams where it slides and no finite force exists (docs/theory/method.md 2.6).


@kernel
def hold_gaps(model, state, r, options, work, event):
    """Zero the gap rates of the r contacts in `event.rest`, and the slip of those that hold.

    The gaps of jammed contacts must not open, however slowly, or there is nothing to stop.
    """
    rest = event.rest
    for i in range(r):
        k = rest.ids[i]
        holds = model.laws[model.contacts[k].group].friction > 0.0 and abs(rest.kin[i].gT_dot) <= options.speed_zero
        event.trial[k] = STICK if holds else FORWARD
    for j in range(len(model.coordinates)):
        work.inverse[j] = inverse_mass(model.coordinates[j])
    project_velocities(rest, r, event.trial, DEPENDENT_AT_EVENTS, work, state.u)
    place(model, state.q, state.u, event.pose)


@kernel
def stop_rounding(model, state, m, r, options, scratch):
    """Stop velocities and slips at the r contacts in `event.rest` that are rounding of the impact just solved; True if any.

    The tangential impulse is sought within its cone, mu Lambda_N to either side: slips are rounded by what that much would do.
    """
    work, event = scratch.work, scratch.event
    closed, rest = event.closed, event.rest
    found = _stop_bodies(r, event, state.u)
    for i in range(r):
        k, slip, rounding = rest.ids[i], abs(rest.kin[i].gT_dot), 0.0
        friction = model.laws[model.contacts[k].group].friction
        for j in range(m):
            if closed.ids[j] == k:
                rounding = VELOCITY_ROUNDING * friction * scratch.impact.impulse[2 * j] * work.G[2 * i + 1, 2 * i + 1]
        stops = options.speed_zero < slip <= rounding
        event.trial[k] = STICK if stops else OPEN
        found = found or stops
    if found:
        project_velocities(rest, r, event.trial, DEPENDENT_AT_EVENTS, work, state.u)
        place(model, state.q, state.u, event.pose)
        refresh(model, m, closed, event.pose)
    return found


@kernel
def _stop_bodies(r, event, out_u):
    """Zero velocities that are rounding of what they were at this instant: a body that should stand has no w̄; True if any."""
    rest, found = event.rest, False
    for i in range(r):
        for slot in range(rest.slots[i]):
            j = rest.coord[i, slot]
            if 0.0 < abs(out_u[j]) <= VELOCITY_ROUNDING * event.pace[j]:
                out_u[j], found = 0.0, True
    return found


@kernel
def slides(r, speed_zero, rest):
    """True if one of the r contacts in I_N slides."""
    for i in range(r):
        if abs(rest.kin[i].gT_dot) > speed_zero:
            return True
    return False


# Does friction lock two bodies where their contact lies on the line of centres?
#
# There w_T is parallel to w_N, so that forces with w_N lambda_N + w_T lambda_T = 0 move nothing, however large they are. Where
# they lie within the cone of friction and press, and the bodies' motion would close the gap between them, no finite force
# lets the motion go on: just beyond the line of centres an impulse stops both bodies, the larger the nearer it is to that line
# (docs/theory/method.md 2.6).


@kernel
def stop_at_dead_centre(model, state, r, solved, work, event, record):
    """Stop what the r contacts in `event.rest` lock on the line of centres; True if anything.

    There no finite forces let the motion go on. That their problem is `solved`, with modes in `event.decided`, is no sign that
    there are any: two directions that are one to rounding give forces of 10¹⁴ N. `work.G` and `work.inverse` are its own.
    """
    found, rest = False, event.rest
    for i in range(r):
        kin = rest.kin[i]
        if (solved and event.decided[rest.ids[i]] != STICK) or not _locks(model, rest, i, work):
            continue
        # What the forces without effect would have to make up for, which they cannot: sigma·w̄.
        if kin.bar_N - kin.bar_T * work.G[2 * i, 2 * i] / work.G[2 * i, 2 * i + 1] >= 0.0:
            continue
        before = kinetic_energy(model, state.u)
        for k in range(rest.slots[i]):
            state.u[rest.coord[i, k]] = 0.0
        row = keep_event(state, record, EventKind.JAM, rest.ids[i], -1, kin.gT_dot)
        record.events[row].energy_lost = before - kinetic_energy(model, state.u)
        state.sums.impacts += record.events[row].energy_lost
        state.counts.jams += 1
        found = True
    return found


@kernel
def stands_at_dead_centre(model, state, island, r, solved, work, event):
    """Let an island of two bodies that stand, locked on the line of centres by its only contact, hold; True if it is one.

    Forces exist, but the rounding of the lever arms, which are one vector, decides whether the problem for them is `solved`,
    and whether that lets them begin to roll, which the lock forbids either way.
    """
    rest = event.rest
    if r != 1 or (solved and event.decided[rest.ids[0]] == OPEN) or not _locks(model, rest, 0, work):
        return False
    for j in range(len(event.label)):
        other = j != rest.coord[0, 0] and j != rest.coord[0, 1]
        if event.label[j] == island and (other or state.u[j] != 0.0):
            return False
    event.decided[rest.ids[0]] = STICK
    return True


@kernel
def hold_at_dead_centre(model, state, m, work, rest):
    """Take the accelerations from bodies that stand, locked by one of the m contacts in force in `rest`.

    The forces are in `work`.
    """
    for i in range(m):
        if state.mode[rest.ids[i]] != STICK or not work.force[2 * i] > 0.0 or not _locks(model, rest, i, work):
            continue
        one, other = rest.coord[i, 0], rest.coord[i, 1]
        if state.u[one] == 0.0 and state.u[other] == 0.0:
            state.a[one], state.a[other] = 0.0, 0.0


@kernel
def _locks(model, rest, i, work):
    """True if w_T of contact i, between two coordinates, is parallel to w_N, and forces without effect lie within its cone."""
    if rest.slots[i] != 2 or work.inverse[rest.coord[i, 0]] == 0.0 or work.inverse[rest.coord[i, 1]] == 0.0:
        return False
    N, T, both = work.G[2 * i, 2 * i], work.G[2 * i + 1, 2 * i + 1], work.G[2 * i, 2 * i + 1]
    friction = model.laws[model.contacts[rest.ids[i]].group].friction
    return N * T - both * both <= DEAD_CENTRE * N * T and 0.0 < N <= friction * abs(both)


# Which contacts of an island stay closed now, which of them stick, and which of its bearings does dry friction hold?


@kernel
def standing_bearings(label, island, grip, out_dry):
    """List the coordinates of the island whose grip is STICK; returns how many."""
    bearings = 0
    for i in range(len(label)):
        if label[i] == island and grip[i] == STICK:
            out_dry[bearings] = i
            bearings += 1
    return bearings


@kernel
def decide(model, state, island, m, options, work, event, out_grip):
    """Modes of those of the island's m closed contacts that are in I_N, into `event.decided`, and the grips of its bearings.

    The forces of the contacts are left in `work`. Returns (number of contacts in I_N, now in `event.rest`; solved?).
    """
    r = resting(model, m, event.closed, event.pose, event.zero, event.rest)
    forces(model, state.clock.time, state.q, state.u, work.h)
    set_grips(model, state.u, event.label, island, options, out_grip)
    add_drag(model, out_grip, work.h)
    bearings = standing_bearings(event.label, island, out_grip, work.dry)
    if r == 0 and bearings == 0:
        fill_inverse(model, out_grip, work.inverse)
        return 0, True
    solved = decide_modes(model, event.rest, r, bearings, options.speed_zero, work, out_grip, event.decided)
    count_problems(state, work)
    return r, solved


@kernel
def count_problems(state, work):
    """Add the problems solved since last asked to the state's counts."""
    counts, rungs = state.counts, work.rungs
    counts.lcp_lemke += rungs[Solver.LEMKE.value]
    counts.lcp_copositive += rungs[Solver.COPOSITIVE.value]
    counts.lcp_detours += rungs[Solver.DETOUR.value]
    counts.lcp_enumerated += rungs[Solver.ENUMERATED.value]
    counts.lcp_inexact += rungs[Solver.INEXACT.value]
    for rung in range(len(rungs)):
        counts.lcp += rungs[rung]
        rungs[rung] = 0
    for i in range(len(LARGEST) + 1):
        counts.lcp_sizes[i] += work.sizes[i]
        work.sizes[i] = 0
