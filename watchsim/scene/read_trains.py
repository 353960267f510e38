"""Can the bodies of a scene file be carried as it says? What cannot be simulated exactly is a fault with its reason."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from watchsim.geometry.primitives import Point
from watchsim.scene.errors import Faults
from watchsim.scene.forces import Contact, Damping, Mainspring, Torque
from watchsim.scene.keys import GEAR, TRAIN, nearest
from watchsim.scene.scene import Body, Gear, Geared
from watchsim.scene.trains import CARRIED, ON_PIVOT, Ride, Weighed, in_silence, note_gears, reached, rides, weigh
from watchsim.scene.values import NAN, Table, listed
from watchsim.units import NUMBER, PER_LENGTH, TRAVEL_PER_TURN, Dimension

# How are [[gears]] read: which bodies share one coordinate, and which have play between them?
#
# Without play all bodies geared to each other, however indirectly, are bound to one of them: the one that is driven, carries
# others, is turned by gravity or has a spring, else the first named.

SAME = 1e-9  # of a velocity that is given twice
DIMENSION: dict[tuple[str, str], Dimension] = {  # of a ratio, by the motions of the first and the second body
    ("pivot", "pivot"): NUMBER,
    ("pivot", "slide"): TRAVEL_PER_TURN,
    ("slide", "pivot"): PER_LENGTH,
    ("slide", "slide"): NUMBER,
}
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
    hung = rides(bodies, in_silence)
    weighed = weigh(bodies, hung, in_silence)
    pulled = _pulled(bodies, hung, weighed, gravity)
    ranks = _ranks(mapping, bodies, hung, pulled)
    loose = [(table, gear) for table, gear in read if gear.backlash > 0.0]
    rigid = [(table, gear) for table, gear in read if gear.backlash == 0.0]
    bound = _bound(rigid, known, ranks)
    _note_carried(loose, list(known), hung)
    _note_double(loose, bound)
    spun = _with_velocities(bodies, bound, mapping, faults)
    note_gears(spun, hung, pulled, lambda name, message: faults.add(_key(rigid, name), message))
    return ReadGears(spun, *(tuple(gear for _, gear in some) for some in (loose, rigid)))


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
    if backlash == 0.0 and (idle := [key for key in PLAY if key in table]):
        need = "needs play" if len(idle) == 1 else f"{' and '.join(idle)} need play"
        table.fault(idle[0], f'{need}: give backlash = "0.5°", how far the second body can go while the first is held')
    more = (table.quantity(key) for key in ("restitution", "efficiency", "pressure_angle"))
    return Gear((first.name, second.name), ratio, backlash, *more)


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
        and math.hypot(*load.moment) > ON_PIVOT * math.sqrt(abs(load.mass * load.inertia))
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
        if b in reached(lambda one: ways.get(one, {}), a):
            table.fault("between", f"{a} and {b} are bound to each other already, through other gears", with_value=True)
            continue
        ways.setdefault(a, {})[b] = gear.ratio
        ways.setdefault(b, {})[a] = 1.0 / gear.ratio
    found: dict[str, Geared] = {}
    for name in sorted(ways, key=lambda one: (ranks[one], list(known).index(one))):
        if name in found or any(geared.to == name for geared in found.values()):
            continue
        others = reached(lambda one: ways.get(one, {}), name)
        found |= {other: Geared(name, ratio) for other, ratio in others.items() if other != name}
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


# What does a mainspring do to a body that it drives through a train?
#
# One turn of the barrel turns the body `ratio` times. Its torque arrives divided by that, less what the train loses; the
# inertia of a wheel between them counts divided by the square of its own ratio to the body.

BARREL = "barrel"
KEYS = ("ratio", "efficiency", "run_down", "train")  # of [[torques]], with over = "barrel" only

Rows = tuple[tuple[float, float], ...]


def with_trains(mapping: Mapping[str, Any], bodies: tuple[Body, ...], faults: Faults) -> tuple[Body, ...]:
    """The bodies, with the inertia of the trains that drive them."""
    torques = mapping.get("torques", [])
    added: dict[str, float] = {}
    for i, entry in enumerate(torques if isinstance(torques, (list, tuple)) else ()):
        if isinstance(entry, Mapping) and "train" in entry:
            name = str(entry.get("body"))
            added[name] = added.get(name, 0.0) + _felt(entry["train"], f"torques.{i}", faults)
    return tuple(replace(body, inertia=body.inertia + added[body.name]) if body.name in added else body for body in bodies)


def _felt(train: object, path: str, faults: Faults | None) -> float:
    """kg·m² at the body, of all wheels listed; without `faults` they have been reported before."""
    noted = faults or Faults("")
    if not isinstance(train, (list, tuple)) or not all(isinstance(one, Mapping) for one in train):
        noted.add(f"{path}.train", 'write a list such as [{ ratio = 10, inertia = "0.5 mg·cm²" }], an entry for each wheel')
        return NAN
    return math.fsum(_felt_wheel(Table(one, f"{path}.train.{i}", TRAIN, noted)) for i, one in enumerate(train))


def _felt_wheel(table: Table) -> float:
    if table.lacks('{ ratio = 10, inertia = "0.5 mg·cm²" }, ratio as turns of the body'):
        return NAN
    return table.quantity("inertia") / table.quantity("ratio") ** 2


def mainspring_torque(table: Table, body: Body, rows: Rows) -> Torque:
    """The torque on the body, whose table in the scene has turns (rad) of the barrel and torque (N·m) at it."""
    if "ratio" not in table:
        table.fault("", "missing: ratio, turns of the body for one of the barrel, negative where the body turns clockwise")
    ratio, efficiency, run_down = table.quantity("ratio", NAN), table.quantity("efficiency"), table.quantity("run_down")
    if math.isnan(ratio) or not rows:
        return Torque(body.name)
    factor = efficiency / ratio
    angles = sorted((body.angle + (turned - run_down) * ratio, factor * torque) for turned, torque in rows)
    at_start = interpolated(rows, run_down)
    train = table.mapping.get("train")
    inertia = _felt(train, table.path, None) if train is not None else 0.0
    spring = Mainspring(ratio, efficiency, run_down, at_start, inertia)
    return Torque(body.name, factor * at_start, over="angle", table=tuple(angles), mainspring=spring)


def interpolated(rows: Rows, at: float) -> float:
    """Linear between the rows, constant beyond them."""
    before, after = rows[0], rows[-1]
    for first, second in pairwise(rows):
        if first[0] <= at <= second[0]:
            before, after = first, second
            break
    else:
        return before[1] if at < before[0] else after[1]
    return before[1] + (after[1] - before[1]) * (at - before[0]) / (after[0] - before[0])


# Can the bodies of a scene file be carried as it says? What cannot be simulated exactly is a fault with its reason.

NOTHING = "so this contact does nothing"


def note_carriers(
    bodies: tuple[Body, ...], damping: tuple[Damping, ...], contacts: tuple[Contact, ...], faults: Faults
) -> None:
    """Faults of carried bodies, of dry friction in their pivots, and of contacts between parts rigid with each other."""
    if all(body.on is None for body in bodies):
        return

    def complain(name: str, message: str) -> None:
        faults.add(f"bodies.{name}.on" if by_name[name].on else f"bodies.{name}", message)

    by_name = {body.name: body for body in bodies}
    hung = rides(bodies, complain)
    weigh(bodies, hung, complain)
    ride_of = dict(zip(by_name, hung, strict=True))
    for i, damper in enumerate(damping):
        if damper.coulomb and damper.body and ride_of[damper.body].turns_with >= 0:
            message = (
                f"dry friction between {damper.body} and a carrier that turns is not simulated. Write viscous, or leave it out"
            )
            faults.add(f"damping.{i}.coulomb", message)
    for i, contact in enumerate(contacts):
        first, second = (side.body for side in contact.sides)
        if not first or not second or first == second:
            continue
        parts = {ride_of[first].part_of, ride_of[second].part_of}
        if len(parts) == 1:
            faults.add(f"contacts.{i}.between", f"{first} and {second} are rigid with each other, {NOTHING}")
        elif all(bodies[part].motion == "fixed" for part in parts) and (by_name[first].on or by_name[second].on):
            faults.add(f"contacts.{i}.between", f"{first} and {second} are both fixed, {NOTHING}")
