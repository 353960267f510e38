"""The swiss lever outlines as a design: its dimensions, what follows from them, its outlines and its scene."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from watchsim.construction.design import dim
from watchsim.construction.outline import (
    along,
    angle_of,
    arc_between,
    arc_of_radius,
    circle,
    fillet,
    fillet_chain,
    polar,
    turned,
)
from watchsim.construction.parts import Arms, BalanceWheel, balance_wheel
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

# Which numbers does the designer of a Swiss lever escapement choose?
#
# Angles of lock, run, lift and draw are at the lever's pivot and locking corner, of tooth and drop at the wheel's, lift angle
# and
# horn at the balance's. Playtner: H. R. Playtner, An Analysis of the Lever Escapement (1910).

PLAYTNER, CHOSEN, USUAL = "Playtner 1910", "chosen for this design", "usual in wristwatches"
ESTIMATE = "estimate: not published for a watch"


@dataclass(frozen=True)
class SwissLever:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(15, "", 9, 30, "teeth of the escape wheel", USUAL)
    embraced: float = dim(2.5, "", 1.5, 7.5, "tooth spaces between the two lockings, a whole number and a half", PLAYTNER)
    tip_radius: float = dim(2.4, "mm", 0.5, 20.0, "escape wheel, to the toes of its teeth", CHOSEN)
    tooth_width: float = dim(4.5, "°", 1.5, 8.0, "of a club tooth from toe to heel, at the wheel's centre", PLAYTNER)
    undercut: float = dim(24.0, "°", 16.0, 32.0, "of a tooth's locking face, from the radius", f"{PLAYTNER}: 20° to 28°")
    lock: float = dim(1.5, "°", 0.1, 4.0, "lever, from the drop of a tooth on the locking face to unlocked", PLAYTNER)
    run: float = dim(0.5, "°", 0.05, 3.0, "lever, from the drop to the banking; lock and run are the total lock", USUAL)
    lift_on_stone: float = dim(4.8, "°", 1.0, 9.0, "lever, a toe driving the impulse face of the entry stone", USUAL)
    lift_on_tooth: float = dim(2.7, "°", 0.3, 6.0, "lever, a tooth's impulse face driving the entry stone", USUAL)
    drop_inside: float = dim(1.2, "°", 0.2, 4.0, "wheel, free from the entry stone's let-off to the exit's lock", USUAL)
    drop_outside: float = dim(1.2, "°", 0.2, 4.0, "wheel, free from the exit stone's let-off to the entry's lock", USUAL)
    draw: float = dim(13.0, "°", 5.0, 25.0, "of the locking faces with the lever on its bank", f"{PLAYTNER}: 12°")
    lever_to_balance: float = dim(4.36, "mm", 1.0, 40.0, "centre distance of lever and balance", CHOSEN)
    lift_angle: float = dim(51.2, "°", 25.0, 75.0, "balance, while the jewel is in the fork", "calibre tables: 44° to 54°")
    jewel_width: float = dim(0.32, "mm", 0.05, 4.0, "diameter of the impulse jewel before its flat is ground", CHOSEN)
    jewel_ground: float = dim(3.0 / 7.0, "", 0.2, 0.5, "of its diameter ground away, to make it D-shaped", PLAYTNER)
    shake: float = dim(0.02, "mm", 0.002, 0.3, "by which the slot of the fork is wider than the jewel", f"{PLAYTNER}: ¼°")
    horn_clearance: float = dim(0.042, "mm", 0.005, 0.5, "between jewel and horn, the lever on its bank", CHOSEN)
    horn_end: float = dim(62.0, "°", 35.0, 80.0, "how far a horn reaches round the balance, the lever on its bank", CHOSEN)
    guard_freedom: float = dim(0.765, "°", 0.1, 2.5, "lever, from its bank until the dart meets the safety roller", CHOSEN)
    safety_ratio: float = dim(
        0.66, "", 0.5, 0.75, "radius of the safety roller by that of the jewel's flat", f"{PLAYTNER}: 4/7 to 2/3"
    )
    crescent: float = dim(22.0, "°", 12.0, 40.0, "half opening of the crescent, at the balance's centre", CHOSEN)
    wheel_inertia: float = dim(0.05, "mg·cm²", 1e-4, 100.0, "escape wheel with the train as felt there", ESTIMATE)
    lever_inertia: float = dim(0.03, "mg·cm²", 1e-4, 100.0, "lever with stones and dart", ESTIMATE)
    balance_inertia: float = dim(12.0, "mg·cm²", 0.1, 1e4, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(28800.0, "vph", 7200.0, 72000.0, "of the balance on its hairspring, in beats per hour", USUAL)
    q_factor: float = dim(250.0, "", 20.0, 2000.0, "quality factor of the balance without the escapement", "often 200 to 300")
    torque: float = dim(1.0, "µN·m", 1e-3, 1e3, "of the train on the escape wheel", ESTIMATE)
    friction: float = dim(0.12, "", 0.0, 0.5, "coefficient of friction, in all contacts", "0.10 to 0.20, steel on oiled ruby")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(270.0, "°", 60.0, 300.0, "balance, from rest, where it is let go", CHOSEN)


# Which points of a Swiss lever follow from its numbers?
#
# The rules are the draughtsman's (H. R. Playtner, An Analysis of the Lever Escapement, 1910): the locking corners stand on
# the tip circle where its tangents from the pallet centre touch, each discharge corner stands where the heel leaves it
# after the whole lift with the drop still to come. Millimetres and degrees. The wheel's centre is the origin and the wheel
# turns clockwise; a positive lever angle puts the entry stone (left) deep; the balance's pin points at the lever at 0.

WHEEL, LEVER, REACH = 2.4, 4.36, 0.75  # mm: tip radius, centre distance, jewel of the design whose lesser lengths others scale


@dataclass(frozen=True)
class Swiss:
    """The draughtsman's numbers; everything else is a property. Lesser lengths grow with wheel and centre distance."""

    tip_radius: float = WHEEL  # R, to the toe of a tooth
    heel_radius: float = 2.452  # to the heel: shares the lift between tooth and stone
    teeth: int = 15
    tooth_width: float = 4.5  # toe to heel at the wheel's centre
    undercut: float = 24.0  # of the tooth's locking face, from the radius
    half_span: float = 30.0  # half of the 2 1/2 tooth spaces between the lockings
    lock: float = 1.5  # lever angle from drop to unlocked
    run: float = 0.5  # lever angle from drop to the bank
    lift: float = 7.5  # lever angle while the balance is driven, stone and tooth together
    drop_inside: float = 1.2  # wheel angle from let-off at the entry stone to lock at the exit stone
    drop_outside: float = 1.2  # wheel angle from let-off at the exit stone to lock at the entry stone
    draw: float = 13.0  # of the locking faces, with the lever on the bank
    lever_to_balance: float = LEVER
    slot_width: float = 0.34
    pin_radius: float = 0.16
    pin_ground: float = 3.0 / 7.0  # of the pin's diameter, to make it D-shaped
    pin_reach: float = REACH  # its flat, from the balance's centre
    horn_clearance: float = 0.042  # between the pin's edge and the horn it passes, lever on the bank
    horn_end: float = 62.0  # the horn reaches this far round the balance from the line of centres, lever on the bank
    safety_radius: float = 0.5
    crescent_half: float = 22.0  # half opening of the crescent at the balance's centre
    dart_clearance: float = 0.034  # from the safety roller, lever on the bank

    @property
    def wheel_scale(self) -> float:
        return self.tip_radius / WHEEL

    @property
    def lever_scale(self) -> float:
        return self.lever_to_balance / LEVER

    @property
    def reach_beyond(self) -> float:
        """How much farther the jewel stands from the balance than in the design whose lesser lengths are scaled."""
        return self.pin_reach - REACH * self.lever_scale

    @property
    def slot_bottom(self) -> float:
        """From the lever's pivot."""
        return 3.5 * self.lever_scale - self.reach_beyond

    @property
    def pin_edge(self) -> float:
        """Rounding of the pin's two edges."""
        return 0.125 * self.pin_radius

    @property
    def crescent_depth(self) -> float:
        inside = self.lever_to_balance - self.dart_centre - self.dart_tip  # the dart's point in the middle of its way
        return max(0.34 * self.safety_radius, self.safety_radius - inside + 0.03 * self.lever_scale)

    @property
    def dart_tip(self) -> float:
        """Rounding of its point."""
        return 0.025 * self.lever_scale

    @property
    def stem_half(self) -> float:
        """Half width of the lever's stem where the banking pins meet it."""
        return 0.125 * self.lever_scale

    @property
    def banking_height(self) -> float:
        """Of the banking pins above the lever's pivot, lever in the middle."""
        return 2.45 * self.lever_scale - self.reach_beyond

    @property
    def banking_radius(self) -> float:
        return 0.16 * self.lever_scale

    @property
    def lever_pivot(self) -> Point:
        return (0.0, self.tip_radius / math.cos(math.radians(self.half_span)))

    @property
    def balance_pivot(self) -> Point:
        return (0.0, self.lever_pivot[1] + self.lever_to_balance)

    @property
    def bank(self) -> float:
        """Half of the lever's travel."""
        return (self.lock + self.lift + 2.0 * self.run) / 2.0

    @property
    def let_off(self) -> float:
        """The lever angle (unsigned) at which a heel leaves: the run is still to come."""
        return self.bank - self.run

    @property
    def unlocked(self) -> float:
        """The lever angle (unsigned) at which a locking corner stands on the tip circle."""
        return self.let_off - self.lock

    def in_lever(self, point: Point, lever: float) -> Point:
        """A point of the movement in the lever's own frame, with the lever at `lever` degrees."""
        return turned((point[0] - self.lever_pivot[0], point[1] - self.lever_pivot[1]), -lever)

    def in_movement(self, point: Point, lever: float) -> Point:
        """A point of the lever in the movement, with the lever at `lever` degrees."""
        x, y = turned(point, lever)
        return (x + self.lever_pivot[0], y + self.lever_pivot[1])

    def locking_corner(self, side: int) -> Point:
        """Of the entry (+1) or exit (-1) stone, in the lever's frame."""
        return self.in_lever(polar(self.tip_radius, 90.0 + side * self.half_span), side * self.unlocked)

    def face_direction(self, side: int) -> float:
        """Direction of the locking face away from the wheel, in the lever's frame.

        Pure locking without draw would point from the wheel's centre at the corner; the face leans to the right of that
        by the draw, towards the lever's pivot on the entry side, away from it on the exit side.
        """
        return 90.0 + side * self.half_span - self.draw - side * self.bank

    def locked_toe(self, side: int) -> float:
        """Polar angle in the movement of a toe that has just dropped on the locking face, lever at let-off, degrees."""
        corner = self.in_movement(self.locking_corner(side), side * self.let_off)
        direction = self.face_direction(side) + side * self.let_off
        low, high = 0.0, self.tip_radius / 4.0
        for _ in range(200):
            middle = (low + high) / 2.0
            inside = math.hypot(*along(corner, direction, middle)) < self.tip_radius
            low, high = (middle, high) if inside else (low, middle)
        return angle_of(along(corner, direction, low))

    def heel_at_let_off(self, side: int) -> float:
        """Polar angle in the movement of the heel that leaves a stone when the next toe has the drop still to go, degrees."""
        pitch = 360.0 / self.teeth
        spaces = 2.0 * self.half_span / pitch
        steps = math.floor(spaces) if side > 0 else -math.ceil(spaces)
        drop = self.drop_inside if side > 0 else self.drop_outside
        toe = self.locked_toe(-side) + steps * pitch + drop
        return toe + self.tooth_width

    def discharge_corner(self, side: int) -> Point:
        """In the lever's frame: where the heel stands at let-off."""
        return self.in_lever(polar(self.heel_radius, self.heel_at_let_off(side)), -side * self.let_off)

    def balance_from_bank(self, side: int) -> Point:
        """The balance's centre in the lever's frame, lever on the entry (+1) or exit (-1) bank."""
        return self.in_lever(self.balance_pivot, side * self.bank)

    @property
    def pin_centre(self) -> float:
        """Centre of the pin's round side, from the balance's centre."""
        return self.pin_reach + (2.0 * self.pin_ground - 1.0) * self.pin_radius

    @property
    def horn_radius(self) -> float:
        """Of the horns about the balance's centre: past the farthest point of the pin's edge."""
        height = self.pin_reach - self.pin_edge
        half = math.sqrt((self.pin_radius - self.pin_edge) ** 2 - (height - self.pin_centre) ** 2)
        return math.hypot(half, height) + self.pin_edge + self.horn_clearance

    @property
    def dart_centre(self) -> float:
        """Centre of the dart's rounding above the lever's pivot."""
        x, y = self.balance_from_bank(1)
        return y - math.sqrt((self.safety_radius + self.dart_clearance + self.dart_tip) ** 2 - x * x)


# How is the lift shared between stone and tooth?


def lift_on_tooth(design: Swiss, side: int) -> float:
    """Lever angle (degrees) from where the stone's discharge corner crosses the circle of the toes to let-off.

    The corner is rho from the lever's pivot, which is C from the wheel's centre: its distance from that one gives the angle
    between the two directions at the pivot. ValueError where the corner never crosses.
    """
    corner = design.discharge_corner(side)
    away, rho = design.lever_pivot[1], math.hypot(*corner)

    def at(distance: float) -> float:
        return math.degrees(math.acos((away**2 + rho**2 - distance**2) / (2.0 * away * rho)))

    return at(design.heel_radius) - at(design.tip_radius)


# How wide must the crescent be for the dart to pass through it?

STEPS_SWISS_LEVER_GUARD = 60


def crescent_needed(design: Swiss) -> float:
    """Half opening, degrees: the farthest the dart's point is beside the jewel while it is within the safety roller.

    The lever follows the jewel with the play of the slot; breadth of the point and rounding of the crescent's edge count.
    """
    play = math.degrees((design.slot_width - 2.0 * design.pin_radius) / design.pin_reach)
    farthest = 0.0
    for i in range(STEPS_SWISS_LEVER_GUARD + 1):
        lever = design.bank * i / STEPS_SWISS_LEVER_GUARD
        x, y = _dart(design, lever)
        distance = math.hypot(x, y)
        if distance < design.safety_radius + design.dart_tip:
            breadth = math.degrees((design.dart_tip + 0.02 * design.lever_scale) / distance)
            beside = abs(math.degrees(math.atan2(x, y)) - _jewel(design, lever))
            farthest = max(farthest, beside + breadth + play)
    return farthest


def _dart(design: Swiss, lever: float) -> tuple[float, float]:
    """Centre of the dart's point from the balance's centre: to the left, and towards the lever."""
    a = math.radians(lever)
    return design.dart_centre * math.sin(a), design.lever_to_balance - design.dart_centre * math.cos(a)


def _jewel(design: Swiss, lever: float) -> float:
    """Balance angle (degrees, to the left) with the middle of the jewel on the middle line of the lever."""
    a, ratio = math.radians(lever), design.lever_to_balance / design.pin_reach
    return math.degrees(math.asin(min(1.0, ratio * math.sin(a)))) - lever


# How far is the impulse jewel from the wall of the slot that it comes to push?

MOUTH = 0.02  # mm at the first design's size: rounding between horn and slot


def gap_to_slot(design: Swiss, balance: float) -> float:
    """mm from jewel to far wall, the lever on its entry bank, the balance at `balance` degrees; negative where they overlap.

    The jewel comes from the left; the far wall is the slot's right one, which ends in the rounding of the mouth. Wall and
    rounding are the outline of all that is within `rounding` of the half line x = centre below the rounding's centre, and
    the jewel is convex, so that its least distance is to the wall, or to that centre.
    """
    rounding = MOUTH * design.lever_scale
    centre = mouth_centre(design, rounding)
    back = design.bank

    def in_lever(point: Point) -> Point:
        x, y = turned(point, balance)
        return design.in_lever((x + design.balance_pivot[0], y + design.balance_pivot[1]), back)

    right = max((in_lever(point) for point in _rightmost(design, balance - back)), key=lambda point: point[0])
    if right[1] <= centre[1]:
        return design.slot_width / 2.0 - right[0]
    x, y = design.in_movement(centre, back)
    seen = turned((x - design.balance_pivot[0], y - design.balance_pivot[1]), -balance)
    return _outside_jewel(design, seen) - rounding


def mouth_centre(design: Swiss, rounding: float) -> Point:
    """In the lever's frame: of the rounding between the right wall of the slot and the right horn (drawn with the lever on
    the exit bank)."""
    x = design.slot_width / 2.0 + rounding
    bx, by = design.balance_from_bank(-1)
    return (x, by - math.sqrt((design.horn_radius + rounding) ** 2 - (x - bx) ** 2))


def _edges(design: Swiss) -> tuple[Point, Point]:
    """Centres of the roundings of the jewel's left and right edge, in the balance's frame."""
    height = design.pin_reach - design.pin_edge
    half = math.sqrt((design.pin_radius - design.pin_edge) ** 2 - (height - design.pin_centre) ** 2)
    return (-half, -height), (half, -height)


def _rightmost(design: Swiss, angle: float) -> list[Point]:
    """Points of the jewel (balance's frame) that may be farthest to the right once it is turned by `angle` degrees."""
    left, right = _edges(design)
    found = [polar(design.pin_edge, -angle, left), polar(design.pin_edge, -angle, right)]
    round_side = polar(design.pin_radius, -angle, (0.0, -design.pin_centre))
    return [*found, *([round_side] if _on_round(design, round_side) else [])]


def _on_round(design: Swiss, point: Point) -> bool:
    """Does the point, seen from the round side's centre, lie between the two roundings on the side of the balance?"""
    (_, ey), cy = _edges(design)[1], -design.pin_centre
    ex = _edges(design)[1][0]
    limit = math.atan2(ey - cy, ex)
    angle = math.atan2(point[1] - cy, abs(point[0]))
    return angle >= limit


def _outside_jewel(design: Swiss, point: Point) -> float:
    """Distance of a point outside from the jewel, both in the balance's frame; negative inside."""
    x, y = abs(point[0]), point[1]
    ex, ey = _edges(design)[1]
    if _on_round(design, (x, y)):
        return math.hypot(x, y + design.pin_centre) - design.pin_radius
    if x <= ex:
        return -design.pin_reach - y
    return math.hypot(x - ex, y - ey) - design.pin_edge


# What are the outlines of the Swiss lever's balance and banking pins?
#
# The table roller (TABLE) carries the D-shaped impulse pin (PIN) and, in another plane, the safety roller with its
# crescent (SAFETY); only the last two touch anything, and the balance's RIM is drawn only. In the balance's own frame, the
# pin towards the lever (-y) at 0; the banking pins (PINS) in movement coordinates. Millimetres.

TABLE_RADIUS, STAFF_RADIUS = 0.95, 0.16
CRESCENT_EDGE = 0.02
ARMS = 3
INERTIA = 12.0  # mg·cm², of the balance as drawn by default


def roller(design: Swiss, inertia: float) -> list[Loop]:
    """Table with the staff's hole, pin, safety roller; the rim of a balance of that inertia (mg·cm²)."""
    return [
        circle("TABLE", (0.0, 0.0), _table_radius(design)),
        circle("TABLE", (0.0, 0.0), STAFF_RADIUS * design.lever_scale, hole=True),
        pin(design),
        safety(design),
        circle("SAFETY", (0.0, 0.0), STAFF_RADIUS * design.lever_scale, hole=True),
        *wheel_of(design, inertia).rim(),
    ]


def wheel_of(design: Swiss, inertia: float) -> BalanceWheel:
    """Rim and hairspring of a balance of that inertia (mg·cm²)."""
    return balance_wheel(inertia, _table_radius(design), STAFF_RADIUS * design.lever_scale, ARMS)


def _table_radius(design: Swiss) -> float:
    return TABLE_RADIUS * design.lever_scale + design.reach_beyond


def pin(design: Swiss) -> Loop:
    """A round pin with part of its diameter ground away: the flat looks outwards, its edges are rounded."""
    centre = (0.0, -design.pin_centre)
    height = design.pin_reach - design.pin_centre
    half = math.sqrt(design.pin_radius**2 - height**2)
    left, right = (-half, -design.pin_reach), (half, -design.pin_reach)
    edges: list[Edge] = [Line(*left, *right), arc_between(right, left, centre, True)]
    return Loop(tuple(fillet_chain(edges, [design.pin_edge, design.pin_edge], closed=True)), "PIN")


def safety(design: Swiss) -> Loop:
    """The safety roller: a disc with a hollow for the dart's point."""
    radius, bottom = design.safety_radius, design.safety_radius - design.crescent_depth
    right, left = (polar(radius, -90.0 + side * design.crescent_half) for side in (1.0, -1.0))
    half, height = right[0], -right[1]
    hollow = (half**2 + (height - bottom) ** 2) / (2.0 * (height - bottom))  # circle through both edges and the bottom
    edges: list[Edge] = [
        arc_between(right, left, (0.0, 0.0), True),
        arc_between(left, right, (0.0, -(bottom + hollow)), False),
    ]
    return Loop(tuple(fillet_chain(edges, [CRESCENT_EDGE * design.lever_scale] * 2, closed=True)), "SAFETY")


def banking(design: Swiss) -> list[Loop]:
    """Two pins that the lever's stem meets at the ends of its travel."""
    reach = design.stem_half + design.banking_radius
    centres = [design.in_movement((-side * reach, design.banking_height), side * design.bank) for side in (1, -1)]
    return [circle("PINS", centre, design.banking_radius) for centre in centres]


# What is the outline of the Swiss lever's escape wheel?
#
# Club teeth on a rim, four arms with rounded corners, a bore; one piece, so all on the layer TEETH. In the wheel's own
# frame, millimetres; tooth 0 has its toe on the x axis and the wheel turns clockwise. The constants are those of a wheel of
# 2.4 mm and 15 teeth; they grow with the wheel, and what lies between two teeth shrinks where there are more.

LAYER = "TEETH"
ROOT_RADIUS = 1.9  # bottom of the gaps
TOE_ROOT, HEEL_ROOT = 0.16, 0.46  # fillets into the gap, before and behind a tooth
CLUB = 0.085  # straight back of the club, from the heel
CLUB_LEAN = 14.0  # of that back, from the radius, towards the toe, degrees
RIM_INNER, HUB_RADIUS, BORE_RADIUS = 1.66, 0.42, 0.11
ARMS_SWISS_LEVER_WHEEL, ARM_WIDTH, WINDOW_FILLET = 4, 0.17, 0.09
DEEP = 1.11  # how far a hollow may lean over the thickness of the tooth
FEW = 15  # teeth, up to which the gaps are as drawn here


def wheel(design: Swiss) -> list[Loop]:
    """The toothed contour, the windows between the arms and the bore."""
    scale = design.wheel_scale
    arms = Arms(ARMS_SWISS_LEVER_WHEEL, ARM_WIDTH * scale, HUB_RADIUS * scale, RIM_INNER * scale, WINDOW_FILLET * scale)
    windows = [Loop(tuple(arms.window(i)), LAYER, hole=True) for i in range(arms.number)]
    return [contour(design), *windows, circle(LAYER, (0.0, 0.0), BORE_RADIUS * scale, hole=True)]


def root_radius(design: Swiss) -> float:
    """Bottom of the gaps."""
    return ROOT_RADIUS * design.wheel_scale


def gap_scale(design: Swiss) -> float:
    """Of what lies between two teeth."""
    return design.wheel_scale * min(1.0, FEW / design.teeth)


def contour(design: Swiss) -> Loop:
    """All teeth, counter-clockwise; one tooth and the gap behind it, turned once per tooth."""
    pitch = math.radians(360.0 / design.teeth)
    tooth = Loop(tuple(tooth_and_gap(design)), LAYER)
    edges = [edge for i in range(design.teeth) for edge in tooth.moved(i * pitch, (0.0, 0.0)).edges]
    return Loop(tuple(edges), LAYER)


def tooth_and_gap(design: Swiss) -> list[Edge]:
    """From the foot of the locking face over toe and heel to the foot of the next tooth's locking face."""
    toe, heel, back = toe_heel_back(design)
    lean, neck, sweep_end = behind(design, back)
    foot, toe_root = locking_foot(design)
    next_start = turned(toe_root.start, 360.0 / design.teeth)
    floor = arc_between(sweep_end, next_start, (0.0, 0.0), True)
    return [toe_root, Line(*foot, *toe), Line(*toe, *heel), Line(*heel, *back), *lean, neck, floor]


def toe_heel_back(design: Swiss) -> tuple[Point, Point, Point]:
    """The corners of a tooth's head."""
    heel = polar(design.heel_radius, design.tooth_width)
    back = along(heel, design.tooth_width + 180.0 - CLUB_LEAN, CLUB * gap_scale(design))
    return polar(design.tip_radius, 0.0), heel, back


def behind(design: Swiss, back: Point) -> tuple[list[Edge], Arc, Point]:
    """From the head's back to the floor of the gap: a hollow, and before it a straight piece parallel to the locking face where
    the tooth is so narrow that the hollow would cut through it. Also where it reaches the floor."""
    depth = math.hypot(*back) - root_radius(design)
    inward = math.radians(180.0 - design.undercut)
    thickness = back[1] * -math.cos(inward) - (design.tip_radius - back[0]) * math.sin(inward)
    allowed = DEEP * thickness / math.sin(inward)
    if depth <= allowed:
        return [], *concave_back(design, back, HEEL_ROOT * gap_scale(design))
    start = along(back, 180.0 - design.undercut, (depth - max(allowed, 0.0)) / -math.cos(inward))
    left = math.hypot(*start) - root_radius(design)
    return [Line(*back, *start)], *concave_back(design, start, left)


def locking_foot(design: Swiss) -> tuple[Point, Arc]:
    """Where the locking face ends, and the fillet from the gap's floor into it."""
    toe = polar(design.tip_radius, 0.0)
    face = Line(*along(toe, 180.0 - design.undercut, 2.0 * (design.tip_radius - root_radius(design))), *toe)
    crossing = _on_root(face, root_radius(design))
    floor = arc_between(polar(root_radius(design), angle_of(crossing) - 8.0), crossing, (0.0, 0.0), True)
    _, root, rest = fillet(floor, Line(*crossing, *toe), TOE_ROOT * gap_scale(design))
    return rest.start, root


def concave_back(design: Swiss, back: Point, hollow: float) -> tuple[Arc, Point]:
    """The hollow into the gap's floor: an arc of that radius through `back`, tangent to the floor from outside; and its end."""
    root = root_radius(design)
    reach, distance = root + hollow, math.hypot(*back)
    cosine = (distance**2 + reach**2 - hollow**2) / (2.0 * distance * reach)
    bearing = angle_of(back) + math.degrees(math.acos(cosine))
    end = polar(root, bearing)
    return arc_between(back, end, polar(reach, bearing), False), end


def _on_root(face: Line, root: float) -> Point:
    """Where the line meets the floor circle, on the way in from the toe."""
    low, high = 0.0, 1.0  # fraction from the far end to the toe; the toe is outside
    for _ in range(200):
        middle = (low + high) / 2.0
        low, high = (middle, high) if math.hypot(*face.point(middle)) < root else (low, middle)
    return face.point(high)


def tooth_gap(design: Swiss) -> float:
    """Degrees of floor between two teeth, negative where the hollow behind one runs into the foot of the next."""
    _, _, sweep_end = behind(design, toe_heel_back(design)[2])
    _, toe_root = locking_foot(design)
    ahead = angle_of(turned(toe_root.start, 360.0 / design.teeth)) - angle_of(sweep_end)
    return (ahead + 180.0) % 360.0 - 180.0


# What is the outline of the Swiss lever's lever?

STONE_LENGTH, STONE_EDGE = 0.70, 0.03
EXPOSED = 0.33  # length of a stone outside its slot
SHELLAC = 0.006  # gap between stone and slot
WALL_OUT, WALL_IN, WALL_END = 0.13, 0.13, 0.13  # metal around the slot
HUB_RADIUS_SWISS_LEVER_LEVER, BORE_RADIUS_SWISS_LEVER_LEVER = 0.25, 0.085
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
        circle("ARMS", (0.0, 0.0), BORE_RADIUS_SWISS_LEVER_LEVER * design.lever_scale, hole=True),
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
    left, right = polar(HUB_RADIUS_SWISS_LEVER_LEVER * scale, 210.0), polar(HUB_RADIUS_SWISS_LEVER_LEVER * scale, 325.0)
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


# How much of the drop is left once unlocking has drawn the wheel back?
#
# A tooth has dropped on one stone, the tooth before it has just left the other. While the lever unlocks, the locking face
# pushes
# the wheel back (the recoil that its draw asks for), and the other stone comes in behind the tooth that it let off. What the
# wheel could still be turned back before the two meet is what is left of the drop; where nothing is left, the lever cannot
# unlock.

PARTS = 40  # of an edge
STEPS = 8  # of the lever, from the bank to unlocked


def drop_after_recoil(design: Swiss, side: int) -> float:
    """Degrees of the wheel, while the entry (+1) or exit (-1) stone unlocks; negative where the other stone is in the way.

    The least over all places of the lever, between every point of that stone and the tooth at the same radius. Infinite where
    the stone stays outside the wheel.
    """
    tooth = _radii_and_angles(_back_of_tooth(design))
    stone = _points(_let_off_faces(design, -side))
    places = np.linspace(design.bank, design.unlocked, STEPS + 1)
    return min(_left(design, side, float(lever), tooth, stone) for lever in places)


def recoil(design: Swiss, side: int) -> float:
    """Degrees by which the wheel is turned back from the bank until it is unlocked, teeth sliding on that stone."""
    return _locked_toe(design, side, design.unlocked) - _locked_toe(design, side, design.bank)


def _left(
    design: Swiss, side: int, lever: float, tooth: tuple[NDArray[np.float64], NDArray[np.float64]], stone: Sequence[Point]
) -> float:
    pitch = 360.0 / design.teeth
    spaces = 2.0 * design.half_span / pitch
    let_off = _locked_toe(design, side, lever) + (-math.ceil(spaces) if side > 0 else math.floor(spaces)) * pitch
    placed = [design.in_movement(point, side * lever) for point in stone]
    radii, angles = tooth
    gaps = [
        angle_of(point) - let_off - float(np.interp(math.hypot(*point), radii, angles))
        for point in placed
        if radii[0] <= math.hypot(*point) <= radii[-1]
    ]
    return min(gaps, default=math.inf)


def _locked_toe(design: Swiss, side: int, lever: float) -> float:
    """Polar angle in the movement of a toe on the locking face, the lever that many degrees to the stone's own side."""
    corner = design.in_movement(design.locking_corner(side), side * lever)
    direction = design.face_direction(side) + side * lever
    middle = corner[0] * math.cos(math.radians(direction)) + corner[1] * math.sin(math.radians(direction))
    # At `unlocked` the corner is on the circle, but for rounding.
    reach = -middle + math.sqrt(max(0.0, middle**2 - math.hypot(*corner) ** 2 + design.tip_radius**2))
    return angle_of(along(corner, direction, reach))


def _back_of_tooth(design: Swiss) -> list[Edge]:
    _, heel, back = toe_heel_back(design)
    lean, hollow, _ = behind(design, back)
    return [Line(*heel, *back), *lean, hollow]


def _let_off_faces(design: Swiss, side: int) -> list[Edge]:
    """Impulse face, and the side of the stone beyond its discharge corner; in the lever's frame."""
    slot = Slot(design, side)
    return [Line(*slot.corner, *slot.end), Line(*slot.end, *slot.at(slot.exposed, slot.width))]


def _points(edges: Sequence[Edge]) -> list[Point]:
    return [edge.point(part / PARTS) for edge in edges for part in range(PARTS + 1)]


def _radii_and_angles(edges: Sequence[Edge]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """In the order of the radii; angles in degrees, from the toe."""
    points = _points(edges)
    radii, angles = np.array([math.hypot(*point) for point in points]), np.array([angle_of(point) for point in points])
    order = np.argsort(radii, kind="stable")
    return radii[order], angles[order]
