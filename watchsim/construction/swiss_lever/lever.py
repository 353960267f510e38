"""What is the outline of the Swiss lever's lever?

Two stones (layer STONES) in the slots of a body with hub, arms and stem (ARMS), a fork with horns (FORK), a dart for the
safety action (DART). In the lever's own frame, pivot at the origin, balance above; millimetres. The left half serves the
entry; left and right are mirror images everywhere but at the pallets.
"""

from __future__ import annotations

import math
from itertools import pairwise

from watchsim.construction.outline import arc_between, arc_of_radius, circle, fillet_chain, polar
from watchsim.construction.swiss_lever.points import Swiss

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

STONE_LENGTH, STONE_EDGE = 0.70, 0.03
EXPOSED = 0.33  # length of a stone outside its slot
SHELLAC = 0.006  # gap between stone and slot
WALL_OUT, WALL_IN, WALL_END = 0.13, 0.13, 0.13  # metal around the slot
HUB_RADIUS, BORE_RADIUS = 0.25, 0.085
STEM_ROOT, NECK = 0.165, 3.02  # half width of the stem at the hub; height at which the fork begins
HORN_TIP = 0.075  # breadth of a horn's end
DART_FOOT, DART_FOOT_RADIUS, DART_HALF = 3.25, 0.085, 0.05  # height of its foot, half width of its bar
DART_SLOPE = 30.0  # half angle of its point


def lever(design: Swiss) -> list[Loop]:
    """All outlines of the lever."""
    stones = [stone(design, 1), stone(design, -1)]
    return [*stones, body(design), circle("ARMS", (0.0, 0.0), BORE_RADIUS, hole=True), fork(design), dart(design)]


class Slot:
    """Places around one stone: `at(t, v)` is t along the locking face from its corner and v across, into the stone."""

    def __init__(self, design: Swiss, side: int) -> None:
        self.corner, self.end = design.locking_corner(side), design.discharge_corner(side)
        direction = math.radians(design.face_direction(side))
        self.u = (math.cos(direction), math.sin(direction))
        self.w = (self.u[1], -self.u[0])
        across = (self.end[0] - self.corner[0], self.end[1] - self.corner[1])
        self.width = across[0] * self.w[0] + across[1] * self.w[1]

    def at(self, t: float, v: float) -> Point:
        return (
            self.corner[0] + t * self.u[0] + v * self.w[0],
            self.corner[1] + t * self.u[1] + v * self.w[1],
        )


def stone(design: Swiss, side: int) -> Loop:
    """Locking corner, impulse face, discharge corner, and the shank."""
    slot = Slot(design, side)
    corners = [slot.corner, slot.end, slot.at(STONE_LENGTH, slot.width), slot.at(STONE_LENGTH, 0.0)]
    edges: list[Edge] = [Line(*corners[i], *corners[(i + 1) % 4]) for i in range(4)]
    return Loop(tuple(fillet_chain(edges, [0.0, STONE_EDGE, STONE_EDGE, 0.0], closed=True)), "STONES")


def body(design: Swiss) -> Loop:
    """Stem, arms and hub, counter-clockwise from the right end of the stem's top."""
    half = design.stem_half
    entry, exit_ = Slot(design, 1), Slot(design, -1)
    left_root, right_root = (-STEM_ROOT, 0.24), (STEM_ROOT, 0.24)
    parts: list[tuple[Edge, float]] = [
        (Line(half, NECK, -half, NECK), 0.0),
        (Line(-half, NECK, -half, design.banking_height - 0.45), 1.2),
        (Line(-half, design.banking_height - 0.45, *left_root), 0.3),
        *_holder_left(entry, left_root),
        *_underside(entry, exit_),
        *_holder_right(exit_, right_root),
        (Line(*right_root, half, design.banking_height - 0.45), 1.2),
        (Line(half, design.banking_height - 0.45, half, NECK), 0.0),
    ]
    return Loop(tuple(fillet_chain([edge for edge, _ in parts], [radius for _, radius in parts], closed=True)), "ARMS")


def _holder_left(slot: Slot, root: Point) -> list[tuple[Edge, float]]:
    """From the stem over the entry stone's holder to the inner end of its mouth; each edge with the fillet after it."""
    top_in = slot.at(STONE_LENGTH + WALL_END, slot.width * 0.5)
    top_out = slot.at(STONE_LENGTH + WALL_END, -WALL_OUT)
    low_out, low_in = slot.at(EXPOSED, -WALL_OUT), slot.at(EXPOSED, slot.width + WALL_IN)
    return [
        (arc_of_radius(root, top_in, -1.8), 0.2),
        (Line(*top_in, *top_out), 0.12),
        (Line(*top_out, *low_out), 0.04),
        *_mouth(slot, low_out, low_in),
    ]


def _holder_right(slot: Slot, root: Point) -> list[tuple[Edge, float]]:
    """From the inner end of the exit stone's mouth over its holder to the stem."""
    low_in, low_out = slot.at(EXPOSED, -WALL_IN), slot.at(EXPOSED, slot.width + WALL_OUT)
    top_out = slot.at(STONE_LENGTH + WALL_END, slot.width + WALL_OUT)
    top_in = slot.at(STONE_LENGTH + WALL_END, -0.5 * WALL_IN)
    return [
        *_mouth(slot, low_in, low_out),
        (Line(*low_out, *top_out), 0.12),
        (Line(*top_out, *top_in), 0.2),
        (arc_of_radius(top_in, root, -2.6), 0.3),
    ]


def _mouth(slot: Slot, first: Point, last: Point) -> list[tuple[Edge, float]]:
    """The slot that holds the stone, between the two ends of the holder's lower edge."""
    near, far = -SHELLAC, slot.width + SHELLAC
    end = STONE_LENGTH + SHELLAC
    chain = [first, slot.at(EXPOSED, near), slot.at(end, near), slot.at(end, far), slot.at(EXPOSED, far), last]
    radii = [0.02, STONE_EDGE, STONE_EDGE, 0.02, 0.04]
    return [(Line(*a, *b), radius) for (a, b), radius in zip(pairwise(chain), radii, strict=True)]


def _underside(entry: Slot, exit_: Slot) -> list[tuple[Edge, float]]:
    """From the entry holder under the hub to the exit holder."""
    start = entry.at(EXPOSED, entry.width + WALL_IN)
    end = exit_.at(EXPOSED, -WALL_IN)
    left, right = polar(HUB_RADIUS, 210.0), polar(HUB_RADIUS, 325.0)
    return [
        (arc_of_radius(start, left, -0.75), 0.08),
        (arc_between(left, right, (0.0, 0.0), True), 0.08),
        (arc_of_radius(right, end, -1.6), 0.04),
    ]


def fork(design: Swiss) -> Loop:
    """The fork, counter-clockwise from the left end of the neck; the left half is the right one mirrored."""
    right = _right_fork(design)
    half = design.slot_width / 2.0
    edges: list[Edge] = [Line(-design.stem_half, NECK, design.stem_half, NECK), *[edge for edge, _ in right]]
    edges += [Line(half, design.slot_bottom, -half, design.slot_bottom), *[_mirrored(edge) for edge, _ in reversed(right)]]
    radii = [radius for _, radius in right]
    return Loop(tuple(fillet_chain(edges, [0.0, *radii, *reversed(radii), 0.0], closed=True)), "FORK")


def _right_fork(design: Swiss) -> list[tuple[Edge, float]]:
    """From the neck up the outside, round the horn and down the slot; each edge with the fillet after it."""
    centre = design.balance_from_bank(-1)
    bearing = -90.0 + design.horn_end + design.bank
    tip_out = polar(design.horn_radius + HORN_TIP, bearing, centre)
    tip_in = polar(design.horn_radius, bearing, centre)
    half = design.slot_width / 2.0
    mouth = (half, centre[1] - math.sqrt(design.horn_radius**2 - (half - centre[0]) ** 2))
    foot, hip = (0.165, NECK + 0.2), (0.43, 3.52)
    return [
        (Line(design.stem_half, NECK, *foot), 0.4),
        (Line(*foot, *hip), 0.2),
        (Line(*hip, *tip_out), 0.03),
        (Line(*tip_out, *tip_in), 0.03),
        (arc_between(tip_in, mouth, centre, False), 0.02),
        (Line(*mouth, half, design.slot_bottom), 0.09),
    ]


def _mirrored(edge: Edge) -> Edge:
    """The mirror image in the y axis, run through the other way (so that the material stays on the left)."""
    if isinstance(edge, Line):
        return Line(-edge.x1, edge.y1, -edge.x0, edge.y0)
    return Arc(-edge.x, edge.y, edge.radius, math.pi - edge.start_angle - edge.sweep, edge.sweep)


def dart(design: Swiss) -> Loop:
    """A round foot, a bar and a rounded point: the guard of the safety action."""
    y, tip = design.dart_centre, design.dart_tip
    left, right = polar(tip, 180.0 - DART_SLOPE, (0.0, y)), polar(tip, DART_SLOPE, (0.0, y))
    drop = (DART_HALF - right[0]) / math.tan(math.radians(DART_SLOPE))
    join = DART_FOOT + math.sqrt(DART_FOOT_RADIUS**2 - DART_HALF**2)
    shoulder = right[1] - drop
    parts: list[tuple[Edge, float]] = [
        (arc_between((-DART_HALF, join), (DART_HALF, join), (0.0, DART_FOOT), True), 0.03),
        (Line(DART_HALF, join, DART_HALF, shoulder), 0.0),
        (Line(DART_HALF, shoulder, *right), 0.0),
        (arc_between(right, left, (0.0, y), True), 0.0),
        (Line(*left, -DART_HALF, shoulder), 0.0),
        (Line(-DART_HALF, shoulder, -DART_HALF, join), 0.03),
    ]
    return Loop(tuple(fillet_chain([edge for edge, _ in parts], [radius for _, radius in parts], closed=True)), "DART")
