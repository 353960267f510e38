"""Which of the draughtsman's numbers follow from the chosen dimensions?

The lift on the tooth decides how far the heel stands out, the lift angle how far the jewel stands from the balance, the freedom
of the guard how far the dart reaches.
"""

from __future__ import annotations

import math
from dataclasses import replace

from scipy.optimize import brentq

from watchsim.construction.design import Impossible
from watchsim.construction.outline import polar, turned
from watchsim.construction.swiss_lever.swiss_lever_dimensions import SwissLever
from watchsim.construction.swiss_lever.swiss_lever_jewel import gap_to_slot
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss

FARTHEST = 0.45  # of the centre distance, where the jewel's flat can stand
FINE = 1e-13  # of the jewel's distance


def swiss(values: SwissLever) -> Swiss:
    """The numbers that the construction draws from. ValueError where there are none."""
    plain = Swiss(
        tip_radius=values.tip_radius,
        heel_radius=values.tip_radius,
        teeth=values.teeth,
        tooth_width=values.tooth_width,
        undercut=values.undercut,
        half_span=values.embraced * 180.0 / values.teeth,
        lock=values.lock,
        run=values.run,
        lift=values.lift_on_stone + values.lift_on_tooth,
        drop_inside=values.drop_inside,
        drop_outside=values.drop_outside,
        draw=values.draw,
        lever_to_balance=values.lever_to_balance,
        slot_width=values.jewel_width + values.shake,
        pin_radius=values.jewel_width / 2.0,
        pin_ground=values.jewel_ground,
        horn_clearance=values.horn_clearance,
        horn_end=values.horn_end,
        crescent_half=values.crescent,
    )
    driven = replace(plain, heel_radius=heel_radius(plain, values.lift_on_tooth))
    reaching = replace(driven, pin_reach=pin_reach(driven, values.lift_angle))
    guarded = replace(reaching, safety_radius=values.safety_ratio * reaching.pin_reach)
    return replace(guarded, dart_clearance=dart_clearance(guarded, values.guard_freedom))


def heel_radius(design: Swiss, lift_on_tooth: float) -> float:
    """Such that the entry stone's discharge corner crosses the tip circle that much lever angle before the heel leaves it.

    The corner of let-off, R u from the wheel's centre, turned back about the lever's pivot P, must lie on the tip circle:
    a quadratic equation in R.
    """
    way = polar(1.0, design.heel_at_let_off(1))
    x, y = turned(way, lift_on_tooth)
    px, py = design.lever_pivot
    tx, ty = turned((px, py), lift_on_tooth)
    dx, dy = px - tx, py - ty
    half, apart = x * dx + y * dy, math.hypot(dx, dy)
    if not apart < design.tip_radius:
        raise Impossible("lift_on_tooth", "the entry stone's corner never crosses the circle of the toes")
    return -half + math.sqrt(half * half - apart**2 + design.tip_radius**2)


def pin_reach(design: Swiss, lift_angle: float) -> float:
    """Such that the jewel, half a lift angle before the middle, meets the far wall of the slot; lever on its bank."""
    away = design.lever_to_balance
    low = away * math.sin(math.radians(design.bank)) + design.slot_width / 2.0  # nearer, the horn would not reach the slot
    high = FARTHEST * away

    def gap(reach: float) -> float:
        return gap_to_slot(replace(design, pin_reach=reach), -lift_angle / 2.0)

    if not gap(low) < 0.0 < gap(high):
        words = f"no jewel between {low:.3g} mm and {high:.3g} mm from the balance has this lift angle with a lever that"
        raise Impossible("lift_angle", f"{words} swings by {2.0 * design.bank:.4g}° and stands {away:g} mm off")
    return float(brentq(gap, low, high, xtol=FINE * away, rtol=1e-14))


def dart_clearance(design: Swiss, freedom: float) -> float:
    """Of the dart's point from the safety roller on the bank, for the lever's freedom (degrees) until they meet.

    They meet where the point's centre, y above the pivot, is a roller and a point's radius from the balance.
    """
    away, reach = design.lever_to_balance, design.safety_radius + design.dart_tip
    if not freedom < design.bank:
        raise Impossible("guard_freedom", f"must be less than half of the lever's travel, {design.bank:.4g}°")
    meets, rests = math.radians(design.bank - freedom), math.radians(design.bank)
    if not away * math.sin(meets) < reach:
        raise Impossible(
            "safety_ratio", "the dart swings past the safety roller: it must be larger, or the lever's travel smaller"
        )
    y = away * math.cos(meets) - math.sqrt(reach**2 - (away * math.sin(meets)) ** 2)
    return math.sqrt(away**2 + y**2 - 2.0 * away * y * math.cos(rests)) - reach
