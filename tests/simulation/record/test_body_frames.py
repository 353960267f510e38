"""Do frames stand where the manual of the scene file puts them, and move as their places change?"""

from __future__ import annotations

import numpy as np
import pytest
from carried_scenes import ARRANGEMENTS, carried_scene, places
from pair_scenes import outline

from watchsim.geometry.loop import Loop
from watchsim.simulation.record.body_frames import frames, speeds

STEP = 1e-5


def block(_: str) -> tuple[Loop, ...]:
    return (outline(0.35),)


@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=str)
def test_carried_bodies(arrangement: tuple[str, str, bool]) -> None:
    scene, compiled = carried_scene(*arrangement, block, (0.25, 0.1))
    rng, n = np.random.default_rng(3), len(compiled.q)
    q, u = rng.uniform(-2.0, 2.0, (4, n)), rng.uniform(-1.0, 1.0, (4, n))
    told, rates = compiled.relative(q), compiled.relative(u, rates=True)
    here = frames(scene, compiled.slices, told)
    for row, one in enumerate(q):
        for name, place in places(scene, compiled, one).items():
            assert here[name][row] == pytest.approx(place, abs=1e-14)
    before, after = (frames(scene, compiled.slices, told + way * STEP * rates) for way in (-1.0, 1.0))
    for name, speed in speeds(scene, compiled.slices, told, rates).items():
        assert speed == pytest.approx((after[name] - before[name]) / (2.0 * STEP), abs=1e-8)
