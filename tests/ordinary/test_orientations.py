"""Does a mechanism move the same way however it lies in the plane and however its parts are drawn?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from mechanisms import MECHANISMS, mechanism
from orientations import apart, posed, random_pose, seen

SLOW = ("gears, two arcs a flank", "Swiss lever")


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow if name in SLOW else ()) for name in MECHANISMS])
def test_the_motion_does_not_depend_on_the_orientation(name: str) -> None:
    scene, rng = mechanism(name), np.random.default_rng(3)
    truth = seen(scene, 0.0, (0.0,) * len(scene.bodies))
    assert not truth.bad
    quarters = [(0.5 * math.pi * k, (0.0,) * len(scene.bodies)) for k in (1, 2)]
    for pose in [*quarters, *(random_pose(scene, rng) for _ in range(2))]:
        found = seen(scene, *pose)
        assert not found.bad
        assert apart(truth, found) < 1e-9, pose


def test_posing_moves_no_point_of_the_mechanism() -> None:
    """A point of each outline, placed by hand, before and after."""
    scene = mechanism("ratchet")
    world, drawn = 1.1, (0.7, -2.0)
    for body, moved in zip(scene.bodies, posed(scene, world, drawn).bodies, strict=True):
        before = complex(*body.position) + complex(*body.loops[0].edges[0].start) * np.exp(1j * body.angle)
        after = complex(*moved.position) + complex(*moved.loops[0].edges[0].start) * np.exp(1j * moved.angle)
        assert abs(after - before * np.exp(1j * world)) < 1e-15
