"""Graham's dead-beat escapement with its pendulum: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, Impossible, dim, sheets_of
from watchsim.construction.outline import along, angle_of, arc_between, around, circle, polar, turned
from watchsim.construction.parts import pendulum, pendulum_clock
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line, Point

# Which numbers does the designer of a dead-beat escapement with its pendulum choose?
#
# Angles of lock and lift are at the pendulum's pivot, of drop and tooth at the wheel's.

USUAL = "usual in pendulum clocks"


@dataclass(frozen=True)
class Graham:
    teeth: int = dim(30, "", 12, 60, "teeth of the escape wheel", USUAL)
    embraced: float = dim(7.5, "", 2.5, 14.5, "tooth spaces between the two lockings, a whole number and a half", USUAL)
    tip_radius: float = dim(20.0, "mm", 2.0, 200.0, "escape wheel, to the tips of its teeth", CHOSEN)
    tip_width: float = dim(0.15, "°", 0.02, 2.0, "of a tooth's tip, at the wheel's centre", CHOSEN)
    undercut: float = dim(6.0, "°", 1.0, 20.0, "of a tooth's front, from the radius", "about 5°")
    back: float = dim(14.0, "°", 2.0, 40.0, "of a tooth's back, from the radius", CHOSEN)
    lift: float = dim(2.0, "°", 0.3, 8.0, "pendulum, while a tooth drives an impulse face", f"{USUAL}: 1.5° to 3°")
    lock: float = dim(
        0.4, "°", 0.02, 3.0, "pendulum, from the drop of a tooth until it is on the impulse face", f"{USUAL}: ¼° to ½°"
    )
    drop: float = dim(1.5, "°", 0.1, 5.0, "wheel, free from a let-off to the next lock", f"{USUAL}: 1° to 2°")
    pendulum: float = dim(248.5, "mm", 20.0, 5000.0, "from the pivot to the middle of the bob", "beats half seconds")
    bob_radius: float = dim(30.0, "mm", 2.0, 500.0, "of the bob, a disc", CHOSEN)
    bob_mass: float = dim(0.5, "kg", 1e-3, 100.0, "of the bob", CHOSEN)
    q_factor: float = dim(
        200.0, "", 5.0, 1e6, "quality factor of the pendulum without the escapement", "estimate: low, settles soon"
    )
    torque: float = dim(0.24, "mN·m", 1e-4, 1e4, "of the train on the escape wheel", CHOSEN)
    wheel_inertia: float = dim(400.0, "g·mm²", 1e-2, 1e8, "escape wheel with the train as felt there", CHOSEN)
    gravity: float = dim(9.81, "m/s²", 0.1, 30.0, "acceleration of gravity", "mean on the ground")
    friction: float = dim(0.1, "", 0.0, 0.5, "coefficient of friction, teeth on pallets", "hardened steel, oiled")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, teeth on pallets", CHOSEN)
    start: float = dim(2.0, "°", 0.5, 12.0, "pendulum, from rest, where it is let go", CHOSEN)

    title: ClassVar[str] = "Dead-beat escapement"
    recoil = 0.0  # degrees by which a locking face leans from the arc about the pivot; a dimension of the recoil anchor


# Where do the corners of the pallets lie, and where does a tooth rest on them?
#
# The wheel's axis is the origin, the pendulum's pivot lies above it where the tangents at the two lockings meet; the wheel
# turns clockwise. The pendulum's angle is positive with the entry pallet, on the left, deep in the wheel. Pallets are in the
# pendulum's frame, that is about its pivot. With the pendulum at +unlocked a tooth leaves the entry pallet's locking face, at
# -released its impulse face; the exit pallet is worked at the opposite angles. Millimetres, degrees.


@dataclass(frozen=True)
class Anchor:
    """What follows from the dimensions."""

    values: Graham

    @property
    def half_span(self) -> float:
        return self.values.embraced * 180.0 / self.values.teeth

    @property
    def pallet_width(self) -> float:
        """Of a pallet, at the wheel's centre: half a pitch without drop and tip."""
        return 180.0 / self.values.teeth - self.values.drop - self.values.tip_width

    @property
    def half_angle_seen(self) -> float:
        """Half the angle between the pallets, seen from the pivot."""
        return 90.0 - self.half_span

    @property
    def distance(self) -> float:
        return self.values.tip_radius / math.cos(math.radians(self.half_span))

    @property
    def unlocked(self) -> float:
        return (self.values.lift - self.values.lock) / 2.0

    @property
    def released(self) -> float:
        return (self.values.lift + self.values.lock) / 2.0

    def from_pivot(self, bearing: float, pendulum: float) -> Point:
        """A tooth's tip at `bearing` (from the line of centres, positive on the left) in the pendulum's frame."""
        x, y = polar(self.values.tip_radius, 90.0 + bearing)
        return turned((x, y - self.distance), -pendulum)

    def corners(self, side: int) -> tuple[Point, Point]:
        """Locking corner and let-off corner of the entry (side 1) or exit (-1) pallet."""
        half = self.pallet_width / 2.0
        locking = self.from_pivot(side * self.half_span + half, side * self.unlocked)
        return locking, self.from_pivot(side * self.half_span - half, -side * self.released)

    def face_direction(self, side: int) -> float:
        """Of the locking face at its corner, away from it: along the arc about the pivot, leaning by `recoil`.

        The entry pallet's runs clockwise about the pivot and leans outwards, the exit pallet's counter-clockwise and inwards.
        """
        locking, _ = self.corners(side)
        bearing = math.degrees(math.atan2(locking[1], locking[0]))
        return bearing - side * 90.0 + self.values.recoil

    def wheel_angle(self, pendulum: float) -> float:
        """Of the wheel, with a tooth on the entry pallet's locking face; at 0 a tip is on the x axis."""
        half = self.pallet_width / 2.0
        if self.values.recoil == 0.0:
            return 90.0 + self.half_span + half
        (x, y), way = self.corners(1)[0], math.radians(self.face_direction(1) + pendulum)
        x, y = turned((x, y), pendulum)
        y += self.distance
        along = x * math.cos(way) + y * math.sin(way)
        rest = along * along - (x * x + y * y - self.values.tip_radius**2)
        if rest < 0.0:
            raise Impossible("start", "lies so far out that no tooth reaches the locking face")
        ends = [-along + sign * math.sqrt(rest) for sign in (-1.0, 1.0)]
        step = min(ends, key=abs)
        return math.degrees(math.atan2(y + step * math.sin(way), x + step * math.cos(way)))


# What are the outlines of the anchor and its pendulum?
#
# A pallet runs from the let-off corner over the impulse face to the locking face. In the pendulum's frame, millimetres.

REACH = 16.0  # degrees, at the pivot, from the corners to the foot of a pallet
HOLD = 5.0  # degrees of it that the anchor holds
HUB, BORE, ROD = 0.16, 0.05, 0.1  # radii, and half the width of the rod, by the radius of the wheel


def pallet(anchor: Anchor, side: int) -> Loop:
    """The entry pallet (side 1) or the exit pallet (-1), counter-clockwise."""
    locking, let_off = anchor.corners(side)
    foot = angle_of((0.0, -1.0)) - side * (anchor.half_angle_seen + REACH)
    back = polar(math.hypot(*let_off), foot)
    face = _face(anchor, side, foot)
    arc = arc_between(back, let_off, (0.0, 0.0), side > 0)
    edges: list[Edge] = [arc, Line(*let_off, *locking), face, Line(*face.end, *back)]
    loop = Loop(tuple(edges), "PALLETS")
    return loop.reversed() if side > 0 else loop


def _face(anchor: Anchor, side: int, foot: float) -> Edge:
    """The locking face from its corner to the foot."""
    locking, _ = anchor.corners(side)
    if anchor.values.recoil == 0.0:
        return arc_between(locking, polar(math.hypot(*locking), foot), (0.0, 0.0), side < 0)
    way = anchor.face_direction(side)
    turn = math.radians(foot - angle_of(locking)) % (2.0 * math.pi)
    turn = turn if side < 0 else 2.0 * math.pi - turn
    lean = math.radians(90.0 + side * anchor.values.recoil)  # between the face and the radius outwards
    length = math.hypot(*locking) * math.sin(turn) / math.sin(lean - turn)
    return Line(*locking, *along(locking, way, length))


def arms(anchor: Anchor) -> Loop:
    """A bow over the pivot from foot to foot."""
    size = anchor.values.tip_radius
    half = anchor.half_angle_seen + REACH - HOLD
    radii = [math.hypot(*anchor.corners(side)[0]) for side in (1, -1)]
    outer, inner = max(radii), min(radii)
    left, right = 270.0 - half, 270.0 + half
    hub = HUB * size
    edges: list[Edge] = [
        Line(*polar(outer, right), *polar(1.6 * hub, 90.0 - half / 2.0)),
        arc_between(polar(1.6 * hub, 90.0 - half / 2.0), polar(1.6 * hub, 90.0 + half / 2.0), (0.0, 0.0), True),
        Line(*polar(1.6 * hub, 90.0 + half / 2.0), *polar(outer, left)),
        Line(*polar(outer, left), *polar(inner, left)),
        Line(*polar(inner, left), *polar(hub, 270.0)),
        Line(*polar(hub, 270.0), *polar(inner, right)),
        Line(*polar(inner, right), *polar(outer, right)),
    ]
    return Loop(tuple(edges), "ANCHOR")


CLEAR = 1e-5  # degrees by which the tooth stands off the pallet at the start
BRASS = 8400.0  # kg/m³


def scene_text(values: Graham) -> str:
    """The text of scene.toml: a tooth locked on the entry pallet, the pendulum about to be let go."""
    anchor, title = Anchor(values), f"{values.title}, {values.teeth} teeth"
    wheel_angle = (anchor.wheel_angle(values.start) + CLEAR) % (360.0 / values.teeth)
    return toml.scene(
        toml.head(values, f"{title}, drawn to these dimensions:", title, gravity=values.gravity),
        toml.body(
            *("wheel", "escape_wheel", "TEETH", "turns clockwise"),
            position=toml.ORIGIN,
            angle=toml.Noted(f"{wheel_angle!r}°", "a tooth just off the locking face of the entry pallet"),
            inertia=f"{values.wheel_inertia:.15g} g·mm²",
        ),
        toml.body(
            *("pendulum", "pendulum", "PALLETS", "with the anchor; let go with the entry pallet deep in the wheel"),
            position=toml.at(0, anchor.distance),
            angle=f"{values.start!r}°",
        ),
        *pendulum_clock(values, "wheel.TEETH pendulum.PALLETS", BRASS, 2.0),
    )


DEPTH, RIM, HUB_WHEEL, BORE_WHEEL = 0.2, 0.1, 0.2, 0.06  # by the radius of the wheel
ARMS, ARM = 4, 0.05


def wheel(values: Graham) -> list[Loop]:
    """Teeth, windows and bore."""
    size = values.tip_radius
    pitch = 2.0 * math.pi / values.teeth
    teeth = around("TEETH", _tooth(values), (i * pitch for i in range(values.teeth)))
    inner, outer = HUB_WHEEL * size, (1.0 - DEPTH - RIM) * size
    windows = [_window(90.0 * i, inner, outer, ARM * size) for i in range(ARMS)]
    return [teeth, *windows, circle("TEETH", (0.0, 0.0), BORE_WHEEL * size, hole=True)]


def feet(values: Graham) -> tuple[Point, Point]:
    """Where front and back of tooth 0 meet the floor."""
    size = values.tip_radius
    tip, heel = (size, 0.0), polar(size, values.tip_width)
    return _down(tip, 180.0 - values.undercut, size), _down(heel, 180.0 + values.tip_width - values.back, size)


def _down(corner: Point, way: float, size: float) -> Point:
    """Along `way` from a corner to the floor."""
    floor, x, y = (1.0 - DEPTH) * size, *corner
    dx, dy = polar(1.0, way)
    ahead = -(x * dx + y * dy)
    return along(corner, way, ahead - math.sqrt(ahead * ahead - (x * x + y * y - floor * floor)))


def _tooth(values: Graham) -> list[Edge]:
    """From the foot of one tooth's front to that of the next, counter-clockwise."""
    front, back = feet(values)
    tip, heel = polar(values.tip_radius, 0.0), polar(values.tip_radius, values.tip_width)
    return [
        Line(*front, *tip),
        arc_between(tip, heel, (0.0, 0.0), True),
        Line(*heel, *back),
        arc_between(back, turned(front, 360.0 / values.teeth), (0.0, 0.0), True),
    ]


def gap(values: Graham) -> float:
    """Degrees of floor between two teeth."""
    front, back = feet(values)
    return 360.0 / values.teeth + angle_of(front) - angle_of(back)


def _window(start: float, inner: float, outer: float, half: float) -> Loop:
    """One opening between two arms, clockwise."""
    ends = []
    for radius in (inner, outer):
        lean = math.degrees(math.asin(half / radius))
        ends.append((polar(radius, start + lean), polar(radius, start + 90.0 - lean)))
    (a, b), (c, d) = ends
    edges: list[Edge] = [Line(*c, *a), arc_between(a, b, (0.0, 0.0), True), Line(*b, *d), arc_between(d, c, (0.0, 0.0), False)]
    return Loop(tuple(edges), "TEETH", hole=True)


LEAST_WIDTH, LEAST_GAP, MOST_SPAN = 0.2, 0.3, 80.0


def conflicts(values: Graham) -> Iterator[Conflict]:
    anchor = Anchor(values)
    if abs(values.embraced % 1.0 - 0.5) > 1e-9:
        yield Conflict("embraced", "must be a whole number and a half, else both pallets are worked at once")
    if anchor.half_span > MOST_SPAN or anchor.half_span < 90.0 - MOST_SPAN:
        spread = (
            f"{2.0 * anchor.half_span:.4g}° of the wheel, {2.0 * (90.0 - MOST_SPAN):g}° to {2.0 * MOST_SPAN:g}° can be drawn"
        )
        yield Conflict("embraced", f"with {values.teeth} teeth the pallets embrace {spread}")
    if anchor.pallet_width < LEAST_WIDTH:
        most = 180.0 / values.teeth - values.tip_width - LEAST_WIDTH
        yield Conflict("drop", f"must be less than {most:.4g}°: nothing would be left of the pallets")
    if values.lock >= values.lift:
        yield Conflict("lock", f"must be less than the lift of {values.lift:g}°: the impulse would end before the middle")
    if values.start <= anchor.released:
        yield Conflict("start", f"must be more than {anchor.released:.4g}°, else no tooth is let off")
    if values.back <= values.undercut:
        yield Conflict("back", f"must be more than the undercut of {values.undercut:g}°, else a tooth is thinner at its foot")
    elif gap(values) < LEAST_GAP:
        yield Conflict("back", f"leaves {gap(values):.3g}° between two teeth; {LEAST_GAP:g}° are needed")


def draw(values: Graham) -> dict[str, Sheet]:
    """Wheel, and pendulum with its anchor."""
    anchor, size = Anchor(values), values.tip_radius
    hanging = pendulum(values, [pallet(anchor, side) for side in (1, -1)], arms(anchor), BORE * size, ROD * size)
    return sheets_of(escape_wheel=wheel(values), pendulum=hanging)


DESIGN = Design("graham", "Graham's dead-beat escapement with its pendulum", Graham, draw, scene_text, conflicts)
