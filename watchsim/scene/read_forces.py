"""How are springs, torques and damping of the scene file read?"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from watchsim import units
from watchsim.geometry.elastic_coil import bending
from watchsim.geometry.hairspring import Coil
from watchsim.geometry.primitives import Point
from watchsim.model import DAMPING_LAWS
from watchsim.scene.errors import Faults
from watchsim.scene.forces import Bearing, Curb, Damping, LineSpring, Spring, Torque
from watchsim.scene.keys import (
    BEARING,
    COIL,
    CURB,
    DAMPING,
    FEWEST_TURNS,
    LEAF,
    LINE_SPRING,
    MOST_TURNS,
    SPRING,
    TORQUE,
    WOUND,
    Keys,
    nearest,
)
from watchsim.scene.read_contacts import read_against, repeated, rows_of
from watchsim.scene.read_trains import BARREL, KEYS, mainspring_torque
from watchsim.scene.roles import Oscillator, loads, oscillator
from watchsim.scene.scene import Body, Gear
from watchsim.scene.solids import HAIRSPRING
from watchsim.scene.values import NAN, UNREADABLE, Table, listed
from watchsim.units import LENGTH

# How is a spring drawn, which acts as a torque and has no shape of its own?

COIL_EXAMPLE = 'draw = { inner = "0.5 mm", outer = "2.8 mm", turns = 13, stud = "90°" }'


def read_coil(table: Table, body: Body | None) -> Coil | None:
    """As `draw` of a spring says; else as the `solids` of its body weigh a hairspring given by numbers; else not at all."""
    if "draw" not in table:
        spirals = () if body is None or body.motion != "pivot" else [one for one in body.solids if one.kind == HAIRSPRING]
        for solid in spirals:
            if solid.spiral is not None and FEWEST_TURNS <= solid.spiral.turns <= MOST_TURNS:
                return Coil(solid.spiral.inner, solid.spiral.outer, solid.spiral.turns, 0.0, solid.width)
        return None
    if body is not None and body.motion != "pivot":
        table.fault("draw", f'a hairspring is wound about a pivot, and motion of {body.name} is "{body.motion}"')
        return None
    found = _read_spiral(table, "draw", COIL, COIL_EXAMPLE)
    return found[0] if found else None


def _read_spiral(table: Table, key: str, known_keys: Keys, example: str) -> tuple[Coil, Table] | None:
    """A hairspring given by numbers, and its table; None after a fault."""
    if not isinstance(table.mapping[key], dict):
        table.fault(key, f"a table is needed here, such as {example}", with_value=True)
        return None
    keys = Table(table.mapping[key], f"{table.path}.{key}", known_keys, table.faults)
    known = len(table.faults.found)
    keys.lacks(example)
    inner, outer, turns = (keys.quantity(key, NAN) for key in ("inner", "outer", "turns"))
    width = keys.quantity("width")
    if outer <= inner:
        keys.fault("outer", "the stud must stand outside the collet: outer is no more than inner", with_value=True)
    stud = keys.quantity("stud")
    return (Coil(inner, outer, turns, stud, width), keys) if len(table.faults.found) == known else None


WOUND_EXAMPLE = 'coil = { inner = "0.5 mm", outer = "2.8 mm", turns = 13, stud = "90°", mass = "2.4 mg" }'


def read_wound(table: Table, body: Body | None) -> tuple[Coil | None, float]:
    """(a hairspring as it bends, its mass in kg); None without."""
    if "coil" not in table:
        return None, 0.0
    if body is not None and (body.motion != "pivot" or body.geared is not None):
        table.fault("coil", f"a hairspring is wound about a pivot without gears to another, unlike {body.name}")
        return None, 0.0
    found = _read_spiral(table, "coil", WOUND, WOUND_EXAMPLE)
    if found is None:
        return None, 0.0
    try:
        bending(found[0])
    except ValueError as reason:
        found[1].fault("turns", f"{reason}: give it more", with_value=True)
        return None, 0.0
    return found[0], found[1].quantity("mass")


CURB_EXAMPLE = 'curb = { share = 0.03, gap = "20°" }'


def read_curb(table: Table, body: Body | None) -> Curb | None:
    """The pins of a hairspring; None without."""
    if "curb" not in table:
        return None
    if not isinstance(table.mapping["curb"], dict):
        table.fault("curb", f"a table is needed here, such as {CURB_EXAMPLE}", with_value=True)
        return None
    keys = Table(table.mapping["curb"], f"{table.path}.curb", CURB, table.faults)
    keys.lacks(CURB_EXAMPLE)
    if body is not None and (body.motion != "pivot" or body.geared is not None):
        table.fault("curb", f"pins hold a hairspring on a body that turns and is not geared without play, unlike {body.name}")
    found = Curb(keys.quantity("share", NAN), keys.quantity("gap", NAN), keys.quantity("offset"))
    if abs(found.offset) > found.gap:
        keys.fault("offset", "at rest the coil would be bent by a pin: it can be no more than gap", with_value=True)
    return found


# How are leaf springs read: their stiffness from their size, their preload and the stop on which they rest?
#
# A leaf clamped at one end and pressed at the other is a cantilever: F = 3 E I y / L³ with I = w t³ / 12, for deflections small
# against its length (Timoshenko, *Strength of Materials*, part I, 1930, art. 37 to 39: deflection of a cantilever).
# On a pivoted body it presses at the end of an arm, which makes it a torsional spring of arm² times that.

LEAF_EXAMPLE = 'leaf = { modulus = "200 GPa", length = "5 mm", width = "0.5 mm", thickness = "0.08 mm" }'


def leaf_stiffness(table: Table, motion: str) -> float:
    """3 E I / L³ of the leaf of a spring, N/m; times arm², N·m/rad, on a body with motion "pivot". NaN after a fault."""
    if not isinstance(table.mapping["leaf"], dict):
        table.fault("leaf", f"a table is needed here, such as {LEAF_EXAMPLE}", with_value=True)
        return NAN
    keys = Table(table.mapping["leaf"], f"{table.path}.leaf", LEAF, table.faults)
    turns = motion == "pivot" or (not motion and "arm" in keys)
    example = LEAF_EXAMPLE + (' with arm = "2 mm", on a pivoted body' if turns else "")
    keys.lacks(example, *(("arm",) if turns else ()))
    if "arm" in keys and not turns:
        keys.fault("arm", "belongs to a leaf on a pivoted body: leave it out")
    modulus, length, width, thickness = (keys.quantity(key, NAN) for key in ("modulus", "length", "width", "thickness"))
    if thickness >= length:
        keys.fault("thickness", "a leaf is thin: the formula of a cantilever needs thickness far below length", with_value=True)
    bending = modulus * width * thickness**3 / 12.0
    return 3.0 * bending / length**3 * (keys.quantity("arm", NAN) if turns else 1.0) ** 2


def read_rest(table: Table, body: Body | None, stiffness: float, other: Body | None) -> float:
    """The place without force; with `preload` that from which the spring presses so much at its stop, or else at the start."""
    if "preload" not in table:
        return table.quantity("rest")
    if "rest" in table:
        table.fault("preload", "rest and preload say the same thing: leave one out")
    start = start_of(body) - start_of(other)
    return table.quantity("stop", start) + table.quantity("preload") / stiffness


def read_stop(table: Table, body: Body | None, other: Body | None, rest: float) -> tuple[float | None, float]:
    """Where a spring rests on its stop (None without one), and the restitution of impacts there."""
    restitution = table.quantity("restitution")
    if "stop" not in table:
        if "restitution" in table:
            table.fault("restitution", 'belongs to a spring with a stop, such as stop = "0°": leave it out')
        return None, 0.0
    stop = table.quantity("stop")
    carried = next((one for one in (body, other) if one is not None and one.on is not None), None)
    if carried is not None and other is not None:
        why = f"{carried.name} is carried by {carried.on}, and a stop between three angles is no contact of two bodies"
        table.fault("stop", f"{why}: draw the stop, and declare the contact with it")
    if other is not None and other.prescribed is not None:
        table.fault("stop", f"{other.name} is driven: draw the stop, and declare the contact with it")
    if rest == stop:
        table.fault("stop", "the spring does not press on it: say by preload or rest to which side it presses", with_value=True)
    elif body is not None and (start_of(body) - start_of(other) - stop) * (stop - rest) < 0.0:
        table.fault("stop", "the body stands beyond it at the start: choose another angle, or the other sign of preload", True)
    return stop, restitution


def start_of(body: Body | None) -> float:
    """The coordinate of a body at the start, 0 for the movement: angles count from the drawing's, travels from the start."""
    return body.angle if body is not None and body.motion == "pivot" else 0.0


# How are [[line_springs]] read, which act along the line between two points?

EXAMPLE = 'points = [["1 mm", "0 mm"], ["5 mm", "2 mm"]]'


def read_line_springs(mapping: Mapping[str, Any], bodies: tuple[Body, ...], faults: Faults) -> tuple[LineSpring, ...]:
    """Each between a point of a body and a point of another, or of the movement."""
    known = {body.name: body for body in bodies}
    tables = [
        Table(one, f"line_springs.{i}", LINE_SPRING, faults) for i, one in enumerate(listed(mapping, "line_springs", faults))
    ]
    found = [_line_spring(table, known) for table in tables]
    return tuple(one for one in found if one is not None)


def _line_spring(table: Table, known: Mapping[str, Body]) -> LineSpring | None:
    ends = _ends(table, known)
    points = _points(table)
    stiffness, viscous = _line_stiffness(table), table.quantity("viscous")
    if "length" in table and "tension" in table:
        table.fault("tension", "length and tension say the same thing: leave one out")
    if ends is None:
        return None
    start = math.dist(*(at_start(body, point) for body, point in zip(ends, points, strict=True)))
    length = table.quantity("length") if "length" in table else start - table.quantity("tension") / stiffness
    if length < 0.0:
        why = "without force it would be shorter than nothing" if "tension" in table else "a length is not negative"
        table.fault("tension" if "tension" in table else "length", why, with_value=True)
    if start == 0.0:
        table.fault("points", "lie on each other at the start: the spring would have no direction")
    first, second = ends
    assert first is not None
    return LineSpring((first.name, second.name if second else None), points, stiffness, length, viscous)


def _line_stiffness(table: Table) -> float:
    if "leaf" in table:
        if "stiffness" in table:
            table.fault("leaf", "stiffness and leaf say the same thing: leave one out")
        return leaf_stiffness(table, "slide")
    if "stiffness" not in table and table.is_table:
        table.fault("", 'missing: stiffness = "20 N/m", or leaf = { … }')
    return table.quantity("stiffness", NAN)


def at_start(body: Body | None, point: Point) -> Point:
    """Where a point of a body, or of the movement, lies when a run begins."""
    if body is None:
        return point
    c, s = math.cos(body.angle), math.sin(body.angle)
    (x0, y0), (x, y) = body.position, point
    return x0 + c * x - s * y, y0 + s * x + c * y


def _ends(table: Table, known: Mapping[str, Body]) -> tuple[Body | None, Body | None] | None:
    """The two bodies, the second None for the movement; None altogether after a fault."""
    example = 'between = ["lever", "wheel"], or ["lever"] for a spring from the movement'
    names = table.names("between", (1, 2), f"one or two bodies are needed: {example}")
    if not names:
        return None
    for i, name in enumerate(names):
        if name not in known:
            table.fault(f"between.{i}", f'there is no body "{name}". {nearest(name, known)}')
            return None
        if known[name].on is not None:
            table.fault(f"between.{i}", f"{name} is carried by {known[name].on}: line springs hold bodies of the movement only")
            return None
    first, second = known[names[0]], known[names[1]] if len(names) == 2 else None
    if all(body is None or body.motion == "fixed" or body.prescribed is not None for body in (first, second)):
        table.fault("between", "nothing that it holds can give way, so this spring does nothing", with_value=True)
    return first, second


def _points(table: Table) -> tuple[Point, Point]:
    value = table.mapping.get("points")
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        if table.is_table:
            table.fault("points" if "points" in table else "", f"a point of each is needed, from its pivot: {EXAMPLE}")
        return UNREADABLE, (NAN, NAN)
    first, second = (table.point(f"points.{i}", one, LENGTH) for i, one in enumerate(value))
    return first, second


# How are springs, torques and damping of the scene file read?

OVER = {"pivot": ("angle", "time", BARREL), "slide": ("travel", "time")}
ABSCISSA = {"angle": units.ANGLE, "travel": units.LENGTH, "time": units.TIME, BARREL: units.ANGLE}
COORDINATE = {"pivot": "inertia", "slide": "mass"}


@dataclass(frozen=True, slots=True)
class Entry:
    """One element of [[springs]], [[torques]] or [[damping]] with the body it names (None after a fault)."""

    table: Table
    body: Body | None
    other: Body | None  # at the other end
    mass: float  # of the body's coordinate, with what it carries and what is geared to it, kg or kg·m²; NaN after a fault

    @property
    def name(self) -> str:
        return self.body.name if self.body else ""

    @property
    def against(self) -> str | None:
        return self.other.name if self.other else None


def read_springs(mapping: Mapping[str, Any], bodies: tuple[Body, ...], faults: Faults) -> tuple[Spring, ...]:
    entries = list(_entries(mapping, "springs", SPRING, bodies, faults))
    holders = [one.body.geared.to if one.body and one.body.geared else one.name for one in entries]
    for entry, holder in zip(entries, holders, strict=True):
        for key in ("cubic", "curb", "coil"):
            if key not in entry.table or entry.body is None:
                continue
            if entry.other is not None or entry.body.on is not None:
                entry.table.fault(key, "is for a spring that is fixed in the movement, on a body that nothing carries")
            elif holders.count(holder) > 1:
                entry.table.fault(key, f"several springs act on {holder} as one, at their common rest: write one")
    return tuple(_spring(entry) for entry in entries)


def read_torques(mapping: Mapping[str, Any], bodies: tuple[Body, ...], faults: Faults) -> tuple[Torque, ...]:
    return tuple(_torque(entry) for entry in _entries(mapping, "torques", TORQUE, bodies, faults))


def read_damping(
    mapping: Mapping[str, Any], bodies: tuple[Body, ...], springs: tuple[Spring, ...], gravity: Point, faults: Faults
) -> tuple[Damping, ...]:
    found = []
    lost = any(not spring.body for spring in springs) or (
        not springs and mapping.get("springs", []) != []
    )  # noted: whose is it?
    for entry in _entries(mapping, "damping", DAMPING, bodies, faults):
        swinging = oscillator(bodies, springs, gravity, entry.name) if "q_factor" in entry.table else None
        found.append(_damping(entry, swinging, lost))
    return tuple(found)


def read_bearings(
    mapping: Mapping[str, Any], bodies: tuple[Body, ...], springs: tuple[Spring, ...], gears: tuple[Gear, ...], faults: Faults
) -> tuple[Bearing, ...]:
    """Pivots whose friction goes with the weight that they carry."""
    crowded = _crowded(bodies)
    found = tuple(_bearing(entry, crowded) for entry in _entries(mapping, "bearings", BEARING, bodies, faults))
    bound = dict.fromkeys((name for gear in gears for name in gear.between), "meshes with a gear")
    bound |= dict.fromkeys((one.body for one in springs if one.stop is not None), "has a spring with a stop")
    named = [bearing.body for bearing in found]
    bound |= {name: "has several bearings" for name in named if named.count(name) > 1}
    for number, bearing in enumerate(found):
        if bearing.play and (reason := bound.get(bearing.body)):
            why = f"{bearing.body} {reason}, which is not simulated together with play of its pivot: leave out one"
            faults.add(f"bearings.{number}.play", why)
    return found


def _crowded(bodies: tuple[Body, ...]) -> dict[str, str]:
    """Bodies whose pivots carry what is not known: other bodies, or the force between teeth of gears without play."""
    found = {body.on: f"carries {body.name}, whose forces its pivot would feel" for body in bodies if body.on}
    for body in bodies:
        if body.geared is not None:
            meshed = "is geared without play, and nothing computes the force between the teeth as it runs"
            found |= {body.name: meshed, body.geared.to: meshed}
    return found


def _bearing(entry: Entry, crowded: Mapping[str, str]) -> Bearing:
    table, body = entry.table, entry.body
    table.lacks('body = "balance", radius = "0.05 mm", friction = 0.12')
    if body is not None and (body.motion != "pivot" or body.on is not None or body.prescribed is not None):
        table.fault("body", "a bearing with a load is that of a body that turns about a pivot of the movement", with_value=True)
    elif body is not None and (reason := crowded.get(body.name)):
        table.fault("body", f"{body.name} {reason}: write coulomb under [[damping]]", with_value=True)
    elif body is not None and body.mass == 0.0:
        why = f"{body.name} has no weight: give it a mass or solids, or write coulomb under [[damping]]"
        table.fault("body", why, with_value=True)
    radius, friction, flat = table.quantity("radius", NAN), table.quantity("friction", NAN), table.quantity("flat")
    play = table.quantity("play")
    if "side" in table and not play:
        table.fault("side", 'says where the pivot lies in its play: write play = "8 µm" as well')
    elif play and body is not None and body.inertia <= body.mass * math.hypot(*body.centre_of_mass) ** 2:
        table.fault("play", f"needs the inertia about the centre of mass, and of {body.name} none is left: check its inertia")
    return Bearing(entry.name, radius, friction, flat, play, table.quantity("side") if "side" in table else None)


def _entries(mapping: Mapping[str, Any], section: str, keys: Keys, bodies: tuple[Body, ...], faults: Faults) -> Iterator[Entry]:
    known = {body.name: body for body in bodies}
    elements = listed(mapping, section, faults)
    masses = {body.name: mass for body, mass in zip(bodies, loads(bodies)[2], strict=True)} if elements else {}
    for i, element in enumerate(elements):
        table = Table(element, f"{section}.{i}", keys, faults)
        name = table.mapping.get("body")
        body = known.get(name) if isinstance(name, str) else None
        table.motion = body.motion if body else ""
        _note_body(table, known)
        other = known.get(read_against(table, body, known) or "")
        yield Entry(table, body, other, masses.get(body.name, NAN) if body else NAN)


def _note_body(table: Table, known: Mapping[str, Body]) -> None:
    if not table.is_table:
        return
    name = table.needed_text("body", next(iter(known), "balance"))
    if name not in known and (name or table.mapping.get("body") == ""):
        table.fault("body", f"there is no such body. {nearest(name, known)}", with_value=True)
    elif name in known and known[name].motion not in COORDINATE:
        table.fault("body", f'acts on a pivoted or a sliding body, and motion of {name} is "{known[name].motion}"', True)
    elif name in known and known[name].prescribed is not None:
        table.fault("body", f"{name} is driven: it moves as prescribed, whatever acts on it", True)
    elif name in known and (geared := known[name].geared) and known[geared.to].prescribed is not None:
        table.fault(
            "body", f"{name} moves as prescribed, whatever acts on it: {geared.to}, to which it is geared, is driven", True
        )


def _spring(entry: Entry) -> Spring:
    stiffness = _spring_stiffness(entry)
    frequency = math.sqrt(stiffness / entry.mass) / math.tau if "frequency" in entry.table and stiffness > 0.0 else None
    coil = read_coil(entry.table, entry.body)
    rest = read_rest(entry.table, entry.body, stiffness, entry.other)
    stop = read_stop(entry.table, entry.body, entry.other, rest)
    cubic, curb = entry.table.quantity("cubic"), read_curb(entry.table, entry.body)
    wound, mass = read_wound(entry.table, entry.body)
    return Spring(entry.name, stiffness, rest, frequency, coil or wound, entry.against, *stop, cubic, curb, wound, mass)


def _spring_stiffness(entry: Entry) -> float:
    """Of a spring given by its stiffness, by the frequency at which it makes its body swing, or by the size of a leaf."""
    table = entry.table
    given = [key for key in ("stiffness", "frequency", "leaf") if key in table]
    if len(given) > 1:
        table.fault(given[1], f"{' and '.join(given)} say the same thing: leave one out")
        return NAN
    if "leaf" in table:
        return leaf_stiffness(table, table.motion)
    if "frequency" in table:
        return entry.mass * (math.tau * table.quantity("frequency")) ** 2
    if "stiffness" not in table and table.is_table:
        table.fault("", 'a spring needs frequency = "28800 vph" or stiffness = "0.758 µN·m/rad"; a leaf spring, leaf = { … }')
    return table.quantity("stiffness", NAN)


def _torque(entry: Entry) -> Torque:
    table = entry.table
    if "table" in table:
        return _tabulated(entry)
    of_table = [key for key in ("over", "period", *KEYS) if key in table]
    if "value" not in table and table.is_table:
        needed = 'missing: value = "-1.0 µN·m", or a table over angle or time'
        table.fault("", f"missing: the table to which {of_table[0]} belongs" if of_table else needed)
        return Torque(entry.name, against=entry.against)
    for key in of_table:
        owner = f' with over = "{BARREL}"' if key in KEYS else "; a value is constant"
        table.fault(key, f"belongs to a table{owner}")
    return Torque(entry.name, table.quantity("value"), against=entry.against)


def _tabulated(entry: Entry) -> Torque:
    table, nothing = entry.table, Torque(entry.name, against=entry.against)
    if "value" in table:
        table.fault("value", "a torque is either a value or a table: leave one out")
    choices = OVER.get(table.motion, tuple(dict.fromkeys(OVER["pivot"] + OVER["slide"])))
    if "over" not in table:
        table.fault("", f'a table needs over = "{choices[0]}" or over = "time"')
        return nothing
    over = table.one_of("over", choices[0], choices)
    if not over:  # columns of what?
        return nothing
    for key, owner in {"period": "time", **dict.fromkeys(KEYS, BARREL)}.items():
        if key in table and over != owner:
            table.fault(key, f'belongs to a table with over = "{owner}"')
    if over == BARREL and entry.body is not None:
        return mainspring_torque(table, entry.body, rows_of(table, units.ANGLE))
    rows, period = rows_of(table, ABSCISSA[over]), None
    if "period" in table and over == "time":
        rows, period = repeated(table, rows)
    return replace(nothing, over="time" if over == "time" else "angle", table=rows, period=period)


def _damping(entry: Entry, swinging: Oscillator | None, spring_lost: bool) -> Damping:
    table = entry.table
    if table.is_table and not any(key in table for key in ("q_factor", *DAMPING_LAWS, "coulomb")):
        choices = 'q_factor = 250, viscous = "0.6 nN·m·s/rad", quadratic = "1 nN·m·s²/rad²" or coulomb = "10 nN·m"'
        table.fault("", f"missing: {choices}")
    viscous = _from_quality(entry, swinging, spring_lost) if "q_factor" in table else table.quantity("viscous")
    others = {key: table.quantity(key) for key in (*DAMPING_LAWS, "coulomb") if key != "viscous"}
    return Damping(entry.name, viscous, against=entry.against, **others)


def _from_quality(entry: Entry, swinging: Oscillator | None, spring_lost: bool) -> float:
    """Viscous damping c = sqrt(k J) / Q of a body that a spring or gravity pulls back."""
    table = entry.table
    if "viscous" in table:
        table.fault("q_factor", "q_factor and viscous say the same thing: leave one out")
    quality = table.quantity("q_factor")
    if entry.body and swinging is None and not spring_lost:
        seen = f"neither a spring nor gravity pulls {entry.name} back, so it has no quality factor"
        table.fault("q_factor", f"{seen}. Add a spring under [[springs]], or gravity and mass; or write viscous")
    product = swinging.stiffness * swinging.inertia if swinging else NAN
    return math.sqrt(product) / quality if product > 0.0 and quality > 0.0 else NAN
