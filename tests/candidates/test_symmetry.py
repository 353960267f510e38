"""Is the symmetry of an outline found where there is one, and only there?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.candidates.symmetry import turn_symmetry
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
