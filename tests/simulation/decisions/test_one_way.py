"""Which faces are immovable, and where do bodies move past each other in one direction only?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.events.immovable import has_one_way, is_immovable

IMMOVABLE = 1e-12  # sine² of the angle
MASS = np.array([2.0, 0.3, 1.1, 0.7])
COORDINATES = [2, 0]  # of the two directions' parts


def asked(kernel, *more, w_N, w_T, reduced=0.0) -> bool:
    model = SimpleNamespace(coordinates=list(MASS), contacts=[None, SimpleNamespace(reduced=reduced)])
    closed = SimpleNamespace(slots=[len(w_N)], coord=np.array([COORDINATES]), w_N=np.array([w_N]), w_T=np.array([w_T]), ids=[1])
    return bool(in_python(kernel, inverse_mass=lambda mass: 1.0 / mass)(model, closed, 0, *more))


def sine_squared(first, second) -> float:
    """Of the angle between two directions, in the metric of the inverse masses."""
    root = np.sqrt(MASS[COORDINATES])
    a, b = np.asarray(first) / root, np.asarray(second) / root
    return 1.0 - (a @ b) ** 2 / ((a @ a) * (b @ b))


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_a_normal_force_with_next_to_no_lever_arm_moves_nothing(share: float) -> None:
    across = np.sqrt(IMMOVABLE * share)
    tangential = np.array([0.3, -0.8])
    normal = across * np.array([0.8, 0.3]) * np.sqrt((tangential**2 / MASS[COORDINATES]).sum())
    normal /= np.sqrt((np.array([0.8, 0.3]) ** 2 / MASS[COORDINATES]).sum())
    assert asked(is_immovable, w_N=normal, w_T=tangential) == (share < 1.0)


@pytest.mark.parametrize("depth", [0.0, 1e-5])
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_two_directions_are_one_where_the_angle_between_them_is_small(depth: float, share: float) -> None:
    """Of two forces of like effect: sin² against four times the bound, for (a + b)² = 4 a b."""
    radius = 0.02
    bound = 4.0 * (IMMOVABLE + 2.0 * depth / radius)
    root = np.sqrt(MASS[COORDINATES])
    angle = np.arcsin(np.sqrt(share * bound))
    normal, tangential = (root * np.array([np.cos(turn), np.sin(turn)]) for turn in (0.7, 0.7 + angle))
    assert sine_squared(normal, tangential) == pytest.approx(share * bound, rel=1e-3, abs=0.0)
    assert asked(has_one_way, depth, w_N=normal, w_T=tangential, reduced=-radius) == (share < 1.0)


def test_depth_means_nothing_between_flat_faces() -> None:
    assert not asked(has_one_way, 1.0, w_N=[1.0, 0.1], w_T=[1.0, 0.0], reduced=0.0)


def test_a_free_pair_of_directions_is_no_single_way() -> None:
    assert not asked(has_one_way, 0.0, w_N=[1.0, 0.5], w_T=[-0.5, 1.0])


@pytest.mark.parametrize("length", [1e-3, 1.0, 1e3])
def test_how_far_either_force_reaches_does_not_matter(length: float) -> None:
    """Parallel directions are one, others two, though one has a thousand times the lever arms of the other."""
    assert asked(has_one_way, 0.0, w_N=[1.0, 0.5], w_T=[-2.0 * length, -length])
    assert not asked(has_one_way, 0.0, w_N=[1.0, 0.5], w_T=[-0.5 * length, length])
