"""How does a scene run in Box2D?

Sequential impulses in single precision at fixed steps, with a skin of two length units per thousand built in: the
length unit decides. A contact takes the larger restitution of both shapes and the geometric mean of their friction.
"""

from __future__ import annotations

from typing import Any

from watchsim.bench.engines import HEAVY, Circle, Drive, Setup, bodies, drives, surfaces
from watchsim.scene.scene import Scene


class Box2DWorld:
    """The world, its bodies by name, and the torques to apply in every step."""

    def __init__(self, world: Any, parts: dict[str, Any], acting: list[Drive], step: float, setup: Setup, mass: float) -> None:
        self.world, self.parts, self.step, self.setup = world, parts, step, setup
        self.iterations = setup.iterations
        scale = mass * setup.units**2
        self.acting = [(parts[d.body], d.torque * scale, d.stiffness * scale, d.rest, d.viscous * scale) for d in acting]

    def advance(self, steps: int) -> None:
        step, (velocity, position), advance = self.step, self.iterations, self.world.Step
        constant = [(body.ApplyTorque, torque) for body, torque, k, _, c in self.acting if k == c == 0.0]
        sprung = [(body, body.ApplyTorque, *rest) for body, *rest in self.acting if rest[1] or rest[3]]
        for _ in range(steps):
            for push, torque in constant:
                push(torque, True)
            for body, push, torque, k, rest, c in sprung:
                push(torque - k * (body.angle - rest) - c * body.angularVelocity, True)
            advance(step, velocity, position)

    def place(self, body: str) -> tuple[float, float, float]:
        part = self.parts[body]
        return part.position[0] / self.setup.units, part.position[1] / self.setup.units, part.angle


def build(scene: Scene, step: float, setup: Setup) -> Box2DWorld:
    """The scene with lengths in 1/`setup.units` metres and masses so that the lightest body's inertia is 1."""
    import Box2D

    units = setup.units
    lightest = min(body.inertia for body in bodies(scene) if body.motion != "fixed")
    mass = 1.0 / (lightest * units**2)
    world = Box2D.b2World(gravity=(scene.gravity[0] * units, scene.gravity[1] * units), doSleep=False)
    parts = {}
    for body in bodies(scene):
        position = (body.position[0] * units, body.position[1] * units)
        make = world.CreateStaticBody if body.motion == "fixed" else world.CreateDynamicBody
        part = make(position=position, angle=body.angle, allowSleep=False)
        # Else only what stands still is met at its own instant: a tooth's corner would sink into a stone by a whole step.
        part.bullet = body.motion != "fixed"
        parts[body.name] = part
        if body.motion == "pivot":
            part.angularVelocity = body.velocity[0] if body.velocity else 0.0
            if any(scene.gravity):
                raise ValueError("gravity on a pivoted body: not compared with Box2D")
    for surface in surfaces(scene, setup.deviation):
        if isinstance(surface.piece, Circle):
            (x, y), radius = surface.piece.centre, surface.piece.radius
            shape: Any = Box2D.b2CircleShape(pos=(x * units, y * units), radius=radius * units)
        else:
            shape = Box2D.b2PolygonShape(vertices=[(x * units, y * units) for x, y in surface.piece])
        parts[surface.body].CreateFixture(
            shape=shape,
            density=0.0,
            friction=surface.friction,
            restitution=surface.restitution,
            categoryBits=surface.own,
            maskBits=surface.meets,
        )
    for body in bodies(scene):
        if body.motion != "fixed":
            heavy = HEAVY if body.motion == "pivot" else body.mass
            parts[body.name].massData = Box2D.b2MassData(mass=heavy * mass, center=(0.0, 0.0), I=body.inertia * mass * units**2)
    return Box2DWorld(world, parts, drives(scene), step, setup, mass)
