"""Are all points where two edges meet found, and no pair of edges lost on the way?"""

from __future__ import annotations

import cmath
import math
import random

import numpy as np
import pytest
from every_time import few

from watchsim.geometry.loops import near_pairs, table_of
from watchsim.geometry.meetings import meetings
from watchsim.geometry.primitives import Arc, Edge, Line

REACH = 1e-9
SAMPLES = 4000


def random_edge(rng: random.Random, size: float) -> Edge:
    x, y = rng.uniform(-1, 1), rng.uniform(-1, 1)
    if rng.random() < 0.5:
        return Line(x, y, x + rng.uniform(-size, size), y + rng.uniform(-size, size))
    return Arc(x, y, rng.uniform(0.05, size), rng.uniform(-7, 7), rng.choice((-1, 1)) * rng.uniform(0.2, 6.2))


def places(edge: Edge, t: np.ndarray) -> np.ndarray:
    """Points of the edge as complex numbers."""
    if isinstance(edge, Line):
        return complex(edge.x0, edge.y0) + t * complex(edge.x1 - edge.x0, edge.y1 - edge.y0)
    return complex(edge.x, edge.y) + edge.radius * np.exp(1j * (edge.start_angle + t * edge.sweep))


def level(edge: Edge, z: np.ndarray) -> np.ndarray:
    """A function that vanishes on the line or circle of the edge."""
    if isinstance(edge, Line):
        a, b = complex(edge.x0, edge.y0), complex(edge.x1, edge.y1)
        return np.imag((z - a) * np.conj(b - a)) / abs(b - a)
    return np.abs(z - complex(edge.x, edge.y)) - edge.radius


def on(edge: Edge, z: complex) -> bool:
    """Does a point of the line or circle lie on the edge itself?"""
    if isinstance(edge, Line):
        a, b = complex(edge.x0, edge.y0), complex(edge.x1, edge.y1)
        return 0.0 < ((z - a) / (b - a)).real < 1.0
    turn = cmath.phase((z - complex(edge.x, edge.y)) * cmath.exp(-1j * edge.start_angle))
    return (turn if edge.sweep > 0 else -turn) % (2 * math.pi) < abs(edge.sweep)


def by_sampling(a: Edge, b: Edge) -> list[complex]:
    """Changes of sign along a, refined by bisection."""
    t = np.linspace(0.0, 1.0, SAMPLES)
    f = level(b, places(a, t))
    found = []
    for k in np.flatnonzero(f[:-1] * f[1:] < 0.0):
        low, high = t[k], t[k + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            same = level(b, places(a, np.array([middle])))[0] * f[k] > 0.0
            low, high = (middle, high) if same else (low, middle)
        z = complex(places(a, np.array([low]))[0])
        found += [z] if on(b, z) else []
    return found


@pytest.mark.parametrize("seed", few(range(3), 1))
def test_points_are_those_of_sampling_and_no_pair_is_lost(seed: int) -> None:
    rng = random.Random(seed)
    edges = [random_edge(rng, rng.choice((0.1, 0.5, 2.0))) for _ in range(80)]
    table = table_of(edges)
    near = near_pairs(table, REACH)
    found = meetings(table, near.first, near.second, REACH)
    points: dict[tuple[int, int], list[complex]] = {}
    for k, (x, y) in zip(found.pair.tolist(), found.point.tolist(), strict=True):
        points.setdefault((int(near.first[k]), int(near.second[k])), []).append(complex(x, y))
    total = 0
    for i, a in enumerate(edges):
        for j in range(i + 1, len(edges)):
            expected, got = by_sampling(a, edges[j]), points.get((i, j), [])
            total += len(expected)
            assert len(got) == len(expected), (i, j)
            assert all(min(abs(z - w) for w in got) < 1e-9 for z in expected)
    assert total > 50


def test_pairs_come_once_and_far_edges_not_at_all() -> None:
    edges: list[Edge] = [Line(float(k), 0.0, float(k + 1), 0.0) for k in range(3000)]
    near = near_pairs(table_of(edges), REACH)
    assert set(zip(near.first.tolist(), near.second.tolist(), strict=True)) >= {(k, k + 1) for k in range(2999)}
    assert len(near.first) == 2999 and not near.crowds
    assert not len(near_pairs(table_of(edges[:1]), REACH).first)


def test_edges_that_cannot_be_told_apart_are_reported() -> None:
    near = near_pairs(table_of([Line(0.0, 0.0, 1.0, 1.0)] * 500), REACH)
    assert near.crowds and len(near.first) < 500 * 40
