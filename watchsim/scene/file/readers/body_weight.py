"""How heavy is a body, and where is its centre of mass?"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass

from watchsim.drawing.findings import Finding
from watchsim.geometry.primitives import Point
from watchsim.geometry.solids.mass import mass_properties
from watchsim.scene.file.keys.key_values import SMALLEST, TOO_SMALL, Table
from watchsim.scene.file.outlines.body_outlines import Outlines
from watchsim.scene.file.readers.bore_notices import bore_notices, uniform_notices
from watchsim.scene.file.readers.read_solids import read_solids
from watchsim.scene.solid import Solid, Weight, total


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
    _note_conflicts(table, motion, outlines)
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


def _note_conflicts(table: Table, motion: str, outlines: Outlines) -> None:
    if "mass" in table and "solids" in table:
        table.fault("mass", "the solids give the mass already: leave out mass or solids")
    if motion == "free" and "solids" in table and outlines.pivot is not None:
        table.fault("pivot", "a free body turns about its centre of mass, which the solids give: leave out pivot or solids")


def _note_massless(table: Table, motion: str, inertias: Inertias, outlines: Outlines) -> None:
    """A moving body that nothing holds back has no acceleration; a fault only where no other fault is the reason."""
    driven = table.mapping.get("motion") == "driven"  # needs no mass: it moves as prescribed
    needs = () if driven else {"pivot": ("inertia",), "slide": ("mass",), "free": ("mass", "inertia")}.get(motion, ())
    promised = table.mapping.get("solids", []) not in ([], ()) or ("mass" in table and (outlines.loops or not outlines.sound))
    for key, value, example in (("mass", inertias.mass, "1 mg"), ("inertia", inertias.inertia, "0.05 mg·cm²")):
        if key in table and 0.0 < value < SMALLEST:
            table.fault(key, TOO_SMALL, with_value=True)
        elif key in table and value < 0.0:
            table.fault(key, "must not be negative", with_value=True)
        elif key in needs and value == 0.0 and (key in table or not promised):
            why = f"the body can move ({motion}) but has no {key}"
            advice = f'Write {key} = "{example}" or give thickness and density in [[{table.path}.solids]]'
            table.fault(key if key in table else "", f"{why}. {advice}", with_value=key in table)
