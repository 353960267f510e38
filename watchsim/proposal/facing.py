"""Which surfaces face which, and how far apart are they at given angles of the bodies?

Layers of two bodies face each other where they come within reach as the bodies turn: wheels and balances all the way, levers a
little. What lies over each other in the drawing lies at different heights and cannot meet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from watchsim.geometry.primitives import Point
from watchsim.mechanism.overlap import material, placed
from watchsim.proposal.pieces import SAME, Floats, Piece, Region, ring, united
from watchsim.proposal.roles import Role
from watchsim.proposal.words import (
    CLICK,
    DRIVER,
    FIXED,
    FORK,
    IMPULSE,
    LEVER,
    OSCILLATOR,
    OVER,
    PASSING,
    PIN,
    RESTING,
    ROLLER,
    STONES,
    WHEEL,
    facing_by_name,
    tokens,
)

SWING = math.radians(15.0)  # of a lever or click, to either side
STEPS = 7
CUTTING = "by their names, though they are drawn overlapping"
MARGIN = 0.01  # of the whole size: what comes as near as this is taken to meet
BETTER = ((FORK, PIN - IMPULSE, IMPULSE), (RESTING, ROLLER, STONES))  # of a surface: what it meets sooner than another, by name


@dataclass(frozen=True)
class Facing:
    """Two layers of two bodies that can meet. `overlap` is what they share in the drawing, by the smaller area."""

    first: Role
    first_layer: str
    second: Role
    second_layer: str
    why: str
    overlap: float = 0.0
    by_name: bool = False
    by_name_alone: bool = False  # the drawing does not show that they meet

    @property
    def sides(self) -> tuple[tuple[Role, str], tuple[Role, str]]:
        return (self.first, self.first_layer), (self.second, self.second_layer)


def facings(roles: Sequence[Role], size: float) -> tuple[list[Facing], list[Facing]]:
    """What is taken to meet, and what also comes within reach but is less likely to; each pair of layers once."""
    likely: list[Facing] = []
    others: list[Facing] = []
    for k, one in enumerate(roles):
        for other in roles[k + 1 :]:
            if not (one.moves or other.moves) or _misses(one, other) or _passes(one, other, roles):
                continue
            if one.on is other or other.on is one:
                likely.append(_rests_on(one, other))
                continue
            met = [facing for a in one.part.layers for b in other.part.layers if (facing := _facing(one, a, other, b, size))]
            kept = _best_named([facing for facing in met if facing.by_name]) or [
                one for one in met if not _lies_over(one, roles)
            ]
            if {one.task, other.task} == {PASSING, OSCILLATOR}:
                kept = _discharging(kept, likely)
            likely += kept
            others += [facing for facing in met if facing not in kept]
    return likely, others


def _best_named(named: list[Facing]) -> list[Facing]:
    """Without those of which a better one is there: of a co-axial's fork with the impulse stone, and the like."""
    words = [set(tokens(facing.first_layer)) | set(tokens(facing.second_layer)) for facing in named]
    rivals = [(one, better, worse) for one, better, worse in BETTER if any(one & found and better & found for found in words)]
    return [
        facing
        for facing, found in zip(named, words, strict=True)
        if not any(one & found and worse & found and not better & found for one, better, worse in rivals)
    ]


def _discharging(met: list[Facing], likely: Sequence[Facing]) -> list[Facing]:
    """Without rollers, which push nothing as they turn, and without what the wheel drives: that is at another height."""
    driven = [
        (role, layer) for facing in likely if WHEEL in (facing.first.task, facing.second.task) for role, layer in facing.sides
    ]
    pushing = [
        facing
        for facing in met
        if not any(side in driven or is_about_pivot(*side) for side in facing.sides if side[0].task == OSCILLATOR)
    ]
    return pushing or met


def is_about_pivot(role: Role, layer: str) -> bool:
    """Is a layer of a body nothing but discs and rims about its pivot? They push nothing as it turns."""
    return all(piece.is_disc and math.dist(piece.centroid, _at(role)) <= SAME for piece in role.part.on(layer))


def _lies_over(facing: Facing, roles: Sequence[Role]) -> bool:
    """Does a layer of the oscillator that covers a lever in the drawing meet a wheel? That is at the lever's height."""
    layers = {role.task: role.part.on(layer) for role, layer in facing.sides}
    levers = [piece for role in roles if role.task == LEVER for piece in role.part.pieces]
    return set(layers) == {WHEEL, OSCILLATOR} and any(_overlap(p, q) > OVER for p in layers[OSCILLATOR] for q in levers)


def named_facings(roles: Sequence[Role]) -> list[Facing]:
    """What works together by its names, where the drawings do not show how the parts stand; a lever meets what stands still."""
    found = []
    for k, one in enumerate(roles):
        for other in roles[k + 1 :]:
            pairs = [(a, b) for a in one.part.layers for b in other.part.layers]
            named = [(a, b) for a, b in pairs if facing_by_name(a, b, frozenset((one.task, other.task))) is not None]
            if {one.task, other.task} == {LEVER, FIXED}:
                arm = max(one.part.pieces if one.task == LEVER else other.part.pieces, key=lambda piece: piece.area).layer
                named = [pair for pair in pairs if arm in pair]
            elif len(pairs) == 1 and FIXED not in {one.task, other.task}:
                named = pairs
            found += [Facing(one, a, other, b, "by their names alone", by_name=True, by_name_alone=True) for a, b in named]
    return found


def _misses(one: Role, other: Role) -> bool:
    """What turns all the way passes what stands still; it would end there."""
    tasks = {one.task, other.task}
    return FIXED in tasks <= {WHEEL, DRIVER, OSCILLATOR, FIXED} and not (one.little or other.little)


def _passes(one: Role, other: Role, roles: Sequence[Role]) -> bool:
    """A passing spring meets what carries it and the oscillator, which by it alone moves the detent."""
    tasks = {one.task, other.task}
    if PASSING in tasks:
        return OSCILLATOR not in tasks and one.on is not other and other.on is not one
    return tasks == {LEVER, OSCILLATOR} and any(role.on in (one, other) for role in roles)


def _rests_on(one: Role, other: Role) -> Facing:
    """The two layers of a passing spring and its carrier that lie against each other."""
    pairs = [(float(p.region.distance(q.region)), p.layer, q.layer) for p in one.part.pieces for q in other.part.pieces]
    _, a, b = min(pairs)
    return Facing(one, a, other, b, "the passing spring lies against it")


def _facing(one: Role, a: str, other: Role, b: str, size: float) -> Facing | None:
    pairs = [(p, q) for p in one.part.on(a) for q in other.part.on(b)]
    overlap = max(_overlap(p, q) for p, q in pairs)
    most = facing_by_name(a, b, frozenset((one.task, other.task)))
    if overlap > (OVER if most is None else most) or not any(_reach(one, p, other, q, MARGIN * size) for p, q in pairs):
        return None
    why = "they come within reach of each other" if most is None else "by their names, and they come within reach"
    if overlap > OVER:
        why = CUTTING
    return Facing(one, a, other, b, why, overlap, most is not None)


def _overlap(p: Piece, q: Piece) -> float:
    """By the smaller area. What lies in the openings of a piece, as a wheel within a balance's rim, lies over it, too."""
    return float(p.filled.intersection(q.filled).area) / min(p.area, q.area)


def turns_fully(role: Role) -> bool:
    return role.task in (WHEEL, DRIVER) or (role.task == OSCILLATOR and not role.little)


def _reach(one: Role, p: Piece, other: Role, q: Piece, near: float) -> bool:
    if turns_fully(one) and turns_fully(other):
        (low, high), (lower, higher) = (ring(piece.points, _at(role)) for piece, role in ((p, one), (q, other)))
        apart = math.dist(_at(one), _at(other))
        return high + higher + near >= apart and apart + min(high, higher) + near >= max(low, lower)
    if turns_fully(other):
        one, p, other, q = other, q, one, p
    if turns_fully(one):
        low, high = ring(p.points, _at(one))
        ranges = [ring(points, _at(one)) for points in _swung(other, q)]
        return any(least <= high + near and most >= low - near for least, most in ranges)
    placed_p, placed_q = ([_region(piece, points) for points in _swung(role, piece)] for role, piece in ((one, p), (other, q)))
    return any(first.distance(second) <= near for first in placed_p for second in placed_q)


def _at(role: Role) -> Point:
    return role.part.centre.at if role.part.centre is not None else (0.0, 0.0)


def _swung(role: Role, piece: Piece) -> list[Floats]:
    """The outer points of a piece at some angles of its body; of what stands still where it is."""
    if not role.moves:
        return [piece.points]
    swing = SWING if role.task in (LEVER, PASSING, OSCILLATOR, CLICK) else math.pi
    return [about(piece.points, _at(role), angle) for angle in np.linspace(-swing, swing, STEPS).tolist()]


def about(points: Floats, centre: Point, angle: float) -> Floats:
    """Points turned about a centre."""
    return placed(points - np.array(centre), (*centre, angle))


def _region(piece: Piece, points: Floats) -> Region:
    ends = np.cumsum([len(ring) for ring, hole in piece.rings if not hole])
    return united(part for ring in np.split(points, ends[:-1]) for part in material([(ring, False)]))


def clearance(facings: Sequence[Facing], angles: dict[str, float]) -> float:
    """The least distance of what can meet, m; 0 where something overlaps."""
    least = math.inf
    for facing in facings:
        first, second = ([_turned(role, piece, angles) for piece in role.part.on(layer)] for role, layer in facing.sides)
        least = min([least, *(float(p.distance(q)) for p in first for q in second)])
        if least <= 0.0:
            break
    return least


def _turned(role: Role, piece: Piece, angles: dict[str, float]) -> Region:
    angle = angles.get(role.name, 0.0)
    if angle == 0.0 or role.part.centre is None:
        return piece.region
    return united(material([(about(points, role.part.centre.at, angle), hole) for points, hole in piece.rings]))
