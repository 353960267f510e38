"""How do the coordinates of geared bodies follow from those of others, and how heavy are these then?

Bodies geared to each other without play share one coordinate, that of the body the others are geared to. Every angle (or
travel) is linear in it, so that the mass matrix stays diagonal and constant: J_A + r² J_B (docs/theory/method.md 2.1).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from watchsim.scene.body import Body
from watchsim.scene.carriers import Complain, Ride, Weighed
from watchsim.scene.scene import Scene


class Bond(NamedTuple):
    """Of one body: whose coordinate q moves it, and how.

    to            the number of the body whose coordinate that is; itself where it has one of its own
    ratio, phase  its angle in the movement, or its travel, is ratio q + phase
    told, shift   as the scene gives both coordinates, the own one is `told` times that of `to`, plus `shift`
    """

    to: int
    ratio: float = 1.0
    phase: float = 0.0
    told: float = 1.0
    shift: float = 0.0


def bonds(bodies: tuple[Body, ...], hung: tuple[Ride, ...]) -> tuple[Bond, ...]:
    """The bond of each body; the phases follow from where bodies stand at the start."""
    numbers = {body.name: i for i, body in enumerate(bodies)}
    return tuple(
        Bond(i) if body.geared is None else _bond(bodies, hung, i, numbers[body.geared.to], body.geared.ratio)
        for i, body in enumerate(bodies)
    )


def _bond(bodies: tuple[Body, ...], hung: tuple[Ride, ...], i: int, to: int, told: float) -> Bond:
    ratio = told + 1.0 if hung[i].turns_with == to else told
    start, begin = (hung[k].start if bodies[k].motion == "pivot" else 0.0 for k in (i, to))
    own, other = (bodies[k].angle if bodies[k].motion == "pivot" else 0.0 for k in (i, to))
    return Bond(to, ratio, start - ratio * begin, told, own - told * other)


def felt(bodies: tuple[Body, ...], hung: tuple[Ride, ...], weighed: tuple[Weighed, ...]) -> tuple[float, ...]:
    """What each body's coordinate weighs, with all that is geared to it: kg·m² where it turns, else kg."""
    own = [load.inertia if body.motion == "pivot" else load.mass for body, load in zip(bodies, weighed, strict=True)]
    if all(body.geared is None for body in bodies):
        return tuple(own)
    bound = bonds(bodies, hung)
    whole = [0.0] * len(bodies)
    for mass, bond in zip(own, bound, strict=True):
        whole[bond.to] += bond.ratio**2 * mass
    return tuple(whole[bond.to] / bond.told**2 for bond in bound)


def ungeared(scene: Scene) -> Scene:
    """The scene with every body free of the others, as parts are that are turned by hand out of their train."""
    if not scene.gears and all(body.geared is None for body in scene.bodies):
        return scene
    return replace(scene, bodies=tuple(replace(body, geared=None) for body in scene.bodies), gears=(), rigid_gears=())


def goes_with(scene: Scene, name: str) -> dict[str, float]:
    """All bodies geared to one, with play or without, itself included: how far each goes for one unit of it."""
    ways: dict[str, dict[str, float]] = {}
    bound = [(body.geared.to, body.name, body.geared.ratio) for body in scene.bodies if body.geared is not None]
    for a, b, ratio in (*bound, *((*gear.between, gear.ratio) for gear in scene.gears)):
        ways.setdefault(a, {})[b] = ratio
        ways.setdefault(b, {})[a] = 1.0 / ratio
    return reached(ways, name)


def reached(ways: Mapping[str, Mapping[str, float]], name: str) -> dict[str, float]:
    """All that `ways` join to a body, directly or not; `ways`: how far the one goes for one unit of the other."""
    found, left = {name: 1.0}, [name]
    while left:
        here = left.pop(0)
        for other, ratio in ways.get(here, {}).items():
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
