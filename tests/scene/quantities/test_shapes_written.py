"""What becomes of circles, polygons and lines that a scene writes, and of those with a mistake?"""

from __future__ import annotations

import math
from typing import Any

import pytest

from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY
from watchsim.scene.outlines import shape_loops
from watchsim.scene.values import Table

FIVE = [["0 mm", "0 mm"], ["5 mm", "1 mm"], ["6 mm", "4 mm"], ["3 mm", "7 mm"], ["-1 mm", "3 mm"]]


def shape(key: str, value: Any) -> tuple[tuple[Any, ...], list[str]]:
    table = Table({key: value}, "b", BODY, Faults())
    return shape_loops(table, key), [f"{fault.key}: {fault.message}" for fault in table.faults.found]


@pytest.mark.parametrize("order", [1, -1])
def test_a_polygon_runs_round_its_material(order: int) -> None:
    (loop,), said = shape("polygon", FIVE[::order])
    corners = [(1e-3 * float(x[:-3]), 1e-3 * float(y[:-3])) for x, y in FIVE]
    assert not said and loop.layer == "polygon" and loop.closed and not loop.hole
    found = [edge.start for edge in loop.edges]
    at = next(k for k, place in enumerate(found) if math.dist(place, corners[0]) < 1e-15)
    assert [abs(complex(*a) - complex(*b)) < 1e-15 for a, b in zip(found[at:] + found[:at], corners, strict=True)] == [True] * 5
    assert all(isinstance(edge, Line) and edge.end == loop.edges[(k + 1) % 5].start for k, edge in enumerate(loop.edges))


def test_circles_and_lines() -> None:
    (ring,), said = shape("circle", "2.5 mm")
    assert not said and ring.layer == "circle" and isinstance(ring.edges[0], Arc) and ring.edges[0].is_circle
    assert (ring.edges[0].x, ring.edges[0].y, ring.edges[0].radius, ring.edges[0].start_angle) == (0.0, 0.0, 2.5e-3, 0.0)
    (line,), said = shape("line", FIVE[1:3])
    assert not said and not line.closed and line.layer == "line"
    assert (line.edges[0].start, line.edges[0].end) == (pytest.approx((5e-3, 1e-3)), pytest.approx((6e-3, 4e-3)))


@pytest.mark.parametrize("point", range(5))
@pytest.mark.parametrize("axis", [0, 1])
def test_one_value_that_cannot_be_read_is_one_fault(point: int, axis: int) -> None:
    """Wherever it stands: what sides with such an end cross is not asked."""
    bad = [list(one) for one in FIVE]
    bad[point][axis] = "5"
    found, said = shape("polygon", bad)
    assert found == () and len(said) == 1 and said[0].startswith(f"b.polygon.{point}.{axis}: ")
    double = [list(one) for one in FIVE]
    double[point], double[(point + 1) % 5] = ["3 mm", "3 mm"], ["3 mm", "3 mm"]
    double[(point + 3) % 5][axis] = "5 kg"
    assert len(shape("polygon", double)[1]) == 1


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("circle", "0 mm", "b.circle: must be above zero: it is the radius"),
        ("circle", "x", "b.circle: "),
        (
            "polygon",
            FIVE[:2],
            "b.polygon: a list of at least 3 points is needed here: "
            'polygon = [["0 mm", "0 mm"], ["5 mm", "0 mm"], ["0 mm", "5 mm"]]',
        ),
        ("line", FIVE[:1], 'b.line: a list of at least 2 points is needed here: line = [["0 mm", "0 mm"], ["5 mm", "0 mm"]]'),
        ("line", FIVE[:3], "b.line: a line has two points; more make a polygon"),
        ("line", [FIVE[1], FIVE[1]], "b.line: its two points are the same"),
        ("line", "5 mm", "b.line: a list of at least 2 points"),
        ("polygon", [FIVE[0], FIVE[1], FIVE[0]], "b.polygon: a point occurs twice in it"),
        ("polygon", [FIVE[0], FIVE[1], ["10 mm", "2 mm"]], "b.polygon: it encloses no area"),
        ("polygon", [FIVE[0], FIVE[1], FIVE[4], FIVE[2]], "b.polygon: its sides 1 and 3 (counted from 0) cross each other"),
        ("polygon", [FIVE[0], ["1 mm"], FIVE[1]], "b.polygon.1: two values are needed here"),
    ],
)
def test_a_mistake_is_one_fault_and_no_outline(key: str, value: Any, words: str) -> None:
    found, said = shape(key, value)
    assert found == () and len(said) == 1 and said[0].startswith(words)
    assert said[0].endswith("]]") is ("at least" in words)
