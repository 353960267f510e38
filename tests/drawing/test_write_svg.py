"""Is an SVG file that was written the outline it was made of, seen by a reader that shares no code with it?"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from itertools import pairwise

import pytest
import svgelements
from hypothesis import given, settings
from made_outlines import parts

from watchsim.drawing.write_svg import svg_text
from watchsim.geometry.loop import Loop
from watchsim.geometry.mass import section
from watchsim.geometry.primitives import TURN, Arc, Line

SVG, INKSCAPE = "{http://www.w3.org/2000/svg}", "{http://www.inkscape.org/namespaces/inkscape}"


def gauss(text: str) -> float:
    """mm² between all curves of all paths, y up: circles by their radius, the rest sampled."""
    total = 0.0
    for element in ET.fromstring(text).iter():
        if element.tag == f"{SVG}circle" and element.get("fill") is None:
            total += math.pi * float(element.get("r", "")) ** 2
        elif element.tag == f"{SVG}path" and element.get("fill") != "none":
            for part in svgelements.Path(element.get("d")).as_subpaths():
                points = [
                    segment.point(k / 32)
                    for segment in svgelements.Path(part)
                    for k in range(33)
                    if not isinstance(segment, svgelements.Move)
                ]
                total -= 0.5 * sum(a.x * b.y - b.x * a.y for a, b in pairwise([*points, points[0]]))
    return total


@settings(deadline=None, max_examples=8)
@given(parts())
def test_random_outlines_enclose_the_same_area(loops: tuple[Loop, ...]) -> None:
    assert gauss(svg_text(loops)) == pytest.approx(1e6 * section(loops).area, rel=3e-4)


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
