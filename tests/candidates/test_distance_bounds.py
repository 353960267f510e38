"""Do bounds of the distance from an axis hold for the true curves, of which only coarse chords are looked at?"""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.candidates.asymmetric_contacts import _range
from watchsim.candidates.chords import chords
from watchsim.candidates.reachable_pairs import _away
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.contact_features import features
from watchsim.model.records import Records


def made_up(seed: int) -> Records:
    """Arcs of either sense and lines, here and there about the origin."""
    rng = np.random.default_rng(seed)
    edges = [
        Arc(*rng.uniform(-1.0, 1.0, 2), rng.uniform(0.2, 1.0), rng.uniform(-3.0, 3.0), rng.uniform(-6.0, 6.0)) for _ in range(9)
    ]
    edges += [Line(*rng.uniform(-1.0, 1.0, 4)) for _ in range(4)]
    return np.concatenate([features(Loop((edge,), closed=False), 0, 1.0) for edge in edges]).view(np.recarray)


def dense(points: np.ndarray) -> np.ndarray:
    """Of a line, which has but two points, many between them."""
    return np.linspace(points[0], points[1], 4001) if len(points) == 2 else points


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("sag", [0.2, 0.02])
def test_the_true_distances_lie_between_the_bounds(seed: int, sag: float) -> None:
    rows = made_up(seed)
    fine, coarse = chords(rows, 1e-9, 4000), chords(rows, sag)
    true = [np.hypot(*dense(points).T) for points in np.split(fine.points, fine.first[1:-1])]
    low, high = np.array([one.min() for one in true]), np.array([one.max() for one in true])
    span = _away(coarse, coarse.points, 0.0)
    bounds = _range(np.hypot(*coarse.points.T), coarse.points, coarse.first, coarse.sag)
    for lower, upper in (tuple(span), bounds):
        assert np.all(lower <= low + 1e-12) and np.all(high <= upper + 1e-12) and np.all(lower >= 0.0)
    assert np.all(span[1] - high <= 2.0 * coarse.sag + 1e-12) and np.all(low - span[0] <= 2.0 * coarse.sag + 1e-6)
    wider = _away(coarse, coarse.points, 0.05)
    assert wider[1] - span[1] == pytest.approx(0.05) and wider[0] == pytest.approx(np.maximum(0.0, span[0] - 0.05), abs=0.05)


@pytest.mark.parametrize("room", [0.0, 1e-5])
def test_what_passes_through_the_axis_comes_as_near_as_nothing(room: float) -> None:
    """Lines a metre long and a micrometre short through or past the origin, up to what they are widened by."""
    lines = [Line(-0.3, -0.4, 0.6, 0.8), Line(-3e-7, 0.0, 7e-7, 0.0), Line(-1.0, 1e-5, 1.0, 1e-5), Line(-1.0, 2e-5, 1.0, 2e-5)]
    rows = np.concatenate([features(Loop((line,), closed=False), 0, 1.0) for line in lines]).view(np.recarray)
    drawn = chords(rows, 1e-6)
    low = _away(drawn, drawn.points, room).low[rows.length > 0.0]
    assert low == pytest.approx([0.0, 0.0, 1e-5 - room, 2e-5 - room], abs=1e-16) and np.all(low >= 0.0)
