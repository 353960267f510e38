"""What are the outlines of a wheel with cycloidal teeth and of its pinion?

In each one's own frame, millimetres; tooth 0 is centred on the x axis. A circle of half the pinion's pitch radius, rolling
outside the wheel's pitch circle, describes the addenda of the wheel; rolling inside that of the pinion, a diameter of it
(Cardan's circles). So radial dedenda of the pinion are conjugate to the wheel's addenda. The wheel's dedenda are radial, too;
the leaves are rounded by arcs tangent to their flanks on the pitch circle.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from watchsim.construction.cycloidal_pair.cycloidal_pair_dimensions import CycloidalPair
from watchsim.construction.design import Impossible
from watchsim.construction.outline import arc_between, polar
from watchsim.construction.tooth_flanks import arc_through, gear_outline, other_flank
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

LAYER = "TEETH"


@dataclass(frozen=True)
class Wheel:
    """The driving wheel, with epicycloids above its pitch circle."""

    values: CycloidalPair

    @property
    def pitch_radius(self) -> float:
        return self.values.module * self.values.wheel_teeth / 2.0

    @property
    def rolling_radius(self) -> float:
        """Of the circle that describes the addenda."""
        return self.values.module * self.values.pinion_teeth / 4.0

    @property
    def tip_radius(self) -> float:
        return self.pitch_radius + self.values.module * self.values.addendum

    @property
    def floor_radius(self) -> float:
        return self.pitch_radius - self.values.module * self.values.wheel_dedendum

    @property
    def half_tooth(self) -> float:
        """Half the angle of a tooth at the pitch circle, radians."""
        return self.values.tooth / self.values.wheel_teeth

    @property
    def last_roll(self) -> float:
        """How far the rolling circle has turned about its centre when it describes the tip, radians."""
        big, small = self.pitch_radius + self.rolling_radius, self.rolling_radius
        cosine = (big**2 + small**2 - self.tip_radius**2) / (2.0 * big * small)
        if cosine < -1.0:
            raise Impossible("addendum", "is higher than the epicycloid, which reaches half of the pinion's teeth in modules")
        return math.acos(cosine)

    def epicycloid(self, roll: float) -> Point:
        """The point of the right flank, distance and angle (radians) from the wheel's centre."""
        big, small = self.pitch_radius + self.rolling_radius, self.rolling_radius
        drawn = big - small * cmath.exp(1j * roll)
        return abs(drawn), roll * small / self.pitch_radius + cmath.phase(drawn) - self.half_tooth


@dataclass(frozen=True)
class Pinion:
    """The driven pinion: leaves with radial flanks and a rounding."""

    values: CycloidalPair

    @property
    def pitch_radius(self) -> float:
        return self.values.module * self.values.pinion_teeth / 2.0

    @property
    def floor_radius(self) -> float:
        return self.pitch_radius - self.values.module * self.values.pinion_dedendum

    @property
    def half_leaf(self) -> float:
        """Half the angle of a leaf at the pitch circle, radians."""
        return self.values.leaf / self.values.pinion_teeth

    @property
    def rounding(self) -> tuple[Point, float]:
        """Centre and radius of the arc above the right flank, which leans on that flank at the pitch circle."""
        radius = self.values.ogive * self.pitch_radius * math.tan(self.half_leaf)
        x, y = polar(self.pitch_radius, -math.degrees(self.half_leaf))
        return (x + radius * math.sin(self.half_leaf), y + radius * math.cos(self.half_leaf)), radius

    @property
    def tip_radius(self) -> float:
        (x, y), radius = self.rounding
        return x + math.sqrt(radius**2 - y**2)


def wheel_outline(wheel: Wheel) -> list[Loop]:
    """The toothed contour and the bore."""
    return _outline(wheel, [*_radial(wheel, wheel.half_tooth), *_addendum(wheel)], wheel.values.wheel_teeth)


def pinion_outline(pinion: Pinion) -> list[Loop]:
    """The leaves and the bore."""
    right = _radial(pinion, pinion.half_leaf)
    centre, _radius = pinion.rounding
    right.append(arc_between(right[0].end, (pinion.tip_radius, 0.0), centre, True))
    return _outline(pinion, right, pinion.values.pinion_teeth)


def _outline(gear: Wheel | Pinion, right: list[Edge], teeth: int) -> list[Loop]:
    """Of a gear with this right flank, from the floor to the tip."""
    left = other_flank(right)
    tip = [arc_between(right[-1].end, left[0].start, (0.0, 0.0), True)] if isinstance(gear, Wheel) else []
    (x, y), pitch = left[-1].end, 360.0 / teeth
    next_foot = polar(gear.floor_radius, pitch - math.degrees(math.atan2(y, x)))
    floor = arc_between((x, y), next_foot, (0.0, 0.0), True)
    return gear_outline(LAYER, [*right, *tip, *left, floor], teeth, gear.floor_radius)


def _radial(gear: Wheel | Pinion, half: float) -> list[Edge]:
    """The right flank up to the pitch circle."""
    foot = -math.degrees(half)
    return [Line(*polar(gear.floor_radius, foot), *polar(gear.pitch_radius, foot))]


def _addendum(wheel: Wheel) -> list[Edge]:
    """The right flank above the pitch circle: arcs evenly spread over the angle of rolling."""
    step = wheel.last_roll / (2 * wheel.values.arcs)
    points = [_flat(wheel.epicycloid(i * step)) for i in range(2 * wheel.values.arcs + 1)]
    return [arc_through(*points[i : i + 3]) for i in range(0, 2 * wheel.values.arcs, 2)]


def _flat(place: Point) -> Point:
    return polar(place[0], math.degrees(place[1]))


def tip_left(wheel: Wheel) -> float:
    """Width of a wheel's tooth at its tip, mm; negative beyond its point."""
    radius, angle = wheel.epicycloid(wheel.last_roll)
    return -2.0 * angle * radius
