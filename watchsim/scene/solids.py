"""What is one solid of a body?

A plate (outlines with a thickness), a turned part (a half profile and its axis) or a hairspring. A body has the mass of all
of its solids.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterable
from dataclasses import dataclass, replace

from watchsim.geometry.hairspring import Spiral
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point
from watchsim.geometry.solids import upright

PLATE, UPRIGHT, LYING, HAIRSPRING = "plate", "upright", "lying", "hairspring"


@dataclass(frozen=True, slots=True)
class Weight:
    """Mass (kg), centre of mass (m) and moment of inertia (kg·m²) about the line through that centre square to the drawing."""

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

    def repeated(self, count: int, pivot: Point) -> Weight:
        """`count` of it, spread evenly about `pivot`."""
        return self if count == 1 else Weight(count * self.mass, pivot, count * self.about(pivot))


@dataclass(frozen=True, slots=True)
class Solid:
    """One solid, SI, in the coordinates of its body (of the drawing while it is read).

    `weight` counts all copies, which are spread evenly about `pivot`, and of a hairspring its share. `loops` are the outlines
    of a plate, with what is taken out of it on the layers `bores` as holes, or of a hairspring's strip, or the half profile of
    a turned part; `axis` is a point and the unit direction of a turned part's axis. An upright part stands on the pivot: its
    loops have the axis along x. `spiral` and `width` describe a hairspring that is not drawn.
    """

    kind: str
    layer: str
    weight: Weight
    density: float
    loops: tuple[Loop, ...] = ()
    thickness: float = 0.0
    pivot: Point = (0.0, 0.0)
    count: int = 1
    axis: tuple[Point, Point] = ((0.0, 0.0), (1.0, 0.0))
    spiral: Spiral | None = None
    width: float = 0.0
    bores: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The layer it is drawn on; what it is where it is not, or on all layers that touch."""
        return self.layer or self.kind

    @property
    def drilled(self) -> tuple[Loop, ...]:
        """The bores of other layers that are taken out, as holes."""
        return tuple(loop for loop in self.loops if loop.layer in self.bores)

    def shifted(self, shift: Point) -> Solid:
        """The same solid in coordinates whose origin lies at minus `shift`."""
        (x, y), (dx, dy) = self.weight.centre, shift
        weight = Weight(self.weight.mass, (x + dx, y + dy), self.weight.inertia)
        pivot = (self.pivot[0] + dx, self.pivot[1] + dy)
        if self.kind == UPRIGHT:
            return replace(self, weight=weight, pivot=pivot)
        (fx, fy), direction = self.axis
        loops = tuple(loop.moved(0.0, shift) for loop in self.loops)
        return replace(self, weight=weight, pivot=pivot, loops=loops, axis=((fx + dx, fy + dy), direction))

    def upright_profile(self) -> tuple[Loop, ...]:
        """A turned part's half profile with its axis along x, the point of its axis at the origin."""
        return self.loops if self.kind == UPRIGHT else upright(self.loops, *self.axis)

    def copies(self, loops: Iterable[Loop], first: int = 0) -> list[Loop]:
        """The loops at the places `first` to `count` - 1 about the pivot."""
        (x, y), shapes = self.pivot, list(loops)
        steps = [math.tau * k / self.count for k in range(first, self.count)]
        return [loop.moved(0.0, (-x, -y)).moved(step, (x, y)) for step in steps for loop in shapes]


def more_seen(solids: tuple[Solid, ...], touchable: Container[str] = ()) -> tuple[Loop, ...]:
    """What pictures show besides the outlines as drawn: bores, copies, and both halves of turned parts that lie.

    A bore is not seen where something fills it: another solid of its layer, or an outline of a `touchable` layer.
    """
    found: list[Loop] = []
    filled = {solid.layer for solid in solids}
    for solid in solids:
        if solid.kind == LYING:
            found += solid.copies([*solid.loops, *(loop.reflected(*solid.axis) for loop in solid.loops)])
        elif solid.kind == PLATE:
            empty = {layer for layer in solid.bores if layer not in filled and layer not in touchable}
            found += [loop for loop in solid.loops if loop.layer in empty]
            found += solid.copies(
                (loop for loop in solid.loops if loop.layer in empty or loop.layer not in solid.bores), first=1
            )
    return tuple(dict.fromkeys(found))


def total(solids: tuple[Solid, ...]) -> Weight | None:
    """All of them together; None where there are none."""
    weight: Weight | None = None
    for solid in solids:
        weight = solid.weight if weight is None else weight.joined(solid.weight)
    return weight
