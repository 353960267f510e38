"""Scenes of escapements in which every dimension was chosen, and copies that stand and turn otherwise."""

import math
from dataclasses import replace
from pathlib import Path

from watchsim.construction import registry as known
from watchsim.construction.swiss_lever import swiss
from watchsim.construction.swiss_lever_outlines import Swiss
from watchsim.designs import Maker
from watchsim.geometry.primitives import Point
from watchsim.scene.forces import Side
from watchsim.scene.load import load
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


TIP = 15.0  # mm
ANCHOR = [
    *((-9.545677457, -9.511799926), (-9.330314371, -7.466982013), (-1.8, -1.8), (1.8, -1.8), (9.230227526, -6.525376066)),
    *((10.504584614, -10.465144552), (11.108802344, -10.568032352), (12.430227526, -4.325376066), (2.2, 2.2), (-2.2, 2.2)),
    *((-13.853712463, -8.557271466), (-13.553712463, -10.557271466)),
]


def one_faced_anchor(folder: Path) -> tuple[Scene, list[Point], list[Point]]:
    """A clock whose anchor has one flat face on each pallet, for recoil and impulse, written into a folder, and the corners of
    wheel and anchor, mm. Drawn for a lift of 3°, let-offs at ±1.5°, and a drop of 1.5° of the wheel, which turns clockwise."""
    tooth = ((11.6, 98.5), (11.6, 106.0 + 1.0 / 3.0), (TIP, 103.0 + 1.0 / 3.0), (TIP, 103.0 + 5.0 / 6.0))
    polar = [(radius, math.radians(angle + 360.0 * k / 27.0)) for k in range(27) for radius, angle in tooth]
    teeth = [(radius * math.cos(angle), radius * math.sin(angle)) for radius, angle in polar]

    def written(corners: list[Point]) -> str:
        return ", ".join(f'["{x!r} mm", "{y!r} mm"]' for x, y in corners)

    text = f"""[scene]
schema = 1
gravity = ["0 m/s²", "-9.81 m/s²"]

[bodies.wheel]
polygon = [{written(teeth)}]
motion = "pivot"
position = ["0 mm", "0 mm"]
inertia = "300 g·mm²"
angle = "-4°"

[bodies.pendulum]
polygon = [{written(ANCHOR)}]
motion = "pivot"
position = ["0 mm", "20.62213808 mm"]
mass = "0.3 kg"
inertia = "0.0186 kg·m²"
centre_of_mass = ["0 mm", "-248 mm"]
angle = "3°"

[[torques]]
body = "wheel"
value = "-0.35 mN·m"

[[damping]]
body = "pendulum"
q_factor = 150

[[contacts]]
between = ["wheel", "pendulum"]
friction = 0.1

[run]
duration = "20 s"
"""
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    return load(folder), teeth, ANCHOR
