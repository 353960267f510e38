"""Does the sieve leave to the polygons what shapely finds, at the instants that matter?"""

import dataclasses
import itertools
import math
from typing import Any

import numpy as np
import pytest
import shapely
from moving_scenes import box, circle
from scipy.interpolate import BPoly

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.overlap import corner_depth
from watchsim.scene.forces import Side
from watchsim.simulation.overlap_sieve import MOST_STEPS, STRIDE, instants_within
from watchsim.simulation.overlap_watch import Layers, Outlines, PairOfLayers
from watchsim.simulation.trajectory import place_between

# Does the sieve get the outlines of all layers, one of each pair shrunk, and do the polygons judge what it leaves?

MM, DEPTH, CHORD = 1e-3, 4e-6, 1e-6
PLATE, BLOCK = (box(6 * MM, 4 * MM),), (box(2 * MM, 1 * MM),)
HOLED = (box(6 * MM, 4 * MM), dataclasses.replace(box(3 * MM, 2 * MM).reversed(), hole=True))
FACE = (Loop((Line(2 * MM, 0.0, -2 * MM, 0.0),), closed=False),)
DISC = (circle(0.7 * MM),)


def pair(number: int, one: str, other: str, first: Any, second: Any) -> PairOfLayers:
    return PairOfLayers(number, (Side(one), Side(other)), (first, second), CHORD)


def test_the_side_with_more_points_stays_and_may_be_held_by_the_other() -> None:
    """A square has five points, a disc many; a ring can be held by what reaches as far as it."""
    for swapped in (False, True):
        loops, bodies = ((PLATE, DISC), ("a", "b")) if not swapped else ((DISC, PLATE), ("b", "a"))
        made = pair(3, bodies[0], bodies[1], *loops)
        assert made.bodies == ("b", "a") and made.still.points > made.mover.points == 5 and made.contact == 3
        assert made.swallows and not made.has_faces
    assert pair(0, "a", "b", BLOCK, BLOCK).bodies == ("a", "b")
    big = (circle(9 * MM),)
    assert not pair(0, "a", "b", big, BLOCK).swallows and pair(0, "a", "b", FACE, BLOCK).has_faces


def placed(loops: tuple[Loop, ...], pose: np.ndarray) -> Any:
    x, y, angle = pose
    parts = [loop.moved(angle, (x, y)) for loop in loops]
    rings = [shapely.Polygon([edge.start for edge in loop.edges]) for loop in parts]
    return rings[0].difference(shapely.union_all(rings[1:])) if len(rings) > 1 else rings[0]


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize(("one", "other"), [(PLATE, BLOCK), (HOLED, BLOCK), (BLOCK, HOLED), (PLATE, PLATE)])
def test_layers_overlap_where_shapely_says_so_and_as_deep(one: Any, other: Any, swapped: bool) -> None:
    """Blocks across edges, within, around, in holes; where the overlap is much more or much less than the depth."""
    rng = np.random.default_rng(4)
    sides = (one, other) if not swapped else (other, one)
    layers = Layers((pair(0, "a", "b", *sides),))
    where = np.concatenate([rng.normal(0.0, 1.5 * MM, (2, 30, 2)), rng.uniform(0.0, 6.0, (2, 30, 1))], axis=2)
    found = layers.overlapping(where, DEPTH)[0]
    truth = [placed(sides[0], where[0, i]).intersection(placed(sides[1], where[1, i])) for i in range(30)]
    for i, common in enumerate(truth):
        if common.area > (30 * DEPTH) ** 2 or common.is_empty:
            assert found[i] == (not common.is_empty)
        if found[i]:
            depth, (x, y) = layers.pairs[0].deepest([where[0, i], where[1, i]])
            assert depth > DEPTH and common.buffer(0.01 * MM).intersects(shapely.Point(x, y))
    assert 0 < found.sum() < 30 or one is PLATE is other


def test_a_corner_of_a_face_is_as_deep_as_its_way_to_the_border() -> None:
    """The deepest of several; below zero where none lies in it or the material came round an end."""
    plate = shapely.box(0.0, 0.0, 4.0, 3.0)
    face = np.array([[-1.0, 1.0], [0.5, 1.5], [2.0, 1.25], [5.0, 2.0]])
    assert corner_depth(face, plate) == (1.25, (2.0, 1.25))
    assert corner_depth(face[:3], plate) == corner_depth(face[1:], plate) == (-1.0, (0.0, 0.0))
    assert corner_depth(face[[1, 0, 2, 3]], plate) == corner_depth(face[[0, 2, 3, 1]], plate) == (-1.0, (0.0, 0.0))
    depth, _ = corner_depth(np.array([[-1.0, 1.0], [-0.5, 1.0], [-1.0, 2.0]]), plate)
    assert depth == -1.0


# Which moves between rows are looked at, and at which instants within them? Against brute force and scipy's polynomials.


def rows(count: int, n: int, seed: int) -> np.ndarray:
    """Rows (t, q, u, a) of n coordinates; now and then two at one instant."""
    rng = np.random.default_rng(seed)
    found = rng.normal(size=(count, 1 + 3 * n))
    found[:, 0] = np.cumsum(rng.random(count) * (rng.random(count) < 0.9))
    return found


@pytest.mark.parametrize("seed", range(3))
def test_within_a_move_there_are_evenly_spaced_instants_by_its_length(seed: int) -> None:
    """One in each tenth of the scene's size or begun one, at most so many; none at the ends. Places are quintics."""
    rng = np.random.default_rng(seed)
    scale = np.array([0.5, 2.0])
    before, after = rows(6, 2, seed), rows(6, 2, seed + 9)
    after[:, 0] = before[:, 0] + rng.uniform(0.1, 0.4, 6)
    ways = (0.0, 0.09, 0.11, -0.55, 0.61, 5.0)
    for k, way in enumerate(ways):
        after[k, 1:3] = before[k, 1:3] + scale * (np.array([way, 0.3 * way]) if k % 2 else np.array([-0.2 * way, way]))
    made = instants_within(before, after, scale, stepped=False)
    steps = [1, 1, 2, 6, 7, MOST_STEPS]
    assert made.ends.tolist() == [0, *np.cumsum(steps)] and len(made.times) == len(made.q) == sum(steps)
    for k, count in enumerate(steps):
        for j in range(count):
            place, share = made.ends[k] + j, (j + 1) / (count + 1)
            assert made.times[place] == pytest.approx(before[k, 0] + share * (after[k, 0] - before[k, 0]), rel=1e-14)
            for i in range(2):
                ends = [[row[k, 1 + i], row[k, 3 + i], row[k, 5 + i]] for row in (before, after)]
                quintic = BPoly.from_derivatives([before[k, 0], after[k, 0]], ends)
                assert made.q[place, i] == pytest.approx(float(quintic(made.times[place])), abs=1e-12)


# Does the sieve leave to the polygons exactly what shapely finds within half the depth of the shrunk outline?

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


# Are the circles around a layer, its chords and its stretches what their words say, and do its rings shrink as asked?


def outlines(points: np.ndarray, hole: bool = False, closed: bool = True) -> Outlines:
    rings, faces = (((points, hole),), ()) if closed else ((), (points,))
    return Outlines(rings, faces, (0.0, 0.0), 1.0, 1.0)


def ring(seed: int, count: int = 9) -> np.ndarray:
    """A closed, star-shaped, counter-clockwise chain with corners either way, one of them flat."""
    rng = np.random.default_rng(seed)
    angle = (np.arange(count) + rng.uniform(0.2, 0.8, count)) * 2.0 * np.pi / count
    points = np.column_stack([np.cos(angle), np.sin(angle)]) * rng.uniform(0.8, 1.2, count)[:, None]
    points[4] = 0.5 * (points[3] + points[5])
    return np.concatenate([points, points[:1]])


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("depth", [1e-3, 0.02])
def test_a_ring_lies_that_far_inside_its_material_with_sharp_corners(seed: int, depth: float) -> None:
    points = ring(seed)
    ((shrunk, hole),) = outlines(points).shrunk_rings(depth)
    expected = shapely.Polygon(points).buffer(-depth, join_style="mitre", mitre_limit=100.0)
    assert not hole and len(shrunk) == len(points)
    assert shapely.Polygon(shrunk).symmetric_difference(expected).area < 1e-12


def test_a_hole_grows() -> None:
    points = ring(3)[::-1]
    ((grown, hole),) = outlines(points, hole=True).shrunk_rings(0.01)
    expected = shapely.Polygon(points).buffer(0.01, join_style="mitre", mitre_limit=100.0)
    assert hole and shapely.Polygon(grown).symmetric_difference(expected).area < 1e-12


def test_an_open_face_moves_to_its_left_and_keeps_its_ends_square() -> None:
    face = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [3.0, 1.0]])
    (moved,) = outlines(face, closed=False).shifted_faces(0.1)
    assert moved == pytest.approx(np.array([[0.0, 0.1], [0.9, 0.1], [0.9, 1.1], [3.0, 1.1]]))


# Do pairs of layers overlap where one would say so: open faces of several edges, several pairs, within moves?

DEPTH_PAIRS_OF_LAYERS = 1e-6


def chain(*points: tuple[float, float]) -> Loop:
    """An open face through these points (mm), its material on the left."""
    return Loop(tuple(Line(*(MM * x for x in (*a, *b))) for a, b in itertools.pairwise(points)), closed=False)


def at_pairs_of_layers(loop: Loop, x: float, y: float) -> Loop:
    return loop.moved(0.0, (x * MM, y * MM))


ROOF = (chain((2.0, 0.0), (0.0, 0.5), (-2.0, 0.0)),)  # material below
ARCH = (Loop((Arc(0.0, 0.0, MM, 0.2, math.pi - 0.4),), closed=False),)
SQUARE = box(2 * MM, 2 * MM)
WEDGE = (chain((-1.0, 1.0), (0.0, 0.0), (1.0, 1.0)),)  # material above
DISC_PAIRS_OF_LAYERS = circle(0.1 * MM)

CASES = [
    ("on the ridge", ROOF, (SQUARE,), (0.0, 1.5), 0.0),
    ("through the ridge", ROOF, (SQUARE,), (0.0, 1.4), 0.1),
    ("through a round ridge", ARCH, (SQUARE,), (0.0, 1.9), 0.1),
    (
        "one part through the ridge",
        ROOF,
        (at_pairs_of_layers(SQUARE, 0.0, 1.4), at_pairs_of_layers(DISC_PAIRS_OF_LAYERS, 2.0, 0.0)),
        (0.0, 0.0),
        0.1,
    ),
    ("within a slope", ROOF, (DISC_PAIRS_OF_LAYERS,), (1.0, 0.25), 0.09),
    ("clear of a slope", ROOF, (DISC_PAIRS_OF_LAYERS,), (1.0, 0.36), 0.0),
    ("round the right end", ROOF, (SQUARE,), (2.5, 0.2), 0.0),
    ("round the left end", ROOF, (SQUARE,), (-2.5, 0.2), 0.0),
    (
        "one part round the right end",
        ROOF,
        (at_pairs_of_layers(SQUARE, 2.5, 0.2), at_pairs_of_layers(DISC_PAIRS_OF_LAYERS, -1.0, 1.0)),
        (0.0, 0.0),
        0.0,
    ),
    (
        "another within a slope",
        ROOF,
        (at_pairs_of_layers(SQUARE, 2.5, 0.2), at_pairs_of_layers(DISC_PAIRS_OF_LAYERS, -1.0, 0.25)),
        (0.0, 0.0),
        0.09,
    ),
    (
        "another within, round the left end",
        ROOF,
        (at_pairs_of_layers(SQUARE, -2.5, 0.2), at_pairs_of_layers(DISC_PAIRS_OF_LAYERS, 1.0, 0.25)),
        (0.0, 0.0),
        0.09,
    ),
    ("tip on the ridge", ROOF, WEDGE, (0.0, 0.5), 0.0),
    ("tip through a slope", ROOF, WEDGE, (1.0, 0.15), 0.09),
    ("tip through the other slope", ROOF, WEDGE, (-1.0, 0.15), 0.09),
    ("one side across an end", ROOF, WEDGE, (2.3, -0.1), 0.0),
    ("far below", ROOF, WEDGE, (0.0, -3.0), 0.0),
]


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("turn", [0.0, 2.1])
@pytest.mark.parametrize(("first", "second", "place", "depth"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_open_faces_of_several_edges(first, second, place, depth: float, turn: float, swapped: bool) -> None:
    """Whichever side is named first, wherever the two stand together."""
    spin, origin = np.exp(1j * turn), complex(7 * MM, -3 * MM)
    there = MM * complex(*place) * spin + origin
    poses = [[(p.real, p.imag, turn)] for p in (origin, there)]
    sides, loops = (Side("a"), Side("b")), (first, second)
    if swapped:
        loops, poses = loops[::-1], poses[::-1]
    looked = Layers((PairOfLayers(0, sides, loops, DEPTH_PAIRS_OF_LAYERS / 8),))
    where = np.array(poses)
    assert looked.overlapping(where, DEPTH_PAIRS_OF_LAYERS).tolist() == [[depth > 0.0]]
    if depth:
        found, (x, y) = looked.pairs[0].deepest(where[:, 0])
        assert found >= 0.99 * depth * MM
        assert abs(complex(x, y) - there) < 2.5 * MM


@pytest.mark.parametrize("share", [0.8, 1.2])
def test_a_face_is_behind_another_by_more_than_the_depth(share: float) -> None:
    poses = np.array([[(0.0, 0.0, 0.0)], [(0.0, 0.5 * MM - share * DEPTH_PAIRS_OF_LAYERS, 0.0)]])
    for other in (WEDGE, (at_pairs_of_layers(SQUARE, 0.0, 1.0),)):
        looked = Layers((PairOfLayers(0, (Side("a"), Side("b")), (ROOF, other), DEPTH_PAIRS_OF_LAYERS / 8),))
        assert looked.overlapping(poses, DEPTH_PAIRS_OF_LAYERS).tolist() == [[share > 1.0]]


def test_several_pairs_are_looked_at_each_for_itself() -> None:
    """Bodies in any order; each has its own outlines, of unlike numbers of points."""
    shapes = {"d": (SQUARE,), "a": (circle(1 * MM),), "c": (box(4 * MM, 1 * MM),), "b": (DISC_PAIRS_OF_LAYERS,)}
    names = [("d", "a"), ("c", "b"), ("a", "c"), ("b", "d")]
    pairs = [
        PairOfLayers(k, (Side(p), Side(q)), (shapes[p], shapes[q]), DEPTH_PAIRS_OF_LAYERS / 8) for k, (p, q) in enumerate(names)
    ]
    looked, rng = Layers(tuple(pairs)), np.random.default_rng(5)
    assert looked.bodies == ["a", "b", "c", "d"]
    where = np.concatenate([rng.normal(0.0, 1.0 * MM, (4, 200, 2)), rng.uniform(-3.0, 3.0, (4, 200, 1))], axis=2)
    together = looked.overlapping(where, DEPTH_PAIRS_OF_LAYERS)
    for row, (p, q) in enumerate(names):
        first, second = sorted((p, q))
        own = Layers((PairOfLayers(0, (Side(p), Side(q)), (shapes[p], shapes[q]), DEPTH_PAIRS_OF_LAYERS / 8),))
        alone = own.overlapping(where[["abcd".index(first), "abcd".index(second)]], DEPTH_PAIRS_OF_LAYERS)
        assert np.array_equal(together[row], alone[0])
        assert 0 < alone.sum() < 200
    # Another depth is another question.
    less = looked.overlapping(where, 0.05 * MM)
    assert np.all(less <= together)
    assert 0 < less.sum() < together.sum() == looked.overlapping(where, DEPTH_PAIRS_OF_LAYERS).sum()


@pytest.mark.parametrize("seed", range(6))
def test_moves_are_looked_at_in_steps_of_a_tenth_of_the_size(seed: int) -> None:
    """At equal shares of each move's time, without its ends; seven at most, and one at least."""
    rng = np.random.default_rng(seed)
    scale, count = np.array([1.0, 0.02]), 25
    before = rng.normal(size=(count, 7))
    after = before + np.column_stack(
        [
            rng.uniform(0.1, 1.0, count),
            scale * rng.choice([0.01, 0.25, 0.9], (count, 1)) * rng.uniform(-1.0, 1.0, (count, 2)),
            np.zeros((count, 4)),
        ]
    )
    found = instants_within(before, after, scale, False)
    times, places, ends = [], [], [0]
    for one, other in zip(before, after, strict=True):
        longest = max(abs(other[1] - one[1]) / 1.0, abs(other[2] - one[2]) / 0.02)
        steps = next(n for n in range(1, 99) if n >= longest / STRIDE or n == MOST_STEPS)
        h = other[0] - one[0]
        for k in range(1, steps + 1):
            s = np.array([[k / (steps + 1)]])
            times.append(one[0] + k / (steps + 1) * h)
            rows = [tuple(row[None, i : i + 2] for i in (1, 3, 5)) for row in (one, other)]
            places.append(place_between(s, np.array([[h]]), *rows)[0])
        ends.append(ends[-1] + steps)
    assert found.times == pytest.approx(np.array(times))
    assert found.q == pytest.approx(np.array(places))
    assert found.ends.tolist() == ends
    assert {1, MOST_STEPS} < set(np.diff(ends).tolist()) and MOST_STEPS == 7


def test_where_time_is_stepped_only_the_rows_are_looked_at() -> None:
    before, after = np.arange(14.0).reshape(2, 7), 0.5 + np.arange(14.0).reshape(2, 7)
    found = instants_within(before, after, np.ones(2), True)
    assert found.times.tolist() == after[:, 0].tolist() and found.q.tolist() == after[:, 1:3].tolist()
    assert found.ends.tolist() == [0, 1, 2]
    nothing = instants_within(before[:0], after[:0], np.ones(2), False)
    assert len(nothing.times) == len(nothing.q) == 0 and nothing.ends.tolist() == [0]
