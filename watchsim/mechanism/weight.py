"""How heavy is a body, and where is its centre of mass?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.geometry.loop import Loop
from watchsim.geometry.mass import mass_properties
from watchsim.geometry.primitives import Point
from watchsim.mechanism.outlines import Outlines
from watchsim.mechanism.schema import SOLID
from watchsim.mechanism.table import Table


@dataclass(frozen=True, slots=True)
class Weight:
    """Mass (kg), centre of mass (m, coordinates of the drawing) and inertia about that centre (kg·m²)."""

    mass: float
    centre: Point
    inertia: float

    def about(self, point: Point) -> float:
        """Inertia about another point (Steiner)."""
        return self.inertia + self.mass * math.dist(point, self.centre) ** 2

    def joined(self, other: Weight) -> Weight:
        mass = self.mass + other.mass
        x, y = ((self.mass * a + other.mass * b) / mass for a, b in zip(self.centre, other.centre, strict=True))
        return Weight(mass, (x, y), self.about((x, y)) + other.about((x, y)))

    def scaled(self, mass: float) -> Weight:
        """The same shape with another mass."""
        return Weight(mass, self.centre, self.inertia * mass / self.mass)


@dataclass(frozen=True, slots=True)
class Inertias:
    """What the motion needs: `origin` is the point of the drawing that becomes the origin of the body's frame."""

    origin: Point
    mass: float
    inertia: float
    centre: Point


def read_inertias(table: Table, motion: str, outlines: Outlines) -> Inertias:
    """Mass and inertia from the keys of a body or from its solids; a moving body without is a fault."""
    weight = _weight(table, motion, outlines)
    _note_conflicts(table, motion, outlines)
    origin = outlines.pivot or ((weight.centre if weight else (0.0, 0.0)) if motion == "free" else (0.0, 0.0))
    mass = table.quantity("mass", weight.mass if weight else 0.0)
    inertia = table.quantity("inertia", _shape_inertia(weight, motion, origin))
    centre = weight.centre if weight and motion != "free" else origin
    inertias = Inertias(origin, mass, inertia, (centre[0] - origin[0], centre[1] - origin[1]))
    _note_massless(table, motion, inertias, outlines)
    return inertias


def _weight(table: Table, motion: str, outlines: Outlines) -> Weight | None:
    """From the solids; else, where the motion asks for it, a uniform plate of the outlines with the mass that was given."""
    if "solids" in table:
        return _solids(table, outlines)
    closed = tuple(loop for loop in outlines.loops if loop.closed)
    wanted = motion == "free" or (motion == "pivot" and "mass" in table)
    if not closed or not outlines.sound or not wanted:
        return None
    plate = _plate(table, closed, 1.0, 1.0)
    return plate.scaled(table.quantity("mass")) if plate else None


def _solids(table: Table, outlines: Outlines) -> Weight | None:
    total: Weight | None = None
    for i, mapping in enumerate(table.tables("solids")):
        solid = Table(mapping, f"{table.path}.solids.{i}", SOLID, table.faults)
        thickness = solid.positive("thickness", "it is the height of the plate") if _has(solid, "thickness", "0.12 mm") else 0.0
        density = solid.positive("density", "steel has 7.85 g/cm³") if _has(solid, "density", "7.85 g/cm³") else 0.0
        loops = _layer_loops(solid, outlines)
        if loops and thickness > 0.0 and density > 0.0:
            part = _plate(solid, loops, thickness, density)
            total = total.joined(part) if total and part else part or total
    return total


def _has(solid: Table, key: str, example: str) -> bool:
    if key not in solid:
        solid.fault("", f'{key} is missing. Write e.g. {key} = "{example}"')
    return key in solid


def _layer_loops(solid: Table, outlines: Outlines) -> tuple[Loop, ...]:
    closed = tuple(loop for loop in outlines.all if loop.closed)
    if "layer" not in solid:
        return tuple(loop for loop in outlines.loops if loop.closed)
    layer = solid.text("layer")
    loops = tuple(loop for loop in closed if loop.layer == layer)
    if not loops and outlines.sound:
        there = ", ".join(dict.fromkeys(loop.layer for loop in closed)) or "none"
        solid.fault("layer", f"no closed outline is on this layer. There are closed outlines on: {there}", with_value=True)
    return loops


def _plate(table: Table, loops: tuple[Loop, ...], thickness: float, density: float) -> Weight | None:
    """Mass properties of a plate with those outlines (holes taken out)."""
    try:
        found = mass_properties(loops, thickness, density)
    except ValueError as error:
        table.fault("", str(error))
        return None
    return Weight(found.mass, found.centre, found.inertia_about(found.centre))


def _shape_inertia(weight: Weight | None, motion: str, origin: Point) -> float:
    if weight is None:
        return 0.0
    return weight.inertia if motion == "free" else weight.about(origin)


def _note_conflicts(table: Table, motion: str, outlines: Outlines) -> None:
    if "mass" in table and "solids" in table:
        table.fault("mass", "the solids say the mass already: leave out mass or solids")
    if motion == "free" and "solids" in table and outlines.pivot is not None:
        table.fault("pivot", "a free body turns about its centre of mass, which the solids give: leave out pivot or solids")


def _note_massless(table: Table, motion: str, inertias: Inertias, outlines: Outlines) -> None:
    """A moving body that nothing holds back has no acceleration; a fault only where no other fault is the reason."""
    needs = {"pivot": ("inertia",), "slide": ("mass",), "free": ("mass", "inertia")}.get(motion, ())
    promised = bool(table.mapping.get("solids")) or ("mass" in table and (outlines.loops or not outlines.sound))
    for key, value, example in (("mass", inertias.mass, "1 mg"), ("inertia", inertias.inertia, "0.05 mg·cm²")):
        if key in table and value < 0.0:
            table.fault(key, "must not be negative", with_value=True)
        elif key in needs and value == 0.0 and (key in table or not promised):
            why = f"the body can move ({motion}) but has no {key}"
            advice = f'Write {key} = "{example}" or give thickness and density in [[{table.path}.solids]]'
            table.fault(key if key in table else "", f"{why}. {advice}", with_value=key in table)
