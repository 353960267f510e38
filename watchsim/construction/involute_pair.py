"""Pair of involute gears: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import arc_between, polar
from watchsim.construction.parts import arc_through, gear_outline, gear_pair_scene, other_flank
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line, Point


@dataclass(frozen=True)
class InvolutePair:
    pinion_teeth: int = dim(20, "", 6, 60, "teeth of the driven pinion", CHOSEN)
    wheel_teeth: int = dim(40, "", 8, 150, "teeth of the driving wheel", CHOSEN)
    module: float = dim(0.2, "mm", 0.02, 10.0, "pitch diameter by number of teeth", "small gears: 0.1 mm to 0.3 mm")
    pressure_angle: float = dim(20.0, "°", 14.0, 28.0, "of the basic rack", "ISO 53: 20°")
    shift: float = dim(
        0.0, "", 0.0, 0.7, "profile shift of the pinion in modules, of the wheel the opposite", "0.4 for 8 teeth"
    )
    addendum: float = dim(1.0, "", 0.5, 1.2, "height of a tooth above the pitch circle, in modules", "ISO 53: 1")
    dedendum: float = dim(1.25, "", 0.7, 1.5, "depth of a gap below the pitch circle, in modules", "ISO 53: 1.25")
    spread: float = dim(0.05, "", 0.002, 0.3, "by which the centres are further apart than without play, in modules", CHOSEN)
    arcs: int = dim(8, "", 1, 16, "arcs that each flank is drawn with, through points of the involute", CHOSEN)
    torque: float = dim(20.0, "µN·m", 1e-4, 1e6, "driving the wheel", CHOSEN)
    drag: float = dim(2.0, "µN·m·s/rad", 1e-6, 1e6, "load on the pinion, in proportion to its speed", CHOSEN)
    pinion_inertia: float = dim(5.0, "mg·cm²", 1e-4, 1e6, "pinion with what it turns", CHOSEN)
    wheel_inertia: float = dim(50.0, "mg·cm²", 1e-4, 1e6, "wheel with what turns it", CHOSEN)
    friction: float = dim(0.0, "", 0.0, 0.4, "coefficient of friction between flanks", "0: to see the form of the teeth alone")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution between flanks", CHOSEN)


# What is the outline of a gear with involute teeth?
#
# In the gear's own frame, millimetres; tooth 0 is centred on the x axis. Each flank is a chain of arcs, each through three
# points of the involute; below the base circle it goes on straight towards the axis. Formulas: ISO 21771.

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
    """The toothed contour, each tooth from the foot of its right flank to the foot of the next one, and the bore."""
    foot = math.degrees(gear.half_tooth(gear.flank_start))
    right = _flank(gear)
    if gear.base_radius > gear.floor_radius:
        right = [Line(*polar(gear.floor_radius, -foot), *right[0].start), *right]
    left = other_flank(right)
    tip = arc_between(right[-1].end, left[0].start, (0.0, 0.0), True)
    next_foot = 360.0 / gear.teeth - foot
    floor = arc_between(polar(gear.floor_radius, foot), polar(gear.floor_radius, next_foot), (0.0, 0.0), True)
    return gear_outline(LAYER, [*right, tip, *left, floor], gear.teeth, gear.floor_radius)


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


def departure(gear: Gear) -> float:
    """How far the arcs lie from the involute at most, mm: looked at halfway between the points that they go through."""
    worst = 0.0
    for arc, (first, middle, last) in zip(_flank(gear), _rolling_angles(gear), strict=True):
        for t in ((first + middle) / 2.0, (middle + last) / 2.0):
            x, y = _at(gear, t)
            if not isinstance(arc, Line):
                worst = max(worst, abs(math.hypot(x - arc.x, y - arc.y) - arc.radius))
    return worst


# How do the two gears mesh: distance, play, contact ratio, and what part of a flank is used?


def distance(values: InvolutePair) -> float:
    """Of the centres, mm."""
    return values.module * ((values.pinion_teeth + values.wheel_teeth) / 2.0 + values.spread)


def working_angle(values: InvolutePair) -> float:
    """The pressure angle at which the gears work at that distance, radians."""
    pinion, wheel = pair(values)
    return math.acos((pinion.base_radius + wheel.base_radius) / distance(values))


def play(values: InvolutePair) -> float:
    """By which the pinion can turn with the wheel held, radians: the pitch less both teeth, on the circles that roll."""
    working, taken = working_angle(values), 0.0
    for gear in pair(values):
        rolling = gear.base_radius / math.cos(working)
        taken += 2.0 * gear.half_tooth(rolling) * rolling
    pinion = pair(values)[0]
    rolling = pinion.base_radius / math.cos(working)
    return 2.0 * math.pi / pinion.teeth - taken / rolling


def beyond_base(values: InvolutePair, gear: Gear, other: Gear) -> float:
    """Where the other gear's tip ends the line of action, from the point of tangency on this gear's base circle, mm.

    Negative where it reaches under the base circle, where there is no involute.
    """
    line = (gear.base_radius + other.base_radius) * math.tan(working_angle(values))
    return line - math.sqrt(other.tip_radius**2 - other.base_radius**2)


def contact_ratio(values: InvolutePair) -> float:
    """Teeth in mesh on average."""
    pinion, wheel = pair(values)
    line = (pinion.base_radius + wheel.base_radius) * math.tan(working_angle(values))
    used = sum(math.sqrt(gear.tip_radius**2 - gear.base_radius**2) for gear in (pinion, wheel)) - line
    return used * pinion.teeth / (2.0 * math.pi * pinion.base_radius)


LEAST_TIP, LEAST_FLOOR = 0.1, 0.05  # modules; degrees


def conflicts(values: InvolutePair) -> Iterator[Conflict]:
    gears = dict(zip(("pinion", "wheel"), pair(values), strict=True))
    for name, gear in gears.items():
        tip = 2.0 * gear.half_tooth(gear.tip_radius) * gear.tip_radius / values.module
        if tip < LEAST_TIP:
            yield Conflict("addendum", f"makes the teeth of the {name} pointed: {tip:.3g} modules are left at the tip")
        if math.degrees(math.tau / gear.teeth - 2.0 * gear.half_tooth(gear.flank_start)) < LEAST_FLOOR:
            yield Conflict("shift", f"leaves no gap between the feet of the {name}'s teeth")
    for (name, gear), other in zip(gears.items(), reversed(gears.values()), strict=True):
        start = math.sqrt(gear.flank_start**2 - gear.base_radius**2)
        if beyond_base(values, gear, other) < start:
            yield Conflict("shift", f"lets the other gear's tips reach below the involutes of the {name}: they would cut in")
        if gear.floor_radius + other.tip_radius >= distance(values):
            yield Conflict("dedendum", f"is too small: the other gear's tips meet the floor of the {name}")
    if play(values) <= 0.0:
        yield Conflict("spread", "leaves no play between the teeth")
    elif sum(map(departure, pair(values))) > play(values) * pair(values)[0].base_radius / 4.0:
        yield Conflict(
            "arcs", "follows the involute so coarsely that it takes up more than half of the play: more arcs or more spread"
        )
    if contact_ratio(values) < 1.0:
        yield Conflict(
            "spread", f"gives a contact ratio of {contact_ratio(values):.3g}: a tooth leaves before the next one meets"
        )


def draw(values: InvolutePair) -> dict[str, Sheet]:
    """Pinion and wheel."""
    pinion, wheel = pair(values)
    return sheets_of(pinion=outline(pinion), wheel=outline(wheel))


def scene_text(values: InvolutePair) -> str:
    """The text of scene.toml."""
    return gear_pair_scene(values, "A pair of involute gears", "Involute gears", distance(values))


DESIGN = Design("involute_pair", "Pair of involute gears", InvolutePair, draw, scene_text, conflicts)
