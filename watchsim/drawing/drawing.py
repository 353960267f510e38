"""What does a drawing hold once it is read?"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from watchsim.drawing.findings import Facts
from watchsim.geometry.loops import Loop
from watchsim.geometry.solids import MassProperties, Section, mass_properties, section

SNAP = 1e-6  # m
Path2D = Any  # a trimesh.path.Path2D


@dataclass(frozen=True)
class Profile:
    """Closed `loops` (outer ones counter-clockwise, holes clockwise) and open `chains`, in metres, apart from any file.

    Outlines are exchanged with other programs in this form: lines and arcs stay lines and arcs.
    """

    loops: tuple[Loop, ...] = ()
    chains: tuple[Loop, ...] = ()

    def __repr__(self) -> str:
        layers = ", ".join(self.layers) or "no layer"
        return f"<Profile: {len(self.loops)} closed outlines, {len(self.chains)} open chains on {layers}>"

    @property
    def layers(self) -> tuple[str, ...]:
        """The layers that hold an outline, in the order of the drawing."""
        return tuple(dict.fromkeys(loop.layer for loop in (*self.loops, *self.chains)))

    def only(self, *layers: str) -> Profile:
        """What lies on these layers."""
        loops, chains = ([loop for loop in part if loop.layer in layers] for part in (self.loops, self.chains))
        return Profile(tuple(loops), tuple(chains))

    def section(self) -> Section:
        """Area and moments of all closed loops (m², m³, m⁴)."""
        return section(self.loops)

    def mass_properties(self, thickness: float, density: float) -> MassProperties:
        """Of a plate of that thickness (m) and density (kg/m³); ValueError where there is no area."""
        return mass_properties(self.loops, thickness, density)

    def to_path2d(self) -> Path2D:
        """A `trimesh.path.Path2D` of the same lines and arcs, in millimetres (`path.units` says so), layers kept.

        trimesh keeps an arc as three points; it refuses to draw arcs of less than 0.7 degrees, though it holds them.
        """
        from watchsim.geometry.meshes import path2d

        return path2d((*self.loops, *self.chains))

    @classmethod
    def from_path2d(cls, path: Path2D, units: str | None = None, snap: float = SNAP) -> Profile:
        """The outlines of a path's lines and arcs, chained like those of a drawing: ends within `snap` metres are joined.

        `units` names the unit of the path where it does not say it itself. Raises ValueError where nobody does, for entities
        that are neither lines nor arcs, and where more than two edges meet in one point.
        """
        from watchsim.drawing.chaining import chain
        from watchsim.drawing.findings import Stroke
        from watchsim.geometry.meshes import edges_of

        strokes: list[Stroke] = []
        for number, (layer, edges) in enumerate(edges_of(path, _scale(path, units))):
            strokes += [Stroke(edge, layer, f"entity {number}", number) for edge in edges]
        chains = chain(strokes, snap)
        branches = [finding.message for finding in chains.findings if finding.code == "branch"]
        if branches:
            raise ValueError("; ".join(branches))
        return cls(chains.loops, chains.open_chains)


def _scale(path: Path2D, units: str | None) -> float:
    """Metres per unit of the path."""
    from watchsim.units import LENGTH, known_unit

    name = units or path.units
    if name is None:
        raise ValueError('the path does not say its units: give them, such as units = "mm"')
    unit = known_unit({"meters": "m", "inches": "inch", "millimeters": "mm"}.get(name, name))
    if unit.powers not in LENGTH.powers or not math.isfinite(unit.factor):
        raise ValueError(f'"{name}" is not a unit of length')
    return unit.factor


@dataclass(frozen=True)
class Drawing(Facts):
    """Everything read from one file: closed `loops`, material on the left, `open_chains`, and the `layers` with geometry."""

    path: Path = Path()
    loops: tuple[Loop, ...] = ()
    open_chains: tuple[Loop, ...] = ()
    layers: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<Drawing {self.path.name!r}, {len(self.findings)} findings: {self.profile!r}>"

    @property
    def profile(self) -> Profile:
        """All outlines, apart from the file; `drawing.profile.only("TEETH")` is that of one layer."""
        return Profile(self.loops, self.open_chains)
