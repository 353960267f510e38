"""Which sheets does a Swiss lever escapement need?"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from scipy.optimize import brentq

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import Conflict, Design, Impossible
from watchsim.construction.outline import along, angle_of, polar, turned
from watchsim.construction.swiss_lever_outlines import (
    INERTIA,
    Slot,
    Swiss,
    SwissLever,
    banking,
    crescent_needed,
    drop_after_recoil,
    gap_to_slot,
    lever,
    lift_on_tooth,
    recoil,
    roller,
    tooth_gap,
    wheel,
    wheel_of,
)
from watchsim.drawing.write import Sheet

# Which of the draughtsman's numbers follow from the chosen dimensions?
#
# The lift on the tooth decides how far the heel stands out, the lift angle how far the jewel stands from the balance, the
# freedom
# of the guard how far the dart reaches.

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


# Which dimensions of a Swiss lever do not go together?

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


# What does the scene of a Swiss lever say?

CLEAR = 1e-4  # degrees by which lever and wheel stand off what they rest on
NO_MORE: Mapping[str, Mapping[str, Any]] = MappingProxyType({})


def scene_text(values: SwissLever) -> str:
    """The text of scene.toml: lever on its entry bank, a tooth on the entry stone, the balance about to be let go."""
    words = "A Swiss lever escapement, drawn to these dimensions:"
    return toml.scene(
        toml.head(values, words, f"Swiss lever, {values.frequency:.0f} vph, {values.teeth} teeth"),
        parts(values),
        toml.torque("wheel", f"{-values.torque:.15g} µN·m"),
        rest(values),
    )


def parts(values: SwissLever, below: float = 0.0, more: Mapping[str, Mapping[str, Any]] = NO_MORE) -> str:
    """Bodies and hairspring: the wheel `below` (mm) the origin, with `more` entries for each body."""
    design = swiss(values)
    wheel, lever, balance = (-below, design.lever_pivot[1] - below, design.balance_pivot[1] - below)
    return toml.scene(
        toml.body(
            *("wheel", "escape_wheel", "TEETH", "turns clockwise"),
            position=_above(wheel),
            angle=toml.Noted(
                f"{wheel_angle(design):.7f}°", "a tooth a few nanometres off the locking face of the entry stone", 6
            ),
            inertia=toml.Noted(f"{values.wheel_inertia:.15g} mg·cm²", "with the train as felt here", 6),
            **more.get("wheel", {}),
        ),
        toml.body(
            *("lever", "lever", "STONES FORK DART ARMS"),
            position=_above(lever),
            angle=toml.Noted(f"{round(design.bank - CLEAR, 10):.15g}°", "a few nanometres off the bank", 5),
            inertia=f"{values.lever_inertia:.15g} mg·cm²",
            **more.get("lever", {}),
        ),
        toml.body(
            *("balance", "roller", "TABLE SAFETY PIN", "hangs at the end of a swing, the jewel far outside the fork"),
            draw="RIM",
            position=_above(balance),
            angle=f"{-values.start:.15g}°",
            inertia=f"{values.balance_inertia:.15g} mg·cm²",
            **more.get("balance", {}),
        ),
        toml.body("banking", "banking", "PINS", position=_above(wheel), motion="fixed", **more.get("banking", {})),
        toml.hairspring(values.frequency, wheel_of(design, values.balance_inertia).hairspring(90.0)),
    )


def rest(values: Any, pallets: str = "wheel.TEETH lever.STONES", tolerance: str = "1e-9") -> str:
    """Damping, contacts, and how it is run; `pallets` is the contact of wheel and lever."""
    return toml.scene(
        toml.q_factor("balance", values.q_factor),
        toml.contacts(
            values,
            pallets,
            "lever.FORK balance.PIN",
            "lever.DART balance.SAFETY: safety action: never meets in normal running",
            "lever.ARMS banking.PINS",
        ),
        toml.run("10 s", tolerance),
        toml.timegrapher(f"{values.lift_angle:.15g}°"),
    )


def _above(height: float) -> tuple[str, str]:
    return ("0 mm", f"{repr(height + 0.0).removesuffix('.0')} mm")


def wheel_angle(design: Swiss) -> float:
    """Of the wheel, °: a toe just off the entry stone's locking face, lever on its bank; at 0 one toe is on the x axis."""
    lever = design.bank - CLEAR
    corner = design.in_movement(design.locking_corner(1), lever)
    direction = design.face_direction(1) + lever
    x, y = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    middle = corner[0] * x + corner[1] * y
    reach = -middle + math.sqrt(middle**2 - math.hypot(*corner) ** 2 + design.tip_radius**2)
    toe = angle_of(along(corner, direction, reach)) + CLEAR
    pitch = 360.0 / design.teeth
    return (toe + pitch / 2.0) % pitch - pitch / 2.0


# Which sheets does a Swiss lever escapement need?


def sheets(swiss: Swiss, inertia: float = INERTIA) -> dict[str, Sheet]:
    """File name without ending -> the part; the rim is that of a balance of `inertia` (mg·cm²).

    ValueError where a fillet does not fit.
    """
    parts = {"escape_wheel": wheel(swiss), "lever": lever(swiss), "roller": roller(swiss, inertia), "banking": banking(swiss)}
    return {name: Sheet(tuple(loops)) for name, loops in parts.items()}


# What makes the Swiss lever a design?


def draw(values: SwissLever) -> dict[str, Sheet]:
    """Its four sheets."""
    return sheets(swiss(values), values.balance_inertia)


DESIGN = Design("swiss_lever", "Swiss lever escapement with its balance", SwissLever, draw, scene_text, conflicts)
