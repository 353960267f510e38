"""How heavy is a hairspring, and how is its mass spread about the balance's axis?

A strip of uniform section along a centre line: an Archimedean spiral given by numbers, or lines and arcs as drawn. For a
centre line r(s) with its left normal n and curvature κ, the strip of width b has the area b L and the polar moment
b ∫ r² ds + b³/12 ∫ (1 - 2 κ r·n) ds. On a circle about the axis the last integral is 3 L; on a spiral of pitch angle α it
differs by tan⁴α, which is below 1e-9 of the whole for any hairspring and is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point
from watchsim.geometry.solids import Section, section

# The shape of a hairspring whose inner end has been turned, for pictures. At rest it is an Archimedean spiral from collet to
# stud. Turned, it keeps both ends and its length to first order: the radius stays linear in the share of the way but for a
# bulge k x (1 - x), so that its mean grows as the spring unwinds and shrinks as it is wound up: it breathes. A real one bends
# off its centre a little, too, which is left out.

Array = NDArray[np.float64]

LEAST = 0.25  # turns that are left at any rate
STEEPEST = 0.95  # of the way from collet to stud: the bulge; with more, coils would cross
PER_TURN = (24, 180)  # chords, at least and at most


@dataclass(frozen=True, slots=True)
class Coil:
    """A flat spiral about a pivot, m and rad: it leaves the collet at radius `inner` and winds counter-clockwise through so
    many `turns` to the stud, at radius `outer` in the direction `stud` of the frame that holds it. `width` is its strip's."""

    inner: float
    outer: float
    turns: float
    stud: float
    width: float

    def chords(self, deviation: float) -> int:
        """How many it takes so that none strays more than `deviation` (m) from the coil."""
        least, most = PER_TURN
        fitting = math.tau / math.sqrt(8.0 * deviation / self.outer)
        return math.ceil(min(max(fitting, least), most) * self.turns)

    def line(self, turned: float, chords: int) -> Array:
        """(chords + 1, 2) points from collet to stud, the collet `turned` (rad, counter-clockwise) from where it rests."""
        swept = max(math.tau * self.turns - turned, math.tau * LEAST)
        share = np.linspace(0.0, 1.0, 1 + chords)
        angle = self.stud - swept * (1.0 - share)
        radius = self.inner + share * (self.outer - self.inner) + self.bulge(turned) * share * (1.0 - share)
        return np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))

    def bulge(self, turned: float) -> float:
        """k, m: the mean radius (inner + outer) / 2 + k / 6 times the angle wound through stays what it is at rest."""
        rest, way = math.tau * self.turns, self.outer - self.inner
        swept = max(rest - turned, math.tau * LEAST)
        return min(max(3.0 * (self.inner + self.outer) * (rest / swept - 1.0), -STEEPEST * way), STEEPEST * way)


SHARE = 1.0 / 3.0  # of its inertia, and of its mass, that a spring held at one end adds to what it drives (Rayleigh)
CHORDS = 48  # per turn, where the spiral is drawn


@dataclass(frozen=True, slots=True)
class Spiral:
    """The centre line r = inner + (outer - inner) φ / (2π turns), metres, about the axis of the balance."""

    inner: float
    outer: float
    turns: float

    @property
    def pitch(self) -> float:
        """Metres from one coil to the next."""
        return (self.outer - self.inner) / self.turns

    @property
    def length(self) -> float:
        """∫ √(r² + a²) dφ with a = pitch / 2π, metres."""
        a = self.pitch / math.tau
        return 0.5 * a * (_arc_length(self.outer / a) - _arc_length(self.inner / a))

    @property
    def second(self) -> float:
        """∫ r² ds, m³."""
        a = self.pitch / math.tau
        return 0.125 * a**3 * (_second(self.outer / a) - _second(self.inner / a))

    def strip(self, width: float) -> Section:
        """The area seen from above (m²) and its polar moment about the axis (m⁴); it counts as poised."""
        return Section((0.0, 0.0), width * self.length, polar=width * self.second + 0.25 * width**3 * self.length)

    def outline(self, width: float) -> Loop:
        """The strip as a closed polygon, for pictures."""
        steps = math.ceil(CHORDS * self.turns)
        sides = []
        for side, order in ((0.5, range(steps + 1)), (-0.5, range(steps, -1, -1))):
            for k in order:
                r, angle = self.inner + (self.outer - self.inner) * k / steps + side * width, math.tau * self.turns * k / steps
                sides.append((r * math.cos(angle), r * math.sin(angle)))
        return Loop(tuple(Line(*a, *b) for a, b in zip(sides, sides[1:] + sides[:1], strict=True)), "hairspring")


def _arc_length(x: float) -> float:
    return x * math.hypot(1.0, x) + math.asinh(x)


def _second(x: float) -> float:
    return x * (2.0 * x * x + 1.0) * math.hypot(1.0, x) - math.asinh(x)


def spiral_of_length(inner: float, outer: float, length: float) -> Spiral:
    """The spiral between two radii whose centre line has that length; ValueError where a straight strip would be longer."""
    if not length > outer - inner:
        raise ValueError("a strip this short does not even reach from the inner to the outer radius")
    fewest, most = 0.0, length / (math.pi * (inner + outer))  # without its slope the spiral would be shorter
    for _ in range(100):
        turns = 0.5 * (fewest + most)
        if turns <= fewest or turns >= most:
            break
        fewest, most = (turns, most) if Spiral(inner, outer, turns).length < length else (fewest, turns)
    return Spiral(inner, outer, most)


def drawn_strip(chain: Loop, width: float) -> Section:
    """Area and moments of the strip whose centre line is an open chain of lines and arcs; exact edge by edge."""
    return section(ribbon(edge, width) for edge in chain.edges)


def ribbon(edge: Edge, width: float) -> Loop:
    """The outline of the strip along one edge, counter-clockwise; ValueError where an arc is too narrow for the strip."""
    if isinstance(edge, Line):
        tx, ty = edge.tangent(0.0)
        dx, dy = -0.5 * width * ty, 0.5 * width * tx
        right, left = (
            Line(edge.x0 - dx, edge.y0 - dy, edge.x1 - dx, edge.y1 - dy),
            Line(edge.x1 + dx, edge.y1 + dy, edge.x0 + dx, edge.y0 + dy),
        )
        return _framed(right, left)
    if not edge.radius > 0.5 * width:
        raise ValueError(f"a strip {1e3 * width:.4g} mm wide cannot follow an arc of radius {1e3 * edge.radius:.4g} mm")
    arc = edge if edge.sweep > 0.0 else edge.reversed()
    outer = Arc(arc.x, arc.y, arc.radius + 0.5 * width, arc.start_angle, arc.sweep)
    inner = Arc(arc.x, arc.y, arc.radius - 0.5 * width, arc.start_angle, arc.sweep).reversed()
    return _framed(outer, inner)


def _framed(first: Edge, second: Edge) -> Loop:
    a: Point = first.end
    return Loop((first, Line(*a, *second.start), second, Line(*second.end, *first.start)), "hairspring")
