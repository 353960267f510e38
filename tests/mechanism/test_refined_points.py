"""Are chords split where they are asked to be, and there alone, and is it said how far they are from their arcs?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.material_polygons import chord_points, placed, refined_points

HALF = Loop((Line(-1.0, 0.0, 0.0, -3.0), Line(0.0, -3.0, 1.0, 0.0), Arc(0.0, 0.0, 1.0, 0.0, math.pi)))
ENDS = Arc(3.0, 0.0, 0.5, -0.5 * math.pi, math.pi), Arc(0.0, 0.0, 0.5, 0.5 * math.pi, math.pi)
SLOT = Loop((Line(0.0, -0.5, 3.0, -0.5), ENDS[0], Line(3.0, 0.5, 0.0, 0.5), ENDS[1]))
ROUND = Loop((Arc(0.5, -0.5, 2.0, 0.3, -math.tau),), hole=True)
BOW = Loop((Arc(0.0, 0.0, 1.0, 0.2, 1.5), Line(*Arc(0.0, 0.0, 1.0, 0.2, 1.5).end, 3.0, 3.0)), closed=False)


def sagitta(loop: Loop, start: np.ndarray, end: np.ndarray) -> float:
    """How far a chord is from the arc that it belongs to, m; 0 of a line."""
    for edge in loop.edges:
        if isinstance(edge, Arc):
            away = [abs(math.dist(p, (edge.x, edge.y)) - edge.radius) for p in (start, end)]
            if max(away) < 1e-9:
                return edge.radius - math.dist(0.5 * (start + end), (edge.x, edge.y))
    return 0.0


@pytest.mark.parametrize("loop", [HALF, SLOT, ROUND, BOW], ids=["half", "slot", "round", "open"])
@pytest.mark.parametrize("seed", range(4))
def test_marked_chords_are_split(loop: Loop, seed: int) -> None:
    """None, one, some or all of them."""
    coarse, fine = 2e-2, 3e-4
    before = chord_points(loop, coarse)
    count = len(before) - 1
    near = np.random.default_rng(seed).random(count) < 0.5
    near = [np.zeros(count, bool), np.arange(count) == count - 1, near, np.ones(count, bool)][seed]
    points, worst = refined_points(loop, coarse, near, fine)
    at, deviations = 0, [0.0]
    for marked, (start, end) in zip(near, pairwise(before), strict=True):
        assert points[at] == pytest.approx(start, abs=1e-12)
        stretch = [points[at]]
        while not np.allclose(points[at], end, atol=1e-9):
            at += 1
            stretch.append(points[at])
        split = marked and sagitta(loop, start, end) > fine
        assert (len(stretch) > 2) is bool(split)
        if marked:
            deviations += [sagitta(loop, a, b) for a, b in pairwise(stretch)]
    assert at == len(points) - 1
    assert worst == pytest.approx(max(deviations), rel=1e-3) and worst <= fine


def test_points_that_others_keep_are_not_written_into() -> None:
    with pytest.raises(ValueError, match="read-only"):
        chord_points(HALF, 1e-2)[0, 0] = 9.0


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_points_of_a_body_that_stands_somewhere(angle: float) -> None:
    points = np.array([[1.0, 0.0], [0.0, 2.0], [-3.0, 0.5]])
    turned = (points[:, 0] + 1j * points[:, 1]) * np.exp(1j * angle) + 4.0 - 5.0j
    assert placed(points, (4.0, -5.0, angle)) == pytest.approx(np.column_stack((turned.real, turned.imag)), abs=1e-14)
