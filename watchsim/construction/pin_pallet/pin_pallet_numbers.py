"""Which numbers of a pin-pallet escapement follow from the chosen dimensions?"""

from __future__ import annotations

import math
from dataclasses import replace

from scipy.optimize import brentq

from watchsim.construction.design import Impossible
from watchsim.construction.outline import angle_of
from watchsim.construction.pin_pallet.pin_pallet_dimensions import PinPallet
from watchsim.construction.pin_pallet.pin_pallet_points import PinLever
from watchsim.construction.swiss_lever.swiss_lever_derived import dart_clearance, pin_reach

GROUND, CLEARANCE, HORN = 3.0 / 7.0, 0.042, 62.0  # impulse pin and horns as in a Swiss lever of 4.36 mm
SHIFT = 3.0  # degrees by which the half span may differ from a whole number and a half of spaces


def pin_lever(values: PinPallet) -> PinLever:
    """The numbers that the construction draws from. ValueError where there are none."""
    nominal = values.embraced * 180.0 / values.teeth
    plain = PinLever(
        tip_radius=values.tip_radius,
        teeth=values.teeth,
        half_span=nominal,
        lock=values.lock,
        run=values.run,
        lift=values.lift,
        drop_inside=values.drop,
        drop_outside=values.drop,
        lever_to_balance=values.lever_to_balance,
        slot_width=values.jewel_width + values.shake,
        pin_radius=values.jewel_width / 2.0,
        pin_ground=GROUND,
        horn_clearance=CLEARANCE * values.lever_to_balance / 4.36,
        horn_end=HORN,
        crescent_half=values.crescent,
        pin=values.pallet_pin / 2.0,
    )
    spread = replace(plain, half_span=_half_span(plain, nominal))
    drawing = replace(spread, undercut=_undercut(spread, values.draw))
    toothed = replace(drawing, heel_radius=heel_radius(drawing), tooth_width=tooth_width(drawing))
    reaching = replace(toothed, pin_reach=pin_reach(toothed, values.lift_angle))
    guarded = replace(reaching, safety_radius=values.safety_ratio * reaching.pin_reach)
    return replace(guarded, dart_clearance=dart_clearance(guarded, values.guard_freedom))


def _half_span(design: PinLever, nominal: float) -> float:
    """Such that both drops are equal: as one pin lets off, the two are a whole number and a half of spaces apart."""

    def excess(half: float) -> float:
        placed = replace(design, half_span=half)
        left, right = placed.placed(1, -placed.let_off), placed.placed(-1, -placed.let_off)
        return angle_of(left) - angle_of(right) - 2.0 * nominal

    return float(brentq(excess, nominal - SHIFT, nominal + SHIFT, xtol=1e-13))


def _undercut(design: PinLever, draw: float) -> float:
    """Such that the pin with less draw has the draw asked for."""

    def excess(undercut: float) -> float:
        leaning = replace(design, undercut=undercut)
        return min(leaning.draw_of(side, leaning.bank) for side in (1, -1)) - draw

    most = 45.0
    if excess(most) < 0.0:
        raise Impossible("draw", f"would need teeth undercut by more than {most:g}°")
    return float(brentq(excess, 0.0, most, xtol=1e-13))


def heel_radius(design: PinLever) -> float:
    """To the back corner of a tooth, which passes beneath a pin's centre as it lets off."""
    return math.hypot(*design.placed(1, -design.let_off)) - design.pin


def tooth_width(design: PinLever) -> float:
    """Of a tooth's impulse face, at the wheel's centre: what half a pitch leaves beside drop and pin."""
    return 180.0 / design.teeth - design.drop_inside - design.behind_pin(design.placed(1, design.let_off))
