"""Do entities in nested, turned, mirrored, squashed and tilted blocks come out where the definitions put them?"""

from __future__ import annotations

import random
from collections.abc import Callable

import numpy as np
import pytest
from every_time import few
from random_dxf import drawing

from watchsim.drawing.drawing import Drawing
from watchsim.geometry.loops import extents

FIT = 2e-9


@pytest.mark.parametrize("seed", few(range(40), lambda seed: seed % 4 == 1))
def test_length_and_extents_are_those_of_the_points_drawn(read_bytes: Callable[..., Drawing], seed: int) -> None:
    data, rows = drawing(random.Random(seed))
    found = read_bytes(data, fit=FIT)
    plane = [1e-3 * row[:, :2] for row in rows]
    everywhere = np.concatenate(plane)
    low, high = everywhere.min(axis=0), everywhere.max(axis=0)
    size = float(np.max(high - low))
    length = sum(float(np.hypot(*np.diff(row, axis=0).T).sum()) for row in plane)
    assert found.drawn.length == pytest.approx(length, rel=1e-5)
    box = extents((*found.loops, *found.open_chains))
    assert box == pytest.approx((*low, *high), abs=1e-5 * size)
    assert not {"damaged", "fit", "block-missing"} & {finding.code for finding in found.findings}
