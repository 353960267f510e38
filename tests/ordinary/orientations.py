"""Does the same mechanism move the same way however it lies in the plane and however its parts are drawn?"""

import dataclasses
import math

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Point
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop

Numbers = NDArray[np.float64]


def _turn(point: Point, angle: float) -> Point:
    c, s = math.cos(angle), math.sin(angle)
    return c * point[0] - s * point[1], s * point[0] + c * point[1]


def _posed_body(body: Body, world: float, drawn: float) -> Body:
    velocity = body.velocity
    if body.motion == "free" and velocity:
        velocity = (*_turn((velocity[0], velocity[1]), world), velocity[2])
    return dataclasses.replace(
        body,
        position=_turn(body.position, world),
        angle=body.angle + world - drawn,
        axis=_turn(body.axis, world),
        velocity=velocity,
        centre_of_mass=_turn(body.centre_of_mass, drawn),
        loops=tuple(loop.moved(drawn, (0.0, 0.0)) for loop in body.loops),
    )


def posed(scene: Scene, world: float, drawn: tuple[float, ...]) -> Scene:
    """The world turned by `world` about its origin, each body's outline turned by its own angle within its frame."""
    bodies = tuple(_posed_body(body, world, angle) for body, angle in zip(scene.bodies, drawn, strict=True))
    shift = {body.name: world - angle for body, angle in zip(scene.bodies, drawn, strict=True) if body.motion == "pivot"}
    springs = tuple(dataclasses.replace(spring, rest=spring.rest + shift.get(spring.body, 0.0)) for spring in scene.springs)
    return dataclasses.replace(scene, bodies=bodies, springs=springs, gravity=_turn(scene.gravity, world))


@dataclasses.dataclass(frozen=True)
class Seen:
    """What is compared: coordinates at the end since the start and turning points since the start, over their size."""

    end: Numbers
    turns: Numbers
    impacts: int
    bad: str


def seen(scene: Scene, world: float, drawn: tuple[float, ...]) -> Seen:
    """The run of the scene so posed, seen from the scene's own frame."""
    turned = posed(scene, world, drawn)
    run = simulate(turned)
    moved = []
    for body, given in zip(scene.bodies, turned.bodies, strict=True):
        if body.motion == "fixed":
            continue
        q = np.asarray(run.end_q[run.slices[body.name]], dtype=float)
        if body.motion == "free":
            x, y = _turn((q[0], q[1]), -world)
            moved += [x - body.position[0], y - body.position[1], q[2] - given.angle]
        elif body.motion == "pivot":
            moved.append(q[0] - given.angle)
        else:
            moved.append(q[0])
    # Of bodies on springs: a pendulum that an impact stops turns back or not by rounding.
    sprung = [k for k, body in enumerate(turned.bodies) if any(spring.body == body.name for spring in turned.springs)]
    events = run.events[(run.events["kind"] == EventKind.TURN) & np.isin(run.events["body"], sprung)]
    drawn_at = np.array([body.angle if body.motion == "pivot" else 0.0 for body in turned.bodies])
    turns = events["value"] - drawn_at[events["body"]]
    bad = "" if run.stop == Stop.DURATION else run.stop.name
    if abs(run.energy["residual_relative"]) > 1e-6:
        bad += f" residual {run.energy['residual_relative']:.1e}"
    return Seen(np.array(moved), np.asarray(turns, dtype=float), run.counts["impacts"], bad)


def apart(a: Seen, b: Seen) -> float:
    """Largest difference over the size of what is compared; infinite where turning points are missing."""
    if len(a.turns) != len(b.turns):
        return math.inf
    end = float(np.abs(a.end - b.end).max() / np.abs(a.end).max())
    turns = float(np.abs(a.turns - b.turns).max() / np.abs(a.turns).max()) if len(a.turns) else 0.0
    return max(end, turns)


def random_pose(scene: Scene, rng: np.random.Generator) -> tuple[float, tuple[float, ...]]:
    """A turn of the world and one of each outline."""
    return float(rng.uniform(0.0, 2.0 * math.pi)), tuple(rng.uniform(0.0, 2.0 * math.pi, len(scene.bodies)).tolist())
