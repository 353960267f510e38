"""Are facets judged by how far they leave the curve through their corners, whatever their lengths?"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import dxf_text as d
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.drawing.circles import curvatures, facets
from watchsim.drawing.drawing import Drawing
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line

Reader = Callable[..., Drawing]
Point = tuple[float, float]


def off(drawing: Drawing) -> list[float]:
    """Deviations (µm) that the findings tell."""
    words = [finding.message for finding in drawing.findings if finding.code == "facets"]
    return [float(text.split("(up to ")[1].split(" µm")[0]) for text in words]


def rim(angles: list[float], radius: float = 2.0, x: float = 0.0) -> list[Point]:
    return [(x + radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


def widest(angles: list[float], radius: float) -> float:
    """µm by which the longest chord leaves its circle."""
    gaps = [b - a for a, b in zip(angles, [*angles[1:], angles[0] + math.tau], strict=True)]
    return 1e3 * radius * (1.0 - math.cos(0.5 * max(gaps)))


@given(st.lists(st.floats(0.6, 1.5), min_size=60, max_size=80))
def test_uneven_facets_of_a_pin(steps: list[float]) -> None:
    angles = [math.tau * sum(steps[:k]) / sum(steps) for k in range(len(steps))]
    points = [(1e-3 * x, 1e-3 * y) for x, y in rim(angles, 10.0)]
    edges = tuple(Line(*a, *b) for a, b in zip(points, [*points[1:], points[0]], strict=True))
    (finding,) = facets([Loop(edges, "0")])
    found = float(finding.message.split("(up to ")[1].split(" µm")[0])
    assert found == pytest.approx(widest(angles, 10.0), rel=1e-2)


@pytest.mark.parametrize(("pieces", "told"), [(68, True), (300, True), (900, False)])
def test_what_no_fitted_curve_would_show_is_not_told(pieces: int, told: bool, read_bytes: Reader) -> None:
    angles = [math.tau * k / pieces for k in range(pieces)]
    rise = 2e3 * (1.0 - math.cos(math.pi / pieces))
    assert (rise > 0.1) == told
    found = off(read_bytes(d.dxf(d.lwpolyline(rim(angles), True))))
    assert found == ([pytest.approx(rise, rel=0.01)] if told else [])


def test_one_finding_for_an_outline(read_bytes: Reader) -> None:
    """A slot with two faceted ends: one finding, with the larger deviation, and what to do."""
    right = rim([-0.5 * math.pi + math.pi * k / 20 for k in range(21)], 1.0, 10.0)
    left = rim([0.5 * math.pi + math.pi * k / 12 for k in range(13)], 1.0, -10.0)
    drawing = read_bytes(d.dxf(d.lwpolyline([*right, *left], True)))
    (finding,) = drawing.findings
    assert "32 straight pieces stand for curves at 2 places" in finding.message and "ARC" in finding.fix
    assert off(drawing) == [pytest.approx(1e3 * (1.0 - math.cos(math.pi / 24)), rel=0.01)]


def test_a_curve_that_is_no_arc(read_bytes: Reader) -> None:
    """Half an ellipse of 4 × 1 mm in 40 pieces; the deviation against the sampled ellipse."""
    at = [math.pi * k / 40 for k in range(41)]
    points = [(4.0 * math.cos(t), math.sin(t)) for t in at]
    true = 0.0
    for a, b, s in zip(points, points[1:], at, strict=False):
        for k in range(1, 100):
            t = s + math.pi / 40 * k / 100
            p = (4.0 * math.cos(t), math.sin(t))
            length = math.dist(a, b)
            true = max(true, abs((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / length)
    (finding,) = read_bytes(d.dxf(d.lwpolyline(points, True))).findings
    assert "stand for a curve" in finding.message and "SPLINE" in finding.fix
    assert float(finding.message.split("(up to ")[1].split(" µm")[0]) == pytest.approx(
        1e3 * true, rel=0.1
    )  # at its end only one corner is known


def test_designed_corners_are_no_facets(read_bytes: Reader) -> None:
    chamfers = [(0, 0), (9, 0), (10, 1), (10, 4), (9.5, 6), (5, 6.5), (1, 6), (0, 5)]
    stairs = [(20 + k, 0.3 * k + (0.5 if k % 2 else 0.0)) for k in range(12)] + [(31, -5), (20, -5)]
    assert not off(read_bytes(d.dxf(d.lwpolyline(chamfers, True) + d.lwpolyline(stairs, True))))


@pytest.mark.parametrize("apart", [5e-6, 5e-5, 5e-4])
def test_outlines_that_all_but_coincide_are_found(apart: float, read_bytes: Reader) -> None:
    """A copy 5 to 500 nm beside its original; drawn 2 µm away it is another outline, which crosses."""
    shape = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
    moved = [(x + apart, y + 0.3 * apart) for x, y in shape]
    codes = [(f.code, f.severity) for f in read_bytes(d.dxf(d.lwpolyline(shape, True) + d.lwpolyline(moved, True))).findings]
    assert ("overlap", "error") in codes
    circles = d.circle(0, 0, 1) + d.circle(apart, 0, 1 - 0.5 * apart)
    assert ("overlap", "error") in [(f.code, f.severity) for f in read_bytes(d.dxf(circles)).findings]
    ring = d.circle(0, 0, 1) + d.circle(0, 0, 0.99)
    assert not read_bytes(d.dxf(ring)).findings


def test_ends_of_unrelated_parts_are_not_paired(read_bytes: Reader) -> None:
    """Two brackets 30 mm apart, one of them all but closed: each is told by itself."""
    first = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0.05)]
    second = [(34, 0), (38, 0), (38, 4)]
    found = read_bytes(d.dxf(d.lwpolyline(first, False) + d.lwpolyline(second, False))).findings
    assert [f.code for f in found] == ["open-outline"] * 2
    assert "50 µm" in found[0].message
    assert all((f.x_mm < 10) == (f.other_mm[0] < 10) for f in found)


def test_pieces_of_one_part_are_paired_over_a_gap(read_bytes: Reader) -> None:
    halves = d.lwpolyline([(0, 0), (4, 0), (4, 4)], False) + d.lwpolyline([(0, 0.2), (0, 4), (3.9, 4)], False)
    found = read_bytes(d.dxf(halves)).findings
    assert sorted(round(math.dist((f.x_mm, f.y_mm), f.other_mm), 3) for f in found) == [0.1, 0.2]


def test_a_piece_without_length_hides_the_curvature_at_its_two_ends_only() -> None:
    """Elsewhere it is that of the circle, 1 / r."""
    angles = np.linspace(0.0, math.tau, 25)
    corners = 2e-3 * np.column_stack((np.cos(angles), np.sin(angles)))
    ways = np.diff(np.insert(corners, 10, corners[10], axis=0), axis=0)
    found = curvatures(ways)
    assert np.flatnonzero(np.isnan(found)).tolist() == [9, 10]
    assert np.delete(found, [9, 10]) == pytest.approx(500.0, rel=1e-9)


def row_of_radii(radii: list[float]) -> Loop:
    """Pieces of 0.1 rad each, open: at corner k they lie on a circle of radius k (m), which turns left."""
    points = [0.0j, complex(0.1 * radii[0])]
    for radius in radii:
        way = points[-1] - points[-2]
        half = 0.5 * abs(way)
        centre = points[-2] + 0.5 * way + 1j * way / abs(way) * math.sqrt(radius * radius - half * half)
        points.append(centre + (points[-1] - centre) * complex(math.cos(0.1), math.sin(0.1)))
    edges = [Line(a.real, a.imag, b.real, b.imag) for a, b in pairwise(points)]
    return Loop(tuple(edges), "0", closed=False)


@pytest.mark.parametrize(("difference", "is_arc"), [(0.0, True), (0.019, True), (0.022, False)])
@pytest.mark.parametrize("order", [1, -1])
def test_radii_within_two_percent_make_an_arc(difference: float, is_arc: bool, order: int) -> None:
    radii = [2e-3 * (1.0 - difference * k / 10) for k in range(11)][::order]
    (finding,) = facets([row_of_radii(radii)])
    curve = "an arc of radius" if is_arc else "a curve"
    assert f"12 straight pieces stand for {curve} " in finding.message
    assert ("SPLINE" in finding.fix) != is_arc
