"""How long does a whole run take by the clock, from the drawing to the last step, the first time and again?

The compiled code is loaded before. The first run of a geometry reads the drawings and learns the cells that it meets (other
engines make their polygons); the second one finds both known.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from watchsim.bench.engines.world import build
from watchsim.bench.scenarios import Scenario
from watchsim.candidates.pair_cache import forget
from watchsim.scene.file.load import load
from watchsim.scene.file.outlines.body_outlines import cached_drawing
from watchsim.simulation.methods import EVENT_DRIVEN, MOREAU
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop


@dataclass(frozen=True, slots=True)
class Whole:
    """s by the clock: getting ready and stepping of the first run of a geometry, and of the one after it."""

    scene: str
    method: str
    setting: float
    simulated: float
    first_ready: float
    first_stepping: float
    again_ready: float
    again_stepping: float


def whole(scenario: Scenario, method: str, setting: float) -> Whole:
    """Both runs, one after the other; KeyboardInterrupt where one is interrupted."""
    if scenario.scene.path is None:
        raise ValueError(f"{scenario.name} has no scene file to be read")
    _once(scenario, scenario.scene.path, method, setting, 0.01)  # compiled code and libraries are loaded
    forget()
    cached_drawing.cache_clear()
    times = [_once(scenario, scenario.scene.path, method, setting, scenario.duration) for _ in range(2)]
    return Whole(scenario.name, method, setting, scenario.duration, *times[0], *times[1])


def _once(scenario: Scenario, path: Path, method: str, setting: float, duration: float) -> tuple[float, float]:
    """Getting ready and stepping, s."""
    begun = time.perf_counter()
    scene = load(path)
    if method in (EVENT_DRIVEN, MOREAU):
        ready = time.perf_counter()
        options = {"tolerance": setting} if method == EVENT_DRIVEN else {"step": setting}
        run = simulate(scene, duration, record="statistics", method=method, **options)  # type: ignore[arg-type]
        if run.stop == Stop.INTERRUPTED:
            raise KeyboardInterrupt
        ended = time.perf_counter()
        return ready - begun + run.compile, ended - ready - run.compile
    world = build(method, scene, setting, scenario.setups[method])
    ready = time.perf_counter()
    world.advance(round(duration / setting))
    return ready - begun, time.perf_counter() - ready
