"""Are random outlines of lines and arcs the same after writing, reading, turning, mirroring, scaling and reversing?"""

from __future__ import annotations

import cmath
import math
import random
import tempfile
from pathlib import Path

import dxf_text as d
import pytest
import svg_text as s
from hypothesis import given
from hypothesis import strategies as st

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.geometry.solids import section

SAME = 1e-12

Corner = tuple[complex, float]  # a place (mm) and the bulge of the edge that leaves it


@st.composite
def outlines(draw: st.DrawFn) -> list[Corner]:
    """A star of lines and arcs about the origin; arcs stay within their sector, so nothing crosses."""
    count = draw(st.integers(3, 14))
    corners = [cmath.rect(draw(st.floats(1.0, 3.0)), math.tau * k / count) for k in range(count)]
    bulges = [draw(st.sampled_from((0.0, 0.0, 0.05, -0.04, 0.08))) for _ in range(count)]
    return list(zip(corners, bulges, strict=True))


@st.composite
def holes(draw: st.DrawFn) -> list[Corner]:
    """A slot or triangle well inside."""
    size = draw(st.floats(0.02, 0.15))
    if draw(st.booleans()):
        return [
            (complex(-size, -size / 4), 0.0),
            (complex(size, -size / 4), 1.0),
            (complex(size, size / 4), 0.0),
            (complex(-size, size / 4), 1.0),
        ]
    return [(size * cmath.exp(2j * math.pi * k / 3), 0.0) for k in range(3)]


def as_polyline(corners: list[Corner]) -> str:
    return d.lwpolyline([(z.real, z.imag, bulge) for z, bulge in corners], True)


def as_entities(corners: list[Corner], rng: random.Random) -> str:
    """Single lines and arcs in any order and direction."""
    pieces = []
    for (a, bulge), (b, _) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if bulge == 0.0:
            p, q = (a, b) if rng.random() < 0.5 else (b, a)
            pieces.append(d.line((p.real, p.imag), (q.real, q.imag)))
        else:
            centre = (a + b) / 2 + 1j * (b - a) * (1 - bulge * bulge) / (4 * bulge)
            first, last = (a, b) if bulge > 0.0 else (b, a)
            angles = [math.degrees(cmath.phase(p - centre)) for p in (first, last)]
            pieces.append(d.arc(centre.real, centre.imag, abs(a - centre), *angles))
    rng.shuffle(pieces)
    return "".join(pieces)


def read_text(entities: str) -> Drawing:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "outline.dxf"
        path.write_bytes(d.dxf(entities))
        return read(path)


def facts(drawing: Drawing) -> tuple[float, float, complex]:
    """Area (mm²), polar moment about the centroid (mm⁴), centroid (mm), after a look at the loops."""
    assert not [finding for finding in drawing.findings if finding.code != "facets"]
    outer, inner = sorted(drawing.loops, key=lambda loop: loop.hole)
    assert not outer.hole and inner.hole and not drawing.open_chains
    total = section(drawing.loops)
    x, y = total.centroid
    return 1e6 * total.area, 1e12 * total.about((x, y)).polar, complex(1e3 * x, 1e3 * y)


def kinds(drawing: Drawing) -> list[list[str]]:
    return sorted(sorted(type(edge).__name__ for edge in loop.edges) for loop in drawing.loops)


@given(outlines(), holes(), st.randoms(use_true_random=False), st.floats(-3.2, 3.2), st.floats(0.1, 20.0), st.booleans())
def test_the_same_outline_however_it_is_written_turned_mirrored_and_scaled(
    outer: list[Corner], inner: list[Corner], rng: random.Random, angle: float, scale: float, mirrored: bool
) -> None:
    plain = read_text(as_polyline(outer) + as_polyline(inner))
    area, polar, centroid = facts(plain)
    backward = [(outer[k][0], -outer[k - 1][1]) for k in range(len(outer) - 1, -1, -1)]
    factor, shift = scale * cmath.exp(1j * angle), complex(3.0, -2.0)

    def moved(corners: list[Corner]) -> list[Corner]:
        """In Python's complex numbers, without the package."""
        if mirrored:
            return [(factor * z.conjugate() + shift, -bulge) for z, bulge in corners]
        return [(factor * z + shift, bulge) for z, bulge in corners]

    centre = factor * (centroid.conjugate() if mirrored else centroid) + shift
    versions = {
        "backward": (as_polyline(backward) + as_polyline(inner), 1.0, centroid),
        "single": (as_entities(outer, rng) + as_entities(inner, rng), 1.0, centroid),
        "moved": (as_polyline(moved(outer)) + as_polyline(moved(inner)), scale, centre),
    }
    for name, (text, by, where) in versions.items():
        drawing = read_text(text)
        found_area, found_polar, found_centroid = facts(drawing)
        assert kinds(drawing) == kinds(plain), name
        assert found_area == pytest.approx(by**2 * area, rel=SAME, abs=0), name
        assert found_polar == pytest.approx(by**4 * polar, rel=SAME, abs=0), name
        assert abs(found_centroid - where) <= SAME * (abs(where) + 3.0 * by), name


@given(outlines(), holes(), st.floats(-180.0, 180.0), st.booleans())
def test_a_block_turned_and_mirrored_by_its_insert_is_the_same(
    outer: list[Corner], inner: list[Corner], degrees: float, mirrored: bool
) -> None:
    text = as_polyline(outer) + as_polyline(inner)
    area, polar, _ = facts(read_text(text))
    placed = d.insert("PART", (5.0, -7.0), (41, -1.5 if mirrored else 1.5), (42, 1.5), (50, degrees))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "block.dxf"
        path.write_bytes(d.dxf(placed, blocks=d.block("PART", text, base=(0.3, 0.4))))
        found_area, found_polar, _ = facts(read(path))
    assert found_area == pytest.approx(1.5**2 * area, rel=SAME, abs=0)
    assert found_polar == pytest.approx(1.5**4 * polar, rel=SAME, abs=0)


def as_path(corners: list[Corner]) -> str:
    """SVG counts y downwards, so that a turn to the left is one to the right there."""
    words = [f"M {corners[0][0].real!r} {-corners[0][0].imag!r}"]
    for (a, bulge), (b, _) in zip(corners, [*corners[1:], corners[0]], strict=True):
        radius = abs(b - a) * (1 + bulge * bulge) / (4 * abs(bulge)) if bulge else 0.0
        arc = f"A {radius!r} {radius!r} 0 0 {int(bulge < 0.0)}" if bulge else "L"
        words.append(f"{arc} {b.real!r} {-b.imag!r}")
    return " ".join([*words, "Z"])


@given(outlines(), st.floats(-180.0, 180.0), st.floats(0.1, 20.0), st.booleans())
def test_an_svg_path_turned_mirrored_and_scaled_by_its_transform_is_the_same(
    outer: list[Corner], degrees: float, scale: float, mirrored: bool
) -> None:
    inner: list[Corner] = [
        (complex(-0.1, -0.02), 0.0),
        (complex(0.1, -0.02), 0.9),
        (complex(0.1, 0.02), 0.0),
        (-0.1 + 0.02j, 0.9),
    ]
    area, polar, centroid = facts(read_text(as_polyline(outer) + as_polyline(inner)))
    placed = f"translate(3 2) rotate({degrees!r}) scale({scale!r} {-scale if mirrored else scale!r})"
    page = 'width="100mm" height="100mm" viewBox="0 0 100 100"'
    text = s.svg(f'<g transform="{placed}"><path d="{as_path(outer)} {as_path(inner)}"/></g>', page)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "outline.svg"
        path.write_text(text)
        found_area, found_polar, found_centroid = facts(read(path))
    turned = scale * cmath.exp(-1j * math.radians(degrees)) * (centroid.conjugate() if mirrored else centroid)
    assert found_area == pytest.approx(scale**2 * area, rel=SAME, abs=0)
    assert found_polar == pytest.approx(scale**4 * polar, rel=SAME, abs=0)
    where = turned + complex(3.0, -2.0)
    assert abs(found_centroid - where) <= SAME * (abs(where) + 3.0 * scale)


@given(outlines())
def test_area_and_moment_agree_with_a_fine_polygon(outer: list[Corner]) -> None:
    """Chords of the arcs, in complex numbers: the error falls with the square of their number."""
    (loop,) = read_text(as_polyline(outer)).loops
    assert isinstance(loop, Loop) and {type(edge) for edge in loop.edges} <= {Line, Arc}
    points: list[complex] = []
    for (a, bulge), (b, _) in zip(outer, [*outer[1:], outer[0]], strict=True):
        points.append(a)
        if bulge:
            centre = (a + b) / 2 + 1j * (b - a) * (1 - bulge * bulge) / (4 * bulge)
            sweep = 4 * math.atan(bulge)
            points += [centre + (a - centre) * cmath.exp(1j * sweep * k / 200) for k in range(1, 200)]
    following = [*points[1:], points[0]]
    crosses = [(p.conjugate() * q).imag for p, q in zip(points, following, strict=True)]
    squares = [abs(p) ** 2 + abs(q) ** 2 + (p.conjugate() * q).real for p, q in zip(points, following, strict=True)]
    total = section([loop]).about((0.0, 0.0))
    assert 1e6 * total.area == pytest.approx(sum(crosses) / 2, rel=1e-5)
    assert 1e12 * total.polar == pytest.approx(sum(c * s for c, s in zip(crosses, squares, strict=True)) / 12, rel=1e-5)
