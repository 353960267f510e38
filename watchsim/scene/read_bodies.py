"""How is a body of the scene file read?"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from watchsim.drawing.findings import Finding
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point
from watchsim.geometry.solids import mass_properties
from watchsim.scene.assign import motion_of
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY, DRIVEN, SWING, nearest
from watchsim.scene.outlines import Made, Outlines, bored, read_outlines
from watchsim.scene.read_bores import bore_notices, uniform_notices
from watchsim.scene.read_solids import read_solids
from watchsim.scene.scene import Body, Prescribed, path, swing
from watchsim.scene.solids import Solid, Weight, more_seen, total
from watchsim.scene.values import NAN, Table, shown
from watchsim.units import ANGLE, LENGTH, SPEED, TIME

# How heavy is a body, and where is its centre of mass?


@dataclass(frozen=True, slots=True)
class Inertias:
    """What the motion needs: `origin` is the point of the drawing that becomes the origin of the body's frame.

    `centre` and `solids` are in that frame. `findings` report bores that count otherwise than their names say."""

    origin: Point
    mass: float
    inertia: float
    centre: Point
    solids: tuple[Solid, ...] = ()
    findings: tuple[Finding, ...] = ()


def read_inertias(table: Table, motion: str, outlines: Outlines, elsewhere: Set[str] = frozenset()) -> Inertias:
    """Mass and inertia from the keys of a body or from its solids; a moving body without is a fault.

    `elsewhere` are the layers of the drawing that other bodies name as their bores.
    """
    solids = read_solids(table, outlines)
    if "solids" in table:
        weight, findings = total(solids), bore_notices(table, outlines, solids, elsewhere)
    else:
        weight = _uniform_plate(table, motion, outlines)
        findings = uniform_notices(table, outlines, weight, elsewhere) if weight and "inertia" not in table else ()
    if "mass" in table and "solids" in table:
        table.fault("mass", "the solids give the mass already: leave out mass or solids")
    if motion == "free" and "solids" in table and outlines.pivot is not None:
        table.fault("pivot", "a free body turns about its centre of mass, which the solids give: leave out pivot or solids")
    origin = outlines.pivot or ((weight.centre if weight else (0.0, 0.0)) if motion == "free" else (0.0, 0.0))
    mass = table.quantity("mass", weight.mass if weight else 0.0)
    inertia = table.quantity("inertia", _shape_inertia(weight, motion, origin))
    centre = _written_centre(table, motion, origin) or (weight.centre if weight and motion != "free" else origin)
    shift = (-origin[0], -origin[1])
    local = (centre[0] + shift[0], centre[1] + shift[1])
    inertias = Inertias(origin, mass, inertia, local, tuple(solid.shifted(shift) for solid in solids), findings)
    _note_massless(table, motion, inertias, outlines)
    return inertias


def _written_centre(table: Table, motion: str, origin: Point) -> Point | None:
    """The centre of mass in the drawing where the scene gives it, from the pivot; None without.

    It stands instead of that of the outline, and belongs to a mass and an inertia that are numbers, too.
    """
    if "centre_of_mass" not in table:
        return None
    if motion == "free":
        table.fault("centre_of_mass", "a free body turns about its centre of mass: write pivot, which is that point")
    elif motion == "slide" or (motion == "fixed" and "on" not in table):
        table.fault("centre_of_mass", f"has no effect on a body that cannot turn ({motion}): leave it out")
    elif "solids" in table:
        table.fault("centre_of_mass", "the solids already give the centre of mass: leave out centre_of_mass or solids")
    elif "mass" not in table or "inertia" not in table:
        table.fault("centre_of_mass", "needs mass and inertia (about the pivot) beside it, as gravity acts on the mass there")
    x, y = table.pair("centre_of_mass")
    return (origin[0] + x, origin[1] + y)


def _uniform_plate(table: Table, motion: str, outlines: Outlines) -> Weight | None:
    """Where the motion asks for it, a uniform plate of the outlines with the mass that was given."""
    closed = tuple(loop for loop in outlines.loops if loop.closed)
    carried = "on" in table
    # Of a carried body whose inertia is written, the outline is not the whole: it counts as poised.
    by_outline = (motion == "pivot" and not (carried and "inertia" in table)) or (motion == "fixed" and carried)
    wanted = motion == "free" or ("mass" in table and by_outline)
    if not closed or not outlines.sound or not wanted:
        return None
    try:
        found = mass_properties(closed, 1.0, 1.0)
    except ValueError as error:
        table.fault("", str(error))
        return None
    return Weight(found.mass, found.centre, found.inertia_about(found.centre)).scaled(table.quantity("mass"))


def _shape_inertia(weight: Weight | None, motion: str, origin: Point) -> float:
    if weight is None:
        return 0.0
    return weight.inertia if motion == "free" else weight.about(origin)


def _note_massless(table: Table, motion: str, inertias: Inertias, outlines: Outlines) -> None:
    """A moving body that nothing holds back has no acceleration; a fault only where no other fault is the reason."""
    driven = table.mapping.get("motion") == "driven"  # needs no mass: it moves as prescribed
    needs = () if driven else {"pivot": ("inertia",), "slide": ("mass",), "free": ("mass", "inertia")}.get(motion, ())
    promised = table.mapping.get("solids", []) not in ([], ()) or ("mass" in table and (outlines.loops or not outlines.sound))
    for key, value, example in (("mass", inertias.mass, "1 mg"), ("inertia", inertias.inertia, "0.05 mg·cm²")):
        if key in needs and value == 0.0 and (key in table or not promised):
            why = f"the body can move ({motion}) but has no {key}"
            advice = f'Write {key} = "{example}" or give thickness and density in [[{table.path}.solids]]'
            table.fault(key if key in table else "", f"{why}. {advice}", with_value=key in table)


# How is the motion of a driven body read?

LAWS = ("velocity", "swing", "path")
MOST_POINTS = 2000


@dataclass(frozen=True, slots=True)
class Read:
    """The law, and the velocity (rad/s or m/s) with which it starts."""

    law: Prescribed
    velocity: float


def read_prescribed(table: Table, start: float) -> Read | None:
    """The law of one body that starts at coordinate `start` (rad, or 0 m); None where nothing is prescribed."""
    if table.mapping.get("motion") != DRIVEN:
        return None
    given = [key for key in LAWS if key in table]
    if len(given) != 1:
        table.fault(
            given[1] if given else "",
            'a driven body needs one law: velocity = "60 rpm", swing = { amplitude = "10°", frequency = "2 Hz" } '
            'or path = [["0.1 s", "36°"], ["0.2 s", "36°"]]',
        )
    if "on" in table:
        table.fault("on", "a driven body cannot be carried: its motion is prescribed in the movement")
    if "swing" in table:
        return _swing(table, start)
    return _path(table) if "path" in table else Read(Prescribed(), table.quantity("velocity"))


def _swing(table: Table, start: float) -> Read:
    inner = Table(table.mapping["swing"], f"{table.path}.swing", SWING, table.faults, table.motion)
    first = "1 mm" if table.motion == "slide" else "10°"
    amplitude, phase = inner.quantity("amplitude", NAN), inner.quantity("phase")
    inner.lacks(f'swing = {{ amplitude = "{first}", frequency = "2 Hz" }}')
    frequency = inner.quantity("frequency", NAN)
    if not math.isfinite(amplitude + phase + frequency):
        return Read(Prescribed(), 0.0)
    law, _, velocity = swing(start - amplitude * math.sin(phase), amplitude, frequency, phase)
    return Read(law, velocity)


def _path(table: Table) -> Read:
    """Points of time and travel since the start, which is the point (0, 0)."""
    points = table.mapping["path"]
    if not isinstance(points, list) or not 1 <= len(points) <= MOST_POINTS:
        table.fault("path", f'a list of 1 to {MOST_POINTS} points is needed: path = [["0.1 s", "36°"], ["0.2 s", "36°"]]', True)
        return Read(Prescribed(), 0.0)
    way = LENGTH if table.motion == "slide" else ANGLE
    found = [(0.0, 0.0)]
    for i, point in enumerate(points):
        if not isinstance(point, list) or len(point) != 2:
            table.fault(f"path.{i}", 'a time and how far the body has gone by then: ["0.1 s", "36°"]')
            continue
        t, q = table.parsed(f"path.{i}.0", point[0], TIME), table.parsed(f"path.{i}.1", point[1], way)
        if t <= found[-1][0]:
            table.fault(f"path.{i}.0", "times must be above zero and increase")
        elif math.isfinite(t + q):
            found.append((t, q))
    if len(found) <= len(points):
        return Read(Prescribed(), 0.0)
    return Read(path(found), 0.0)


# How is a body of the scene file read?

AS_DRAWN = "as drawn"
LIKELY = {  # the motion of a body with such a key, where it cannot be read; the first that is there
    **dict.fromkeys(("swing", "path"), DRIVEN),
    **{"spin": "free", "axis": "slide"},
    **dict.fromkeys(("inertia", "solids", "mass"), "pivot"),
    "velocity": DRIVEN,
}
FORGOTTEN = (  # key, the motion that it belongs to, a key that must be there as well, one that must not
    ("swing", DRIVEN, "swing", "inertia"),
    ("path", DRIVEN, "path", "inertia"),
    ("spin", "free", "mass", "axis"),
    ("axis", "slide", "mass", "inertia"),
)


@dataclass(frozen=True)
class ReadBodies:
    """All bodies, what their drawings said besides errors, the names of bodies whose outlines are sound, and the drawings as
    they were read: name in the scene file -> bytes."""

    bodies: tuple[Body, ...] = ()
    findings: tuple[Finding, ...] = ()
    sound: frozenset[str] = frozenset()
    drawings: Mapping[str, bytes | Sheet] = field(default_factory=dict)


@dataclass(frozen=True)
class _Read:
    """One table with what its drawing and its solids gave; `path` is the drawing, `shared` if several bodies use it."""

    name: str
    table: Table
    motion: str
    outlines: Outlines
    inertias: Inertias
    path: Path | None
    shared: bool


def read_bodies(mapping: object, folder: Path, faults: Faults, made: Made | None = None) -> ReadBodies:
    """Every body of the scene file; faults go to `faults`. Drawings in `made` are taken from there, not from the folder."""
    if not isinstance(mapping, dict):
        faults.add("bodies", "write one table per body, such as [bodies.wheel]", shown(mapping))
        return ReadBodies()
    if not mapping:
        faults.add("bodies", "a scene needs at least one body, such as [bodies.wheel]")
    for name, entry in mapping.items():
        if not isinstance(entry, dict):
            where = f"bodies.{name}"
            faults.add(where, "a body is expected here: a table with its name, such as [bodies.wheel]", shown(entry))
    mapping = {name: _with_motion(name, entry, faults) for name, entry in mapping.items() if isinstance(entry, dict)}
    users = Counter(_drawing_path(entry, folder) for entry in mapping.values())
    bores: dict[Path | None, Counter[str]] = {path: Counter() for path in users}  # drawing -> layers, by how many bodies
    for entry in mapping.values():
        bores[_drawing_path(entry, folder)].update(set(bored(entry)))
    read = [_read(mapping, name, folder, users, bores, faults, made or {}) for name in mapping]
    places = {one.name: one for one in read}
    bodies = [_body(one, _with_play(one.table, _position(one, places)), _carrier(one.table, one.name, mapping)) for one in read]
    findings = [finding for one in read for finding in (*one.outlines.findings, *one.inertias.findings)]
    sound = {one.name for one in read if one.outlines.sound}
    drawings = {one.table.text("drawing"): one.outlines.data for one in read if one.outlines.data is not None}
    return ReadBodies(tuple(bodies), tuple(dict.fromkeys(findings)), frozenset(sound), drawings)


def _with_motion(name: str, entry: dict[str, Any], faults: Faults) -> dict[str, Any]:
    """The entry with a motion that there is: after a fault the one that was probably meant, so that all else is read by it."""
    table = Table(entry, f"bodies.{name}", BODY, faults)
    motion = table.one_of("motion", "pivot")
    guessed = next((likely for key, likely in LIKELY.items() if key in table), "fixed")
    if "motion" not in table:
        return {**table.mapping, **_forgotten(table)}
    return {**table.mapping, "motion": motion or guessed}


def _forgotten(table: Table) -> dict[str, str]:
    """The motion of a body that does not give it and would make no sense without; it is noted."""
    for key, motion, beside, excluding in FORGOTTEN:
        if key in table and beside in table and excluding not in table:
            table.fault(key, f'belongs to motion = "{motion}", which is not written; a body turns unless motion says otherwise')
            return {"motion": motion}
    return {}


def _drawing_path(entry: object, folder: Path) -> Path | None:
    name = entry.get("drawing") if isinstance(entry, dict) else None
    return folder / name if isinstance(name, str) else None


def _bores_elsewhere(entry: Mapping[str, Any], bores: Counter[str]) -> frozenset[str]:
    """The layers that other bodies of the same drawing name as bores; `bores` counts the bodies that name each."""
    own = set(bored(entry))
    return frozenset(layer for layer, bodies in bores.items() if bodies > (layer in own))


def _read(
    mapping: Mapping[str, Any],
    name: str,
    folder: Path,
    users: Counter[Path | None],
    bores: Mapping[Path | None, Counter[str]],
    faults: Faults,
    made: Made,
) -> _Read:
    """What one table says and its drawing holds. Everything is read even after a fault, so that all are found at once."""
    motion = motion_of(mapping, name)
    table = Table(mapping[name], f"bodies.{name}", BODY, faults, motion)
    if "." in name or not name:
        table.fault("", "a body's name must not be empty or contain a point: paths such as bodies.lever.angle use it")
    path = _drawing_path(mapping[name], folder)
    outlines = read_outlines(table, folder, made)
    shared = users[path] > 1
    inertias = read_inertias(table, motion, outlines, _bores_elsewhere(mapping[name], bores[path]) if shared else frozenset())
    return _Read(name, table, motion, outlines, inertias, path, shared and path is not None)


def _position(one: _Read, read: Mapping[str, _Read]) -> Point:
    """Where the body's origin sits in the movement, or on its carrier; "as drawn" where that is in the drawing.

    Bodies of one drawing are an assembly, drawn in place: as drawn unless the scene says otherwise.
    """
    table, carrier = one.table, read.get(str(one.table.mapping.get("on")))
    if "position" in table and table.mapping["position"] != AS_DRAWN:
        if isinstance(table.mapping["position"], str):
            table.fault("position", f'write ["1 mm", "0 mm"], or "{AS_DRAWN}"', with_value=True)
            return (NAN, NAN)
        return table.pair("position")
    together = carrier is None or carrier.path == one.path
    if "position" in table and (one.path is None or not together):
        why = "has no drawing" if one.path is None else f"is not in the drawing of {table.mapping.get('on')}, which carries it"
        table.fault("position", f"the body {why}: give its coordinates", with_value=True)
    if one.path is None or not together or not ("position" in table or one.shared):
        return (0.0, 0.0)
    (x, y), (x0, y0) = one.inertias.origin, carrier.inertias.origin if carrier else (0.0, 0.0)
    return (x - x0, y - y0)


def _with_play(table: Table, position: Point) -> Point:
    """Where the pivot lies in its hole: half of the play off, to one side."""
    if "side" in table and "play" not in table:
        table.fault("side", 'says where the pivot lies in its play: write play = "10 µm" as well')
    off, side = 0.5 * table.quantity("play"), table.quantity("side")
    return (position[0] + off * math.cos(side), position[1] + off * math.sin(side)) if off else position


def _body(one: _Read, position: Point, on: str | None) -> Body:
    table, motion, outlines, inertias = one.table, one.motion, one.outlines, one.inertias
    angle = table.quantity("angle")
    table.note_motion(DRIVEN if table.mapping.get("motion") == DRIVEN else motion)
    prescribed = read_prescribed(table, angle if motion == "pivot" else 0.0)
    shift = (-inertias.origin[0], -inertias.origin[1])
    rest = outlines.drawn if outlines.drawn is not None else () if one.shared else outlines.rest
    return Body(
        name=one.name,
        motion=motion,
        position=position,
        angle=angle,
        velocity=(prescribed.velocity,) if prescribed else _velocity(table, motion),
        axis=_axis(table, motion),
        mass=inertias.mass,
        inertia=inertias.inertia,
        centre_of_mass=inertias.centre,
        loops=_shifted(outlines.loops, shift),
        decoration=(*_shifted(rest, shift), *more_seen(inertias.solids, {loop.layer for loop in outlines.loops})),
        solids=inertias.solids,
        on=on,
        prescribed=prescribed.law if prescribed else None,
    )


def _carrier(table: Table, name: str, bodies: Mapping[str, Any]) -> str | None:
    """The name of the body that carries this one; None without, or where there is no such body."""
    if "on" not in table:
        return None
    on = table.text("on")
    if on in bodies and on != name:
        return on
    if isinstance(table.mapping["on"], str):
        others = [other for other in bodies if other != name]
        complaint = "a body cannot carry itself" if on == name else f"there is no such body. {nearest(on, others)}"
        table.fault("on", complaint, with_value=True)
    return None


def _shifted(loops: tuple[Loop, ...], shift: Point) -> tuple[Loop, ...]:
    return tuple(loop.moved(0.0, shift) for loop in loops)


def _velocity(table: Table, motion: str) -> tuple[float, ...]:
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
        return (1.0, 0.0)
    if "axis" not in table:
        table.fault("", "a sliding body needs its direction. Write e.g. axis = [1.0, 0.0]")
    x, y = table.pair("axis", (NAN, NAN))
    length = math.hypot(x, y)
    if length == 0.0:
        table.fault("axis", "a direction of length zero points nowhere", with_value=True)
        return (NAN, NAN)
    return (x / length, y / length)
