"""Which of several symmetries of an outline counts, what is alike, and how far may a turned primitive be from its image?"""

from __future__ import annotations

import cmath
import math
from itertools import pairwise

import numpy as np
import pytest
from test_cell_travel import curve

from watchsim.candidates.chords import chords
from watchsim.candidates.symmetry import _classes, _divisors, _mismatch, _split, turn_symmetry
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.mechanism.contact_features import features
from watchsim.model.records import ARC, CORNER, FULL, LINE, Records

TOLERANCE = 1e-6


def joined(*parts: Records) -> Records:
    return np.concatenate(parts).view(np.recarray)


def hole(centre: complex, radius: float = 0.05) -> Records:
    return features(Loop((Arc(centre.real, centre.imag, radius, 0.0, -TURN),), hole=True), 0, 1.0)


def crown(count: int, away: float, radius: float = 0.05, turn: float = 0.0) -> Records:
    return joined(*(hole(cmath.rect(away, turn + TURN * k / count), radius) for k in range(count)))


@pytest.mark.parametrize(("single", "fold"), [(2, 2), (3, 2), (4, 1), (5, 1)])
def test_more_than_half_must_share_a_symmetry(single: int, fold: int) -> None:
    """Two pairs of holes opposite one another, and holes that have no partner."""
    alone = [hole(cmath.rect(2.0 + 0.3 * k, 1.0 + k)) for k in range(single)]
    found = turn_symmetry(joined(crown(2, 0.7), crown(2, 1.1, turn=0.4), *alone), TOLERANCE)
    assert found.fold == fold and np.count_nonzero(found.loose) == (single if fold == 2 else 0)


@pytest.mark.parametrize(("pairs", "fold", "loose"), [(0, 6, 0), (1, 6, 2), (2, 6, 4), (3, 2, 0), (4, 2, 0)])
def test_the_symmetry_that_saves_most_counts(pairs: int, fold: int, loose: int) -> None:
    """Of six holes five are saved by their own symmetry; by that of the pairs three, and one of each pair."""
    others = [crown(2, 1.4 + 0.2 * k, turn=0.3 * k) for k in range(pairs)]
    found = turn_symmetry(joined(crown(6, 0.8), *others), TOLERANCE)
    assert (found.fold, np.count_nonzero(found.loose)) == (fold, loose)


def test_a_hole_in_the_middle_is_its_own_image() -> None:
    rows = joined(crown(5, 0.9), hole(0.0), crown(3, 0.4))
    found = turn_symmetry(rows, TOLERANCE)
    assert found.fold == 5 and found.loose.tolist() == [False] * 6 + [True] * 3
    assert found.image.tolist() == [1, 2, 3, 4, 0, 5, 6, 7, 8]


@pytest.mark.parametrize(("wrong", "fold"), [(0.8, 5), (1.2, 1)])
def test_the_misses_of_a_whole_turn_count(wrong: float, fold: int) -> None:
    """Five times the miss of one image: a hole is moved outwards."""
    rows = crown(5, 0.9)
    rows.x[0] += wrong * TOLERANCE / 5.0
    assert turn_symmetry(rows, TOLERANCE).fold == fold


def test_holes_are_counted_round_by_their_middles_and_arcs_by_their_own() -> None:
    """Holes that all hold the axis; arcs about the axis in any order."""
    assert turn_symmetry(crown(5, 0.2, radius=0.5), TOLERANCE).fold == 5
    arcs = [Arc(0.0, 0.0, 1.1, TURN * k / 5.0, 0.7) for k in (3, 1, 4, 0, 2)]
    found = turn_symmetry(joined(*(features(Loop((arc,), closed=False), 0, 1.0) for arc in arcs)), TOLERANCE)
    assert found.fold == 5 and not found.loose.any()


def test_divisors() -> None:
    assert [_divisors(n) for n in (1, 2, 12, 15, 17)] == [[], [2], [12, 6, 4, 3, 2], [15, 5, 3], [17]]


@pytest.mark.parametrize("seed", range(5))
def test_values_are_parted_where_a_gap_is_wider_than_the_tolerance(seed: int) -> None:
    """Neighbours in the order of values belong together, each only within its label."""
    rng = np.random.default_rng(seed)
    label, value = rng.integers(0, 3, 30), np.cumsum(rng.choice([0.0, 0.9, 1.1, 5.0], 30))[rng.permutation(30)]
    got = _split(label, value, 1.0)
    for one in range(3):
        rows = sorted(np.flatnonzero(label == one), key=lambda i: value[i])
        alike = [got[a] == got[b] for a, b in pairwise(rows)]
        assert alike == [value[b] - value[a] <= 1.0 for a, b in pairwise(rows)]
    names = [{int(got[i]) for i in np.flatnonzero(label == one)} for one in range(3)]
    assert sum(map(len, names)) == len(set.union(*names))


def test_classes_are_of_one_kind_in_the_order_of_their_angles() -> None:
    """Holes of two sizes at one distance, of one size at two distances, and one in the middle."""
    rows = joined(crown(3, 0.9, turn=2.0), crown(2, 0.9, 0.07), crown(3, 0.8, turn=-1.0), hole(0.0))
    classes = sorted((members.tolist(), on_axis) for members, on_axis in _classes(rows, TOLERANCE))
    assert classes == [([1, 2, 0], False), ([3, 4], False), ([7, 5, 6], False), ([8], True)]


def made_up(rng: np.random.Generator) -> Records:
    """Lines, arcs that turn left and right, of every size, and full circles."""
    parts = [features(Loop((Line(*rng.normal(size=4)),), closed=False), 0, 1.0) for _ in range(3)]
    for _ in range(4):
        x, y, start = rng.normal(size=3)
        parts.append(features(Loop((Arc(x, y, rng.uniform(0.2, 0.9), start, rng.uniform(-6.0, 6.0)),), closed=False), 0, 1.0))
    return joined(*parts, hole(complex(*rng.normal(size=2)), 0.4), hole(complex(*rng.normal(size=2)), 0.3))


def shaken(rows: Records, angle: float, size: float, rng: np.random.Generator) -> Records:
    """The same turned, and then each moved, turned, stretched and bent a little."""
    out, way = rows.copy(), np.exp(1j * angle)
    for row in out:
        off, twist = size * complex(*rng.normal(size=2)), np.exp(1j * size * rng.normal())
        for x, y in (("x", "y"), ("px", "py")):
            moved = complex(row[x], row[y]) * way + off
            row[x], row[y] = moved.real, moved.imag
        for x, y in (("nx", "ny"), ("tx", "ty")):
            turned = complex(row[x], row[y]) * way * twist
            row[x], row[y] = turned.real, turned.imag
        if row.kind == LINE:
            row.length *= 1.0 + size * rng.normal()
        if row.kind == ARC:
            row.radius += 0.1 * size * rng.normal()
            middle = complex(row.x, row.y) + row.side * row.radius * complex(row.nx, row.ny)
            row.px, row.py = middle.real, middle.imag
        if row.kind == ARC and row.extent == 0:
            half = math.atan2(row.half_sin, row.half_cos) * (1.0 + 0.1 * size * rng.normal())
            row.half_cos, row.half_sin = math.cos(half), math.sin(half)
    return out


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("size", [1e-3, 0.1])
def test_no_point_of_a_turned_primitive_is_farther_from_its_image_than_is_told(seed: int, size: float) -> None:
    """Points at the same share of both; and no more is told than four times the farthest of what is not bent."""
    rng = np.random.default_rng(seed)
    angle = 2.0 * math.pi / 3.0
    rows = made_up(rng)
    rows = joined(rows, shaken(rows, angle, size, rng))
    count = len(rows) // 2
    drawn = chords(rows, math.inf)
    ends = drawn.points[drawn.first[:-1]], drawn.points[drawn.first[1:] - 1]
    image = np.concatenate([np.arange(count, 2 * count), np.arange(count)])
    told = _mismatch(rows, ends, image, angle)[:count]
    for i in range(count):
        one, other = rows[i], rows[i + count]
        if one.extent == FULL:  # whichever points of the two are opposite each other
            apart = abs(complex(one.x, one.y) * np.exp(1j * angle) - complex(other.x, other.y))
            assert told[i] == pytest.approx(apart + 2.0 * abs(one.radius - other.radius), rel=1e-12, abs=0.0)
            continue
        apart = np.abs(curve(one) * np.exp(1j * angle) - curve(other)).max()
        assert apart <= told[i] + 1e-14
        assert one.kind == ARC or told[i] < 4.0 * apart


def test_of_corners_the_normals_count_too() -> None:
    """As an angle times the scene's size: the middle of the fan and half its width."""
    edges = (Line(-1.0, 1.5, 0.3, 0.2), Line(0.3, 0.2, 1.2, 1.1))
    rows = features(Loop(edges, closed=False), 0, 1.0)
    corner = rows[rows.kind == CORNER][:1].view(np.recarray)
    both = joined(corner, corner)
    middle = math.atan2(both.ny[0], both.nx[0])
    half = math.atan2(both.half_sin[0], both.half_cos[0])
    both.length[:] = 0.7
    both.nx[1], both.ny[1] = math.cos(middle + 0.5), math.sin(middle + 0.5)
    both.half_cos[1], both.half_sin[1] = math.cos(half - 0.2), math.sin(half - 0.2)
    place = complex(both.px[0], both.py[0]) * np.exp(0.4j)
    both.px[1], both.py[1] = both.x[1], both.y[1] = place.real, place.imag
    drawn = chords(both, math.inf)
    ends = drawn.points[drawn.first[:-1]], drawn.points[drawn.first[1:] - 1]
    assert len(drawn.points) == 2
    told = _mismatch(both, ends, np.array([1, 0]), 0.4)
    assert told[0] == pytest.approx(0.7 * (2.0 * math.sin(0.05) + 0.2), rel=1e-12, abs=0.0)
    back = 0.7 * (2.0 * math.sin(0.45) + 0.2) + 3.0 * abs(place) * 2.0 * math.sin(0.4)
    assert told[1] == pytest.approx(back, rel=1e-12)
