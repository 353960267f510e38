"""What does each element draw, corner by corner, and which map is each transform?"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import pytest

from watchsim.drawing.projection import IDENTITY, Affine, Conic, Dot, Shape, Straight
from watchsim.drawing.svg_elements import SvgError
from watchsim.drawing.svg_shapes import (
    READERS,
    Box,
    Measures,
    PathData,
    diagonal,
    fitted,
    length,
    numbers,
    placed,
    split_length,
    transform,
    view_box,
)
from watchsim.geometry.primitives import TURN

Point = tuple[float, float]


def drawn(kind: str, values: Mapping[str, str], width: float = 200.0, height: float = 100.0) -> PathData:
    return READERS[kind](Measures(values, width, height))


def sides(*corners: Point) -> list[Shape]:
    return [Straight((*a, 0.0), (*b, 0.0)) for a, b in pairwise(corners)]


def corner(x: float, y: float, rx: float, ry: float, start: float) -> Conic:
    return Conic((x, y, 0.0), (rx, 0.0, 0.0), (0.0, ry, 0.0), start * TURN / 4.0, TURN / 4.0)


def oval(x: float, y: float, rx: float, ry: float) -> Conic:
    return Conic((x, y, 0.0), (rx, 0.0, 0.0), (0.0, ry, 0.0), 0.0, TURN)


BOX = {"x": "1", "y": "2", "width": "10", "height": "6"}
EDGES = sides((1, 2), (11, 2), (11, 8), (1, 8), (1, 2))
ROUNDED = [
    *(Straight((3, 2, 0), (9, 2, 0)), corner(9, 3, 2, 1, -1), Straight((11, 3, 0), (11, 7, 0)), corner(9, 7, 2, 1, 0)),
    *(Straight((9, 8, 0), (3, 8, 0)), corner(3, 7, 2, 1, 1), Straight((1, 7, 0), (1, 3, 0)), corner(3, 3, 2, 1, 2)),
]
CASES: list[tuple[str, dict[str, str], list[Shape], bool]] = [
    ("line", {"x1": "1", "y1": "2", "x2": "3", "y2": "4"}, sides((1, 2), (3, 4)), False),
    ("line", {"x2": "10%", "y2": "10%"}, sides((0, 0), (20, 10)), False),
    ("polyline", {"points": "1,2 3,4 5,0"}, sides((1, 2), (3, 4), (5, 0)), False),
    ("polyline", {"points": "1,2 3,4 5,0 1,2"}, sides((1, 2), (3, 4), (5, 0), (1, 2)), True),
    ("polyline", {"points": "1,2 3,4 1,2"}, sides((1, 2), (3, 4), (1, 2)), True),
    ("polyline", {"points": "1,2 1,2"}, sides((1, 2), (1, 2)), False),
    ("polygon", {"points": "1,2 3,4 5,0"}, sides((1, 2), (3, 4), (5, 0), (1, 2)), True),
    ("polygon", {"points": "1,2 3,4 5,0 1,2"}, sides((1, 2), (3, 4), (5, 0), (1, 2)), True),
    ("polygon", {"points": "1,2 3,4"}, sides((1, 2), (3, 4), (1, 2)), True),
    ("rect", BOX, EDGES, True),
    ("rect", {**BOX, "rx": "0", "ry": "1"}, EDGES, True),
    ("rect", {**BOX, "rx": "2", "ry": "0"}, EDGES, True),
    ("rect", {**BOX, "rx": "2", "ry": "1"}, ROUNDED, True),
    ("rect", {**BOX, "rx": "1%", "ry": "1%"}, ROUNDED, True),
    ("rect", {"width": "10", "height": "6", "rx": "5", "ry": "3"}, [corner(5, 3, 5, 3, k) for k in (-1, 0, 1, 2)], True),
    ("rect", {"width": "10", "height": "6", "rx": "99", "ry": "99"}, [corner(5, 3, 5, 3, k) for k in (-1, 0, 1, 2)], True),
    ("circle", {"cx": "4", "cy": "-5", "r": "2"}, [oval(4, -5, 2, 2)], True),
    ("circle", {"cx": "10%", "cy": "10%", "r": "5e-4"}, [oval(20, 10, 5e-4, 5e-4)], True),
    ("circle", {"cx": "4", "cy": "5", "r": "0"}, [Dot((4.0, 5.0, 0.0))], True),
    ("ellipse", {"cx": "4", "cy": "5", "rx": "2", "ry": "1"}, [oval(4, 5, 2, 1)], True),
    ("ellipse", {"rx": "2"}, [oval(0, 0, 2, 2)], True),
    ("ellipse", {"rx": "auto", "ry": "3%"}, [oval(0, 0, 3, 3)], True),
    ("ellipse", {"rx": "5e-4", "ry": "5e-4"}, [oval(0, 0, 5e-4, 5e-4)], True),
    ("path", {"d": "M 1 2 L 3 4"}, sides((1, 2), (3, 4)), False),
]


@pytest.mark.parametrize(("kind", "values", "shapes", "closed"), CASES, ids=[f"{kind} {values}" for kind, values, *_ in CASES])
def test_an_element_draws_these_shapes(kind: str, values: dict[str, str], shapes: list[Shape], closed: bool) -> None:
    (row,) = drawn(kind, values).rows
    assert (row.shapes, row.closed) == (shapes, closed)


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        *(("polygon", {"points": ""}), ("polygon", {"points": "1 2"}), ("rect", {"width": "0", "height": "5"})),
        *(("rect", {"width": "5", "height": "0"}), ("ellipse", {"rx": "0", "ry": "3"}), ("ellipse", {"rx": "3", "ry": "0"})),
        *(("path", {"d": " "}), ("path", {"d": "none"})),
    ],
)
def test_an_element_that_is_there_and_draws_nothing(kind: str, values: dict[str, str]) -> None:
    assert drawn(kind, values) == PathData([], "")


@pytest.mark.parametrize(
    ("kind", "values", "why"),
    [
        *(("line", {}, "no coordinates"), ("polyline", {}, "no points"), ("polygon", {"points": "1 2 3"}, "3 coordinates")),
        *(
            ("rect", {"width": "5"}, "no height"),
            ("rect", {"height": "5"}, "no width"),
            ("rect", {**BOX, "width": "-1"}, "width is -1"),
        ),
        *(
            ("rect", {**BOX, "rx": "-0.5"}, "rx is -0.5"),
            ("rect", {**BOX, "rx": "1", "ry": "-2"}, "ry is -2"),
            ("circle", {}, "no r"),
        ),
        *(("circle", {"r": "-1"}, "r is -1"), ("ellipse", {}, "neither rx nor ry"), ("ellipse", {"rx": "-1"}, "rx is -1")),
        *(("ellipse", {"rx": "2", "ry": "-1"}, "ry is -1"), ("path", {}, "no d")),
    ],
)
def test_what_cannot_be_meant_is_said(kind: str, values: dict[str, str], why: str) -> None:
    with pytest.raises(SvgError, match=why):
        drawn(kind, values)


def test_one_radius_alone_counts_for_both_and_none_is_longer_than_half_its_side() -> None:
    """SVG 2, §10.2; a rectangle 10 wide and 6 high."""
    for given, radii in (
        *(
            ({"rx": "1"}, (1, 1)),
            ({"ry": "2"}, (2, 2)),
            ({"rx": "4"}, (4, 3)),
            ({"ry": "4"}, (4, 3)),
            ({"rx": "7", "ry": "1"}, (5, 1)),
            ({"rx": "4.5", "ry": "2.6"}, (4.5, 2.6)),
        ),
        *(({"rx": "2", "ry": "9"}, (2, 3)), ({"rx": "auto", "ry": "1"}, (1, 1)), ({"rx": "1e-4", "ry": "1e-4"}, (1e-4, 1e-4))),
    ):
        (row,) = drawn("rect", {**BOX, **given}).rows
        corners = [shape for shape in row.shapes if isinstance(shape, Conic)]
        assert len(corners) == 4 and {(one.u[0], one.v[1]) for one in corners} == {radii}
        straight = [math.dist(shape.a, shape.b) for shape in row.shapes if isinstance(shape, Straight)]
        expected = [side for side in (10 - 2 * radii[0], 6 - 2 * radii[1]) if side > 0.0]
        assert sorted(straight) == pytest.approx(sorted(expected * 2))


@pytest.mark.parametrize(
    ("text", "user"),
    [
        ("7", 7.0),
        ("-7px", -7.0),
        ("1in", 96.0),
        ("2.54cm", 96.0),
        ("25.4mm", 96.0),
        ("101.6Q", 96.0),
        ("72pt", 96.0),
        ("6pc", 96.0),
        ("25%", 50.0),
        (" .5e1 PX ", 5.0),
    ],
)
def test_lengths_in_pixels(text: str, user: float) -> None:
    assert length(text, 200.0) == pytest.approx(user, rel=1e-15)


def test_numbers_and_lengths_that_are_none() -> None:
    for text in ("", "mm", "1 2", "1em", "--1", "1e", "5 %%"):
        with pytest.raises(SvgError):
            split_length(text)
    for text in (",1", "1,,2", "1 a", "1;2"):
        with pytest.raises(SvgError):
            numbers(text)
    assert numbers(" 1,2 -3+4.5.5e1 ") == [1.0, 2.0, -3.0, 4.5, 5.0] and numbers("  ") == []
    assert (
        length("0%", 0.0) == 0.0
        and diagonal(3.0, 4.0) == pytest.approx(math.sqrt(12.5))
        and diagonal(5.0, 5.0) == pytest.approx(5.0)
    )
    for text in ("5%", "0.0001%", "-1%"):
        with pytest.raises(SvgError, match="a page whose size is not given"):
            length(text, 0.0)
    assert length("50%", 5e-4) == 2.5e-4
    for huge in ("1e20", "-1e20", "1e400"):
        with pytest.raises(SvgError, match="beyond any drawing"):
            numbers(huge)


C, S = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
MATRICES: list[tuple[str, tuple[float, float, float, float, float, float]]] = [
    *(("none", (1, 0, 0, 1, 0, 0)), ("", (1, 0, 0, 1, 0, 0)), ("matrix(1 2 3 4 5 6)", (1, 2, 3, 4, 5, 6))),
    *(("translate(3)", (1, 0, 0, 1, 3, 0)), ("translate(3, 4)", (1, 0, 0, 1, 3, 4)), ("translateX(3px)", (1, 0, 0, 1, 3, 0))),
    *(("translateY(4px)", (1, 0, 0, 1, 0, 4)), ("scale(2)", (2, 0, 0, 2, 0, 0)), ("scale(2 3)", (2, 0, 0, 3, 0, 0))),
    *(
        ("scaleX(2)", (2, 0, 0, 1, 0, 0)),
        ("scaleY(3)", (1, 0, 0, 3, 0, 0)),
        ("skewX(45)", (1, 0, 1, 1, 0, 0)),
        ("skewY(45)", (1, 1, 0, 1, 0, 0)),
    ),
    *(("rotate(30)", (C, S, -S, C, 0, 0)), ("rotate(90)", (0, 1, -1, 0, 0, 0)), ("rotate(-30deg)", (C, -S, S, C, 0, 0))),
    *(
        ("rotate(100grad)", (0, 1, -1, 0, 0, 0)),
        ("rotate(0.25turn)", (0, 1, -1, 0, 0, 0)),
        (f"rotate({math.pi / 6!r}rad)", (C, S, -S, C, 0, 0)),
    ),
    *(
        ("rotate(90 3 5)", (0, 1, -1, 0, 8, 2)),
        ("rotate(180, 3, 5)", (-1, 0, 0, -1, 6, 10)),
        ("rotate(30 2 1)", (C, S, -S, C, 2 - 2 * C + S, 1 - 2 * S - C)),
    ),
    *(
        ("translate(1 2) scale(3)", (3, 0, 0, 3, 1, 2)),
        ("scale(3),translate(1 2)", (3, 0, 0, 3, 3, 6)),
        ("skewX(-45)", (1, 0, -1, 1, 0, 0)),
    ),
]


@pytest.mark.parametrize(("text", "six"), MATRICES)
def test_transforms_are_these_matrices(text: str, six: tuple[float, ...]) -> None:
    a, b, c, d, e, f = six
    expected = Affine((a, b, 0.0), (c, d, 0.0), (0.0, 0.0, 1.0), (e, f, 0.0))
    assert np.array(transform(text)) == pytest.approx(np.array(expected), abs=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        *(
            "rotate()",
            "rotate(x)",
            "rotate(1 2)",
            "rotate(1 2 3 4)",
            "skewX(90)",
            "skewY(-90)",
            "skewX(1 2)",
            "scale(1 2 3)",
            "turn(3)",
        ),
        *(
            "matrix(1 2 3 4 5)",
            "translateX(1 2)",
            "scale(2) 5",
            "translate(1",
            "rotate(3.6e12)",
            "scale(1e6) scale(1.1e6)",
            "scale(1e6) translate(0 -1.1e6)",
        ),
    ],
)
def test_transforms_that_cannot_be_read(text: str) -> None:
    with pytest.raises(SvgError):
        transform(text)


def test_transforms_up_to_the_end_of_any_drawing() -> None:
    assert transform("scale(1e6) scale(0.9e6)").ax[0] == 0.9e12 and transform("rotate(3.5e11)") is not None


@pytest.mark.parametrize(
    ("origin", "at"),
    [
        *(("10 20", (10, 20)), ("10", (10, 50)), ("left top", (0, 0)), ("top left", (0, 0)), ("bottom right", (200, 100))),
        *(
            ("center", (100, 50)),
            ("top", (100, 0)),
            ("right", (200, 50)),
            ("25% 10px", (50, 10)),
            ("10 bottom 5", (10, 100)),
            ("top 30", (30, 0)),
        ),
        *(("center left", (0, 50)), ("bottom left", (0, 100)), ("center right", (200, 50)), ("center bottom", (100, 100))),
    ],
)
def test_what_turns_about_an_origin_leaves_it_where_it_is(origin: str, at: Point) -> None:
    found = placed({"transform": "rotate(30) scale(2)", "transform-origin": origin}, 200.0, 100.0)
    assert found.point((*at, 0.0)) == pytest.approx((*at, 0.0), abs=1e-12)
    assert found.direction((1.0, 0.0, 0.0)) == pytest.approx((2 * C, 2 * S, 0.0))


def test_without_a_transform_or_an_origin() -> None:
    assert placed({}, 1.0, 1.0) == placed({"transform-origin": "5 5"}, 1.0, 1.0) == IDENTITY
    assert placed({"transform": "scale(2)"}, 9.0, 9.0) == transform("scale(2)")
    for wrong in ({"transform-box": "fill-box"}, {"transform-origin": "1 2 3 4"}, {"transform-origin": "1 x"}):
        with pytest.raises(SvgError):
            placed({"transform": "scale(2)", "transform-origin": "1 2", **wrong}, 1.0, 1.0)


@pytest.mark.parametrize("text", ["0 0 0 5", "0 0 5 0", "1 2 3", "0 0 -5 5", "1 2 3 4 5"])
def test_view_boxes_without_area_are_none(text: str) -> None:
    with pytest.raises(SvgError, match="not four numbers"):
        view_box(text)
    assert view_box(None) is None is view_box(" none ") and view_box("1 2 5e-4 4e-4") == Box(1.0, 2.0, 5e-4, 4e-4)


@pytest.mark.parametrize("x", ["Min", "Mid", "Max"])
@pytest.mark.parametrize("y", ["Min", "Mid", "Max"])
def test_a_view_box_lies_in_its_page_as_it_is_aligned(x: str, y: str) -> None:
    box, share = Box(-3.0, 7.0, 40.0, 10.0), {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    for width, height in ((200.0, 100.0), (30.0, 90.0)):
        for word, pick in (("", min), (" meet", min), (" slice", max)):
            sx, sy, tx, ty = fitted(box, width, height, f"x{x}Y{y}{word}")
            assert sx == sy == pick(width / 40.0, height / 10.0)
            for k, size, page, t in ((0, 40.0, width, tx), (1, 10.0, height, ty)):
                s, low = (sx, sy)[k], (box.x, box.y)[k]
                part = share[(x, y)[k]]
                assert s * (low + part * size) + t == pytest.approx(part * page)  # this point of the box on that of the page
    assert fitted(box, 200.0, 100.0, "none") == (5.0, 10.0, 15.0, -70.0)
    assert fitted(box, 200.0, 100.0, None) == fitted(box, 200.0, 100.0, "") == fitted(box, 200.0, 100.0, "defer xMidYMid meet")
    with pytest.raises(SvgError, match="cannot be read"):
        fitted(box, 1.0, 1.0, "xMid")
