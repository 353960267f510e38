"""Is the symmetry of an outline found where there is one, and only there?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from watchsim.candidates.broad_phase import _largest
from watchsim.candidates.chords import chords
from watchsim.candidates.symmetry import _mismatch, turn_symmetry
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, moved
from watchsim.mechanism.contact_features import features
from watchsim.model.records import Records

TOLERANCE = 1e-6


def wheel(teeth: int, spokes: int = 0, shift: float = 0.0, spoilt: float = 0.0) -> Records:
    """Primitives of saw teeth with a rounded root and of round spoke holes; `spoilt` lengthens one tooth."""
    edges: list[Edge] = []
    for k in range(teeth):
        tip = 1.0 + (spoilt if k == 3 else 0.0)
        angle = 2.0 * math.pi * k / teeth + shift
        c, s = math.cos(2.0 * math.pi / teeth), math.sin(2.0 * math.pi / teeth)
        end = (0.8 * c, 0.8 * s)
        edges += [moved(Line(0.8, 0.0, tip, 0.05), angle, (0.0, 0.0)), moved(Line(tip, 0.05, *end), angle, (0.0, 0.0))]
    holes = [
        Arc(0.4 * math.cos(a), 0.4 * math.sin(a), 0.1, 0.0, -2.0 * math.pi) for a in np.arange(spokes) * 2.0 * math.pi / spokes
    ]
    loops = [Loop(tuple(edges)), *(Loop((hole,), hole=True) for hole in holes)]
    return np.concatenate([features(loop, 0, 1.0) for loop in loops]).view(np.recarray)


def points(rows: Records, at: np.ndarray) -> np.ndarray:
    """Where the reference points of some primitives are: middles, or centres of full circles."""
    x, y = np.where(rows.extent > 0, rows.x, rows.px), np.where(rows.extent > 0, rows.y, rows.py)
    return (x + 1j * y)[at]


@pytest.mark.parametrize("teeth", [2, 15, 20, 97])
@pytest.mark.parametrize("shift", [0.0, 0.1, math.pi])
def test_every_primitive_lies_on_its_image(teeth: int, shift: float) -> None:
    rows = wheel(teeth, shift=shift)
    found = turn_symmetry(rows, TOLERANCE)
    assert found.fold == teeth and not found.loose.any()
    assert sorted(found.image) == list(range(len(rows)))
    every = np.arange(len(rows))
    assert np.abs(points(rows, every) * np.exp(2j * math.pi / teeth) - points(rows, found.image)).max() < 1e-12
    assert np.array_equal(rows.kind, rows.kind[found.image])


def test_spokes_that_do_not_fit_the_teeth_are_loose() -> None:
    rows = wheel(15, spokes=4)
    found = turn_symmetry(rows, TOLERANCE)
    assert found.fold == 15
    assert np.array_equal(found.loose, rows.extent > 0)


def test_spokes_that_fit_share_the_smaller_symmetry_or_are_loose() -> None:
    rows = wheel(15, spokes=5)
    found = turn_symmetry(rows, TOLERANCE)
    assert found.fold == 15 and np.count_nonzero(found.loose) == 5


@pytest.mark.parametrize(("spoilt", "fold"), [(1e-9, 15), (1e-3, 1)])
def test_a_spoilt_tooth_ends_the_symmetry_unless_it_is_rounding(spoilt: float, fold: int) -> None:
    found = turn_symmetry(wheel(15, spoilt=spoilt), TOLERANCE)
    assert found.fold == fold


def test_no_primitives_have_no_symmetry() -> None:
    assert turn_symmetry(wheel(5)[:0], TOLERANCE).fold == 1


@pytest.mark.parametrize("change", [3e-5, -3e-5])
def test_holes_of_unlike_radii_miss_by_twice_the_difference(change: float) -> None:
    """Both the one that is larger and the one whose image is."""
    rows = wheel(4, spokes=4)
    holes = np.flatnonzero(rows.extent > 0)
    image = np.arange(len(rows))
    image[holes] = np.roll(holes, -1)
    drawn = chords(rows, math.inf)
    ends = drawn.points[drawn.first[:-1]], drawn.points[drawn.first[1:] - 1]
    before = _mismatch(rows, ends, image, math.pi / 2.0)[holes]
    rows.radius[holes[1]] += change
    more = _mismatch(rows, ends, image, math.pi / 2.0)[holes] - before
    assert more == pytest.approx([2.0 * abs(change), 2.0 * abs(change), 0.0, 0.0], abs=1e-12)


def test_largest_of_each_group() -> None:
    values = np.random.default_rng(2).normal(size=(3, 11))
    first = np.array([0, 1, 4, 9, 11])
    naive = [[max(row[a:b]) for a, b in pairwise(first)] for row in values.tolist()]
    assert _largest(values, first).tolist() == naive
