"""How are springs, torques and damping of the scene file read?"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from watchsim import units
from watchsim.geometry.primitives import Point
from watchsim.scene.body import Body
from watchsim.scene.errors import Faults
from watchsim.scene.file.keys.key_values import NAN, Table, listed
from watchsim.scene.file.keys.schema import DAMPING, SPRING, TORQUE, Keys, nearest
from watchsim.scene.file.readers.force_table import repeated, rows_of
from watchsim.scene.file.readers.read_against import read_against
from watchsim.scene.file.readers.read_trains import BARREL, KEYS, mainspring_torque
from watchsim.scene.file.readers.springs.read_coil import read_coil
from watchsim.scene.file.readers.springs.read_leaf import leaf_stiffness, read_rest, read_stop
from watchsim.scene.force import Damping, Spring, Torque
from watchsim.scene.oscillation import Oscillator, loads, oscillator

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
    entries = _entries(mapping, "springs", SPRING, bodies, faults)
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


def _entries(mapping: Mapping[str, Any], section: str, keys: Keys, bodies: tuple[Body, ...], faults: Faults) -> Iterator[Entry]:
    known = {body.name: body for body in bodies}
    elements = listed(mapping, section, faults)
    masses = _masses(bodies) if elements else {}
    for i, element in enumerate(elements):
        table = Table(element, f"{section}.{i}", keys, faults)
        name = table.mapping.get("body")
        body = known.get(name) if isinstance(name, str) else None
        table.motion = body.motion if body else ""
        _note_body(table, known)
        other = known.get(read_against(table, body, known) or "")
        yield Entry(table, body, other, masses.get(body.name, NAN) if body else NAN)


def _masses(bodies: tuple[Body, ...]) -> dict[str, float]:
    """What the coordinate of each body weighs: turning its inertia, sliding its mass, with all that is geared to it."""
    return {body.name: mass for body, mass in zip(bodies, loads(bodies)[2], strict=True)}


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
    stiffness = _stiffness(entry)
    frequency = math.sqrt(stiffness / entry.mass) / math.tau if "frequency" in entry.table and stiffness > 0.0 else None
    coil = read_coil(entry.table, entry.body)
    rest = read_rest(entry.table, entry.body, stiffness, entry.other)
    stop = read_stop(entry.table, entry.body, entry.other, rest)
    return Spring(entry.name, stiffness, rest, frequency, coil, entry.against, *stop)


def _stiffness(entry: Entry) -> float:
    """Of a spring given by its stiffness, by the frequency at which it makes its body swing, or by the size of a leaf."""
    table = entry.table
    given = [key for key in ("stiffness", "frequency", "leaf") if key in table]
    if len(given) > 1:
        table.fault(given[1], f"{' and '.join(given)} say the same thing: leave one out")
        return NAN
    if "leaf" in table:
        return leaf_stiffness(table, table.motion)
    if "frequency" in table:
        frequency = table.positive("frequency", "it is the frequency of the free oscillation")
        return entry.mass * (math.tau * frequency) ** 2
    if "stiffness" not in table and table.is_table:
        table.fault("", 'a spring needs frequency = "28800 vph" or stiffness = "0.758 µN·m/rad"; a leaf spring, leaf = { … }')
    return table.positive("stiffness", "a spring pulls back")


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
    over = table.one_of("over", choices, choices[0])
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
    if table.is_table and not any(key in table for key in ("q_factor", "viscous", "quadratic", "coulomb")):
        choices = 'q_factor = 250, viscous = "0.6 nN·m·s/rad", quadratic = "1 nN·m·s²/rad²" or coulomb = "10 nN·m"'
        table.fault("", f"missing: {choices}")
    for key in ("viscous", "quadratic", "coulomb"):
        if table.quantity(key) < 0.0:
            table.fault(key, "negative damping would drive the body", with_value=True)
    viscous = _from_quality(entry, swinging, spring_lost) if "q_factor" in table else table.quantity("viscous")
    return Damping(entry.name, viscous, table.quantity("quadratic"), table.quantity("coulomb"), entry.against)


def _from_quality(entry: Entry, swinging: Oscillator | None, spring_lost: bool) -> float:
    """Viscous damping c = sqrt(k J) / Q of a body that a spring or gravity pulls back."""
    table = entry.table
    if "viscous" in table:
        table.fault("q_factor", "q_factor and viscous say the same thing: leave one out")
    quality = table.positive("q_factor", "it is the quality factor of the oscillation, about 250 for a balance")
    if entry.body and swinging is None and not spring_lost:
        seen = f"neither a spring nor gravity pulls {entry.name} back, so it has no quality factor"
        table.fault("q_factor", f"{seen}. Add a spring under [[springs]], or gravity and mass; or write viscous")
    product = swinging.stiffness * swinging.inertia if swinging else NAN
    return math.sqrt(product) / quality if product > 0.0 and quality > 0.0 else NAN
