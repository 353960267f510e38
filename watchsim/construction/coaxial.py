"""Co-axial escapement with its balance: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import Conflict, Design, dim, sheets_of
from watchsim.construction.outline import along, angle_of, circle, cosine, polar, rounded, sine, to_circle, turned
from watchsim.construction.parts import (
    Arms,
    BalanceWheel,
    Stone,
    ToothForm,
    balance_wheel,
    contour,
    fork_outline,
    guard,
    horn_radius,
    impulse_pin,
    safety_roller,
    too_little_draw,
)
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point

# Which dimensions does a co-axial escapement have?
#
# Proportions after descriptions of the flat form (two coplanar impulses, three stones on the lever); no maker's drawing is
# public. Angles in degrees: of the wheel, where nothing else is said. Why limits are where they are: docs/guide/coaxial.md, and
# `watchsim check --turn` of a design beyond them.

LAYOUT = "construction by overlapping circles, docs/guide/coaxial.md"
RUNS = "chosen by runs from 60° to 330°, docs/guide/coaxial.md"
PLAYTNER = "as in a lever, Playtner 1910"
WEIGHED = "as drawn in steel 0.06 to 0.09, and the train, docs/guide/coaxial.md"
ESTIMATE = "estimate: not published for a watch"


@dataclass(frozen=True)
class Coaxial:
    """The numbers a designer chooses; lengths that are not named here scale with the wheel."""

    tip_radius: float = dim(2.25, "mm", 1.2, 4.0, "of the large wheel, to its tips", "R. W. Smith names 4.5 mm across")
    direct_reach: float = dim(9.5, "°", 7.0, 10.5, "half overlap of the tip circle and the roller stone's", LAYOUT)
    direct_lead: float = dim(
        11.25, "°", 10.8, 11.7, "from the waiting tooth to the line wheel-balance, first stone locked", LAYOUT
    )
    stone_ratio: float = dim(0.45, "", 0.3, 0.7, "roller stone's reach from the balance's centre, by the tip radius", LAYOUT)
    stone_lag: float = dim(8.0, "°", 0.0, 12.0, "balance, of the roller stone behind the unlocking pin", RUNS)
    indirect_reach: float = dim(9.5, "°", 7.0, 13.0, "half overlap of the small tip circle and the lever stone's", LAYOUT)
    indirect_lever: float = dim(4.5, "°", 3.5, 8.0, "the same at the lever", LAYOUT)
    indirect_offset: float = dim(0.5, "°", -3.0, 3.0, "lever, with its stone on the line wheel-lever", RUNS)
    indirect_lead: float = dim(11.25, "°", 7.5, 14.0, "from the waiting small tooth to that line, second stone locked", RUNS)
    lock: float = dim(1.5, "°", 0.75, 3.0, "lever, total lock of both stones less the run", PLAYTNER)
    run: float = dim(0.5, "°", 0.1, 1.5, "lever, before the banking, taken off the total lock", PLAYTNER)
    lift: float = dim(8.25, "°", 6.0, 11.0, "lever, from bank to bank less lock and both runs", LAYOUT)
    draw: float = dim(12.0, "°", 8.0, 18.0, "of the locking faces, the lever on its bank", PLAYTNER)
    lift_angle: float = dim(
        38.0, "°", 30.0, 55.0, "balance, while its pin is in the fork", "published for calibres 2500 and 8500 of Omega"
    )
    undercut: float = dim(24.0, "°", 18.0, 32.0, "of the teeth's fronts from the radius, so that tips lock", PLAYTNER)
    pin_radius: float = dim(0.15, "mm", 0.08, 0.25, "of the unlocking pin before part of it is ground away", PLAYTNER)
    shake: float = dim(0.02, "mm", 0.005, 0.05, "by which the slot of the fork is wider than the pin", PLAYTNER)
    horn_clearance: float = dim(0.04, "mm", 0.015, 0.08, "between pin and horn, the lever on its bank", PLAYTNER)
    guard_clearance: float = dim(
        0.034, "mm", 0.015, 0.06, "between guard pin and safety roller, the lever on its bank", PLAYTNER
    )
    wheel_inertia: float = dim(0.1, "mg·cm²", 0.01, 10.0, "both wheels with the train as felt there", WEIGHED)
    lever_inertia: float = dim(0.06, "mg·cm²", 0.005, 5.0, "lever with its stones", ESTIMATE)
    balance_inertia: float = dim(12.0, "mg·cm²", 0.5, 200.0, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(
        25200.0, "vph", 14400.0, 36000.0, "of the balance, in beats per hour", "calibres 2500 and 8500 of Omega"
    )
    q_factor: float = dim(250.0, "", 50.0, 1000.0, "quality factor of the balance without the escapement", "often 200 to 300")
    torque: float = dim(0.48, "µN·m", 0.05, 20.0, "of the train on the escape wheel", "for 290°, docs/guide/coaxial.md")
    friction: float = dim(0.15, "", 0.0, 0.3, "coefficient of friction, in all contacts", "0.10 to 0.20, steel on ruby")
    restitution: float = dim(0.0, "", 0.0, 0.6, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(290.0, "°", 60.0, 330.0, "balance, from rest, where it is let go", "chosen")


# Which points follow from the dimensions of a co-axial escapement?
#
# The wheel's centre O is the origin, the lever's pivot P stands above it, the balance's centre B to the right; the wheel turns
# clockwise. The locking corners stand on the tip circle where its tangents from P touch, one and a half pitches apart: the
# first to the left of P, the second to the right. A positive lever angle puts the first stone deep. Two circles that overlap
# give each impulse: the tips of the large wheel and the roller stone's about B, the tips of the small wheel and the lever
# stone's about P. Angles in degrees, counter-clockwise from +x; millimetres.

TEETH = 8
PITCH = 360.0 / TEETH
HALF_SPAN = 0.75 * PITCH
FIRST, SECOND = 1, -1  # the locking stones


class Points:
    """Places in the movement and in the parts."""

    def __init__(self, values: Coaxial) -> None:
        self.values = values
        self.scale = values.tip_radius / 2.25
        """What was drawn for a wheel of 4.5 mm is so much larger."""
        self.lever_pivot = (0.0, values.tip_radius / cosine(HALF_SPAN))
        self.bank = (values.lock + values.lift + 2.0 * values.run) / 2.0
        self.let_off = self.bank - values.run
        self.unlocked = self.let_off - values.lock
        """The lever angle (unsigned) at which a locking corner stands on the tip circle."""
        self.stone_reach = values.stone_ratio * values.tip_radius
        """From B to the tip of the roller stone."""
        self.direct_balance = math.degrees(math.asin(values.tip_radius * sine(values.direct_reach) / self.stone_reach))
        """Turn of the balance on either side of the line of centres in which roller stone and tips overlap."""
        apart = values.tip_radius * cosine(values.direct_reach) + self.stone_reach * cosine(self.direct_balance)
        self.balance_bearing = 90.0 + HALF_SPAN - 2.0 * PITCH - values.direct_lead
        self.balance_pivot = polar(-apart, self.balance_bearing + 180.0)
        both = sine(values.indirect_reach + values.indirect_lever)
        self.small_radius = self.lever_pivot[1] * sine(values.indirect_lever) / both
        self.impulse_reach = self.lever_pivot[1] * sine(values.indirect_reach) / both
        """From P to the tip of the lever's impulse stone."""
        self.small_turn = (90.0 + values.indirect_lead - (90.0 - HALF_SPAN)) % PITCH
        """From a large tooth to the next small one, counter-clockwise."""
        dx, dy = (b - p for b, p in zip(self.balance_pivot, self.lever_pivot, strict=True))
        self.lever_to_balance = math.hypot(dx, dy)
        self.fork_bearing = math.degrees(math.atan2(dy, dx))
        """Direction from P to B."""
        half = values.lift_angle / 2.0
        self.pin_reach = self.lever_to_balance * sine(self.bank) / sine(half + self.bank)
        self.slot_width = 2.0 * values.pin_radius + values.shake

    def balance_at(self, lever: float) -> float:
        """Angle of the balance (unsigned) with its pin in the fork at a lever angle (unsigned)."""
        sine_at_pin = self.lever_to_balance * sine(lever) / self.pin_reach
        return math.degrees(math.asin(sine_at_pin)) - lever

    def in_lever(self, point: Point, lever: float) -> Point:
        """A point of the movement in the lever's own frame, with the lever at `lever` degrees."""
        return turned((point[0] - self.lever_pivot[0], point[1] - self.lever_pivot[1]), -lever)

    def in_movement(self, point: Point, lever: float) -> Point:
        """A point of the lever in the movement, with the lever at `lever` degrees."""
        x, y = turned(point, lever)
        return (x + self.lever_pivot[0], y + self.lever_pivot[1])

    def locking_corner(self, side: int) -> Point:
        """Of the first or second stone, in the lever's frame."""
        return self.in_lever(polar(self.values.tip_radius, 90.0 + side * HALF_SPAN), side * self.unlocked)

    def face_direction(self, side: int) -> float:
        """Direction of the locking face away from the wheel, in the lever's frame: leaning to the right by the draw."""
        return 90.0 + side * HALF_SPAN - self.values.draw - side * self.bank

    def locked_tip(self, side: int, lever: float) -> float:
        """Polar angle of the tip that a locking face holds, lever at `lever` degrees to its side."""
        corner = self.in_movement(self.locking_corner(side), side * lever)
        direction = self.face_direction(side) + side * lever
        return angle_of(along(corner, direction, to_circle(corner, direction, self.values.tip_radius)))


# What is the outline of a co-axial escape wheel?
#
# Two wheels on one arbor: the large one (TEETH) locks and gives the direct impulse, the small one (SMALL_TEETH) the indirect
# one.
# Eight pointed teeth each, their fronts undercut so that only tips work, their backs hollow. In the wheel's own frame,
# millimetres; large tooth 0 has its tip on the x axis and the wheel turns clockwise.

ARMS, ARM_WIDTH, WINDOW_FILLET = 4, 0.16, 0.09
RIM_INNER, HUB_RADIUS, BORE_RADIUS = 1.24, 0.42, 0.11


def wheel(points: Points) -> list[Loop]:
    """Both wheels' contours, the windows between the arms and the bore."""
    s = points.scale
    large = ToothForm(points.values.tip_radius, 1.5 * s, 0.02 * s, 0.42 * s, 41.0, 0.62 * s, 0.12 * s)
    small = ToothForm(points.small_radius, 0.68 * points.small_radius, 0.015 * s, 0.15 * s, 42.0, 0.25 * s, 0.05 * s)
    arms = Arms(ARMS, ARM_WIDTH * s, HUB_RADIUS * s, RIM_INNER * s, WINDOW_FILLET * s)
    windows = arms.windows("TEETH")
    bores = [circle(layer, (0.0, 0.0), BORE_RADIUS * s, hole=True) for layer in ("TEETH", "SMALL_TEETH")]
    undercut = points.values.undercut
    second = contour(small, undercut, "SMALL_TEETH", TEETH).moved(math.radians(points.small_turn), (0.0, 0.0))
    return [contour(large, undercut, "TEETH", TEETH), *windows, bores[0], second, bores[1]]


# Where do the stones of a co-axial escapement stand, and what are their outlines?
#
# Three on the lever (two LOCKING_STONES, one IMPULSE_STONE) and one on the roller (IMPULSE_STONE): prisms with two rounded
# edges in their slots. In the frame of the part that holds them, millimetres.

LOCKING_WIDTH, LOCKING_LENGTH = 0.30, 0.62
LEVER_WIDTH, LEVER_LENGTH = 0.17, 0.52
ROLLER_WIDTH, ROLLER_LENGTH = 0.22, 0.46
EDGE = 0.03
UNDER = 0.025  # by which the end of a locking stone stays off the tip circle behind its corner
RELIEF = 25.0  # of the ends of impulse stones behind their tips, from the circle they run on, degrees: the tooth that has given
# its impulse waits behind the lever's stone


def locking_stone(points: Points, side: int) -> Stone:
    """The first (+1) or second (-1): its end stays off the tips that pass when it has let one go."""
    s = points.scale
    tip, face = points.locking_corner(side), points.face_direction(side)
    straight = Stone(tip, face, LOCKING_WIDTH * s, LOCKING_LENGTH * s, 0.0)
    x, y = points.in_movement(straight.at(0.0, straight.width), side * points.unlocked)
    turn = face + side * points.unlocked
    return replace(straight, relief=to_circle((x, y), turn, points.values.tip_radius + UNDER * s))


def lever_stone(points: Points) -> Stone:
    """The lever's impulse stone: its face looks at the teeth that come from the left, and points at the lever's pivot."""
    s = points.scale
    bearing = -90.0 - points.values.indirect_offset
    width = LEVER_WIDTH * s
    return Stone(
        polar(points.impulse_reach, bearing), bearing + 180.0, width, LEVER_LENGTH * s, width * math.tan(math.radians(RELIEF))
    )


def roller_stone(points: Points) -> Stone:
    """The roller's impulse stone in the balance's frame, whose pin points at the lever at angle 0."""
    s = points.scale
    bearing = points.balance_bearing + 180.0 - points.values.stone_lag
    width = ROLLER_WIDTH * s
    tip = polar(points.stone_reach, bearing)
    return Stone(tip, bearing + 180.0, width, ROLLER_LENGTH * s, width * math.tan(math.radians(RELIEF)))


# What are the outlines of the fork and of the guard pin of a co-axial escapement's lever?
#
# Drawn with the lever's pivot at the origin and the balance above, then turned to where the balance is. Millimetres. The right
# half is drawn, the left one is its mirror image.

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
        clearance = points.values.horn_clearance
        self.horn_radius = horn_radius(points.pin_reach, self.pin_centre, radius, self.pin_edge, clearance)
        """Of the horns about the balance's centre, lever on the bank: past the farthest point of the pin's edge."""

    def balance_from_bank(self, side: int) -> Point:
        """The balance's centre in this frame, lever on the first (+1) or second (-1) stone's bank."""
        return polar(self.points.lever_to_balance, 90.0 - side * self.points.bank)

    def guard_centre(self) -> float:
        """Centre of the guard pin's rounding above the lever's pivot."""
        x, y = self.balance_from_bank(1)
        reach = SAFETY_RADIUS * self.scale + self.points.values.guard_clearance + GUARD_TIP * self.scale
        return y - math.sqrt(reach**2 - x * x)


def fork_of(fork: Fork) -> Loop:
    """The fork, drawn with the lever on the second stone's bank."""
    s, bearing = fork.scale, -90.0 + HORN_END + fork.points.bank
    centre = fork.balance_from_bank(-1)
    foot, hip = (0.13 * s, fork.neck + 0.13 * s), (0.36 * s, fork.points.lever_to_balance - HIP * s)
    outside = [(fork.stem_half, fork.neck), foot, hip, polar(fork.horn_radius + HORN_TIP * s, bearing, centre)]
    tip, radii = polar(fork.horn_radius, bearing, centre), [share * s for share in (0.3, 0.15, 0.025, 0.025, 0.015, 0.08)]
    return fork_outline(outside, tip, (centre, fork.horn_radius), (fork.slot_half, fork.slot_bottom), radii)


def guard_pin(fork: Fork) -> Loop:
    """The guard: a round foot, a bar and a rounded point."""
    s = fork.scale
    foot = (fork.points.lever_to_balance - GUARD_FOOT * s, GUARD_FOOT_RADIUS * s)
    tip, half, slope = GUARD_TIP * s, GUARD_HALF * s, GUARD_SLOPE
    drop = (half - tip * cosine(slope)) * cosine(slope) / sine(slope)
    return guard("GUARD", fork.guard_centre(), tip, half, slope, drop, foot, 0.025 * s)


# What is the outline of a co-axial escapement's lever?
#
# Two locking stones and an impulse stone in the slots of a body with hub, arms and tail (ARMS), a fork with horns (FORK) and a
# guard pin (GUARD). In the lever's own frame, millimetres: pivot at the origin, wheel below, balance to the right.

EXPOSED = 0.27  # length of a locking stone outside its slot; of the impulse stone:
EXPOSED_IMPULSE = 0.2
SHELLAC = 0.006  # gap between stone and slot
WALL = 0.11  # metal around the slots
HUB, BORE = 0.24, 0.085
TAIL_LENGTH, TAIL_HALF, TAIL_ROOT = 1.75, 0.085, 0.13
BANKING_WAY, BANKING_RADIUS = 1.55, 0.1  # of the banking pins along the tail, from the pivot

Part = tuple[Point, float]  # a corner and its fillet


def lever(points: Points) -> list[Loop]:
    """All outlines of the lever."""
    s = points.scale
    fork = Fork(points)
    turn = math.radians(points.fork_bearing - 90.0)
    return [
        *(locking_stone(points, side).loop("LOCKING_STONES", EDGE * s) for side in (FIRST, SECOND)),
        lever_stone(points).loop("IMPULSE_STONE", EDGE * s),
        body(points, fork),
        circle("ARMS", (0.0, 0.0), BORE * s, hole=True),
        fork_of(fork).moved(turn, (0.0, 0.0)),
        guard_pin(fork).moved(turn, (0.0, 0.0)),
    ]


def body(points: Points, fork: Fork) -> Loop:
    """Arms, tail and hub, counter-clockwise from the fork's neck."""
    s = points.scale
    first, second, middle = locking_stone(points, FIRST), locking_stone(points, SECOND), lever_stone(points)

    def ahead(way: float, right: float) -> Point:
        """A place `way` towards the balance and `right` of that line (the wheel's side)."""
        return turned((right, way), points.fork_bearing - 90.0)

    def behind(way: float, right: float) -> Point:
        return ahead(-way, right)

    wall, stem = WALL * s, fork.stem_half
    top = second.length + wall
    corners: list[Part] = [
        (ahead(fork.neck, stem), 0.0),
        (ahead(fork.neck, -stem), 0.0),
        (second.at(0.55 * second.length, second.width + wall + 0.03 * s), 0.25 * s),
        (second.at(top, second.width + wall), 0.1 * s),
        (second.at(top, -wall), 0.1 * s),
        (second.at(0.75 * second.length, -wall), 0.3 * s),
        (polar(1.25 * HUB * s, points.fork_bearing + 70.0), 0.3 * s),
        (behind(HUB * s, -TAIL_ROOT * s), 0.2 * s),
        (behind(TAIL_LENGTH * s, -TAIL_HALF * s), 0.06 * s),
        (behind(TAIL_LENGTH * s, TAIL_HALF * s), 0.06 * s),
        (behind(1.4 * HUB * s, TAIL_ROOT * s), 0.15 * s),
        (first.at(first.length + wall, first.width + 0.5 * wall), 0.25 * s),
        (first.at(first.length + wall, -wall), 0.1 * s),
        *mouth(first, EXPOSED * s, s),
        (polar(1.05 * HUB * s, 215.0), 0.2 * s),
        (middle.at(middle.length + 0.1 * s, -wall), 0.15 * s),
        *mouth(middle, EXPOSED_IMPULSE * s, s),
        (middle.at(middle.length + 0.3 * s, middle.width + wall), 0.3 * s),
        (polar(1.35 * HUB * s, points.fork_bearing - 28.0), 0.3 * s),
        (second.at(0.5 * second.length, -wall - 0.04 * s), 0.12 * s),
        *mouth(second, EXPOSED * s, s),
    ]
    return rounded("ARMS", corners)


def mouth(stone: Stone, exposed: float, scale: float) -> list[Part]:
    """The slot that holds a stone, from the left end of the holder's lower edge to the right one."""
    wall, near, far, end = WALL * scale, -SHELLAC * scale, stone.width + SHELLAC * scale, stone.length + SHELLAC * scale
    return [
        (stone.at(exposed, -wall), 0.04 * scale),
        (stone.at(exposed, near), 0.02 * scale),
        (stone.at(end, near), EDGE * scale),
        (stone.at(end, far), EDGE * scale),
        (stone.at(exposed, far), 0.02 * scale),
        (stone.at(exposed, stone.width + wall), 0.04 * scale),
    ]


def banking(points: Points) -> list[Loop]:
    """Two pins that the lever's tail meets at the ends of its travel, in the movement."""
    s = points.scale
    # The tail narrows along its length: the perpendicular from the pin's centre to its side.
    slope = math.atan2((TAIL_ROOT - TAIL_HALF) * s, (TAIL_LENGTH - HUB) * s)
    slope_under = math.atan2((TAIL_ROOT - TAIL_HALF) * s, (TAIL_LENGTH - 1.4 * HUB) * s)
    loops = []
    for side in (FIRST, SECOND):
        lean, start = (slope, HUB) if side == SECOND else (slope_under, 1.4 * HUB)
        half = TAIL_ROOT * s - (BANKING_WAY - start) * s * math.tan(lean)
        across = half + BANKING_RADIUS * s / math.cos(lean)
        right = across if side == FIRST else -across
        place = turned((right, -BANKING_WAY * s), points.fork_bearing - 90.0)
        loops.append(circle("PINS", points.in_movement(place, side * points.bank), BANKING_RADIUS * s))
    return loops


# What are the outlines of a co-axial escapement's balance?
#
# The table (TABLE) carries the stone of the direct impulse (IMPULSE_STONE) and the D-shaped unlocking pin (PIN); in another
# plane the safety roller with its crescent (SAFETY); the balance's RIM is drawn only. In the balance's own frame, millimetres:
# at angle 0 the pin points at the lever.

TABLE_RADIUS, STAFF_RADIUS = 0.93, 0.16
CRESCENT_EDGE = 0.02
ARMS_ROLLER = 4


def roller(points: Points) -> list[Loop]:
    """Table with the staff's hole, stone, pin, safety roller; the balance's rim."""
    s, fork, radius = points.scale, Fork(points), points.values.pin_radius
    turn = math.radians(points.fork_bearing - 90.0)
    pin = impulse_pin(points.pin_reach, fork.pin_centre, radius, (1.0 - 2.0 * PIN_GROUND) * radius, fork.pin_edge)
    return [
        circle("TABLE", (0.0, 0.0), _table_radius(points)),
        circle("TABLE", (0.0, 0.0), STAFF_RADIUS * s, hole=True),
        roller_stone(points).loop("IMPULSE_STONE", EDGE * s),
        pin.moved(turn, (0.0, 0.0)),
        safety_roller(SAFETY_RADIUS * s, CRESCENT_DEPTH * s, CRESCENT_HALF, CRESCENT_EDGE * s).moved(turn, (0.0, 0.0)),
        circle("SAFETY", (0.0, 0.0), STAFF_RADIUS * s, hole=True),
        *wheel_of(points).rim(),
    ]


def wheel_of(points: Points) -> BalanceWheel:
    """Rim and hairspring of the balance."""
    reach = max(_table_radius(points), points.stone_reach, points.pin_reach)
    return balance_wheel(points.values.balance_inertia, reach, STAFF_RADIUS * points.scale, ARMS_ROLLER)


def _table_radius(points: Points) -> float:
    return TABLE_RADIUS * points.stone_reach / 1.0125


CLEAR = 1e-4  # degrees by which lever and wheel stand off what they rest on

WORDS = """\
A co-axial escapement after George Daniels: the large wheel locks on two stones of the lever and pushes the roller's stone
(direct impulse, balance counter-clockwise); the small one pushes the lever's third stone (indirect impulse, through fork and
pin). Drawn to these dimensions:"""


def scene_text(values: Coaxial) -> str:
    """The text of scene.toml: wheel locked on the first stone, lever on its bank, the balance about to be let go."""
    points = Points(values)
    lever = points.bank - CLEAR
    tooth = f"{points.locked_tip(FIRST, lever) + CLEAR:.7f}°"
    return toml.scene(
        toml.head(values, WORDS, f"Co-axial escapement, {values.frequency:.0f} vph, 8 + 8 teeth"),
        toml.body(
            *("wheel", "escape_wheel", "TEETH SMALL_TEETH", "turns clockwise; the inertia includes the train as felt here"),
            position=toml.ORIGIN,
            angle=toml.Noted(tooth, "a tooth a few nanometres off the first locking face", 6),
            inertia=f"{values.wheel_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("lever", "lever", "LOCKING_STONES IMPULSE_STONE FORK GUARD ARMS"),
            position=toml.at(0, points.lever_pivot[1]),
            angle=toml.Noted(f"{round(lever, 10):.15g}°", "a few nanometres off the bank", 5),
            inertia=f"{values.lever_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("balance", "roller", "TABLE SAFETY PIN IMPULSE_STONE"),
            "hangs at the end of a swing, its pin far outside the fork",
            draw="RIM",
            position=toml.at(*points.balance_pivot),
            angle=f"{-values.start:.15g}°",
            inertia=f"{values.balance_inertia:.15g} mg·cm²",
        ),
        toml.banking(),
        toml.hairspring(values.frequency, wheel_of(points).hairspring(round(points.fork_bearing, 1))),
        toml.torque("wheel", f"{-values.torque:.15g} µN·m"),
        toml.q_factor("balance", values.q_factor),
        toml.contacts(
            values,
            "wheel.TEETH lever.LOCKING_STONES: locking",
            "wheel.TEETH balance.IMPULSE_STONE: direct impulse",
            "wheel.SMALL_TEETH lever.IMPULSE_STONE: indirect impulse",
            "lever.FORK balance.PIN: unlocking, and the indirect impulse handed on",
            "lever.GUARD balance.SAFETY: safety action: never meets in normal running",
            "lever.ARMS banking.PINS",
        ),
        toml.run("10 s"),
        toml.timegrapher(f"{values.lift_angle:.15g}°"),
    )


def sheets(values: Coaxial) -> dict[str, Sheet]:
    """File name without ending -> the part. ValueError where a fillet does not fit."""
    points = Points(values)
    return sheets_of(escape_wheel=wheel(points), lever=lever(points), roller=roller(points), banking=banking(points))


INSIDE = 1.0  # degrees of the balance by which the roller stone must be inside the overlap when the wheel is let go
FREE = 0.75  # degrees of the wheel by which a waiting tooth must stand outside an overlap


def conflicts(values: Coaxial) -> Iterator[Conflict]:
    points = Points(values)
    yield from too_little_draw(values)
    least = values.draw + points.bank
    if values.undercut < least:
        words = f"must be at least {least:.4g}°, draw and half the lever's travel, so that tips lock and not fronts"
        yield Conflict("undercut", words)
    yield from _direct(values, points)
    yield from _indirect(values, points)
    freedom = guard_freedom(points)
    if freedom >= values.lock:
        words = f"gives the lever {freedom:.2f}° of freedom; for draw to bring it back, less than the lock, {values.lock:.4g}°"
        yield Conflict("guard_clearance", words)
    sheets(values)


def _direct(values: Coaxial, points: Points) -> Iterator[Conflict]:
    waits = min(values.direct_lead, PITCH / 2.0 - values.direct_lead)
    if waits < values.direct_reach + FREE:
        words = f"must be at most {waits - FREE:.4g}°: a waiting tooth stands {waits:.4g}° from the line of centres"
        yield Conflict("direct_reach", f"{words}, and the roller's stone has to pass it")
    latest = points.direct_balance - INSIDE - points.balance_at(points.unlocked)
    if values.stone_lag > latest:
        yield Conflict("stone_lag", f"must be at most {latest:.4g}°, or the tooth passes under the stone")


def _indirect(values: Coaxial, points: Points) -> Iterator[Conflict]:
    waits = min(values.indirect_lead, PITCH / 2.0 - values.indirect_lead)
    if waits < values.indirect_reach + FREE:
        words = f"must be at most {waits - FREE:.4g}°: a waiting small tooth stands {waits:.4g}° from the line of centres"
        yield Conflict("indirect_reach", f"{words}, and the lever's stone has to pass it")
    first, last = values.indirect_offset - values.indirect_lever, values.indirect_offset + values.indirect_lever
    if first > -points.unlocked:
        words = f"the lever's stone comes into the small wheel's way at {first:.4g}° of the lever"
        yield Conflict(
            "indirect_lever", f"{words}, after the release at {-points.unlocked:.4g}°: the tooth would pass under it"
        )
    if last > points.let_off + 0.5 * values.run:
        words = f"the indirect impulse would last until {last:.4g}° of the lever"
        yield Conflict("indirect_lever", f"{words}, beyond the lock at {points.let_off:.4g}°")


def guard_freedom(points: Points) -> float:
    """Lever angle from the bank until the guard pin meets the safety roller, degrees."""
    y, d = Fork(points).guard_centre(), points.lever_to_balance
    reach = (SAFETY_RADIUS + GUARD_TIP) * points.scale
    cosine = (y * y + d * d - reach * reach) / (2.0 * y * d)
    return points.bank - math.degrees(math.acos(min(1.0, cosine)))


DESIGN = Design("coaxial", "Co-axial escapement with its balance", Coaxial, sheets, scene_text, conflicts)
