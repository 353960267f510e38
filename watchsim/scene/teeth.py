"""How many teeth has an outline, and which wheels do they join?

Two toothed wheels in contact are a pair of gears, though nothing but their outlines says so.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loops import Loop, points_along
from watchsim.scene.forces import Side
from watchsim.scene.scene import Scene
from watchsim.scene.trains import gear_ways, reached

# An outline with Z equal teeth looks the same after 1/Z of a turn, so of the moments of its length, ∮ r² exp(i n φ) ds, only
# those with n a multiple of Z are not zero. That holds for pointed teeth, club teeth and pins alike.

MOST_TEETH = 240
FEWEST_TEETH = 3  # of a gear: pallets, pins and arms may look the same after half a turn
LARGEST_RATIO = 10**6  # denominator of the ratio of a train
SPACING = 1.0 / 400.0  # of the wheel's radius, between sampled points
NOTICEABLE = 0.05  # share of the largest moment; smaller ones are inaccuracies of the drawing
ROUND = 1e-6  # share of the length's own moment; a wheel without larger ones is a plain disc

Array = NDArray[np.float64]

_recent: deque[tuple[list[Loop], int]] = deque(maxlen=32)  # many questions about one scene ask for the same outlines


def touching_loops(scene: Scene, sides: list[Side]) -> list[Loop]:
    """The outlines of one body with which it touches others at these sides of contacts."""
    if not sides:
        return []
    body = scene.body(sides[0].body)
    layers = {layer for side in sides for layer in ([side.layer] if side.layer is not None else body.layers)}
    return [loop for loop in body.loops if loop.layer in layers and loop.closed and not loop.hole]


def teeth_of(scene: Scene, sides: list[Side]) -> int:
    """The same as `tooth_count`, of those outlines."""
    loops = touching_loops(scene, sides)
    count = next((known for others, known in _recent if _same(others, loops)), None)
    if count is None:
        count = tooth_count(loops)
        _recent.appendleft((loops, count))
    return count


def _same(first: list[Loop], second: list[Loop]) -> bool:
    return len(first) == len(second) and all(one is other for one, other in zip(first, second, strict=True))


def tooth_count(loops: list[Loop]) -> int:
    """The order of the outlines' rotational symmetry about the origin; 1 without any, 0 where all is round or nothing there."""
    points, lengths = _sampled(loops)
    weights = lengths * np.abs(points) ** 2
    direction = points / np.maximum(np.abs(points), 1e-300)
    turned, moments = weights.astype(complex), np.zeros(MOST_TEETH)
    for n in range(MOST_TEETH):
        turned = turned * direction
        moments[n] = abs(turned.sum())
    if moments.max() < ROUND * weights.sum():
        return 0
    return math.gcd(*(np.flatnonzero(moments > NOTICEABLE * moments.max()) + 1).tolist())


def _sampled(loops: list[Loop]) -> tuple[Array, Array]:
    """Complex points in the middle of short pieces of all edges, and the lengths of these pieces."""
    edges = [edge for loop in loops for edge in loop.edges]
    reach = max((math.hypot(*edge.point(f)) for edge in edges for f in (0.0, 0.5)), default=0.0)
    counts = [max(2, math.ceil(edge.length / (SPACING * reach))) for edge in edges]
    points = [points_along(edge, (np.arange(count) + 0.5) / count) for edge, count in zip(edges, counts, strict=True)]
    lengths = [edge.length / count for edge, count in zip(edges, counts, strict=True)]
    return np.concatenate([np.zeros(0, complex), *points]), np.repeat(lengths, counts)


def train(scene: Scene, name: str) -> dict[str, float]:
    """All bodies that turn with one, by declared gears or by teeth in contact, itself included: how far for one unit of it.

    Of teeth in contact that is the mean; their play is left out.
    """
    declared = gear_ways(scene)
    return reached(lambda one: {**dict(_meshes(scene, one)), **declared.get(one, {})}, name)


def turns_of_a_round(scene: Scene, name: str) -> int:
    """Turns of a wheel after which the same teeth stand in the same places again wherever its train is in mesh."""
    ratios = train(scene, name)
    passed = (
        Fraction(abs(ratio)).limit_denominator(LARGEST_RATIO) * teeth_of(scene, [side])
        for one, ratio in ratios.items()
        for contact in scene.contacts
        for side, other in (contact.sides, contact.sides[::-1])
        if side.body == one and other.body in ratios
    )
    return math.lcm(*(teeth.denominator for teeth in passed))


def _meshes(scene: Scene, name: str) -> Iterator[tuple[str, float]]:
    """The wheels whose teeth are in contact with those of a wheel, and how far they turn for one unit of it."""
    for contact in scene.contacts:
        own, other = contact.sides if contact.sides[0].body == name else contact.sides[::-1]
        if own.body != name or other.body == name or not _turn_beside_each_other(scene, own, other):
            continue
        theirs = teeth_of(scene, [other])
        mine = teeth_of(scene, [own]) if theirs >= FEWEST_TEETH else 0
        if mine >= FEWEST_TEETH:
            yield other.body, -mine / theirs


def _turn_beside_each_other(scene: Scene, *sides: Side) -> bool:
    """About pivots that keep their distance."""
    both = [scene.body(side.body) for side in sides]
    return both[0].on == both[1].on and all(body.motion == "pivot" and body.prescribed is None for body in both)
