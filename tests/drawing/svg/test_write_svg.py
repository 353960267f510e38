"""Is an SVG file that was written the outline it was made of, for our reader and for plain path arithmetic?"""

from __future__ import annotations

import math
import re
import sys
import xml.etree.ElementTree as ET
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from made_outlines import parts
from same_outlines import compare, same_edge

from watchsim.drawing.read import read
from watchsim.drawing.write import svg_text
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.solids import section

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from naive import svg_curve

ROOT = Path(__file__).resolve().parents[3]
SVG, INKSCAPE = "{http://www.w3.org/2000/svg}", "{http://www.inkscape.org/namespaces/inkscape}"


def gauss(text: str) -> float:
    """mm² between all curves of all paths, y up, by plain arithmetic: circles by their radius, the rest sampled."""
    total = 0.0
    for element in ET.fromstring(text).iter():
        if element.tag == f"{SVG}circle" and element.get("fill") is None:
            total += math.pi * float(element.get("r", "")) ** 2
        elif element.tag == f"{SVG}path" and element.get("fill") != "none":
            for part in re.findall(r"M[^M]*", element.get("d", "")):
                words = re.findall(r"([MLAZ])([^MLAZ]*)", part)
                commands = [(letter, *map(float, numbers.split())) for letter, numbers in words]
                points = svg_curve.points(commands, 33).tolist()
                total -= 0.5 * sum(ax * by - bx * ay for (ax, ay), (bx, by) in pairwise([*points, points[0]]))
    return total


@given(parts())
def test_random_outlines_enclose_the_same_area(loops: tuple[Loop, ...]) -> None:
    assert gauss(svg_text(loops)) == pytest.approx(1e6 * section(loops).area, rel=3e-4)


def read_back(text: str, folder: Path) -> tuple[tuple[Loop, ...], tuple[Loop, ...]]:
    """Loops and open chains, in the coordinates from before: a drawing's origin is the corner of its page."""
    path = folder / "again.svg"
    path.write_text(text, encoding="utf-8")
    drawing = read(path)
    assert drawing.units == "mm" and drawing.units_from == "page"
    assert {finding.code for finding in drawing.findings} <= ({"open-outline"} if drawing.open_chains else set())
    left, top, *_ = map(float, ET.fromstring(text).get("viewBox", "").split())
    shift = (1e-3 * left, -1e-3 * top)
    loops, chains = ([loop.moved(0.0, shift) for loop in found] for found in (drawing.loops, drawing.open_chains))
    return tuple(loops), tuple(chains)


def quartered(loop: Loop, whole_discs: bool) -> Loop:
    """With arcs of at most a quarter turn, as they are written; circles may be elements of their own."""
    if whole_discs and not loop.hole and len(loop.edges) == 1:
        return loop
    edges: list[Edge] = []
    for edge in loop.edges:
        parts = math.ceil(abs(edge.sweep) / (math.pi / 2) - 1e-9) if isinstance(edge, Arc) else 1
        for k in range(parts) if parts > 1 and isinstance(edge, Arc) else ():
            start, sweep = edge.start_angle + k * edge.sweep / parts, edge.sweep / parts
            edges.append(Arc(edge.x, edge.y, edge.radius, start, sweep))
        edges += [edge] if parts <= 1 else []
    return Loop(tuple(edges), loop.layer, loop.closed, loop.hole)


def written(loops: tuple[Loop, ...]) -> tuple[Loop, ...]:
    pierced = {loop.layer for loop in loops if loop.hole}
    return tuple(quartered(loop, loop.layer not in pierced) for loop in loops)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(parts())
def test_random_outlines_come_back_the_same(tmp_path: Path, loops: tuple[Loop, ...]) -> None:
    again, chains = read_back(svg_text(loops), tmp_path)
    compare(written(loops), again)
    assert not chains


@pytest.mark.parametrize("name", ["escape_wheel", "lever", "roller", "banking"])
def test_real_outlines_come_back_the_same(name: str, tmp_path: Path) -> None:
    drawing = read(ROOT / "profiles" / "swiss_lever" / f"{name}.dxf")
    pivot: Point = (0.1e-3, 0.2e-3)
    again, _ = read_back(svg_text(drawing.loops, [("MARK", pivot)]), tmp_path)
    compare(written(drawing.loops), tuple(loop for loop in again if loop.layer != "MARK"))
    (mark,) = [loop.edges[0] for loop in again if loop.layer == "MARK"]
    assert isinstance(mark, Arc) and (mark.x, mark.y) == pytest.approx(pivot, abs=1e-15)


def test_open_chains_stay_open(tmp_path: Path) -> None:
    chain = Loop((Line(0.0, 0.0, 1e-3, 0.0), Arc(1e-3, 1e-3, 1e-3, -math.pi / 2, 1.0)), "FACE", closed=False)
    _, (again,) = read_back(svg_text((chain,)), tmp_path)
    assert again.layer == "FACE" and all(same_edge(a, b, 1e-15) for a, b in zip(chain.edges, again.edges, strict=True))


def test_page_layers_and_arcs() -> None:
    half = Loop((Arc(0.0, 0.0, 2e-3, 0.0, math.pi), Line(-2e-3, 0.0, 2e-3, 0.0)), "HALF & HALF")
    disc = Loop((Arc(5e-3, 1e-3, 0.5e-3, 0.0, TURN),), "DISC")
    text = svg_text((half, disc), [("PIVOT", (1e-3, 2e-3))], {"DISC": "#c4234f"}, title="a < b & c")
    root = ET.fromstring(text)
    width, height = (float(root.get(name, "").removesuffix("mm")) for name in ("width", "height"))
    box = [float(value) for value in root.get("viewBox", "").split()]
    assert box[2:] == [width, height] and width == pytest.approx(7.5 + 0.75) and height == pytest.approx(2.0 + 0.75)
    assert root.findtext(f"{SVG}title") == "a < b & c"
    groups = {group.get(f"{INKSCAPE}label"): group for group in root.iter(f"{SVG}g")}
    assert list(groups) == ["HALF & HALF", "DISC", "PIVOT"]
    assert all(group.get(f"{INKSCAPE}groupmode") == "layer" for group in groups.values())
    (path,) = groups["HALF & HALF"]
    words = path.get("d", "").split()
    assert words.count("A") == 2 and words[-1] == "Z"
    top = [float(word) for word in words[words.index("A") + 6 : words.index("A") + 8]]
    assert top == pytest.approx([0.0, -2.0], abs=1e-12)  # y points down in SVG
    (circle,) = groups["DISC"]
    assert [float(circle.get(name, "")) for name in ("cx", "cy", "r")] == pytest.approx([5.0, -1.0, 0.5], rel=1e-15)
    (mark,) = groups["PIVOT"]
    assert [float(mark.get(name, "")) for name in ("cx", "cy")] == pytest.approx([1.0, -2.0], rel=1e-15)


def test_a_bore_shares_the_path_of_its_ring() -> None:
    ring = (Loop((Arc(0.0, 0.0, 2e-3, 0.0, TURN),), "R"), Loop((Arc(0.0, 0.0, 1e-3, 0.0, -TURN),), "R", hole=True))
    text = svg_text(ring)
    assert text.count("<path") == 1 and "<circle" not in text
    assert gauss(text) == pytest.approx(3.0 * math.pi, rel=1e-3)


def test_the_page_holds_the_drawing_and_little_more() -> None:
    """An outline far from the origin, y up in the drawing and down on the page."""
    points = [(3e-3, 7e-3), (9e-3, 7e-3), (9e-3, 9e-3), (3e-3, 9e-3)]
    text = svg_text([Loop(tuple(Line(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True)))])
    root = ET.fromstring(text)
    left, top, width, height = (float(word) for word in root.get("viewBox", "").split())
    assert left < 3.0 and 9.0 < left + width < 9.0 + 6.0 and left > 3.0 - 3.0
    assert top < -9.0 and -7.0 < top + height < -7.0 + 3.0 and top > -9.0 - 3.0
    assert (root.get("width"), root.get("height")) == (f"{width!r}mm", f"{height!r}mm")
