"""How is a scene simulated from Python?"""

from __future__ import annotations

import functools
import math
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from watchsim.mechanism.compile import compile_scene
from watchsim.scene.recording import Recording, Window, as_recording
from watchsim.scene.scene import Scene
from watchsim.simulation.frozen_run import trajectory_of
from watchsim.simulation.methods import EVENT_DRIVEN, METHODS, MOREAU, USUAL_STEP
from watchsim.simulation.record.joined_runs import joined
from watchsim.simulation.record.saved_state import SavedState
from watchsim.simulation.record.trajectory import Pair, Trajectory
from watchsim.simulation.runner import Progress, Run, load_for
from watchsim.tolerances import COARSEST_TOLERANCE, FINEST_TOLERANCE
from watchsim.units import TIME, UnitError, parse

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
) -> Trajectory:
    """Simulate `scene` from 0 to `duration` at a relative error `tolerance` per step (both default to the scene's own).

    scene      a scene, or the file or folder that holds one
    duration   seconds, or a text with its unit such as "5 s"; so is `step`
    record     what is kept: windows (s) of rows, "events", "statistics" or a `Recording`; default the scene's, else
               everything
    progress   called as progress(simulated, duration) about ten times a second
    prefilter  off: every declared pair of primitives is looked at in every step; slow, the same events
    method     "pfeiffer-glocker" (by events) or "moreau" (fixed steps of `step` seconds, default 10 µs; see
               docs/theory/method.md)
    start      go on from here instead of from the scene's start: a trajectory (the result then holds both parts), or its
               `end_state` (the result holds what follows). The same bits come out as from one run, whatever was cut where.
    stream     a folder in whose file system rows and events are held where they would take more than some 50 MB of memory: in
               files without a name, which vanish with the last array of the trajectory that looks into them

    follow     called as follow(pairs, events, rows) with the events and rows (t, q, u, a) that are settled, in order, while the
               run goes on; the last ones and what goes before `start` are in the trajectory only

    KeyboardInterrupt ends the run and keeps what was simulated. A solver that cannot go on does not raise: see
    `Trajectory.stop`. ValueError for a bad argument, and for a `start` of another scene or other settings; SceneError where
    bodies overlap at the start by more than the rounding of drawings.
    """
    begun = time.perf_counter()
    if not isinstance(scene, Scene):
        from watchsim.scene.file.load import load

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
        from watchsim.simulation.moreau.time_stepping import MoreauRun

        run: Run = MoreauRun(scene, compiled, tolerance, recording, USUAL_STEP if step is None else float(step))
    else:
        run = Run(scene, compiled, tolerance, recording)
    if stream is not None:
        run.kept.stream(Path(stream))
    if follow is not None:
        run.kept.follow = functools.partial(follow, run.pairs)
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
