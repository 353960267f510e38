"""How is the event loop driven from a given state, without keeping rows?

What `simulate` does around the compiled loop, reduced to what a return map needs: states that can be copied, changed and taken
up again, and the events of an oscillation.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_table import CellFinder
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Scene
from watchsim.simulation.advance import EVENTS_PER_CONTACT, ROWS_PER_STEP, advance
from watchsim.simulation.loop_state.buffers import Until, new_record, new_until
from watchsim.simulation.loop_state.scratch import new_scratch
from watchsim.simulation.loop_state.state import State, new_state, room_for
from watchsim.simulation.loop_state.state_arrays import copy_of_state
from watchsim.simulation.options import natural_step, options_for
from watchsim.simulation.start_clearance import clear_start
from watchsim.simulation.start_clearance import warm_up as warm_up_start
from watchsim.simulation.stops import Stop
from watchsim.studies.limit_cycle.beginning import freed_start
from watchsim.tolerances import FIRST_STEP

Events = NDArray[Any]

EVENTS = 4000  # room for those of a slice
STEPS = 4000.0  # at most between two looks at the clock
NO_ROWS = np.zeros((0, 2))  # the windows in which rows are kept


class SolverGaveUp(Exception):
    """The event loop could not go on; `stop` says why, `time` (s) when, counted from the state it was given."""

    def __init__(self, stop: Stop, time: float) -> None:
        self.stop, self.time = stop, time
        super().__init__(stop.sentence)


class Loop:
    """The compiled loop of one scene at one tolerance; states are values that it is given."""

    def __init__(self, scene: Scene, tolerance: float, like: Loop | None = None) -> None:
        """`like` is a loop of the same scene at another tolerance: what it knows need not be found again."""
        self.scene, self.tolerance = scene, tolerance
        self.compiled: Compiled = like.compiled if like else compile_scene(scene)
        model = self.compiled.model
        self.options = options_for(self.compiled.size, tolerance, natural_step(self.compiled, scene.duration))
        self.finder: CellFinder = like.finder if like else CellFinder(model)
        self._scratch = new_scratch(model)
        self._record = new_record(model, ROWS_PER_STEP + 64, EVENTS + EVENTS_PER_CONTACT * room_for(model), NO_ROWS)
        self.simulated = 0.0  # s, over all states

    def warm_up(self) -> None:
        """Load or compile the kernels: a call that returns at once because it has no room to record."""
        nowhere = new_record(self.compiled.model, 0, 0, NO_ROWS)
        self._call(new_state(self.compiled.model, self.compiled.q, self.compiled.u), new_until(), nowhere)
        warm_up_start(self.scene, self.compiled.model)

    def begin(self) -> State:
        """The state at the scene's start; SceneError where bodies overlap there, but for a little (see beginning.py)."""
        try:
            q, _ = clear_start(self.scene, self.compiled, self.finder, self.options)
        except SceneError:
            freed = freed_start(self.compiled, self.options)
            if freed is None:
                raise
            q = freed
        state = new_state(self.compiled.model, q, self.compiled.u)
        state.clock.step = FIRST_STEP * self.options.max_step
        return state

    def on(self, state: State, time: float, exactly: bool = False) -> Events:
        """Bring `state` to the end of the step that passes `time` (s), or `exactly` there; the events on the way.

        SolverGaveUp where the loop cannot go on; KeyboardInterrupt between two slices.
        """
        begun = float(state.clock.time)
        until = new_until(time, time if exactly else math.inf, may_cut=True, steps=STEPS)
        parts = []
        while True:
            stop = self._call(state, until, self._record)
            if stop == Stop.CELL_UNKNOWN:
                self.finder.learn(int(self._scratch.asked.cell.pair), self._scratch.asked.at.copy(), state.u)
                continue
            events = int(self._record.used.events)
            parts.append(self._record.events[:events].copy())
            self._record.used.rows, self._record.used.events = 0, 0
            if stop == Stop.DURATION or (stop == Stop.SLICE and state.clock.time >= time):
                break
            if stop == Stop.SLICE:
                until.steps = STEPS
            elif stop != Stop.BUFFER_FULL:
                raise SolverGaveUp(stop, float(state.clock.time))
        self.simulated += float(state.clock.time) - begun
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def _call(self, state: State, until: Until, record: Any) -> Stop:
        return Stop(int(advance(self.compiled.model, self.finder.cells, state, self.options, until, self._scratch, record)))


def copied(state: State) -> State:
    """The same state in arrays of its own."""
    return copy_of_state(state)
