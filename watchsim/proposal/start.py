"""At which angles do the bodies begin, how heavy are they, and what drives them, as far as drawings can say?

Where the drawing shows teeth in stones, the wheel is turned within a pitch, and the lever a little, to where all is clear.
Inertias, frequencies and torques are the likely ones: plates of steel, a balance as usual for the size, and a torque that makes
up for what the oscillator loses in a beat.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from watchsim.drawing.write import dxf_text
from watchsim.geometry.primitives import Point
from watchsim.geometry.solids import section
from watchsim.mechanism.overlap import placed
from watchsim.proposal.facing import Facing, clearance, turns_fully
from watchsim.proposal.parts import Part, nose_of, toothing
from watchsim.proposal.pieces import Floats, Piece, Source, ring
from watchsim.proposal.roles import Role, first_of, plain
from watchsim.proposal.words import CLICK, DRIVER, LEVER, OSCILLATOR, PASSING, PENDULUMS, WHEEL, tokens

STEEL = 7850.0  # kg/m³
GRAVITY = 9.81  # m/s²
WATCH = 40e-3  # m: what is larger is a clock
THICKNESS = {True: 0.2e-3, False: 2e-3}  # m, of the parts of a watch, of a clock
BALANCE = 1.2e-9  # kg·m²: 12 mg·cm², usual for a wristwatch
BEATS = {True: 28800.0, False: 7200.0}  # vph
Q_FACTOR = {True: 250.0, False: 1000.0}
SHARE = 0.35  # of the drive's work that reaches the oscillator: usual for a lever escapement
LIGHT = 30.0  # times the lever's inertia: a balance with less is drawn without its rim
KEEPS_UP = 5.0  # times the torque by which the wheel just follows the pallets: with less the swing pushes the wheel on
STEPPED = 8  # teeth: a wheel with fewer is driven step by step, as in a Geneva drive
LIFTING = 0.1  # of the drive's work that lifts a click
BENT = 0.5  # rad by which the spring of a click is bent at the start: its force hardly changes
FLAT = 0.2  # share of its motion that leads to the cam: what has less does not turn but slides
TURNS = 1.0  # per second, of what has nothing to hold it back but damping


@dataclass(frozen=True)
class Amount:
    """A number in SI units and why."""

    value: float
    why: str


@dataclass(frozen=True)
class ClickSpring:
    """What presses a click into the teeth: stiffness in N·m/rad, and the way (rad) from its start to its rest.

    What is guided straight has an `axis`, away from the cam; its spring is in N/m and m.
    """

    body: str
    stiffness: Amount
    way: float
    rest_why: str
    axis: Point | None = None


@dataclass(frozen=True)
class Amounts:
    inertia: dict[str, Amount]
    vph: Amount | None
    q_factor: Amount | None
    torque: Amount | None
    viscous: Amount | None
    driven: str | None  # the body that the torque turns
    clicks: tuple[ClickSpring, ...] = ()
    lift: Amount | None = None  # rad: the oscillator's way between the sounds from which its amplitude follows
    mass: dict[str, Amount] = field(default_factory=dict)  # kg, of what slides
    turned: str | None = None  # the body that turns evenly, as a finger does that moves a star on against its jumper


def amounts_of(roles: Sequence[Role], size: float, swing: float, met: Sequence[Facing] = ()) -> Amounts:
    """Inertias of all that moves, and what drives it."""
    watch = size < WATCH
    thick = THICKNESS[watch]
    plate = f"its outlines as steel {1e3 * thick:g} mm thick"
    inertia = {role.name: Amount(_plate(role.part, thick), plate) for role in roles if role.moves}
    wheel, lever, swinging = (first_of(roles, task) for task in (WHEEL, LEVER, OSCILLATOR))
    between = any({facing.first.task, facing.second.task} == {WHEEL, LEVER} for facing in met)
    lift = _lift(swinging, wheel) if swinging is not None and wheel is not None and not between else None
    if swinging is not None:
        inertia[swinging.name] = _oscillators(inertia, swinging, lever, wheel, lift, Q_FACTOR[watch])
    driven = _driven(roles, wheel, swinging)
    clicks = any(role.task == CLICK for role in roles)
    driver = first_of(roles, DRIVER)  # what is not known as one may as well be held by the wheel, as in a stop work
    evenly = driver is not None and driver.name == driven and (clicks or driver.part.kind == DRIVER)
    turned = driven if evenly else None
    if swinging is None:
        torque = Amount(1e-6 if watch else 1e-4, "nothing in the drawing says how strong the drive is")
        why = (
            "so that it stops when nothing drives it"
            if turned
            else f"so that {driven} comes to about {TURNS:g} turn per second"
        )
        slow = Amount(torque.value / (2.0 * math.pi * TURNS), why)
        springs = _clicks(roles, wheel, torque.value)
        sliding = [role for role in roles if any(spring.axis and spring.body == role.name for spring in springs)]
        mass = {role.name: Amount(STEEL * thick * role.part.area, plate) for role in sliding}
        if driven is None:
            return Amounts(inertia, None, None, None, None, None, springs, None, mass, turned)
        return Amounts(inertia, None, None, torque, slow, driven, springs, None, mass, turned)
    usual = f"usual for {'a watch' if watch else 'a clock'} of this size ({1e3 * size:.3g} mm)"
    length = _hanging(swinging)[1] if inertia[swinging.name].why == plate else 0.0
    by_gravity = f"as gravity swings what is drawn, like a simple pendulum of {1e3 * length:.4g} mm"
    beats = (
        Amount(round(3600.0 / math.pi * math.sqrt(GRAVITY / length), 1), by_gravity) if length else Amount(BEATS[watch], usual)
    )
    q = Amount(Q_FACTOR[watch], "usual; the escapement's own losses come on top")
    torque_amount = None
    if wheel is not None and wheel.teeth:
        omega = 2.0 * math.pi * beats.value / 7200.0
        loss = math.pi * inertia[swinging.name].value * (omega * swing) ** 2 / q.value
        value = loss / (SHARE * 2.0 * math.pi / wheel.teeth)
        why = f"it makes up for what the {swinging.name} loses at {math.degrees(swing):.3g}°, {SHARE:.0%} of it reaching it"
        torque_amount = Amount(value, why)
    carried = {role.name: Amount(STEEL * thick * role.part.area, plate) for role in roles if role.on is not None}
    springs = _detent_springs(roles, met, torque_amount.value) if torque_amount is not None else ()
    return Amounts(inertia, beats, q, torque_amount, None, driven, springs, lift, carried)


FULL_LIFT = math.radians(40.0)  # of a balance that the wheel drives itself: cylinder 40°, duplex and detent more
USUAL_LIFT = math.radians(4.0)  # of an anchor
HALVINGS = 30  # of a step of LIFTS
LIFTS = np.radians(np.arange(0.0, 20.0, 0.05)).tolist()


def _lift(swinging: Role, wheel: Role) -> Amount:
    """From where one pallet lets go of the teeth to where the other does."""
    if not swinging.little:
        return Amount(FULL_LIFT, "usual for a cylinder; the drawing does not say where the impulse begins and ends")
    released = _releases(swinging, wheel)
    if released is None:
        return Amount(USUAL_LIFT, "usual; the drawing does not show two pallets in the teeth")
    return Amount(abs(released[0] - released[1]), "from where one pallet lets go of the teeth to where the other does")


def _releases(swinging: Role, wheel: Role) -> tuple[float, float] | None:
    """How far an anchor is turned (rad) where each of its pallets lets go of the teeth; None without two."""
    teeth, centre = toothing(wheel.part), swinging.part.centre
    if teeth is None or centre is None:
        return None
    at, axis = np.array(centre.at), np.array(teeth.centre) - np.array(centre.at)
    points = np.concatenate([piece.points for piece in swinging.part.pieces]) - at
    side = np.sign(axis[0] * points[:, 1] - axis[1] * points[:, 0])
    released = []
    for pallet in (points[side > 0.0], points[side < 0.0]):
        inward = pallet[np.hypot(*(pallet - axis).T) < 1.5 * teeth.outer]
        drawn = len(inward) > 0 and _is_clear(inward, axis, 0.0, teeth.outer)
        reach = teeth.outer  # of the tips
        ways = (way for angle in LIFTS for way in (angle, -angle) if _is_clear(inward, axis, way, reach) != drawn)
        way = next(ways, None) if len(inward) else None
        released.append(None if way is None else _crossing(inward, axis, reach, way))
    if released[0] is None or released[1] is None or not 0.0 < abs(released[0] - released[1]) < 0.5:
        return None
    return released[0], released[1]


def _crossing(points: Floats, wheel: Floats, outer: float, beyond: float) -> float:
    """The angle (rad), within a step of `LIFTS` before that one, at which points come clear of the tips, or into them."""
    within, there = beyond - math.copysign(min(LIFTS[1], abs(beyond)), beyond), _is_clear(points, wheel, beyond, outer)
    for _ in range(HALVINGS):
        middle = 0.5 * (within + beyond)
        within, beyond = (within, middle) if _is_clear(points, wheel, middle, outer) == there else (middle, beyond)
    return beyond


def _is_clear(points: Floats, wheel: Floats, angle: float, outer: float) -> bool:
    """Do points about a pivot, turned, lie outside the circle of the tips about `wheel`?"""
    return bool(np.hypot(*(placed(points, (0.0, 0.0, angle)) - wheel).T).min() >= outer)


def _clicks(roles: Sequence[Role], wheel: Role | None, torque: float) -> tuple[ClickSpring, ...]:
    """Springs so strong that lifting the click over a tooth, or over the cam, takes a share of the drive's work."""
    found = []
    under = wheel or first_of(roles, DRIVER)
    for role in roles:
        if role.task != CLICK or under is None or under.part.centre is None:
            continue
        teeth, nose = toothing(under.part), nose_of(role.part, under.part)
        outline = max(under.part.pieces, key=lambda piece: piece.area).points
        low, high = ring(outline, under.part.centre.at) if teeth is None else (teeth.inner, teeth.outer)
        slides = teeth is None and nose.share < FLAT
        lift = (high - low) / (1.0 if slides else nose.arm)  # m, or rad, about
        bent = 2.0 * lift if slides else max(BENT, 2.0 * lift)
        moment = LIFTING * torque * 2.0 * math.pi / (teeth.fold if teeth is not None else 1) / lift
        over = "a tooth" if teeth is not None else under.name
        why = f"lifting it over {over} takes about {LIFTING:.0%} of the drive's work"
        axis = _away(role.part, under.part) if slides else None
        way = -bent if slides else nose.inward * bent
        pressed = "in the cam: it presses the follower on it" if slides else "in the teeth: it presses the click on the wheel"
        found.append(ClickSpring(role.name, Amount(moment / bent, why), way, pressed, axis))
    return tuple(found)


DETENT, LEAF = 0.12, 0.016  # of the wheel's torque: the moments that hold a detent on its bank, and its passing spring on it


def _detent_springs(roles: Sequence[Role], met: Sequence[Facing], torque: float) -> tuple[ClickSpring, ...]:
    """Springs that press a detent on its bank and the passing spring on the detent."""
    found = []
    for leaf in (role for role in roles if role.on is not None):
        for role, share, against in ((leaf.on, DETENT, "its bank"), (leaf, LEAF, leaf.on.name if leaf.on else "")):
            way = pressing(role, met) if role is not None else 0
            if role is not None and way:
                why = f"usual: it presses with {share:.2g} of the wheel's torque"
                stiffness = Amount(share * torque / BENT, why)
                found.append(ClickSpring(role.name, stiffness, way * BENT, f"it presses {role.name} on {against}"))
    return tuple(found)


def pressing(role: Role, met: Sequence[Facing]) -> int:
    """The way (+1 counter-clockwise) that turns a body into what carries it or stands still; 0: none."""
    rests = [f for f in met if role in (f.first, f.second) and (role.on in (f.first, f.second) if role.on else _on_still(f))]
    if not rests:
        return 0
    open_by = [clearance(rests, {role.name: side * NUDGE}) for side in (1, -1)]
    return 0 if open_by[0] == open_by[1] else 1 if open_by[0] < open_by[1] else -1


def _on_still(facing: Facing) -> bool:
    return not (facing.first.moves and facing.second.moves)


def _away(part: Part, cam: Part) -> Point:
    """The direction from a cam's pivot to that of its follower."""
    assert part.centre is not None and cam.centre is not None
    (x, y), (x0, y0) = part.centre.at, cam.centre.at
    far = math.dist((x, y), (x0, y0))
    return (x - x0) / far, (y - y0) / far


def _plate(part: Part, thickness: float) -> float:
    centre: Point = part.centre.at if part.centre is not None else (0.0, 0.0)
    return sum(abs(section(piece.loops).about(centre).polar) for piece in part.pieces) * thickness * STEEL


def _oscillators(
    inertia: dict[str, Amount], swinging: Role, lever: Role | None, wheel: Role | None, lift: Amount | None, q: float
) -> Amount:
    """As drawn; where that is too little with a balance or pendulum that is not drawn.

    An oscillator I loses π I (ω A)² / Q in a beat, of which the torque makes up. Within the time lift / (ω A) of an impulse it
    must turn a wheel J by half a pitch, or the wheel comes too late to push. So I is at least J pitch² Q / lift², about.
    """
    own = inertia[swinging.name]
    light = "what is drawn is too light to be all of it"
    if lever is not None and own.value < LIGHT * inertia[lever.name].value:
        return Amount(max(BALANCE, LIGHT * inertia[lever.name].value), f"a balance's; {light}")
    if lever is None and wheel is not None and wheel.teeth and lift is not None:
        share = (2.0 * math.pi / wheel.teeth / lift.value) ** 2
        least = KEEPS_UP * SHARE * q / math.pi * share * inertia[wheel.name].value
        if own.value < least:
            heavy = f"so heavy that the torque that it needs makes {wheel.name} keep up with it"
            return Amount(least, f"with its pendulum or balance, {heavy}; {light}")
    return own


def _driven(roles: Sequence[Role], wheel: Role | None, swinging: Role | None) -> str | None:
    driver = first_of(roles, DRIVER)
    if driver is not None and (wheel is None or wheel.teeth < STEPPED or driver.part.kind == DRIVER):
        return driver.name
    if wheel is not None:
        return wheel.name
    return next((role.name for role in roles if role.moves and role is not swinging), None)


# Lever and wheel stand as when a watch waits to be unlocked.

FINE = 96  # steps of a pitch, and of the way to a bank
MOST_BANK, USUAL_BANK = math.radians(20.0), math.radians(5.0)
BACK = math.radians(0.1)  # short of touching
NUDGE = math.radians(0.01)  # what is drawn touching is turned so far off


def locked(
    roles: Sequence[Role], facings: Sequence[Facing], angles: dict[str, float], direction: int
) -> tuple[dict[str, float], dict[str, str]] | None:
    """The lever turned to its bank, on the side from which the pin comes, and the wheel on until a tooth is at a stone.

    Of an anchor that swings itself the wheel alone is turned on. None where there is no such place.
    """
    wheel = next((role for role in roles if role.task == WHEEL and role.teeth), None)
    lever, swinging = first_of(roles, LEVER), first_of(roles, OSCILLATOR)
    if wheel is None or swinging is None:
        return None
    why = {}
    carried = first_of(roles, PASSING)
    if turns_fully(swinging):
        if lever is None:
            return None
        still = [f for f in facings if lever in (f.first, f.second) and not (f.first.moves and f.second.moves)]
        reach = _first_touch(lambda angle: clearance(still, {**angles, lever.name: angle}), MOST_BANK) if still else USUAL_BANK
        angles = {**angles, lever.name: max(reach - BACK, 0.0)}
        why[lever.name] = "just before its bank, on the side from which the pin comes" if still else "as if at its bank"
        if carried is not None:
            angles[lever.name] = -NUDGE * pressing(lever, facings)
            angles[carried.name] = -NUDGE * pressing(carried, facings)
            why |= dict.fromkeys((lever.name, carried.name), "just off what it is drawn touching")
    own = [f for f in facings if wheel in (f.first, f.second)]
    free = _free_way(lambda angle: clearance(own, {**angles, wheel.name: direction * angle}), 2.0 * math.pi / wheel.teeth)
    if free is None:
        return None
    angles = {**angles, wheel.name: direction * free}
    why[wheel.name] = "turned on, the way it is driven, until a tooth is just before a surface that stops it"
    return angles, why


def _first_touch(open_at: Callable[[float], float], most: float) -> float:
    """The angle, from 0 on, at which there is no clearance any more, at most `most`."""
    steps = np.linspace(0.0, most, FINE + 1).tolist()
    for before, angle in itertools.pairwise(steps):
        if open_at(angle) <= 0.0:
            return _edge(open_at, before, angle)
    return most


def _free_way(open_at: Callable[[float], float], pitch: float) -> float | None:
    """The end, in the driven direction, of the widest stretch of angles within a pitch where there is clearance."""
    step = pitch / FINE
    free = [open_at(k * step) > 0.0 for k in range(FINE)]
    if all(free) or not any(free):
        return 0.0 if all(free) else None
    ends = [k for k in range(FINE) if free[k] and not free[(k + 1) % FINE]]
    longest = max(ends, key=lambda k: next(n for n in range(1, FINE + 1) if not free[(k - n) % FINE]))
    return max(_edge(open_at, longest * step, (longest + 1) * step) - BACK, longest * step - step)


def _edge(open_at: Callable[[float], float], free: float, blocked: float) -> float:
    while abs(blocked - free) > 0.1 * BACK:
        middle = 0.5 * (free + blocked)
        free, blocked = (middle, blocked) if open_at(middle) > 0.0 else (free, middle)
    return free


# Parts that were drawn each by itself are put side by side.

OVER = 0.3  # of the smaller area: parts of two files that share more were not drawn where they belong
SAME = 2e-6  # m, of pivots
ROOM = 1.2  # times their width


def side_by_side(roles: Sequence[Role], files: int) -> dict[str, tuple[float, float]]:
    """Positions (m) in a row by name; none where the drawings show the parts where they belong, or are one.

    What stands still keeps its place against the first part, whose pivot is often the origin of the movement.
    """
    if files < 2 or not _on_top_of_each_other(roles):
        return {}
    places = {role.name: (0.0, 0.0) for role in roles if not role.moves}
    x = 0.0
    for role in (role for role in roles if role.moves):
        at = role.part.centre.at if role.part.centre is not None else (0.0, 0.0)
        around = [math.dist(at, (px, py)) for piece in role.part.pieces for px, py in piece.points.tolist()]
        reach = ROOM * max(around)
        x = x + reach if any(other.moves and other.name in places for other in roles) else 0.0
        places[role.name] = (round(x, 4), 0.0)
        x += reach
    return places


def _on_top_of_each_other(roles: Sequence[Role]) -> bool:
    for one, other in itertools.combinations([role.part for role in roles], 2):
        if one.file == other.file:
            continue
        if one.centre is not None and other.centre is not None and math.dist(one.centre.at, other.centre.at) <= SAME:
            return True
        if any(p.region.intersection(q.region).area > OVER * min(p.area, q.area) for p in one.pieces for q in other.pieces):
            return True
    return False


# The scene takes the drawing as it is, where every layer belongs to one body; else a copy of its outlines in which it does.

PIVOT = "PIVOT"


@dataclass(frozen=True)
class Drawn:
    """A drawing of the scene: its name and bytes; `layers` gives, by body and layer of the original, the layer there."""

    name: str
    data: bytes
    is_sorted: bool
    layers: dict[tuple[str, str], str]


def drawn(sources: Sequence[Source], roles: Sequence[Role]) -> list[Drawn]:
    """One drawing for each source; names are those of the files, which may come from different folders."""
    stems = Counter(source.path.name.casefold() for source in sources)
    found = []
    for number, source in enumerate(sources):
        own = [role for role in roles if role.part.file == number]
        prefix = f"{number + 1}_" if stems[source.path.name.casefold()] > 1 else ""
        if source.blocks or source.mended or any(plain(layer)[1] for role in own for layer in role.part.layers):
            found.append(_sorted(f"{prefix}{source.path.stem}_sorted.dxf", own))
        else:
            layers = {(role.name, layer): layer for role in own for layer in role.part.layers}
            found.append(Drawn(prefix + source.path.name, source.drawing.data, False, layers))
    return found


def _sorted(name: str, roles: Sequence[Role]) -> Drawn:
    layers: dict[tuple[str, str], str] = {}
    loops, points = [], []
    for role in roles:
        own = role.name.upper()
        for layer in role.part.layers:
            layers[role.name, layer] = _layer_name(own, layer, len(role.part.layers))
        loops += [replace(loop, layer=layers[role.name, piece.layer]) for piece in role.part.pieces for loop in piece.loops]
        if role.moves and role.part.centre is not None:
            points.append((f"{own}_{PIVOT}", role.part.centre.at))
    return Drawn(name, dxf_text(loops, points).encode(), True, layers)


def _layer_name(body: str, layer: str, count: int) -> str:
    """BODY where it has only one, else BODY_LAYER, with a number where the layer was taken apart."""
    if count == 1:
        return body
    name, number = plain(layer)
    numbered = number and (number != "1" or not tokens(name))
    return "_".join([body, *([name.strip()] if tokens(name) else []), *([number] if numbered else [])])


WHEEL_STEPS = 48  # of a pitch
LEVER_ANGLES = np.radians((0.0, 3.0, -3.0, 5.0, -5.0, 8.0, -8.0, 11.0, -11.0)).tolist()
SWINGS = np.radians((250.0, 235.0, 265.0, 220.0, 200.0, 280.0, 180.0, 150.0, 120.0, 90.0)).tolist()  # of a balance, from rest
ANCHOR_SWINGS = np.radians((4.0, 3.0, 5.0, 2.0, 6.0, 1.0, 8.0)).tolist()
AT_REST = math.radians(3.0)  # a pin this near to the line to the lever is drawn where it rests


@dataclass(frozen=True)
class Start:
    """Angles of the bodies (rad) by name, with a reason, and the spring's rest angle of the oscillator."""

    angles: dict[str, float]
    why: dict[str, str]
    rest: float
    rest_why: str
    swing: float


def start_of(roles: Sequence[Role], facings: Sequence[Facing], direction: int) -> Start:
    """Free angles, as far as they can be found: the lever at its bank, a tooth of the wheel, driven that way, at the stone."""
    swinging = first_of(roles, OSCILLATOR)
    rest, rest_why = _rest(swinging, first_of(roles, LEVER), first_of(roles, WHEEL), facings)
    angles = dict.fromkeys((role.name for role in roles if role.moves), 0.0)
    why: dict[str, str] = {}
    waiting, swing = None, 0.0
    if swinging is not None:
        ways = SWINGS if turns_fully(swinging) else ANCHOR_SWINGS
        own = [facing for facing in facings if swinging in (facing.first, facing.second)]
        side = direction if turns_fully(swinging) and first_of(roles, LEVER) is None else -1  # mirrored with the wheel
        for swing in (*ways, ways[0]):  # teeth may be too narrow for a wide swing
            angles[swinging.name] = rest + side * swing
            waiting = locked(roles, facings, angles, direction)
            if clearance(own, angles) > 0.0 if turns_fully(swinging) else waiting is not None:
                break
        why[swinging.name] = "let go at the end of a swing" if turns_fully(swinging) else "let go a little beside its rest"
    if waiting is not None:
        angles, reasons = waiting
        why.update(reasons)
    elif clearance(facings, angles) <= 0.0:
        found = _searched(roles, facings, angles)
        if found is not None:
            for name in [name for name in found if found[name] != angles[name]]:
                why[name] = "turned so far that nothing overlaps at the start; in the drawing it does"
            angles = found
    return Start(angles, why, rest, rest_why, swing)


def _rest(swinging: Role | None, lever: Role | None, wheel: Role | None, facings: Sequence[Facing]) -> tuple[float, str]:
    """How far the balance must be turned for its pin to point at the lever, or an anchor to stand midway."""
    drawn = "as it is drawn"
    if swinging is None or swinging.part.centre is None:
        return 0.0, drawn
    if swinging.little:
        tilt = _hanging(swinging)[0]
        if AT_LEAST < abs(tilt) < ASIDE:
            return -tilt, "so that it hangs straight down; it is drawn aside"
        released = _releases(swinging, wheel) if wheel is not None else None
        middle = 0.5 * sum(released) if released is not None else 0.0
        aside = released is not None and abs(middle) > OFF_BEAT * abs(released[0] - released[1])
        return (middle, "midway between where its pallets let the teeth go; it is drawn aside") if aside else (0.0, drawn)
    if lever is None or any(facing.first.on or facing.second.on for facing in facings):
        return 0.0, drawn
    touching = {layer for facing in facings for role, layer in facing.sides if role is swinging}
    at = np.array(swinging.part.centre.at)
    pins = [piece for piece in swinging.part.pieces if piece.layer in touching and _is_pin(piece, at)]
    if not pins or lever.part.centre is None:
        return 0.0, drawn
    pin = min(pins, key=lambda piece: piece.area)
    to_pin, to_lever = np.array(pin.centroid) - at, np.array(lever.part.centre.at) - at
    turn = math.atan2(*to_lever[::-1]) - math.atan2(*to_pin[::-1])
    turn = math.remainder(turn, 2.0 * math.pi)
    if abs(turn) <= AT_REST:
        return 0.0, f"{drawn}: its pin points at the lever"
    return turn, "so that its pin points at the lever"


OFF_BEAT = 0.25  # of the lift: an anchor that is drawn so far from the middle is drawn as it swings
AT_LEAST, ASIDE = math.radians(0.02), math.radians(10.0)  # a pendulum drawn so far from hanging is drawn as it swings


def _hanging(swinging: Role) -> tuple[float, float]:
    """Of a pendulum: how far (rad) it is drawn from hanging straight down, and the length (m) of the simple one that beats so.

    (0, 0) of what is called none, or is drawn another way than down the sheet.
    """
    part = swinging.part
    if part.centre is None or not {word for layer in part.layers for word in tokens(layer)} & PENDULUMS:
        return 0.0, 0.0
    at = np.array(part.centre.at)
    areas = np.array([piece.area for piece in part.pieces])
    middle = areas @ np.array([piece.centroid for piece in part.pieces]) / areas.sum() - at
    tilt, away = math.atan2(middle[0], -middle[1]), float(np.hypot(*middle))
    polar = sum(abs(section(piece.loops).about(part.centre.at).polar) for piece in part.pieces)
    return (tilt, polar / (areas.sum() * away)) if abs(tilt) < ASIDE else (0.0, 0.0)


def _is_pin(piece: Piece, centre: np.ndarray) -> bool:
    away = float(np.hypot(*(np.array(piece.centroid) - centre)))
    return away > 0.5 * math.sqrt(piece.area / math.pi)


def _searched(roles: Sequence[Role], facings: Sequence[Facing], angles: dict[str, float]) -> dict[str, float] | None:
    """The first angles, nearest to those drawn, at which nothing overlaps: the most open ones of the wheel."""
    ways: dict[str, list[float]] = {}
    for role in roles:
        if role.task in (LEVER, CLICK):
            ways[role.name] = LEVER_ANGLES
        elif role.task == OSCILLATOR and not turns_fully(role):
            drawn = angles[role.name]
            ways[role.name] = [drawn, *(side * way for way in ANCHOR_SWINGS for side in (1.0, -1.0)), 0.0]
        elif role.task == WHEEL and role.teeth:
            pitch = 2.0 * math.pi / role.teeth
            ways[role.name] = (np.arange(WHEEL_STEPS) * pitch / WHEEL_STEPS).tolist()
    wheels = [role.name for role in roles if role.task == WHEEL and role.name in ways]
    names = [name for name in ways if name not in wheels]
    for others in sorted(itertools.product(*(ways[name] for name in names)), key=lambda found: sum(map(abs, found))):
        tried = {**angles, **dict(zip(names, others, strict=True))}
        candidates = [{**tried, wheels[0]: angle} for angle in ways[wheels[0]]] if wheels else [tried]
        open_by, best = max(((clearance(facings, one), one) for one in candidates), key=lambda pair: pair[0])
        if open_by > 0.0:
            return best
    return None
