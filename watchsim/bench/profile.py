"""Where does the time of a run go, and how far is it from the least that its kernels take?

The floor is what would be left if nothing were done but the counted work: each count times the cost of one kernel, measured by
itself. What is above it is bookkeeping, bounds, the search for roots within steps, recording.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from watchsim.bench.kernel_costs import kernel_costs
from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.recording import Recording
from watchsim.simulation.run import Run
from watchsim.simulation.trajectory import Trajectory

WORK = {
    "evaluation": ("evaluations", "accelerations of coupled bodies"),
    "flight": ("flights", "flights in closed form"),
    "gap_evaluation": ("gap_evaluations", "gaps"),
    "lcp_to_1": ("lcp_to_1", "problems of 1 unknown"),
    "lcp_to_2": ("lcp_to_2", "problems of 2 unknowns"),
    "lcp_to_4": ("lcp_to_4", "problems of 3 and 4 unknowns"),
    "lcp_to_8": ("lcp_to_8", "problems of 5 to 8 unknowns"),
    "lcp_to_16": ("lcp_to_16", "problems of 9 to 16 unknowns"),
    "lcp_larger": ("lcp_larger", "problems of more unknowns"),
}
LONGEST = 10.0  # s simulated once more


def profile_of(run: Trajectory) -> dict[str, Any]:
    """The first ten seconds of a run by events done once more, with all cells known, and its kernels by themselves.

    `simulated_s`; `stepping_s` of the processor, without getting ready; `counts`; `work`: name -> {count, seconds_each,
    seconds, share}; `floor_s`, the sum of these seconds; `over_floor`, the stepping over the floor.
    """
    duration = min(run.simulated, LONGEST)
    again = Run(run.scene, compile_scene(run.scene), run.tolerance, Recording(keep="statistics"))
    again.warm_up()
    begun = time.process_time()
    stop = again.to_the_end(duration, None)
    stepping = time.process_time() - begun
    counts = again.trajectory(stop, stepping, 0.0).counts
    work: dict[str, dict[str, float]] = {}
    for name, cost in kernel_costs(run.scene).items():
        if counts[WORK[name][0]] == 0:
            continue
        seconds = counts[WORK[name][0]] * cost
        work[name] = {"count": counts[WORK[name][0]], "seconds_each": cost, "seconds": seconds, "share": seconds / stepping}
    floor = sum(entry["seconds"] for entry in work.values())
    return {
        "simulated_s": duration,
        "stepping_s": stepping,
        "counts": counts,
        "work": work,
        "floor_s": floor,
        "over_floor": stepping / floor if floor > 0.0 else None,
    }


def profile_text(profile: Mapping[str, Any]) -> str:
    """The same for people."""
    lines = [f"  stepping     {profile['stepping_s']:.3g} s of the processor for {profile['simulated_s']:g} s simulated"]
    for name, entry in profile["work"].items():
        each, share = 1e9 * entry["seconds_each"], 100.0 * entry["share"]
        lines.append(f"               {WORK[name][1]:33}{entry['count']:>9} × {each:5.0f} ns = {share:4.1f} %")
    if profile["over_floor"] is not None:
        lines.append(f"               {profile['over_floor']:.2g} × the sum of these")
    return "\n".join(lines)
