"""Which points of a Swiss lever follow from its numbers?

The rules are the draughtsman's (H. R. Playtner, An Analysis of the Lever Escapement, 1910): the locking corners stand on
the tip circle where its tangents from the pallet centre touch, each discharge corner stands where the heel leaves it
after the whole lift with the drop still to come. Millimetres and degrees. The wheel's centre is the origin and the wheel
turns clockwise; a positive lever angle puts the entry stone (left) deep; the balance's pin points at the lever at 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.outline import along, angle_of, polar, turned
from watchsim.geometry.primitives import Point

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
