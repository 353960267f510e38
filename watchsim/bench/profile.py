"""What does a run do at a random sample of its moments, and how long does that take?

The run is walked: the loop is given room to record one step, so that it comes back after each step and after each event. From a
state kept on the way it can be started again and again. The same kernels as ever run, on what they really meet.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim import jit
from watchsim.contact.cell_lookup import candidates
from watchsim.contact.cells import forget
from watchsim.contact.gaps import place
from watchsim.dynamics.delassus import copy
from watchsim.dynamics.friction import LARGEST, law_of
from watchsim.dynamics.impact import impact
from watchsim.dynamics.lcp import LcpOutcome, Level, lcp_work, lemke_checked
from watchsim.mechanism.compile import compile_scene
from watchsim.model import CellsRef, ModelRef
from watchsim.scene.scene import Recording, Scene
from watchsim.simulation import EVENT_DRIVEN
from watchsim.simulation.closed_contacts import gather, refresh
from watchsim.simulation.coupled_motion import engage, island_of, label_islands, motion, place_contacts, sort_by_island
from watchsim.simulation.event_loop import EVENTS_PER_CONTACT, ROWS_PER_STEP, advance
from watchsim.simulation.first_closing import first_touch
from watchsim.simulation.impacts import approaching, collide
from watchsim.simulation.modes import decide, set_rate_zeros
from watchsim.simulation.options import OptionsRef
from watchsim.simulation.runner import Run, trajectory_of
from watchsim.simulation.scratch import (
    Record,
    RecordRef,
    Until,
    new_record,
    new_until,
    scratch_by_reference,
    state_by_reference,
)
from watchsim.simulation.state import COUNT_NAMES, State, Stop, arrays_of, copy_of_state, room_for, write_state
from watchsim.simulation.trajectory import Trajectory

# Each entry takes the number of repeats last. Nothing depends on these entries, so they are not among the sources that `jit`
# takes for kernels.

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
    m, c, s, o, w = (
        ModelRef(*model),
        CellsRef(*cells),
        state_by_reference(state),
        OptionsRef(*options),
        scratch_by_reference(scratch),
    )
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
    m, s, o, w = ModelRef(*model), state_by_reference(state), OptionsRef(*options), scratch_by_reference(scratch)
    n = len(s.q)
    w.smooth.y[:n], w.smooth.y[n : 2 * n] = s.q, s.u
    engage(m, s.regime.active, s.instant, w.smooth)
    for _ in range(repeats):
        motion(m, s.regime, o, s.clock.time, w.smooth, s.counts)
    return w.smooth.dy[0]


@jit.entry
def impacts_again(model, cells, state, options, scratch, record, collides, repeats):
    """The impacts of the event that waits, island by island, or only what brings back the velocities before them."""
    m, c, s, o, w = (
        ModelRef(*model),
        CellsRef(*cells),
        state_by_reference(state),
        OptionsRef(*options),
        scratch_by_reference(scratch),
    )
    r, before = RecordRef(*record), w.smooth.y[: len(s.u)]
    copy(s.u, before)
    count, first = gathered(m, c, s, o, w), 0
    while first < count:
        island = island_of(m, w.event.label, w.event.listed[first])
        size = place_contacts(m, w.event.listed, first, w.event.upto[first], w.event.pose, w.event.closed)
        set_rate_zeros(w.event.closed, size, False, o, w.event.peak_speed, w.event.zero)
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
    _, count = gather(model, cells, state, options, scratch.path, scratch.requested, scratch.event.pose, scratch.event.listed)
    label_islands(model, scratch.event.listed, count, scratch.event.label)
    sort_by_island(model, scratch.event.label, count, scratch.event.listed, scratch.event.upto)
    return count


@jit.entry
def pose(model, cells, state, options, scratch, record, which):
    """Leave one problem of the event that waits, of the first island that has it, in `scratch.work`; returns its size or 0."""
    m, c, s, o, w = (
        ModelRef(*model),
        CellsRef(*cells),
        state_by_reference(state),
        OptionsRef(*options),
        scratch_by_reference(scratch),
    )
    r, posed = RecordRef(*record), w.work.problem.last
    r.used.rows, r.used.events, posed.level = 0, 0, Level.NONE
    count, first = gathered(m, c, s, o, w), 0
    while first < count and posed.level == Level.NONE:
        island = island_of(m, w.event.label, w.event.listed[first])
        size = place_contacts(m, w.event.listed, first, w.event.upto[first], w.event.pose, w.event.closed)
        first += size
        set_rate_zeros(w.event.closed, size, False, o, w.event.peak_speed, w.event.zero)
        hit = approaching(size, w.event.closed, w.event.zero)
        if which == MODES:
            if hit:
                collide(m, s, island, size, o, 0.0, w, r)
                posed.level = Level.NONE
            decide(m, s, island, size, o, w.work.system, w.work.problem, w.event, w.impact.grip)
        elif hit:
            for i in range(size):
                restitution = law_of(m, w.event.closed.ids[i]).restitution
                w.impact.restitution[i] = restitution if which == EXPANSION else 0.0
            impact(m, w.event.closed, size, w.impact.restitution, 0.0, w.work.system, w.work.problem, w.work.phases, s.u)
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


SAMPLE = 200  # moments of each kind
REPEATS_SAMPLED_MOMENTS = 20  # of what follows a moment
TRIES = 3  # of which the quickest counts
EVERYWHERE = np.array([[-np.inf, np.inf]])


class Kind(Enum):
    """What the loop does next."""

    STEP = "a step of coupled bodies"
    FLIGHT = "a flight in closed form"
    IMPACT = "an event with impacts is settled"
    CHANGE = "an event without impacts is settled"


@dataclass(frozen=True)
class Moment:
    """A state of the run, and what the loop does next."""

    state: State
    done: NDArray[np.int64]  # by place in `COUNT_NAMES`

    def count(self, name: str) -> int:
        """How often that is done."""
        return int(self.done[COUNT_NAMES.index(name)])

    @property
    def kind(self) -> Kind:
        if self.count("instants"):
            return Kind.IMPACT if self.count("impacts") else Kind.CHANGE
        return Kind.FLIGHT if self.count("flights") else Kind.STEP


class Walk:
    """A scene's run to `duration`, walked: how many moments of each kind it has, a sample of each, and all it has counted."""

    def __init__(self, scene: Scene, tolerance: float, duration: float) -> None:
        self.run = Run(scene, compile_scene(scene), tolerance, Recording())
        model = self.run.compiled.model
        # Each step and each event leaves a row: with room for no more the loop comes back. Twice the events it asks for.
        self.room = new_record(model, ROWS_PER_STEP + 1, 2 * EVENTS_PER_CONTACT * room_for(model), EVERYWHERE)
        self._nowhere = new_record(model, 0, 0, EVERYWHERE)
        self._until = new_until(duration, duration, True, np.inf)
        self.met = dict.fromkeys(Kind, 0)
        self.moments: dict[Kind, list[Moment]] = {kind: [] for kind in Kind}
        chance = np.random.default_rng(0)
        for moment in self._passed():
            # Each of its kind met so far is in the sample with the same chance.
            sample = self.moments[moment.kind]
            self.met[moment.kind] += 1
            if len(sample) < SAMPLE:
                sample.append(moment)
            elif (place := int(chance.integers(self.met[moment.kind]))) < SAMPLE:
                sample[place] = moment
        self.counts = dict(zip(COUNT_NAMES, arrays_of(self.run.state).counts.tolist(), strict=True))

    def weight(self, kind: Kind) -> float:
        """For how many moments of its kind one of the sample stands."""
        return self.met[kind] / len(self.moments[kind]) if self.moments[kind] else 0.0

    def at(self, moment: Moment) -> None:
        """Bring the run's state there."""
        write_state(self.run.state, moment.state)

    def again(self, moment: Moment) -> None:
        """Do once more what follows the moment: its step is in the run's scratch then, its state is the one behind it."""
        self.at(moment)
        self._advance(self.room)

    def seconds(self, moment: Moment) -> float:
        """What follows the moment takes so long, without what a call takes in which nothing is done."""
        run = self.run
        states = run.state, arrays_of(run.state), arrays_of(moment.state)
        loop = run.compiled.model, run.finder.cells, *states, run.options, self._until, run.scratch
        whole, nothing = (
            seconds_each(moments_again, (*loop, record), REPEATS_SAMPLED_MOMENTS) for record in (self.room, self._nowhere)
        )
        return whole - nothing

    def call_seconds(self) -> float:
        """Of one call of the compiled loop from Python, s; in those timed here nothing is done."""

        def calls(repeats: int) -> None:
            for _ in range(repeats):
                self._advance(self._nowhere)

        return seconds_each(calls, (), REPEATS_SAMPLED_MOMENTS)

    def _advance(self, record: Record) -> Stop:
        record.used.rows, record.used.events = 0, 0
        return self.run._advance(self._until, record)

    def _passed(self) -> Iterator[Moment]:
        """All moments of the run."""
        run = self.run
        while True:
            before = copy_of_state(run.state)
            while (stop := self._advance(self.room)) == Stop.CELL_UNKNOWN:
                run._learn()
                write_state(run.state, before)
            if stop != Stop.BUFFER_FULL:
                return
            yield Moment(before, arrays_of(run.state).counts - arrays_of(before).counts)


def seconds_each(call: Callable[..., object], arguments: tuple[Any, ...], repeats: int) -> float:
    """Of one repeat of `call(*arguments, repeats)`, without the call itself; compiled before. The quickest try counts."""
    best = [float("inf"), float("inf")]
    call(*arguments, 0)
    for _ in range(TRIES):
        for i, times in enumerate((0, repeats)):
            begun = time.perf_counter()
            call(*arguments, times)
            best[i] = min(best[i], time.perf_counter() - begun)
    return max(best[1] - best[0], 0.0) / repeats


# They are posed again at the events of a walk: those of the compression and the expansion at impacts, and of the modes
# afterwards.

POSED = {Kind.IMPACT: (COMPRESSION, EXPANSION, MODES), Kind.CHANGE: (MODES,)}

Array = NDArray[np.float64]
Problem = tuple[Array, Array]  # A, b


def problem_costs(walk: Walk) -> dict[str, float]:
    """Seconds for one problem of each size (`lcp_to_1`, ...) that the walk has met."""
    seconds: dict[str, list[float]] = {}
    for A, b in problems_met(walk):
        n = len(b)
        taken = seconds_each(problems_again, (A, b, n, lcp_work(n), np.zeros(n)), REPEATS)
        seconds.setdefault(size_name(n), []).append(taken)
    return {name: float(np.mean(found)) for name, found in seconds.items()}


def problems_met(walk: Walk) -> list[Problem]:
    """The problems at the events of a walk."""
    run, found = walk.run, []
    problem = run.scratch.work.problem
    loop = run.compiled.model, run.finder.cells, run.state, run.options, run.scratch, walk.room
    for kind, posed in POSED.items():
        for moment in walk.moments[kind]:
            for which in posed:
                walk.at(moment)
                if n := pose(*loop, which):
                    found.append((problem.A[:n, :n].copy(), problem.rhs[:n].copy()))
    return found


def size_name(unknowns: int) -> str:
    """The name of the count of problems with that many unknowns."""
    return next((f"lcp_to_{size}" for size in LARGEST if unknowns <= size), "lcp_larger")


# Kernels are called many times in compiled code at the moments of a walk. What has no kernel of its own is what the loop
# takes at these moments beyond the pieces counted by themselves.

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
    mode_ends = state.instant.event_waits == 1 and state.instant.touched < 0
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


# The floor is what would be left if nothing were done but the counted work: each count times the cost of one piece of it,
# measured by itself in the middle of the run (`kernel_costs`). No work is counted twice. What is above the floor is the
# rest: what goes on in between, and what the same work takes more when it is not done many times in a row.

WORDS = {
    "step": "steps of coupled bodies",
    "evaluation": "accelerations of coupled bodies",
    "flight": "flights in closed form",
    "gap_evaluation": "gaps",
    "cell_lookup": "cells looked up",
    "instant": "instants of events",
    "impact": "impacts",
    "lcp_to_1": "problems of 1 unknown",
    "lcp_to_2": "problems of 2 unknowns",
    "lcp_to_4": "problems of 3 and 4 unknowns",
    "lcp_to_8": "problems of 5 to 8 unknowns",
    "lcp_to_16": "problems of 9 to 16 unknowns",
    "lcp_larger": "problems of more unknowns",
    "call": "calls of the loop, tallies",
}
NUMERICS = ("evaluation", "gap_evaluation", *(name for name in WORDS if name.startswith("lcp_")))
LONGEST = 10.0  # s simulated once more
TIMES, ENOUGH = 5, 1.0  # runs, of which the quickest counts; s after which no other one is begun


class _Timed(Run):
    """A run that knows how often the compiled loop was called, and for how long."""

    calls = 0
    looping: float = 0.0  # s of processor time
    learning: float = 0.0

    def _advance(self, until: Until, record: Any) -> Stop:
        begun = time.process_time()
        stop = super()._advance(until, record)
        self.looping += time.process_time() - begun
        self.calls += 1
        return stop

    def _learn(self) -> None:
        begun = time.process_time()
        super()._learn()
        self.learning += time.process_time() - begun


def profile_of(run: Trajectory) -> dict[str, Any]:
    """The first ten seconds of a run by events done again, with no cell known and with all cells known, and its kernels.

    `simulated_s`; `stepping_s` of processor time with all cells known, without set-up; `counts`; `work`: kind of work ->
    {count, seconds_each, seconds, share}; `floor_s`, the sum of these seconds; `rest`: {seconds, share} above it; `over_floor`,
    the stepping over the floor; `over_numerics`, over accelerations, gaps and problems alone; `learning`: as one of `work`, for
    the cells asked about where nothing is known before, its share that of the stepping there.
    ValueError for a run with fixed steps.
    """
    if run.method != EVENT_DRIVEN:
        raise ValueError(f"only runs of the method {EVENT_DRIVEN} have a profile, not those of {run.method}")
    duration = min(run.simulated, LONGEST)
    learning = _learning(run.scene, run.tolerance, duration)
    again, stop, stepping = _quickest(run.scene, run.tolerance, duration)
    counts = trajectory_of(again, stop, stepping, 0.0).counts | {"calls": again.calls}
    walk = Walk(run.scene, run.tolerance, duration)
    costs = kernel_costs(walk) | {"call": walk.call_seconds() + (stepping - again.looping) / again.calls}
    count = {name: counts[COUNTED_AS.get(name, name)] for name in WORDS}
    work = {name: _shared(n, costs[name] * n, stepping) for name, n in count.items() if n and name in costs}
    floor = sum(entry["seconds"] for entry in work.values())
    numerics = sum(work[name]["seconds"] for name in NUMERICS if name in work)
    return {
        "simulated_s": duration,
        "stepping_s": stepping,
        "counts": counts,
        "work": work,
        "rest": {"seconds": stepping - floor, "share": 1.0 - floor / stepping},
        "floor_s": floor,
        "over_floor": stepping / floor if floor > 0.0 else None,
        "over_numerics": stepping / numerics if numerics > 0.0 else None,
        "learning": learning,
    }


def _quickest(scene: Scene, tolerance: float, duration: float) -> tuple[_Timed, Stop, float]:
    """Of some runs, as `_stepped`."""
    runs = [_stepped(scene, tolerance, duration)]
    while len(runs) < TIMES and sum(run[2] for run in runs) < ENOUGH:
        runs.append(_stepped(scene, tolerance, duration))
    return min(runs, key=lambda run: run[2])


def _stepped(scene: Scene, tolerance: float, duration: float) -> tuple[_Timed, Stop, float]:
    """(a run done, why it ended, seconds of processor time)."""
    run = _Timed(scene, compile_scene(scene), tolerance, Recording(keep="statistics"))
    run.warm_up()
    run.calls = run.looping = 0
    begun = time.process_time()
    stop = run.to_the_end(duration, None)
    return run, stop, time.process_time() - begun


def _learning(scene: Scene, tolerance: float, duration: float) -> dict[str, float]:
    """What cells take that nobody in this process has asked about."""
    forget()
    run, _, stepping = _stepped(scene, tolerance, duration)
    return _shared(run.finder.learned, run.learning, stepping)


def _shared(count: int, seconds: float, of: float) -> dict[str, float]:
    return {"count": count, "seconds_each": seconds / count if count else 0.0, "seconds": seconds, "share": seconds / of}


def profile_text(profile: Mapping[str, Any]) -> str:
    """The same for people."""
    lines = [f"  stepping     {profile['stepping_s']:.3g} s of processor time for {profile['simulated_s']:g} s simulated"]
    for name, entry in profile["work"].items():
        each = 1e9 * entry["seconds_each"]
        lines.append(f"{'':15}{WORDS[name]:33}{entry['count']:>9} × {each:6.0f} ns = {100.0 * entry['share']:4.1f} %")
    rest = f"{'':15}{'the rest':33}{'':24}{100.0 * profile['rest']['share']:4.1f} %"
    if profile["over_floor"] is not None:
        alone = f", {profile['over_numerics']:.3g} × accelerations, gaps and problems alone" if profile["over_numerics"] else ""
        lines.append(f"{'':15}{profile['over_floor']:.3g} × the sum of these{alone}")
    lines.append(rest)
    learning = profile["learning"]
    if learning["count"]:
        each, share = 1e6 * learning["seconds_each"], 100.0 * learning["share"]
        taken = f"{learning['count']} learnt × {each:.0f} µs = {learning['seconds']:.2g} s"
        lines.append(f"  cells        {taken}, {share:.0f} % of the stepping where none is known before")
    return "\n".join(lines)
