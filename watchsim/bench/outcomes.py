"""What does an engine make of a scenario, and how long does it take?

Processor times of the stepping alone: setting up a scene, compiling and computing cells are left out for all.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from watchsim.analysis.timing.averages import mean_over
from watchsim.analysis.timing.beats import DAY
from watchsim.bench.engines.world import build
from watchsim.bench.sampled_swings import swing
from watchsim.bench.scenarios import Scenario
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.recording import Recording
from watchsim.simulation.frozen_run import trajectory_of
from watchsim.simulation.methods import EVENT_DRIVEN, MOREAU
from watchsim.simulation.moreau.time_stepping import MoreauRun
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.runner import Run
from watchsim.simulation.stops import Stop

SAMPLE = 2e-4  # s between looks at other engines; a swing of 4 Hz has 1250
ENOUGH = 0.9  # of the half swings: fewer, and the watch did not run


@dataclass(frozen=True, slots=True)
class Outcome:
    """amplitude in degrees, rate in s/d, x in m of the body that is free; None where there is no such thing."""

    amplitude: float | None = None
    rate: float | None = None
    x: float | None = None
    note: str = ""


def outcome(scenario: Scenario, method: str, setting: float) -> Outcome:
    """What comes out; `note` says what went wrong."""
    if method in (EVENT_DRIVEN, MOREAU):
        return _own(scenario, method, setting)
    return _other(scenario, method, setting)


def cpu_seconds(scenario: Scenario, method: str, setting: float, duration: float) -> float:
    """Processor time to step through the first `duration` seconds."""
    if method in (EVENT_DRIVEN, MOREAU):
        return _own_run(scenario, method, setting, duration)[1]
    world = build(method, scenario.scene, setting, scenario.setups[method])
    steps = round(duration / setting)
    begun = time.process_time()
    world.advance(steps)
    return time.process_time() - begun


def _own_run(scenario: Scenario, method: str, setting: float, duration: float) -> tuple[Trajectory, float]:
    scene, keep = scenario.scene, Recording(keep="statistics")
    compiled = compile_scene(scene)
    run = Run(scene, compiled, setting, keep) if method == EVENT_DRIVEN else MoreauRun(scene, compiled, 1e-9, keep, setting)
    run.warm_up()
    begun = time.process_time()
    stop = run.to_the_end(duration, None)
    taken = time.process_time() - begun
    if stop == Stop.INTERRUPTED:
        raise KeyboardInterrupt  # half a run is no result
    return trajectory_of(run, stop, taken, 0.0), taken


def _own(scenario: Scenario, method: str, setting: float) -> Outcome:
    run, _ = _own_run(scenario, method, setting, scenario.duration)
    if run.stop != Stop.DURATION:
        return Outcome(note=run.stop.sentence)
    if scenario.window is None:
        return Outcome(x=float(run.end_q[0]))
    means = mean_over(run, scenario.window)
    return Outcome(means.amplitude_deg, means.rate_s_per_d, note=_verdict(means.beats, scenario))


def _verdict(beats: int, scenario: Scenario) -> str:
    assert scenario.window is not None
    length = scenario.window[1] - scenario.window[0]
    wanted = 2.0 * length / _period(scenario)
    return "" if beats >= ENOUGH * wanted else "does not run"


def _period(scenario: Scenario) -> float:
    scene = scenario.scene
    spring = scene.springs[0]
    return float(2.0 * np.pi * np.sqrt(scene.body(spring.body).inertia / spring.stiffness))


def _other(scenario: Scenario, method: str, setting: float) -> Outcome:
    scene = scenario.scene
    world = build(method, scene, setting, scenario.setups[method])
    if scenario.window is None:
        free = next(body.name for body in scene.bodies if body.motion == "free")
        world.advance(round(scenario.duration / setting))
        return Outcome(x=world.place(free)[0])
    spring = scene.springs[0]
    stride = max(1, round(SAMPLE / setting))
    count = round(scenario.duration / (stride * setting))
    angles = np.empty(count)
    for i in range(count):
        world.advance(stride)
        angles[i] = world.place(spring.body)[2] - spring.rest
    times = stride * setting * np.arange(1.0, count + 1.0, dtype=np.float64)
    amplitude, period, beats = swing(times, angles, scenario.window)
    note = _verdict(beats, scenario)
    if note or amplitude is None or period is None:
        return Outcome(note=note or "does not run")
    return Outcome(float(np.degrees(amplitude)), DAY * (_period(scenario) / period - 1.0), note=note)
