"""How is a body of the scene file read?"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from watchsim.drawing.findings import Finding
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.mechanism.body import MOTIONS, Body
from watchsim.mechanism.errors import Faults
from watchsim.mechanism.outlines import Outlines, read_outlines
from watchsim.mechanism.schema import BODY, nearest
from watchsim.mechanism.solid import more_seen
from watchsim.mechanism.solid_layers import bored
from watchsim.mechanism.table import NAN, Table, shown
from watchsim.mechanism.weight import Inertias, read_inertias
from watchsim.units import SPEED

REFUSED = ("adjust",)


@dataclass(frozen=True)
class ReadBodies:
    """All bodies, what their drawings said besides errors, the names of bodies whose outlines are sound, and the drawings as
    they were read: name in the scene file -> bytes."""

    bodies: tuple[Body, ...] = ()
    findings: tuple[Finding, ...] = ()
    sound: frozenset[str] = frozenset()
    drawings: Mapping[str, bytes] = field(default_factory=dict)


def read_bodies(mapping: object, folder: Path, faults: Faults) -> ReadBodies:
    """Every body of the scene file; faults go to `faults`."""
    if not isinstance(mapping, dict):
        faults.add("bodies", "write one table per body, such as [bodies.wheel]", shown(mapping))
        return ReadBodies()
    users = Counter(_drawing_path(entry, folder) for entry in mapping.values())
    bodies: list[Body] = []
    findings: list[Finding] = []
    sound: set[str] = set()
    drawings: dict[str, bytes] = {}
    for name, entry in mapping.items():
        motion = motion_of(mapping, name)
        table = Table(entry, f"bodies.{name}", BODY, faults, motion)
        if "." in name or not name:
            table.fault("", "a body's name must not be empty or contain a point: paths such as bodies.lever.angle use it")
        outlines = read_outlines(table, folder)
        shared = users[_drawing_path(entry, folder)] > 1
        inertias = read_inertias(table, motion, outlines, _bores_elsewhere(mapping, name, folder) if shared else frozenset())
        rest = () if shared else outlines.rest
        bodies.append(_body(name, table, motion, (outlines, inertias), rest, _carrier(table, name, mapping)))
        findings.extend((*outlines.findings, *inertias.findings))
        sound.update([name] if outlines.sound else [])
        if outlines.data is not None:
            drawings[table.text("drawing")] = outlines.data
    return ReadBodies(tuple(bodies), tuple(dict.fromkeys(findings)), frozenset(sound), drawings)


def motion_of(bodies: Mapping[str, Any], name: object) -> str:
    """The motion a body asks for, "pivot" where it says nothing readable."""
    entry = bodies.get(name) if isinstance(bodies, Mapping) and isinstance(name, str) else None
    motion = entry.get("motion", "pivot") if isinstance(entry, Mapping) else "pivot"
    return motion if motion in MOTIONS else "pivot"


def _drawing_path(entry: object, folder: Path) -> Path | None:
    name = entry.get("drawing") if isinstance(entry, dict) else None
    return folder / name if isinstance(name, str) else None


def _bores_elsewhere(bodies: Mapping[str, Any], name: str, folder: Path) -> frozenset[str]:
    """The layers that other bodies of the same drawing name as bores."""
    path = _drawing_path(bodies[name], folder)
    others = [entry for other, entry in bodies.items() if other != name and _drawing_path(entry, folder) == path]
    return frozenset(layer for entry in others for layer in bored(entry))


def _body(
    name: str, table: Table, motion: str, drawn: tuple[Outlines, Inertias], rest: tuple[Loop, ...], on: str | None
) -> Body:
    """Everything is read even after a fault, so that all faults of a body are found at once."""
    outlines, inertias = drawn
    table.one_of("motion", MOTIONS, "pivot")
    for key in REFUSED:
        if key in table:
            table.refuse(key)
    shift = (-inertias.origin[0], -inertias.origin[1])
    return Body(
        name=name,
        motion=motion,
        position=table.pair("position"),
        angle=table.quantity("angle"),
        velocity=_velocity(table, motion),
        axis=_axis(table, motion),
        mass=inertias.mass,
        inertia=inertias.inertia,
        centre_of_mass=inertias.centre,
        loops=_shifted(outlines.loops, shift),
        decoration=(*_shifted(rest, shift), *more_seen(inertias.solids, {loop.layer for loop in outlines.loops})),
        solids=inertias.solids,
        on=on,
    )


def _carrier(table: Table, name: str, bodies: Mapping[str, Any]) -> str | None:
    """The name of the body that carries this one; None without, or where there is no such body."""
    if "on" not in table:
        return None
    on = table.text("on")
    if on in bodies and on != name:
        return on
    if on:
        others = [other for other in bodies if other != name]
        complaint = "a body cannot carry itself" if on == name else f"there is no such body. {nearest(on, others)}"
        table.fault("on", complaint, with_value=True)
    return None


def _shifted(loops: tuple[Loop, ...], shift: Point) -> tuple[Loop, ...]:
    return tuple(loop.moved(0.0, shift) for loop in loops)


def _velocity(table: Table, motion: str) -> tuple[float, ...]:
    if "spin" in table and motion != "free":
        table.fault("spin", 'belongs to motion = "free"; here the key is velocity')
    if motion == "free":
        velocity = table.point("velocity", table.mapping["velocity"], SPEED) if "velocity" in table else (0.0, 0.0)
        return (*velocity, table.quantity("spin"))
    if motion == "fixed":
        if "velocity" in table:
            table.fault("velocity", "a fixed body does not move", with_value=True)
        return ()
    return (table.quantity("velocity"),)


def _axis(table: Table, motion: str) -> Point:
    """Unit direction of a sliding body."""
    if motion != "slide":
        if "axis" in table:
            table.fault("axis", 'belongs to motion = "slide"')
        return (1.0, 0.0)
    if "axis" not in table:
        table.fault("", "a sliding body needs its direction. Write e.g. axis = [1.0, 0.0]")
    x, y = table.pair("axis", (NAN, NAN))
    length = math.hypot(x, y)
    if length == 0.0:
        table.fault("axis", "a direction of length zero points nowhere", with_value=True)
        return (NAN, NAN)
    return (x / length, y / length)
