"""What are the outlines of the fork and of the guard pin of a co-axial escapement's lever?

Drawn with the lever's pivot at the origin and the balance above, then turned to where the balance is. Millimetres. The right
half is drawn, the left one is its mirror image.
"""

from __future__ import annotations

import math

from watchsim.construction.coaxial.coaxial_points import Points, cosine, sine
from watchsim.construction.outline import arc_between, fillet_chain, polar
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

STEM_HALF = 0.10
NECK, HIP, BOTTOM = 1.24, 0.80, 0.09  # from the balance's centre; of the slot below the pin
HORN_TIP, HORN_END = 0.065, 50.0  # breadth of a horn's end; how far round the balance it reaches, lever on the bank, degrees
PIN_GROUND, PIN_EDGE = 3.0 / 7.0, 0.02  # of the pin's diameter that is ground away; rounding of its two edges
SAFETY_RADIUS, CRESCENT_HALF, CRESCENT_DEPTH = 0.5, 23.0, 0.17
GUARD_FOOT, GUARD_FOOT_RADIUS, GUARD_HALF, GUARD_TIP, GUARD_SLOPE = 1.08, 0.075, 0.045, 0.025, 30.0


class Fork:
    """Places of the fork, in the frame in which the balance is above the lever's pivot."""

    def __init__(self, points: Points) -> None:
        self.scale = s = points.scale
        self.points = points
        self.stem_half = STEM_HALF * s
        self.neck = points.lever_to_balance - NECK * s
        self.slot_half = points.slot_width / 2.0
        self.slot_bottom = points.lever_to_balance - points.pin_reach - BOTTOM * s
        radius = points.values.pin_radius
        self.pin_edge = PIN_EDGE * s
        self.pin_centre = points.pin_reach + (2.0 * PIN_GROUND - 1.0) * radius
        height = points.pin_reach - self.pin_edge
        half = math.sqrt((radius - self.pin_edge) ** 2 - (height - self.pin_centre) ** 2)
        self.horn_radius = math.hypot(half, height) + self.pin_edge + points.values.horn_clearance
        """Of the horns about the balance's centre, lever on the bank: past the farthest point of the pin's edge."""

    def balance_from_bank(self, side: int) -> Point:
        """The balance's centre in this frame, lever on the first (+1) or second (-1) stone's bank."""
        return polar(self.points.lever_to_balance, 90.0 - side * self.points.bank)

    def guard_centre(self) -> float:
        """Centre of the guard pin's rounding above the lever's pivot."""
        x, y = self.balance_from_bank(1)
        reach = SAFETY_RADIUS * self.scale + self.points.values.guard_clearance + GUARD_TIP * self.scale
        return y - math.sqrt(reach**2 - x * x)


def fork_outline(fork: Fork) -> Loop:
    """The fork, counter-clockwise from the left end of the neck."""
    right = _right_half(fork)
    neck, half, bottom = fork.neck, fork.slot_half, fork.slot_bottom
    edges: list[Edge] = [Line(-fork.stem_half, neck, fork.stem_half, neck), *[edge for edge, _ in right]]
    edges += [Line(half, bottom, -half, bottom), *[_mirrored(edge) for edge, _ in reversed(right)]]
    radii = [radius for _, radius in right]
    return Loop(tuple(fillet_chain(edges, [0.0, *radii, *reversed(radii), 0.0], closed=True)), "FORK")


def _right_half(fork: Fork) -> list[tuple[Edge, float]]:
    """From the neck up the outside, round the horn and down the slot; each edge with the fillet after it."""
    s = fork.scale
    centre = fork.balance_from_bank(-1)
    bearing = -90.0 + HORN_END + fork.points.bank
    tip_out = polar(fork.horn_radius + HORN_TIP * s, bearing, centre)
    tip_in = polar(fork.horn_radius, bearing, centre)
    half = fork.slot_half
    mouth = (half, centre[1] - math.sqrt(fork.horn_radius**2 - (half - centre[0]) ** 2))
    foot, hip = (0.13 * s, fork.neck + 0.13 * s), (0.36 * s, fork.points.lever_to_balance - HIP * s)
    return [
        (Line(fork.stem_half, fork.neck, *foot), 0.3 * s),
        (Line(*foot, *hip), 0.15 * s),
        (Line(*hip, *tip_out), 0.025 * s),
        (Line(*tip_out, *tip_in), 0.025 * s),
        (arc_between(tip_in, mouth, centre, False), 0.015 * s),
        (Line(*mouth, half, fork.slot_bottom), 0.08 * s),
    ]


def _mirrored(edge: Edge) -> Edge:
    """The mirror image in the y axis, run through the other way (so that the material stays on the left)."""
    if isinstance(edge, Line):
        return Line(-edge.x1, edge.y1, -edge.x0, edge.y0)
    return Arc(-edge.x, edge.y, edge.radius, math.pi - edge.start_angle - edge.sweep, edge.sweep)


def guard_pin(fork: Fork) -> Loop:
    """A round foot, a bar and a rounded point."""
    s = fork.scale
    y, tip, half, slope = fork.guard_centre(), GUARD_TIP * s, GUARD_HALF * s, GUARD_SLOPE
    foot, radius = fork.points.lever_to_balance - GUARD_FOOT * s, GUARD_FOOT_RADIUS * s
    left, right = polar(tip, 180.0 - slope, (0.0, y)), polar(tip, slope, (0.0, y))
    join = foot + math.sqrt(radius**2 - half**2)
    shoulder = right[1] - (half - right[0]) * cosine(slope) / sine(slope)
    parts: list[tuple[Edge, float]] = [
        (arc_between((-half, join), (half, join), (0.0, foot), True), 0.025 * s),
        (Line(half, join, half, shoulder), 0.0),
        (Line(half, shoulder, *right), 0.0),
        (arc_between(right, left, (0.0, y), True), 0.0),
        (Line(*left, -half, shoulder), 0.0),
        (Line(-half, shoulder, -half, join), 0.025 * s),
    ]
    return Loop(tuple(fillet_chain([edge for edge, _ in parts], [r for _, r in parts], closed=True)), "GUARD")
