"""How are the solids of a body read?

Each entry of [[bodies.NAME.solids]] is a plate, or `turned`, or a `hairspring`; which keys belong to which is said once, here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from watchsim.geometry.hairspring import SHARE, Spiral, drawn_strip, ribbon, spiral_of_length
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line, Point
from watchsim.geometry.solids import Section, mass_properties, section, turned, upright
from watchsim.scene.keys import SOLID
from watchsim.scene.outlines import Outlines
from watchsim.scene.read_bores import bores_of_plate
from watchsim.scene.solids import HAIRSPRING, LYING, PLATE, UPRIGHT, Solid, Weight
from watchsim.scene.values import Table

SPIRAL = ("inner", "outer", "turns", "length")
SPRING_KEYS = (*SPIRAL, "width")
LENGTHS = {"inner": "0.6 mm", "outer": "2.6 mm", "width": "0.03 mm", "thickness": "0.12 mm", "density": "7.85 g/cm³"}


def read_solids(table: Table, outlines: Outlines) -> tuple[Solid, ...]:
    """The solids of a body in the coordinates of its drawing; faults go to the table, and what has one is left out."""
    found = []
    for i, mapping in enumerate(table.tables("solids")):
        entry = Table(mapping, f"{table.path}.solids.{i}", SOLID, table.faults)
        solid = _Reader(entry, outlines).solid() if entry.is_table else None
        found += [solid] if solid else []
    return tuple(found)


class _Reader:
    """Reads one entry; every fault is noted at once."""

    def __init__(self, entry: Table, outlines: Outlines) -> None:
        self.entry, self.outlines = entry, outlines
        self.pivot = outlines.pivot or (0.0, 0.0)

    def solid(self) -> Solid | None:
        known = len(self.entry.faults.found)
        spring = self._flag("hairspring", any(key in self.entry for key in SPRING_KEYS))
        lying = self._flag("lying", "turned" in self.entry)
        self._note_strangers(spring)
        density = self._positive("density")
        if spring and "turned" not in self.entry:
            made = self._spring(density)
        elif "turned" in self.entry:
            made = self._turned(density, lying)
        else:
            made = self._plate(density) if "lying" not in self.entry else None
        return made if len(self.entry.faults.found) == known else None

    def _note_strangers(self, spring: bool) -> None:
        """Keys that do not go together."""
        entry = self.entry
        if not spring and (idle := [key for key in SPRING_KEYS if key in entry]):
            what = f"{', '.join(idle)} belong" if len(idle) > 1 else "belongs"
            cure = f"write hairspring = true as well, or leave {'them' if len(idle) > 1 else 'it'} out"
            entry.fault(idle[0], f"{what} to a hairspring: {cure}", with_value=True)
        if "lying" in entry and "turned" not in entry:
            entry.fault("lying", "belongs to a turned solid: write turned as well, or leave it out", with_value=True)
        if "bores" in entry and (spring or "turned" in entry):
            what = "a hairspring has none" if spring else "those of a turned solid are drawn in its half profile"
            entry.fault("bores", f"belongs to a plate: {what}. Leave bores out", with_value=True)
        if "turned" in entry and spring:
            entry.fault("turned", "a solid is a hairspring or turned, not both: leave out one of them")
        if "turned" in entry and "thickness" in entry:
            entry.fault("thickness", "a turned solid has its size from its profile: leave thickness out", with_value=True)

    def _plate(self, density: float) -> Solid | None:
        thickness, count, loops = self._positive("thickness"), self._count(), self._closed()
        bores = bores_of_plate(self.entry, self.outlines, loops) if "bores" in self.entry else ()
        if any(loop in self.outlines.loops for loop in loops) and count > 1:
            self.entry.fault(
                "count", "this layer can touch, and nothing could touch the copies: draw them all", with_value=True
            )
        if not loops or math.isnan(thickness) or math.isnan(density):
            return None
        loops += bores
        try:
            found = mass_properties(loops, thickness, density)
        except ValueError as error:
            self.entry.fault("", str(error))
            return None
        weight = Weight(found.mass, found.centre, found.inertia_about(found.centre)).repeated(count, self.pivot)
        named = self.entry.texts("bores") if bores else ()
        return Solid(PLATE, self._layer(), weight, density, loops, thickness, self.pivot, count, bores=named)

    def _turned(self, density: float, lying: bool) -> Solid | None:
        count, axis = self._count(), self._axis()
        if "layer" not in self.entry:
            self.entry.fault("", 'layer is missing: on which one is the half profile? Write e.g. layer = "STAFF"')
            return None
        if count > 1 and not lying:
            self.entry.fault("count", "it stands on the pivot, where there is room for one: leave count out", with_value=True)
        loops = self._closed()
        if not loops or axis is None or math.isnan(density):
            return None
        try:
            body = turned(loops, *axis)
            profile = loops if lying else upright(loops, *axis)
        except ValueError as error:
            self.entry.fault("turned", str(error))
            return None
        mass = density * body.volume
        if lying:
            (fx, fy), (dx, dy) = axis
            there = (fx + body.centre * dx, fy + body.centre * dy)
            weight = Weight(mass, there, density * body.transverse).repeated(count, self.pivot)
        else:
            weight = Weight(mass, self.pivot, density * body.axial)
        return Solid(LYING if lying else UPRIGHT, self._layer(), weight, density, profile, 0.0, self.pivot, count, axis)

    def _spring(self, density: float) -> Solid | None:
        entry, height = self.entry, self._positive("thickness")
        if "count" in entry:
            entry.fault("count", "a body has as many hairsprings as entries: leave count out", with_value=True)
        if "layer" in entry:
            for key in SPIRAL:
                if key in entry:
                    entry.fault(key, "the hairspring is drawn on a layer: leave out layer, or the numbers", with_value=True)
            strip, loops, spiral = *self._drawn_strip(), None
        else:
            strip, loops, spiral = self._spiral()
        if strip is None or math.isnan(height) or math.isnan(density):
            return None
        surface = SHARE * height * density
        # It moves along with one third of its mass, breathing about the axis: it does not pull the balance out of poise.
        weight = Weight(surface * strip.area, self.pivot, surface * strip.about((0.0, 0.0) if spiral else self.pivot).polar)
        width = entry.quantity("width") if "width" in entry else 0.0
        return Solid(HAIRSPRING, self._layer(), weight, density, loops, height, self.pivot, spiral=spiral, width=width)

    def _spiral(self) -> tuple[Section | None, tuple[Loop, ...], Spiral | None]:
        entry = self.entry
        inner, outer, width = (self._positive(key) for key in ("inner", "outer", "width"))
        given = [key for key in ("turns", "length") if key in entry]
        if len(given) != 1:
            word = "both are given: leave out one" if given else 'missing. Write e.g. turns = 12, or length = "120 mm"'
            entry.fault(given[-1] if given else "", f"turns or length: {word}")
            return None, (), None
        amount = self._positive(given[0])
        if outer <= inner:
            entry.fault("outer", "must be larger than inner", with_value=True)
        if not outer > inner or math.isnan(width) or math.isnan(amount):
            return None, (), None
        try:
            spiral = Spiral(inner, outer, amount) if given == ["turns"] else spiral_of_length(inner, outer, amount)
        except ValueError as error:
            entry.fault("length", str(error), with_value=True)
            return None, (), None
        if not width < spiral.pitch or not 0.5 * width < inner:
            room = min(spiral.pitch, 2.0 * inner)
            entry.fault(
                "width", f"there are only {1e3 * room:.4g} mm of room for the strip: its coils would overlap", with_value=True
            )
            return None, (), None
        return spiral.strip(width), (), spiral

    def _drawn_strip(self) -> tuple[Section | None, tuple[Loop, ...]]:
        """The strip from its outline, or from its centre line and its width."""
        entry, layer = self.entry, self._layer()
        closed = tuple(loop for loop in self.outlines.all if loop.closed and loop.layer == layer)
        lines = tuple(chain for chain in self.outlines.chains if chain.layer == layer)
        if closed:
            if "width" in entry:
                entry.fault("width", "the outline of the strip is drawn and has its width: leave width out", with_value=True)
            return section(self._closed()), closed
        if len(lines) != 1:
            if self.outlines.sound:
                seen = f"{len(lines)} separate lines are" if lines else "nothing is"
                entry.fault(
                    "layer", f"{seen} on this layer; draw the strip's outline, or one unbroken centre line", with_value=True
                )
            return None, ()
        width = self._positive("width")
        try:
            return (
                (None, ())
                if math.isnan(width)
                else (drawn_strip(lines[0], width), tuple(ribbon(e, width) for e in lines[0].edges))
            )
        except ValueError as error:
            entry.fault("width", str(error), with_value=True)
            return None, ()

    def _axis(self) -> tuple[Point, Point] | None:
        """A point of the axis and its direction: from a layer with one straight line, or from two points."""
        entry, value = self.entry, self.entry.mapping["turned"]
        if isinstance(value, str):
            lines = [chain.edges[0] for chain in self.outlines.chains if chain.layer == value and len(chain.edges) == 1]
            straight = [edge for edge in lines if isinstance(edge, Line)]
            if len(straight) != 1:
                if self.outlines.sound:
                    seen = f"{len(straight)} straight lines are" if straight else "no straight line by itself is"
                    entry.fault("turned", f"{seen} on this layer; the axis is one line", with_value=True)
                return None
            return straight[0].start, straight[0].tangent(0.0)
        if not isinstance(value, Sequence) or len(value) != 2:
            entry.fault(
                "turned",
                'a layer with the axis is needed here, or two points of it: turned = [["0 mm", "0 mm"], ["0 mm", "5 mm"]]',
                with_value=True,
            )
            return None
        a, b = (entry.point(f"turned.{k}", point, entry.dimension("turned")) for k, point in enumerate(value))
        length = math.dist(a, b)
        if length == 0.0:
            entry.fault("turned", "its two points are the same")
        return (a, ((b[0] - a[0]) / length, (b[1] - a[1]) / length)) if length > 0.0 else None

    def _closed(self) -> tuple[Loop, ...]:
        """The closed outlines of the layer, by default those that can touch."""
        closed = tuple(loop for loop in self.outlines.all if loop.closed)
        layer = self._layer()
        if not isinstance(self.entry.mapping.get("layer", ""), str):  # that has been noted
            return ()
        if "layer" not in self.entry:
            loops = tuple(loop for loop in self.outlines.loops if loop.closed)
            if not loops and self.outlines.sound:
                self.entry.fault("", 'the body has no closed outline to make a plate of. Write layer = "..." or draw one')
            return loops
        broken = [finding for finding in self.outlines.errors if finding.layer == layer]
        for finding in broken:
            self.entry.fault("layer", f"{finding.message.rstrip('.')}. {finding.fix}".strip(), with_value=True)
        loops = tuple(loop for loop in closed if loop.layer == layer)
        if not loops and not broken and self.outlines.sound:
            there = ", ".join(dict.fromkeys(loop.layer for loop in closed)) or "none"
            self.entry.fault(
                "layer", f"no closed outline is on this layer. There are closed outlines on: {there}", with_value=True
            )
        return loops

    def _layer(self) -> str:
        return self.entry.text("layer")

    def _flag(self, key: str, likely: bool) -> bool:
        """True or false; after a fault what is `likely`, by which all else is read."""
        value = self.entry.mapping.get(key, False)
        if isinstance(value, bool):
            return value
        self.entry.fault(key, "true or false is needed here, without quotes", with_value=True)
        return likely

    def _positive(self, key: str) -> float:
        """A quantity that must be there and above zero; not-a-number after a fault."""
        if key not in self.entry:
            self.entry.fault("", f'{key} is missing. Write e.g. {key} = "{LENGTHS[key]}"')
            return math.nan
        return self.entry.quantity(key, math.nan)

    def _count(self) -> int:
        value = self.entry.quantity("count")
        return 1 if math.isnan(value) else int(value)
