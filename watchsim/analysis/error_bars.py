"""How far would the numbers move in a more exact run?

The run is done again, a hundred times more exactly (by events) or with half the step (Moreau, where the error of the first
run is then twice the difference, since it goes with the step). What moves is the error of the computation. That a watch has
not settled yet is another error; of the two the larger is given.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from watchsim.simulation.methods import MOREAU
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.runner import Progress
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

TIGHTER, TIGHTEST = 0.01, 1e-13
NUMBERS = ("amplitude_deg", "period_s", "rate_s_per_d", "beat_error_ms")


def more_exact(run: Trajectory, progress: Progress | None = None, stream: Path | None = None) -> Trajectory:
    """The same motion once more, more exactly."""
    if run.method == MOREAU and run.step is not None:
        step = 0.5 * run.step
        return simulate(run.scene, run.simulated, run.tolerance, progress=progress, method=MOREAU, step=step, stream=stream)
    return simulate(run.scene, run.simulated, max(TIGHTER * run.tolerance, TIGHTEST), progress=progress, stream=stream)


def with_error_bars(numbers: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """The summary `numbers` with the differences to `other`, the summary of the more exact run, as errors.

    Each `..._error` becomes at least the difference (where beats are too few to tell their scatter, it stays None: how exactly
    they were computed, `differences` says), every end state gets an error beside it, and `error_bars` says what was
    compared; its `complete` is False where the more exact run did not come to its end, and no error is given then.
    """
    share = 2.0 if numbers["method"] == MOREAU else 1.0
    said = {name: other[name] for name in ("tolerance", "step_s", "stop", "wall_s")}
    if other["stop"] != Stop.DURATION.name:
        return {**numbers, "error_bars": {**said, "complete": False}}
    out = dict(numbers)
    moved = {}
    for name in NUMBERS:
        if numbers[name] is None or other[name] is None:
            continue
        moved[name] = share * abs(numbers[name] - other[name])
        if numbers[f"{name}_error"] is not None:
            out[f"{name}_error"] = max(moved[name], numbers[f"{name}_error"])
    out["bodies"] = {
        body: {**state, **{f"{name}_error": share * abs(value - other["bodies"][body][name]) for name, value in state.items()}}
        for body, state in numbers["bodies"].items()
    }
    out["error_bars"] = {**said, "complete": True, "differences": moved}
    return out
