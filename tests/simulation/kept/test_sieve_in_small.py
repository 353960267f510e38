"""Is every step of the sieve right: chords, stretches, windings, whole pairs? Small shapes against shapely."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely
import shapely.affinity
from plain_kernels import in_python

from watchsim.model.records import records
from watchsim.simulation.record import overlap_sieve
from watchsim.simulation.record.overlap_sieve import PAIR, STRETCH

Ring = list[tuple[float, float]]
ELL: Ring = [(4.0, 0.5), (4.5, 2.0), (1.5, 1.5), (1.0, 5.0), (-0.5, 4.0), (0.0, 0.0)]
HOLE: Ring = [(0.2, 0.4), (0.1, 1.0), (0.7, 1.1), (0.9, 0.5)]  # runs the other way round
DART: Ring = [(0.6, -0.3), (0.5, 0.4), (0.0, 0.0)]
HOLED = shapely.Polygon(ELL, [HOLE])


def ask(name: str, *given: Any, **instead: Any) -> Any:
    return in_python(getattr(overlap_sieve, name), **instead)(*given)


def stretches_of(rings: list[tuple[Ring, bool]], chords: int) -> tuple[Any, np.ndarray]:
    """Rings, with a word for holes, in stretches of so many chords, each with a circle around it."""
    rows: list[tuple[float, float, float, float, int, int, int]] = []
    points: list[tuple[float, float]] = []
    for ring, hole in rings:
        closed = [*ring, ring[0]]
        for start in range(0, len(ring), chords):
            own = np.array(closed[start : start + chords + 1])
            centre = own.mean(axis=0)
            half = 0.5 * np.hypot(*np.diff(own, axis=0).T).max()
            first = len(points) + start
            rows.append(
                (*centre, np.hypot(*(own - centre).T).max(), half, first, first + len(own) - 1, int(start == 0 and not hole))
            )
        points += closed
    made = records(STRETCH, len(rows))
    for k, row in enumerate(rows):
        made[k] = row
    return made, np.array(points)


@pytest.mark.parametrize("seed", range(3))
def test_points_are_turned_and_moved_as_complex_numbers_are(seed: int) -> None:
    rng = np.random.default_rng(seed)
    (x, y, px, py), angle = rng.normal(size=4), rng.uniform(0.0, 6.0)
    c, s = math.cos(angle), math.sin(angle)
    turned = (x + 1j * y) * np.exp(1j * angle)
    assert ask("_turned", x, y, c, s) == pytest.approx((turned.real, turned.imag))
    moved = (px + 1j * py) * np.exp(1j * angle) + x + 1j * y
    assert ask("_moved", px, py, (x, y, c, s)) == pytest.approx((moved.real, moved.imag))
    for share, within in ((0.99, True), (1.01, False)):
        assert ask("_is_within", share * 3.0, -share * 4.0, 5.0) == within == ask("_is_within", -share * 4.0, share * 3.0, 5.0)


@pytest.mark.parametrize("seed", range(40))
def test_two_chords_cross_and_a_point_is_as_far_from_one_as_shapely_says(seed: int) -> None:
    a, b, p, q = 1e-3 * np.random.default_rng(seed).normal(size=(4, 2))
    one, other = shapely.LineString([a, b]), shapely.LineString([p, q])
    assert ask("_cross", a, b, p, q) == one.crosses(other)
    assert ask("_apart", p, a, b) == pytest.approx(one.distance(shapely.Point(p)), abs=1e-15)
    assert ask("_apart", p, a, a) == pytest.approx(math.dist(p, a), abs=1e-15)
    assert ask("_side", p, a, b) == pytest.approx(float(np.linalg.det([b - a, p - a])), abs=1e-18)


@pytest.mark.parametrize("seed", range(25))
def test_a_chord_comes_near_a_stretch_where_one_of_its_chords_is_nearer_than_the_margin(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(size=(9, 2)), axis=0)
    other = records(STRETCH, 1)[0]
    other.first, other.last = 2, 6
    a = rng.normal(0.0, 3.0, 2)
    for b in (a + rng.normal(size=2), a + rng.normal(0.0, 6.0, 2)):
        apart = shapely.LineString([a, b]).distance(shapely.LineString(points[2:7]))
        for margin in (0.98 * apart, 1.02 * apart, 0.1, 2.0):
            assert ask("_chord_comes_near", a, b, other, points, margin) == (apart < margin or apart == 0.0)
            assert ask("_chord_comes_near", b, a, other, points, margin) == (apart < margin or apart == 0.0)


@pytest.mark.parametrize("margin", [0.01, 0.3])
@pytest.mark.parametrize("kind", ["ahead", "beside", "aslant"])
def test_chords_whose_boxes_touch_are_compared(kind: str, margin: float) -> None:
    """A chord right, left, above or below another one, to either side of the margin."""
    points = np.array([[0.0, 0.0], [2.0, 0.0]]) if kind != "aslant" else np.array([[0.0, 0.0], [2.0, 0.5]])
    for turn in (1.0, 1j, -1.0, -1j):
        for share in (0.99, 1.01):
            start = {"ahead": 2.0 + share * margin, "beside": 1.0 + 1j * share * margin, "aslant": 2.0 + share * margin + 0.5j}[
                kind
            ]
            whole = np.array([*(points @ [1.0, 1j]), start, start + 1.0]) * turn
            p, q, a, b = ([z.real, z.imag] for z in whole)
            other = records(STRETCH, 1)[0]
            other.first, other.last = 0, 1
            assert ask("_chord_comes_near", a, b, other, np.array([p, q]), margin) == (share < 1.0)


@pytest.mark.parametrize("chords", [1, 2, 9])
def test_rings_go_round_what_lies_within_them(chords: int) -> None:
    """Points everywhere, also at the heights of corners; in a hole the rings go round twice, one each way."""
    stretches, points = stretches_of([(ELL, False), (HOLE, True), ([(x + 9.0, y) for x, y in DART], False)], chords)
    both = HOLED.union(shapely.Polygon([(x + 9.0, y) for x, y in DART]))
    grid = [
        (x, y)
        for x in np.arange(-1.07, 10.0, 0.41)
        for y in (-0.5, -0.2, 0.0, 0.4, 0.5, 0.77, 1.0, 1.5, 2.0, 3.3, 4.0, 4.6, 5.0, 6.0)
    ]
    for x, y in grid:
        if both.boundary.distance(shapely.Point(x, y)) > 1e-9:
            turns = ask("_winding", x, y, 0, len(stretches), stretches, points)
            assert turns == int(both.contains(shapely.Point(x, y)))
    part = ask("_winding", 9.3, 0.1, len(stretches) - math.ceil(3 / chords), len(stretches), stretches, points)
    assert part == 1 and ask("_winding", 9.3, 0.1, 0, len(stretches) - math.ceil(3 / chords), stretches, points) == 0
    backwards, there = stretches_of([(ELL[::-1], False)], chords)
    assert ask("_winding", 0.5, 2.0, 0, len(backwards), backwards, there) == -1


def pair_of(
    still: list[tuple[Ring, bool]], mover: list[tuple[Ring, bool]], chords: int, **more: int
) -> tuple[Any, Any, np.ndarray]:
    """A pair, its stretches and points."""
    pair = records(PAIR, 1)[0]
    parts = [stretches_of(rings, chords) for rings in (still, mover)]
    (one, here), (two, there) = parts
    two.first += len(here)
    two.last += len(here)
    pair.still_first, pair.still_stop, pair.mover_first, pair.mover_stop = 0, len(one), len(one), len(one) + len(two)
    for name, points in (("still", here), ("mover", there)):
        centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
        pair[f"{name}_x"], pair[f"{name}_y"] = centre
        pair[f"{name}_radius"] = np.hypot(*(points - centre).T).max()
    pair.still, pair.mover = 1, 0
    for name, value in more.items():
        pair[name] = value
    return pair, np.concatenate([one, two]).view(np.recarray), np.concatenate([here, there])


def brought(shape: Any, frame: tuple[float, float, float]) -> Any:
    x, y, angle = frame
    c, s = math.cos(angle), math.sin(angle)
    return shapely.affinity.affine_transform(shape, [c, -s, s, c, x, y])


def framed(x: float, y: float, angle: float) -> tuple[float, float, float, float]:
    return x, y, math.cos(angle), math.sin(angle)


@pytest.mark.parametrize("chords", [2, 9])
@pytest.mark.parametrize("seed", range(6))
def test_a_stretch_comes_near_where_shapely_says_so(seed: int, chords: int) -> None:
    rng = np.random.default_rng(seed)
    pair, stretches, points = pair_of([(ELL, False)], [(DART, False)], chords)
    room, outline = np.full((12, 2), 77.0), shapely.LinearRing(ELL)
    for _ in range(12):
        place = (*rng.uniform(-2.0, 5.0, 2), rng.uniform(0.0, 6.0))
        for m in range(pair.mover_first, pair.mover_stop):
            own = points[stretches[m].first : stretches[m].last + 1]
            apart = brought(shapely.LineString(own), place).distance(outline)
            for margin in (0.97 * apart, 1.03 * apart, 0.05):
                found = ask("_comes_near", stretches[m], pair, stretches, points, framed(*place), margin, room)
                assert found == (apart < margin or apart == 0.0)


@pytest.mark.parametrize("chords", [2, 9])
@pytest.mark.parametrize("seed", range(6))
def test_a_pair_is_left_where_outlines_come_near_or_one_lies_within(seed: int, chords: int) -> None:
    """The dart in the holed plate, and a plate that swallows the dart; margins that matter and some that do not."""
    rng = np.random.default_rng(seed)
    room, small = np.full((12, 2), 77.0), [(0.3 * x, 0.3 * y) for x, y in DART]
    holed = [(ELL, False), (HOLE, True)]
    for still, mover, swallows in ((holed, [(small, False)], 0), ([(small, False)], holed, 1), (holed, [(DART, False)], 0)):
        pair, stretches, points = pair_of(still, mover, chords, swallows=swallows)
        outside, inside = (shapely.Polygon(rings[0][0], [ring for ring, _ in rings[1:]]) for rings in (still, mover))
        seen = set()
        for _ in range(20):
            x, y, angle = (*rng.uniform(-1.5, 3.5, 2), rng.uniform(0.0, 6.0))
            if swallows:  # the dart in the frame of the plate
                z = -complex(x, y) * np.exp(1j * angle)
                x, y = z.real, z.imag
            there = brought(inside, (x, y, angle))
            apart = outside.boundary.distance(there.boundary)
            for margin in (0.02, 0.98 * apart, 1.02 * apart):
                if abs(apart - margin) > 1e-9:
                    wanted = apart < margin or outside.intersects(there)
                    assert ask("_is_left", pair, stretches, points, framed(x, y, angle), margin, room) == wanted
                    seen.add(wanted)
        assert seen == {True, False}


def test_open_faces_are_left_to_the_polygons_wherever_the_circles_meet() -> None:
    pair, stretches, points = pair_of([(ELL, False)], [(DART, False)], 3, open=1)
    reach = pair.still_radius + pair.mover_radius + 0.25
    for angle in (0.3, 2.0, 4.0):
        for turn in (0.0, 1.3):
            centre = complex(pair.still_x, pair.still_y) - complex(pair.mover_x, pair.mover_y) * np.exp(1j * turn)
            for share, left in ((0.999, True), (1.001, False)):
                place = centre + share * reach * np.exp(1j * angle)
                found = ask("_is_left", pair, stretches, points, framed(place.real, place.imag, turn), 0.25, None)
                assert found == left


def test_of_each_instant_the_mover_is_seen_from_the_other_body() -> None:
    """Where that has not changed since the instant before, nothing is looked at again."""
    asked: list[tuple[float, ...]] = []
    rng = np.random.default_rng(3)
    where = rng.normal(size=(3, 5, 3))
    where[:, 2] = where[:, 1]
    pairs = records(PAIR, 2)
    pairs.still, pairs.mover = [2, 0], [0, 1]
    left = np.zeros((2, 5), bool)

    def is_left(pair: Any, stretches: Any, points: Any, frame: tuple[float, ...], margin: float, room: Any) -> bool:
        asked.append((int(pair.still), *frame))
        return len(asked) % 2 == 0

    in_python(overlap_sieve.sieve, _is_left=is_left)(pairs, None, None, where, 0.5, None, left)
    assert left.tolist() == [[False, True, True, False, True], [False, True, True, False, True]]
    wanted = []
    for still, mover in ((2, 0), (0, 1)):
        for i in (0, 1, 3, 4):
            (sx, sy, sa), (mx, my, ma) = where[still, i], where[mover, i]
            z = complex(mx - sx, my - sy) * np.exp(-1j * sa)
            wanted.append((still, z.real, z.imag, math.cos(ma - sa), math.sin(ma - sa)))
    assert np.array(asked) == pytest.approx(np.array(wanted))
