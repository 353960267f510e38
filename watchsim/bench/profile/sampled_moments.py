"""What does a run do at a random sample of its moments, and how long does that take?

The run is walked: the loop is given room to record one step, so that it comes back after each step and after each event. From a
state kept on the way it can be started again and again. The same kernels as ever run, on what they really meet.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.bench.profile.repeated_work import moments_again
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation.advance import EVENTS_PER_CONTACT, ROWS_PER_STEP
from watchsim.simulation.loop_state.buffers import Record, new_record, new_until
from watchsim.simulation.loop_state.state import COUNT_NAMES, State, room_for
from watchsim.simulation.loop_state.state_arrays import arrays_of, copy_of_state, write_state
from watchsim.simulation.runner import Run
from watchsim.simulation.stops import Stop

SAMPLE = 200  # moments of each kind
REPEATS = 20  # of what follows a moment
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
        whole, nothing = (seconds_each(moments_again, (*loop, record), REPEATS) for record in (self.room, self._nowhere))
        return whole - nothing

    def call_seconds(self) -> float:
        """Of one call of the compiled loop from Python, s; in those timed here nothing is done."""

        def calls(repeats: int) -> None:
            for _ in range(repeats):
                self._advance(self._nowhere)

        return seconds_each(calls, (), REPEATS)

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
