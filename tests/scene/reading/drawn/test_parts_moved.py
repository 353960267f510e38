"""Where do the outlines of a drawing lie once `adjust` has turned and shifted them? Against complex numbers."""

from __future__ import annotations

import cmath
import math
from typing import Any

import pytest
from made_scenes import circle, drawing, square

from watchsim.drawing.drawing import Drawing
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY
from watchsim.scene.placing import adjusted
from watchsim.scene.values import Table

LEFT, RIGHT = (-3e-3, 2e-3), (5e-3, -1e-3)
HOLE = square(0.4e-3, (5.2e-3, -1.1e-3), "S", hole=True)
CHAIN = Loop((Line(1e-3, 7e-3, 2e-3, 9e-3), Line(2e-3, 9e-3, 6e-3, 8e-3)), "S", closed=False)
OTHER = Loop((Line(8e-3, 7e-3, 9e-3, 9e-3),), "T", closed=False)
DRAWING = drawing(
    "a.dxf",
    [square(1e-3, LEFT, "S"), circle(0.3e-3, (4e-3, 6e-3), "T"), square(2e-3, RIGHT, "S"), HOLE],
    open_chains=(OTHER, CHAIN),
    points=(("S", 7e-3, 3e-3), ("P", 0.5e-3, -2.5e-3), ("Q", 1e-3, 1e-3), ("Q", 1e-3, 2e-3)),
)


def moved(entry: Any, layer: str = "S", **body: Any) -> tuple[Drawing, list[str]]:
    table = Table({"adjust": {layer: entry}, **body}, "bodies.a", BODY, Faults())
    found = adjusted(table, DRAWING)
    return found, [f"{fault.key.removeprefix('bodies.a.adjust.')}: {fault.message}" for fault in table.faults.found]


def corners(made: Drawing) -> list[list[complex]]:
    """Of all outlines and chains; of a circle its centre."""
    loops = (*made.loops, *made.open_chains)
    return [
        [complex(*edge.start) if isinstance(edge, Line) else complex(edge.x, edge.y) for edge in loop.edges] for loop in loops
    ]


def expected(ways: dict[int, tuple[complex, float, complex]]) -> list[list[complex]]:
    """The corners with some outlines turned about a place by an angle and then shifted."""
    found = corners(DRAWING)
    for k, (place, angle, shift) in ways.items():
        found[k] = [place + (z - place) * cmath.exp(1j * angle) + shift for z in found[k]]
    return found


def same(found: Drawing, ways: dict[int, tuple[complex, float, complex]]) -> bool:
    one, other = corners(found), expected(ways)
    return all(
        abs(a - b) < 1e-15 for mine, theirs in zip(one, other, strict=True) for a, b in zip(mine, theirs, strict=True)
    ) and [loop.layer for loop in (*found.loops, *found.open_chains)] == ["S", "T", "S", "S", "T", "S"]


def test_all_outlines_chains_and_points_of_a_layer_go_together() -> None:
    """About the centroid of what is closed, less the hole in it, where no place is given."""
    found, said = moved({"turn": "0.3 rad", "shift": ["4 µm", "-7 µm"]})
    areas = {LEFT: 1.0, RIGHT: 4.0, (5.2e-3, -1.1e-3): -0.16}
    centre = sum(area * complex(*place) for place, area in areas.items()) / sum(areas.values())
    way = (centre, 0.3, 4e-6 - 7e-6j)
    assert not said and same(found, dict.fromkeys((0, 2, 3, 5), way))
    z = centre + (7e-3 + 3e-3j - centre) * cmath.exp(0.3j) + 4e-6 - 7e-6j
    assert found.points[0] == ("S", pytest.approx(z.real, abs=1e-15), pytest.approx(z.imag, abs=1e-15))
    assert found.points[1:] == DRAWING.points[1:]


def test_open_lines_turn_about_the_middle_of_their_extent() -> None:
    found, said = moved({"turn": "-0.4 rad", "near": ["3 mm", "8.9 mm"]})
    assert not said and same(found, {5: (3.5e-3 + 8e-3j, -0.4, 0j)}) and found.points == DRAWING.points


@pytest.mark.parametrize(("about", "place"), [("P", 0.5e-3 - 2.5e-3j), (["-2 mm", "3 mm"], -2e-3 + 3e-3j), ("T", 4e-3 + 6e-3j)])
def test_about_a_point_a_circle_or_coordinates(about: Any, place: complex) -> None:
    found, said = moved({"turn": "0.2 rad", "about": about, "near": ["-3 mm", "2.1 mm"]})
    assert not said and same(found, {0: (place, 0.2, 0j)})


def test_a_part_moves_with_its_hole_away_from_a_place() -> None:
    """Each part along the line from that place to its own centre."""
    found, said = moved({"radial": "9 µm", "about": ["1 mm", "-4 mm"]})
    right = (4.0 * complex(*RIGHT) - 0.16 * (5.2e-3 - 1.1e-3j)) / 3.84
    ways: dict[int, tuple[complex, float, complex]] = {}
    for numbers, centre in (((0,), complex(*LEFT)), ((2, 3), right), ((5,), 3.5e-3 + 8e-3j)):
        away = centre - (1e-3 - 4e-3j)
        ways |= dict.fromkeys(numbers, (0j, 0.0, 9e-6 * away / abs(away)))
    assert not said and same(found, ways)


@pytest.mark.parametrize(("pivot", "place"), [("P", 0.5e-3 - 2.5e-3j), (["-2 mm", "3 mm"], -2e-3 + 3e-3j)])
def test_without_a_place_the_radius_is_that_from_the_pivot(pivot: Any, place: complex) -> None:
    found, said = moved({"radial": "-9 µm", "near": ["-3 mm", "2.1 mm"]}, pivot=pivot)
    away = complex(*LEFT) - place
    assert not said and same(found, {0: (0j, 0.0, -9e-6 * away / abs(away))})


@pytest.mark.parametrize(("face", "way"), [((1.4, 7.8), -1.0), ((1.6, 8.2), 1.0), ((3.0, 8.75), -1.0), ((5.0, 8.25), 1.0)])
def test_along_an_edge_towards_the_end_that_is_nearer(face: tuple[float, float], way: float) -> None:
    entry = {"near": ["3 mm", "8.9 mm"], "along": "6 µm", "face": [f"{face[0]} mm", f"{face[1]} mm"], "shift": ["1 µm", "2 µm"]}
    found, said = moved(entry)
    edge = CHAIN.edges[0 if face[0] < 2.0 else 1]
    along = complex(*edge.end) - complex(*edge.start)
    assert not said and same(found, {5: (0j, 0.0, 1e-6 + 2e-6j + way * 6e-6 * along / abs(along))})


def test_of_several_entries_each_sees_the_drawing_as_it_was() -> None:
    """The second does not look for its outline where the first one has put it."""
    near = ["-3 mm", "2.1 mm"]
    found, said = moved([{"near": near, "shift": ["7 mm", "1 mm"]}, {"near": near, "turn": "0.1 rad", "about": "P"}])
    turned = (0.5e-3 - 2.5e-3j, 0.1, (7e-3 + 1e-3j) * cmath.exp(0.1j))
    assert not said and same(found, {0: turned})


REFUSED: list[tuple[Any, str]] = [
    ({"turn": "0.2 mm"}, "S.turn: "),
    ({"tilt": "0.2 rad"}, "S.tilt: unknown key"),
    (3, "S: a table of keys is needed"),
    ({"near": ["0.7 mm", "0.6 mm"], "turn": "1°"}, "S.near: two outlines of this layer are about equally near"),
    ({"near": ["1 mm", 3], "turn": "1°"}, "S.near.1: a bare number"),
    ({"about": "Q", "turn": "1°"}, "S.about: 2 points or circles are on this layer: give coordinates"),
    ({"about": "X", "turn": "1°"}, "S.about: neither a point nor a circle"),
    ({"radial": "1 µm"}, "S.radial: away from where?"),
    ({"radial": "1 µm", "near": ["-3 mm", "2 mm"], "about": ["-3 mm", "2 mm"]}, "S.radial: away from where?"),
    ({"along": "1 µm"}, "S.along: belongs together with face"),
    ({"face": ["1 mm", "1 mm"]}, "S.face: belongs together with along"),
    ({"along": "1 µm", "face": ["2 mm", "9.1 mm"], "near": ["3 mm", "8.9 mm"]}, "S.face: two edges meet there"),
    ({"along": "1 µm", "face": ["-3 mm", "1.4 mm"], "near": ["-3 mm", "2 mm"]}, "S.face: lies in the middle of the edge"),
    ({"near": ["-3 mm", "2 mm"], "shift": ["7 mm", "-2 mm"]}, "S: moved so far, its outlines cross at ("),
    ([{"turn": "1°"}, {"turn": "1 mm"}], "S.1.turn: "),
]


@pytest.mark.parametrize(("entry", "words"), REFUSED)
def test_what_cannot_be_done_is_said_once(entry: Any, words: str) -> None:
    found, said = moved(entry)
    assert len(said) == 1 and said[0].startswith(words)
    if not isinstance(entry, list) and not words.startswith(("S: moved", "S.radial")):
        assert same(found, {})


def test_an_arc_has_no_straight_edge() -> None:
    assert moved({"along": "1 µm", "face": ["4 mm", "6 mm"], "near": ["4 mm", "6 mm"]}, "T")[1] == [
        "T.face: the part has no straight edge"
    ]


def test_a_pivot_that_is_no_place_says_no_direction() -> None:
    for pivot in ("Q", "X"):
        assert moved({"radial": "1 µm"}, pivot=pivot)[1][0].startswith("S.radial: away from where?")


def test_layers_without_outlines_are_named() -> None:
    """Points alone are no outlines; chains are."""
    assert moved({"turn": "1°"}, "P")[1] == ["P: the drawing has no outlines on such a layer. Known here: S, T."]
    assert moved({"turn": "1°"}, "s")[1] == ['s: the drawing has no outlines on such a layer. Did you mean "S"?']
    table = Table({"adjust": 3}, "bodies.a", BODY, Faults())
    assert adjusted(table, DRAWING) is DRAWING and len(table.faults.found) == 1
    assert adjusted(Table({}, "bodies.a", BODY, Faults()), DRAWING) is DRAWING


def test_places_of_crossings_are_in_millimetres() -> None:
    """The square of 1 mm, shifted so that its right lower corner lies in the larger one's left upper corner."""
    _, said = moved({"near": ["-3 mm", "2 mm"], "shift": ["6.6 mm", "-1.8 mm"]})
    (words,) = said
    x, y = (float(part) for part in words.partition("at (")[2].partition(")")[0].split(","))
    assert (x, y) in ((pytest.approx(4.0), pytest.approx(-0.3)), (pytest.approx(4.1), pytest.approx(0.0)))
    assert math.isfinite(x)
