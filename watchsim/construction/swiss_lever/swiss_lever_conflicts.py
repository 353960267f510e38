"""Which dimensions of a Swiss lever do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.outline import angle_of, polar
from watchsim.construction.swiss_lever.swiss_lever_derived import swiss
from watchsim.construction.swiss_lever.swiss_lever_dimensions import SwissLever
from watchsim.construction.swiss_lever.swiss_lever_guard import crescent_needed
from watchsim.construction.swiss_lever.swiss_lever_lever import Slot
from watchsim.construction.swiss_lever.swiss_lever_lifts import lift_on_tooth
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.construction.swiss_lever.swiss_lever_recoil import drop_after_recoil, recoil
from watchsim.construction.swiss_lever.swiss_lever_wheel import tooth_gap

LEAST_STONE, LEAST_GAP, LEAST_LIFT = 0.8, 1.0, 0.2  # degrees
SPANS = (15.0, 55.0)  # degrees, half of what the pallets embrace
WHEELS = (0.25, 1.2)  # tip radius by centre distance of lever and balance
LEAST_HORN = 4.0  # degrees of a horn's arc


def conflicts(values: SwissLever) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    plain = [*_counts(values), *_angles(values)]
    yield from plain
    if plain:
        return
    design = swiss(values)
    yield from _pallets(values, design)
    yield from _roller(values, design)


def _counts(values: SwissLever) -> Iterator[Conflict]:
    if values.embraced % 1.0 != 0.5:
        yield Conflict(
            "embraced", "must be a whole number and a half: one stone locks while the other stands between two teeth"
        )
    span = values.embraced * 180.0 / values.teeth
    if not SPANS[0] <= span <= SPANS[1]:
        least, most = (2.0 * one for one in SPANS)
        words = f"with {values.teeth} teeth the pallets embrace {2.0 * span:.4g}°; {least:g}° to {most:g}° can be drawn"
        yield Conflict("embraced", words)

    if not WHEELS[0] <= values.tip_radius / values.lever_to_balance <= WHEELS[1]:
        least, most = (one * values.lever_to_balance for one in WHEELS)
        words = f"with {values.lever_to_balance:g} mm from lever to balance must be from {least:.3g} mm to {most:.3g} mm"
        yield Conflict("tip_radius", f"{words}: the lever would have no room for its arms or its stem")


def _angles(values: SwissLever) -> Iterator[Conflict]:
    beat = 180.0 / values.teeth
    for name in ("drop_inside", "drop_outside"):
        stone = beat - values.tooth_width - getattr(values, name)
        if stone < LEAST_STONE:
            words = f"with {values.teeth} teeth a beat is {beat:.4g}° of the wheel; a tooth of {values.tooth_width:g}°"
            yield Conflict(name, f"{words} and this drop leave {stone:.4g}° for the stone, which needs {LEAST_STONE:g}°")
    if values.guard_freedom >= values.lock + values.run:
        words = f"must be less than the total lock, {values.lock + values.run:.4g}°"
        yield Conflict("guard_freedom", f"{words}: the dart is to stop the lever before it unlocks")
    if values.draw >= values.undercut:
        words = f"must be less than the undercut of the teeth, {values.undercut:.4g}°"
        yield Conflict("draw", f"{words}: else the stone's edge slides on the tooth, and the draw is that of the tooth's face")


def _pallets(values: SwissLever, design: Swiss) -> Iterator[Conflict]:
    gap = tooth_gap(design)
    if gap < LEAST_GAP:
        words = (
            f"between two of {values.teeth} teeth there is no floor left: {gap:.3g}° of it, at least {LEAST_GAP:g}° are needed"
        )
        yield Conflict("tooth_width", words)
    on_tooth = lift_on_tooth(design, -1)
    on_stone = design.lift - on_tooth
    if min(on_tooth, on_stone) < LEAST_LIFT:
        words = (
            f"the same teeth then give the exit stone {on_stone:.3g}° of lift on the stone and {on_tooth:.3g}° on the tooth;"
        )
        yield Conflict("lift_on_tooth", f"{words} each needs {LEAST_LIFT:g}°")
    thin = min(Slot(design, side).width for side in (1, -1))
    if thin < 0.04 * design.wheel_scale:
        yield Conflict("draw", f"a stone would be {1e3 * thin:.3g} µm thick: its faces nearly meet")
    else:
        yield from _unlocking(design)


def _unlocking(design: Swiss) -> Iterator[Conflict]:
    for side, name, locks, lets_off in ((-1, "drop_inside", "exit", "entry"), (1, "drop_outside", "entry", "exit")):
        left = drop_after_recoil(design, side)
        if left < 0.0:
            words = (
                f"is {-left:.3g}° too small: while the {locks} stone unlocks, the wheel recoils by {recoil(design, side):.3g}°"
            )
            yield Conflict(name, f"{words}, and the tooth that has left the {lets_off} stone would come back into that stone")


def _roller(values: SwissLever, design: Swiss) -> Iterator[Conflict]:
    staff = 0.16 * design.lever_scale
    if design.safety_radius - design.crescent_depth < 1.1 * staff:
        yield Conflict(
            "safety_ratio", f"the crescent would cut into the staff of {2.0 * staff:.3g} mm: the safety roller is too small"
        )
    needed = crescent_needed(design)
    if values.crescent < needed:
        yield Conflict("crescent", f"must be at least {needed:.4g}°: the dart enters the roller that far beside the jewel")
    horn = _horn_arc(design)
    if horn < LEAST_HORN:
        yield Conflict("horn_end", f"leaves {horn:.3g}° for the horn beside the slot; at least {LEAST_HORN:g}° are needed")


def _horn_arc(design: Swiss) -> float:
    """Degrees round the balance from the mouth of the slot to the end of the horn."""
    centre, half = design.balance_from_bank(-1), design.slot_width / 2.0
    mouth = (half, centre[1] - math.sqrt(design.horn_radius**2 - (half - centre[0]) ** 2))
    end = polar(design.horn_radius, -90.0 + design.horn_end + design.bank, centre)
    return (angle_of(end, centre) - angle_of(mouth, centre) + 180.0) % 360.0 - 180.0
