"""How long do forces hold what stands still while its loads change?

Contacts and bearings that hold the same bodies share their load as they like: a step follows one of the ways, and may leave the
limits of one friction though another way would hold. Where the modes of such a rest come back at one instant, its island is put
to sleep, and from then on the problem of an event is posed along each step: as long as that has a solution in which nothing
accelerates the island stands (docs/theory/method.md 3.5).
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import place
from watchsim.dynamics.acceleration import accelerate
from watchsim.dynamics.delassus import apply
from watchsim.dynamics.moving_frame import is_shaken, next_jolt
from watchsim.jit import kernel
from watchsim.simulation.coupled_motion import (
    add_terms,
    begin_terms,
    has_stopped,
    island_of,
    label_islands,
    place_contacts,
    sort_by_island,
)
from watchsim.simulation.modes import decide, stands_at_dead_centre
from watchsim.simulation.options import longest_step
from watchsim.tolerances import LOAD_ROUGH

LOOKS = 8  # along a step
LONGEST = 0.1  # of the longest step: between two of them loads change little
HALVINGS = 30  # far enough beyond the fall for what moves then to be more than rounding


@kernel
def stands_shaken(model, regime, t):
    """True if anything sleeps whose load will change."""
    if not is_shaken(model, t):
        return False
    for k in range(len(model.weighed)):
        first = model.bodies[model.weighed[k].body].first
        if regime.awake[first] == 0 and not model.coordinates[first].linear:
            return True
    return False


@kernel
def step_while_standing(model, options, t):
    """The longest step from time t (s), s."""
    return min(LONGEST * longest_step(options, t), next_jolt(model, t) - t)


@kernel
def first_fall(model, state, length, options, scratch):
    """The time from now, within `length` (s), from which on nothing holds an island that stands, which is woken.

    Infinity where all are held.
    """
    held = 0.0
    for look in range(1, LOOKS + 1):
        fallen = length * look / LOOKS
        if _holds(model, state, state.clock.time + fallen, options, scratch, False):
            held = fallen
            continue
        for _ in range(HALVINGS):
            middle = 0.5 * (held + fallen)
            if not held < middle < fallen:
                break
            if _holds(model, state, state.clock.time + middle, options, scratch, False):
                held = middle
            else:
                fallen = middle
        _holds(model, state, state.clock.time + fallen, options, scratch, True)
        return fallen
    return math.inf


@kernel
def _holds(model, state, t, options, scratch, wakes):
    """True if all islands asleep can stand under the loads at time t; `wakes`: those that cannot are woken."""
    event, regime, first, holds, now = scratch.event, state.regime, 0, True, state.clock.time
    m = state.instant.awake_contacts + state.instant.sleeping_contacts
    for j in range(m):
        event.listed[j] = regime.active[j]
    label_islands(model, event.listed, m, event.label)
    sort_by_island(model, event.label, m, event.listed, event.upto)
    place(model, state.q, state.u, event.pose)
    state.clock.time = t
    for island in range(len(event.label)):
        if event.label[island] != island:
            continue
        last = event.upto[first] if first < m and island_of(model, event.label, event.listed[first]) == island else first
        if regime.awake[island] == 0 and last > first:
            closed = place_contacts(model, event.listed, first, last, event.pose, event.closed)
            if not _stands(model, state, island, closed, options, scratch):
                holds = False
                for i in range(len(event.label) if wakes else 0):
                    if event.label[i] == island:
                        regime.awake[i] = 1
        first = last
    state.clock.time = now
    return holds


@kernel
def _stands(model, state, island, m, options, scratch):
    """True if the problem of the island's m contacts, which stand still, has a solution without acceleration."""
    event, work, grip, system = scratch.event, scratch.work, scratch.impact.grip, scratch.work.system
    event.zero[:m] = options.speed_zero
    for i in range(len(grip)):
        grip[i] = state.regime.grip[i]
    r, solved = decide(model, state, island, m, options, system, work.problem, event, grip)
    if stands_at_dead_centre(model, state.u, island, r, solved, system, event):
        return True
    if not solved or work.problem.last.jammed:
        return False
    accelerate(model, event.rest, 0, system, system.a)
    apply(event.rest, r, system.force, system.inverse, system.a)
    begin_terms(system.h, event.terms)
    for i in range(len(event.terms)):
        event.terms[i] += system.dry[i]  # of what a bearing at its limit bears little is left in h
    add_terms(event.rest, r, system.force, event.terms)
    return has_stopped(model, island, state.u, system.a, options.sleep + LOAD_ROUGH, options, event)
