"""What does one piece of each kind of work cost, in the middle of a run?

Kernels are called many times in compiled code at the moments of a walk. What has no kernel of its own is what the loop takes at
these moments beyond the pieces counted by themselves.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.bench.profile.lcp_costs import problem_costs
from watchsim.bench.profile.repeated_work import evaluations_again, impacts_again, lookups_again, touches_again
from watchsim.bench.profile.sampled_moments import Kind, Moment, Walk, seconds_each
from watchsim.simulation.loop_state.state import COUNT_NAMES
from watchsim.simulation.loop_state.state_arrays import arrays_of

REPEATS = 50
COUNTED_AS = {  # kind of work -> its count, where that has another name
    "step": "steps",
    "evaluation": "evaluations",
    "flight": "flights",
    "gap_evaluation": "gap_evaluations",
    "cell_lookup": "cells_looked_up",
    "instant": "instants",
    "impact": "impacts",
    "call": "calls",
}

Costs = dict[str, float]  # kind of work -> seconds for one
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class _Parts:
    """What a step or flight and its parts take, s."""

    whole: float
    evaluations: float  # all of them
    search: float  # for the first contact that closes

    @property
    def beyond(self) -> float:
        """What the step or flight takes besides."""
        return self.whole - self.evaluations - self.search


def kernel_costs(walk: Walk) -> Costs:
    """Seconds for one `step`, `evaluation`, `flight`, `gap_evaluation`, `cell_lookup`, `instant`, `impact` and one
    complementarity problem of each size (`lcp_to_1`, ...); without those that the walk does not meet.

    No work is in two of them. A step or flight is what evaluations and the search for contacts leave of it; a gap what look-ups
    leave of that search; an impact all that is done for it but the problems; an instant the settling of an event but for
    impacts, problems and look-ups.
    """
    costs = problem_costs(walk) | _lookup_costs(walk)
    return costs | _smooth_costs(walk, costs.get("cell_lookup", 0.0)) | _settling_costs(walk, costs)


def _smooth_costs(walk: Walk, lookup: float) -> Costs:
    """Of a `step`, `evaluation`, `flight` and `gap_evaluation`."""
    steps, flights = ([_parts(walk, moment) for moment in walk.moments[kind]] for kind in (Kind.STEP, Kind.FLIGHT))
    costs, search, gaps = {}, 0.0, 0.0
    if steps:
        costs["step"] = sum(part.beyond for part in steps) / len(steps)
        costs["evaluation"] = sum(part.evaluations for part in steps) / _count("evaluations", walk.moments[Kind.STEP])
    if flights:
        # Some flights look for contacts at length: a difference of large numbers, where the machine code of the loop and of the
        # search by itself differ by some per cent.
        costs["flight"] = float(np.median([part.beyond for part in flights]))
    for kind, parts in ((Kind.STEP, steps), (Kind.FLIGHT, flights)):
        weight, moments = walk.weight(kind), walk.moments[kind]
        search += weight * (sum(part.search for part in parts) - lookup * _count("cells_looked_up", moments))
        gaps += weight * _count("gap_evaluations", moments)
    return costs | ({"gap_evaluation": search / gaps} if gaps else {})


def _count(name: str, moments: Iterable[Moment]) -> int:
    """How often that is done at all these moments."""
    return sum(moment.count(name) for moment in moments)


def _parts(walk: Walk, moment: Moment) -> _Parts:
    """The parts of one step or flight, each by itself."""
    walk.again(moment)
    run = walk.run
    state, options, scratch = run.state, run.options, run.scratch
    # Contacts are looked for up to the end of the step, or up to where a mode ends before.
    mode_ends = state.now.event_waits == 1 and state.now.touched < 0
    end = float(state.clock.time - scratch.step.span.start if mode_ends else scratch.step.span.length)
    walk.at(moment)
    search = seconds_each(touches_again, (run.compiled.model, run.finder.cells, state, options, end, scratch), REPEATS)
    each = 0.0
    if moment.kind == Kind.STEP:
        each = seconds_each(evaluations_again, (run.compiled.model, state, options, scratch), REPEATS)
    return _Parts(walk.seconds(moment), each * moment.count("evaluations"), search)


def _lookup_costs(walk: Walk) -> Costs:
    """Of a `cell_lookup`."""
    model, cells = walk.run.compiled.model, walk.run.finder.cells
    listed = int(np.count_nonzero(model.pairs.listed))
    places = [moment.state.q for moments in walk.moments.values() for moment in moments]
    if not listed:
        return {}
    return {"cell_lookup": float(np.mean([seconds_each(lookups_again, (model, cells, q), REPEATS) for q in places])) / listed}


def _settling_costs(walk: Walk, costs: Costs) -> Costs:
    """Of an `impact` and of an `instant`; `costs`: what is known to be done at both."""
    found: Costs = {}
    impacts = [_impacts(walk, moment, costs) for moment in walk.moments[Kind.IMPACT]]
    if number := sum(one[1] for one in impacts):
        found["impact"] = sum(one[0] for one in impacts) / number
    left, instants = 0.0, 0
    for kind in (Kind.CHANGE, Kind.IMPACT):
        beyond = [walk.seconds(moment) - _seconds(moment.done, costs | found) for moment in walk.moments[kind]]
        left += walk.weight(kind) * sum(beyond)
        instants += walk.met[kind]
    return found | ({"instant": left / instants} if instants else {})


def _impacts(walk: Walk, moment: Moment, costs: Costs) -> tuple[float, int]:
    """(seconds of the impacts at an event without the problems solved, how many)."""
    run = walk.run
    loop = run.compiled.model, run.finder.cells, run.state, run.options, run.scratch, walk.room
    walk.at(moment)
    impacts_again(*loop, True, 1)
    done = arrays_of(run.state).counts - arrays_of(moment.state).counts
    done[COUNT_NAMES.index("cells_looked_up")] = 0  # contacts are gathered before that is repeated
    whole, nothing = (seconds_each(impacts_again, (*loop, collides), REPEATS) for collides in (True, False))
    return whole - nothing - _seconds(done, costs), int(done[COUNT_NAMES.index("impacts")])


def _seconds(done: Integers, costs: Costs) -> float:
    """Of what is done, by place in `COUNT_NAMES`, at these costs."""
    return sum(cost * float(done[COUNT_NAMES.index(COUNTED_AS.get(work, work))]) for work, cost in costs.items())
