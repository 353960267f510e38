"""Which dimensions of a pin-pallet escapement do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.pin_pallet.pin_pallet_clearance import drop_needed
from watchsim.construction.pin_pallet.pin_pallet_dimensions import PinPallet
from watchsim.construction.pin_pallet.pin_pallet_numbers import pin_lever
from watchsim.construction.pin_pallet.pin_pallet_points import PinLever
from watchsim.construction.swiss_lever.swiss_lever_guard import crescent_needed
from watchsim.construction.swiss_lever.swiss_lever_wheel import locking_foot, root_radius, tooth_gap

LEAST_TOOTH, LEAST_GAP, LEAST_RISE = 2.0, 1.0, 3.0  # degrees
SPANS = (18.0, 50.0)  # degrees, half of what the pins embrace
STEEPEST = 50.0  # degrees of an impulse face from the wheel's rim
CLEARANCE = 0.05  # radii of a pin


def conflicts(values: PinPallet) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    plain = list(_plain(values))
    yield from plain
    if not plain:
        design = pin_lever(values)
        yield from _teeth(values, design)
        yield from _roller(values, design)


def _plain(values: PinPallet) -> Iterator[Conflict]:
    if values.embraced % 1.0 != 0.5:
        yield Conflict("embraced", "must be a whole number and a half: one pin locks while the other stands between two teeth")
    span = values.embraced * 180.0 / values.teeth
    if not SPANS[0] <= span <= SPANS[1]:
        words = f"with {values.teeth} teeth the pins embrace {2.0 * span:.4g}°"
        yield Conflict("embraced", f"{words}; {2.0 * SPANS[0]:g}° to {2.0 * SPANS[1]:g}° can be drawn")
    holds = math.degrees(math.atan(values.friction))
    if holds >= values.draw:
        words = f"{values.draw:.4g}° does not hold at a friction of {values.friction:.4g}: more than {holds:.2f}° is needed"
        yield Conflict("draw", words)
    if values.guard_freedom >= values.lock + values.run:
        words = f"must be less than the total lock, {values.lock + values.run:.4g}°"
        yield Conflict("guard_freedom", f"{words}: the dart is to stop the lever before it unlocks")
    if not 0.25 <= values.tip_radius / values.lever_to_balance <= 1.2:
        least, most = 0.25 * values.lever_to_balance, 1.2 * values.lever_to_balance
        words = f"must be from {least:.3g} mm to {most:.3g} mm with {values.lever_to_balance:g} mm from lever to balance"
        yield Conflict("tip_radius", f"{words}, or the lever has no room for its arms or its stem")


def _teeth(values: PinPallet, design: PinLever) -> Iterator[Conflict]:
    if design.tooth_width < LEAST_TOOTH:
        beat = 180.0 / values.teeth
        words = f"leaves {design.tooth_width:.3g}° of a beat of {beat:.4g}° for the impulse face beside drop and pin"
        yield Conflict("pallet_pin", f"{words}; {LEAST_TOOTH:g}° are needed")
        return
    rise = math.degrees(
        math.atan2(design.heel_radius - design.tip_radius, math.radians(design.tooth_width) * design.tip_radius)
    )
    if not LEAST_RISE <= rise <= STEEPEST:
        words = f"gives the impulse faces a slope of {rise:.3g}°; {LEAST_RISE:g}° to {STEEPEST:g}° work"
        yield Conflict("lift", words)
        return
    rounds = "only the front of a tooth draws, and its corner rounds the pin before it unlocks"
    for name, lever, what in (
        ("lock", design.let_off, "a tooth would drop on a pin with its corner"),
        ("guard_freedom", design.bank - values.guard_freedom, "the dart would stop the lever too late"),
    ):
        if min(design.front_used(side, lever) for side in (1, -1)) < 0.0:
            yield Conflict(name, f"{what}: {rounds}")
    needed = drop_needed(design)
    if values.drop < needed:
        words = f"must be at least {needed:.4g}°: while one pin unlocks, the other comes in behind the tooth that it let off"
        yield Conflict("drop", words)
    gap = tooth_gap(design)
    if gap < LEAST_GAP:
        words = f"between two of {values.teeth} teeth {gap:.3g}° of floor are left, {LEAST_GAP:g}° are needed"
        yield Conflict("teeth", words)
    foot, _ = locking_foot(design)
    front = math.dist(foot, (design.tip_radius, 0.0))
    deepest = min(math.hypot(*design.placed(side, side * design.bank)) for side in (1, -1)) - design.pin
    floor = root_radius(design) + CLEARANCE * design.pin
    used = max(design.front_used(side, design.bank) for side in (1, -1))
    if deepest < floor or used > front:
        most = values.pallet_pin - max(floor - deepest, used - front)
        yield Conflict("pallet_pin", f"must be at most {most:.3g} mm, else a locked pin reaches the floor between the teeth")


def _roller(values: PinPallet, design: PinLever) -> Iterator[Conflict]:
    staff = 0.16 * design.lever_scale
    if design.safety_radius - design.crescent_depth < 1.1 * staff:
        yield Conflict(
            "safety_ratio", f"the crescent would cut into the staff of {2.0 * staff:.3g} mm: the safety roller is too small"
        )
    needed = crescent_needed(design)
    if values.crescent < needed:
        words = f"must be at least {needed:.4g}°"
        yield Conflict("crescent", f"{words}: the dart enters the roller that far beside the impulse pin")
