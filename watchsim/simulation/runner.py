"""How does a simulation run from Python, whatever the stepping?

The compiled loop is called slice by slice; unknown cells, full buffers, progress and interrupts are dealt with between
slices. What is handed back stands in `frozen_run`.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.broad_phase import load_shapely
from watchsim.candidates.cell_table import CellFinder
from watchsim.dynamics.applied_forces import stored_energy
from watchsim.mechanism.compile import Compiled
from watchsim.model.named_fields import words_of
from watchsim.scene.oscillation import frequency
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation.advance import EVENTS_PER_CONTACT, ROWS_PER_STEP, advance
from watchsim.simulation.energy_ledger import ledger, ledger_fails, usual_energy
from watchsim.simulation.interrupts import held_interrupts
from watchsim.simulation.loop_state.buffers import Until, new_record, new_until
from watchsim.simulation.loop_state.scratch import new_scratch
from watchsim.simulation.loop_state.state import COUNT_NAMES, State, new_state, room_for
from watchsim.simulation.loop_state.state_arrays import arrays_of
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.options import Options, natural_step, options_for
from watchsim.simulation.record.contact_names import pairs_of
from watchsim.simulation.record.overlap_watch import OverlapWatch
from watchsim.simulation.record.overlap_watch import warm_up as warm_up_watch
from watchsim.simulation.record.row_selection import Kept, tail_length
from watchsim.simulation.record.saved_state import SavedState, save_state
from watchsim.simulation.record.scene_coordinates import events_of_scene, rows_of_scene
from watchsim.simulation.record.tally import Tally
from watchsim.simulation.slice_pace import Pace
from watchsim.simulation.start_clearance import clear_start
from watchsim.simulation.start_clearance import warm_up as warm_up_start
from watchsim.simulation.stops import Stop
from watchsim.tolerances import FIRST_STEP

Progress = Callable[[float, float], None]  # simulated time, duration

ROWS, EVENTS = 20000, 20000

_warm: set[type[Run]] = set()  # ways of stepping whose kernels are loaded


def load_for(compiled: Compiled) -> None:
    """Load what a run needs before it can be made: once in a process, 40 ms that say nothing about the scene."""
    if len(compiled.model.contacts):
        load_shapely()
    stored_energy(compiled.model, compiled.q, compiled.u)


class Run:
    """A run under way: the loop's arrays and what has been kept. By events; see `moreau.MoreauRun` for fixed steps.

    The step of a scene without springs is bounded by the duration the scene gives, not by the requested one: how far a run is
    to go must not change a bit of it.
    """

    method = EVENT_DRIVEN
    step: float | None = None  # s, where steps are fixed

    def __init__(self, scene: Scene, compiled: Compiled, tolerance: float, recording: Recording) -> None:
        model = compiled.model
        self.scene, self.compiled, self.tolerance = scene, compiled, tolerance
        self.options: Options = options_for(compiled.size, tolerance, natural_step(compiled, scene.duration))
        self.state: State = new_state(model, compiled.q, compiled.u)
        self.state.clock.step = FIRST_STEP * self.options.max_step
        self.finder = CellFinder(model)
        self.scratch = new_scratch(model)
        self.pairs = pairs_of(compiled)
        self.kept = Kept(
            recording,
            tail_length(frequency(scene)),
            functools.partial(rows_of_scene, compiled),
            functools.partial(events_of_scene, compiled),
        )
        self.tally = Tally(scene, self.pairs)
        # A step wider, for the rows next to a window.
        windows = np.array(self.kept.windows, float).reshape(-1, 2) + self.options.max_step * np.array([-1.0, 1.0])
        self.record = new_record(model, ROWS + ROWS_PER_STEP, EVENTS + EVENTS_PER_CONTACT * room_for(model), windows)
        self.watch = OverlapWatch(scene, compiled, self.method, self.kept.windows)
        self.stored_at_start = stored_energy(model, self.state.q, self.state.u)
        self._usual_energy = usual_energy(model)
        self.saved: SavedState | None = None
        self.parts_before = 0  # what was flushed before the state was saved

    def begin(self) -> None:
        """Begin at the scene's start; SceneError where bodies overlap there (see `start.clear_start`)."""
        q, taken_back = clear_start(self.scene, self.compiled, self.finder, self.options)
        if taken_back > 0.0:
            self.state.q[:], self.state.worst.penetration = q, taken_back
            self.stored_at_start = stored_energy(self.compiled.model, q, self.state.u)

    def begin_from(self, saved: SavedState) -> None:
        """Take up a saved state; ValueError where it is not one of this model with these settings."""
        saved.check(self.compiled, self.settings())
        saved.restore(self.arrays())
        self.stored_at_start = saved.stored_at_start
        self.tally.restore(saved.tally)
        self.kept.go_on(saved.recorded)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything the future depends on, besides the model and the settings."""
        return {**arrays_of(self.state)._asdict(), "worst_residual": self.worst_residual(), "overlap": self.watch.numbers}

    def worst_residual(self) -> NDArray[np.float64]:
        """(1,): the worst violation of a complementarity condition so far."""
        return words_of(self.scratch.work.lcp.worst, float)

    def settings(self) -> dict[str, Any]:
        """What must be the same when a saved state is taken up."""
        return {"method": self.method, **{name: float(value) for name, value in self.options._asdict().items()}}

    def save(self) -> SavedState:
        """The state now, with the sums over all events so far."""
        self.flush()
        self.parts_before = self.kept.parts
        state = save_state(self.compiled, self.settings(), self.arrays(), self.stored_at_start, self.tally.arrays())
        self.watch.fill_in_later(state.arrays["overlap"])
        return dataclasses.replace(state, recorded=self.kept.unfinished())

    def flush(self) -> None:
        """Empty the buffers: count the events, keep what the recording wants."""
        rows, events = self.record.used.rows, self.record.used.events
        self.tally.fold(self.record.events[:events])
        self.watch.see_rows(self.record.rows[:rows])
        self.kept.flush(self.record.rows[:rows], self.record.events[:events])
        self.record.used.rows, self.record.used.events = 0, 0

    def warm_up(self) -> None:
        """Load or compile the kernels, once in a process: a call that returns at once because it has no room to record."""
        if type(self) not in _warm:
            nowhere = new_record(self.compiled.model, 0, 0, self.record.windows)
            self._advance(new_until(), nowhere)
            self.finder.warm_up()
            _warm.add(type(self))
        warm_up_start(self.scene, self.compiled.model)
        if self.scene.contacts:
            warm_up_watch()

    def _advance(self, until: Until, record: Any) -> Stop:
        code = advance(self.compiled.model, self.finder.cells, self.state, self.options, until, self.scratch, record)
        return Stop(int(code))

    def _learn(self) -> None:
        """Look up the cell that the loop has met."""
        self.finder.learn(int(self.scratch.asked.cell.pair), self.scratch.asked.at.copy(), self.state.u)

    def to_the_end(self, duration: float, progress: Progress | None) -> Stop:
        """Run until the duration is over or something ends the run for good."""
        try:
            with held_interrupts() as interrupted:
                stop = self._slices(duration, progress, interrupted)
        except KeyboardInterrupt:
            stop = Stop.INTERRUPTED
        except OverflowError:  # so far away that no cell has a number
            stop = Stop.FAR_AWAY
        except MemoryError:
            stop = Stop.OUT_OF_MEMORY
        if self.saved is None:
            self.saved = self.save()
        self.flush()
        self._look()
        self.watch.see()
        if stop not in (Stop.DURATION, Stop.INTERRUPTED):
            return stop
        if self._overlaps():
            return Stop.OVERLAP
        return Stop.LEDGER if self._ledger_fails() else stop

    def _ledger_fails(self) -> bool:
        """Is the residual of the energy ledger more than rounding?"""
        held = max(float(self.state.worst.kinetic_energy), self.stored_at_start, self._usual_energy)
        return ledger_fails(self.energy(), held, self.tolerance)

    def _look(self) -> None:
        """Look, soon, at the state now for bodies inside each other."""
        self.watch.see_state(float(self.state.clock.time), self.state.q.copy())

    def _overlaps(self) -> bool:
        return self.watch.fails(float(self.state.worst.penetration))

    def _slices(self, duration: float, progress: Progress | None, interrupted: Callable[[], bool]) -> Stop:
        """Slice after slice, with what has to be done between them."""
        pace = Pace(duration)
        until = new_until(0.0, duration)
        look = self.watch.next_look(float(self.state.clock.time))
        while True:
            pace.begin(float(self.state.clock.time), until, look)
            stop = self._advance(until, self.record)
            if stop == Stop.CELL_UNKNOWN:
                self._learn()
                if interrupted():
                    return Stop.INTERRUPTED
                continue
            if stop == Stop.BUFFER_FULL:
                self.flush()
            elif stop == Stop.LAST_STEP:
                # The next step is cut short by the end. Who goes on later must go on from here, to take it whole.
                self.saved, until.may_cut = self.save(), 1
            elif stop != Stop.SLICE:
                return stop
            else:
                pace.end(float(self.state.clock.time), until)
            if self.state.clock.time >= look:
                self._look()
                look = self.watch.next_look(float(self.state.clock.time))
            if self._ledger_fails():
                return Stop.LEDGER
            if self._overlaps():
                return Stop.OVERLAP
            if progress is not None:
                progress(float(self.state.clock.time), duration)
            if interrupted():
                return Stop.INTERRUPTED

    def counts(self) -> dict[str, int]:
        """How much work was done: the names of COUNT_NAMES and of the cells."""
        counts = {name: int(value) for name, value in zip(COUNT_NAMES, words_of(self.state.counts, int), strict=True)}
        counts["cells"] = self.finder.number
        counts["cells_asked"] = self.finder.learned
        counts["declared_pairs"] = len(self.compiled.model.contacts)
        return counts

    def _dissipated(self) -> dict[str, float]:
        sums = self.state.sums
        return {"friction": float(sums.friction), "damping": float(sums.damping), "impacts": float(sums.impacts)}

    def energy(self) -> dict[str, Any]:
        """The ledger: work in = stored + dissipated + residual, J."""
        at_end = stored_energy(self.compiled.model, self.state.q, self.state.u)
        return ledger(float(self.state.sums.drive), self._dissipated(), (self.stored_at_start, at_end), self.compiled.model)
