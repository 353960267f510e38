"""Does the sieve get the outlines of all layers, one of each pair shrunk, and do the polygons judge what it leaves?"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
import shapely
from moving_scenes import box, circle

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.mechanism.overlap_depth import corner_depth
from watchsim.scene.force import Side
from watchsim.simulation.record import overlap_instants
from watchsim.simulation.record.overlap_instants import Layers, PairOfLayers, _inverse

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


def test_what_the_sieve_reads_is_all_layers_one_behind_the_other() -> None:
    """Of each pair the resting one shrunk by the depth, the other as it is."""
    layers = Layers((pair(0, "b", "a", PLATE, DISC), pair(1, "c", "b", HOLED, BLOCK), pair(2, "c", "a", FACE, BLOCK)))
    rows, stretches, points = layers._records(DEPTH)
    assert layers.bodies == ["a", "b", "c"]
    assert rows.still.tolist() == [0, 2, 0] and rows.mover.tolist() == [1, 1, 2]
    assert rows.swallows.tolist() == [1, 0, 1] and rows.open.tolist() == [0, 0, 1]
    ends = [0]
    for row, one in zip(rows, layers.pairs, strict=True):
        for name, outlines, depth in (("still", one.still, DEPTH), ("mover", one.mover, 0.0)):
            assert row[f"{name}_first"] == ends[-1]
            ends.append(int(row[f"{name}_stop"]))
            own = stretches[row[f"{name}_first"] : row[f"{name}_stop"]]
            drawn = [shapely.LineString(points[s.first : s.last + 1]) for s in own]
            wanted = [shapely.LineString(ring) for ring, _ in (outlines.shrunk_rings(depth) if depth else outlines.rings)]
            assert sum(line.length for line in drawn) == pytest.approx(sum(line.length for line in wanted))
            for line in drawn:
                assert shapely.MultiLineString(wanted).buffer(1e-12).contains(line)
            assert (row[f"{name}_x"], row[f"{name}_y"], row[f"{name}_radius"]) == (*outlines.centre, outlines.radius)
    assert ends[-1] == len(stretches) and stretches.last.max() == len(points) - 1


def test_the_sieve_is_asked_with_half_the_depth_and_only_what_it_leaves_is_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    layers = Layers((pair(0, "a", "b", PLATE, DISC), pair(1, "c", "b", HOLED, DISC)))
    where = np.random.default_rng(1).normal(size=(3, 5, 3))
    asked: list[Any] = []

    def sieve(
        rows: Any, stretches: Any, points: Any, places: np.ndarray, margin: float, room: np.ndarray, left: np.ndarray
    ) -> None:
        asked.append((places.tolist() == where.tolist(), margin, left.shape, len(room)))
        left[0, [1, 3]] = left[1, 4] = True

    def overlapping(self: PairOfLayers, still: np.ndarray, mover: np.ndarray, depth: float) -> np.ndarray:
        assert depth == DEPTH
        asked.append((self.contact, still[:, 0].tolist(), mover[:, 0].tolist()))
        return np.arange(len(still)) == 0

    monkeypatch.setattr(overlap_instants, "sieve", sieve)
    monkeypatch.setattr(PairOfLayers, "overlapping", overlapping)
    found = layers.overlapping(where, DEPTH)
    assert asked[0] == (True, 0.5 * DEPTH, (2, 5), 33)
    assert asked[1:] == [
        (0, where[1, [1, 3], 0].tolist(), where[0, [1, 3], 0].tolist()), (1, [where[1, 4, 0]], [where[2, 4, 0]])
    ]  # fmt: skip
    assert np.argwhere(found).tolist() == [[0, 1], [1, 4]]


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


@pytest.mark.parametrize("seed", range(3))
def test_the_first_frame_seen_from_the_second_is_the_inverse(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shift, twist = rng.normal(size=2) @ (1.0, 1j), np.exp(1j * rng.uniform(0.0, 6.0))
    back, turn = _inverse((np.array([shift]), np.array([twist])))
    for point in (0.3 + 0.7j, -1.0 + 0.2j):
        assert complex((back + turn * (twist * point + shift))[0]) == pytest.approx(point)


def test_a_corner_of_a_face_is_as_deep_as_its_way_to_the_border() -> None:
    """The deepest of several; below zero where none lies in it or the material came round an end."""
    plate = shapely.box(0.0, 0.0, 4.0, 3.0)
    face = np.array([[-1.0, 1.0], [0.5, 1.5], [2.0, 1.25], [5.0, 2.0]])
    assert corner_depth(face, plate) == (1.25, (2.0, 1.25))
    assert corner_depth(face[:3], plate) == corner_depth(face[1:], plate) == (-1.0, (0.0, 0.0))
    assert corner_depth(face[[1, 0, 2, 3]], plate) == corner_depth(face[[0, 2, 3, 1]], plate) == (-1.0, (0.0, 0.0))
    depth, _ = corner_depth(np.array([[-1.0, 1.0], [-0.5, 1.0], [-1.0, 2.0]]), plate)
    assert depth == -1.0
