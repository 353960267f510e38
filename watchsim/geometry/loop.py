"""What is a sound outline?

A chain of edges, each starting where the one before ends; closed, it bounds material on its left: an outer outline
runs counter-clockwise, a hole clockwise.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.geometry.primitives import Edge, Point, moved, reflected


@dataclass(frozen=True, slots=True)
class Loop:
    """An oriented chain of edges in metres, with the layer it was drawn on.

    `closed` False marks an open chain; `hole` True a loop that bounds the inside of another one.
    """

    edges: tuple[Edge, ...]
    layer: str = "0"
    closed: bool = True
    hole: bool = False

    @property
    def length(self) -> float:
        return sum(edge.length for edge in self.edges)

    def reversed(self) -> Loop:
        edges = tuple(edge.reversed() for edge in reversed(self.edges))
        return Loop(edges, self.layer, self.closed, self.hole)

    def moved(self, angle: float, shift: Point) -> Loop:
        """Turned by `angle` (radians) about the origin, then shifted (metres)."""
        return Loop(tuple(moved(edge, angle, shift) for edge in self.edges), self.layer, self.closed, self.hole)

    def reflected(self, foot: Point, direction: Point) -> Loop:
        """Its image across the line through `foot` along the unit vector `direction`, still with the material on the left."""
        edges = tuple(reflected(edge, foot, direction).reversed() for edge in reversed(self.edges))
        return Loop(edges, self.layer, self.closed, self.hole)
