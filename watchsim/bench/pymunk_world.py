"""How does a scene run in pymunk (the Chipmunk engine)?

Sequential impulses in double precision at fixed steps. Friction and elasticity of a contact are the products of both
shapes' values, so one side carries the value and the other 1.
"""

from __future__ import annotations

from typing import Any

from watchsim.bench.engines import HEAVY, Circle, Drive, Setup, bodies, drives, surfaces
from watchsim.scene.scene import Scene


class PymunkWorld:
    """The space, its bodies by name, and the forces that pymunk forgets after every step."""

    def __init__(self, space: Any, parts: dict[str, Any], acting: list[Drive], step: float, units: float) -> None:
        self.space, self.parts, self.step, self.units = space, parts, step, units
        self.acting = [
            (parts[d.body], d.torque * units**2, d.stiffness * units**2, d.rest, d.viscous * units**2) for d in acting
        ]

    def advance(self, steps: int) -> None:
        space, step = self.space, self.step
        constant = [(body, torque) for body, torque, k, _, c in self.acting if k == c == 0.0]
        sprung = [entry for entry in self.acting if entry[2] or entry[4]]
        for _ in range(steps):
            for body, torque in constant:
                body.torque = torque
            for body, torque, k, rest, c in sprung:
                # A step moves the bodies first and lets forces act then: with the spring's torque of before, that would be
                # Euler's explicit method, which feeds the oscillation (at 20 µs 1 % of its energy in a second).
                w = body.angular_velocity
                body.torque = torque - k * (body.angle + step * w - rest) - c * w
            space.step(step)

    def place(self, body: str) -> tuple[float, float, float]:
        part = self.parts[body]
        return part.position.x / self.units, part.position.y / self.units, part.angle


def build(scene: Scene, step: float, setup: Setup) -> PymunkWorld:
    """The scene with lengths in 1/`setup.units` metres, masses in kilograms."""
    import pymunk

    units = setup.units
    space = pymunk.Space()
    space.gravity = (scene.gravity[0] * units, scene.gravity[1] * units)
    space.iterations = setup.iterations[0]
    space.collision_slop = setup.slop * units
    parts = {}
    for body in bodies(scene):
        if body.motion == "fixed":
            part = pymunk.Body(body_type=pymunk.Body.STATIC)
        else:
            part = pymunk.Body(body.mass if body.motion == "free" else HEAVY, body.inertia * units**2)
        part.position, part.angle = (body.position[0] * units, body.position[1] * units), body.angle
        parts[body.name] = part
        space.add(part)
        if body.motion == "pivot":
            part.angular_velocity = body.velocity[0] if body.velocity else 0.0
            if any(scene.gravity):
                raise ValueError("gravity on a pivoted body: not compared with pymunk")
    for surface in surfaces(scene, setup.deviation):
        if isinstance(surface.piece, Circle):
            (x, y), radius = surface.piece.centre, surface.piece.radius
            shape: Any = pymunk.Circle(parts[surface.body], radius * units, (x * units, y * units))
        else:
            shape = pymunk.Poly(parts[surface.body], [(x * units, y * units) for x, y in surface.piece])
        first = surface.own & 0x55555555 != 0  # the side of its contact that carries the values
        shape.friction, shape.elasticity = (surface.friction, surface.restitution) if first else (1.0, 1.0)
        shape.filter = pymunk.ShapeFilter(categories=surface.own, mask=surface.meets)
        space.add(shape)
    return PymunkWorld(space, parts, drives(scene), step, units)
