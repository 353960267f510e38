"""What is handed back of a run when it ends, and what is said of its end?"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.lcp_failure import driven_into, failure_of
from watchsim.simulation.record.row_selection import columns_of
from watchsim.simulation.record.saved_state import SavedState
from watchsim.simulation.record.trajectory import EVENT_DTYPE, Trajectory
from watchsim.simulation.stop_details import furthest, unaccounted, unexplained, what_alternates
from watchsim.simulation.stops import Stop

if TYPE_CHECKING:
    from watchsim.simulation.runner import Run


def trajectory_of(run: Run, stop: Stop, wall: float, compile_time: float) -> Trajectory:
    """Everything kept of a run that ended with `stop`, as a frozen value; `wall` and `compile_time` in seconds."""
    compiled, state = run.compiled, run.state
    time = float(state.clock.time)
    (t, q, u, a), events = _all_kept(run)
    return Trajectory(
        scene=run.scene,
        t=t,
        q=q,
        u=u,
        a=a,
        slices=compiled.slices,
        events=events,
        pairs=run.pairs,
        stop=stop,
        stop_message=f"t = {time:.9g} s: {_words(run, stop)}",
        simulated=time,
        wall=wall,
        compile=compile_time,
        method=run.method,
        tolerance=run.tolerance,
        worst_penetration=float(state.worst.penetration),
        worst_residual=float(run.worst_residual()[0]),
        overlap=run.watch.result(float(state.worst.penetration)),
        energy=run.energy(),
        counts=run.counts(),
        step=run.step,
        end_q=compiled.relative(state.q[None])[0].copy(),
        end_u=compiled.relative(state.u[None], rates=True)[0].copy(),
        keep=run.kept.recording.keep,
        spans=run.kept.spans(time),
        sums=run.tally.finished(),
        end_state=_end_state(run),
        failure=failure_of(state, run.scratch, run.pairs) if stop == Stop.LCP_FAILED else None,
    )


def _all_kept(run: Run) -> tuple[Sequence[NDArray[np.float64]], NDArray[Any]]:
    """t, q, u, a and the events."""
    nothing = columns_of(np.zeros((0, 1 + 3 * len(run.state.q))))
    return run.kept.closed(float(run.state.clock.time)) or (nothing, np.zeros(0, EVENT_DTYPE))


def _end_state(run: Run) -> SavedState | None:
    """The state to go on from, with how many of the rows and events that were kept belong to it."""
    if run.saved is None:
        return None
    time = float(run.state.clock.time)
    rows, events = run.kept.counts(time, run.parts_before)
    recorded = {**run.saved.recorded, "stays": run.kept.for_good(time, run.parts_before)}
    return dataclasses.replace(run.saved, rows=rows, events=events, recorded=recorded)


def _words(run: Run, stop: Stop) -> str:
    """The cause and what is known of where and why; where a driven body jams another, that is the cause."""
    if stop == Stop.LCP_FAILED:
        driven = {body.name for body in run.scene.bodies if body.prescribed is not None}
        failure = failure_of(run.state, run.scratch, run.pairs) if driven else None
        return driven_into(failure, run.pairs, driven) or stop.sentence
    words = _details(run, stop)
    return f"{stop.sentence}: {words}" if words else stop.sentence


def _details(run: Run, stop: Stop) -> str:
    if stop == Stop.OVERLAP:
        return run.watch.words()
    if stop == Stop.LEDGER:
        return unaccounted(run.energy())
    if stop == Stop.UNEXPLAINED:
        return unexplained(run.state, run.pairs)
    if stop == Stop.TOO_MANY_EVENTS:
        bodies = [run.scene.bodies[coordinate.body].name for coordinate in run.compiled.model.coordinates]
        return what_alternates(run.scratch.ended, run.pairs, bodies)
    if stop == Stop.FAR_AWAY:
        return furthest(run.state, run.compiled.model, [body.name for body in run.scene.bodies])
    return ""
