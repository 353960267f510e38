"""Does the sieve leave to the polygons exactly what shapely finds within half the depth of the shrunk outline?"""

from __future__ import annotations

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest
import shapely
from every_time import few
from moving_scenes import circle
from plain_kernels import in_python

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.force import Side
from watchsim.simulation.record import overlap_sieve
from watchsim.simulation.record.layer_outlines import shrunk_material, stretches_of
from watchsim.simulation.record.overlap_instants import MARGIN, Layers, PairOfLayers
from watchsim.simulation.record.overlap_sieve import sieve
from watchsim.simulation.record.watched_instants import longest_moves

MM, DEPTH = 1e-3, 2e-6
HOLE = dataclasses.replace(circle(1.2 * MM).reversed(), hole=True)


def star(rng: np.random.Generator, corners: int, size: float, x: float = 0.0) -> Loop:
    """A ring round (x, 0) with as many corners, at random distances from it."""
    angles = 2.0 * math.pi / corners * (np.arange(corners) + rng.uniform(-0.4, 0.4, corners))
    points = size * rng.uniform(0.6, 1.0, corners) * np.exp(1j * angles) + x
    return Loop(tuple(Line(a.real, a.imag, b.real, b.imag) for a, b in zip(points, np.roll(points, -1), strict=True)))


def shapes(rng: np.random.Generator) -> list[tuple[Loop, ...]]:
    """A few corners, many, arcs, a ring around a hole, two rings, a small disc."""
    return [
        (star(rng, 7, 2 * MM),),
        (star(rng, 90, 3 * MM),),
        (circle(1.5 * MM),),
        (circle(2 * MM), HOLE),
        (star(rng, 12, 1 * MM, -2 * MM), star(rng, 12, 1 * MM, 2 * MM)),
        (circle(0.3 * MM),),
    ]


def brought(rings, mover: np.ndarray, still: np.ndarray) -> shapely.Geometry:
    """Rings of a frame that stands at `mover` (x, y, angle), seen from the frame at `still`."""
    shift, twist = (mover - still)[:2] @ (1.0, 1j) * np.exp(-1j * still[2]), np.exp(1j * (mover[2] - still[2]))
    material = shapely.Polygon()
    for points, hole in rings:
        at = points @ (1.0, 1j) * twist + shift
        part = shapely.Polygon(np.column_stack([at.real, at.imag]))
        material = material.difference(part) if hole else material.union(part)
    return material


def left_by_the_sieve(layers: Layers, where: np.ndarray) -> np.ndarray:
    left = np.zeros((1, where.shape[1]), bool)
    sieve(*layers._records(DEPTH), where, MARGIN * DEPTH, layers._room, left)
    return left[0]


@pytest.mark.parametrize("seed", few(range(6), 3))
def test_what_it_leaves_is_what_shapely_finds_near(seed: int) -> None:
    rng = np.random.default_rng(seed)
    kinds = shapes(rng)
    found = []
    for first, second in [(a, b) for a in kinds for b in kinds]:
        pair = PairOfLayers(0, (Side("a"), Side("b")), (first, second), DEPTH / 8)
        # Many poses for the outlines to touch, few that are far apart.
        place, way = rng.normal(0.0, 2.5 * MM, (2, 40)), rng.uniform(-9.0, 9.0, (2, 40))
        where = np.zeros((2, 40, 3))
        where[:, :, :2] = rng.normal(0.0, 5 * MM, 2)
        where[1, :, :2] += place.T
        where[:, :, 2] = way
        layers = Layers((pair,))
        left = left_by_the_sieve(layers, where)
        still, mover = (where[layers.bodies.index(body)] for body in pair.bodies)
        material = shrunk_material(pair.still, DEPTH)
        for i in range(40):
            apart = shapely.distance(material, brought(pair.mover.rings, mover[i], still[i]))
            if abs(apart - MARGIN * DEPTH) > 1e-3 * DEPTH:
                assert left[i] == (apart < MARGIN * DEPTH), (first, second, where[:, i], apart)
        found += left.tolist()
    assert 0.2 < np.mean(found) < 0.8, "the case tests nothing any more"


def test_what_touches_passes() -> None:
    """Two discs, and the circles of their chords, which lie up to an eighth of the depth within."""
    pair = PairOfLayers(0, (Side("a"), Side("b")), ((circle(1 * MM),), (circle(2 * MM),)), DEPTH / 8)
    angles = np.linspace(0.0, 6.0, 50)
    for gap, expected in ((0.0, False), (-0.1 * DEPTH, False), (-1.3 * DEPTH, True)):
        where = np.zeros((2, 50, 3))
        where[1, :, 0], where[1, :, 1] = (3 * MM + gap) * np.cos(angles), (3 * MM + gap) * np.sin(angles)
        where[:, :, 2] = angles * np.array([[1.0], [-2.0]])
        assert left_by_the_sieve(Layers((pair,)), where).tolist() == [expected] * 50


def test_stretches_cover_their_outlines() -> None:
    rng = np.random.default_rng(4)
    for loops in shapes(rng):
        outlines = PairOfLayers(0, (Side("a"), Side("b")), (loops, loops), DEPTH / 8).still
        stretches, points = stretches_of(outlines, 0.0)
        covered = 0
        for row in stretches:
            inside = points[row.first : row.last + 1]
            assert np.all(np.hypot(inside[:, 0] - row.x, inside[:, 1] - row.y) <= row.radius * (1.0 + 1e-12))
            chords = np.hypot(*np.diff(inside, axis=0).T)
            assert 2.0 * row.half == pytest.approx(chords.max())
            covered += len(chords)
        assert covered == len(points) - len(outlines.rings)
        assert int(stretches.begins.sum()) == sum(not hole for _, hole in outlines.rings)


def test_the_longest_moves_are_those_of_numpy() -> None:
    rows = np.random.default_rng(1).normal(size=(500, 7))
    ways, found = np.full(3, np.inf), np.zeros(3, np.int64)
    longest_moves(rows, 100, 400, np.array([1, 3, 6]), ways, found)
    expected = np.abs(np.diff(rows[100:401, [1, 3, 6]], axis=0))
    assert found.tolist() == (100 + expected.argmax(axis=0)).tolist()
    assert ways.tolist() == expected.max(axis=0).tolist()


@pytest.mark.parametrize("share", [0.99, 1.01])
@pytest.mark.parametrize("length", [0.01, 0.5, 3.0])
@pytest.mark.parametrize("way", [0.0, 0.7, 1.6, 4.0])
def test_chords_come_near_however_short_they_are(share: float, length: float, way: float) -> None:
    """Two chords side by side, one after another or in between, circles around them no larger than they: by true distances."""
    margin, half = 1.0, 0.5 * length
    turn = np.exp(1j * way)
    one = np.array([-half, half]) * np.exp(0.4j)
    normal = (1j * turn) if way < 3.0 else turn
    apart = shapely.LineString([(z.real, z.imag) for z in one])
    far = 4.0 * (length + margin)
    low, high = 0.0, far
    for _ in range(60):  # where the other one is as far as the margin
        middle = 0.5 * (low + high)
        there = [(z.real, z.imag) for z in one * turn + middle * normal]
        low, high = (low, middle) if apart.distance(shapely.LineString(there)) > share * margin else (middle, high)
    points = np.array([[z.real, z.imag] for z in (*one, *(np.array([-half, half]) * np.exp(0.4j)))])
    stretch = {"x": 0.0, "y": 0.0, "radius": half, "half": half, "begins": 1}
    stretches = [SimpleNamespace(first=0, last=1, **stretch), SimpleNamespace(first=2, last=3, **stretch)]
    pair = SimpleNamespace(still_x=0.0, still_y=0.0, still_radius=half, still_first=0, still_stop=1)
    x, y = float((low * normal).real), float((low * normal).imag)
    frame = (x, y, math.cos(way), math.sin(way))
    near = in_python(overlap_sieve._comes_near)(stretches[1], pair, stretches, points, frame, margin, np.zeros((2, 2)))
    assert bool(near) == (share < 1.0)
