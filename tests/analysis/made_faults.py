"""Which small changes make a watch that ticks fail, each in its own way?

All are made from the Swiss lever profile; `turned_over` and `renamed` change what no verdict may depend on.
"""

import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import replace

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line, Point
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Contact, Side, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene

NAMES = {"wheel": "rad", "lever": "anker", "balance": "unruh", "banking": "stifte"}
EDGES = 6  # of a tooth of the Swiss lever's wheel; the first two meet at its toe
TEETH = 15


@functools.cache
def _swiss() -> Scene:
    return load(profiles_dir() / "swiss_lever")


def swiss(**changes: str) -> Scene:
    """The profile with changes such as torques_0_value = "-1.5 µN·m"."""
    scene = _swiss()
    for key, value in changes.items():
        scene = scene.set(key.replace("_", "."), value)
    return replace(scene, expect=())


def unguarded(scene: Scene) -> Scene:
    """Without its guard pin: the dart touches nothing."""
    return replace(scene, contacts=tuple(one for one in scene.contacts if all(side.layer != "DART" for side in one.sides)))


def knocked(scene: Scene, t: float, torque: float, lasting: float = 2e-3) -> Scene:
    """A knock on the lever at time t (s)."""
    table = ((0.0, 0.0), (t, 0.0), (t + 1e-5, torque), (t + lasting, torque), (t + lasting + 1e-5, 0.0), (1e4, 0.0))
    return replace(scene, torques=(*scene.torques, Torque("lever", over="time", table=table)))


def on_teeth(scene: Scene, change: Callable[[Loop], Loop]) -> Scene:
    """Another outline of the wheel's rim; holes stay."""
    bodies = tuple(
        replace(body, loops=tuple(loop if loop.hole else change(loop) for loop in body.loops)) if body.name == "wheel" else body
        for body in scene.bodies
    )
    return replace(scene, bodies=bodies)


def chipped(scene: Scene, tooth: int, depth: float, back: float = 0.0) -> Scene:
    """The toe of one tooth worn off: towards the centre by `depth` (m), and by the share `back` of its impulse face."""

    def worn(loop: Loop) -> Loop:
        edges = list(loop.edges)
        front, top = edges[EDGES * tooth], edges[EDGES * tooth + 1]
        assert isinstance(front, Line) and isinstance(top, Line) and front.end == top.start
        (x, y), (heel_x, heel_y) = front.end, top.end
        share = 1.0 - depth / math.hypot(x, y)
        toe = (share * (x + back * (heel_x - x)), share * (y + back * (heel_y - y)))
        edges[EDGES * tooth], edges[EDGES * tooth + 1] = Line(*front.start, *toe), Line(*toe, *top.end)
        return Loop(tuple(edges), loop.layer)

    return on_teeth(scene, worn)


def toothless(scene: Scene, tooth: int) -> Scene:
    """Without one tooth."""

    def broken(loop: Loop) -> Loop:
        edges = list(loop.edges)
        first = EDGES * tooth
        # From the root before the tooth to the root behind it.
        low, high = edges[first - 1], edges[first + 3]
        edges[first : first + 3] = [Line(*low.end, *high.start)]
        return Loop(tuple(edges), loop.layer)

    return on_teeth(scene, broken)


def eccentric(scene: Scene, shift: float) -> Scene:
    """The rim off its centre by `shift` (m)."""
    return on_teeth(scene, lambda loop: loop.moved(0.0, (shift, 0.0)))


def turned_over(scene: Scene) -> Scene:
    """The same watch seen in a mirror: everything turns the other way."""

    def over(body: Body) -> Body:
        return replace(
            body,
            position=_across(body.position),
            angle=-body.angle,
            velocity=tuple(-one for one in body.velocity),
            loops=tuple(loop.reflected((0.0, 0.0), (0.0, 1.0)) for loop in body.loops),
        )

    def against(torque: Torque) -> Torque:
        return replace(torque, value=-torque.value, table=tuple((at, -value) for at, value in torque.table))

    springs = tuple(replace(spring, rest=-spring.rest) for spring in scene.springs)
    return replace(scene, bodies=tuple(map(over, scene.bodies)), springs=springs, torques=tuple(map(against, scene.torques)))


def _across(point: Point) -> Point:
    return -point[0], point[1]


def renamed(scene: Scene, names: Mapping[str, str] = NAMES) -> Scene:
    """Other words for all bodies, listed the other way round."""

    def told(contact: Contact) -> Contact:
        first, second = (Side(names[side.body], side.layer) for side in contact.sides)
        return replace(contact, sides=(second, first))

    return replace(
        scene,
        bodies=tuple(replace(body, name=names[body.name]) for body in reversed(scene.bodies)),
        springs=tuple(replace(one, body=names[one.body]) for one in scene.springs),
        torques=tuple(replace(one, body=names[one.body]) for one in scene.torques),
        damping=tuple(replace(one, body=names[one.body]) for one in scene.damping),
        contacts=tuple(map(told, scene.contacts)),
    )
