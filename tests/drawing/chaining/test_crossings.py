"""Is every crossing of outlines found with its place, and no touch taken for one?"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import dxf_text as d
import pytest

from watchsim.drawing.chain_faults import Meeting, crossings, stretches
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.drawing.nodes import Outline
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, moved

Reader = Callable[..., Drawing]
SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]


def of_code(drawing: Drawing, code: str) -> list[Finding]:
    return [finding for finding in drawing.findings if finding.code == code]


def places(findings: list[Finding]) -> list[tuple[float, float]]:
    return sorted((round(f.x_mm or 0.0, 6) + 0.0, round(f.y_mm or 0.0, 6) + 0.0) for f in findings)


def found_places(outlines: list[list[Edge]], closed: bool = True) -> list[tuple[float, float]]:
    named = [Outline(Loop(tuple(edges), "0", closed), ("edge",) * len(edges)) for edges in outlines]
    return places([finding for finding in crossings(named) if finding.code == "crossing"])


def polygon(*corners: tuple[float, float]) -> list[Edge]:
    return [
        Line(1e-3 * a[0], 1e-3 * a[1], 1e-3 * b[0], 1e-3 * b[1])
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]


def circle(x: float, y: float, r: float, start: float = 0.3) -> list[Edge]:
    return [Arc(1e-3 * x, 1e-3 * y, 1e-3 * r, start, TURN)]


def test_a_bow_tie_of_lines_is_an_error_that_names_both(read_bytes: Reader) -> None:
    corners = [(0, 0), (4, 4), (4, 0), (0, 4)]
    lines = [d.line(a, b, handle=f"A{k}") for k, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1], strict=True))]
    (finding,) = of_code(read_bytes(d.dxf("".join(lines))), "crossing")
    assert finding.severity == "error" and (finding.x_mm, finding.y_mm) == pytest.approx((2.0, 2.0), abs=1e-12)
    assert "crosses itself at (2, 2) mm" in finding.message and "LINE #A0 and LINE #A2" in finding.message


def test_a_figure_of_eight_through_a_corner_that_is_drawn_twice(read_bytes: Reader) -> None:
    crossing = [(0, 0), (2, 2), (4, 4), (4, 0), (2, 2), (0, 4)]
    touching = [(0, 0), (2, 2), (0, 4), (4, 4), (2, 2), (4, 0)]
    assert places(of_code(read_bytes(d.dxf(d.lwpolyline(crossing, True))), "crossing")) == [(2.0, 2.0)]
    assert not of_code(read_bytes(d.dxf(d.lwpolyline(touching, True))), "crossing")


def test_circles_cross_touch_or_stay_apart() -> None:
    height = math.sqrt(3.0) / 2.0
    assert found_places([circle(0, 0, 1), circle(1, 0, 1)]) == places(
        [Finding("", "", "", "", "0", 0.5, side * height) for side in (-1, 1)]
    )
    for x in (2.0, 0.5, 3.0, 0.0):
        radius = 0.5 if x == 0.5 else 1.0 if x != 0.0 else 0.7
        assert not found_places([circle(0, 0, 1), circle(x, 0, radius)]), x


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.1])
def test_tangent_lines_and_arcs_are_touches_and_cuts_are_not(angle: float) -> None:
    def turned(edges: list[Edge]) -> list[Edge]:
        return [moved(edge, angle, (3e-3, -1e-3)) for edge in edges]

    disc = turned(circle(0, 0, 1))
    assert not found_places([disc, turned(polygon((-2, 1), (2, 1), (0, 3)))]), "a side touches from outside"
    assert not found_places([disc, turned(polygon((-2, 1 + 1e-6), (2, 1 - 1e-6), (0, 3)))]), "to a nanometre"
    assert not found_places([disc, turned(polygon((0, 1), (1, 2), (-1, 2)))]), "a corner touches"
    assert len(found_places([disc, turned(polygon((-2, 0.9999), (2, 0.9999), (0, 3)))])) == 2, "0.1 µm deep"
    assert len(found_places([disc, turned(polygon((0, 0.9), (1, 2), (-1, 2)))])) == 2, "a corner inside"


def test_an_outline_that_passes_through_the_corner_of_another_one() -> None:
    square = polygon(*SQUARE)
    through = polygon((2.0, 2.0), (6.0, 6.0), (6.0, 2.0))
    corner = polygon((4.0, 4.0), (6.0, 4.0), (6.0, 6.0))
    assert (4.0, 4.0) in found_places([square, through])
    assert not found_places([square, corner])


def test_an_arc_that_comes_back_over_its_neighbour() -> None:
    """Both lines that close a three-quarter turn cut the arc a second time."""
    arc = Arc(0.0, 0.0, 1e-3, 0.0, 1.5 * math.pi)
    legs: list[Edge] = [Line(0.0, -1e-3, -2e-3, 0.5e-3), Line(-2e-3, 0.5e-3, 1e-3, 0.0)]
    foot = found_places([[arc, *legs]])
    assert len(foot) == 2 and all(math.hypot(*p) == pytest.approx(1.0, abs=1e-6) for p in foot)


def test_joints_that_do_not_quite_meet_are_no_crossings(read_bytes: Reader) -> None:
    """Ends overshoot each other by a nanometre to five micrometres; arcs stay as drawn."""
    for gap in (1e-6, 4e-4, 5e-3):
        entities = d.arc(0, 0, 1, 0, 180) + d.arc(-gap, -gap, 1, 180, 360 + 1e-3 * gap)
        drawing = read_bytes(d.dxf(entities))
        assert len(drawing.loops) == 1 and not of_code(drawing, "crossing"), gap


def test_lines_and_arcs_that_lie_partly_on_each_other(read_bytes: Reader) -> None:
    sides = d.line((0, 0), (3, 0), handle="A") + d.line((2, 0), (4, 0), handle="B")
    drawing = read_bytes(d.dxf(sides + d.arc(9, 0, 1, 0, 120, (5, "C")) + d.arc(9, 0, 1, 90, 200, (5, "D"))))
    lines, arcs = of_code(drawing, "overlap")
    assert lines.severity == "warning" and (lines.x_mm, lines.y_mm) == pytest.approx((2.5, 0.0), abs=1e-9)
    assert "LINE #A and LINE #B" in lines.message and "(2, 0)" in lines.message and "(3, 0)" in lines.message
    assert "ARC #C and ARC #D" in arcs.message
    assert math.atan2(arcs.y_mm or 0.0, (arcs.x_mm or 0.0) - 9.0) == pytest.approx(math.radians(105), abs=1e-9)


@pytest.mark.parametrize("start", [0.0, 100.0, 200.0, 359.0])
def test_an_arc_on_a_circle_lies_on_it_wherever_that_begins(start: float) -> None:
    """From 90° to 200°, the circle from anywhere; beside it an arc that meets it nowhere."""
    arc = Arc(1e-3, 2e-3, 5e-3, math.radians(90.0), math.radians(110.0))
    whole = Arc(1e-3, 2e-3, 5e-3, math.radians(start), math.tau)
    layer: Any = SimpleNamespace(edges=[whole, arc])
    ((p, q),) = stretches(layer, Meeting(0, 1, [arc.end, arc.start]))
    assert {p, q} == {arc.start, arc.end}
    assert stretches(layer, Meeting(0, 1, [arc.end])) == []


def test_a_spike_shorter_on_the_way_back(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.lwpolyline([(0, 0), (4, 0), (4, 2), (6, 2), (5, 2), (5, 4), (0, 4)], True)))
    (overlap,) = of_code(drawing, "overlap")
    assert (overlap.x_mm, overlap.y_mm) == pytest.approx((5.5, 2.0), abs=1e-9)


def test_centre_lines_may_cross_what_they_like(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + d.line((-2, 0), (2, 0)) + d.line((0, -2), (0, 2))))
    assert {finding.code for finding in drawing.findings} == {"stray-line"}


def test_an_end_on_the_middle_of_another_edge_is_no_crossing(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.line((0, 0), (10, 0)) + d.line((5, 0), (5, 3)) + d.line((5, 3), (0, 0))))
    assert [finding.code for finding in drawing.findings] == ["open-outline"]


def test_an_open_chain_that_crosses_itself_is_a_warning(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.lwpolyline([(0, 0), (4, 0), (4, 2), (2, 2), (2, -2)], False)))
    (finding,) = of_code(drawing, "crossing")
    assert finding.severity == "warning" and places([finding]) == [(2.0, 0.0)]


def test_outlines_on_different_layers_may_cross(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1, layer="A") + d.circle(1, 0, 1, layer="B")))
    assert not drawing.findings


@pytest.mark.parametrize("seed", range(6))
def test_random_polygons_cross_where_every_pair_of_sides_says(seed: int) -> None:
    """Against all pairs, with rational arithmetic."""
    from fractions import Fraction

    rng = random.Random(seed)
    corners = [(rng.randrange(1000), rng.randrange(1000)) for _ in range(60)]
    expected = []
    sides = list(zip(corners, corners[1:] + corners[:1], strict=True))
    for i, (a, b) in enumerate(sides):
        for c, e in sides[i + 2 : len(sides) - (i == 0)]:
            ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], e[0] - c[0], e[1] - c[1]
            cross = ux * vy - uy * vx
            if cross:
                s = Fraction((c[0] - a[0]) * vy - (c[1] - a[1]) * vx, cross)
                t = Fraction((c[0] - a[0]) * uy - (c[1] - a[1]) * ux, cross)
                if 0 < s < 1 and 0 < t < 1:
                    expected.append((round(float(a[0] + s * ux), 6), round(float(a[1] + s * uy), 6)))
    assert len(expected) > 100
    found = found_places([polygon(*[(float(x), float(y)) for x, y in corners])])
    assert len(found) == len(expected)
    for p, q in zip(found, sorted(expected), strict=True):
        assert p == pytest.approx(q, abs=2e-6)


@pytest.mark.slow
def test_many_edges_through_one_point_are_said_where_not_all_are_looked_at() -> None:
    petals = []
    for k in range(400):
        angle = TURN * k / 400
        petals.append([moved(edge, angle, (0.0, 0.0)) for edge in polygon((0, 0), (1, -0.004), (1, 0.004))])
    named = [Outline(Loop(tuple(edges)), ("edge",) * 3) for edges in petals]
    codes = {finding.code for finding in crossings(named)}
    assert codes <= {"crowded"}, "they touch at the centre only"
