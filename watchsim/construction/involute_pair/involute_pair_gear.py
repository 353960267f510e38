"""What is the outline of a gear with involute teeth?

In the gear's own frame, millimetres; tooth 0 is centred on the x axis. Each flank is a chain of arcs, each through three
points of the involute; below the base circle it goes on straight towards the axis. Formulas: ISO 21771.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.involute_pair.involute_pair_dimensions import InvolutePair
from watchsim.construction.outline import arc_between, polar
from watchsim.construction.tooth_flanks import arc_through, gear_outline, other_flank
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

LAYER = "TEETH"


def involute(angle: float) -> float:
    """inv x = tan x - x, radians."""
    return math.tan(angle) - angle


@dataclass(frozen=True)
class Gear:
    """A gear of the pair: its number of teeth and its profile shift in modules."""

    values: InvolutePair
    teeth: int
    shift: float

    @property
    def pitch_radius(self) -> float:
        return self.values.module * self.teeth / 2.0

    @property
    def base_radius(self) -> float:
        return self.pitch_radius * math.cos(math.radians(self.values.pressure_angle))

    @property
    def tip_radius(self) -> float:
        return self.pitch_radius + self.values.module * (self.values.addendum + self.shift)

    @property
    def floor_radius(self) -> float:
        return self.pitch_radius - self.values.module * (self.values.dedendum - self.shift)

    @property
    def flank_start(self) -> float:
        """Radius at which the involute begins in the drawing."""
        return max(self.base_radius, self.floor_radius)

    def half_tooth(self, radius: float) -> float:
        """Half the angle that a tooth takes at a radius, radians; negative above its point."""
        pressure = math.radians(self.values.pressure_angle)
        at_pitch = (math.pi / 2.0 + 2.0 * self.shift * math.tan(pressure)) / self.teeth
        there = math.acos(min(1.0, self.base_radius / radius))
        return at_pitch + involute(pressure) - involute(there)


def pair(values: InvolutePair) -> tuple[Gear, Gear]:
    """Pinion and wheel."""
    return Gear(values, values.pinion_teeth, values.shift), Gear(values, values.wheel_teeth, -values.shift)


def outline(gear: Gear) -> list[Loop]:
    """The toothed contour and the bore."""
    return gear_outline(LAYER, _tooth(gear), gear.teeth, gear.floor_radius)


def _tooth(gear: Gear) -> list[Edge]:
    """From the foot of a tooth's right flank over its tip to the foot of the next tooth's, counter-clockwise."""
    foot = math.degrees(gear.half_tooth(gear.flank_start))
    right = _flank(gear)
    if gear.base_radius > gear.floor_radius:
        right = [Line(*polar(gear.floor_radius, -foot), *right[0].start), *right]
    left = other_flank(right)
    tip = arc_between(right[-1].end, left[0].start, (0.0, 0.0), True)
    next_foot = 360.0 / gear.teeth - foot
    floor = arc_between(polar(gear.floor_radius, foot), polar(gear.floor_radius, next_foot), (0.0, 0.0), True)
    return [*right, tip, *left, floor]


def _flank(gear: Gear) -> list[Edge]:
    """The right flank, outwards: arcs evenly spread over the involute's rolling angle."""
    return [arc_through(*(_at(gear, t) for t in three)) for three in _rolling_angles(gear)]


def _rolling_angles(gear: Gear) -> list[tuple[float, float, float]]:
    """For each arc the tangents of the pressure angle (rolling angles, rad) at its first, middle and last point."""
    base = gear.base_radius
    first, last = (math.sqrt(max((r / base) ** 2 - 1.0, 0.0)) for r in (gear.flank_start, gear.tip_radius))
    half = (last - first) / (2 * gear.values.arcs)
    return [(first + 2 * i * half, first + (2 * i + 1) * half, first + 2 * (i + 1) * half) for i in range(gear.values.arcs)]


def _at(gear: Gear, rolled: float) -> Point:
    """The point of the right flank at that rolling angle."""
    radius = gear.base_radius * math.sqrt(1.0 + rolled * rolled)
    return polar(radius, -math.degrees(gear.half_tooth(radius)))


def floor_left(gear: Gear) -> float:
    """Degrees of floor between two teeth."""
    foot = gear.half_tooth(gear.flank_start)
    return math.degrees(2.0 * math.pi / gear.teeth - 2.0 * foot)


def departure(gear: Gear) -> float:
    """How far the arcs lie from the involute at most, mm: looked at halfway between the points that they go through."""
    worst = 0.0
    for arc, (first, middle, last) in zip(_flank(gear), _rolling_angles(gear), strict=True):
        for t in ((first + middle) / 2.0, (middle + last) / 2.0):
            x, y = _at(gear, t)
            if not isinstance(arc, Line):
                worst = max(worst, abs(math.hypot(x - arc.x, y - arc.y) - arc.radius))
    return worst
