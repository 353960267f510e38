"""Do pairs of layers overlap where one would say so: open faces of several edges, several pairs, within moves?"""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest
from moving_scenes import box, circle

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.record.overlap_instants import Layers, PairOfLayers, declared_pairs
from watchsim.simulation.record.trajectory import place_between
from watchsim.simulation.record.watched_instants import MOST_STEPS, STRIDE, instants_within

MM, DEPTH = 1e-3, 1e-6


def chain(*points: tuple[float, float]) -> Loop:
    """An open face through these points (mm), its material on the left."""
    return Loop(tuple(Line(*(MM * x for x in (*a, *b))) for a, b in itertools.pairwise(points)), closed=False)


def at(loop: Loop, x: float, y: float) -> Loop:
    return loop.moved(0.0, (x * MM, y * MM))


ROOF = (chain((2.0, 0.0), (0.0, 0.5), (-2.0, 0.0)),)  # material below
ARCH = (Loop((Arc(0.0, 0.0, MM, 0.2, math.pi - 0.4),), closed=False),)
SQUARE = box(2 * MM, 2 * MM)
WEDGE = (chain((-1.0, 1.0), (0.0, 0.0), (1.0, 1.0)),)  # material above
DISC = circle(0.1 * MM)

CASES = [
    ("on the ridge", ROOF, (SQUARE,), (0.0, 1.5), 0.0),
    ("through the ridge", ROOF, (SQUARE,), (0.0, 1.4), 0.1),
    ("through a round ridge", ARCH, (SQUARE,), (0.0, 1.9), 0.1),
    ("one part through the ridge", ROOF, (at(SQUARE, 0.0, 1.4), at(DISC, 2.0, 0.0)), (0.0, 0.0), 0.1),
    ("within a slope", ROOF, (DISC,), (1.0, 0.25), 0.09),
    ("clear of a slope", ROOF, (DISC,), (1.0, 0.36), 0.0),
    ("round the right end", ROOF, (SQUARE,), (2.5, 0.2), 0.0),
    ("round the left end", ROOF, (SQUARE,), (-2.5, 0.2), 0.0),
    ("one part round the right end", ROOF, (at(SQUARE, 2.5, 0.2), at(DISC, -1.0, 1.0)), (0.0, 0.0), 0.0),
    ("another within a slope", ROOF, (at(SQUARE, 2.5, 0.2), at(DISC, -1.0, 0.25)), (0.0, 0.0), 0.09),
    ("another within, round the left end", ROOF, (at(SQUARE, -2.5, 0.2), at(DISC, 1.0, 0.25)), (0.0, 0.0), 0.09),
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
    looked = Layers((PairOfLayers(0, sides, loops, DEPTH / 8),))
    where = np.array(poses)
    assert looked.overlapping(where, DEPTH).tolist() == [[depth > 0.0]]
    if depth:
        found, (x, y) = looked.pairs[0].deepest(where[:, 0])
        assert found >= 0.99 * depth * MM
        assert abs(complex(x, y) - there) < 2.5 * MM


@pytest.mark.parametrize("share", [0.8, 1.2])
def test_a_face_is_behind_another_by_more_than_the_depth(share: float) -> None:
    poses = np.array([[(0.0, 0.0, 0.0)], [(0.0, 0.5 * MM - share * DEPTH, 0.0)]])
    for other in (WEDGE, (at(SQUARE, 0.0, 1.0),)):
        looked = Layers((PairOfLayers(0, (Side("a"), Side("b")), (ROOF, other), DEPTH / 8),))
        assert looked.overlapping(poses, DEPTH).tolist() == [[share > 1.0]]


def test_several_pairs_are_looked_at_each_for_itself() -> None:
    """Bodies in any order; each has its own outlines, of unlike numbers of points."""
    shapes = {"d": (SQUARE,), "a": (circle(1 * MM),), "c": (box(4 * MM, 1 * MM),), "b": (DISC,)}
    names = [("d", "a"), ("c", "b"), ("a", "c"), ("b", "d")]
    pairs = [PairOfLayers(k, (Side(p), Side(q)), (shapes[p], shapes[q]), DEPTH / 8) for k, (p, q) in enumerate(names)]
    looked, rng = Layers(tuple(pairs)), np.random.default_rng(5)
    assert looked.bodies == ["a", "b", "c", "d"]
    where = np.concatenate([rng.normal(0.0, 1.0 * MM, (4, 200, 2)), rng.uniform(-3.0, 3.0, (4, 200, 1))], axis=2)
    together = looked.overlapping(where, DEPTH)
    for row, (p, q) in enumerate(names):
        first, second = sorted((p, q))
        own = Layers((PairOfLayers(0, (Side(p), Side(q)), (shapes[p], shapes[q]), DEPTH / 8),))
        alone = own.overlapping(where[["abcd".index(first), "abcd".index(second)]], DEPTH)
        assert np.array_equal(together[row], alone[0])
        assert 0 < alone.sum() < 200
    # Another depth is another question.
    less = looked.overlapping(where, 0.05 * MM)
    assert np.all(less <= together)
    assert 0 < less.sum() < together.sum() == looked.overlapping(where, DEPTH).sum()


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


def test_a_scene_is_drawn_once_for_each_closeness_of_chords() -> None:
    """Bodies that cannot meet are left out; contacts keep their numbers; layers are told apart."""
    ring = dataclasses.replace(circle(3 * MM), layer="RING")
    bodies = (
        Body("a", "fixed", loops=(ring, SQUARE)),
        Body("b", "pivot", inertia=1.0, loops=(DISC,)),
        Body("c", "pivot", inertia=1.0),
    )
    contacts = Contact((Side("b"), Side("c"))), Contact((Side("a", "RING"), Side("b"))), Contact((Side("a"), Side("b")))
    scene = Scene("drawn", bodies, contacts=contacts)
    coarse = declared_pairs(scene, 1e-5)
    assert declared_pairs(scene, 1e-5) is coarse
    assert [pair.contact for pair in coarse.pairs] == [1, 2]
    assert [len(pair.still.rings) for pair in coarse.pairs] == [1, 2]
    fine = declared_pairs(scene, 1e-7)
    assert fine.pairs[0].still.points > 5 * coarse.pairs[0].still.points
    other = dataclasses.replace(scene, contacts=contacts[1:])
    assert [pair.contact for pair in declared_pairs(other, 1e-7).pairs] == [0, 1]
