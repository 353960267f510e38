"""Which pieces does the text of a path draw, command by command, and where is a fault in it?"""

from __future__ import annotations

import pytest

from watchsim.drawing.projection import Conic, Shape, Spline, Straight
from watchsim.drawing.svg_shapes import read_path

Point = tuple[float, float]


def line(a: Point, b: Point) -> Straight:
    return Straight((*a, 0.0), (*b, 0.0))


def curve(*points: Point) -> Spline:
    count = len(points)
    return Spline(count - 1, [0.0] * count + [1.0] * count, [(x, y, 0.0) for x, y in points])


A, B, C, D = (1.0, 2.0), (3.0, 7.0), (8.0, 5.0), (9.0, 1.0)
TEXTS: list[tuple[str, list[list[Shape]], list[bool]]] = [
    ("M1 2L3 7", [[line(A, B)]], [False]),
    ("m1 2 2 5 5-2", [[line(A, B), line(B, C)]], [False]),
    ("M1 2 3 7 8 5z", [[line(A, B), line(B, C), line(C, A)]], [True]),
    ("M1 2L3 7 1 2", [[line(A, B), line(B, A)]], [True]),
    ("M1 2L3 7 1 2Z", [[line(A, B), line(B, A)]], [True]),
    ("M1,2 H8 V5 h1 v-4", [[line(A, (8, 2)), line((8, 2), C), line(C, (9, 5)), line((9, 5), D)]], [False]),
    ("M1 2 H3 4", [[line(A, (3, 2)), line((3, 2), (4, 2))]], [False]),
    ("M1 2 C3 7 8 5 9 1", [[curve(A, B, C, D)]], [False]),
    ("M1 2 c2 5 7 3 8-1", [[curve(A, B, C, D)]], [False]),
    ("M1 2 Q3 7 8 5", [[curve(A, B, C)]], [False]),
    ("M1 2 q2 5 7 3", [[curve(A, B, C)]], [False]),
    ("M1 2 C3 7 8 5 9 1 S4 4 5 5", [[curve(A, B, C, D), curve(D, (10, -3), (4, 4), (5, 5))]], [False]),
    ("M1 2 S8 5 9 1", [[curve(A, A, C, D)]], [False]),
    ("M1 2 Q3 7 8 5 S4 4 5 5", [[curve(A, B, C), curve(C, C, (4, 4), (5, 5))]], [False]),
    ("M1 2 Q3 7 8 5 T9 1 4 4", [[curve(A, B, C), curve(C, (13, 3), D), curve(D, (5, -1), (4, 4))]], [False]),
    ("M1 2 C3 7 8 5 9 1 T4 4", [[curve(A, B, C, D), curve(D, D, (4, 4))]], [False]),
    ("M1 2 Q3 7 8 5 L9 1 T4 4", [[curve(A, B, C), line(C, D), curve(D, D, (4, 4))]], [False]),
    ("M1 2 s7 3 8-1 t-5 3", [[curve(A, A, C, D), curve(D, D, (4, 4))]], [False]),
    ("M1 2 C1 2 1 2 1 2", [[line(A, A)]], [True]),
    ("M1 2 L3 7 M8 5 L9 1", [[line(A, B)], [line(C, D)]], [False, False]),
    ("M1 2 L3 7 Z L9 1", [[line(A, B), line(B, A)], [line(A, D)]], [True, False]),
    ("M1 2 L3 7 Z m2 5 l5-2", [[line(A, B), line(B, A)], [line(B, C)]], [True, False]),
    ("M1 2 Z", [[line(A, A)]], [True]),
    ("M1 2", [], []),
    ("M1 2 M3 7", [], []),
    ("M1 2 A5 5 0 0 0 1 2", [], []),
    ("M1 2 A0 5 0 0 0 3 7", [[line(A, B)]], [False]),
    (
        "M0 0L.1.2.3.4-.5-.6",
        [[line((0, 0), (0.1, 0.2)), line((0.1, 0.2), (0.3, 0.4)), line((0.3, 0.4), (-0.5, -0.6))]],
        [False],
    ),
]


@pytest.mark.parametrize(("text", "shapes", "closed"), TEXTS, ids=[text for text, *_ in TEXTS])
def test_a_path_draws_these_pieces(text: str, shapes: list[list[Shape]], closed: list[bool]) -> None:
    for written in (text, f"  {text}\n"):
        found = read_path(written)
        assert found.fault == ""
        assert [row.shapes for row in found.rows] == shapes and [row.closed for row in found.rows] == closed


@pytest.mark.parametrize("text", ["M0 0A5 4 10 1 0 3 7", "M0 0A5 4 10 103 7", "M0 0a-5-4 10 1,0,3,7", "M0 0 A 5,4,10,1 0 3 7"])
def test_flags_need_no_blank_and_radii_no_sign(text: str) -> None:
    (row,) = read_path(text).rows
    (plain,) = read_path("M0 0A5 4 10 1 0 3 7").rows
    assert row == plain and isinstance(row.shapes[0], Conic)


FAULTS = [
    ("L3 7", 0, 'it begins with "L3 7", not with M'),
    ("x M1 2 L3 7", 0, 'it begins with "x M1 2 L3 7", not with M'),
    ("1234567890123456789012345", 0, 'it begins with "12345678901234567890", not with M'),
    ("M1 2 L3", 0, "it ends where L needs a number"),
    ("M1 2 L3 7 8", 1, "it ends where L needs a number"),
    ("M1 2 L3 7 8L9 1", 1, 'character 12 is "L" where L needs a number'),
    ("M1 2 L3 7 8  ?9", 1, 'character 14 is "?9" where L needs a number'),
    ("M1 2 L3 7?8", 1, 'character 10 is "?8" where L needs a number'),
    ("M1 2 L,3 7", 0, 'character 7 is ",3 7" where L needs a number'),
    ("M1 2 L3 7,", 1, 'character 10 is "," where L needs a number'),
    ("M1 2 L3 7 z4", 2, 'character 12 is "4", after a closed outline'),
    ("M1 2 A5 5 0,2 0 3 7", 0, 'character 12 is ",2 0 3 7" where A needs a number'),
    ("M1 2 H", 0, "it ends where H needs a number"),
]


@pytest.mark.parametrize(("text", "count", "fault"), FAULTS, ids=[text for text, *_ in FAULTS])
def test_a_fault_is_told_with_its_place_and_what_stands_before_it_is_drawn(text: str, count: int, fault: str) -> None:
    found = read_path(text)
    assert found.fault == fault and sum(len(row.shapes) for row in found.rows) == count


@pytest.mark.parametrize("size", [1.0, 1e4, 1e-4])
def test_a_remainder_of_rounding_is_no_line_and_a_step_is_one(size: float) -> None:
    """Relative steps that should come back do so up to the last digits of the largest coordinate."""
    for off, lines in ((0.0, 3), (2.0**-52, 3), (2.0**-48, 4)):
        x = size * 0.1
        text = f"M{x!r} 0 L{size!r} 0 L{size!r} {size!r} L{x + off * size!r} 0 Z"
        (row,) = read_path(text).rows
        assert len(row.shapes) == lines and row.closed
