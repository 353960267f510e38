"""Which point of a drawing does the text of a pivot mean?"""

from __future__ import annotations

import math
from typing import Any

import pytest
from made_scenes import circle, drawing, square

from watchsim.drawing.drawing import Drawing
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Point
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY
from watchsim.scene.placing import given_pivot, marked_pivot, marks_on
from watchsim.scene.values import Table

BORE = Loop((Arc(2e-3, 1e-3, 0.2e-3, 0.0, -math.tau),), "PLATE", hole=True)
LOOPS = (square(20e-3, layer="PLATE"), BORE, circle(0.3e-3, (5e-3, 1e-3), "STUD"), circle(0.1e-3, (-4e-3, 3e-3), "STUD"))
POINTS = (("AXIS", -1e-3, -2e-3), ("MARK", 3e-3, -6e-3), ("MARK", 7e-3, -6e-3))
DRAWING = drawing("plate.dxf", LOOPS, points=POINTS)


def named(text: object, made: Drawing = DRAWING) -> tuple[Point, list[str]]:
    table = Table({"pivot": text}, "bodies.a", BODY, Faults())
    found = marked_pivot(table, made)
    return found, [fault.message for fault in table.faults.found]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("AXIS", (-1e-3, -2e-3)),
        ("PLATE", (2e-3, 1e-3)),
        ("hole near [1.5 mm, 0.5 mm]", (2e-3, 1e-3)),
        ("hole near [5 mm, 1 mm]", (2e-3, 1e-3)),  # only the bore is a hole of its own layer
        ("circle near [4.5 mm, 1 mm]", (5e-3, 1e-3)),
        ("circle near [1.5 mm, 0.5 mm]", (2e-3, 1e-3)),
        ("circle near [-3000 µm, 0.3 cm]", (-4e-3, 3e-3)),
        ("point near [-1 mm, 0 mm]", (-1e-3, -2e-3)),
        ("point near [8 mm, -6 mm]", (7e-3, -6e-3)),
        ("  point   near[ '8 mm' , \"-6 mm\" ] ", (7e-3, -6e-3)),
    ],
)
def test_a_layer_or_what_is_nearest(text: str, place: Point) -> None:
    assert named(text) == (place, [])


@pytest.mark.parametrize(("x", "clear"), [(4.2, True), (4.34, False), (5.6, False), (5.68, True)])
def test_the_next_one_must_be_twice_as_far(x: float, clear: bool) -> None:
    """The marks lie at 3 mm and 7 mm: twice as far from 4 1/3 mm and from 5 2/3 mm."""
    (px, _), said = named(f"point near [{x} mm, -6 mm]")
    assert (px == (3e-3 if x < 5.0 else 7e-3)) if clear else math.isnan(px)
    words = ["(3.000, -6.000), (7.000, -6.000)" if x < 5.0 else "(7.000, -6.000), (3.000, -6.000)"]
    assert said == ([] if clear else [f"{words[0]} mm are about equally near: give the place more exactly"])


def test_exactly_twice_as_far_is_clear() -> None:
    made = drawing("a.dxf", (), points=(("A", 0.0, 0.0), ("B", 3.0, 0.0)))
    assert named("point near [1 m, 0 m]", made) == ((0.0, 0.0), [])
    assert named("point near [1.001 m, 0 m]", made)[1]


def test_without_holes_every_circle_is_one() -> None:
    made = drawing("a.dxf", (circle(0.3e-3, (5e-3, 1e-3), "BORE"), square(4e-3, layer="PLATE")))
    assert named("hole near [0 mm, 0 mm]", made) == ((5e-3, 1e-3), [])
    square_hole = drawing("a.dxf", (circle(0.3e-3, (5e-3, 1e-3), "BORE"), square(4e-3, layer="PLATE", hole=True)))
    assert named("hole near [0 mm, 0 mm]", square_hole) == ((5e-3, 1e-3), [])


@pytest.mark.parametrize(("apart", "count"), [(0.0, 1), (0.9e-9, 1), (1.1e-9, 2), (-0.9e-9, 1), (-1.1e-9, 2)])
def test_marks_a_nanometre_apart_are_one(apart: float, count: int) -> None:
    made = drawing(
        "a.dxf", (circle(1e-3, (3e-3, 4e-3), "P"), circle(2e-3, (9e-3, 9e-3), "Q")), points=(("P", 3e-3 + apart, 4e-3),)
    )
    assert len(marks_on(made, "P")) == count
    assert marks_on(made, "P")[0] == (3e-3 + apart, 4e-3)
    assert bool(named("P", made)[1]) is (count == 2)


REFUSED: list[tuple[object, str]] = [
    ("MARK", "2 points or circles are on this layer, at (3.000, -6.000), (7.000, -6.000) mm: leave one, or say which"),
    ("STUD", "2 points or circles are on this layer, at (5.000, 1.000), (-4.000, 3.000) mm"),
    ("BODY", "the drawing has no such layer. plate.dxf has PLATE, STUD."),
    ("MARKS", 'the drawing has no such layer. Did you mean "MARK"? plate.dxf has PLATE, STUD.'),
    ("slot near [1 mm, 2 mm]", "write hole, circle or point near a place"),
    ("hole near 1 mm", "write hole, circle or point near a place"),
    ("hole near [1 mm, 2 mm, 3 mm]", "write hole, circle or point near a place"),
    ("hole near [1, 2.5 mm]", 'write pivot = "hole near [1 mm, 2.5 mm]"'),
    ("point near [1 mm, -2e-3]", 'write pivot = "point near [1 mm, -2e-3 mm]"'),
    ("point near [1 s, 2 mm]", "is a time; here a length is needed"),
    ("point near [1 mm, 2 s]", "is a time; here a length is needed"),
]


@pytest.mark.parametrize(("text", "words"), REFUSED)
def test_what_is_not_clear_is_refused_once(text: object, words: str) -> None:
    place, said = named(text)
    assert len(said) == 1 and words in said[0] and all(map(math.isnan, place))


def test_at_most_four_places_are_listed() -> None:
    made = drawing("a.dxf", (), points=tuple(("P", k * 1e-3, 0.0) for k in range(6)))
    (said,) = named("P", made)[1]
    assert "6 points or circles" in said and said.count("(") == 4 and "(3.000, 0.000) mm: leave one" in said


def test_a_layer_without_marks_and_a_drawing_without_anything() -> None:
    made = drawing("a.dxf", (square(1e-3, layer="LEVER"),))
    assert named("LEVER", made)[1] == ["neither a point nor a circle is on this layer"]
    assert named("point near [1 mm, 2 mm]", made)[1] == ["the drawing holds no point"]
    assert named("circle near [1 mm, 2 mm]", made)[1] == ["the drawing holds no circle"]
    assert named("LEVER", drawing("a.dxf"))[1] == ["the drawing has no such layer. a.dxf has no layers with lines."]


def test_a_layer_may_be_called_like_a_place() -> None:
    made = drawing("a.dxf", (), points=(("hole near [1 mm, 2 mm]", 5e-3, 6e-3), ("X", 1e-3, 2e-3)))
    assert named("hole near [1 mm, 2 mm]", made) == ((5e-3, 6e-3), [])


@pytest.mark.parametrize(
    ("mapping", "pivot", "faults"),
    [({}, None, 0), ({"pivot": ["3 mm", "-4 mm"]}, (3e-3, -4e-3), 0), ({"pivot": "AXIS"}, (math.nan, math.nan), 1)],
)
def test_without_a_drawing_a_pivot_is_given_by_coordinates(mapping: dict[str, Any], pivot: Point | None, faults: int) -> None:
    table = Table(mapping, "bodies.a", BODY, Faults())
    assert given_pivot(table) == (pivot if pivot is None else pytest.approx(pivot, abs=0.0, nan_ok=True))
    assert len(table.faults.found) == faults
