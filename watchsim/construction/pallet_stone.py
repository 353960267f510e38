"""What is the outline of a stone: a prism with a slanted end, held in a slot?

In the frame of the part that holds it, millimetres.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.outline import fillet_chain, polar
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point


@dataclass(frozen=True)
class Stone:
    """A prism: `at(t, v)` is t along the working face, away from its tip, and v across, into the stone.

    The face runs from `tip` in the direction `face` (degrees); the material is to the right of it. `relief` is how far the
    end's other corner stands back.
    """

    tip: Point
    face: float
    width: float
    length: float
    relief: float

    def at(self, t: float, v: float) -> Point:
        ux, uy = polar(1.0, self.face)
        return (self.tip[0] + t * ux + v * uy, self.tip[1] + t * uy - v * ux)

    def loop(self, layer: str, edge: float) -> Loop:
        """Tip, end, back and face, counter-clockwise; the two edges of the shank rounded by `edge`."""
        corners = [
            self.tip,
            self.at(self.relief, self.width),
            self.at(self.length, self.width),
            self.at(self.length, 0.0),
        ]
        edges: list[Edge] = [Line(*corners[i], *corners[(i + 1) % 4]) for i in range(4)]
        return Loop(tuple(fillet_chain(edges, [0.0, edge, edge, 0.0], closed=True)), layer)
