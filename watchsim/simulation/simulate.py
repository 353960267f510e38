"""How is a scene simulated from Python?

Compile the scene, run the event loop slice by slice (unknown cells, full buffers, progress and interrupts are dealt with
between slices), and hand back a frozen trajectory.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cells import CellFinder
from watchsim.dynamics.forces import stored_energy
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.mechanism.model import KIND_WORD
from watchsim.mechanism.scene import Scene
from watchsim.simulation.advance import EVENTS_PER_STEP, ROWS_PER_STEP, advance
from watchsim.simulation.failure import failure_of
from watchsim.simulation.options import Options, options_for
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
)
from watchsim.simulation.stops import Stop
from watchsim.simulation.trajectory import EVENT_DTYPE, Pair, Trajectory

Progress = Callable[[float, float], None]  # simulated time, duration

ROWS, EVENTS = 20000, 20000
SLICE_WALL = 0.1  # s between looks at the clock
WHOLE_RUN = ((-math.inf, math.inf),)


@dataclass
class _Kept:
    """Rows and events flushed so far."""

    rows: list[NDArray[np.float64]] = field(default_factory=list)
    events: list[NDArray[Any]] = field(default_factory=list)

    def flush(self, record: Any) -> None:
        rows, events = record.used
        self.rows.append(record.rows[:rows].copy())
        self.events.append(record.events[:events].copy())
        record.used[:] = 0


def simulate(
    scene: Scene,
    duration: float | None = None,
    tolerance: float | None = None,
    record: tuple[tuple[float, float], ...] | None = None,
    progress: Progress | None = None,
) -> Trajectory:
    """Simulate `scene` for `duration` seconds at a relative error `tolerance` per step (both default to the scene's own).

    `record` lists the windows (s) in which rows are kept, default the scene's, else the whole run; events are always kept.
    `progress(simulated, duration)` is called about ten times a second. KeyboardInterrupt ends the run and keeps what was
    simulated. A solver that cannot go on does not raise: see `Trajectory.stop`.
    """
    start = time.perf_counter()
    duration = scene.duration if duration is None else float(duration)
    tolerance = scene.tolerance if tolerance is None else float(tolerance)
    if not (duration > 0.0 and math.isfinite(duration)):
        raise ValueError(f"the duration must be a positive number of seconds, not {duration}")
    if not 1e-13 <= tolerance <= 1e-2:
        raise ValueError(f"the tolerance must lie between 1e-13 and 1e-2, not {tolerance}")
    compiled = compile_scene(scene)
    run = _Run(compiled, tolerance, duration, record or scene.record or WHOLE_RUN)
    ready = time.perf_counter()
    run.warm_up()
    warm = time.perf_counter()
    stop = run.to_the_end(duration, progress)
    done = time.perf_counter()
    return run.trajectory(scene, stop, wall=done - warm, compile_time=warm - ready, setup=ready - start)


def natural_step(compiled: Compiled, duration: float) -> float:
    """Longest step: a quarter of the fastest spring's period, so that no turning point hides between two others."""
    return min(duration, 0.5 * math.pi / compiled.fastest) if compiled.fastest else duration


class _Run:
    """A run under way: the loop's arrays and what has been kept."""

    def __init__(self, compiled: Compiled, tolerance: float, duration: float, windows: Any) -> None:
        model = compiled.model
        self.compiled, self.tolerance = compiled, tolerance
        self.options: Options = options_for(compiled.size, tolerance, natural_step(compiled, duration))
        self.state: State = new_state(model, compiled.q, compiled.u)
        self.state.clock[1] = 1e-3 * self.options.max_step
        self.finder = CellFinder(model)
        self.scratch = new_scratch(model)
        self.record = new_record(model, ROWS + ROWS_PER_STEP, EVENTS + EVENTS_PER_STEP, np.array(windows, float).reshape(-1, 2))
        self.kept = _Kept()
        self.stored_at_start = stored_energy(model, self.state.q, self.state.u)
        self.message = ""

    def warm_up(self) -> None:
        """Load or compile the kernels: a call that returns at once because it has no room to record."""
        nowhere = new_record(self.compiled.model, 0, 0, self.record.windows)
        self._advance(np.zeros(2), nowhere)

    def _advance(self, until: NDArray[np.float64], record: Any) -> Stop:
        code = advance(self.compiled.model, self.finder.cells, self.state, self.options, until, self.scratch, record)
        return Stop(int(code))

    def to_the_end(self, duration: float, progress: Progress | None) -> Stop:
        """Run until the duration is over or something ends the run for good."""
        length = duration / 100.0
        try:
            while True:
                start = time.perf_counter()
                until = np.array([min(duration, self.state.clock[0] + length), duration])
                stop = self._advance(until, self.record)
                if stop == Stop.CELL_UNKNOWN:
                    self.finder.learn(int(self.scratch.unknown[0]), self.scratch.at.copy())
                elif stop == Stop.BUFFER_FULL:
                    self.kept.flush(self.record)
                elif stop != Stop.SLICE:
                    break
                else:
                    taken = time.perf_counter() - start
                    length = min(max(length * SLICE_WALL / max(taken, 1e-4), 1e-9 * duration), 10.0 * length)
                if progress is not None:
                    progress(float(self.state.clock[0]), duration)
        except KeyboardInterrupt:
            stop = Stop.INTERRUPTED
        self.kept.flush(self.record)
        return stop

    def trajectory(self, scene: Scene, stop: Stop, wall: float, compile_time: float, setup: float) -> Trajectory:
        """Everything kept, as a frozen value."""
        n = len(self.state.q)
        rows = np.concatenate(self.kept.rows) if self.kept.rows else np.zeros((0, 1 + 3 * n))
        events = np.concatenate(self.kept.events) if self.kept.events else np.zeros(0, EVENT_DTYPE)
        counts = {name: int(value) for name, value in zip(COUNT_NAMES, self.state.counts, strict=True)}
        counts["cells"] = len(self.finder._known)
        counts["declared_pairs"] = len(self.compiled.model.contacts)
        pairs = pairs_of(self.compiled, scene)
        return Trajectory(
            scene=scene,
            t=rows[:, 0],
            q=rows[:, 1 : 1 + n],
            u=rows[:, 1 + n : 1 + 2 * n],
            a=rows[:, 1 + 2 * n :],
            slices=self.compiled.slices,
            events=events,
            pairs=pairs,
            stop=stop,
            stop_message=f"t = {self.state.clock[0]:.9g} s: {stop.sentence}",
            simulated=float(self.state.clock[0]),
            wall=wall + setup,
            compile=compile_time,
            tolerance=self.tolerance,
            worst_penetration=float(self.state.worst[0]),
            energy=self._energy(),
            counts=counts,
            failure=failure_of(self.state, self.scratch, pairs) if stop == Stop.LCP_FAILED else None,
        )

    def _energy(self) -> dict[str, Any]:
        """The ledger: work in = stored + dissipated + residual, J."""
        sums = self.state.sums
        stored = stored_energy(self.compiled.model, self.state.q, self.state.u) - self.stored_at_start
        dissipated = {"friction": sums[FRICTION], "damping": sums[DAMPING], "impacts": sums[IMPACTS]}
        residual = sums[DRIVE] - stored - sum(dissipated.values())
        scale = max(abs(sums[DRIVE]), abs(stored), sum(dissipated.values()))
        return {
            "in_J": float(sums[DRIVE]),
            "dissipated": {name: float(value) for name, value in dissipated.items()},
            "stored_J": float(stored),
            "residual_J": float(residual),
            "residual_relative": float(abs(residual) / scale) if scale else 0.0,
        }


def pairs_of(compiled: Compiled, scene: Scene) -> tuple[Pair, ...]:
    """The contacts of a model in words; row k belongs to contact number k."""
    model, names = compiled.model, [body.name for body in scene.bodies]
    first = {int(b): i for i, b in reversed(list(enumerate(model.primitives.body)))}
    out = []
    for contact in model.contacts:
        a, b = model.primitives[contact.a], model.primitives[contact.b]
        out.append(
            Pair(
                group=int(contact.group),
                body_a=names[a.body],
                primitive_a=KIND_WORD[a.kind],
                index_a=int(contact.a) - first[int(a.body)],
                layer_a=compiled.layers[contact.a],
                body_b=names[b.body],
                primitive_b=KIND_WORD[b.kind],
                index_b=int(contact.b) - first[int(b.body)],
                layer_b=compiled.layers[contact.b],
            )
        )
    return tuple(out)
