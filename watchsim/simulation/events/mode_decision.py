"""Which contacts of an island stay closed now, which of them stick, and which of its bearings does dry friction hold?"""

from __future__ import annotations

from watchsim.contact.index_sets import STICK
from watchsim.dynamics.acceleration import decide_modes
from watchsim.dynamics.applied_forces import forces
from watchsim.dynamics.bearing_friction import add_drag, set_grips
from watchsim.dynamics.delassus import LARGEST, fill_inverse
from watchsim.dynamics.problem_kinds import Rung
from watchsim.jit import kernel
from watchsim.simulation.events.closed_contacts import resting


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
    counts.lcp_lemke += rungs[Rung.LEMKE.value]
    counts.lcp_copositive += rungs[Rung.COPOSITIVE.value]
    counts.lcp_detours += rungs[Rung.DETOUR.value]
    counts.lcp_enumerated += rungs[Rung.ENUMERATED.value]
    counts.lcp_inexact += rungs[Rung.INEXACT.value]
    for rung in range(len(rungs)):
        counts.lcp += rungs[rung]
        rungs[rung] = 0
    for place in range(len(LARGEST) + 1):
        counts.lcp_sizes[place] += work.sizes[place]
        work.sizes[place] = 0
