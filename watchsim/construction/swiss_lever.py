"""The Swiss lever escapement: its dimensions, the draughtsman's numbers that follow, what does not go together, its scene."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, Impossible, dim, sheets_of
from watchsim.construction.outline import along, angle_of, polar, turned
from watchsim.construction.parts import edge_half
from watchsim.construction.root import zero_between
from watchsim.construction.swiss_lever_outlines import (
    INERTIA,
    MOUTH,
    Slot,
    Swiss,
    banking,
    behind,
    lever,
    roller,
    safety_roller_conflicts,
    toe_heel_back,
    tooth_gap,
    wheel,
    wheel_of,
)
from watchsim.drawing.write import Sheet
from watchsim.geometry.primitives import Edge, Line, Point

# Which numbers does the designer of a Swiss lever escapement choose?
#
# Angles of lock, run, lift and draw are at the lever's pivot and locking corner, of tooth and drop at the wheel's, lift angle
# and horn at the balance's. Playtner: H. R. Playtner, An Analysis of the Lever Escapement (1910).

PLAYTNER, USUAL = "Playtner 1910", "usual in wristwatches"
ESTIMATE = "estimate: not published for a watch"


@dataclass(frozen=True)
class SwissLever:
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
        0.66, "", 0.5, 0.75, "ratio of the safety roller's radius to that of the jewel's flat", f"{PLAYTNER}: 4/7 to 2/3"
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


# Which of the draughtsman's numbers follow from the chosen dimensions?
#
# The lift on the tooth decides how far the heel stands out, the lift angle how far the jewel stands from the balance, the
# freedom of the guard how far the dart reaches.

FARTHEST = 0.45  # of the centre distance, where the jewel's flat can stand
FINE = 1e-13  # of the jewel's distance


@lru_cache(maxsize=4)
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
    return zero_between(gap, low, high, FINE * away)


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


# How far is the impulse jewel from the wall of the slot that it comes to push?


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
    half = edge_half(design.pin_reach, design.pin_centre, design.pin_radius, design.pin_edge)
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


# How much of the drop is left once unlocking has drawn the wheel back?
#
# A tooth has dropped on one stone, the tooth before it has just left the other. While the lever unlocks, the locking face
# pushes the wheel back (the recoil that its draw asks for), and the other stone comes in behind the tooth that it let off. What
# the wheel could still be turned back before the two meet is what is left of the drop; where nothing is left, the lever cannot
# unlock.

PARTS = 40  # of an edge
STEPS = 8  # of the lever, from the bank to unlocked


def drop_after_recoil(design: Swiss, side: int) -> float:
    """Degrees of the wheel, while the entry (+1) or exit (-1) stone unlocks; negative where the other stone is in the way.

    The least over all places of the lever, between every point of that stone and the tooth at the same radius. Infinite where
    the stone stays outside the wheel.
    """
    tooth = _radii_and_angles(_back_of_tooth(design))
    stone = np.array(_points(_let_off_faces(design, -side)))
    places = np.linspace(design.bank, design.unlocked, STEPS + 1)
    return min(_left(design, side, float(lever), tooth, stone) for lever in places)


def recoil(design: Swiss, side: int) -> float:
    """Degrees by which the wheel is turned back from the bank until it is unlocked, teeth sliding on that stone."""
    return _locked_toe(design, side, design.unlocked) - _locked_toe(design, side, design.bank)


def _left(
    design: Swiss, side: int, lever: float, tooth: tuple[NDArray[np.float64], NDArray[np.float64]], stone: NDArray[np.float64]
) -> float:
    pitch = 360.0 / design.teeth
    spaces = 2.0 * design.half_span / pitch
    let_off = _locked_toe(design, side, lever) + (-math.ceil(spaces) if side > 0 else math.floor(spaces)) * pitch
    c, s = math.cos(math.radians(side * lever)), math.sin(math.radians(side * lever))
    x = c * stone[:, 0] - s * stone[:, 1] + design.lever_pivot[0]
    y = s * stone[:, 0] + c * stone[:, 1] + design.lever_pivot[1]
    (radii, angles), radius = tooth, np.hypot(x, y)
    gaps = np.degrees(np.arctan2(y, x)) - let_off - np.interp(radius, radii, angles)
    return float(gaps[(radii[0] <= radius) & (radius <= radii[-1])].min(initial=math.inf))


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


LEAST_STONE, LEAST_GAP, LEAST_LIFT = 0.8, 1.0, 0.2  # degrees
SPANS = (15.0, 55.0)  # degrees, half of what the pallets embrace
WHEELS = (0.25, 1.2)  # tip radius by centre distance of lever and balance
LEAST_HORN = 4.0  # degrees of a horn's arc


def conflicts(values: SwissLever) -> Iterator[Conflict]:
    plain = [*_counts(values), *_angles(values)]
    yield from plain
    if plain:
        return
    design = swiss(values)
    yield from _pallets(values, design)
    yield from safety_roller_conflicts(design, "jewel")
    yield from _horn(design)


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


def _horn(design: Swiss) -> Iterator[Conflict]:
    centre, half = design.balance_from_bank(-1), design.slot_width / 2.0
    mouth = (half, centre[1] - math.sqrt(design.horn_radius**2 - (half - centre[0]) ** 2))
    end = polar(design.horn_radius, -90.0 + design.horn_end + design.bank, centre)
    horn = (angle_of(end, centre) - angle_of(mouth, centre) + 180.0) % 360.0 - 180.0
    if horn < LEAST_HORN:
        yield Conflict("horn_end", f"leaves {horn:.3g}° for the horn beside the slot; at least {LEAST_HORN:g}° are needed")


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


def sheets(swiss: Swiss, inertia: float = INERTIA) -> dict[str, Sheet]:
    """File name without ending -> the part; the rim is that of a balance of `inertia` (mg·cm²).

    ValueError where a fillet does not fit.
    """
    return sheets_of(escape_wheel=wheel(swiss), lever=lever(swiss), roller=roller(swiss, inertia), banking=banking(swiss))


def draw(values: SwissLever) -> dict[str, Sheet]:
    """Its four sheets."""
    return sheets(swiss(values), values.balance_inertia)


DESIGN = Design("swiss_lever", "Swiss lever escapement with its balance", SwissLever, draw, scene_text, conflicts)
