"""Is there a pin that drives a slotted wheel, as in a Geneva drive, and what turns with it?

A pin by itself shows no pivot, and names say little: what one calls PLATEAU another calls DISCO or C. Two lengths decide. A
pin enters a slot along the slot, so that its distance from the crank's axis is sin(180°/slots) of the distance between the
axes; and it is as wide as the slot.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from watchsim.geometry.primitives import Point
from watchsim.proposal.pieces import SAME, SHARE, SURE, Centre, Mark, Piece, Turned, holds, hole_of, is_toothed, ring

FEWEST_SLOTS, MOST_SLOTS = 3, 12
ALONG = 0.03  # of the crank: by how much a pin may miss the circle on which it enters the slots along them
SNUG, LOOSE = 0.95, 1.5  # a slot by its pin
DEPTHS = 0.25, 0.75  # of the way from its mouth to where the pin is deepest: a gap between teeth is not as wide at both
ANGLES = 33  # at which the middle of a slot is looked for


@dataclass(frozen=True)
class Crank:
    """Pins and the pieces that turn with them, about a centre."""

    pieces: list[Piece]
    centre: Centre


def cranks_of(pieces: Sequence[Piece], marks: Sequence[Mark]) -> Iterator[Crank]:
    """The crank of each slotted wheel that has one."""
    for wheel in pieces:
        slots = wheel.turned
        if slots is None or not FEWEST_SLOTS <= slots.fold <= MOST_SLOTS or not is_toothed(slots):
            continue
        others = [piece for piece in pieces if not holds(piece, slots.centre) and piece.turned is None]
        for at, mark in _axes(others, marks):
            pins = [piece for piece in others if piece.is_disc and _drives(piece, wheel, slots, at)]
            if pins:
                why = f"a pin beside it fits the slots of {wheel.layer}, and enters them along them, as in a Geneva drive"
                turning = [piece for piece in others if piece not in pins and _turns_about(piece, at)]
                yield Crank(pins + turning, Centre(at, SURE, why, mark))
                break


def _axes(pieces: Sequence[Piece], marks: Sequence[Mark]) -> Iterator[tuple[Point, Mark | None]]:
    """Where something may turn: marks, then holes, then the middles of arcs, the longest first."""
    yield from ((mark.at, mark) for mark in marks)
    yield from ((hole.at, None) for piece in pieces if (hole := hole_of(piece)) is not None)
    arcs = sorted((arc for piece in pieces for arc in piece.arcs), key=lambda arc: -arc.length)
    yield from (((arc.x, arc.y), None) for arc in arcs)


def _drives(pin: Piece, wheel: Piece, slots: Turned, axis: Point) -> bool:
    """Does a pin that turns about an axis enter the slots along them, and fill them?"""
    crank, apart = math.dist(pin.centroid, axis), math.dist(slots.centre, axis)
    if abs(crank - math.sin(math.pi / slots.fold) * apart) > ALONG * crank:
        return False
    x, y = slots.centre
    deepest = wheel.points[int(np.argmin(np.hypot(*(wheel.points - np.array(slots.centre)).T)))]
    middle, half = math.atan2(deepest[1] - y, deepest[0] - x), 0.5 * math.pi / slots.fold
    radius = pin.length / math.tau
    for share in DEPTHS:
        r = slots.outer + share * (apart - crank - slots.outer)
        places = [(x + r * math.cos(a), y + r * math.sin(a)) for a in np.linspace(middle - half, middle + half, ANGLES)]
        free = max((ring(wheel.points, place)[0] for place in places if not holds(wheel, place)), default=0.0)
        if not SNUG * radius <= free <= LOOSE * radius:
            return False
    return True


def _turns_about(piece: Piece, axis: Point) -> bool:
    """Does it lie over the axis, or have a good part of its outline on arcs about it?"""
    about = sum(arc.length for arc in piece.arcs if math.dist((arc.x, arc.y), axis) <= SAME)
    return holds(piece, axis) or about >= SHARE * piece.length
