"""Cycloidal wheel and pinion: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction.design import CHOSEN, Conflict, Design, Impossible, dim, sheets_of
from watchsim.construction.outline import arc_between, polar
from watchsim.construction.parts import arc_through, gear_outline, gear_pair_scene, other_flank
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line, Point

HALF = "half a pitch"


@dataclass(frozen=True)
class CycloidalPair:
    pinion_teeth: int = dim(10, "", 6, 30, "leaves of the driven pinion", "watch trains: 6 to 12")
    wheel_teeth: int = dim(80, "", 20, 150, "teeth of the driving wheel", "watch trains: 6 to 10 times the leaves")
    module: float = dim(0.12, "mm", 0.02, 10.0, "pitch diameter by number of teeth", "watch trains: 0.08 mm to 0.2 mm")
    addendum: float = dim(1.4, "", 0.5, 2.0, "height of the wheel's teeth above the pitch circle, in modules", CHOSEN)
    wheel_dedendum: float = dim(1.57, "", 0.5, 2.5, "depth of the wheel's gaps below the pitch circle, in modules", HALF)
    pinion_dedendum: float = dim(1.75, "", 0.5, 2.5, "depth of the pinion's gaps below the pitch circle, in modules", CHOSEN)
    tooth: float = dim(1.57, "", 1.0, 1.8, "width of the wheel's teeth on the pitch circle, in modules", HALF)
    leaf: float = dim(1.05, "", 0.7, 1.5, "width of the leaves on the pitch circle, in modules", "a third of a pitch")
    ogive: float = dim(
        1.333,
        "",
        1.0,
        3.0,
        "ratio of the radius of the leaves' rounding to that of a round top",
        "1: round tops, above: ogives (BS 978-2)",
    )
    spread: float = dim(
        0.0, "", -0.05, 0.2, "by which the centres are further apart than the pitch circles, in modules", CHOSEN
    )
    arcs: int = dim(
        6, "", 1, 16, "arcs that the addendum of each flank is drawn with, through points of the epicycloid", CHOSEN
    )
    torque: float = dim(40.0, "µN·m", 1e-4, 1e6, "driving the wheel", CHOSEN)
    drag: float = dim(1.0, "µN·m·s/rad", 1e-6, 1e6, "load on the pinion, in proportion to its speed", CHOSEN)
    pinion_inertia: float = dim(10.0, "mg·cm²", 1e-4, 1e6, "pinion with what it turns", "a brass wheel of 8 mm on its arbor")
    wheel_inertia: float = dim(50.0, "mg·cm²", 1e-4, 1e6, "wheel with what turns it", CHOSEN)
    friction: float = dim(0.0, "", 0.0, 0.4, "coefficient of friction between flanks", "0: to see the form of the teeth alone")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution between flanks", CHOSEN)


# What are the outlines of a wheel with cycloidal teeth and of its pinion?
#
# In each one's own frame, millimetres; tooth 0 is centred on the x axis. A circle of half the pinion's pitch radius, rolling
# outside the wheel's pitch circle, describes the addenda of the wheel; rolling inside that of the pinion, a diameter of it
# (Cardan's circles). So radial dedenda of the pinion are conjugate to the wheel's addenda. The wheel's dedenda are radial, too;
# the leaves are rounded by arcs tangent to their flanks on the pitch circle.

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
    """The toothed contour and the bore; the addendum of arcs evenly spread over the angle of rolling."""
    arcs = wheel.values.arcs
    step = wheel.last_roll / (2 * arcs)
    points = [wheel.epicycloid(i * step) for i in range(2 * arcs + 1)]
    flank = [polar(radius, math.degrees(angle)) for radius, angle in points]
    addendum = [arc_through(*flank[i : i + 3]) for i in range(0, 2 * arcs, 2)]
    return _outline(wheel, [_radial(wheel, wheel.half_tooth), *addendum], wheel.values.wheel_teeth)


def pinion_outline(pinion: Pinion) -> list[Loop]:
    """The leaves and the bore."""
    flank = _radial(pinion, pinion.half_leaf)
    rounding = arc_between(flank.end, (pinion.tip_radius, 0.0), pinion.rounding[0], True)
    return _outline(pinion, [flank, rounding], pinion.values.pinion_teeth)


def _outline(gear: Wheel | Pinion, right: list[Edge], teeth: int) -> list[Loop]:
    """Of a gear with this right flank, from the floor to the tip."""
    left = other_flank(right)
    tip = [arc_between(right[-1].end, left[0].start, (0.0, 0.0), True)] if isinstance(gear, Wheel) else []
    (x, y), pitch = left[-1].end, 360.0 / teeth
    next_foot = polar(gear.floor_radius, pitch - math.degrees(math.atan2(y, x)))
    floor = arc_between((x, y), next_foot, (0.0, 0.0), True)
    return gear_outline(LAYER, [*right, *tip, *left, floor], teeth, gear.floor_radius)


def _radial(gear: Wheel | Pinion, half: float) -> Line:
    """The right flank up to the pitch circle."""
    foot = -math.degrees(half)
    return Line(*polar(gear.floor_radius, foot), *polar(gear.pitch_radius, foot))


def tip_left(wheel: Wheel) -> float:
    """Width of a wheel's tooth at its tip, mm; negative beyond its point."""
    radius, angle = wheel.epicycloid(wheel.last_roll)
    return -2.0 * angle * radius


# How do wheel and pinion mesh: distance, play, and how long does a tooth lead evenly?


def distance(values: CycloidalPair) -> float:
    """Of the centres, mm."""
    return values.module * ((values.pinion_teeth + values.wheel_teeth) / 2.0 + values.spread)


def play(values: CycloidalPair) -> float:
    """On the pitch circles, in modules."""
    return math.pi - values.tooth - values.leaf


def lead_after_centres(values: CycloidalPair) -> float:
    """How far a tooth leads evenly beyond the line of centres, in pitches.

    While the rolling circle turns by an angle about its centre, the pinion, of twice its radius, turns by half of it.
    """
    return Wheel(values).last_roll / 2.0 / (2.0 * math.pi / values.pinion_teeth)


LEAST_TIP, LEAST_PLAY, LEAST_ROOM = 0.02, 0.02, 0.05  # modules


def conflicts(values: CycloidalPair) -> Iterator[Conflict]:
    wheel, pinion, module = Wheel(values), Pinion(values), values.module
    if tip_left(wheel) < LEAST_TIP * module:
        yield Conflict(
            "addendum", f"makes the teeth of the wheel pointed: {tip_left(wheel) / module:.3g} modules are left at the tip"
        )
    if play(values) < LEAST_PLAY:
        yield Conflict(
            "leaf", f"leaves no play: with a tooth of {values.tooth:g} modules it must be less than 3.12 - {values.tooth:g}"
        )
    if pinion.floor_radius < LEAST_ROOM * module or wheel.floor_radius < LEAST_ROOM * module:
        yield Conflict("pinion_dedendum", "leaves no core: it must be less than half the number of leaves")
    elif distance(values) - wheel.tip_radius - pinion.floor_radius < LEAST_ROOM * module:
        least = values.addendum - values.spread + LEAST_ROOM
        yield Conflict(
            "pinion_dedendum", f"lets the wheel's tips meet the floor of the pinion: it must be at least {least:.3g}"
        )
    if distance(values) - pinion.tip_radius - wheel.floor_radius < LEAST_ROOM * module:
        least = (pinion.tip_radius - pinion.pitch_radius) / module - values.spread + LEAST_ROOM
        yield Conflict("wheel_dedendum", f"lets the leaves meet the floor of the wheel: it must be at least {least:.3g}")


def draw(values: CycloidalPair) -> dict[str, Sheet]:
    """Pinion and wheel."""
    return sheets_of(pinion=pinion_outline(Pinion(values)), wheel=wheel_outline(Wheel(values)))


def scene_text(values: CycloidalPair) -> str:
    """The text of scene.toml."""
    return gear_pair_scene(values, "A wheel with cycloidal teeth and its pinion", "Cycloidal gears", distance(values))


DESIGN = Design("cycloidal_pair", "Cycloidal wheel and pinion", CycloidalPair, draw, scene_text, conflicts)
