"""Which contacts of an island stay closed now, which of them stick, and which of its bearings does dry friction hold?

`decide` poses the question, `judge` says what follows from the answer. The rules for near-degenerate cases stand below where
they are applied: zero rates, dead centre, rounding of an impact and jams when modes are decided; released contacts and the
recurrence of modes after that (docs/theory/method.md 2.6, 3.5).
"""

from __future__ import annotations

import math
from enum import IntEnum

from watchsim.contact.gaps import BACKWARD, FORWARD, OPEN, STICK, gap_acceleration, place
from watchsim.dynamics.acceleration import accelerate, decide_modes, solve_mode
from watchsim.dynamics.bearings import LOAD_ROUNDS, begin_loads, has_settled, lay_on, press_contacts, rub
from watchsim.dynamics.coupled_loads import aim_first, starts, turn_to_loads
from watchsim.dynamics.delassus import fill_inverse, inverse_mass
from watchsim.dynamics.forces import add_drag, forces, set_grips, stop_held
from watchsim.dynamics.friction import LARGEST, law_of
from watchsim.dynamics.lcp import Solver
from watchsim.jit import kernel
from watchsim.simulation.closed_contacts import kinetic_energy, refresh, resting
from watchsim.simulation.coupled_motion import cone_margin, find_correction, normal_margin, project_velocities, remaining_rate
from watchsim.simulation.scratch import keep_change, keep_event
from watchsim.simulation.state import EventKind
from watchsim.tolerances import (
    BEGIN_SLACK,
    CONTRADICTING_RATE,
    DEAD_CENTRE,
    DEPENDENT_AT_EVENTS,
    FORCE_NOISE,
    LENIENCE_STEP,
    LOAD_ROUGH,
    MOST_LENIENT,
    NEARLY_SEIZED,
    PAINLEVE,
    RATE_FLOOR,
    RATE_ROUNDING,
    TILT_ROUNDING,
    VELOCITY_ROUNDING,
)


class Verdict(IntEnum):
    """What follows from a decision."""

    HOLDS = 0  # the modes are those to go on with
    STOPPED = 1  # velocities were changed: decide again
    ROUNDING = 2  # rounding of the impact was taken from velocities: decide again, and do not look for any again
    EXACTLY = 3  # take nothing but rounding for a gap rate of zero, and decide again
    JAMMED = 4  # no finite force holds sliding contacts apart (Painlevé): find the impulses that stop them
    SEIZED = 5  # so in a bearing, whose friction grows faster than the load that it is to carry
    FAILED = 6


@kernel
def standing_bearings(label, island, grip, out_bearing):
    """List the coordinates of the island whose grip is STICK; returns how many."""
    bearings = 0
    for i in range(len(label)):
        if label[i] == island and grip[i] == STICK:
            out_bearing[bearings] = i
            bearings += 1
    return bearings


# Of the rounds: from there on a contact that has begun to slide goes on. Its normal force may fall a little in the bearing's
# favour as soon as it slides, by as much as it takes to hold it again.
LASTING = 0.5


@kernel
def decide(model, state, island, m, options, system, problem, event, out_grip):
    """Modes of those of the island's m closed contacts that are in I_N, into `event.decided`, and the grips of its bearings.

    Their forces are left in `system`. Returns (number of contacts in I_N, now in `event.rest`; solved?). Of `state` only
    counts are written. `problem.last.jammed`: no friction of the bearings goes with the load that it makes.
    """
    r = resting(model, m, event.closed, event.pose, event.zero, event.rest)
    problem.last.jammed, problem.last.coupled, problem.last.sliders = 0, 0, 0
    problem.last.near = PAINLEVE * min(state.instant.lenience, NEARLY_SEIZED)
    begin_loads(model, state.clock.time, state.q, state.u, system)
    for number in range(LOAD_ROUNDS):
        forces(model, state.clock.time, state.q, state.u, system.h)
        set_grips(model, state.u, event.label, island, options, out_grip)
        add_drag(system.dry, out_grip, system.h)
        bearings, solved = standing_bearings(event.label, island, out_grip, problem.bearing), True
        if r == 0 and bearings == 0:
            fill_inverse(model, out_grip, system.inverse)
        else:
            problem.last.keeps = 1 if number > LASTING * LOAD_ROUNDS else 0
            solved = decide_modes(model, event.rest, r, bearings, options.speed_zero, system, problem, out_grip, event.decided)
            count_problems(problem, state.counts)
        if len(model.bearings) == 0 or not solved:
            return r, solved
        accelerate(model, event.rest, r, system, system.a)
        lay_on(model, 1.0, system)
        press_contacts(model, event.rest, r, system.force, system)
        changed = rub(model, out_grip, system)
        if _hold(r, bearings, out_grip, system, problem) and has_settled(changed, number):
            problem.last.jammed = 1 if _seizes(model, event, r, out_grip, problem.last.near, system) else 0
            return r, True
    return r, _decide_coupled(model, state, island, r, options, system, problem, event, out_grip)


@kernel
def _decide_coupled(model, state, island, r, options, system, problem, event, out_grip):
    """The same where loads and forces, found in turn, do not settle: as one problem (coupled_loads.py). Is it solved?"""
    last, rest = problem.last, event.rest
    last.coupled, last.jammed = 1, 1
    for start in range(starts(r)):
        for number in range(LOAD_ROUNDS):
            forces(model, state.clock.time, state.q, state.u, system.h)
            set_grips(model, state.u, event.label, island, options, out_grip)
            bearings = standing_bearings(event.label, island, out_grip, problem.bearing)
            last.sliders = _moving_bearings(model, event.label, island, out_grip, bearings, system, problem)
            add_drag(system.dry, out_grip, system.h)
            if number == 0:
                aim_first(rest, r, bearings + last.sliders, start, problem)
            last.keeps = 1 if number > LASTING * LOAD_ROUNDS else 0
            solved = decide_modes(model, rest, r, bearings, options.speed_zero, system, problem, out_grip, event.decided)
            count_problems(problem, state.counts)
            if not solved:
                break
            if has_settled(turn_to_loads(r, bearings + last.sliders, system.force, problem), number):
                last.coupled, last.sliders = 0, 0
                last.jammed = 1 if _seizes(model, event, r, out_grip, last.near, system) else 0
                return True
    last.coupled, last.sliders = 0, 0
    return False


@kernel
def _seizes(model, event, r, grip, share, system):
    """True if the force of a contact is what its friction and that in bearings make of that share of it.

    It grows without bound as it comes to pass a pivot at friction times radius, where none goes with its load any more.
    """
    rest = event.rest
    for i in range(r):
        force, presses = system.force[2 * i : 2 * i + 2], system.force[2 * i] * system.G[2 * i, 2 * i]
        slides = -force[1] * system.G[2 * i, 2 * i + 1] if event.decided[rest.ids[i]] != STICK else 0.0
        terms, rubs = abs(rest.kin[i].bar_N), 0.0
        for k in range(rest.slots[i]):
            j, drag, own = rest.coord[i, k], 0.0, 0.0
            if grip[j] == FORWARD or grip[j] == BACKWARD:
                drag = grip[j] * system.dry[j]
                for p in range(len(model.bearings)):
                    if model.bearings[p].coordinate == j:
                        own = grip[j] * model.bearings[p].grip * math.sqrt(force[0] * force[0] + force[1] * force[1])
            by = abs(rest.w_N[i, k] * system.inverse[j])
            terms += by * (abs(system.h[j] + drag) + abs(drag - own))
            rubs += by * abs(own)
        if share * presses > terms and rubs > 0.0 and 2.0 * (rubs + max(0.0, slides)) > presses:
            return True
    return False


@kernel
def _moving_bearings(model, label, island, grip, bearings, system, problem):
    """List the island's moving bearings with a load behind those that stand, without friction yet; returns how many."""
    problem.pivots.slides[:] = 0.0
    count = 0
    for k in range(len(model.bearings)):
        i = model.bearings[k].coordinate
        system.dry[i] = 0.0
        if label[i] == island and (grip[i] == FORWARD or grip[i] == BACKWARD):
            problem.bearing[bearings + count], problem.pivots.slides[bearings + count] = i, float(grip[i])
            count += 1
    return count


@kernel
def _hold(r, bearings, grip, system, problem):
    """True if the bearings that were found to hold do so with the friction of the load that follows."""
    for p in range(bearings):
        i = problem.bearing[p]
        if grip[i] == STICK and abs(system.force[2 * r + p]) > (1.0 + LOAD_ROUGH) * system.dry[i]:
            return False
    return True


@kernel
def count_problems(problem, out_counts):
    """Add the problems solved since last counted."""
    solvers = problem.solvers
    out_counts.lcp_lemke += solvers[Solver.LEMKE.value]
    out_counts.lcp_copositive += solvers[Solver.COPOSITIVE.value]
    out_counts.lcp_detours += solvers[Solver.DETOUR.value]
    out_counts.lcp_enumerated += solvers[Solver.ENUMERATED.value]
    out_counts.lcp_inexact += solvers[Solver.INEXACT.value]
    for solver in range(len(solvers)):
        out_counts.lcp += solvers[solver]
        solvers[solver] = 0
    for i in range(len(LARGEST) + 1):
        out_counts.lcp_sizes[i] += problem.sizes[i]
        problem.sizes[i] = 0


@kernel
def judge(model, state, island, m, decision, terms, options, scratch, record):
    """The `Verdict` on a decision about the island's m closed contacts: (contacts in I_N, now in `event.rest`; solved?).

    `terms`: (is nothing but rounding a gap rate of zero? has an impact just been solved?).
    """
    (r, solved), (exactly, hit) = decision, terms
    event, system, rest = scratch.event, scratch.work.system, scratch.event.rest
    if scratch.work.problem.last.jammed:
        hold_gaps(model, r, options, system, event, scratch.projection, state.u)
        replace(model, state.q, state.u, m, event)
        return Verdict.SEIZED
    if stop_at_dead_centre(model, state, r, solved, system, event, record):
        replace(model, state.q, state.u, m, event)
        return Verdict.STOPPED
    if stands_at_dead_centre(model, state.u, island, r, solved, system, event):
        return Verdict.HOLDS
    if solved:
        if not exactly and contradicts(model, state.instant.touched, r, options, system, event, scratch.projection, state.a):
            return Verdict.EXACTLY
        stop_held(event.label, island, state.regime.grip, state.u)
        return Verdict.HOLDS
    if hit and stop_rounding(model, m, r, options, system, event, scratch.impact.impulse, scratch.projection, state.u):
        replace(model, state.q, state.u, m, event)
        return Verdict.ROUNDING
    if not _slides(r, options.speed_zero, rest):
        state.counts.lcp_failures += 1
        return Verdict.FAILED
    hold_gaps(model, r, options, system, event, scratch.projection, state.u)
    replace(model, state.q, state.u, m, event)
    return Verdict.JAMMED


@kernel
def replace(model, q, u, m, event):
    """Poses and the kinematics of the m closed contacts at the state, which has changed."""
    place(model, q, u, event.pose)
    refresh(model, m, event.closed, event.pose)


@kernel
def _slides(r, speed_zero, rest):
    """True if one of the r contacts in I_N slides."""
    for i in range(r):
        if abs(rest.kin[i].gT_dot) > speed_zero:
            return True
    return False


# Zero rates: as a rule those below `speed_zero`, which is what tolerances leave of a rate that is zero. But bodies may move on
# a pair of nearly parallel faces whose gap rates are tiny and yet not zero: a follower that passes a shallow kink at v closes
# the gap to the next face at v times the angle. Where taking small rates for zero contradicts itself, only what is rounding of
# the velocities counts as zero (`exactly`), at that instant and in that island.


@kernel
def track_peak_speed(u, out_peak_speed):
    """Keep the largest magnitude of each velocity at this instant: rounding goes with what was before an impact, too."""
    for j in range(len(u)):
        out_peak_speed[j] = max(out_peak_speed[j], abs(u[j]))


@kernel
def rate_rounding(closed, i, options, peak_speed):
    """What counts as rounding in the gap rate of contact i, m/s."""
    terms, across = 0.0, 0.0
    for k in range(closed.slots[i]):
        terms += abs(closed.w_N[i, k]) * peak_speed[closed.coord[i, k]]
        across += abs(closed.w_T[i, k]) * peak_speed[closed.coord[i, k]]
    return RATE_ROUNDING * terms + TILT_ROUNDING * across + RATE_FLOOR * options.accumulation_speed


@kernel
def set_rate_zeros(closed, m, exactly, options, peak_speed, out_zero):
    """For each of the m contacts the magnitude up to which its gap rate is zero, m/s."""
    for i in range(m):
        out_zero[i] = rate_rounding(closed, i, options, peak_speed) if exactly else options.speed_zero


@kernel
def contradicts(model, touched, r, options, system, event, projection, out_a):
    """True if the modes decided for the r contacts in `event.rest` show that their gap rates only seemed to be zero.

    Those in force cannot all have none, or the one that has just `touched` goes on closing.
    """
    rest = event.rest
    for i in range(r):
        if rest.ids[i] == touched and event.decided[rest.ids[i]] == OPEN:
            rate = rest.kin[i].gN_dot
            if rate < -rate_rounding(rest, i, options, event.peak_speed):
                # It would sink in by more than `gap_zero` before it is parted, and close again at once, and again.
                accelerate(model, rest, r, system, out_a)
                room = max(rest.kin[i].g, 0.0) + options.gap_zero
                if rate * rate > 2.0 * room * gap_acceleration(rest, i, out_a):
                    return True
                break
    find_correction(rest, r, event.decided, DEPENDENT_AT_EVENTS, system.inverse, projection)
    for i in range(r):
        left = abs(remaining_rate(rest, r, i, projection)) if event.decided[rest.ids[i]] != OPEN else 0.0
        if left > CONTRADICTING_RATE * rate_rounding(rest, i, options, event.peak_speed):
            return True
    return False


# Dead centre: friction locks two bodies where their contact lies on the line of centres. There w_T is parallel to w_N, so that
# forces with w_N lambda_N + w_T lambda_T = 0 move nothing, however large they are. Where they lie within the cone of friction
# and press, and the bodies' motion would close the gap between them, no finite force lets the motion go on: just beyond the
# line of centres an impulse stops both bodies, the larger the nearer it is to that line (docs/theory/method.md 2.6).


@kernel
def stop_at_dead_centre(model, state, r, solved, system, event, record):
    """Stop what the r contacts in `event.rest` lock on the line of centres; True if anything.

    There no finite forces let the motion go on. That their problem is `solved`, with modes in `event.decided`, is no sign that
    there are any: two directions that are one to rounding give forces of 10¹⁴ N.
    """
    found, rest = False, event.rest
    for i in range(r):
        kin = rest.kin[i]
        if (solved and event.decided[rest.ids[i]] != STICK) or not _locks(model, rest, i, system):
            continue
        # What the forces without effect would have to make up for, which they cannot: sigma·w̄.
        if kin.bar_N - kin.bar_T * system.G[2 * i, 2 * i] / system.G[2 * i, 2 * i + 1] >= 0.0:
            continue
        _stop_both(model, state, rest, i, record)
        found = True
    return found


@kernel
def stop_locked(model, state, m, system, event, record):
    """Stop what an impact locks on the line of centres, one of the m closed contacts; True if anything.

    Impulses change both rates of the contact alike there. None is found where all that would take the gap rate back leaves a
    slip whose friction is along with it: the nearer to the line, the larger those are that do.
    """
    found, closed = False, event.closed
    for i in range(m):
        rate, slip = closed.kin[i].gN_dot, closed.kin[i].gT_dot
        if not (rate < -event.zero[i] and _locks(model, closed, i, system)):
            continue
        if rate - slip * system.G[2 * i, 2 * i] / system.G[2 * i, 2 * i + 1] < 0.0:
            _stop_both(model, state, closed, i, record)
            found = True
    return found


@kernel
def _stop_both(model, state, closed, i, record):
    """Stop the bodies of contact i; their energy goes to the impacts."""
    before = kinetic_energy(model, state.u)
    for k in range(closed.slots[i]):
        state.u[closed.coord[i, k]] = 0.0
    row = keep_event(record, state.clock, state.counts, EventKind.JAM, closed.ids[i], -1, closed.kin[i].gT_dot)
    record.events[row].energy_lost = before - kinetic_energy(model, state.u)
    state.sums.impacts += record.events[row].energy_lost
    state.counts.jams += 1


@kernel
def stands_at_dead_centre(model, u, island, r, solved, system, event):
    """Let an island of two bodies that stand, locked on the line of centres by its only contact, hold; True if it is one.

    Forces exist, but the rounding of the lever arms, which are one vector, decides whether the problem for them is `solved`,
    and whether that lets them begin to roll, which the lock forbids either way. Where nothing presses the contact they part.
    """
    rest = event.rest
    if r != 1 or (solved and event.decided[rest.ids[0]] == OPEN) or not _locks(model, rest, 0, system):
        return False
    if solved and not system.force[0] > 0.0:
        event.decided[rest.ids[0]] = OPEN
        return False
    for j in range(len(event.label)):
        other = j != rest.coord[0, 0] and j != rest.coord[0, 1]
        if event.label[j] == island and (other or u[j] != 0.0):
            return False
    event.decided[rest.ids[0]] = STICK
    return True


@kernel
def hold_at_dead_centre(model, mode, u, m, system, rest, out_a):
    """Take the accelerations from bodies that stand, locked by one of the m contacts in force in `rest`; True if any do."""
    found = False
    for i in range(m):
        if mode[rest.ids[i]] != STICK or not system.force[2 * i] > 0.0 or not _locks(model, rest, i, system):
            continue
        one, other = rest.coord[i, 0], rest.coord[i, 1]
        if u[one] == 0.0 and u[other] == 0.0:
            out_a[one], out_a[other], found = 0.0, 0.0, True
    return found


@kernel
def _locks(model, rest, i, system):
    """True if w_T of contact i, between two coordinates, is parallel to w_N, and forces without effect lie within its cone."""
    if rest.slots[i] != 2 or system.inverse[rest.coord[i, 0]] == 0.0 or system.inverse[rest.coord[i, 1]] == 0.0:
        return False
    N, T, both = system.G[2 * i, 2 * i], system.G[2 * i + 1, 2 * i + 1], system.G[2 * i, 2 * i + 1]
    friction = law_of(model, rest.ids[i]).friction
    return N * T - both * both <= DEAD_CENTRE * N * T and 0.0 < N <= friction * abs(both)


# Jammed contacts: they slide and no finite force exists. Before contacts are taken for jammed no rounding of an impact may be
# left in the velocities, and gaps must not open, however slowly, or there is nothing to stop.


@kernel
def stop_rounding(model, m, r, options, system, event, impulse, projection, out_u):
    """Stop velocities and slips at the r contacts in `event.rest` that are rounding of the impact just solved; True if any.

    A body that should stand has no w̄. The tangential impulse is sought within its cone, mu Lambda_N to either side: slips are
    rounded by what that much would do.
    """
    closed, rest, found = event.closed, event.rest, False
    for i in range(r):
        for slot in range(rest.slots[i]):
            j = rest.coord[i, slot]
            if 0.0 < abs(out_u[j]) <= VELOCITY_ROUNDING * event.peak_speed[j]:
                out_u[j], found = 0.0, True
    for i in range(r):
        k, slip, rounding = rest.ids[i], abs(rest.kin[i].gT_dot), 0.0
        for j in range(m):
            if closed.ids[j] == k:
                rounding = VELOCITY_ROUNDING * law_of(model, k).friction * impulse[2 * j] * system.G[2 * i + 1, 2 * i + 1]
        stops = options.speed_zero < slip <= rounding
        event.trial[k] = STICK if stops else OPEN
        found = found or stops
    if found:
        project_velocities(rest, r, event.trial, DEPENDENT_AT_EVENTS, system.inverse, projection, out_u)
    return found


@kernel
def hold_gaps(model, r, options, system, event, projection, out_u):
    """Zero the gap rates of the r contacts in `event.rest`, and the slip of those that hold."""
    rest = event.rest
    for i in range(r):
        k = rest.ids[i]
        holds = law_of(model, k).friction > 0.0 and abs(rest.kin[i].gT_dot) <= options.speed_zero
        event.trial[k] = STICK if holds else FORWARD
    for j in range(len(model.coordinates)):
        system.inverse[j] = inverse_mass(model.coordinates[j])
    project_velocities(rest, r, event.trial, DEPENDENT_AT_EVENTS, system.inverse, projection, out_u)


# Released contacts: the complementarity problem decides by accelerations, what ends a mode by forces. Where a force moves its
# own contact by next to nothing, or where several contacts share it, the two may differ: a mode would end as soon as it began,
# and begin again.


@kernel
def _weakest(model, mode, lenience, m, options, system, rest):
    """(does any not hold? row of the contact that is furthest from holding, does it pull?)."""
    zero = BEGIN_SLACK * lenience * options.force_zero
    worst, found, row, pulls, largest = 0.0, False, 0, False, 0.0
    for i in range(m):
        largest = max(largest, system.force[2 * i])
    for i in range(m):
        left = normal_margin(system, i, zero) - FORCE_NOISE * largest
        if left <= worst:
            worst, found, row, pulls = left, True, i, True
        friction = law_of(model, rest.ids[i]).friction
        if friction > 0.0 and mode[rest.ids[i]] == STICK:
            left = cone_margin(friction, system, i, zero)
            if left <= worst:
                worst, found, row, pulls = left, True, i, False
    return found, row, pulls


@kernel
def release_pulling(model, state, m, options, system, modes, event, record):
    """Forces of the m contacts in `event.rest`, without those that would pull; those that cannot stick slide.

    The forces are left in `system`, the modes in `state.regime.mode`. Returns (number of contacts in force, are their forces
    unique?).
    """
    rest, mode, lenience = event.rest, state.regime.mode, state.instant.lenience
    unique = solve_mode(model, rest, m, mode, lenience, system, modes)
    for _ in range(2 * m):
        found, i, pulls = _weakest(model, mode, lenience, m, options, system, rest)
        if not found:
            break
        k = rest.ids[i]
        old = mode[k]
        if pulls:
            mode[k] = OPEN
            m -= 1
            for j in range(i, m):
                rest.ids[j] = rest.ids[j + 1]
            refresh(model, m, rest, event.pose)
        else:
            mode[k] = FORWARD if system.force[2 * i + 1] < 0.0 else BACKWARD
        keep_change(record, state.clock, state.counts, k, old, mode[k])
        unique = solve_mode(model, rest, m, mode, lenience, system, modes)
    return m, unique


# Mode recurrence: decisions are made from accelerations, modes end by forces, slips and ways, and where all of these are
# rounding the two can contradict each other for ever. So no set of modes is decided twice at one instant on the same terms: at
# the second time what counts as zero for forces and slips is made ten times larger, until time has gone on. There are finitely
# many sets of modes and finitely many such terms, so that every instant comes to an end (docs/theory/method.md 3.5).

BASE, MODULUS = 1000003, 2147483647


@kernel
def begin_instant(out_instant):
    """Forget what was decided before."""
    out_instant.decisions, out_instant.lenience = 0, 1.0


@kernel
def key_of_modes(regime, instant):
    """A number for the modes of all contacts in force and the grips of all bearings."""
    key = 1
    for j in range(instant.awake_contacts + instant.sleeping_contacts):
        k = regime.active[j]
        key = (key * BASE + 4 * int(k) + int(regime.mode[k]) + 1) % MODULUS
    for i in range(len(regime.grip)):
        key = (key * BASE + int(regime.grip[i]) + 1) % MODULUS
    return key


@kernel
def decide_once(key, decided, out_instant):
    """Note the modes just decided, by their `key`; False if they come back on the most lenient terms there are."""
    known = out_instant.decisions
    for j in range(known):
        if decided[j] == key:
            out_instant.decisions = 0
            out_instant.lenience *= LENIENCE_STEP
            return out_instant.lenience <= MOST_LENIENT
    if known < len(decided):
        decided[known] = key
        out_instant.decisions = known + 1
    return True
