"""How are [[gears]] read: which bodies share one coordinate, and which have play between them?

Without play all bodies geared to each other, however indirectly, are bound to one of them: the one that is driven, carries
others, is turned by gravity or has a spring, else the first named.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from watchsim.geometry.primitives import Point
from watchsim.scene.body import Body
from watchsim.scene.carriers import Ride, Weighed, rides, weigh
from watchsim.scene.errors import Faults
from watchsim.scene.file.keys.key_values import NAN, Table, listed
from watchsim.scene.file.keys.schema import GEAR, nearest
from watchsim.scene.gear_trains import CARRIED, note_gears, reached
from watchsim.scene.gearing import PRESSURE_ANGLE, Gear, Geared
from watchsim.units import NUMBER, PER_LENGTH, TRAVEL_PER_TURN, Dimension

SAME = 1e-9  # of a velocity that is given twice
POISED = 1e-9  # of the radius of gyration: a centre of mass nearer to the pivot is not turned by gravity
DIMENSION: dict[tuple[str, str], Dimension] = {  # of a ratio, by the motions of the first and the second body
    ("pivot", "pivot"): NUMBER,
    ("pivot", "slide"): TRAVEL_PER_TURN,
    ("slide", "pivot"): PER_LENGTH,
    ("slide", "slide"): NUMBER,
}
MOST_PRESSURE = math.radians(45.0)
PLAY = ("restitution", "efficiency")  # what needs play


@dataclass(frozen=True, slots=True)
class ReadGears:
    """The bodies, those without play bound to each other, the gears with play, and those without."""

    bodies: tuple[Body, ...]
    gears: tuple[Gear, ...]
    rigid: tuple[Gear, ...]


def read_gears(mapping: Mapping[str, Any], bodies: tuple[Body, ...], gravity: Point, faults: Faults) -> ReadGears:
    """Faults are noted for unknown bodies, for what turns neither nor slides, and for bindings that contradict each other."""
    tables = [Table(one, f"gears.{i}", GEAR, faults) for i, one in enumerate(listed(mapping, "gears", faults))]
    if not tables:
        return ReadGears(bodies, (), ())
    known = {body.name: body for body in bodies}
    read = [(table, gear) for table in tables if (gear := _gear(table, known)) is not None]
    hung = rides(bodies, _in_silence)
    weighed = weigh(bodies, hung, _in_silence)
    pulled = _pulled(bodies, hung, weighed, gravity)
    ranks = _ranks(mapping, bodies, hung, pulled)
    rigid = [(table, gear) for table, gear in read if gear.backlash == 0.0]
    bound = _bound(rigid, known, ranks)
    _note_carried([(table, gear) for table, gear in read if gear.backlash > 0.0], list(known), hung)
    _note_double([(table, gear) for table, gear in read if gear.backlash > 0.0], bound)
    spun = _with_velocities(bodies, bound, mapping, faults)
    note_gears(spun, hung, pulled, lambda name, message: faults.add(_key(rigid, name), message))
    return ReadGears(spun, tuple(gear for _, gear in read if gear.backlash > 0.0), tuple(gear for _, gear in rigid))


def _in_silence(_name: str, _message: str) -> None:
    """What cannot be carried is complained of elsewhere."""


def _gear(table: Table, known: Mapping[str, Body]) -> Gear | None:
    names = table.names("between", (2,), 'two bodies are needed: between = ["wheel", "pinion"]')
    if not names:
        return None
    for i, name in enumerate(names):
        if name not in known:
            table.fault(f"between.{i}", f'there is no body "{name}". {nearest(name, known)}')
            return None
        if known[name].motion not in ("pivot", "slide"):
            table.fault(f"between.{i}", f'gears bind bodies that turn or slide; motion of {name} is "{known[name].motion}"')
            return None
    first, second = (known[name] for name in names)
    ratio = _ratio(table, DIMENSION[first.motion, second.motion])
    table.motion = second.motion
    backlash = table.quantity("backlash")
    if backlash < 0.0:
        table.fault("backlash", "play cannot be negative: leave it out for none", with_value=True)
    if backlash == 0.0 and (idle := [key for key in PLAY if key in table]):
        need = "needs play" if len(idle) == 1 else f"{' and '.join(idle)} need play"
        table.fault(idle[0], f'{need}: give backlash = "0.5°", how far the second body can go while the first is held')
    restitution, efficiency = table.quantity("restitution"), table.quantity("efficiency", 1.0)
    if restitution < 0.0 or restitution > 1.0:
        table.fault("restitution", "must lie between 0 (no rebound) and 1 (nothing lost)", with_value=True)
    if efficiency <= 0.0 or efficiency > 1.0:
        table.fault("efficiency", "is a share of the work: above 0, at most 1", with_value=True)
    pressure = table.quantity("pressure_angle", PRESSURE_ANGLE)
    if pressure < 0.0 or pressure >= MOST_PRESSURE:
        table.fault(
            "pressure_angle", f"must lie between 0° and {math.degrees(MOST_PRESSURE):g}°; usual is 20°", with_value=True
        )
    return Gear((first.name, second.name), ratio, backlash, restitution, efficiency, pressure)


def _ratio(table: Table, dimension: Dimension) -> float:
    """How far the second body goes for one unit of the first."""
    if "ratio" not in table:
        sign = "negative where it turns the other way, as outside gears make it"
        table.fault("", f"missing: ratio, turns (or travel) of the second body for one turn of the first, {sign}")
        return NAN
    ratio = table.parsed("ratio", table.mapping["ratio"], dimension)
    if ratio == 0.0:
        table.fault("ratio", "must not be 0: the second body would stand still", with_value=True)
        return NAN
    return ratio


def _pulled(bodies: tuple[Body, ...], hung: tuple[Ride, ...], weighed: tuple[Weighed, ...], gravity: Point) -> frozenset[str]:
    """The bodies that gravity turns; a carried one is poised."""
    if not any(gravity):
        return frozenset()
    return frozenset(
        body.name
        for body, ride, load in zip(bodies, hung, weighed, strict=True)
        if body.motion == "pivot"
        and ride.host < 0
        and math.hypot(*load.moment) > POISED * math.sqrt(abs(load.mass * load.inertia))
    )


def _ranks(
    mapping: Mapping[str, Any], bodies: tuple[Body, ...], hung: tuple[Ride, ...], pulled: frozenset[str]
) -> dict[str, tuple[bool, ...]]:
    """By name, ascending: the smallest of those geared to each other holds the coordinate."""
    carrying = {number for ride in hung for number in (ride.host, ride.turns_with)}
    springs = mapping.get("springs", ())
    entries = [one for one in springs if isinstance(one, Mapping)] if isinstance(springs, (list, tuple)) else []
    sprung = {str(one.get("body")) for one in entries}
    return {
        body.name: (
            body.prescribed is None,
            i not in carrying,
            body.name not in pulled,
            body.on is not None,
            body.name not in sprung,
        )
        for i, body in enumerate(bodies)
    }


def _bound(
    rigid: list[tuple[Table, Gear]], known: Mapping[str, Body], ranks: Mapping[str, tuple[bool, ...]]
) -> dict[str, Geared]:
    """What each geared body is geared to, through whatever is between; a second binding of the same two is a fault."""
    ways: dict[str, dict[str, float]] = {}  # ratio of the one for one unit of the other
    for table, gear in rigid:
        a, b = gear.between
        if b in reached(ways, a):
            table.fault("between", f"{a} and {b} are bound to each other already, through other gears", with_value=True)
            continue
        ways.setdefault(a, {})[b] = gear.ratio
        ways.setdefault(b, {})[a] = 1.0 / gear.ratio
    found: dict[str, Geared] = {}
    for name in sorted(ways, key=lambda one: (ranks[one], list(known).index(one))):
        if name in found or any(geared.to == name for geared in found.values()):
            continue
        found.update({other: Geared(name, ratio) for other, ratio in reached(ways, name).items() if other != name})
    return found


def _note_double(loose: list[tuple[Table, Gear]], bound: Mapping[str, Geared]) -> None:
    """Play between two bodies that are bound without any is none."""
    for table, gear in loose:
        a, b = (bound[name].to if name in bound else name for name in gear.between)
        if a == b:
            table.fault("between", f"{' and '.join(gear.between)} are bound to each other already, without play", True)


def _note_carried(loose: list[tuple[Table, Gear]], names: list[str], hung: tuple[Ride, ...]) -> None:
    """Play between angles of which one is against a third body would be a contact of three coordinates."""
    for table, gear in loose:
        numbers = [names.index(name) for name in gear.between]
        carriers = [hung[number].turns_with for number in numbers]
        if carriers == [-1, -1]:
            continue
        if carriers not in ([-1, numbers[0]], [numbers[1], -1]):
            why = f"play between these would bind three angles, theirs and that of what carries them. {CARRIED}"
            table.fault("between", why, with_value=True)
        elif gear.ratio == -1.0:
            table.fault("ratio", "with play must not be -1: the carried body would not turn in the movement", with_value=True)


def _with_velocities(
    bodies: tuple[Body, ...], bound: Mapping[str, Geared], mapping: Mapping[str, Any], faults: Faults
) -> tuple[Body, ...]:
    """The bodies with their bindings; a velocity given for one of those bound together is that of all."""
    tables = mapping.get("bodies", {})
    start: dict[str, float] = {}
    holders = {geared.to for geared in bound.values()}
    for body in bodies:
        geared = bound.get(body.name)
        holder = geared.to if geared else body.name
        if holder not in holders or "velocity" not in tables.get(body.name, {}) or not body.velocity:
            continue
        speed = body.velocity[0] / (geared.ratio if geared else 1.0)
        if math.isnan(speed):  # that has been noted
            continue
        if not math.isclose(start.setdefault(holder, speed), speed, rel_tol=SAME):
            why = f"contradicts the velocity of another body that is geared to {holder}: give one of them"
            faults.add(f"bodies.{body.name}.velocity", why)
    velocities = {name: (speed,) for name, speed in start.items()}
    velocities |= {name: (start[geared.to] * geared.ratio,) for name, geared in bound.items() if geared.to in start}
    return tuple(
        replace(body, geared=bound.get(body.name), velocity=velocities.get(body.name, body.velocity)) for body in bodies
    )


def _key(rigid: list[tuple[Table, Gear]], name: str) -> str:
    """The gears that bind a body."""
    return next((f"{table.path}.between" for table, gear in rigid if name in gear.between), "gears")
