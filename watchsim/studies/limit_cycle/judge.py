"""What does a mechanism without a cycle do instead?

An ordinary run from where the search for a cycle ended, and the verdict on it. The only place that knows how a run is judged.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from watchsim.analysis.timing.averages import Averages, averages
from watchsim.analysis.timing.beats import beats
from watchsim.analysis.verdicts.verdict import verdict
from watchsim.analysis.verdicts.verdict_kinds import BACKWARDS, KNOCKS, STOPS, TICKS, TRIPS, UNSETTLED
from watchsim.dynamics.applied_forces import stored_energy
from watchsim.scene.recording import Recording
from watchsim.simulation.frozen_run import trajectory_of
from watchsim.simulation.loop_state.state import State
from watchsim.simulation.loop_state.state_arrays import write_state
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.runner import Run
from watchsim.simulation.stops import Stop
from watchsim.studies.limit_cycle.run_from_state import Loop

# What the search has met, where the run shows no more than that.
WORDS = {
    STOPS: "the swing does not unlock the wheel any more",
    TRIPS: "the wheel runs through: it passes more than one tooth in an oscillation",
    BACKWARDS: "the wheel turns against its drive",
    KNOCKS: "the oscillator swings so far that it is struck on its way out, and no regular swing balances the drive",
}
WHEN = re.compile(r"^t = \S+ s  ")  # counted from the start of a run that nobody has asked for


@dataclass(frozen=True)
class Judgement:
    """`name` is a verdict; None where nothing can be said, such as when the solver gave up."""

    name: str | None
    message: str


def run_from(loop: Loop, state: State | None, duration: float) -> Trajectory:
    """An ordinary run of so many seconds from a state with time 0; None: from the scene's start. KeyboardInterrupt ends it."""
    run = Run(loop.scene, loop.compiled, loop.tolerance, Recording())
    run.warm_up()
    if state is None:
        run.begin()
    else:
        write_state(run.state, state)
        run.stored_at_start = float(stored_energy(run.compiled.model, run.state.q, run.state.u))
    stop = run.to_the_end(duration, None)
    if stop == Stop.INTERRUPTED:
        raise KeyboardInterrupt
    loop.simulated += float(run.state.clock.time)
    return trajectory_of(run, stop, 0.0, 0.0)


def judged(run: Trajectory, suspicion: str = "", since_start: bool = False) -> Judgement:
    """What the mechanism does in that run; `suspicion` is what the search for a cycle met.

    Times are given only where the run began with the scene (`since_start`).
    """
    if run.stop.gave_up:
        return Judgement(None, run.stop_message)
    found = verdict(run)
    if found.name in (TICKS, UNSETTLED, None) and suspicion in WORDS:
        return Judgement(suspicion, WORDS[suspicion])
    message = found.message or ""
    return Judgement(found.name, message if since_start else WHEN.sub("", message))


def late_means(run: Trajectory) -> Averages:
    """Means over the last third of a run, with their scatter."""
    found = beats(run)
    return averages(found, (2.0 * run.simulated / 3.0, run.simulated))
