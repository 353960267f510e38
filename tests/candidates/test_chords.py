"""Do chords lie as near to their primitives as they say, with no more pieces than that takes?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from pair_scenes import two_bodies

from watchsim.candidates.chords import chords
from watchsim.model.records import ARC, CORNER, FULL, LINE

ROWS = two_bodies("fixed", "free")[1].model.primitives
MOST = 30


@pytest.mark.parametrize("sag", [1.0, 1e-2, 1e-3, 1e-4, 1e-7])
def test_points_lie_on_the_primitives_and_chords_near_them(sag: float) -> None:
    """Each rise against Pythagoras: R - √(R² - (c / 2)²); one piece fewer would rise by more than was asked."""
    made = chords(ROWS, sag, MOST)
    assert made.owner.tolist() == sorted(made.owner.tolist()) and set(made.owner.tolist()) == set(range(len(ROWS)))
    for i, row in enumerate(ROWS):
        points = made.points[made.owner == i]
        if row.kind != ARC:
            ends = (
                [(row.x, row.y)] if row.kind == CORNER else [(row.x + s * row.tx, row.y + s * row.ty) for s in (0, row.length)]
            )
            assert points == pytest.approx(np.array(ends), abs=1e-15) and made.sag[i] == 0.0
            continue
        pieces, half = len(points) - 1, math.pi if row.extent == FULL else math.atan2(row.half_sin, row.half_cos)
        assert np.hypot(*(points - (row.x, row.y)).T) == pytest.approx(row.radius, rel=1e-14)
        middle = math.atan2(row.side * row.ny, row.side * row.nx)
        angles = np.arctan2(*(points - (row.x, row.y)).T[::-1]) - middle
        assert np.cos(angles) == pytest.approx(np.cos(half * np.linspace(-1.0, 1.0, pieces + 1)), abs=1e-13)
        width = math.dist(*points[:2])
        rise = row.radius - math.sqrt(row.radius**2 - 0.25 * width**2) if half < pieces * math.pi / 2 else None
        assert rise is None or made.sag[i] == pytest.approx(rise, rel=1e-6, abs=1e-14)
        assert made.sag[i] <= sag * (1.0 + 1e-12) or pieces == MOST
        assert pieces == 1 or 2.0 * row.radius * math.sin(0.5 * half / (pieces - 1)) ** 2 > sag
    assert {CORNER, LINE, ARC} <= set(np.asarray(ROWS.kind).tolist())
