"""How do gears with play, and stops of springs, become contacts?

The two bodies move two racks, geared to them without play, as far as their circumferences go at the pitch point. One rack is a
round tooth, the other the gap between two flanks: both gap functions are linear in the coordinates, and impacts, forces and
restitution are those of any contact. The racks touch nothing else, weigh nothing and are drawn nowhere.

Friction of the teeth takes a share of the work whichever body drives. The racks run askew for it, each at 45° to the normal, so
that the tooth slides along the flank by as much as the two bodies go together; what a body puts in is then N (1 + µ), what
comes out at the other N (1 - µ), and µ = (1 - η) / (1 + η) gives the efficiency η.

The stop of a spring is such a tooth, on a rack moved by the spring's body, and one flank, of the movement or on a rack of the
other body.
"""

from __future__ import annotations

import math
from dataclasses import replace

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Arc, Line, Point
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side, Spring
from watchsim.scene.gearing import Gear, Geared
from watchsim.scene.scene import Scene

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
    for k, gear in enumerate(scene.gears):
        racks = _racks(scene, gear, k, size)
        bodies += racks
        named |= {rack.name: name for rack, name in zip(racks, gear.between, strict=True)}
        friction = (1.0 - gear.efficiency) / (1.0 + gear.efficiency)
        sides = (Side(racks[0].name), Side(racks[1].name))
        contacts.append(Contact(sides, friction, gear.restitution))
    return replace(scene, bodies=tuple(bodies), contacts=tuple(contacts)), named


def _racks(scene: Scene, gear: Gear, number: int, size: float) -> tuple[Body, Body]:
    """The rack of the first body with the tooth, that of the second with the flanks."""
    first, second = (scene.body(name) for name in gear.between)
    reach = pitch_radius(first, second, gear.ratio, size)
    askew = 1.0 if gear.efficiency < 1.0 else 0.0
    tooth, play = TOOTH * size, 0.5 * gear.backlash * reach
    apart, far = tooth + play, FLANK * size
    flanks = (Line(apart, far, apart, -far), Line(-apart, -far, -apart, far))
    ends: tuple[tuple[Body, float, float, tuple[Loop, ...]], ...] = (
        (first, gear.ratio * reach, askew, (Loop((Arc(0.0, 0.0, tooth, 0.0, TURN),), LAYER),)),
        (second, reach, -askew, tuple(Loop((flank,), LAYER, closed=False) for flank in flanks)),
    )
    made = []
    for body, arm, slope, loops in ends:
        holder = body.geared or Geared(body.name, 1.0)
        long = math.hypot(1.0, slope)
        axis: Point = (1.0 / long, slope / long)
        geared = Geared(holder.to, holder.ratio * arm * long)
        made.append(Body(f"{body.name} gear {number}", "slide", axis=axis, loops=loops, geared=geared))
    return made[0], made[1]


def _stop(scene: Scene, spring: Spring, number: int, size: float) -> tuple[Body, Body]:
    """The rack of the spring's body with the tooth; the flank that stops it, of the movement or on a rack of the other body."""
    assert spring.stop is not None
    body, other = scene.body(spring.body), scene.body(spring.against) if spring.against else None
    turns = body.motion == "pivot"
    reach, tooth = size if turns else 1.0, TOOTH * size
    start = (body.angle - (other.angle if other else 0.0)) if turns else 0.0
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
