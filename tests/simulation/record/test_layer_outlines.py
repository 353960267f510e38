"""Are the circles around a layer, its chords and its stretches what their words say, and do its rings shrink as asked?"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
import shapely
from moving_scenes import box, circle

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.simulation.record.layer_outlines import CHORDS, Outlines, outlines_of, stretches_of

DEVIATION = 1e-4


def at(loop: Loop, x: float, y: float, hole: bool = False) -> Loop:
    return dataclasses.replace(loop.moved(0.0, (x, y)).reversed() if hole else loop.moved(0.0, (x, y)), hole=hole)


FACE = Loop((Line(-5.0, 1.0, -5.0, 4.0), Line(-5.0, 4.0, -1.0, 4.0)), closed=False)
PLATE = (at(box(6.0, 2.0), 1.0, 2.0), at(circle(0.5), 2.0, 2.0, hole=True), at(circle(0.3), 9.0, -1.0), FACE)


def test_rings_holes_and_faces_are_told_apart() -> None:
    found = outlines_of(PLATE, DEVIATION)
    assert [hole for _, hole in found.rings] == [False, True, False]
    assert len(found.faces) == 1 and found.faces[0].tolist() == [[-5.0, 1.0], [-5.0, 4.0], [-1.0, 4.0]]
    assert found.points == sum(len(points) for points, _ in found.rings)
    areas = [shapely.Polygon(points).area for points, _ in found.rings]
    assert areas == pytest.approx([12.0, math.pi * 0.25, math.pi * 0.09], rel=1e-3)


def test_one_circle_is_around_everything_and_one_around_the_smallest_outer_ring() -> None:
    """About the middle of their boxes: from -5 to 9.3 and from -1.3 to 4; of the small disc."""
    found = outlines_of(PLATE, DEVIATION)
    assert found.centre == pytest.approx((2.15, 1.35), abs=DEVIATION)
    corners = [(-5.0, 1.0), (-5.0, 4.0), (-1.0, 4.0), (4.0, 1.0), (4.0, 3.0), (-2.0, 1.0), (-2.0, 3.0)]
    disc = math.dist((2.15, 1.35), (9.0, -1.0)) + 0.3
    assert found.radius == pytest.approx(max(disc, *(math.dist((2.15, 1.35), corner) for corner in corners)), abs=2e-3)
    assert found.smallest == pytest.approx(0.3, abs=1e-3)
    assert outlines_of(PLATE[:1], DEVIATION).smallest == outlines_of(PLATE[:1], DEVIATION).radius == math.hypot(3.0, 1.0)


def test_without_outer_rings_or_without_anything_there_is_no_smallest_one() -> None:
    assert outlines_of((FACE, PLATE[1]), DEVIATION).smallest == math.inf
    nothing = outlines_of((), DEVIATION)
    assert (nothing.rings, nothing.faces, nothing.radius, nothing.smallest) == ((), (), -math.inf, math.inf)
    assert len(stretches_of(nothing, 0.0)[0]) == 0


def zigzag(count: int) -> np.ndarray:
    """A ring of two chords three wide, and so many short ones."""
    x = np.linspace(3.0, 0.0, count + 1)
    top = np.column_stack([x, 1.0 + 0.02 * (np.arange(count + 1) % 2)])
    return np.concatenate([[[0.0, 0.0], [3.0, 0.0]], top, [[0.0, 0.0]]])


@pytest.mark.parametrize("depth", [0.0, 0.004])
def test_stretches_follow_each_other_along_their_ring(depth: float) -> None:
    """Of no more chords than is said, none longer than a quarter of the size; each ends where the next begins."""
    rings = ((zigzag(150), False), (0.3 * zigzag(4)[::-1] + (0.5, 0.3), True))
    outlines = Outlines(rings, (), (1.5, 0.5), 1.6, 1.6)
    stretches, points = stretches_of(outlines, depth)
    wanted = outlines.shrunk_rings(depth) if depth else rings
    begins = [i for i in range(len(stretches)) if i == 0 or stretches.first[i] != stretches.last[i - 1]]
    assert len(begins) == len(rings)
    assert stretches.begins.tolist() == [int(i == 0) for i in range(len(stretches))]
    for (ring, _), first, stop in zip(wanted, begins, [*begins[1:], len(stretches)], strict=True):
        whole = points[stretches.first[first] : stretches.last[stop - 1] + 1]
        assert whole[0] == pytest.approx(ring[0]) and whole[-1] == pytest.approx(ring[-1])
        assert shapely.LineString(whole).length == pytest.approx(shapely.LineString(ring).length)
        assert shapely.hausdorff_distance(shapely.LineString(whole), shapely.LineString(ring)) < 1e-12
        assert np.hypot(*(whole[:, None] - ring).T).min(axis=1).max() < 1e-12
    lengths = []
    for row in stretches:
        inside = points[row.first : row.last + 1]
        chords = np.hypot(*np.diff(inside, axis=0).T)
        lengths.append(float(chords.sum()))
        assert 1 <= len(chords) <= CHORDS == 32
        assert chords.max() <= 0.25 * 1.6 * (1.0 + 1e-12)
        assert chords.sum() <= 0.25 * 1.6 + chords.max()
        low, high = inside.min(axis=0), inside.max(axis=0)
        assert (row.x, row.y) == pytest.approx(tuple(0.5 * (low + high)))
        assert row.radius == pytest.approx(0.5 * math.dist(low, high))
        assert row.half == pytest.approx(0.5 * chords.max())
    # No more of them than that takes.
    assert max(lengths) > 0.25 * 1.6 * 0.9
    assert len(stretches) <= sum(lengths) / (0.25 * 1.6) * 1.5 + 6


def test_long_chords_are_divided_into_equal_parts_as_few_as_will_do() -> None:
    outlines = Outlines(((np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.2], [0.0, 0.0]]), False),), (), (0.5, 0.0), 0.9, 0.9)
    points = stretches_of(outlines, 0.0)[1]  # chords of 1, 0.2 and 1.02, none longer than 0.225
    assert np.hypot(*np.diff(points, axis=0).T) == pytest.approx([0.2] * 5 + [0.2] + [math.hypot(1.0, 0.2) / 5] * 5)


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


def test_where_an_outline_turns_back_its_corner_stays_near() -> None:
    """It would lie nowhere: a hundred depths away at most."""
    face = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1e-9]])
    (moved,) = outlines(face, closed=False).shifted_faces(1e-3)
    assert np.isfinite(moved).all() and np.abs(moved[1] - face[1]).max() <= 0.1
