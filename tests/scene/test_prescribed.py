"""Does a prescribed path pass its points, from rest to rest, and a swing begin where it should?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import PPoly

from watchsim.scene.scene import path, swing

PATHS = [
    ((0.0, 0.3), (2.0, -1.0)),
    ((0.0, 0.0), (1.0, 2.0), (1.5, 2.0)),
    ((0.0, 1.0), (0.1, 1.5), (0.4, -2.0), (1.0, 0.0), (1.7, 0.5)),
    ((1.0, 5.0), (3.0, 5.0)),
]


@pytest.mark.parametrize("points", PATHS, ids=len)
def test_a_path_passes_its_points_and_ends_at_rest(points: tuple[tuple[float, float], ...]) -> None:
    """By scipy's integrals of the piecewise linear acceleration."""
    times, places = np.array(points).T
    knots, a = np.array(path(points).table).T
    bend = PPoly(np.array([np.diff(a) / np.diff(knots), a[:-1]]), knots)
    speed = bend.antiderivative()
    assert a[0] == a[-1] == 0.0 and len(knots) == len(points) + 2
    assert speed(times[-1]) == pytest.approx(0.0, abs=1e-12)
    assert places[0] + speed.antiderivative()(times) == pytest.approx(places, abs=1e-12)


def test_knots_divide_the_first_and_the_last_stretch() -> None:
    assert [t for t, _ in path(PATHS[0]).table] == pytest.approx([0.0, 2.0 / 3.0, 4.0 / 3.0, 2.0])
    assert [t for t, _ in path(PATHS[1]).table] == pytest.approx([0.0, 0.5, 1.0, 1.25, 1.5])


@pytest.mark.parametrize("phase", [0.0, 0.7, -2.0])
def test_a_swing(phase: float) -> None:
    law, start, speed = swing(0.2, 1.5, 3.0, phase)
    w = 2.0 * math.pi * 3.0
    assert (law.square, law.middle, law.table) == (pytest.approx(w * w), 0.2, ())
    assert start == pytest.approx(0.2 + 1.5 * math.sin(phase)) and speed == pytest.approx(1.5 * w * math.cos(phase))
