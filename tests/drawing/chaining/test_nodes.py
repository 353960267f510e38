"""Does the grid find everything within reach?"""

from __future__ import annotations

import math
import random
from itertools import pairwise

import pytest

from watchsim.drawing.findings import Stroke
from watchsim.drawing.nodes import Grid, Nodes
from watchsim.geometry.primitives import Line


@pytest.mark.parametrize("reach", [1e-9, 1e-6, 3e-6])
def test_grid_finds_all_within_reach(reach: float) -> None:
    """Places with decimals of a nanometre, which often lie on borders of cells, far from the origin too."""
    rng = random.Random(1)
    for far in (0.0, 0.019, -0.3):
        places = [(far + round(rng.uniform(0, 12 * reach), 9), far + round(rng.uniform(0, 12 * reach), 9)) for _ in range(300)]
        grid = Grid(reach)
        for number, p in enumerate(places[::3]):
            grid.add(p, number)
        for p in places:
            near = {number for number, other in enumerate(places[::3]) if math.dist(p, other) <= 0.999 * reach}
            assert near <= set(grid.around(p))


@pytest.mark.parametrize("reach", [1e-9, 1e-6, 3e-6])
def test_grid_finds_what_lies_at_the_same_place(reach: float) -> None:
    rng = random.Random(2)
    for _ in range(5000):
        p = round(rng.uniform(-0.3, 0.3), 9), round(rng.uniform(-0.3, 0.3), 9)
        grid = Grid(reach)
        grid.add(p, 7)
        assert grid.around(p) == [7]


def test_a_join_names_the_strokes_whose_ends_it_joins() -> None:
    """Five lines in a row, the last two 2 µm apart."""
    corners = [(0.0, 0.0), (1e-3, 0.0), (2e-3, 1e-3), (3e-3, 0.0), (4e-3, 1e-3)]
    lines = [Line(*a, *b) for a, b in pairwise(corners)]
    lines.append(Line(4e-3, 1e-3 + 2e-6, 5e-3, 0.0))
    (join,) = Nodes([Stroke(line, "A", "LINE", k) for k, line in enumerate(lines)]).snap(5e-6, loose_only=False)
    assert sorted(join.strokes) == [3, 4]
    assert join.gap == pytest.approx(2e-6, rel=1e-6)
    assert join.at == pytest.approx((4e-3, 1e-3), abs=3e-6)


NM = 1e-9


def nodes_of(*lines: Line) -> Nodes:
    return Nodes([Stroke(line, "A", "LINE", k) for k, line in enumerate(lines)])


@pytest.mark.parametrize(("gap", "one"), [(0.9, True), (1.1, False), (2.5, False)])
def test_ends_are_one_node_up_to_a_nanometre(gap: float, one: bool) -> None:
    """Two lines that begin close to each other, in one cell of the grid, and end far apart."""
    nodes = nodes_of(Line(0.5 * NM, 0.5 * NM, -1e-3, 0.0), Line((0.5 + gap) * NM, 0.5 * NM, 1e-3, 0.0))
    assert (nodes.of(0)[0] == nodes.of(1)[0]) == one


@pytest.mark.parametrize(("x", "nearest"), [(0.9, 0), (1.4, 1)])
def test_an_end_goes_to_the_nearest_of_two_nodes(x: float, nearest: int) -> None:
    """Nodes at 0.4 and 1.8 nm, and an end between them, within a nanometre of both."""
    beginnings = [Line(u * NM, 0.5 * NM, way * 1e-3, 1e-3) for u, way in ((0.4, -1.0), (1.8, 1.0), (x, 2.0))]
    nodes = nodes_of(*beginnings)
    assert nodes.of(0)[0] != nodes.of(1)[0]
    assert nodes.of(2)[0] == nodes.of(nearest)[0]


@pytest.mark.parametrize("length", [0.2, 0.5, 0.9])
def test_an_edge_shorter_than_a_nanometre_keeps_its_two_ends(length: float) -> None:
    nodes = nodes_of(Line(0.5 * NM, 0.5 * NM, (0.5 + length) * NM, 0.5 * NM))
    assert nodes.of(0) == (0, 1)
