"""How does a pivot with play become a shaft in a hole?

The body is free, about its centre of mass, since only there is its mass matrix diagonal. A circle that it carries lies in a
circular hole of the movement, half of the play wider: a contact like any other, with the friction of the bearing. To the rest
of the program it stays a pivoted body, whose column is its angle; where it stands in its hole is in the two columns before.

Which primitives could touch hardly depends on where in its hole a shaft lies. That is asked of bodies on pivots in the middle,
with as much more clearance.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Point
from watchsim.model import PIVOT, Records
from watchsim.scene.forces import Bearing, Contact, LineSpring, Side
from watchsim.scene.scene import Body, Scene

SHAFT, HOLE = "pivot", "hole"  # layers, in the names of contacts


def loose(scene: Scene) -> dict[str, Bearing]:
    """The bearings with play, by body."""
    return {one.body: one for one in scene.bearings if one.play > 0.0}


def with_holes(scene: Scene) -> tuple[Scene, dict[str, str]]:
    """The scene with free bodies in the place of those with play, their shafts and holes at its end; shaft or hole -> whose."""
    bearings = loose(scene)
    if not bearings:
        return scene, {}
    bodies = [_freed(body, bearings[body.name]) if body.name in bearings else body for body in scene.bodies]
    contacts, named = list(scene.contacts), dict[str, str]()
    for name, bearing in bearings.items():
        (cx, cy), radius = scene.body(name).centre_of_mass, bearing.radius
        shaft = Loop((Arc(0.0, 0.0, radius, 0.0, TURN),), SHAFT)
        hole = Loop((Arc(0.0, 0.0, radius + 0.5 * bearing.play, 0.0, -TURN),), HOLE)
        bodies.append(Body(f"{name} pivot", "fixed", position=(-cx, -cy), on=name, loops=(shaft,)))
        bodies.append(Body(f"{name} hole", "fixed", position=scene.body(name).position, loops=(hole,)))
        contacts.append(Contact((Side(f"{name} pivot"), Side(f"{name} hole")), bearing.friction))
        named |= {f"{name} pivot": name, f"{name} hole": name}
    lines = tuple(_from_centre(scene, line, bearings) for line in scene.line_springs)
    return replace(scene, bodies=tuple(bodies), contacts=tuple(contacts), line_springs=lines), named


def _freed(body: Body, bearing: Bearing) -> Body:
    """The same body, free about its centre of mass."""
    (x, y), (cx, cy), off = body.position, body.centre_of_mass, 0.5 * bearing.play
    if bearing.side is not None:
        x, y = x + off * math.cos(bearing.side), y + off * math.sin(bearing.side)
    c, s = math.cos(body.angle), math.sin(body.angle)
    arm, spin = (c * cx - s * cy, s * cx + c * cy), body.velocity[0] if body.velocity else 0.0
    return replace(
        body,
        motion="free",
        position=(x + arm[0], y + arm[1]),
        velocity=(-spin * arm[1], spin * arm[0], spin),
        inertia=body.inertia - body.mass * (cx * cx + cy * cy),
        centre_of_mass=(0.0, 0.0),
        loops=tuple(loop.moved(0.0, (-cx, -cy)) for loop in body.loops),
    )


def _from_centre(scene: Scene, line: LineSpring, bearings: Mapping[str, Bearing]) -> LineSpring:
    """Its points in the frames of the free bodies."""

    def moved(name: str | None, point: Point) -> Point:
        cx, cy = scene.body(name).centre_of_mass if name is not None and name in bearings else (0.0, 0.0)
        return point[0] - cx, point[1] - cy

    first, second = (moved(name, point) for name, point in zip(line.between, line.points, strict=True))
    return replace(line, points=(first, second))


def in_the_middle(scene: Scene, bodies: Records, primitives: Records) -> tuple[Records, Records]:
    """Bodies and primitives with those that have play on pivots in the middle of their holes; `scene` as it was declared."""
    bearings = loose(scene)
    if not bearings:
        return bodies, primitives
    bodies, primitives = bodies.copy(), primitives.copy()
    for number, body in enumerate(scene.bodies):
        if body.name in bearings:
            row = bodies[number]
            row.motion, row.first = PIVOT, row.first + 2
            row.x, row.y = body.position
            mine = primitives.body == number
            for x, y in (("x", "y"), ("px", "py")):
                primitives[x][mine] += body.centre_of_mass[0]
                primitives[y][mine] += body.centre_of_mass[1]
    return bodies, primitives


def widen(scene: Scene, pairs: Records) -> None:
    """More clearance for the pairs of bodies with play, by twice what they may be off the middle: symmetry takes half of it."""
    bearings = loose(scene)
    off = np.array([0.5 * bearings[body.name].play if body.name in bearings else 0.0 for body in scene.bodies])
    off = np.append(off, np.zeros(2 * len(bearings)))
    if bearings:
        pairs.clearance += 2.0 * (off[pairs.a] + off[pairs.b])
