"""Is the part of a chain between two positions the right one, also across the start of a closed outline?"""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.drawing.nodes import Track
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line, Point

CORNERS: tuple[Point, ...] = ((0.0, 0.0), (4e-3, 0.0), (4e-3, 3e-3), (1e-3, 3e-3), (0.0, 1e-3))
LOOP = Loop(tuple(Line(*a, *b) for a, b in zip(CORNERS, (*CORNERS[1:], CORNERS[0]), strict=True)))
WHOLE = sum(edge.length for edge in LOOP.edges)


def touched(low: float, high: float) -> set[int]:
    """The edges that a walk from `low` to `high` in a thousand small steps comes past."""
    found, ends = set(), [sum(edge.length for edge in LOOP.edges[:k]) for k in range(len(LOOP.edges) + 1)]
    for step in range(1001):
        s = (low + (high - low) * step / 1000) % WHOLE
        found |= {k for k in range(len(LOOP.edges)) if ends[k] + 1e-6 < s < ends[k + 1] - 1e-6}
    return found


@given(st.floats(-3.0, 3.0), st.floats(0.01, 0.9))
def test_the_edges_between_two_positions_are_those_of_a_walk(turns: float, share: float) -> None:
    low = turns * WHOLE
    near = Track(LOOP)._between(low, low + share * WHOLE)
    assert touched(low, low + share * WHOLE) <= set(near) <= set(range(len(LOOP.edges)))
    assert len(near) <= len(touched(low, low + share * WHOLE)) + 2  # what it just touches at both ends


@pytest.mark.parametrize("turns", [-2, -1, 0, 1, 2])
def test_a_side_is_the_same_a_turn_earlier_or_later(turns: int) -> None:
    track, middle = Track(LOOP), 2e-3
    for p, side in (((2e-3, 1e-4), 1.0), ((2e-3, -1e-4), -1.0)):
        low = middle + turns * track.length
        gap, found = track.side(p, low - 1e-3, low + 1e-3)
        assert found == side
        assert math.isclose(gap, 1e-4, rel_tol=1e-9)
