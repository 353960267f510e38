"""How does a simulation run from Python, whatever the stepping?

The compiled loop is called slice by slice; unknown cells, full buffers, progress and interrupts are dealt with between
slices. A frozen trajectory is handed back.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cells import CellFinder
from watchsim.dynamics.forces import stored_energy
from watchsim.mechanism.compile import Compiled
from watchsim.mechanism.model import KIND_WORD
from watchsim.mechanism.oscillation import frequency
from watchsim.mechanism.recording import Recording
from watchsim.mechanism.scene import Scene
from watchsim.simulation.advance import EVENTS_PER_CONTACT, ROWS_PER_STEP, advance
from watchsim.simulation.failure import failure_of
from watchsim.simulation.interrupts import held_interrupts
from watchsim.simulation.kept import Kept, tail_length
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.options import Options, options_for
from watchsim.simulation.saved import SavedState, save_state
from watchsim.simulation.state import (
    COUNT_NAMES,
    DAMPING,
    DRIVE,
    FRICTION,
    IMPACTS,
    State,
    new_record,
    new_scratch,
    new_state,
    room_for,
)
from watchsim.simulation.stops import Stop
from watchsim.simulation.tally import Tally
from watchsim.simulation.trajectory import EVENT_DTYPE, EventKind, Pair, Trajectory

Progress = Callable[[float, float], None]  # simulated time, duration

ROWS, EVENTS = 20000, 20000
SLICE_WALL = 0.1  # s between looks at the clock


def natural_step(compiled: Compiled, longest: float) -> float:
    """Longest step: a quarter of the fastest spring's period, so that no turning point hides between two others."""
    return min(longest, 0.5 * math.pi / compiled.fastest) if compiled.fastest else longest


class Run:
    """A run under way: the loop's arrays and what has been kept. By events; see `moreau.MoreauRun` for fixed steps.

    The step of a scene without springs is bounded by the duration the scene gives, not by the asked one: how far a run is
    to go must not change a bit of it.
    """

    method = EVENT_DRIVEN
    step: float | None = None  # s, where steps are fixed

    def __init__(self, scene: Scene, compiled: Compiled, tolerance: float, recording: Recording) -> None:
        model = compiled.model
        self.scene, self.compiled, self.tolerance = scene, compiled, tolerance
        self.options: Options = options_for(compiled.size, tolerance, natural_step(compiled, scene.duration))
        self.state: State = new_state(model, compiled.q, compiled.u)
        self.state.clock[1] = 1e-3 * self.options.max_step
        self.finder = CellFinder(model)
        self.scratch = new_scratch(model)
        self.pairs = pairs_of(compiled)
        self.kept, self.tally = Kept(recording, tail_length(frequency(scene))), Tally(scene, self.pairs)
        # A step wider, for the rows next to a window.
        windows = np.array(self.kept.windows, float).reshape(-1, 2) + self.options.max_step * np.array([-1.0, 1.0])
        self.record = new_record(model, ROWS + ROWS_PER_STEP, EVENTS + EVENTS_PER_CONTACT * room_for(model), windows)
        self.stored_at_start = stored_energy(model, self.state.q, self.state.u)
        self.saved: SavedState | None = None
        self._parts_before = 0  # what was flushed before the state was saved

    def begin_from(self, saved: SavedState) -> None:
        """Take up a saved state; ValueError where it is not one of this model with these settings."""
        saved.check(self.compiled, self.settings())
        saved.restore(self.arrays())
        self.stored_at_start = saved.stored_at_start
        self.tally.restore(saved.tally)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything the future depends on, besides the model and the settings."""
        return {**self.state._asdict(), "worst_residual": self._worst_residual()}

    def _worst_residual(self) -> NDArray[np.float64]:
        """(1,): the worst violation of a complementarity condition so far."""
        worst: NDArray[np.float64] = self.scratch.work.lcp.worst
        return worst

    def settings(self) -> dict[str, Any]:
        """What must be the same when a saved state is taken up."""
        return {"method": self.method, **{name: float(value) for name, value in self.options._asdict().items()}}

    def save(self) -> SavedState:
        """The state now, with the sums over all events so far."""
        self.flush()
        self._parts_before = self.kept.parts
        return save_state(self.compiled, self.settings(), self.arrays(), self.stored_at_start, self.tally.arrays())

    def flush(self) -> None:
        """Empty the buffers: count the events, keep what the recording wants."""
        rows, events = self.record.used
        self.tally.fold(self.record.events[:events])
        self.kept.flush(self.record.rows[:rows], self.record.events[:events])
        self.record.used[:] = 0

    def warm_up(self) -> None:
        """Load or compile the kernels: a call that returns at once because it has no room to record."""
        nowhere = new_record(self.compiled.model, 0, 0, self.record.windows)
        self._advance(np.zeros(3), nowhere)

    def _advance(self, until: NDArray[np.float64], record: Any) -> Stop:
        code = advance(self.compiled.model, self.finder.cells, self.state, self.options, until, self.scratch, record)
        return Stop(int(code))

    def _learn(self) -> None:
        """Look up the cell that the loop has met."""
        self.finder.learn(int(self.scratch.unknown[0]), self.scratch.at.copy())

    def to_the_end(self, duration: float, progress: Progress | None) -> Stop:
        """Run until the duration is over or something ends the run for good."""
        try:
            with held_interrupts() as interrupted:
                stop = self._slices(duration, progress, interrupted)
        except KeyboardInterrupt:
            stop = Stop.INTERRUPTED
        if self.saved is None:
            self.saved = self.save()
        self.flush()
        return stop

    def _slices(self, duration: float, progress: Progress | None, interrupted: Callable[[], bool]) -> Stop:
        """Slice after slice of about `SLICE_WALL`, with what has to be done between them."""
        length = 1e-5 * duration  # grows tenfold at most: a long slice would be deaf
        until = np.array([0.0, duration, 0.0])
        while True:
            start = time.perf_counter()
            until[0] = min(duration, self.state.clock[0] + length)
            stop = self._advance(until, self.record)
            if stop == Stop.CELL_UNKNOWN:
                self._learn()
            elif stop == Stop.BUFFER_FULL:
                self.flush()
            elif stop == Stop.LAST_STEP:
                # The next step is cut short by the end. Who goes on later must go on from here, to take it whole.
                self.saved, until[2] = self.save(), 1.0
            elif stop != Stop.SLICE:
                return stop
            else:
                taken = time.perf_counter() - start
                length = min(max(length * SLICE_WALL / max(taken, 1e-4), 1e-9 * duration), 10.0 * length)
            if progress is not None:
                progress(float(self.state.clock[0]), duration)
            if interrupted():
                return Stop.INTERRUPTED

    def _all_kept(self, parts: int | None = None) -> tuple[NDArray[np.float64], NDArray[Any]]:
        """Rows and events of the first `parts` flushes, default all."""
        rows, events = self.kept.closed(float(self.state.clock[0]), parts)
        nothing = np.zeros((0, 1 + 3 * len(self.state.q)))
        return nothing if rows is None else rows, np.zeros(0, EVENT_DTYPE) if events is None else events

    def trajectory(self, stop: Stop, wall: float, compile_time: float) -> Trajectory:
        """Everything kept, as a frozen value."""
        n = len(self.state.q)
        compiled = self.compiled
        rows, events = self._all_kept()
        before = [len(part) for part in self._all_kept(self._parts_before)]
        saved = None if self.saved is None else dataclasses.replace(self.saved, rows=before[0], events=before[1])
        return Trajectory(
            scene=self.scene,
            t=rows[:, 0],
            q=compiled.relative(rows[:, 1 : 1 + n]),
            u=compiled.relative(rows[:, 1 + n : 1 + 2 * n], rates=True),
            a=compiled.relative(rows[:, 1 + 2 * n :], rates=True),
            slices=compiled.slices,
            events=_as_told(events, compiled),
            pairs=self.pairs,
            stop=stop,
            stop_message=f"t = {self.state.clock[0]:.9g} s: {stop.sentence}",
            simulated=float(self.state.clock[0]),
            wall=wall,
            compile=compile_time,
            method=self.method,
            tolerance=self.tolerance,
            worst_penetration=float(self.state.worst[0]),
            worst_residual=float(self._worst_residual()[0]),
            energy=self._energy(),
            counts=self._counts(),
            step=self.step,
            end_q=compiled.relative(self.state.q[None])[0].copy(),
            end_u=compiled.relative(self.state.u[None], rates=True)[0].copy(),
            keep=self.kept.recording.keep,
            spans=self.kept.spans(float(self.state.clock[0])),
            sums=self.tally.finished(),
            end_state=saved,
            failure=failure_of(self.state, self.scratch, self.pairs) if stop == Stop.LCP_FAILED else None,
        )

    def _counts(self) -> dict[str, int]:
        counts = {name: int(value) for name, value in zip(COUNT_NAMES, self.state.counts, strict=True)}
        counts["cells"] = self.finder.number
        counts["cells_asked"] = self.finder.learned
        counts["declared_pairs"] = len(self.compiled.model.contacts)
        return counts

    def _dissipated(self) -> dict[str, float]:
        sums = self.state.sums
        return {"friction": float(sums[FRICTION]), "damping": float(sums[DAMPING]), "impacts": float(sums[IMPACTS])}

    def _energy(self) -> dict[str, Any]:
        """The ledger: work in = stored + dissipated + residual, J."""
        sums = self.state.sums
        stored = stored_energy(self.compiled.model, self.state.q, self.state.u) - self.stored_at_start
        dissipated = self._dissipated()
        residual = sums[DRIVE] - stored - sum(dissipated.values())
        scale = max(abs(sums[DRIVE]), abs(stored), sum(dissipated.values()))
        return {
            "in_J": float(sums[DRIVE]),
            "dissipated": dissipated,
            "stored_J": float(stored),
            "residual_J": float(residual),
            "residual_relative": float(abs(residual) / scale) if scale else 0.0,
        }


def _as_told(events: NDArray[Any], compiled: Compiled) -> NDArray[Any]:
    """The events, angles of turning points told as the scene tells them."""
    told = [(compiled.model.coordinates[own].body, angle) for own, _, angle in compiled.against if angle != 0.0]
    events = events.copy() if told else events
    for body, angle in told:
        events["value"][(events["kind"] == EventKind.TURN) & (events["body"] == body)] -= angle
    return events


def pairs_of(compiled: Compiled) -> tuple[Pair, ...]:
    """The contacts of a model in words; row k belongs to contact number k."""
    model, owners = compiled.model, compiled.owners
    first = {name: owners.index(name) for name in dict.fromkeys(owners)}
    index = [number - first[name] for number, name in enumerate(owners)]
    # Plain lists: reading a field of a record array takes a microsecond each time.
    kind = [KIND_WORD[kind] for kind in model.primitives.kind.tolist()]
    side = list(zip(owners, kind, index, compiled.layers, strict=True))
    contacts = zip(model.contacts.group.tolist(), model.contacts.a.tolist(), model.contacts.b.tolist(), strict=True)
    return tuple(Pair(group, *side[a], *side[b]) for group, a, b in contacts)
