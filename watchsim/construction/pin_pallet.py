"""Pin-pallet (Roskopf) lever escapement with its balance: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, ESTIMATE, Conflict, Design, Impossible, dim, sheets_of
from watchsim.construction.outline import angle_of, circle, polar, rounded, turned
from watchsim.construction.parts import too_little_draw
from watchsim.construction.root import zero_between
from watchsim.construction.swiss_lever import dart_clearance, pin_reach, rest
from watchsim.construction.swiss_lever_outlines import (
    LEVER_BORE,
    LEVER_HUB,
    Swiss,
    banking,
    dart,
    fork,
    locking_foot,
    neck_height,
    roller,
    root_radius,
    safety_roller_conflicts,
    toe_heel_back,
    tooth_gap,
    wheel,
    wheel_of,
)
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point

# Which numbers does the designer of a pin-pallet lever escapement choose?
#
# A Roskopf pocket watch's size. Angles of lock, run and lift are at the lever's pivot, of the drop at the wheel's, lift angle
# and horn at the balance's.

PLAYTNER, USUAL = "as in a Swiss lever, Playtner 1910", "usual in pin-lever watches"


@dataclass(frozen=True)
class PinPallet:
    teeth: int = dim(15, "", 12, 21, "teeth of the escape wheel", USUAL)
    embraced: float = dim(2.5, "", 1.5, 4.5, "tooth spaces between the two pins, a whole number and a half", USUAL)
    tip_radius: float = dim(3.6, "mm", 0.8, 20.0, "escape wheel, to the front corners of its teeth", CHOSEN)
    pallet_pin: float = dim(0.24, "mm", 0.05, 2.0, "diameter of the steel pins that are the pallets", CHOSEN)
    lock: float = dim(2.0, "°", 0.5, 4.0, "lever, from the drop of a tooth on a pin to unlocked", "more than with stones")
    run: float = dim(0.5, "°", 0.1, 2.0, "lever, from the drop to the banking; lock and run are the total lock", PLAYTNER)
    lift: float = dim(10.0, "°", 5.0, 12.0, "lever, from unlocked to let off; all of it is on the teeth", CHOSEN)
    drop: float = dim(
        3.0, "°", 0.5, 6.0, "wheel, from where a heel is below a pin's centre to the next lock, the same on both sides", CHOSEN
    )
    draw: float = dim(12.0, "°", 5.0, 20.0, "by the fronts of the teeth, on the pin with less, lever on its bank", PLAYTNER)
    lever_to_balance: float = dim(6.5, "mm", 1.5, 40.0, "centre distance of lever and balance", CHOSEN)
    lift_angle: float = dim(52.0, "°", 30.0, 75.0, "balance, while the jewel is in the fork", CHOSEN)
    jewel_width: float = dim(0.48, "mm", 0.08, 4.0, "diameter of the impulse pin before its flat is ground", CHOSEN)
    shake: float = dim(0.03, "mm", 0.003, 0.3, "by which the slot of the fork is wider than the impulse pin", PLAYTNER)
    guard_freedom: float = dim(1.0, "°", 0.2, 2.5, "lever, from its bank until the dart meets the safety roller", PLAYTNER)
    safety_ratio: float = dim(
        0.62, "", 0.5, 0.75, "ratio of the safety roller's radius to that of the impulse pin's flat", PLAYTNER
    )
    crescent: float = dim(25.0, "°", 12.0, 40.0, "half opening of the crescent, at the balance's centre", CHOSEN)
    wheel_inertia: float = dim(0.3, "mg·cm²", 1e-3, 100.0, "escape wheel with the train as felt there", ESTIMATE)
    lever_inertia: float = dim(0.2, "mg·cm²", 1e-3, 100.0, "lever with pins and dart", ESTIMATE)
    balance_inertia: float = dim(35.0, "mg·cm²", 1.0, 1e4, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(18000.0, "vph", 7200.0, 28800.0, "of the balance on its hairspring, in beats per hour", USUAL)
    q_factor: float = dim(150.0, "", 20.0, 1000.0, "quality factor of the balance without the escapement", ESTIMATE)
    torque: float = dim(2.0, "µN·m", 0.01, 1e3, "of the train on the escape wheel", ESTIMATE)
    friction: float = dim(0.12, "", 0.0, 0.3, "coefficient of friction, in all contacts", "oiled steel on brass 0.11 to 0.19")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(250.0, "°", 60.0, 300.0, "balance, from rest, where it is let go", CHOSEN)


# Which points of a pin-pallet escapement follow from its numbers?
#
# The wheel's centre O is the origin and the wheel turns clockwise; a positive lever angle puts the entry pin (left) deep. With
# the lever at `unlocked` a pin's centre C stands where OC and the line to the lever's pivot P are at right angles, and the
# front corner of a tooth, behind the pin on that line, pushes through P: it neither draws nor drives. Both pins are as far from
# P, so that a let-off on one side is the mirror image of that on the other. Millimetres and degrees.


@dataclass(frozen=True)
class PinLever(Swiss):
    """The numbers of a Swiss lever, whose fork, roller and banking it has, and those of the pins.

    `half_span` is that of the pins' centres at `unlocked`, `undercut` the lean of a tooth's front from the radius.
    """

    pin: float = 0.15  # radius of the pallets

    @property
    def unlocking_radius(self) -> float:
        """From O to the pin's centre at `unlocked`."""
        return math.sqrt(self.tip_radius**2 - self.pin**2)

    @property
    def lever_pivot(self) -> Point:
        return (0.0, self.unlocking_radius / math.cos(math.radians(self.half_span)))

    @property
    def arm(self) -> float:
        """From P to the pins' centres."""
        return self.unlocking_radius * math.tan(math.radians(self.half_span))

    def pallet(self, side: int) -> Point:
        """Centre of the entry (1) or exit (-1) pin, in the lever's frame."""
        return polar(self.arm, 270.0 - side * (90.0 - self.half_span + self.unlocked))

    def placed(self, side: int, lever: float) -> Point:
        """The same in the movement, the lever at `lever` degrees."""
        return self.in_movement(self.pallet(side), lever)

    def behind_pin(self, centre: Point) -> float:
        """Degrees of the wheel from a pin there to the front corner of the tooth whose front rests on it.

        With the corner at (R, 0) the front goes inwards from it in the direction 180° - u; the pin's centre, the angle b
        before the corner, is a pin's radius off that line: R sin u + |C| sin(b - u) = pin.
        """
        lean = math.radians(self.undercut)
        return self.undercut + math.degrees(math.asin((self.pin - self.tip_radius * math.sin(lean)) / math.hypot(*centre)))

    def locked_corner(self, side: int, lever: float) -> float:
        """Polar angle of the front corner of a tooth whose front rests on a pin, the lever that far to the pin's own side."""
        centre = self.placed(side, side * lever)
        return angle_of(centre) + self.behind_pin(centre)

    def front_used(self, side: int, lever: float) -> float:
        """How far from its corner the front of a tooth touches the pin; negative where the corner does."""
        centre = self.placed(side, side * lever)
        before, lean = math.radians(self.behind_pin(centre)), math.radians(self.undercut)
        x, y = math.hypot(*centre) * math.cos(before), -math.hypot(*centre) * math.sin(before)
        return (self.tip_radius - x) * math.cos(lean) + y * math.sin(lean)

    def draw_of(self, side: int, lever: float) -> float:
        """Where a tooth's front rests on a pin: between its push and the line through P, positive where it draws the pin in."""
        push = self.locked_corner(side, lever) - 90.0 - self.undercut
        touched = polar(-self.pin, push, self.placed(side, side * lever))
        through = angle_of(self.lever_pivot, touched) if side > 0 else angle_of(touched, self.lever_pivot)
        return (through - push + 180.0) % 360.0 - 180.0


# Which numbers of a pin-pallet escapement follow from the chosen dimensions?

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

    return zero_between(excess, nominal - SHIFT, nominal + SHIFT, 1e-13)


def _undercut(design: PinLever, draw: float) -> float:
    """Such that the pin with less draw has the draw asked for."""

    def excess(undercut: float) -> float:
        leaning = replace(design, undercut=undercut)
        return min(leaning.draw_of(side, leaning.bank) for side in (1, -1)) - draw

    most = 45.0
    if excess(most) < 0.0:
        raise Impossible("draw", f"would need teeth undercut by more than {most:g}°")
    return zero_between(excess, 0.0, most, 1e-13)


def heel_radius(design: PinLever) -> float:
    """To the back corner of a tooth, which passes beneath a pin's centre as it lets off."""
    return math.hypot(*design.placed(1, -design.let_off)) - design.pin


def tooth_width(design: PinLever) -> float:
    """Of a tooth's impulse face, at the wheel's centre: what half a pitch leaves beside drop and pin."""
    return 180.0 / design.teeth - design.drop_inside - design.behind_pin(design.placed(1, design.let_off))


# How much drop does a round pin need to come in behind the tooth that it let off?
#
# A heel lets off as it passes beneath the pin's centre, so that half of the pin is still above the tooth. While the other pin
# unlocks, draw turns the wheel back, and the corner of its tooth rounds it before the wheel goes on, this one comes in.

STEPS = 120  # of the lever, from its bank to the let-off
MOST = 12.0  # degrees more than drawn


def drop_needed(design: PinLever) -> float:
    """Degrees of the wheel, the larger of both pins'; infinite where even a thin tooth would be in the way."""

    def least(more: float) -> float:
        return min(_clear(design, side, more) for side in (1, -1)) - design.pin

    if least(MOST) < 0.0:
        return math.inf
    if least(-MOST) > 0.0:
        return 0.0
    return design.drop_inside + zero_between(least, -MOST, MOST, 1e-9)


def _clear(design: PinLever, locks: int, more: float) -> float:
    """Least distance of the other pin's centre from the back of the tooth before it, its heel so much nearer its front corner
    than drawn; negative where the centre is still above the tooth."""
    spaces = (design.teeth * 2.0 * design.half_span / 360.0) // 1.0
    steps = (math.floor(spaces) + (0 if locks < 0 else 1)) * -locks
    found = math.inf
    for lever in np.linspace(-design.let_off, design.bank, STEPS + 1):
        heel = pushed_corner(design, locks, float(lever)) + steps * 360.0 / design.teeth - more
        centre = design.placed(-locks, locks * float(lever))
        found = min(found, _from_back(design, turned(centre, -heel)))
    return found


def pushed_corner(design: PinLever, side: int, lever: float) -> float:
    """Polar angle of the front corner of the tooth that a pin touches, by its front, its corner or its impulse face."""
    if design.front_used(side, lever) >= 0.0:
        return design.locked_corner(side, lever)
    centre, corner = design.placed(side, side * lever), (design.tip_radius, 0.0)
    away, reach = math.hypot(*centre), design.tip_radius
    cosine = (away**2 + reach**2 - design.pin**2) / (2.0 * away * reach)
    before = math.acos(cosine) if cosine < 1.0 else 0.0
    _, heel, _ = toe_heel_back(design)
    slope = angle_of(heel, corner) - 90.0  # of the impulse face's normal
    if angle_of((away * math.cos(before), -away * math.sin(before)), corner) > slope or cosine >= 1.0:
        normal = math.radians(slope)
        before = -math.acos(min(1.0, (design.pin + reach * math.cos(normal)) / away)) - normal
    return angle_of(centre) + math.degrees(before)


def _from_back(design: PinLever, centre: Point) -> float:
    """Distance from the straight part of a tooth's back, the front corner of that tooth on the x axis."""
    _, heel, back = toe_heel_back(design)
    along = np.subtract(back, heel)
    share = float(np.clip(np.dot(np.subtract(centre, heel), along) / np.dot(along, along), 0.0, 1.0))
    nearest = (heel[0] + share * along[0], heel[1] + share * along[1])
    beyond = math.atan2(centre[1], centre[0]) - math.atan2(nearest[1], nearest[0])
    return math.copysign(math.dist(centre, nearest), beyond)


LEAST_TOOTH, LEAST_GAP, LEAST_RISE = 2.0, 1.0, 3.0  # degrees
SPANS = (18.0, 50.0)  # degrees, half of what the pins embrace
STEEPEST = 50.0  # degrees of an impulse face from the wheel's rim
OFF_THE_FLOOR = 0.05  # radii of a pin


def conflicts(values: PinPallet) -> Iterator[Conflict]:
    plain = list(_plain(values))
    yield from plain
    if not plain:
        design = pin_lever(values)
        yield from _teeth(values, design)
        yield from safety_roller_conflicts(design, "impulse pin")


def _plain(values: PinPallet) -> Iterator[Conflict]:
    if values.embraced % 1.0 != 0.5:
        yield Conflict("embraced", "must be a whole number and a half: one pin locks while the other stands between two teeth")
    span = values.embraced * 180.0 / values.teeth
    if not SPANS[0] <= span <= SPANS[1]:
        words = f"with {values.teeth} teeth the pins embrace {2.0 * span:.4g}°"
        yield Conflict("embraced", f"{words}; {2.0 * SPANS[0]:g}° to {2.0 * SPANS[1]:g}° can be drawn")
    yield from too_little_draw(values)
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
    floor = root_radius(design) + OFF_THE_FLOOR * design.pin
    used = max(design.front_used(side, design.bank) for side in (1, -1))
    if deepest < floor or used > front:
        most = values.pallet_pin - max(floor - deepest, used - front)
        yield Conflict("pallet_pin", f"must be at most {most:.3g} mm, else a locked pin reaches the floor between the teeth")


# What is the outline of a pin-pallet lever?
#
# Two round pins (layer PALLETS) stand on the arms of a body with hub and stem (ARMS); fork (FORK) and dart (DART) are those of
# a Swiss lever. In the lever's frame, pivot at the origin, balance above; millimetres.

BOSS = 2.0  # half the breadth of an arm round its pin, in radii of the pin
ROOT = 0.75  # half the breadth of an arm at the hub, of the hub's radius


def pin_pallet_lever(design: PinLever) -> list[Loop]:
    """All outlines of the lever."""
    return [
        *(circle("PALLETS", design.pallet(side), design.pin) for side in (1, -1)),
        body(design),
        circle("ARMS", (0.0, 0.0), LEVER_BORE * design.lever_scale, hole=True),
        fork(design),
        dart(design),
    ]


def body(design: PinLever) -> Loop:
    """Stem and two arms, counter-clockwise from the right end of the stem's top; one half is the other mirrored."""
    hub, half, boss = LEVER_HUB * design.lever_scale, design.stem_half, BOSS * design.pin
    x, y = design.pallet(-1)
    way = (x / (x**2 + y**2) ** 0.5, y / (x**2 + y**2) ** 0.5)
    right: list[tuple[Point, float]] = [
        (polar(1.2 * hub, 250.0 + 20.0), hub),
        (_beside((x, y), way, boss, -boss), 0.95 * boss),
        (_beside((x, y), way, boss, boss), 0.95 * boss),
        (_beside((0.0, 0.0), way, 1.6 * hub, ROOT * hub), 0.8 * hub),
        ((half, 2.0 * hub), hub),
        ((half, neck_height(design)), 0.0),
    ]
    left = [((-x, y), radius) for (x, y), radius in reversed(right[1:])]
    return rounded("ARMS", [*right, *left], yielding=True)


def _beside(point: Point, way: Point, ahead: float, left: float) -> Point:
    return (point[0] + ahead * way[0] - left * way[1], point[1] + ahead * way[1] + left * way[0])


CLEAR = 1e-4  # degrees by which lever and wheel stand off what they rest on


def scene_text(values: PinPallet) -> str:
    """The text of scene.toml: lever on its entry bank, a tooth on the entry pin, the balance about to be let go."""
    design = pin_lever(values)
    lever = design.bank - CLEAR
    wheel_angle = round((design.locked_corner(1, lever) + CLEAR) % (360.0 / values.teeth), 9)
    return toml.scene(
        toml.head(
            *(values, "A pin-pallet (Roskopf) lever escapement, drawn to these dimensions:"),
            f"Pin-pallet lever, {values.frequency:.0f} vph, {values.teeth} teeth",
        ),
        toml.body(
            *("wheel", "escape_wheel", "TEETH", "turns clockwise"),
            position=toml.ORIGIN,
            angle=toml.Noted(f"{wheel_angle!r}°", "a tooth just off the entry pin"),
            inertia=toml.Noted(f"{values.wheel_inertia:.15g} mg·cm²", "with the train as felt here", 6),
        ),
        toml.body(
            *("lever", "lever", "PALLETS FORK DART ARMS"),
            position=toml.at(0, design.lever_pivot[1]),
            angle=toml.Noted(f"{round(lever, 10)!r}°", "just off the bank"),
            inertia=f"{values.lever_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("balance", "roller", "TABLE SAFETY PIN"),
            "hangs at the end of a swing, the impulse pin far outside the fork",
            draw="RIM",
            position=toml.at(0, design.balance_pivot[1]),
            angle=f"{-values.start!r}°",
            inertia=f"{values.balance_inertia:.15g} mg·cm²",
        ),
        toml.banking(),
        toml.hairspring(values.frequency, wheel_of(design, values.balance_inertia).hairspring(90.0)),
        toml.torque("wheel", f"{-values.torque!r} µN·m"),
        rest(values, "wheel.TEETH lever.PALLETS"),
    )


def draw(values: PinPallet) -> dict[str, Sheet]:
    """Its four sheets."""
    design = pin_lever(values)
    balance = roller(design, values.balance_inertia)
    return sheets_of(escape_wheel=wheel(design), lever=pin_pallet_lever(design), roller=balance, banking=banking(design))


DESIGN = Design("pin_pallet", "Pin-pallet (Roskopf) lever escapement with its balance", PinPallet, draw, scene_text, conflicts)
