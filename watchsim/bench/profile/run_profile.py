"""Where does the time of a run go, and how far is it from the least that its kernels take?

The floor is what would be left if nothing were done but the counted work: each count times the cost of one piece of it,
measured by itself in the middle of the run (kernel_costs.py). No work is counted twice. What is above the floor is the rest:
what goes on in between, and what the same work takes more when it is not done many times in a row.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from watchsim.bench.profile.kernel_costs import COUNTED_AS, kernel_costs
from watchsim.bench.profile.sampled_moments import Walk
from watchsim.candidates.pair_cache import forget
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation.frozen_run import trajectory_of
from watchsim.simulation.loop_state.buffers import Until
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.runner import Run
from watchsim.simulation.stops import Stop

WORDS = {
    "step": "steps of coupled bodies",
    "evaluation": "accelerations of coupled bodies",
    "flight": "flights in closed form",
    "gap_evaluation": "gaps",
    "cell_lookup": "cells looked up",
    "instant": "instants of events",
    "impact": "impacts",
    "lcp_to_1": "problems of 1 unknown",
    "lcp_to_2": "problems of 2 unknowns",
    "lcp_to_4": "problems of 3 and 4 unknowns",
    "lcp_to_8": "problems of 5 to 8 unknowns",
    "lcp_to_16": "problems of 9 to 16 unknowns",
    "lcp_larger": "problems of more unknowns",
    "call": "calls of the loop, tallies",
}
NUMERICS = ("evaluation", "gap_evaluation", *(name for name in WORDS if name.startswith("lcp_")))
LONGEST = 10.0  # s simulated once more
TIMES, ENOUGH = 5, 1.0  # runs, of which the quickest counts; s after which no other one is begun


class _Timed(Run):
    """A run that knows how often the compiled loop was called, and for how long."""

    calls = 0
    looping: float = 0.0  # s of processor time
    learning: float = 0.0

    def _advance(self, until: Until, record: Any) -> Stop:
        begun = time.process_time()
        stop = super()._advance(until, record)
        self.looping += time.process_time() - begun
        self.calls += 1
        return stop

    def _learn(self) -> None:
        begun = time.process_time()
        super()._learn()
        self.learning += time.process_time() - begun


def profile_of(run: Trajectory) -> dict[str, Any]:
    """The first ten seconds of a run by events done again, with no cell known and with all cells known, and its kernels.

    `simulated_s`; `stepping_s` of processor time with all cells known, without set-up; `counts`; `work`: kind of work ->
    {count, seconds_each, seconds, share}; `floor_s`, the sum of these seconds; `rest`: {seconds, share} above it; `over_floor`,
    the stepping over the floor; `over_numerics`, over accelerations, gaps and problems alone; `learning`: as one of `work`, for
    the cells asked about where nothing is known before, its share that of the stepping there.
    ValueError for a run with fixed steps.
    """
    if run.method != EVENT_DRIVEN:
        raise ValueError(f"only runs of the method {EVENT_DRIVEN} have a profile, not those of {run.method}")
    duration = min(run.simulated, LONGEST)
    learning = _learning(run.scene, run.tolerance, duration)
    again, stop, stepping = _quickest(run.scene, run.tolerance, duration)
    counts = trajectory_of(again, stop, stepping, 0.0).counts | {"calls": again.calls}
    walk = Walk(run.scene, run.tolerance, duration)
    costs = kernel_costs(walk) | {"call": walk.call_seconds() + (stepping - again.looping) / again.calls}
    count = {name: counts[COUNTED_AS.get(name, name)] for name in WORDS}
    work = {name: _shared(n, costs[name] * n, stepping) for name, n in count.items() if n and name in costs}
    floor = sum(entry["seconds"] for entry in work.values())
    numerics = sum(work[name]["seconds"] for name in NUMERICS if name in work)
    return {
        "simulated_s": duration,
        "stepping_s": stepping,
        "counts": counts,
        "work": work,
        "rest": {"seconds": stepping - floor, "share": 1.0 - floor / stepping},
        "floor_s": floor,
        "over_floor": stepping / floor if floor > 0.0 else None,
        "over_numerics": stepping / numerics if numerics > 0.0 else None,
        "learning": learning,
    }


def _quickest(scene: Scene, tolerance: float, duration: float) -> tuple[_Timed, Stop, float]:
    """Of some runs, as `_stepped`."""
    runs = [_stepped(scene, tolerance, duration)]
    while len(runs) < TIMES and sum(run[2] for run in runs) < ENOUGH:
        runs.append(_stepped(scene, tolerance, duration))
    return min(runs, key=lambda run: run[2])


def _stepped(scene: Scene, tolerance: float, duration: float) -> tuple[_Timed, Stop, float]:
    """(a run done, why it ended, seconds of processor time)."""
    run = _Timed(scene, compile_scene(scene), tolerance, Recording(keep="statistics"))
    run.warm_up()
    run.calls = run.looping = 0
    begun = time.process_time()
    stop = run.to_the_end(duration, None)
    return run, stop, time.process_time() - begun


def _learning(scene: Scene, tolerance: float, duration: float) -> dict[str, float]:
    """What cells take that nobody in this process has asked about."""
    forget()
    run, _, stepping = _stepped(scene, tolerance, duration)
    return _shared(run.finder.learned, run.learning, stepping)


def _shared(count: int, seconds: float, of: float) -> dict[str, float]:
    return {"count": count, "seconds_each": seconds / count if count else 0.0, "seconds": seconds, "share": seconds / of}


def profile_text(profile: Mapping[str, Any]) -> str:
    """The same for people."""
    lines = [f"  stepping     {profile['stepping_s']:.3g} s of processor time for {profile['simulated_s']:g} s simulated"]
    for name, entry in profile["work"].items():
        each = 1e9 * entry["seconds_each"]
        lines.append(f"{'':15}{WORDS[name]:33}{entry['count']:>9} × {each:6.0f} ns = {100.0 * entry['share']:4.1f} %")
    rest = f"{'':15}{'the rest':33}{'':24}{100.0 * profile['rest']['share']:4.1f} %"
    if profile["over_floor"] is not None:
        alone = f", {profile['over_numerics']:.3g} × accelerations, gaps and problems alone" if profile["over_numerics"] else ""
        lines.append(f"{'':15}{profile['over_floor']:.3g} × the sum of these{alone}")
    lines.append(rest)
    learning = profile["learning"]
    if learning["count"]:
        each, share = 1e6 * learning["seconds_each"], 100.0 * learning["share"]
        taken = f"{learning['count']} learnt × {each:.0f} µs = {learning['seconds']:.2g} s"
        lines.append(f"  cells        {taken}, {share:.0f} % of the stepping where none is known before")
    return "\n".join(lines)
