"""How far does one outline leave another? Every edge counts, of many edges some from all around."""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.drawing.chain_faults import MOST_TWINS as MOST
from watchsim.drawing.chain_faults import distance, finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line


def polygon(corners: np.ndarray) -> Loop:
    ends = np.roll(corners, -1, axis=0)
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners.tolist(), ends.tolist(), strict=True)))


def round_polygon(count: int) -> np.ndarray:
    angles = np.arange(count) * 2.0 * math.pi / count
    return np.column_stack((np.cos(angles), np.sin(angles)))


@pytest.mark.parametrize("corner", range(5))
def test_the_corner_that_was_moved_is_found_wherever_it_is(corner: int) -> None:
    """A corner moved outwards: it is the farthest point, and nearest is the corner where it was."""
    plain = round_polygon(5)
    moved = plain.copy()
    moved[corner] *= 1.001
    for pair in ((plain, moved), (moved, plain)):
        assert distance(*map(polygon, pair), 1.0) == pytest.approx(1e-3, rel=1e-9)
        assert distance(*map(polygon, pair), 0.9e-3) == math.inf


@pytest.mark.parametrize("count", [MOST, 5 * MOST])
def test_of_many_edges_those_of_a_shifted_outline_are_found(count: int) -> None:
    """Half of it lies elsewhere: some of the edges looked at are among these."""
    plain = round_polygon(count)
    moved = plain + np.where(plain[:, :1] < 0.0, 0.01, 0.0) * plain
    assert distance(polygon(plain), polygon(moved), 1.0) == pytest.approx(0.01, rel=0.02)


def test_the_finding_stands_on_the_outline() -> None:
    """In the middle of its first edge, in millimetres."""
    loop = polygon(np.array([[2e-3, 5e-3], [4e-3, 5e-3], [4e-3, 9e-3]]))
    found = finding(loop, 3e-9)
    assert (found.x_mm, found.y_mm) == pytest.approx((3.0, 5.0)) and "within 3 nm" in found.message
