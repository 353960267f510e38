"""How do gears with play, and stops of springs, become contacts?

The two bodies move two racks, geared to them without play, as far as their circumferences go at the pitch point. One rack is a
round tooth, the other the gap between two flanks: both gap functions are linear in the coordinates, and impacts, forces and
restitution are those of any contact. The racks touch nothing else, weigh nothing and are drawn nowhere.

Friction of the teeth takes a share of the work whichever body drives. The racks run askew for it, each at 45° to the normal, so
that the tooth slides along the flank by as much as the two bodies go together; what a body puts in is then N (1 + µ), what
comes out at the other N (1 - µ), and µ = (1 - η) / (1 + η) gives the efficiency η.

Of a body and the carriage it rides on, which rolls round a fixed wheel, the angle of the one is against the other: with
ψ = r φ the body turns by (1 + r) φ in the movement. The tooth of the fixed wheel moves nothing; its force acts on the carriage
where the body's pivot is, as N (1 + µ) R + N (1 - µ) ρ, ρ and R = r ρ being the pitch radii, N (1 - µ) ρ on the body. The
carriage's rack is askew by (r - 1) / (r + 1) for it, and the efficiency is that of the same gears with the carriage held.

The stop of a spring is such a tooth, on a rack moved by the spring's body, and one flank, of the movement or on a rack of the
other body, or of the carrier.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line, Point
from watchsim.scene.forces import Contact, Side, Spring
from watchsim.scene.scene import Body, Gear, Geared, Scene
from watchsim.scene.trains import Ride, rides

LAYER, STOP = "gear", "stop"  # of both racks, in the names of contacts
TOOTH = 0.1  # of the scene's size: radius of the tooth
FLANK = 1e7  # of the scene's size: half the length of a flank, which the tooth must never leave


def with_racks(scene: Scene, size: float) -> tuple[Scene, dict[str, str]]:
    """The scene with two racks for each of its gears with play and each stop, at the end of its bodies; rack -> whose it is."""
    stopped = [spring for spring in scene.springs if spring.stop is not None]
    if not scene.gears and not stopped:
        return scene, {}
    bodies, contacts = list(scene.bodies), list(scene.contacts)
    named: dict[str, str] = {}
    for k, spring in enumerate(stopped):
        stops = _stop(scene, spring, k, size)
        bodies += stops
        named |= {stops[0].name: spring.body, stops[1].name: spring.against or spring.body}
        contacts.append(Contact((Side(stops[0].name), Side(stops[1].name)), restitution=spring.restitution))
    riding = rides(scene.bodies)
    for k, gear in enumerate(scene.gears):
        racks = _racks(scene, gear, k, size, rack_ways(scene, riding, gear, size))
        bodies += racks
        named |= {rack.name: name for rack, name in zip(racks, gear.between, strict=True)}
        friction = (1.0 - gear.efficiency) / (1.0 + gear.efficiency)
        sides = (Side(racks[0].name), Side(racks[1].name))
        contacts.append(Contact(sides, friction, gear.restitution))
    return replace(scene, bodies=tuple(bodies), contacts=tuple(contacts)), named


class Ways(NamedTuple):
    """`far`: how far each body moves its rack, by `reach`, the pitch radius (m) of the second; `askew`: their tangents."""

    far: tuple[float, float]
    askew: tuple[float, float]
    reach: float


def rack_ways(scene: Scene, riding: tuple[Ride, ...], gear: Gear, size: float) -> Ways:
    """How gears with play move their racks, in a scene of that size (m)."""
    names = [body.name for body in scene.bodies]
    first, second = (names.index(name) for name in gear.between)
    r = gear.ratio
    if riding[first].turns_with != second and riding[second].turns_with != first:
        return Ways((r, 1.0), (1.0, -1.0), pitch_radius(scene.bodies[first], scene.bodies[second], r, size))
    against = (r - 1.0) / (r + 1.0)
    if riding[second].turns_with == first:
        return Ways((1.0 + r, 1.0), (against, -1.0), _rolling_radius(riding[second], r, size))
    return Ways((r, 1.0 + r), (1.0, against), _rolling_radius(riding[first], r, size))


def _racks(scene: Scene, gear: Gear, k: int, size: float, ways: Ways) -> tuple[Body, Body]:
    """The rack of the first body with the tooth, that of the second with the flanks."""
    tooth, play = TOOTH * size, 0.5 * gear.backlash * ways.reach
    apart, far = tooth + play, FLANK * size
    flanks = (Line(apart, far, apart, -far), Line(-apart, -far, -apart, far))
    shapes: tuple[tuple[Loop, ...], ...] = (
        (Loop((Arc(0.0, 0.0, tooth, 0.0, TURN),), LAYER),),
        tuple(Loop((flank,), LAYER, closed=False) for flank in flanks),
    )
    made = []
    for name, way, askew, loops in zip(gear.between, ways.far, ways.askew, shapes, strict=True):
        holder = scene.body(name).geared or Geared(name, 1.0)
        slope = askew if gear.efficiency < 1.0 else 0.0
        long = math.hypot(1.0, slope)
        axis: Point = (1.0 / long, slope / long)
        geared = Geared(holder.to, holder.ratio * way * ways.reach * long)
        made.append(Body(f"{name} gear {k}", "slide", axis=axis, loops=loops, geared=geared))
    return made[0], made[1]


def _stop(scene: Scene, spring: Spring, number: int, size: float) -> tuple[Body, Body]:
    """The rack of the spring's body with the tooth; the flank that stops it, of the movement or on a rack of the other body."""
    assert spring.stop is not None
    body, other = scene.body(spring.body), scene.body(spring.against) if spring.against else None
    turns = body.motion == "pivot"
    reach, tooth = size if turns else 1.0, TOOTH * size
    start = (body.angle - (other.angle if other else 0.0)) if turns else 0.0
    if body.on is not None:  # its angle is given against its carrier, and so is the stop
        carrier = rides(scene.bodies)[scene.bodies.index(body)].turns_with
        other = scene.bodies[carrier] if carrier >= 0 else None
    side = math.copysign(1.0, spring.stop - spring.rest)  # on which the body is free
    wall, far = -side * (tooth + abs(start - spring.stop) * reach), side * FLANK * size
    flank = (Loop((Line(wall, -far, wall, far),), STOP, closed=False),)
    name = f"{body.name} stop {number}"
    moved = _rack(name, body, reach, (Loop((Arc(0.0, 0.0, tooth, 0.0, TURN),), STOP),))
    at = f"{name} of {other.name}" if other else f"{name} of the movement"
    return moved, _rack(at, other, reach, flank) if other else Body(at, "fixed", loops=flank)


def _rack(name: str, body: Body, reach: float, loops: tuple[Loop, ...]) -> Body:
    """Slides along x as far as the body's circumference at `reach` goes."""
    holder = body.geared or Geared(body.name, 1.0)
    return Body(name, "slide", axis=(1.0, 0.0), loops=loops, geared=Geared(holder.to, holder.ratio * reach))


def _rolling_radius(carried: Ride, ratio: float, size: float) -> float:
    """Pitch radius of the second of a carriage and what it carries, m; the scene's size where both are on one axis."""
    return math.hypot(*carried.place) / abs(1.0 + ratio) or size


def pitch_radius(first: Body, second: Body, ratio: float, size: float) -> float:
    """Of the second body, m: where both run alike on the line of centres; the scene's size where there is no such place.

    1 where the second slides, whose coordinate is a length.
    """
    if second.motion == "slide":
        return 1.0
    distance = math.dist(first.position, second.position)
    if first.motion == "slide" or distance == 0.0 or ratio == 1.0:
        return size
    return distance / abs(1.0 - ratio)
