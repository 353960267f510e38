"""How small can a mechanism be made that still fails in the same way?

Greedy: bodies, forces, gravity, corners, the end of the run are dropped and numbers rounded, one after another, as long as the
judge still finds a reason of the same class.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

from hunt.judge import Verdict, judged
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.mechanism.overlap import overlaps
from watchsim.scene.body import Body
from watchsim.scene.scene import Scene

BUDGET = 40.0  # s
SHORTEST = 1e-2  # of the duration: below that runs are so short that anything is large against them


def shrunk(scene: Scene, verdict: Verdict, seed: int) -> Scene:
    """The smallest found within the budget; the scene itself where nothing may go."""
    classes = {reason.split(":")[0] for reason in verdict.reasons}
    witness = classes == {"witness"}

    def fails(other: Scene) -> bool:
        try:
            if overlaps(other):
                return False
            found = judged(other, seed, witness)
        except Exception:  # what cannot be compiled is no mechanism
            return False
        return bool(classes & {reason.split(":")[0] for reason in found.reasons})

    end, shortest = time.perf_counter() + BUDGET, SHORTEST * scene.duration
    smaller = True
    while smaller and time.perf_counter() < end:
        smaller = False
        for candidate in _smaller(scene):
            if time.perf_counter() > end:
                break
            if candidate.duration >= shortest and fails(candidate):
                scene, smaller = candidate, True
                break
    return scene


def _smaller(scene: Scene) -> Iterator[Scene]:
    for share in (0.5, 0.75, 0.9):
        yield replace(scene, duration=float(f"{share * scene.duration:.3g}"))
    for body in scene.bodies if len(scene.bodies) > 2 else ():
        yield _without(scene, body.name)
    for name in ("springs", "damping", "torques"):
        entries = getattr(scene, name)
        for k in range(len(entries)):
            yield replace(scene, **{name: entries[:k] + entries[k + 1 :]})
    if any(scene.gravity):
        yield replace(scene, gravity=(0.0, 0.0))
    for k, contact in enumerate(scene.contacts):
        for changed in (replace(contact, friction=0.0), replace(contact, restitution=0.0)):
            if changed != contact:
                yield replace(scene, contacts=(*scene.contacts[:k], changed, *scene.contacts[k + 1 :]))
    for k, body in enumerate(scene.bodies):
        for other in _plainer(body):
            yield replace(scene, bodies=(*scene.bodies[:k], other, *scene.bodies[k + 1 :]))


def _without(scene: Scene, name: str) -> Scene:
    def keep(entries: tuple[Any, ...]) -> tuple[Any, ...]:
        return tuple(entry for entry in entries if entry.body != name)

    return replace(
        scene,
        bodies=tuple(body for body in scene.bodies if body.name != name),
        springs=keep(scene.springs),
        torques=keep(scene.torques),
        damping=keep(scene.damping),
        contacts=tuple(c for c in scene.contacts if name not in (c.sides[0].body, c.sides[1].body)),
    )


def _plainer(body: Body) -> Iterator[Body]:
    if any(body.velocity):
        yield replace(body, velocity=(0.0,) * len(body.velocity))
    (loop,) = body.loops
    if len(loop.edges) > 3 and all(isinstance(edge, Line) for edge in loop.edges):
        points = [edge.start for edge in loop.edges]
        for k in range(len(points)):
            yield replace(body, loops=(_polygon([*points[:k], *points[k + 1 :]]),))
    rounded: list[Callable[[], Body]] = [
        lambda: replace(body, velocity=tuple(_round(v) for v in body.velocity)),
        lambda: replace(body, angle=_round(body.angle)),
        lambda: replace(body, mass=_round(body.mass), inertia=_round(body.inertia)),
    ]
    for make in rounded:
        if (other := make()) != body:
            yield other


def _polygon(points: list[tuple[float, float]]) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, [*points[1:], points[0]], strict=True)), "polygon")


def _round(value: float) -> float:
    return float(f"{value:.2g}")
