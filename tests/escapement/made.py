"""Scenes of escapements in which every dimension was chosen, and copies that stand and turn otherwise."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import draw_swiss_lever
from draw_swiss_design import Swiss

from watchsim.geometry.primitives import Point
from watchsim.mechanism.body import Body
from watchsim.mechanism.force import Side
from watchsim.mechanism.load import load
from watchsim.mechanism.scene import Scene
from watchsim.profiles_path import profiles_dir

CLEAR = 0.3  # degrees of the wheel, before the locking


def swiss_scene(folder: Path, design: Swiss) -> Scene:
    """The profile's scene with drawings of that design; lever on the entry bank, a tooth just before the entry stone."""
    draw_swiss_lever.draw(folder, design)
    text = (profiles_dir() / "swiss_lever" / "scene.toml").read_text(encoding="utf-8")
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    toe = design.locked_toe(1) + CLEAR
    scene = load(folder / "scene.toml")
    for key, value in {
        "bodies.lever.position": ["0 mm", f"{design.lever_pivot[1]!r} mm"],
        "bodies.balance.position": ["0 mm", f"{design.balance_pivot[1]!r} mm"],
        "bodies.lever.angle": f"{design.bank - 1e-3!r}°",
        "bodies.wheel.angle": f"{toe!r}°",
    }.items():
        scene = scene.set(key, value)
    return scene


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
