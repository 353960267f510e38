"""Where do the points of a Swiss lever lie, and what are the outlines of its wheel, lever, roller and banking?"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from watchsim.construction.design import Conflict
from watchsim.construction.outline import (
    along,
    angle_of,
    arc_between,
    arc_of_radius,
    around,
    circle,
    fillet,
    filleted,
    polar,
    rounded,
    turned,
)
from watchsim.construction.parts import (
    Arms,
    BalanceWheel,
    balance_wheel,
    fork_outline,
    guard,
    hollow_back,
    horn_radius,
    impulse_pin,
    safety_roller,
)
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

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
            if middle in (low, high):
                break
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
        return horn_radius(self.pin_reach, self.pin_centre, self.pin_radius, self.pin_edge, self.horn_clearance)

    @property
    def dart_centre(self) -> float:
        """Centre of the dart's rounding above the lever's pivot."""
        x, y = self.balance_from_bank(1)
        return y - math.sqrt((self.safety_radius + self.dart_clearance + self.dart_tip) ** 2 - x * x)


# How wide must the crescent be for the dart to pass through it?

GUARD_STEPS = 60


def crescent_needed(design: Swiss) -> float:
    """Half opening, degrees: the farthest the dart's point is beside the jewel while it is within the safety roller.

    The lever follows the jewel with the play of the slot; breadth of the point and rounding of the crescent's edge count.
    """
    play = math.degrees((design.slot_width - 2.0 * design.pin_radius) / design.pin_reach)
    farthest = 0.0
    for i in range(GUARD_STEPS + 1):
        lever = design.bank * i / GUARD_STEPS
        x, y = _dart(design, lever)
        distance = math.hypot(x, y)
        if distance < design.safety_radius + design.dart_tip:
            breadth = math.degrees((design.dart_tip + 0.02 * design.lever_scale) / distance)
            beside = abs(math.degrees(math.atan2(x, y)) - _jewel(design, lever))
            farthest = max(farthest, beside + breadth + play)
    return farthest


def safety_roller_conflicts(design: Swiss, pin: str) -> Iterator[Conflict]:
    """A crescent that is too deep for the staff, or too narrow for the dart beside the `pin`."""
    staff = STAFF_RADIUS * design.lever_scale
    if design.safety_radius - design.crescent_depth < 1.1 * staff:
        yield Conflict(
            "safety_ratio", f"the crescent would cut into the staff of {2.0 * staff:.3g} mm: the safety roller is too small"
        )
    needed = crescent_needed(design)
    if design.crescent_half < needed:
        yield Conflict("crescent", f"must be at least {needed:.4g}°: the dart enters the roller that far beside the {pin}")


def _dart(design: Swiss, lever: float) -> tuple[float, float]:
    """Centre of the dart's point from the balance's centre: to the left, and towards the lever."""
    a = math.radians(lever)
    return design.dart_centre * math.sin(a), design.lever_to_balance - design.dart_centre * math.cos(a)


def _jewel(design: Swiss, lever: float) -> float:
    """Balance angle (degrees, to the left) with the middle of the jewel on the middle line of the lever."""
    a, ratio = math.radians(lever), design.lever_to_balance / design.pin_reach
    return math.degrees(math.asin(min(1.0, ratio * math.sin(a)))) - lever


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
    reach = design.pin_reach
    return [
        circle("TABLE", (0.0, 0.0), _table_radius(design)),
        circle("TABLE", (0.0, 0.0), STAFF_RADIUS * design.lever_scale, hole=True),
        impulse_pin(reach, design.pin_centre, design.pin_radius, reach - design.pin_centre, design.pin_edge),
        safety_roller(design.safety_radius, design.crescent_depth, design.crescent_half, CRESCENT_EDGE * design.lever_scale),
        circle("SAFETY", (0.0, 0.0), STAFF_RADIUS * design.lever_scale, hole=True),
        *wheel_of(design, inertia).rim(),
    ]


def wheel_of(design: Swiss, inertia: float) -> BalanceWheel:
    """Rim and hairspring of a balance of that inertia (mg·cm²)."""
    return balance_wheel(inertia, _table_radius(design), STAFF_RADIUS * design.lever_scale, ARMS)


def _table_radius(design: Swiss) -> float:
    return TABLE_RADIUS * design.lever_scale + design.reach_beyond


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
MOUTH = 0.02  # mm at the first design's size: rounding between horn and slot
ROOT_RADIUS = 1.9  # bottom of the gaps
TOE_ROOT, HEEL_ROOT = 0.16, 0.46  # fillets into the gap, before and behind a tooth
CLUB = 0.085  # straight back of the club, from the heel
CLUB_LEAN = 14.0  # of that back, from the radius, towards the toe, degrees
RIM_INNER, HUB_RADIUS, BORE_RADIUS = 1.66, 0.42, 0.11
WHEEL_ARMS, ARM_WIDTH, WINDOW_FILLET = 4, 0.17, 0.09
DEEP = 1.11  # how far a hollow may lean over the thickness of the tooth
FEW = 15  # teeth, up to which the gaps are as drawn here


def wheel(design: Swiss) -> list[Loop]:
    """The toothed contour, the windows between the arms and the bore."""
    scale = design.wheel_scale
    arms = Arms(WHEEL_ARMS, ARM_WIDTH * scale, HUB_RADIUS * scale, RIM_INNER * scale, WINDOW_FILLET * scale)
    pitch = math.radians(360.0 / design.teeth)
    teeth = around(LAYER, tooth_and_gap(design), (i * pitch for i in range(design.teeth)))
    return [teeth, *arms.windows(LAYER), circle(LAYER, (0.0, 0.0), BORE_RADIUS * scale, hole=True)]


def root_radius(design: Swiss) -> float:
    """Bottom of the gaps."""
    return ROOT_RADIUS * design.wheel_scale


def gap_scale(design: Swiss) -> float:
    """Of what lies between two teeth."""
    return design.wheel_scale * min(1.0, FEW / design.teeth)


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


def behind(design: Swiss, back: Point) -> tuple[list[Edge], Edge, Point]:
    """From the head's back to the floor of the gap: a hollow, and before it a straight piece parallel to the locking face where
    the tooth is so narrow that the hollow would cut through it. Also where it reaches the floor."""
    depth = math.hypot(*back) - root_radius(design)
    inward = math.radians(180.0 - design.undercut)
    thickness = back[1] * -math.cos(inward) - (design.tip_radius - back[0]) * math.sin(inward)
    allowed = DEEP * thickness / math.sin(inward)
    if depth <= allowed:
        return [], *hollow_back(back, HEEL_ROOT * gap_scale(design), root_radius(design))
    start = along(back, 180.0 - design.undercut, (depth - max(allowed, 0.0)) / -math.cos(inward))
    left = math.hypot(*start) - root_radius(design)
    return [Line(*back, *start)], *hollow_back(start, left, root_radius(design))


def locking_foot(design: Swiss) -> tuple[Point, Arc]:
    """Where the locking face ends, and the fillet from the gap's floor into it."""
    toe = polar(design.tip_radius, 0.0)
    face = Line(*along(toe, 180.0 - design.undercut, 2.0 * (design.tip_radius - root_radius(design))), *toe)
    crossing = _on_root(face, root_radius(design))
    floor = arc_between(polar(root_radius(design), angle_of(crossing) - 8.0), crossing, (0.0, 0.0), True)
    _, root, rest = fillet(floor, Line(*crossing, *toe), TOE_ROOT * gap_scale(design))
    return rest.start, root


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


STONE_LENGTH, STONE_EDGE = 0.70, 0.03
EXPOSED = 0.33  # length of a stone outside its slot
SHELLAC = 0.006  # gap between stone and slot
WALL_OUT, WALL_IN, WALL_END = 0.13, 0.13, 0.13  # metal around the slot
LEVER_HUB, LEVER_BORE = 0.25, 0.085
STEM_ROOT, NECK = 0.165, 3.02  # half width of the stem at the hub; height at which the fork begins
HORN_TIP = 0.075  # breadth of a horn's end
HIP = (0.43, 3.52)  # where the fork is widest
DART_FOOT, DART_FOOT_RADIUS, DART_HALF = 3.25, 0.085, 0.05  # height of its foot, half width of its bar
DART_SLOPE = 30.0  # half angle of its point


def lever(design: Swiss) -> list[Loop]:
    """All outlines of the lever."""
    return [
        *(stone(design, side) for side in (1, -1)),
        body(design),
        circle("ARMS", (0.0, 0.0), LEVER_BORE * design.lever_scale, hole=True),
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
        return (self.corner[0] + t * self.u[0] + v * self.w[0], self.corner[1] + t * self.u[1] + v * self.w[1])


def stone(design: Swiss, side: int) -> Loop:
    """Locking corner, impulse face, discharge corner, and the shank."""
    slot = Slot(design, side)
    back, front = slot.at(slot.length, slot.width), slot.at(slot.length, 0.0)
    return rounded("STONES", [(slot.corner, 0.0), (slot.end, 0.0), (back, slot.edge), (front, slot.edge)])


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
    return filleted("ARMS", parts, yielding=True)


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
    left, right = polar(LEVER_HUB * scale, 210.0), polar(LEVER_HUB * scale, 325.0)
    return [
        (_bow(start, left, -0.75 * entry.scale, 0.077 * entry.scale), 0.08 * scale),
        (arc_between(left, right, (0.0, 0.0), True), 0.08 * scale),
        (_bow(right, end, -1.6 * entry.scale, 0.103 * entry.scale), 0.04 * exit_.scale),
    ]


def fork(design: Swiss) -> Loop:
    """The fork, drawn with the lever on its exit bank."""
    scale, neck, tip_out = design.lever_scale, neck_height(design), _horn_tip(design)
    centre = design.balance_from_bank(-1)
    hip = (HIP[0] * scale + (tip_out[0] - REFERENCE_TIP * scale), HIP[1] * scale - design.reach_beyond)
    outside = [(design.stem_half, neck), (0.165 * scale, neck + 0.2 * scale), hip, tip_out]
    tip, slot = polar(design.horn_radius, _horn_bearing(design), centre), (design.slot_width / 2.0, design.slot_bottom)
    radii = [*(share * scale for share in (0.4, 0.2, 0.03, 0.03, MOUTH)), min(0.09 * scale, 0.3 * design.slot_width)]
    return fork_outline(outside, tip, (centre, design.horn_radius), slot, radii)


def _horn_bearing(design: Swiss) -> float:
    """Of the right horn's end from the balance's centre, seen from the lever on its exit bank."""
    return -90.0 + design.horn_end + design.bank


def _horn_tip(design: Swiss) -> Point:
    """The outer end of the right horn."""
    reach = design.horn_radius + HORN_TIP * design.lever_scale
    return polar(reach, _horn_bearing(design), design.balance_from_bank(-1))


REFERENCE_TIP = _horn_tip(Swiss())[0]  # beside which HIP stands


def dart(design: Swiss) -> Loop:
    """The guard of the safety action: a round foot, a bar and a rounded point."""
    scale = design.lever_scale
    foot = (DART_FOOT * scale - design.reach_beyond, DART_FOOT_RADIUS * scale)
    tip, half, slope = design.dart_tip, DART_HALF * scale, math.radians(DART_SLOPE)
    drop = (half - tip * math.cos(slope)) / math.tan(slope)
    return guard("DART", design.dart_centre, tip, half, DART_SLOPE, drop, foot, 0.03 * scale)
