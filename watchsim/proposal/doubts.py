"""What of a proposal cannot be true, or could not be found in the drawing?

A guess that is written down beside twenty others is easily overlooked; what keeps the mechanism from working is said aloud.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np

from watchsim.geometry.primitives import Point
from watchsim.proposal.facing import CUTTING, Facing, is_about_pivot
from watchsim.proposal.parts import nose_of, toothing
from watchsim.proposal.pieces import NONE, SAME, Piece, ring
from watchsim.proposal.roles import Role, first_of
from watchsim.proposal.words import CLICK, DRIVER, LEVER, OSCILLATOR, OVER, WHEEL


def doubts(
    roles: Sequence[Role], facings: Sequence[Facing], apart: bool, leans: bool, left_out: bool, pivots: Sequence[Point] = ()
) -> list[str]:
    """Sentences, the gravest first.

    `apart`: parts were put side by side; `leans`: teeth show which way the wheel turns; `left_out`: outlines with faults were;
    `pivots` (m): the points on layers for pivots.
    """
    moving = [role for role in roles if role.moves]
    racks = [role for role in roles if any(_is_rack(piece) for piece in role.part.pieces)]
    met = {role.name for facing in facings for role, _ in facing.sides}
    found = list(_layout(moving, facings, apart, left_out))
    if not found and len(moving) > 1:
        found += [f"{role.name} meets nothing that moves or holds it: {_cure(role)}" for role in moving if role.name not in met]
        found += _chain(roles, facings)
        found += list(_heights(moving, facings)) or _cut_in(moving, facings)
        found += _overlapping(facings)
        found += _clicks([role for role in moving if role not in racks])
    elif not found and moving and not facings and len(roles) > 1:
        found.append(f"{moving[0].name} is all that moves, and nothing meets it: no pivot was found for the other parts")
    found += _centres([role for role in moving if role not in racks])
    found += list(_racks(roles)) or (_hinges(moving, pivots) if found else ())
    wheel = first_of(roles, WHEEL)
    stopped = any(role.task in (LEVER, OSCILLATOR, CLICK) for role in roles if role not in racks)
    if wheel is not None and not leans and stopped and not any(role.task == DRIVER for role in roles):
        found.append(
            f"the teeth of {wheel.name} lean neither way: that it is driven clockwise is a guess. "
            "If it runs backwards, change the sign of its torque"
        )
    return found


def _layout(moving: Sequence[Role], facings: Sequence[Facing], apart: bool, left_out: bool) -> Iterator[str]:
    if len(moving) < 2:
        return
    cure = "give each its place with position, or draw them assembled; until then nothing acts on anything"
    if apart:
        yield f"the drawings do not show where the parts stand, and they were put side by side: {cure}"
        return
    if any(facing.first.moves and facing.second.moves and not facing.by_name_alone for facing in facings):
        return
    over = [f"{one.name} and {other.name}" for one, other in itertools.combinations(moving, 2) if lie_over(one, other)]
    if over and facings and all(facing.by_name_alone for facing in facings):
        yield (
            f"{', '.join(over)} lie over each other, and nothing else comes within reach: contacts were guessed by their names "
            "alone. Draw the parts where they stand, each beside what it touches"
        )
    elif not over:
        names = ", ".join(role.name for role in moving)
        if left_out:
            yield f"{names} never come within reach of each other: what should touch may be among what was left out"
            return
        missing = list(_missing(moving))
        yield from missing
        if missing:
            return
        if not facings:
            yield (
                f"{names} never come within reach of each other: where gears that are not drawn join them, declare [[gears]]; "
                f"else {cure}"
            )
            return
        yield f"{names} lie side by side and never come within reach of each other, as in a layout for cutting: {cure}"


def _missing(moving: Sequence[Role]) -> Iterator[str]:
    """A follower that stands off its cam, or a click off its wheel: by how much, and what would close that."""
    under = first_of(moving, WHEEL) or first_of(moving, DRIVER)
    for role in (role for role in moving if role.task == CLICK):
        if under is None or under.part.centre is None or role.part.centre is None:
            continue
        at = under.part.centre.at
        highest = max(ring(piece.points, at)[1] for piece in under.part.pieces)
        gap = 1e3 * (min(ring(piece.points, at)[0] for piece in role.part.pieces) - highest)
        if 0.0 < gap < 1e3 * highest:
            yield (
                f"{role.name} stands {gap:.3g} mm off {under.name} where {under.name} is highest, out of reach of it as it is "
                f"proposed. Draw it touching; or let its spring, or gravity, close the gap: declare their contact under "
                f'[[contacts]], and see that [bodies.{role.name}] can move there, by its pivot or by motion = "slide"'
            )


def _cure(role: Role) -> str:
    if role.task == OSCILLATOR:
        return "it swings by itself and is no part of an escapement"
    return "declare what it touches under [[contacts]], or leave it out"


def _chain(roles: Sequence[Role], facings: Sequence[Facing]) -> Iterator[str]:
    """A lever stands between a wheel and an oscillator, and a click on a wheel or cam; of levers there is one."""
    pairs = [{facing.first.name, facing.second.name} for facing in facings]
    wheel, swinging = first_of(roles, WHEEL), first_of(roles, OSCILLATOR)
    levers = [role for role in roles if role.task == LEVER]
    if wheel is None or swinging is None:
        return
    carried = {role.on.name: role.name for role in roles if role.on is not None}  # a detent is moved by its passing spring
    between = [
        lever
        for lever in levers
        if {lever.name, wheel.name} in pairs and {carried.get(lever.name, lever.name), swinging.name} in pairs
    ]
    if levers and not between:
        yield (
            f"no lever comes within reach of both {wheel.name} and {swinging.name}, so that nothing passes "
            "from one to the other: look at which body each part was given to"
        )
    elif len(levers) > 1:
        rest = ", ".join(lever.name for lever in levers if lever is not between[0])
        yield (f"{rest} is no second lever of an escapement: give its layers to {between[0].name}, or leave it out")
    elif not levers and {wheel.name, swinging.name} not in pairs:
        yield f"{wheel.name} and {swinging.name} never come within reach of each other: nothing keeps {swinging.name} going"


def _clicks(moving: Sequence[Role]) -> Iterator[str]:
    """A click must end in the wheel: where its nose passes the line of centres between two teeth it holds nothing."""
    wheel = first_of(moving, WHEEL)
    teeth = None if wheel is None else toothing(wheel.part)
    for role in moving:
        if role.task != CLICK or role.part.centre is None or wheel is None or teeth is None:
            continue
        least = math.dist(role.part.centre.at, teeth.centre) - nose_of(role.part, wheel.part).arm
        if least > teeth.inner:
            yield (
                f"{role.name} can swing through the teeth of {wheel.name} unless its spring has a stop, as that of a click "
                f"that recoils: its nose comes no nearer to the centre than {1e3 * least:.3g} mm, and the teeth go down to "
                f"{1e3 * teeth.inner:.3g} mm. Give stop under [[springs]], or move its pivot, or make it longer"
            )


MANY = 3  # contacts of two bodies, without names that fit: more are likely to be of several heights


def lie_over(one: Role, other: Role) -> bool:
    return any(p.region.intersects(q.region) for p in one.part.pieces for q in other.part.pieces)


def _heights(moving: Sequence[Role], facings: Sequence[Facing]) -> Iterator[str]:
    """Parts that lie over each other, where no name says which of their surfaces are at one height."""
    partners = [{WHEEL, LEVER}, {LEVER, OSCILLATOR}]
    partners += [] if any(role.task == LEVER for role in moving) else [{WHEEL, OSCILLATOR}]
    carrying = [role.on for role in moving if role.on is not None]  # a detent is moved by its passing spring alone
    for one, other in itertools.combinations(moving, 2):
        if (one in carrying or other in carrying) and OSCILLATOR in (one.task, other.task):
            continue
        met = [facing for facing in facings if {facing.first.name, facing.second.name} == {one.name, other.name}]
        nameless = not any(facing.by_name for facing in met)
        if {one.task, other.task} in partners and nameless and (len(met) > MANY or not met) and lie_over(one, other):
            taken = f"{len(met)} contacts were taken for likely" if met else "no contact was taken for likely"
            yield (
                f"{one.name} and {other.name} lie over each other, and a flat drawing does not show which of their surfaces "
                f"are at one height; {taken}. Give surfaces that touch layers of their own, such as TEETH, STONES, FORK and PIN"
            )


DEEP = 0.3  # of the smaller area: what shares more with a wheel lies over it


def _cut_in(moving: Sequence[Role], facings: Sequence[Facing]) -> Iterator[str]:
    """What cuts a little into teeth may touch them, and be drawn at an angle that it cannot have."""
    wheel = first_of(moving, WHEEL)
    toothed = None if wheel is None else toothing(wheel.part)
    if wheel is None or toothed is None:
        return
    for other in moving:
        met = [one for one in facings if {one.first, one.second} == {wheel, other}]
        if other.task not in (LEVER, OSCILLATOR, CLICK, DRIVER) or any(one.by_name for one in met):
            continue
        teeth = [piece for piece in wheel.part.pieces if piece.turned is toothed]
        taken = {(layer, facing) for one in met for (_, facing), (role, layer) in (one.sides, one.sides[::-1]) if role is other}
        pushing = [piece for piece in other.part.pieces if not is_about_pivot(other, piece.layer)]
        pairs = [(p, q) for p in teeth for q in pushing if (q.layer, p.layer) not in taken]
        between = ((p, q) for p, q in pairs if ring(q.points, toothed.centre)[0] > toothed.inner)
        cutting = (q.layer for p, q in between if OVER < p.region.intersection(q.region).area / min(p.area, q.area) < DEEP)
        for layer in dict.fromkeys(cutting):
            yield (
                f"{layer} cuts into the teeth of {wheel.name} as it is drawn, so that it was taken to lie at another height. "
                "If it touches them, turn one of the two in the drawing until it is clear of them"
            )


def _overlapping(facings: Sequence[Facing]) -> Iterator[str]:
    """What names say to be at one height cannot be where it is drawn in each other."""
    for facing in facings:
        if facing.why == CUTTING:
            names = f"{facing.first_layer} of {facing.first.name} and {facing.second_layer} of {facing.second.name}"
            yield (
                f"{names} overlap as they are drawn, by {facing.overlap:.0%} of the smaller one; by their names they touch, so "
                "that they are taken to, from a start at which they are clear of each other. If they lie at different heights, "
                "take that contact out"
            )


STRAIGHT = 5.0  # times as long as wide
ROW, EVEN = 8, 0.02  # teeth of a rack, at least; of the pitch: what their distances scatter by


def _racks(roles: Sequence[Role]) -> Iterator[str]:
    """Rows of teeth along a line, such as a crown wheel seen from the side: nothing here turns so."""
    racks = [piece.layer for role in roles for piece in role.part.pieces if _is_rack(piece)]
    if racks:
        yield (
            f"{' and '.join(dict.fromkeys(racks))}: teeth in a straight row, as of a rack or a crown wheel seen from the side. "
            'Only wheels of teeth about a centre are proposed; give it a body with motion = "slide", bound to the wheel by '
            "[[gears]], as in the scene of watchsim new verge"
        )


def _is_rack(piece: Piece) -> bool:
    points = piece.points - piece.points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points, full_matrices=False)
    along, across = (points @ axes.T).T
    if sizes[0] < STRAIGHT * sizes[1] or np.ptp(along) < STRAIGHT * np.ptp(across):
        return False
    middle = 0.5 * (across.max() + across.min())
    for level in (0.5 * (middle + across.max()), 0.5 * (middle + across.min())):
        ups = np.flatnonzero((across[:-1] < level) & (across[1:] >= level))
        pitches = np.diff(along[ups])
        if len(ups) >= ROW and np.ptp(np.abs(pitches)) < EVEN * np.abs(pitches).mean():
            return True
    return False


def _hinges(moving: Sequence[Role], pivots: Sequence[Point]) -> Iterator[str]:
    """More pivots at one place than parts that turn about it."""
    places: list[Point] = []
    for at in pivots:
        here = sum(math.dist(at, other) <= SAME for other in pivots)
        turning = [role.name for role in moving if role.part.centre and math.dist(role.part.centre.at, at) <= SAME]
        if here <= max(1, len(turning)) or any(math.dist(at, place) <= SAME for place in places):
            continue
        places.append(at)
        about = f"only {' and '.join(turning)} turns" if turning else "no part turns"
        yield (
            f"{here} pivots are drawn at ({1e3 * at[0]:.4g}, {1e3 * at[1]:.4g}) mm, and {about} about that place as proposed: "
            "parts hinged at one place, as the pallets of a grasshopper are on its pendulum, are not distinguished. Write a "
            "body for each, with on = NAME where another one carries it"
        )


def _centres(moving: Sequence[Role]) -> Iterator[str]:
    for role in moving:
        if role.part.centre is not None and role.part.centre.worth == NONE:
            yield f"nothing shows about which point {role.name} turns: its centre of area stands for it. Give its pivot"
