"""Pin-wheel escapement of a tower clock with its pendulum: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import angle_of, arc_between, circle, polar, rounded, turned
from watchsim.construction.parts import Arms, pendulum, pendulum_clock
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line, Point

# Which numbers does the designer of a pin-wheel escapement choose?
#
# A tower clock's size. Angles of lock and lift are at the pendulum's pivot, of the drop at the wheel's.

GOODRICH = "Goodrich, The Modern Clock (1905), ch. IX"
AS_GRAHAM = "as usual with a dead-beat anchor"


@dataclass(frozen=True)
class PinWheel:
    pins: int = dim(30, "", 16, 60, "of the escape wheel, half round", CHOSEN)
    pin_circle: float = dim(50.0, "mm", 5.0, 300.0, "radius of the circle of the pins' centres", CHOSEN)
    pin_diameter: float = dim(2.4, "mm", 0.2, 15.0, "of the pins before their upper half is cut away", CHOSEN)
    arm_ratio: float = dim(1.0, "", 0.75, 1.5, "length of the anchor's arms by the diameter of the pin circle", GOODRICH)
    lift: float = dim(2.0, "°", 0.5, 5.0, "pendulum, while a pin drives an impulse face", AS_GRAHAM)
    lock: float = dim(0.5, "°", 0.05, 2.0, "pendulum, from the drop of a pin until it is on the impulse face", AS_GRAHAM)
    drop: float = dim(1.2, "°", 0.1, 4.0, "wheel, free from a let-off to the next lock", AS_GRAHAM)
    reach: float = dim(4.0, "°", 1.0, 10.0, "of the dead faces, at the pivot, from their corners", CHOSEN)
    pendulum: float = dim(994.0, "mm", 100.0, 5000.0, "from the pivot to the middle of the bob", "beats seconds")
    bob_radius: float = dim(110.0, "mm", 5.0, 600.0, "of the bob, a disc", CHOSEN)
    bob_mass: float = dim(12.0, "kg", 0.01, 500.0, "of the bob", CHOSEN)
    q_factor: float = dim(
        300.0, "", 5.0, 1e6, "quality factor of the pendulum without the escapement", "estimate: low, settles soon"
    )
    torque: float = dim(24.0, "mN·m", 1e-3, 1e5, "of the train on the escape wheel", CHOSEN)
    wheel_inertia: float = dim(2e5, "g·mm²", 1.0, 1e9, "escape wheel with the train as felt there", CHOSEN)
    gravity: float = dim(9.81, "m/s²", 0.1, 30.0, "acceleration of gravity", "mean on the ground")
    friction: float = dim(0.1, "", 0.0, 0.4, "coefficient of friction, pins on pallets", "hardened steel, oiled")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, pins on pallets", CHOSEN)
    start: float = dim(2.4, "°", 0.3, 10.0, "pendulum, from rest, where it is let go", CHOSEN)


# Where do the corners of the pallets of a pin-wheel escapement lie?
#
# The wheel's axis O is the origin and it turns clockwise; the pendulum's pivot P stands above the rightmost point of the pin
# circle, so that the pins between the anchor's arms move straight away from P. A pin rests on the upper pallet (side -1, on the
# right), drives it to the right, drops on the lower one (side 1, on the left), drives that to the left, and is gone. Resting
# faces are arcs about P. Of a pin the half that looks down is left; its upper side is flat along the radius. Pallets are in the
# pendulum's frame, that is about P. Millimetres, degrees.


@dataclass(frozen=True)
class PinAnchor:
    """What follows from the dimensions."""

    values: PinWheel

    @property
    def half_pitch(self) -> float:
        return 180.0 / self.values.pins

    @property
    def driven(self) -> float:
        """Turn of the wheel while a pin drives a pallet."""
        return self.half_pitch - self.values.drop

    @property
    def pin(self) -> float:
        """Radius of a pin."""
        return self.values.pin_diameter / 2.0

    @property
    def pivot(self) -> Point:
        return (self.values.pin_circle, 2.0 * self.values.arm_ratio * self.values.pin_circle)

    @property
    def unlocked(self) -> float:
        return (self.values.lift - self.values.lock) / 2.0

    @property
    def released(self) -> float:
        return (self.values.lift + self.values.lock) / 2.0

    def locked(self, side: int) -> float:
        """Polar angle of a pin that rests on a pallet: the ways on both are even about the line from O to the right."""
        return (self.driven - side * self.half_pitch) / 2.0

    def from_pivot(self, point: Point, pendulum: float) -> Point:
        """A place of the movement in the pendulum's frame, the pendulum at that angle."""
        return turned((point[0] - self.pivot[0], point[1] - self.pivot[1]), -pendulum)

    def corners(self, side: int) -> tuple[Point, Point]:
        """Where a pallet's resting face ends, and where a pin leaves it.

        As a pin is unlocked the corner is at its lowest point, seen from P; as it is let off, beside it at the edge of its
        flat.
        """
        centre = polar(self.values.pin_circle, self.locked(side))
        x, y = self.from_pivot(centre, side * self.unlocked)
        away = math.hypot(x, y)
        locking = (x * (1.0 + self.pin / away), y * (1.0 + self.pin / away))
        edge = polar(self.values.pin_circle - side * self.pin, self.locked(side) - self.driven)
        return locking, self.from_pivot(edge, -side * self.released)


LEAST_DRIVEN = 1.0  # degrees of the wheel
SLOPES = (20.0, 80.0)  # degrees of an impulse face from the resting face
LEAST_SPACE = 0.5  # of a pin's radius, between two pins
SPARE = 0.3  # degrees of resting face beyond the start


def conflicts(values: PinWheel) -> Iterator[Conflict]:
    anchor = PinAnchor(values)
    if values.lock >= values.lift:
        yield Conflict("lock", f"must be less than the lift of {values.lift:g}°: the impulse would end before the middle")
    if values.start <= anchor.released:
        yield Conflict("start", f"must be more than {anchor.released:.4g}°, else no pin is let off")
    most = anchor.unlocked + values.reach - SPARE
    if values.start > most:
        words = f"must be more than {values.start - most + values.reach:.4g}°"
        yield Conflict("reach", f"{words}: pins would run past the resting faces")
    if anchor.driven < LEAST_DRIVEN:
        most = anchor.half_pitch - LEAST_DRIVEN
        yield Conflict("drop", f"must be at most {most:.4g}° with {values.pins} pins: nothing would be left for the impulse")
        return
    yield from _drive(values, anchor)
    chord = 2.0 * values.pin_circle * math.sin(math.radians(anchor.half_pitch))
    if (2.0 + LEAST_SPACE) * anchor.pin > chord:
        most = 2.0 * chord / (2.0 + LEAST_SPACE)
        yield Conflict("pin_diameter", f"must be at most {most:.3g} mm: there is hardly any space between two pins")
    for side in (1, -1):
        slope = _slope(anchor, side)
        if not SLOPES[0] <= slope <= SLOPES[1]:
            name = "pin_diameter" if slope > SLOPES[1] else "lift"
            words = f"gives an impulse face that falls by {slope:.3g}° from the resting face"
            yield Conflict(name, f"{words}; {SLOPES[0]:g}° to {SLOPES[1]:g}° work")


def _drive(values: PinWheel, anchor: PinAnchor) -> Iterator[Conflict]:
    """The swing that the drive would keep up if none of its work were lost but by damping: w = π k A² / 2 Q in a beat."""
    stiffness = values.bob_mass * values.gravity * 1e-3 * values.pendulum
    work = 1e-3 * values.torque * math.radians(anchor.driven)
    swing = math.degrees(math.sqrt(2.0 * work * values.q_factor / (math.pi * stiffness)))
    most = anchor.unlocked + values.reach - SPARE
    if swing > most:
        words = f"must be less than {values.torque * (most / swing) ** 2:.4g} mN·m"
        yield Conflict("torque", f"{words}: without friction the pendulum would swing by {swing:.3g}°, past the resting faces")
    if swing < anchor.released:
        words = f"must be more than {values.torque * (anchor.released / swing) ** 2:.4g} mN·m"
        yield Conflict("torque", f"{words}: the pendulum would swing by {swing:.3g}° at most, and let off no pin")


def _slope(anchor: PinAnchor, side: int) -> float:
    """Of an impulse face, from the direction in which the resting face goes on."""
    locking, let_off = anchor.corners(side)
    ahead = angle_of(locking) + side * 90.0
    return side * ((ahead - angle_of(let_off, locking) + 180.0) % 360.0 - 180.0)


# What are the outlines of a pin-wheel escapement's wheel and pendulum?
#
# PINS and PALLETS touch; the wheel's RIM, the ANCHOR with its two arms, ROD and BOB are drawn only. Millimetres.

RIM, HUB, BORE = 0.1, 0.17, 0.04  # breadth of the rim and radii, by the pin circle
ARMS, ARM, FILLET = 6, 0.07, 0.05
BOSS, HOLE, LEG, ROD = 0.11, 0.04, 0.045, 0.05  # of the anchor: radii, half the width of its arms and of the rod


def wheel(anchor: PinAnchor) -> list[Loop]:
    """Pins on a rim with arms; pin 0 on the x axis."""
    size = anchor.values.pin_circle
    outer, inner = size + 2.0 * anchor.pin, size * (1.0 - RIM) - anchor.pin
    arms = Arms(ARMS, ARM * size, HUB * size, inner, FILLET * size)
    return [
        *(half_pin(anchor, i * 2.0 * anchor.half_pitch) for i in range(anchor.values.pins)),
        circle("RIM", (0.0, 0.0), outer),
        *arms.windows("RIM"),
        circle("RIM", (0.0, 0.0), BORE * size, hole=True),
    ]


def half_pin(anchor: PinAnchor, bearing: float) -> Loop:
    """The half of a round pin that goes ahead."""
    size = anchor.values.pin_circle
    inner, outer = polar(size - anchor.pin, bearing), polar(size + anchor.pin, bearing)
    return Loop((arc_between(inner, outer, polar(size, bearing), True), Line(*outer, *inner)), "PINS")


def pallet(anchor: PinAnchor, side: int) -> Loop:
    """The lower pallet on the left (side 1) or the upper one on the right (-1): resting face, impulse face, back."""
    locking, let_off = anchor.corners(side)
    foot = angle_of(locking) - side * anchor.values.reach
    high, low = polar(math.hypot(*locking), foot), polar(math.hypot(*let_off), foot)
    edges: list[Edge] = [
        Line(*let_off, *locking),
        arc_between(locking, high, (0.0, 0.0), side < 0),
        Line(*high, *low),
        arc_between(low, let_off, (0.0, 0.0), side > 0),
    ]
    loop = Loop(tuple(edges), "PALLETS")
    return loop if side > 0 else loop.reversed()


def arms(anchor: PinAnchor) -> Loop:
    """A boss from which two arms reach down to the feet of the pallets, one on either side of the pins."""
    size = anchor.values.pin_circle
    boss, half = BOSS * size, LEG * size
    left, right = _leg(anchor, 1, half), _leg(anchor, -1, half)
    crotch = -boss - 3.0 * half
    corners: list[tuple[Point, float]] = [
        (polar(boss, 40.0), 0.6 * boss),
        (polar(boss, 140.0), 0.6 * boss),
        (left[0], 0.4 * half),
        (left[1], 0.4 * half),
        ((0.0, crotch), 0.5 * half),
        (right[1], 0.4 * half),
        (right[0], 0.4 * half),
    ]
    return rounded("ANCHOR", corners, yielding=True)


def _leg(anchor: PinAnchor, side: int, half: float) -> tuple[Point, Point]:
    """The outer and the inner end of an arm, at the foot of its pallet."""
    locking, let_off = anchor.corners(side)
    foot, end = angle_of(locking) - side * anchor.values.reach, math.hypot(*let_off)
    beside = math.degrees(half / end)
    return polar(end, foot - side * 1.5 * beside), polar(end, foot + side * 0.5 * beside)


CLEAR = 1e-5  # degrees by which the pin stands off the pallet at the start
IRON = 7200.0  # kg/m³


def scene_text(values: PinWheel) -> str:
    """The text of scene.toml: a pin at rest on the lower pallet, the pendulum about to be let go."""
    anchor = PinAnchor(values)
    words = "A pin-wheel escapement with its pendulum, drawn to these dimensions:"
    wheel_angle = (anchor.locked(1) + CLEAR) % (2.0 * anchor.half_pitch)
    return toml.scene(
        toml.head(values, words, f"Pin-wheel escapement, {values.pins} pins", gravity=values.gravity),
        toml.body(
            *("wheel", "escape_wheel", "PINS", "turns clockwise"),
            draw="RIM",
            position=toml.ORIGIN,
            angle=toml.Noted(f"{wheel_angle!r}°", "a pin just off the resting face of the lower pallet"),
            inertia=f"{values.wheel_inertia:.15g} g·mm²",
        ),
        toml.body(
            *("pendulum", "pendulum", "PALLETS", "with the anchor; let go on the right"),
            position=toml.at(*anchor.pivot),
            angle=f"{values.start!r}°",
        ),
        *pendulum_clock(values, "wheel.PINS pendulum.PALLETS", IRON, 4.0),
    )


def draw(values: PinWheel) -> dict[str, Sheet]:
    """Wheel, and pendulum with its anchor."""
    anchor, size = PinAnchor(values), values.pin_circle
    hanging = pendulum(values, [pallet(anchor, side) for side in (1, -1)], arms(anchor), HOLE * size, ROD * size)
    return sheets_of(escape_wheel=wheel(anchor), pendulum=hanging)


DESIGN = Design("pin_wheel", "Pin-wheel escapement of a tower clock with its pendulum", PinWheel, draw, scene_text, conflicts)
