"""Are the boxes round lines and arcs as tight as dense samples say?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.geometry.loops import Loop, edge_extents, extents, table_of, total_length
from watchsim.geometry.primitives import Arc, Edge, Line

SAMPLES = 4001  # odd: the middle of an arc is one of them


def made_up(seed: int) -> list[Edge]:
    """Lines, arcs of any sweep either way, and short ones whose middle lies on an axis."""
    rng = np.random.default_rng(seed)
    edges: list[Edge] = [Line(*rng.uniform(-1.0, 1.0, 4)) for _ in range(5)]
    edges += [Arc(*rng.uniform(-1.0, 1.0, 2), 0.5, rng.uniform(-7.0, 7.0), rng.uniform(-6.0, 6.0)) for _ in range(30)]
    for quarter in range(-5, 6):
        half = rng.choice([-1.0, 1.0]) * 2e-4
        edges.append(Arc(*rng.uniform(-1.0, 1.0, 2), 0.5, quarter * math.pi / 2 - half, 2.0 * half))
    return edges


def sampled(edge: Edge) -> tuple[float, float, float, float]:
    share = np.linspace(0.0, 1.0, SAMPLES)
    if isinstance(edge, Arc):
        angle = edge.start_angle + share * edge.sweep
        x, y = edge.x + edge.radius * np.cos(angle), edge.y + edge.radius * np.sin(angle)
    else:
        x, y = edge.x0 + share * (edge.x1 - edge.x0), edge.y0 + share * (edge.y1 - edge.y0)
    return x.min(), y.min(), x.max(), y.max()


@pytest.mark.parametrize("seed", range(4))
def test_boxes_against_samples(seed: int) -> None:
    """Between two samples an arc rises by its step squared over eight, at most 3e-7 of the radius."""
    edges = made_up(seed)
    table = table_of(edges)
    for edge, row in zip(edges, table.box, strict=True):
        finest = 1e-12 if abs(getattr(edge, "sweep", 0.0)) < 1e-3 else 2e-7
        assert edge_extents(edge) == pytest.approx(sampled(edge), abs=finest)
        assert row == pytest.approx(sampled(edge), abs=finest)
    few, many = Loop(tuple(edges[:9])), Loop(tuple(edges))
    for loop in (few, many):
        boxes = np.array([sampled(edge) for edge in loop.edges])
        assert extents([loop]) == pytest.approx((*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0)), abs=2e-7)
    assert total_length([few, many]) == pytest.approx(
        sum(edge.length for edge in (*few.edges, *many.edges)), rel=1e-14, abs=0.0
    )


def test_lines_have_nothing_of_an_arc() -> None:
    table = table_of([Line(1.0, 2.0, 3.0, 5.0), Arc(1.0, 2.0, 3.0, 0.5, -1.5)])
    assert table.arc.tolist() == [False, True]
    rows = np.column_stack((table.centre, table.radius, table.start_angle, table.sweep))
    assert rows.tolist() == [[0.0] * 5, [1.0, 2.0, 3.0, 0.5, -1.5]]
    assert table.start[0].tolist() == [1.0, 2.0] and table.end[0].tolist() == [3.0, 5.0]


def test_nothing_has_no_box() -> None:
    assert extents([]) is None and extents([Loop(())]) is None and total_length([]) == 0.0
