"""Which two bodies meet every kind of contact? One outline with lines, a convex arc, a concave arc and corners, twice.

The outlines are a metre across, so that all numbers are of order one.
"""

import functools
import math
from collections.abc import Callable

import numpy as np

from watchsim.contact.gaps import closed_contacts, contact_kinematics, place, poses
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import ARC, CORNER, LINE
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene

MOTIONS = ("pivot", "slide", "free", "fixed")
DEGREES = {"pivot": 1, "slide": 1, "free": 3, "fixed": 0}
PLACES = {"a": (0.3, -0.2), "b": (-0.1, 0.4)}
KINDS = (
    *("corner-line", "line-corner", "corner-arc", "arc-corner", "corner-bite", "bite-corner", "arc-line", "line-arc"),
    "arc-arc",
)

_place, _kinematics = callable_kernel(place), callable_kernel(contact_kinematics)


def outline(scale: float = 1.0, shift: Point = (0.0, 0.0)) -> Loop:
    """A block with a round nose (convex arc) on the right and a bite (concave arc, two corners) in its top."""
    s, (x, y) = scale, shift
    left, bottom, top, bite = -0.45 * s + x, -0.25 * s + y, 0.25 * s + y, 0.12 * s
    nose = math.asin(0.25 / 0.3)
    centre = 0.25 * s + x - 0.3 * s * math.cos(nose)
    edges: tuple[Edge, ...] = (
        Line(left, bottom, 0.25 * s + x, bottom),
        Arc(centre, y, 0.3 * s, -nose, 2.0 * nose),
        Line(0.25 * s + x, top, -0.1 * s + bite + x, top),
        Arc(-0.1 * s + x, top, bite, 0.0, -math.pi),
        Line(-0.1 * s - bite + x, top, left, top),
        Line(left, top, left, bottom),
    )
    return Loop(edges)


@functools.cache
def two_bodies(motion_a: str, motion_b: str, scale_b: float = 0.35) -> tuple[Scene, Compiled]:
    """Bodies a and b with their origins beside the outlines; b is the smaller one, so that it fits into a's bite."""
    bodies = []
    for name, motion, scale, shift in (("a", motion_a, 1.0, (0.2, 0.1)), ("b", motion_b, scale_b, (0.1, -0.15))):
        axis = (math.cos(0.7), math.sin(0.7)) if name == "a" else (math.cos(2.0), math.sin(2.0))
        angle = 0.0 if motion != "slide" else 0.6
        bodies.append(Body(name, motion, PLACES[name], angle, axis=axis, mass=1.3, inertia=0.7, loops=(outline(scale, shift),)))
    scene = Scene("two bodies", tuple(bodies), contacts=(Contact((Side("a"), Side("b")), 0.2, 0.5),))
    return scene, compile_scene(scene)


def kind_of(compiled: Compiled, k: int) -> str:
    """The word for contact k: what body a brings, then what body b brings."""
    words = {}
    contact = compiled.model.contacts[k]
    for number in (contact.a, contact.b):
        p = compiled.model.primitives[number]
        word = {CORNER: "corner", LINE: "line", ARC: "arc"}[int(p.kind)]
        words[int(p.body)] = "bite" if p.kind == ARC and p.side < 0.0 else word
    return f"{words[0]}-{words[1]}"


@functools.cache
def contacts_of_kind(motion_a: str, motion_b: str, kind: str) -> tuple[int, ...]:
    """All contacts of one kind."""
    compiled = two_bodies(motion_a, motion_b)[1]
    return tuple(k for k in range(len(compiled.model.contacts)) if kind_of(compiled, k) == kind)


def pose_at(compiled: Compiled, q: np.ndarray, u: np.ndarray) -> np.recarray:
    """Poses of both bodies."""
    pose = poses(2)
    _place(compiled.model, q, u, pose)
    return pose


class Kin:
    """What the kernel says about contact k at (q, u), with w_N and w_T as full vectors."""

    def __init__(self, compiled: Compiled, k: int, q: np.ndarray, u: np.ndarray) -> None:
        closed = closed_contacts(2)
        _kinematics(compiled.model, k, pose_at(compiled, q, u), 1, closed)
        kin = closed.kin[1]
        self.g, self.gN_dot, self.gT_dot = float(kin.g), float(kin.gN_dot), float(kin.gT_dot)
        self.bar_N, self.bar_T, self.margin = float(kin.bar_N), float(kin.bar_T), float(kin.margin)
        self.point = np.array([kin.x, kin.y])
        self.w_N, self.w_T = np.zeros(len(q)), np.zeros(len(q))
        for j in range(closed.slots[1]):
            self.w_N[closed.coord[1, j]] += closed.w_N[1, j]
            self.w_T[closed.coord[1, j]] += closed.w_T[1, j]


def body_pose(scene: Scene, name: str, q: np.ndarray) -> tuple[float, float, float]:
    """x, y, angle of a body from the coordinates of the scene, with none of the package's kernels."""
    first = 0
    for body in scene.bodies:
        if body.name == name:
            break
        first += DEGREES[body.motion]
    x, y = body.position
    if body.motion == "pivot":
        return x, y, q[first]
    if body.motion == "slide":
        return x + q[first] * body.axis[0], y + q[first] * body.axis[1], body.angle
    if body.motion == "free":
        return q[first], q[first + 1], q[first + 2]
    return x, y, body.angle


# Which pairs of bodies hang on carriers, and where are they by the rules of the scene file?

CARRIERS = ("pivot", "slide", "free")
# Who the pivoted body "a" on the carriage meets: "b" beside it on the carriage, the carriage itself, a part fixed on it, bodies
# in the movement, one on a carriage of its own.
PARTNERS = ("beside", "carrier", "part", "fixed", "pivot", "slide", "free", "other")
ARRANGEMENTS = [(carrier, partner, False) for carrier in CARRIERS for partner in PARTNERS] + [
    ("pivot", "beside", True),
    ("pivot", "fixed", True),
    ("slide", "part", True),
]

Shape = Callable[[str], tuple[Loop, ...]]
AXIS = (math.cos(0.7), math.sin(0.7))


def carried_scene(carrier: str, partner: str, deep: bool, shape: Shape, at: tuple[float, float]) -> tuple[Scene, Compiled]:
    """Body a pivoted at `at` on a carriage that pivots, slides or is free, and what it meets.

    `deep`: a sits on a hub in between, coaxial with the carriage or fixed on it.
    """

    def moving(name: str, motion: str, place: tuple[float, float], outlined: bool, on: str | None = None) -> Body:
        angle = 0.6 if motion in ("slide", "fixed") else 0.0
        loops = shape(name) if outlined else ()
        return Body(name, motion, place, angle, axis=AXIS, mass=0.0 if on else 1.0, inertia=1.0, loops=loops, on=on)

    met = {"beside": "b", "carrier": "carriage", "part": "b"}.get(partner, "b")
    bodies = [moving("carriage", carrier, (0.3, -0.2), met == "carriage")]
    below = "carriage"
    if deep:
        hub = "pivot" if carrier == "pivot" else "fixed"
        bodies.append(moving("hub", hub, (0.0, 0.0) if hub == "pivot" else (0.05, 0.1), False, "carriage"))
        below = "hub"
    # The carried body stands before its carrier, as a scene file may have it.
    bodies.insert(0, moving("a", "pivot", at, True, below))
    if partner in ("beside", "part"):
        bodies.append(moving("b", "pivot" if partner == "beside" else "fixed", (-0.2, 0.15), True, "carriage"))
    elif partner == "other":
        bodies += [moving("second", "pivot", (0.1, 0.5), False), moving("b", "pivot", (0.3, -0.1), True, "second")]
    elif partner != "carrier":
        bodies.append(moving("b", partner, (-0.1, 0.4), True))
    scene = Scene("carried", tuple(bodies), contacts=(Contact((Side("a"), Side(met)), 0.2, 0.5),))
    return scene, compile_scene(scene)


def places(scene: Scene, compiled: Compiled, q: np.ndarray) -> dict[str, tuple[float, float, float]]:
    """x, y, angle of every body in the movement, from coordinates told as in a scene file, by the words of its manual."""
    told = compiled.relative(q[None])[0]
    by_name = {body.name: body for body in scene.bodies}

    @functools.cache
    def place(name: str) -> tuple[float, float, float]:
        body, (x, y), turn = by_name[name], by_name[name].position, by_name[name].angle
        own = told[compiled.slices[name]] if name in compiled.slices else ()
        if body.motion == "pivot":
            turn = own[0]
        elif body.motion == "slide":
            x, y = x + own[0] * body.axis[0], y + own[0] * body.axis[1]
        elif body.motion == "free":
            x, y, turn = own
        if body.on is None:
            return x, y, turn
        cx, cy, angle = place(body.on)
        return cx + math.cos(angle) * x - math.sin(angle) * y, cy + math.sin(angle) * x + math.cos(angle) * y, angle + turn

    return {name: place(name) for name in by_name}
