"""About which point does a piece turn, as far as it shows by itself?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from watchsim.drawing.circles import circle_of
from watchsim.geometry.inside import winding
from watchsim.geometry.primitives import Point
from watchsim.proposal.bodies.piece import Piece
from watchsim.proposal.bodies.source import Mark
from watchsim.proposal.bodies.symmetry_centre import Turned

SAME = 2e-6  # m: two centres this close are one, as in drawings with three decimals of a millimetre
SHARE = 0.1  # of a piece's outline must lie on arcs about a mark for these to name its centre
MANY, DEEP = 8, 0.65  # a wheel: so many teeth, or slots so deep (least by largest radius) that it is no nut and no square stone

# How much a centre is worth
SURE, LIKELY, WEAK = 3, 2, 1


@dataclass(frozen=True)
class Centre:
    """A pivot: where, the mark that shows it, and why it is taken for one."""

    at: Point
    worth: int
    why: str
    mark: Mark | None = None

    def is_that_of(self, other: Centre) -> bool:
        return math.dist(self.at, other.at) <= SAME


def centre_of(piece: Piece, marks: Sequence[Mark]) -> Centre | None:
    """The centre that a piece shows: a mark with arcs about it, its own symmetry, the one mark in it, or its hole."""
    shares = [(sum(arc.length for arc in piece.arcs if math.dist((arc.x, arc.y), mark.at) <= SAME), mark) for mark in marks]
    best = max(shares, key=lambda pair: pair[0], default=(0.0, None))
    symmetry = piece.turned
    if best[1] is not None and best[0] >= SHARE * piece.length:
        return Centre(
            best[1].at, SURE, f"the drawing marks a point there, on layer {best[1].layer}, with arcs about it", best[1]
        )
    if symmetry is not None and is_toothed(symmetry):
        mark = next((one for one in marks if math.dist(one.at, symmetry.centre) <= SAME), None)
        at = symmetry.centre if mark is None else mark.at
        return Centre(at, SURE, f"the outline comes back onto itself {symmetry.fold} times in a turn about it", mark)
    inside = [mark for mark in marks if holds(piece, mark.at)]
    if len(inside) == 1:
        return Centre(inside[0].at, LIKELY, f"the one point of layer {inside[0].layer} that lies in its outline", inside[0])
    return None if marks else hole_of(piece)


def is_toothed(symmetry: Turned) -> bool:
    """Is it a wheel, with teeth or slots?"""
    return symmetry.fold >= MANY or (symmetry.fold >= 3 and symmetry.inner < DEEP * symmetry.outer)


def hole_of(piece: Piece) -> Centre | None:
    """The centre of the circular hole nearest to the centre of area."""
    circles = [circle for loop in piece.loops if loop.hole and (circle := circle_of(loop)) is not None]
    if not circles:
        return None
    nearest = min(circles, key=lambda circle: math.dist(circle.centre, piece.centroid))
    return Centre(nearest.centre, LIKELY, f"the centre of its hole of radius {1e3 * nearest.radius:.4g} mm")


def holds(piece: Piece, place: Point) -> bool:
    """Does an outer outline of the piece run round the place?"""
    return any(not loop.hole and winding(loop, place) != 0 for loop in piece.loops)
