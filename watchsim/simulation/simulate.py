"""How is a scene simulated from Python?"""

from __future__ import annotations

import dataclasses
import functools
import math
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import blank, row_of
from watchsim.scene.scene import Recording, Scene, Window, as_recording
from watchsim.simulation import EVENT_DRIVEN, METHODS, MOREAU
from watchsim.simulation.foregone import Foregone
from watchsim.simulation.moreau import EVENTS_PER_CONTACT, ROWS_PER_STEP, Pace, advance_fixed, moreau_work
from watchsim.simulation.recording import Pair
from watchsim.simulation.runner import EVENTS, ROWS, Progress, Run, load_for, trajectory_of
from watchsim.simulation.saved_state import SavedState
from watchsim.simulation.scratch import Until, new_record
from watchsim.simulation.state import USUAL_STEP, Stop, room_for
from watchsim.simulation.systems import run_of
from watchsim.simulation.trajectory import Trajectory, joined
from watchsim.tolerances import COARSEST_TOLERANCE, FINEST_TOLERANCE
from watchsim.units import TIME, UnitError, parse

# How does Moreau's time stepping run on the same model? The independent twin of the event-driven solver.

ROWS_PER_QUARTER = 300  # of the fastest spring's period; of the scene's duration where there is no spring


class MoreauRun(Run):
    """Fixed steps of `step` seconds; impacts, friction and forces once for each."""

    method = MOREAU

    def __init__(self, scene: Scene, compiled: Compiled, tolerance: float, recording: Recording, step: float) -> None:
        super().__init__(scene, compiled, tolerance, recording)
        self.step = step
        self.pace = blank(Pace)
        self.pace.step, self.pace.row = step, max(step, self.options.max_step / ROWS_PER_QUARTER)
        self.work = moreau_work(compiled.model)
        self.record = new_record(
            compiled.model, ROWS + ROWS_PER_STEP, EVENTS + EVENTS_PER_CONTACT * room_for(compiled.model), self.record.windows
        )

    def begin_from(self, saved: SavedState) -> None:
        if "row_time" not in saved.arrays:  # earlier versions kept it with the times
            saved = dataclasses.replace(saved, arrays=saved.arrays | {"row_time": saved.arrays["clock"][2:]})
        super().begin_from(saved)

    def arrays(self) -> dict[str, NDArray[Any]]:
        kept = row_of(self.work.kept)
        own = {name: kept[name] for name in ("depth", "sweeps", "row_time", "since_row")}
        return {**super().arrays(), **{name: getattr(self.work, name) for name in ("memory", "row_a", "row_jerk")}, **own}

    def worst_residual(self) -> NDArray[np.float64]:
        return cast(NDArray[np.float64], row_of(self.work.kept)["violation"])

    def settings(self) -> dict[str, Any]:
        return {**super().settings(), "step": self.step}

    def _advance(self, until: Until, record: Any) -> Stop:
        model = self.compiled.model
        # Of fixed length, so that their number is a time.
        before = float(self.state.clock.time)
        until.slice_end = min(until.slice_end, before + until.steps * self.pace.step)
        code = advance_fixed(model, self.finder.cells, self.state, self.options, until, self.pace, self.work, record)
        until.steps -= round((float(self.state.clock.time) - before) / self.pace.step)
        return Stop(int(code))

    def _learn(self) -> None:
        self.finder.learn(int(self.work.requested.cell.pair), self.work.requested.at.copy(), self.state.u)

    def counts(self) -> dict[str, int]:
        return {**super().counts(), "sweeps": int(self.work.kept.sweeps)}

    def _ledger_fails(self) -> bool:
        """Never: the error of the ledger goes with the step, which the user has chosen."""
        return False

    def _dissipated(self) -> dict[str, float]:
        return {**super()._dissipated(), "stepping": float(self.state.sums.correction)}


Follow = Callable[[Sequence[Pair], NDArray[Any], Sequence[NDArray[Any]]], object]


def simulate(  # noqa: PLR0913 - options, by name
    scene: Scene | str | Path,
    duration: float | str | None = None,
    tolerance: float | None = None,
    record: Recording | str | Iterable[Window] | None = None,
    progress: Progress | None = None,
    prefilter: bool = True,
    *,
    method: str = EVENT_DRIVEN,
    step: float | str | None = None,
    start: Trajectory | SavedState | None = None,
    stream: str | Path | None = None,
    follow: Follow | None = None,
    to_the_end: bool = True,
) -> Trajectory:
    """Simulate `scene` from 0 to `duration` at a relative error `tolerance` per step (both default to the scene's own).

    scene      a scene, or the file or folder that holds one
    duration   seconds, or a text with its unit such as "5 s"; so is `step`
    record     what is kept: windows (s) of rows, "events", "statistics" or a `Recording`; default the scene's, else
               everything
    progress   called as progress(simulated, duration) about ten times a second; before that its attribute `crowded`, if it has
               one, with words where events crowd so that the run crawls (which contacts, since when), else with ""
    prefilter  off: every declared pair of primitives is looked at in every step; slow, the same events
    method     "pfeiffer-glocker" (by events) or "moreau" (fixed steps of `step` seconds, default 10 µs; see
               docs/theory/method.md)
    start      go on from here instead of from the scene's start: a trajectory (the result then holds both parts), or its
               `end_state` (the result holds what follows). The same bits come out as from one run, whatever was cut where.
    stream     a folder in whose file system rows and events are held where they would take more than some 50 MB of memory: in
               files without a name, which vanish with the last array of the trajectory that looks into them

    follow     called as follow(pairs, events, rows) with the events and rows (t, q, u, a) that are settled, in order, while the
               run goes on; the last ones and what goes before `start` are in the trajectory only

    to_the_end  off: a watch that has come to rest, or whose wheel races, ends the run, since nothing can change any more

    KeyboardInterrupt ends the run and keeps what was simulated. A solver that cannot go on does not raise: see
    `Trajectory.stop`. ValueError for a bad argument, and for a `start` of another scene or other settings; SceneError where
    bodies overlap at the start by more than the rounding of drawings.
    """
    begun = time.perf_counter()
    if not isinstance(scene, Scene):
        from watchsim.scene.load import load

        scene = load(scene)
    duration = scene.duration if duration is None else _seconds("duration", duration)
    step = None if step is None else _seconds("step", step)
    tolerance = scene.tolerance if tolerance is None else float(tolerance)
    _check(duration, tolerance, method, step)
    compiled = compile_scene(scene, prefilter)
    loading = time.perf_counter()
    load_for(compiled)
    loading = time.perf_counter() - loading
    recording = as_recording(record) or scene.record
    if method == MOREAU:
        run: Run = MoreauRun(scene, compiled, tolerance, recording, USUAL_STEP if step is None else float(step))
    else:
        run = run_of(scene, compiled, tolerance, recording, prefilter)
    if stream is not None:
        run.kept.stream(Path(stream))
    if follow is not None:
        run.kept.follow = functools.partial(follow, run.pairs)
    if not to_the_end:
        run.foregone = Foregone(scene, compiled)
    if start is not None:
        _take_up(run, start, duration)
    warming = time.perf_counter()
    run.warm_up()
    loading += time.perf_counter() - warming
    if start is None:
        run.begin()
    stop = run.to_the_end(duration, progress)
    made = trajectory_of(run, stop, time.perf_counter() - begun - loading, compile_time=loading)
    if isinstance(start, Trajectory):
        return joined(start, made, None if stream is None else Path(stream))
    return made


def _seconds(name: str, value: float | str) -> float:
    """A number of seconds, or a text with a unit of time."""
    try:
        return parse(value, TIME) if isinstance(value, str) else float(value)
    except UnitError as error:
        raise ValueError(f"{name}: {error}") from error


def _check(duration: float, tolerance: float, method: str, step: float | None) -> None:
    if not (duration > 0.0 and math.isfinite(duration)):
        raise ValueError(f"the duration must be a positive number of seconds, not {duration}")
    if not FINEST_TOLERANCE <= tolerance <= COARSEST_TOLERANCE:
        raise ValueError(f"the tolerance must lie between {FINEST_TOLERANCE:g} and {COARSEST_TOLERANCE:g}, not {tolerance}")
    if method not in METHODS:
        raise ValueError(f'there is no method "{method}"; choose {" or ".join(METHODS)}')
    if step is not None and method != MOREAU:
        raise ValueError(f"a fixed step belongs to the method {MOREAU}; {method} finds its own steps from the tolerance")
    if step is not None and not 0.0 < step <= duration:
        raise ValueError(f"the step must be a positive number of seconds up to the duration ({duration:g}), not {step}")


def _take_up(run: Run, start: Trajectory | SavedState, duration: float) -> None:
    """Begin from a saved state."""
    saved = start.end_state if isinstance(start, Trajectory) else start
    if saved is None:
        raise ValueError("this trajectory carries no end state to go on from")
    reached = start.simulated if isinstance(start, Trajectory) else saved.time
    if not duration > reached:
        raise ValueError(
            f"the run to go on from has reached {reached:g} s already; the duration {duration:g} s must lie beyond"
        )
    run.begin_from(saved)
