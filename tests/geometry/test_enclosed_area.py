"""Is the region that nested outlines enclose the material between them, whichever way they run?"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc
from watchsim.geometry.solids import pieces, region

RADII = (5e-3, 3e-3, 1e-3)


def circle(radius: float, way: float, hole: bool) -> Loop:
    return replace(Loop((Arc(1e-3, -2e-3, radius, 0.3, way * TURN),)), closed=True, hole=hole)


@pytest.mark.parametrize("way", [-1.0, 1.0])
@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_an_island_in_a_hole_is_material(way: float, order: tuple[int, ...]) -> None:
    loops = [circle(radius, way, k == 1) for k, radius in enumerate(RADII)]
    for scale in (None, 1e3):
        found = region([loops[k] for k in order], 1e-8, *([scale] if scale else []))
        exact = math.pi * (RADII[0] ** 2 - RADII[1] ** 2 + RADII[2] ** 2) * (scale or 1.0) ** 2
        assert found.area == pytest.approx(exact, rel=1e-4)
        assert [len(part.interiors) for part in sorted(pieces(found), key=lambda part: part.area)] == [0, 1]


def test_open_chains_enclose_nothing() -> None:
    assert region([replace(circle(1e-3, 1.0, False), closed=False), Loop(())], 1e-8).is_empty
    assert not list(pieces(region([], 1e-8)))
