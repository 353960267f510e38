"""How does the time of a simulation grow with what is asked of it: simulated time, bodies, arcs of the outlines?

Declared pairs have a study of their own (docs/reports/complexity.md). The motion stays the same in every row of a study.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc
from watchsim.mechanism.compile import compile_scene
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.scene import Recording, Scene
from watchsim.simulation.state import Stop
from watchsim.simulation.systems import run_of

DISTANCE = 0.03  # m between levers side by side
APART = 0.013  # rad between the start angles of their balances, so that they do not tick at one instant
STRONGER = 0.01  # share by which each torque exceeds the one before, for the same reason
DURATIONS = (2.5, 5.0, 10.0, 20.0, 40.0)  # s
LEVERS = (1, 2, 5, 10, 20, 50)
ARCS = (2, 8, 32, 128, 512)  # in every full circle


@dataclass(frozen=True, slots=True)
class Study:
    """Processor times (s) at sizes, and the exponent p of time ~ size^p, fitted over the upper part.

    `stopped` says why larger sizes are missing.
    """

    what: str
    sizes: tuple[float, ...]
    seconds: tuple[float, ...]
    stopped: str = ""

    @property
    def exponent(self) -> float | None:
        """Slope of the straight line through the last three points, both axes logarithmic; None with fewer."""
        if len(self.sizes) < 3:
            return None
        return float(np.polyfit(np.log(self.sizes[-3:]), np.log(self.seconds[-3:]), 1)[0])


def studies() -> list[Study]:
    """All of them, on the bench lever."""
    scene = load(profiles_dir() / "bench_lever" / "scene.toml")
    return [
        _study("simulated time, s", [(duration, scene, duration) for duration in DURATIONS]),
        _study("levers side by side", [(count, side_by_side(scene, count), 0.5) for count in LEVERS]),
        _study("arcs in each circle", [(count, with_arcs(scene, count), 2.0) for count in ARCS]),
    ]


def _study(what: str, cases: list[tuple[float, Scene, float]]) -> Study:
    sizes: list[float] = []
    seconds: list[float] = []
    for size, scene, duration in cases:
        taken, stop = _cpu_seconds(scene, duration)
        if stop != Stop.DURATION:
            return Study(what, tuple(sizes), tuple(seconds), f"{size:g}: {stop.sentence}")
        sizes.append(float(size))
        seconds.append(taken)
    return Study(what, tuple(sizes), tuple(seconds))


def _cpu_seconds(scene: Scene, duration: float) -> tuple[float, Stop]:
    """Of the stepping alone, with all cells known; the better of two."""
    best = math.inf
    for attempt in range(3):
        run = run_of(scene, compile_scene(scene), scene.tolerance, Recording(keep="statistics"))
        run.warm_up()
        run.begin()
        begun = time.process_time()
        stop = run.to_the_end(duration, None)
        if stop != Stop.DURATION:
            return math.inf, stop
        if attempt:
            best = min(best, time.process_time() - begun)
    return best, stop


def side_by_side(scene: Scene, count: int) -> Scene:
    """The scene `count` times over, in one; the copies do not touch each other and do not tick at one instant."""
    copies = [_moved(scene, k) for k in range(count)]
    parts = ("bodies", "springs", "torques", "damping", "contacts")
    together: dict[str, Any] = {name: tuple(one for copy in copies for one in getattr(copy, name)) for name in parts}
    return replace(scene, **together, expect=())


def _moved(scene: Scene, k: int) -> Scene:
    """The k-th copy: with names, places, start and torques of its own."""

    def named(one: Any, **changed: Any) -> Any:
        return replace(one, body=f"{one.body} {k}", **changed)

    bodies = []
    for body in scene.bodies:
        (x, y), swings = body.position, body.name == scene.springs[0].body
        angle = body.angle + APART * k if swings else body.angle
        bodies.append(replace(body, name=f"{body.name} {k}", position=(x + k * DISTANCE, y), angle=angle))
    return replace(
        scene,
        bodies=tuple(bodies),
        springs=tuple(map(named, scene.springs)),
        torques=tuple(named(one, value=one.value * (1.0 + STRONGER * k)) for one in scene.torques),
        damping=tuple(map(named, scene.damping)),
        contacts=tuple(replace(one, sides=tuple(map(named, one.sides))) for one in scene.contacts),
    )


def with_arcs(scene: Scene, count: int) -> Scene:
    """Every full circle cut into `count` arcs."""
    return replace(
        scene, bodies=tuple(replace(body, loops=tuple(_cut(loop, count) for loop in body.loops)) for body in scene.bodies)
    )


def _cut(loop: Loop, count: int) -> Loop:
    first = loop.edges[0]
    if not (isinstance(first, Arc) and loop.closed and abs(sum(getattr(e, "sweep", 0.0) for e in loop.edges)) > 6.28):
        return loop
    if any(not isinstance(edge, Arc) or edge.radius != first.radius for edge in loop.edges):
        return loop
    sweep = math.copysign(math.tau / count, first.sweep)
    arcs = tuple(Arc(first.x, first.y, first.radius, first.start_angle + i * sweep, sweep) for i in range(count))
    return replace(loop, edges=arcs)
