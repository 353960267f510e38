"""How do the coordinates of geared bodies follow from those of others, and how heavy are these then?

Bodies geared to each other without play share one coordinate, that of the body the others are geared to. Every angle (or
travel) is linear in it, so that the mass matrix stays diagonal and constant: J_A + r² J_B (docs/theory/method.md 2.1).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

from watchsim.geometry.primitives import Point
from watchsim.scene.scene import Body, Scene

# Which body carries which, and where do their frames and angles hang?
#
# A body's place, angle and velocity are given relative to its carrier. The model knows one level of carriers: the origin of a
# carried body is a point fixed in one moving body, its host. What is exact in that form and keeps the mass matrix constant and
# diagonal (docs/theory/method.md 2.1) is resolved here, the rest is refused by name.

MOVEMENT, NOWHERE = -1, -2  # in the place of a host's number
ON_PIVOT = 1e-9  # of the radius of gyration: a centre of mass nearer to the pivot lies on it, but for rounding
POISED = 1e-6  # of a body's reach: a centre of mass nearer to the pivot than that lies on it
Complain = Callable[[str, str], None]  # takes the name of a body and what is wrong with how it is carried


@dataclass(frozen=True, slots=True)
class Ride:
    """How one body hangs in the model. Bodies are numbered as in the scene; MOVEMENT stands for the movement itself.

    part_of     the body of the model that its outlines belong to: itself, or what it is rigidly joined to
    host        the moving body in which its frame's origin is a fixed point
    place       that point in the host's frame (m)
    turns_with  the moving body against whose angle its own is given
    angle       added to that (rad): its own angle is this one plus q of `turns_with` plus the angle in the scene
    start, spin the angle and the turning rate that it has at the start in the movement (rad, rad/s)
    """

    part_of: int
    host: int = MOVEMENT
    place: Point = (0.0, 0.0)
    turns_with: int = MOVEMENT
    angle: float = 0.0
    start: float = 0.0
    spin: float = 0.0


@dataclass(frozen=True, slots=True)
class Weighed:
    """Mass (kg), its first moment (kg·m) and its inertia (kg·m²) about the origin of a body's frame."""

    mass: float = 0.0
    moment: Point = (0.0, 0.0)
    inertia: float = 0.0

    def plus(self, other: Weighed) -> Weighed:
        moment = (self.moment[0] + other.moment[0], self.moment[1] + other.moment[1])
        return Weighed(self.mass + other.mass, moment, self.inertia + other.inertia)


def rides(bodies: tuple[Body, ...], complain: Complain | None = None) -> tuple[Ride, ...]:
    """How each of these bodies hangs. What cannot be simulated exactly goes to `complain`, without one it is a ValueError."""
    names = {body.name: i for i, body in enumerate(bodies)}
    found: dict[int, Ride] = {}
    for i in carriers_first(bodies, complain or _refuse):
        found[i] = _ride(bodies, i, names.get(str(bodies[i].on), MOVEMENT), found, complain or _refuse)
    return tuple(found.get(i, Ride(i)) for i in range(len(bodies)))


def _refuse(name: str, message: str) -> None:
    raise ValueError(f"{name}: {message}")


def in_silence(_name: str, _message: str) -> None:
    """For whom what cannot be carried is complained of elsewhere."""


def carriers_first(bodies: tuple[Body, ...], complain: Complain) -> list[int]:
    """The numbers of the bodies, each after its carrier; one that carries itself, however indirectly, is left out."""
    names = {body.name: i for i, body in enumerate(bodies)}
    order: list[int] = []
    left = list(range(len(bodies)))
    while left:
        ready = [i for i in left if bodies[i].on not in names or names[str(bodies[i].on)] in order]
        if not ready:
            for i in left:
                complain(bodies[i].name, "it would carry itself, by way of the bodies that carry it")
            break
        order += ready
        left = [i for i in left if i not in ready]
    return order


def carried_last(bodies: tuple[Body, ...]) -> list[Body]:
    """The bodies, each after its carrier."""
    return [bodies[i] for i in carriers_first(bodies, _refuse)]


def _ride(bodies: tuple[Body, ...], i: int, c: int, found: dict[int, Ride], complain: Complain) -> Ride:
    """The ride of body i on body c (-1: none)."""
    body = bodies[i]
    alone = Ride(i, place=body.position, start=body.angle, spin=_spin(body))
    if c not in found:
        return alone
    if body.motion not in ("pivot", "fixed"):
        complain(body.name, f'motion = "{body.motion}" on a carrier is not simulated. A carried body is pivoted or fixed there')
        return alone
    below = found[c]
    base = below.part_of
    inside = body.position if base == c else _moved(body.position, below.place, below.angle)
    turns_with, angle = _reference(bodies[base], base, below)
    start, spin = below.start + body.angle, below.spin + _spin(body)
    if body.motion == "fixed" and bodies[base].motion != "fixed":
        # Rigid with what carries it: its outlines become outlines of that body, in its frame.
        turned = body.angle if base == c else below.angle + body.angle
        return Ride(base, base, inside, turns_with, turned, start, spin)
    host, place = _point(bodies[base], base, found[base], inside)
    if host == NOWHERE:
        complain(body.name, _chain(body.name, bodies[base], bodies[found[base].host].name))
        return alone
    return Ride(i, host, place, turns_with, angle, start, spin)


def _spin(body: Body) -> float:
    return {"pivot": body.velocity[-1], "free": body.velocity[-1]}.get(body.motion, 0.0) if body.velocity else 0.0


def _chain(name: str, carrier: Body, host: str) -> str:
    return (
        f"{carrier.name} is itself carried by {host} and turns on it: a body carried in two steps has a mass matrix that "
        f'changes with the angles, which is not simulated. Pivot {name} at the centre of {carrier.name} (position = ["0 mm", '
        f'"0 mm"]), carry it by {host}, or make {carrier.name} fixed there'
    )


def _point(base: Body, number: int, ride: Ride, point: Point) -> tuple[int, Point]:
    """(host, place) of a point of a body of the model; host NOWHERE where it moves with more than one body."""
    if base.motion == "fixed":
        return MOVEMENT, _moved(point, ride.place, ride.start)
    if base.motion == "pivot" and point == (0.0, 0.0):
        return ride.host, ride.place
    return (number, point) if ride.host < 0 else (NOWHERE, point)


def _reference(base: Body, number: int, below: Ride) -> tuple[int, float]:
    """The moving body with which a carrier that is part of `base` turns, and the angle from that one's to its own."""
    if base.motion in ("fixed", "slide"):
        return MOVEMENT, below.start
    return number, (0.0 if below.part_of == number and below.host != number else below.angle)


def _moved(point: Point, origin: Point, angle: float) -> Point:
    c, s = math.cos(angle), math.sin(angle)
    return origin[0] + c * point[0] - s * point[1], origin[1] + s * point[0] + c * point[1]


def weigh(bodies: tuple[Body, ...], hung: tuple[Ride, ...], complain: Complain | None = None) -> tuple[Weighed, ...]:
    """What each body of the model weighs with all that it carries, about the origin of its own frame.

    Rigid parts count whole, pivoted bodies as a mass at their pivot; those must be poised there.
    """
    complain = complain or _refuse
    found = [Weighed() for _ in bodies]
    for body, ride in zip(bodies, hung, strict=True):
        found[ride.part_of] = found[ride.part_of].plus(_own(body, ride))
    for i, (body, ride) in enumerate(zip(bodies, hung, strict=True)):
        if ride.host < 0 or ride.part_of != i:
            continue
        if not _is_poised(bodies, hung, i, found[i]):
            complain(body.name, _not_poised(body, found[i]))
        (x, y), mass = ride.place, found[i].mass
        found[ride.host] = found[ride.host].plus(Weighed(mass, (mass * x, mass * y), mass * (x * x + y * y)))
    carrying = {ride.host for ride in hung} | {ride.part_of for k, ride in enumerate(hung) if ride.part_of != k}
    for i, body in enumerate(bodies):
        if body.motion == "free" and i in carrying and not _is_poised(bodies, hung, i, found[i]):
            place = ", ".join(f"{1e3 * part / found[i].mass:.4g}" for part in found[i].moment)
            complain(
                body.name,
                f"with what it carries, its centre of mass moves to ({place}) mm of its frame, and a free body must have it at "
                "the origin. Place what it carries so that it balances",
            )
    return tuple(found)


def _own(body: Body, ride: Ride) -> Weighed:
    """A body without its loads, in the frame of the body it is part of."""
    (cx, cy), mass = body.centre_of_mass, body.mass
    if body.motion in ("free", "slide"):
        return Weighed(mass, (0.0, 0.0), body.inertia)
    own = Weighed(mass, (mass * cx, mass * cy), body.inertia)
    if body.motion == "pivot" or ride.host < 0:
        return own
    x, y = _moved(body.centre_of_mass, ride.place, ride.angle)
    about_centre = body.inertia - mass * (cx * cx + cy * cy)
    return Weighed(mass, (mass * x, mass * y), about_centre + mass * (x * x + y * y))


def _is_poised(bodies: tuple[Body, ...], hung: tuple[Ride, ...], i: int, weighed: Weighed) -> bool:
    parts = [body for body, ride in zip(bodies, hung, strict=True) if ride.part_of == i]
    reach = max((math.hypot(*edge.point(0.5)) for body in parts for loop in body.loops for edge in loop.edges), default=0.0)
    reach = max(reach, *(math.hypot(*ride.place) for ride in hung if i in (ride.part_of, ride.host)))
    # What could not be read is not a number, and no reason for a second complaint.
    return not math.hypot(*weighed.moment) > POISED * weighed.mass * reach


def _not_poised(body: Body, weighed: Weighed) -> str:
    off = 1e6 * math.hypot(*weighed.moment) / weighed.mass
    return (
        f"its centre of mass lies {off:.4g} µm beside its pivot. A carried body must be poised: its pull would change the mass "
        "matrix with its angle, which is not simulated. Balance it with another entry of solids, or write mass and "
        "inertia instead: then it counts as poised"
    )


def is_still(scene: Scene, body: Body) -> bool:
    """Can the body never move? True for a fixed one that nothing, or only what is fixed, carries."""
    while body.motion == "fixed" and body.on is not None:
        body = scene.body(body.on)
    return body.motion == "fixed"


def start_poses(scene: Scene) -> dict[str, tuple[float, float, float]]:
    """x, y (m) and angle (rad) of every body's frame in the movement at the start."""
    found: dict[str, tuple[float, float, float]] = {}
    for i in carriers_first(scene.bodies, _refuse):
        body = scene.bodies[i]
        if body.on is None:
            found[body.name] = (*body.position, body.angle)
            continue
        x, y, angle = found.get(body.on, (0.0, 0.0, 0.0))
        found[body.name] = (*_moved(body.position, (x, y), angle), angle + body.angle)
    return found


def at_start(scene: Scene) -> Scene:
    """The scene with all positions and angles given in the movement and nothing carried, to draw or measure the start."""
    if all(body.on is None for body in scene.bodies):
        return scene
    poses = start_poses(scene)
    bodies = tuple(replace(body, position=poses[body.name][:2], angle=poses[body.name][2], on=None) for body in scene.bodies)
    return replace(scene, bodies=bodies)


# How do the coordinates of geared bodies follow from those of others, and how heavy are these then?


class Bond(NamedTuple):
    """Of one body: whose coordinate q moves it, and how.

    to            the number of the body whose coordinate that is; itself where it has one of its own
    ratio, phase  its angle in the movement, or its travel, is ratio q + phase
    given, shift  as the scene gives both coordinates, the own one is `given` times that of `to`, plus `shift`
    """

    to: int
    ratio: float = 1.0
    phase: float = 0.0
    given: float = 1.0
    shift: float = 0.0


def bonds(bodies: tuple[Body, ...], hung: tuple[Ride, ...]) -> tuple[Bond, ...]:
    """The bond of each body; the phases follow from where bodies stand at the start."""
    numbers = {body.name: i for i, body in enumerate(bodies)}
    return tuple(
        Bond(i) if body.geared is None else _bond(bodies, hung, i, numbers[body.geared.to], body.geared.ratio)
        for i, body in enumerate(bodies)
    )


def _bond(bodies: tuple[Body, ...], hung: tuple[Ride, ...], i: int, to: int, given: float) -> Bond:
    ratio = given + 1.0 if hung[i].turns_with == to else given
    start, begin = (hung[k].start if bodies[k].motion == "pivot" else 0.0 for k in (i, to))
    own, other = (bodies[k].angle if bodies[k].motion == "pivot" else 0.0 for k in (i, to))
    return Bond(to, ratio, start - ratio * begin, given, own - given * other)


def felt(bodies: tuple[Body, ...], hung: tuple[Ride, ...], weighed: tuple[Weighed, ...]) -> tuple[float, ...]:
    """What each body's coordinate weighs, with all that is geared to it: kg·m² where it turns, else kg."""
    own = [load.inertia if body.motion == "pivot" else load.mass for body, load in zip(bodies, weighed, strict=True)]
    if all(body.geared is None for body in bodies):
        return tuple(own)
    bound = bonds(bodies, hung)
    whole = [0.0] * len(bodies)
    for mass, bond in zip(own, bound, strict=True):
        whole[bond.to] += bond.ratio**2 * mass
    return tuple(whole[bond.to] / bond.given**2 for bond in bound)


def ungeared(scene: Scene) -> Scene:
    """The scene with every body free of the others, as parts are that are turned by hand out of their train."""
    if not scene.gears and all(body.geared is None for body in scene.bodies):
        return scene
    return replace(scene, bodies=tuple(replace(body, geared=None) for body in scene.bodies), gears=(), rigid_gears=())


def goes_with(scene: Scene, name: str) -> dict[str, float]:
    """All bodies geared to one, with play or without, itself included: how far each goes for one unit of it."""
    ways = gear_ways(scene)
    return reached(lambda one: ways.get(one, {}), name)


def gear_ways(scene: Scene) -> dict[str, dict[str, float]]:
    """For each geared body the ones it is geared to, with play or without: how far they go for one unit of it."""
    ways: dict[str, dict[str, float]] = {}
    bound = [(body.geared.to, body.name, body.geared.ratio) for body in scene.bodies if body.geared is not None]
    for a, b, ratio in (*bound, *((*gear.between, gear.ratio) for gear in scene.gears)):
        ways.setdefault(a, {})[b] = ratio
        ways.setdefault(b, {})[a] = 1.0 / ratio
    return ways


def reached(ways: Callable[[str], Mapping[str, float]], name: str) -> dict[str, float]:
    """All that `ways` join to a body, directly or not; `ways`: how far its neighbours go for one unit of a body."""
    found, left = {name: 1.0}, [name]
    while left:
        here = left.pop(0)
        for other, ratio in ways(here).items():
            if other not in found:
                found[other] = found[here] * ratio
                left.append(other)
    return found


def note_gears(bodies: tuple[Body, ...], hung: tuple[Ride, ...], pulled: frozenset[str], complain: Complain) -> None:
    """What cannot be simulated exactly goes to `complain`; `pulled`: the bodies that gravity turns."""
    numbers = {body.name: i for i, body in enumerate(bodies)}
    carrying = {number for ride in hung for number in (ride.host, ride.turns_with)}
    for i, (body, ride) in enumerate(zip(bodies, hung, strict=True)):
        if body.geared is None:
            continue
        to = numbers[body.geared.to]
        if hung[to].turns_with >= 0:
            complain(body.name, f"{body.geared.to} is itself carried by a body that turns. {CARRIED}")
        elif ride.turns_with not in (-1, to):
            complain(body.name, f"what carries it is not {body.geared.to}. {CARRIED}")
        reason = _reason(bodies, i, carrying, pulled)
        if reason:
            complain(body.name, f"{reason}; {_reason(bodies, to, carrying, pulled)}. {ONE}")


CARRIED = "Gears bind bodies in the movement, or a carrier and a body that it carries, which rolls round a fixed wheel"
ONE = "Of bodies geared to each other without play only one may be driven, carry others or be turned by gravity"


def _reason(bodies: tuple[Body, ...], number: int, carrying: set[int], pulled: frozenset[str]) -> str:
    """Why a body must hold the coordinate; "" where it need not."""
    name = bodies[number].name
    if bodies[number].prescribed is not None:
        return f"{name} is driven"
    if number in carrying:
        return f"{name} carries others"
    return f"gravity turns {name}, which is not poised" if name in pulled else ""
