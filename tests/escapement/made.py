"""Scenes of escapements in which every dimension was chosen, and copies that stand and turn otherwise."""

from __future__ import annotations

import math
from dataclasses import replace

from watchsim.construction import registry as known
from watchsim.construction.swiss_lever import swiss
from watchsim.construction.swiss_lever_outlines import Swiss
from watchsim.designs import Maker
from watchsim.geometry.primitives import Point
from watchsim.scene.forces import Side
from watchsim.scene.scene import Body, Scene


def swiss_scene(**dimensions: object) -> tuple[Scene, Swiss]:
    """A Swiss lever of chosen dimensions, and the points it was constructed by (millimetres, degrees)."""
    drawn = Maker(known.design("swiss_lever"))(**dimensions)
    return drawn.scene(), swiss(drawn.values)


def turned_scene(scene: Scene, angle: float, shift: Point = (0.0, 0.0)) -> Scene:
    """The whole movement turned by `angle` (rad) about the origin and shifted (m)."""
    c, s = math.cos(angle), math.sin(angle)

    def image(x: float, y: float) -> Point:
        return c * x - s * y + shift[0], s * x + c * y + shift[1]

    bodies = tuple(
        replace(
            body,
            position=image(*body.position),
            angle=body.angle + angle,
        )
        for body in scene.bodies
    )  # fmt: skip
    springs = tuple(replace(spring, rest=spring.rest + angle) for spring in scene.springs)
    return replace(scene, bodies=bodies, springs=springs)


def mirrored_scene(scene: Scene) -> Scene:
    """The movement seen from the other side: everything that turned one way turns the other."""

    def image(body: Body) -> Body:
        x, y = body.position
        loops = tuple(loop.reflected((0.0, 0.0), (0.0, 1.0)) for loop in body.loops)
        return replace(body, position=(-x, y), angle=-body.angle, loops=loops)

    torques = tuple(replace(torque, value=-torque.value) for torque in scene.torques)
    springs = tuple(replace(spring, rest=-spring.rest) for spring in scene.springs)
    return replace(scene, bodies=tuple(image(body) for body in scene.bodies), torques=torques, springs=springs)


def renamed_scene(scene: Scene, names: dict[str, str], layers: dict[str, str]) -> Scene:
    """The same with other names of bodies and layers, bodies and contacts in the reverse order."""

    def side(one: Side) -> Side:
        return Side(names[one.body], None if one.layer is None else layers.get(one.layer, one.layer))

    bodies = tuple(
        replace(
            body,
            name=names[body.name],
            loops=tuple(replace(loop, layer=layers.get(loop.layer, loop.layer)) for loop in body.loops),
        )
        for body in reversed(scene.bodies)
    )
    contacts = tuple(
        replace(contact, sides=(side(contact.sides[1]), side(contact.sides[0]))) for contact in reversed(scene.contacts)
    )
    return replace(
        scene,
        bodies=bodies,
        contacts=contacts,
        springs=tuple(replace(one, body=names[one.body]) for one in scene.springs),
        torques=tuple(replace(one, body=names[one.body]) for one in scene.torques),
        damping=tuple(replace(one, body=names[one.body]) for one in scene.damping),
    )
