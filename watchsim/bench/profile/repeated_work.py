"""Which pieces of a run's work are done again and again, to time one of them?

Each entry takes the number of repeats last. Nothing depends on these entries, so they are not among the sources that `jit`
takes for kernels.
"""

from __future__ import annotations

from watchsim import jit
from watchsim.candidates.cell_lookup import candidates
from watchsim.contact.poses import place
from watchsim.dynamics.impact import impact
from watchsim.dynamics.lcp.lemke_pivoting import lemke_checked
from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.problem_kinds import Level
from watchsim.dynamics.small_systems import copy
from watchsim.model.records import CellsRef, ModelRef
from watchsim.simulation.advance import advance
from watchsim.simulation.events.closed_contacts import gather, refresh
from watchsim.simulation.events.collision import approaching, collide
from watchsim.simulation.events.mode_decision import decide
from watchsim.simulation.events.zero_rates import set_rate_zeros
from watchsim.simulation.first_closing.time_of_impact import first_touch
from watchsim.simulation.loop_state.buffers import RecordRef
from watchsim.simulation.loop_state.scratch import scratch_by_reference
from watchsim.simulation.loop_state.state import StateRef
from watchsim.simulation.motion.contact_islands import island_of, label_islands, place_contacts, sort_by_island
from watchsim.simulation.motion.coupled_motion import engage, motion
from watchsim.simulation.options import OptionsRef
from watchsim.simulation.stops import Stop

COMPRESSION, EXPANSION, MODES = 0, 1, 2


@jit.entry
def moments_again(model, cells, state, own, moment, options, until, scratch, record, repeats):  # noqa: PLR0913 - what `advance` takes, and more
    """What follows one moment, `repeats` times; returns the last cause to come back. `own`, `moment`: `StateArrays`."""
    code = Stop.RUNNING
    for _ in range(repeats):
        own.clock[:], own.q[:], own.u[:], own.a[:] = moment.clock, moment.q, moment.u, moment.a
        own.mode[:], own.grip[:], own.awake[:] = moment.mode, moment.grip, moment.awake
        own.active[:], own.upto[:], own.numbers[:] = moment.active, moment.upto, moment.numbers
        own.side_u[:], own.side_q[:] = moment.side_u, moment.side_q
        own.sums[:], own.counts[:], own.worst[:] = moment.sums, moment.counts, moment.worst
        own.decided[:], own.lenience[:] = moment.decided, moment.lenience
        own.returning[:], own.returned[:] = moment.returning, moment.returned
        record.used.rows, record.used.events = 0, 0
        code = advance(model, cells, state, options, until, scratch, record)
    return code


@jit.entry
def touches_again(model, cells, state, options, end, scratch, repeats):
    """The search for the first contact that closes in the step's first `end` seconds."""
    m, c, s, o, w = ModelRef(*model), CellsRef(*cells), StateRef(*state), OptionsRef(*options), scratch_by_reference(scratch)
    total = 0.0
    for _ in range(repeats):
        total += first_touch(m, c, s, o, end, w)[1]
    return total


@jit.entry
def lookups_again(model, cells, q, repeats):
    """The candidates of all pairs of bodies that have cells; returns how often one was looked up."""
    m, c = ModelRef(*model), CellsRef(*cells)
    found, total = 0, 0
    for _ in range(repeats):
        for p in range(len(m.pairs)):
            if m.pairs[p].listed:
                total += candidates(m, c, p, q)[2]
                found += 1
    return found if total >= 0 else 0


@jit.entry
def evaluations_again(model, state, options, scratch, repeats):
    """The accelerations of coupled bodies with all monitors."""
    m, s, o, w = ModelRef(*model), StateRef(*state), OptionsRef(*options), scratch_by_reference(scratch)
    n = len(s.q)
    w.smooth.y[:n], w.smooth.y[n : 2 * n] = s.q, s.u
    engage(m, s, w.smooth)
    for _ in range(repeats):
        motion(m, s, o, s.clock.time, w.work, w.smooth)
    return w.smooth.dy[0]


@jit.entry
def impacts_again(model, cells, state, options, scratch, record, collides, repeats):
    """The impacts of the event that waits, island by island, or only what brings back the velocities before them."""
    m, c, s, o, w = ModelRef(*model), CellsRef(*cells), StateRef(*state), OptionsRef(*options), scratch_by_reference(scratch)
    r, before = RecordRef(*record), w.smooth.y[: len(s.u)]
    copy(s.u, before)
    count, first = gathered(m, c, s, o, w), 0
    while first < count:
        island = island_of(m, w.event.label, w.event.listed[first])
        size = place_contacts(m, w.event.listed, first, w.event.upto[first], w.event.pose, w.event.closed)
        set_rate_zeros(w.event.closed, size, False, o, w.event.pace, w.event.zero)
        approaches = approaching(size, w.event.closed, w.event.zero)
        for _ in range(repeats if approaches else 0):
            r.used.rows, r.used.events = 0, 0
            copy(before, s.u)
            place(m, s.q, s.u, w.event.pose)
            refresh(m, size, w.event.closed, w.event.pose)
            if collides:
                collide(m, s, island, size, o, 0.0, w, r)
        copy(before, s.u)
        place(m, s.q, s.u, w.event.pose)
        first += size
    return count


@jit.kernel
def gathered(model, cells, state, options, scratch):
    """The closed contacts by island in `scratch.event.listed`, as the event loop gathers them at an event; returns how many."""
    place(model, state.q, state.u, scratch.event.pose)
    _, count = gather(model, cells, state, options, scratch)
    label_islands(model, scratch.event.listed, count, scratch.event.label)
    sort_by_island(model, scratch.event.label, count, scratch.event.listed, scratch.event.upto)
    return count


@jit.entry
def pose(model, cells, state, options, scratch, record, which):
    """Leave one problem of the event that waits, of the first island that has it, in `scratch.work`; returns its size or 0."""
    m, c, s, o, w = ModelRef(*model), CellsRef(*cells), StateRef(*state), OptionsRef(*options), scratch_by_reference(scratch)
    r, posed = RecordRef(*record), w.work.posed
    r.used.rows, r.used.events, posed.level = 0, 0, Level.NONE
    count, first = gathered(m, c, s, o, w), 0
    while first < count and posed.level == Level.NONE:
        island = island_of(m, w.event.label, w.event.listed[first])
        size = place_contacts(m, w.event.listed, first, w.event.upto[first], w.event.pose, w.event.closed)
        first += size
        set_rate_zeros(w.event.closed, size, False, o, w.event.pace, w.event.zero)
        hit = approaching(size, w.event.closed, w.event.zero)
        if which == MODES:
            if hit:
                collide(m, s, island, size, o, 0.0, w, r)
                posed.level = Level.NONE
            decide(m, s, island, size, o, w.work, w.event, w.impact.grip)
        elif hit:
            for i in range(size):
                law = m.laws[m.contacts[w.event.closed.ids[i]].group]
                w.impact.restitution[i] = law.restitution if which == EXPANSION else 0.0
            impact(m, w.event.closed, size, w.impact.restitution, 0.0, w.work, s.u)
    if which == EXPANSION and posed.level != Level.EXPANSION:
        return 0
    return posed.contacts + 2 * posed.elements if posed.level != Level.NONE else 0


@jit.entry
def problems_again(A, b, n, work, x, repeats):
    """One problem by Lemke's method."""
    total = 0
    for _ in range(repeats):
        total += 1 if lemke_checked(A, b, n, work, x) == LcpOutcome.SOLVED else 0
    return total
