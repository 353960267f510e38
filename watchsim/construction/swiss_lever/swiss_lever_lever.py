"""What is the outline of the Swiss lever's lever?

Two stones (layer STONES) in the slots of a body with hub, arms and stem (ARMS), a fork with horns (FORK), a dart for the
safety action (DART). In the lever's own frame, pivot at the origin, balance above; millimetres. The left half serves the
entry; left and right are mirror images everywhere but at the pallets. The constants are those of a wheel of 2.4 mm and a
centre distance of 4.36 mm: what holds the stones grows with the wheel, the rest with the centre distance.
"""

from __future__ import annotations

import math
from itertools import pairwise

from watchsim.construction.outline import arc_between, arc_of_radius, circle, fillet_chain, polar
from watchsim.construction.swiss_lever.swiss_lever_jewel import MOUTH
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

STONE_LENGTH, STONE_EDGE = 0.70, 0.03
EXPOSED = 0.33  # length of a stone outside its slot
SHELLAC = 0.006  # gap between stone and slot
WALL_OUT, WALL_IN, WALL_END = 0.13, 0.13, 0.13  # metal around the slot
HUB_RADIUS, BORE_RADIUS = 0.25, 0.085
STEM_ROOT, NECK = 0.165, 3.02  # half width of the stem at the hub; height at which the fork begins
HORN_TIP = 0.075  # breadth of a horn's end
HIP = (0.43, 3.52)  # where the fork is widest
DART_FOOT, DART_FOOT_RADIUS, DART_HALF = 3.25, 0.085, 0.05  # height of its foot, half width of its bar
DART_SLOPE = 30.0  # half angle of its point


def lever(design: Swiss) -> list[Loop]:
    """All outlines of the lever."""
    stones = [stone(design, 1), stone(design, -1)]
    return [
        *stones,
        body(design),
        circle("ARMS", (0.0, 0.0), BORE_RADIUS * design.lever_scale, hole=True),
        fork(design),
        dart(design),
    ]


class Slot:
    """Places around one stone: `at(t, v)` is t along the locking face from its corner and v across, into the stone."""

    def __init__(self, design: Swiss, side: int) -> None:
        self.corner, self.end = design.locking_corner(side), design.discharge_corner(side)
        direction = math.radians(design.face_direction(side))
        self.u = (math.cos(direction), math.sin(direction))
        self.w = (self.u[1], -self.u[0])
        across = (self.end[0] - self.corner[0], self.end[1] - self.corner[1])
        self.width = across[0] * self.w[0] + across[1] * self.w[1]
        self.scale = design.wheel_scale
        self.length, self.exposed = STONE_LENGTH * self.scale, EXPOSED * self.scale
        self.wall_out, self.wall_in, self.wall_end = (self.scale * wall for wall in (WALL_OUT, WALL_IN, WALL_END))
        self.edge = min(STONE_EDGE * self.scale, 0.2 * self.width)  # rounding of its back edges

    def at(self, t: float, v: float) -> Point:
        return (
            self.corner[0] + t * self.u[0] + v * self.w[0],
            self.corner[1] + t * self.u[1] + v * self.w[1],
        )


def stone(design: Swiss, side: int) -> Loop:
    """Locking corner, impulse face, discharge corner, and the shank."""
    slot = Slot(design, side)
    corners = [slot.corner, slot.end, slot.at(slot.length, slot.width), slot.at(slot.length, 0.0)]
    edges: list[Edge] = [Line(*corners[i], *corners[(i + 1) % 4]) for i in range(4)]
    return Loop(tuple(fillet_chain(edges, [0.0, slot.edge, slot.edge, 0.0], closed=True)), "STONES")


def body(design: Swiss) -> Loop:
    """Stem, arms and hub, counter-clockwise from the right end of the stem's top."""
    half, scale, neck = design.stem_half, design.lever_scale, neck_height(design)
    entry, exit_ = Slot(design, 1), Slot(design, -1)
    left_root, right_root = (-STEM_ROOT * scale, 0.24 * scale), (STEM_ROOT * scale, 0.24 * scale)
    bend = design.banking_height - 0.45 * scale
    parts: list[tuple[Edge, float]] = [
        (Line(half, neck, -half, neck), 0.0),
        (Line(-half, neck, -half, bend), 1.2 * scale),
        (Line(-half, bend, *left_root), 0.3 * scale),
        *_holder_left(entry, left_root),
        *_underside(entry, exit_, scale),
        *_holder_right(exit_, right_root, scale),
        (Line(*right_root, half, bend), 1.2 * scale),
        (Line(half, bend, half, neck), 0.0),
    ]
    edges, radii = [edge for edge, _ in parts], [radius for _, radius in parts]
    return Loop(tuple(fillet_chain(edges, radii, closed=True, yielding=True)), "ARMS")


def neck_height(design: Swiss) -> float:
    """Where the fork begins: the deeper the jewel reaches, the lower."""
    return NECK * design.lever_scale - design.reach_beyond


def _holder_left(slot: Slot, root: Point) -> list[tuple[Edge, float]]:
    """From the stem over the entry stone's holder to the inner end of its mouth; each edge with the fillet after it."""
    end = slot.length + slot.wall_end
    top_in, top_out = slot.at(end, slot.width * 0.5), slot.at(end, -slot.wall_out)
    low_out, low_in = slot.at(slot.exposed, -slot.wall_out), slot.at(slot.exposed, slot.width + slot.wall_in)
    return [
        (_bow(root, top_in, -1.8 * slot.scale, 0.085 * slot.scale), 0.2 * slot.scale),
        (Line(*top_in, *top_out), 0.12 * slot.scale),
        (Line(*top_out, *low_out), 0.04 * slot.scale),
        *_mouth(slot, low_out, low_in),
    ]


def _holder_right(slot: Slot, root: Point, scale: float) -> list[tuple[Edge, float]]:
    """From the inner end of the exit stone's mouth over its holder to the stem."""
    low_in, low_out = slot.at(slot.exposed, -slot.wall_in), slot.at(slot.exposed, slot.width + slot.wall_out)
    end = slot.length + slot.wall_end
    top_out, top_in = slot.at(end, slot.width + slot.wall_out), slot.at(end, -0.5 * slot.wall_in)
    return [
        *_mouth(slot, low_in, low_out),
        (Line(*low_out, *top_out), 0.12 * slot.scale),
        (Line(*top_out, *top_in), 0.2 * slot.scale),
        (_bow(top_in, root, -2.6 * slot.scale, 0.116 * slot.scale), 0.3 * scale),
    ]


def _bow(start: Point, end: Point, radius: float, deepest: float) -> Arc:
    """An arc of that radius, or a flatter one where it would be deeper than `deepest`: a longer arm stays stout."""
    flat = math.dist(start, end) ** 2 / (8.0 * deepest)
    return arc_of_radius(start, end, math.copysign(max(abs(radius), flat), radius))


def _mouth(slot: Slot, first: Point, last: Point) -> list[tuple[Edge, float]]:
    """The slot that holds the stone, between the two ends of the holder's lower edge."""
    near, far = -SHELLAC * slot.scale, slot.width + SHELLAC * slot.scale
    end = slot.length + SHELLAC * slot.scale
    chain = [first, slot.at(slot.exposed, near), slot.at(end, near), slot.at(end, far), slot.at(slot.exposed, far), last]
    radii = [0.02 * slot.scale, slot.edge, slot.edge, 0.02 * slot.scale, 0.04 * slot.scale]
    return [(Line(*a, *b), radius) for (a, b), radius in zip(pairwise(chain), radii, strict=True)]


def _underside(entry: Slot, exit_: Slot, scale: float) -> list[tuple[Edge, float]]:
    """From the entry holder under the hub to the exit holder."""
    start = entry.at(entry.exposed, entry.width + entry.wall_in)
    end = exit_.at(exit_.exposed, -exit_.wall_in)
    left, right = polar(HUB_RADIUS * scale, 210.0), polar(HUB_RADIUS * scale, 325.0)
    return [
        (_bow(start, left, -0.75 * entry.scale, 0.077 * entry.scale), 0.08 * scale),
        (arc_between(left, right, (0.0, 0.0), True), 0.08 * scale),
        (_bow(right, end, -1.6 * entry.scale, 0.103 * entry.scale), 0.04 * exit_.scale),
    ]


def fork(design: Swiss) -> Loop:
    """The fork, counter-clockwise from the left end of the neck; the left half is the right one mirrored."""
    right, neck = _right_fork(design), neck_height(design)
    half = design.slot_width / 2.0
    edges: list[Edge] = [Line(-design.stem_half, neck, design.stem_half, neck), *[edge for edge, _ in right]]
    edges += [Line(half, design.slot_bottom, -half, design.slot_bottom), *[_mirrored(edge) for edge, _ in reversed(right)]]
    radii = [radius for _, radius in right]
    return Loop(tuple(fillet_chain(edges, [0.0, *radii, *reversed(radii), 0.0], closed=True)), "FORK")


def _right_fork(design: Swiss) -> list[tuple[Edge, float]]:
    """From the neck up the outside, round the horn and down the slot; each edge with the fillet after it."""
    scale, neck = design.lever_scale, neck_height(design)
    centre = design.balance_from_bank(-1)
    tip_out = _horn_tip(design)
    tip_in = polar(design.horn_radius, _horn_bearing(design), centre)
    half = design.slot_width / 2.0
    mouth = (half, centre[1] - math.sqrt(design.horn_radius**2 - (half - centre[0]) ** 2))
    foot = (0.165 * scale, neck + 0.2 * scale)
    hip = (HIP[0] * scale + (tip_out[0] - REFERENCE_TIP * scale), HIP[1] * scale - design.reach_beyond)
    return [
        (Line(design.stem_half, neck, *foot), 0.4 * scale),
        (Line(*foot, *hip), 0.2 * scale),
        (Line(*hip, *tip_out), 0.03 * scale),
        (Line(*tip_out, *tip_in), 0.03 * scale),
        (arc_between(tip_in, mouth, centre, False), MOUTH * scale),
        (Line(*mouth, half, design.slot_bottom), min(0.09 * scale, 0.3 * design.slot_width)),
    ]


def _horn_bearing(design: Swiss) -> float:
    """Of the right horn's end from the balance's centre, seen from the lever on its exit bank."""
    return -90.0 + design.horn_end + design.bank


def _horn_tip(design: Swiss) -> Point:
    """The outer end of the right horn."""
    reach = design.horn_radius + HORN_TIP * design.lever_scale
    return polar(reach, _horn_bearing(design), design.balance_from_bank(-1))


REFERENCE_TIP = _horn_tip(Swiss())[0]  # beside which HIP stands


def _mirrored(edge: Edge) -> Edge:
    """The mirror image in the y axis, run through the other way (so that the material stays on the left)."""
    if isinstance(edge, Line):
        return Line(-edge.x1, edge.y1, -edge.x0, edge.y0)
    return Arc(-edge.x, edge.y, edge.radius, math.pi - edge.start_angle - edge.sweep, edge.sweep)


def dart(design: Swiss) -> Loop:
    """A round foot, a bar and a rounded point: the guard of the safety action."""
    y, tip, scale = design.dart_centre, design.dart_tip, design.lever_scale
    foot_at, foot_radius, bar = DART_FOOT * scale - design.reach_beyond, DART_FOOT_RADIUS * scale, DART_HALF * scale
    left, right = polar(tip, 180.0 - DART_SLOPE, (0.0, y)), polar(tip, DART_SLOPE, (0.0, y))
    drop = (bar - right[0]) / math.tan(math.radians(DART_SLOPE))
    join = foot_at + math.sqrt(foot_radius**2 - bar**2)
    shoulder = right[1] - drop
    parts: list[tuple[Edge, float]] = [
        (arc_between((-bar, join), (bar, join), (0.0, foot_at), True), 0.03 * scale),
        (Line(bar, join, bar, shoulder), 0.0),
        (Line(bar, shoulder, *right), 0.0),
        (arc_between(right, left, (0.0, y), True), 0.0),
        (Line(*left, -bar, shoulder), 0.0),
        (Line(-bar, shoulder, -bar, join), 0.03 * scale),
    ]
    return Loop(tuple(fillet_chain([edge for edge, _ in parts], [radius for _, radius in parts], closed=True)), "DART")
