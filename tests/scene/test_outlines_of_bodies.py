"""Which outlines of its drawing does a body get, for what, and which findings of the drawing concern it?"""

import cmath
import itertools
import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely
from made_scenes import circle, drawing, square

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY
from watchsim.scene.outlines import Outlines, first_crossing, read_outlines, signed_area
from watchsim.scene.placing import adjusted, lines_near, part_near, parts_of
from watchsim.scene.toml import key_lines, tomllib
from watchsim.scene.values import Table

HEAD: dict[str, Any] = {"drawing": "a.dxf", "pivot": "P", "material": {"G": "left"}}
SOLIDS = [
    *({"layer": "W", "bores": ["H", "A"]}, {"layer": "X", "turned": "AXIS"}, {"layer": "Y", "hairspring": True}),
    *({"layer": "Z", "hairspring": False}, {"turned": [[0, 0], [1, 1]]}, 5),
]
LAYERS = ("A", "B", "G", "H", "W", "X", "Y", "Z", "P")
CLOSED = tuple(square(1e-3, (3e-3 * k, 1e-3), layer) for k, layer in enumerate(LAYERS) if layer != "G")
CHAINS = tuple(Loop((Line(k, 7e-3, k, 9e-3),), layer, closed=False) for k, layer in enumerate(("G", "K", "AXIS", "X")))


def read(desk: Any, mapping: dict[str, Any], *findings: Finding) -> tuple[Outlines, list[str]]:
    layers = (*LAYERS, "K", "AXIS")
    desk.put(drawing("a.dxf", CLOSED, open_chains=CHAINS, layers=layers, points=(("P", 1.0, 2.0),), findings=findings))
    table = Table({**HEAD, **mapping}, "bodies.a", BODY, Faults(), "fixed")
    found = read_outlines(table, desk.folder, {})
    return found, [f"{fault.key.removeprefix('bodies.a.')}{fault.shown}: {fault.message}" for fault in table.faults.found]


def names(loops: tuple[Loop, ...] | None) -> str:
    return "-" if loops is None else "".join(loop.layer for loop in loops)


@pytest.mark.parametrize(
    ("more", "loops", "rest", "aside", "bores", "drawn"),
    [
        ({}, "ABHWXYZG", "P", "", "", "-"),
        ({"solids": SOLIDS}, "BWZG", "P", "XY", "AH", "-"),
        ({"layers": ["A", "G"]}, "AG", "BHWXYZP", "", "", "-"),
        ({"layers": ["A", "G"], "solids": SOLIDS}, "AG", "BWZP", "XY", "H", "-"),
        ({"layers": ["A", "G", "H", "X"], "solids": SOLIDS}, "AHXG", "BWZP", "Y", "", "-"),
        ({"layers": ["A", "G"], "draw": ["B", "P"]}, "AG", "BHWXYZP", "", "", "BP"),
        ({"layers": ["B", "G"], "solids": [{"bores": ["X"], "layer": "X"}]}, "BG", "AHWXYZP", "", "", "-"),
    ],
)
def test_every_layer_has_its_place(
    desk: Any, more: dict[str, Any], loops: str, rest: str, aside: str, bores: str, drawn: str
) -> None:
    found, said = read(desk, more)
    got = tuple(map(names, (found.loops, found.rest, found.aside, found.bores, found.drawn)))
    assert not said and got == (loops, rest, aside, bores, drawn)
    assert names(found.chains) == "GKAXISX" and set(found.all) == {*found.loops, *found.rest, *found.aside, *found.bores}


OUTCOMES = {  # (layers are chosen, layer, code) -> what becomes of an error, a warning and a notice
    (True, "A", "gap"): "fault warning notice",
    (True, "A", "crossing"): "fault warning notice",
    (True, "A", "open-outline"): "fault warning notice",
    (True, "B", "gap"): "nothing nothing nothing",
    (True, "B", "crossing"): "warning warning notice",
    (True, "P", "gap"): "nothing nothing nothing",
    (True, "P", "crossing"): "warning warning notice",
    (True, "W", "gap"): "fault warning notice",
    (True, "W", "crossing"): "fault warning notice",
    (True, "H", "gap"): "fault warning notice",
    (True, "X", "gap"): "nothing nothing nothing",
    (True, "X", "crossing"): "nothing nothing nothing",
    (True, "AXIS", "open-outline"): "nothing nothing nothing",
    (True, "G", "gap"): "fault warning notice",
    (True, "G", "open-outline"): "nothing nothing nothing",
    (True, "G", "stray-line"): "nothing nothing nothing",
    (True, "G", "crossing"): "fault fault fault",
    (True, None, "gap"): "fault warning notice",
    (False, "B", "gap"): "fault warning notice",
    (False, "B", "crossing"): "fault warning notice",
    (False, "K", "stray-line"): "fault warning notice",
    (False, "P", "gap"): "nothing nothing nothing",
    (False, "P", "crossing"): "warning warning notice",
    (False, "X", "gap"): "nothing nothing nothing",
    (False, "G", "open-outline"): "nothing nothing nothing",
    (False, "G", "crossing"): "fault fault fault",
    (False, None, "gap"): "fault warning notice",
}
CASES = [
    (*key, severity, outcome)
    for key, outcomes in OUTCOMES.items()
    for severity, outcome in zip(("error", "warning", "notice"), outcomes.split(), strict=True)
]


@pytest.mark.parametrize(("chosen", "layer", "code", "severity", "outcome"), CASES)
def test_what_becomes_of_a_finding(desk: Any, chosen: bool, layer: str | None, code: str, severity: str, outcome: str) -> None:
    finding = Finding(code, severity, "it is so.", 'Set units = "mm" (or "inch").', layer, 3.0, 4.0)
    found, said = read(desk, {"solids": SOLIDS, **({"layers": ["A", "G"]} if chosen else {})}, finding)
    faults = [one for one in said if "it is so" in one]
    assert found.sound is not bool(said)
    if outcome == "fault":
        place = "drawing -> a.dxf" + (f", layer {layer}" if layer else "")
        advice = " If it is to stay open: material" if code in ("open-outline", "stray-line") else ""
        assert faults[0].startswith(f'{place}: it is so. Set units = "mm" (or "inch") under [bodies.a].{advice}')
        assert faults[0].endswith(").") is bool(advice) and not found.findings
    else:
        assert not faults
        assert [(one.severity, one.message, one.layer) for one in found.findings] == (
            [] if outcome == "nothing" else [(outcome, "a.dxf: it is so.", layer)]
        )
    assert [one.layer for one in found.errors] == ([layer] if severity == "error" and layer in ("X", "AXIS") else [])


MISTAKES: list[tuple[dict[str, Any], list[str]]] = [
    ({"layers": ["A", "Q"]}, ['layers.1 = "Q": the drawing has no such layer. a.dxf has A, B']),
    ({"layers": ["a"]}, ['layers.0 = "a": the drawing has no such layer. Did you mean "A"? a.dxf has']),
    (
        {"layers": ["K"]},
        ["layers.0 -> a.dxf, layer K: there is no closed outline on this layer. Its lines are open: close them"],
    ),
    ({"layers": ["AXIS", "Q"]}, ["layers.0 -> a.dxf, layer AXIS: there is no closed", 'layers.1 = "Q": the drawing has no']),
    ({"layers": ["A"], "draw": ["Q"]}, ['draw.0 = "Q": the drawing has no such layer.']),
    ({"layers": ["A"], "draw": ["B", "A"]}, ['draw.1 = "A": this layer can touch, and is drawn anyway']),
    ({"layers": ["A"], "draw": ["K"]}, ["draw.0: there is no closed outline on this layer, and open lines"]),
    ({"drawing": "b.dxf"}, ['drawing = "b.dxf": there is no such file. Did you mean "a.dxf"? (looked for']),
    ({"drawing": "x/b.dxf"}, ['drawing = "x/b.dxf": there is no such file, nor the folder']),
    ({"drawing": "zzzzzz"}, ['drawing = "zzzzzz": there is no such file. Known here: a.dxf, wheel.dxf (looked for']),
    ({"drawing": ""}, ['drawing = "": the name of a drawing is needed here: a.dxf, wheel.dxf']),
    ({"drawing": 3}, ["drawing = 3: a text in quotes is needed here"]),
    ({"snap": "0 mm"}, ['snap = "0 mm": must be above zero: it is the gap that may be closed']),
    ({"circle": "1 mm"}, ["circle: a body has one outline: leave out circle or drawing"]),
    (
        {"line": [], "circle": "1 mm"},
        ["circle: a body has one outline", "line: a body has one outline: leave out line or draw"],
    ),
]


@pytest.mark.parametrize(("mapping", "expected"), MISTAKES)
def test_every_mistake_is_said_once(desk: Any, mapping: dict[str, Any], expected: list[str]) -> None:
    keys = {"material": {"G": "left"}} if mapping.get("layers") is None else {"material": {}}
    found, said = read(desk, {**mapping, **keys, "pivot": ["1 mm", "2 mm"]})
    assert len(said) == len(expected) and all(one.startswith(words) for one, words in zip(said, expected, strict=True)), said
    if "drawing" in mapping or "snap" in mapping:
        assert found.pivot == (1e-3, 2e-3) and found.loops == () and not found.sound


def test_a_layer_that_is_broken_is_told_once(desk: Any) -> None:
    gap = Finding("gap", "error", "it is so", "", "K")
    said = read(desk, {"layers": ["K"], "material": {}}, gap)[1]
    assert said == ["drawing -> a.dxf, layer K: it is so."]


@pytest.mark.parametrize(("open_lines", "broken"), list(itertools.product((False, True), (False, True))))
def test_a_drawing_without_closed_outlines(desk: Any, open_lines: bool, broken: bool) -> None:
    findings = (Finding("gap", "error" if broken else "warning", "it is so", "", None),)
    desk.put(drawing("a.dxf", (), open_chains=CHAINS if open_lines else (), findings=findings))
    table = Table({"drawing": "a.dxf"}, "bodies.a", BODY, Faults(), "fixed")
    read_outlines(table, desk.folder, {})
    (fault,) = table.faults.found
    assert ("it is so" in fault.message) is broken
    assert fault.message.startswith("it holds no closed outline.") is not broken
    assert ("Its lines are open: say where" in fault.message) is (open_lines and not broken)


@pytest.mark.parametrize("key", ["layers", "draw", "units", "snap", "material", "adjust"])
def test_what_belongs_to_a_drawing(desk: Any, key: str) -> None:
    """It does nothing to a written shape; without any outline it is left to what is said of that."""
    for shape, count in (({"circle": "1 mm"}, 1), ({}, 0)):
        table = Table({**shape, key: "x"}, "bodies.a", BODY, Faults(), "fixed")
        found = read_outlines(table, desk.folder, {})
        assert len(table.faults.found) == count and len(found.loops) == count
        if count:
            assert table.faults.found[0].message == "belongs to a drawing; this body is a circle"


def test_a_snap_is_handed_on_and_the_reader_s_own_is_the_default(desk: Any) -> None:
    read(desk, {})
    read(desk, {"snap": "3 µm", "units": "inch"})
    assert [asked[1:] for asked in desk.asked] == [(None, 1e-6), ("inch", 3e-6)]


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


def square_parts_near(x: float, y: float, half: float, hole: bool = False) -> Loop:
    corners = [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)]
    corners = corners[::-1] if hole else corners
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), hole=hole)


def circle_parts_near(x: float, y: float, radius: float, hole: bool = False) -> Loop:
    return Loop((Arc(x, y, radius, 0.0, -math.tau if hole else math.tau),), hole=hole)


OPEN = Loop((Line(-9.0, -9.0, 9.0, -9.0), Line(9.0, -9.0, 9.0, 9.0), Line(9.0, 9.0, -9.0, 9.0)), closed=False)


def test_holes_go_with_the_smallest_outline_around_them() -> None:
    """Not with open lines about them; a hole with nothing around it stands alone."""
    large, small = square_parts_near(0.0, 0.0, 4.0), square_parts_near(2.0, 0.0, 1.0)
    inner, outer = circle_parts_near(2.0, 0.0, 0.5, True), circle_parts_near(-2.0, 0.0, 0.5, True)
    far = square_parts_near(20.0, 0.0, 1.0, True)
    loops = [OPEN, inner, large, outer, small, far]
    assert sorted(parts_of(loops)) == [(0,), (2, 3), (4, 1), (5,)]
    assert sorted(parts_of([*loops, circle_parts_near(2.0, 0.7, 0.1, True)])) == [(0,), (2, 3), (4, 1, 6), (5,)]


@pytest.mark.parametrize("order", [1, -1])
def test_the_part_that_holds_the_place_or_is_nearest(order: int) -> None:
    """Clearly so where the next one is more than twice as far."""
    left, right = square_parts_near(-2.0, 0.0, 1.0), circle_parts_near(2.0, 0.0, 1.0)
    loops, chosen = [left, right][::order], [0, 1][::order]
    assert part_near(loops, (-1.5, 0.5)) == ((chosen[0],), True) and part_near(loops, (2.5, 0.0)) == ((chosen[1],), True)
    # Between -1 and 1 lies nothing: 0.6 from the one and 1.4 from the other, 0.7 and 1.3.
    assert part_near(loops, (-0.4, 0.0)) == ((chosen[0],), True) and part_near(loops, (0.4, 0.0)) == ((chosen[1],), True)
    assert part_near(loops, (-0.3, 0.0)) == ((chosen[0],), False)
    assert part_near([left], (9.0, 9.0)) == ((0,), True) and part_near([], (0.0, 0.0)) == ((), False)


def test_within_open_lines_nothing_is() -> None:
    """They are as near as their edges."""
    assert part_near([OPEN, square_parts_near(0.0, 0.0, 1.0)], (0.0, 3.0)) == ((1,), True)
    assert part_near([OPEN, square_parts_near(0.0, 0.0, 1.0)], (0.0, 8.5)) == ((0,), True)


@pytest.mark.parametrize(("aside", "count"), [(0.0, 2), (0.9e-8, 2), (1.1e-8, 1), (-0.9e-8, 2), (-1.1e-8, 1)])
def test_edges_that_a_place_cannot_tell_apart(aside: float, count: int) -> None:
    """On the diagonal of a corner both are equally near; from beside it, one is nearer by so much."""
    found = lines_near([square_parts_near(0.0, 0.0, 1.0), circle_parts_near(0.9, 0.9, 0.05)], (0.9 + aside, 0.9))
    assert len(found) == count
    nearest, fraction = found[0] if aside >= 0.0 or count == 2 else found[-1]
    assert fraction == pytest.approx(0.95 if nearest.start[0] == nearest.end[0] else 0.05, abs=1e-6)
    (bottom,) = lines_near([square_parts_near(0.0, 0.0, 1.0)], (-0.5, -2.0))
    assert bottom[0].start == (-1.0, -1.0) and bottom[1] == pytest.approx(0.25)


TEXT = '''\
# a comment with [brackets] and "quotes
top = 1
[scene]
title = "a # no comment" # a comment
"quoted key" = """
several [lines]
of = text
"""
[bodies.wheel]
position = [
  "1 mm",   # first
  "2 mm",
]
nested.key = 2
[[springs]]
body = 'balance'
[[springs]]
frequency = "4 Hz"
[[bodies.wheel.solids]]
layer = "A"
[[bodies.wheel.solids]]
layer = "B"
[expect]
"amplitude" = { value = "275°", tolerance = "1°" }
polygon = [["1 mm", "2 mm"],
           ["3 mm", "4 mm"]]
number = -1.5e-3
'''


def test_lines_of_all_kinds_of_keys():
    lines = key_lines(TEXT)
    expected = {
        **{"top": 2, "scene": 3, "scene.title": 4, "scene.quoted key": 5, "bodies.wheel": 9, "bodies.wheel.position": 10},
        **{"bodies.wheel.position.0": 11, "bodies.wheel.position.1": 12, "bodies.wheel.nested.key": 14, "springs": 15},
        **{"springs.0": 15, "springs.0.body": 16, "springs.1": 17, "springs.1.frequency": 18},
        **{"bodies.wheel.solids.0.layer": 20, "bodies.wheel.solids.1.layer": 22, "expect.amplitude": 24},
        **{"expect.amplitude.tolerance": 24, "expect.polygon.0": 25, "expect.polygon.1": 26, "expect.polygon.1.0": 26},
        "expect.number": 27,
    }
    assert {key: lines.get(key) for key in expected} == expected


def test_every_key_of_the_parsed_text_is_located():
    lines = key_lines(TEXT)

    def keys(value, path):
        if isinstance(value, dict):
            return [path, *(k for key, item in value.items() for k in keys(item, f"{path}.{key}" if path else key))]
        if isinstance(value, list):
            return [path, *(k for i, item in enumerate(value) for k in keys(item, f"{path}.{i}"))]
        return [path]

    missing = [key for key in keys(tomllib.loads(TEXT), "") if key and key not in lines]
    assert missing == ["bodies", "bodies.wheel.nested"]


def folds_back(points: list[tuple[int, int]]) -> bool:
    """A side that returns on its neighbour: no crossing of two sides that are no neighbours."""
    ways = np.diff(np.array([*points, *points[:2]]), axis=0)
    return any(a[0] * b[1] == a[1] * b[0] and a @ b < 0 for a, b in pairwise(ways))


def test_it_is_found_where_sides_meet_and_nowhere_else() -> None:
    rng = np.random.default_rng(5)
    simple = crossed = touched = 0
    while min(simple, crossed, touched) < 30:
        points = [(int(x), int(y)) for x, y in rng.integers(0, 5, (rng.integers(3, 7), 2))]
        if len(set(points)) < len(points) or folds_back(points):
            continue
        found = first_crossing(points)
        assert (found is None) == shapely.LinearRing(points).is_simple, points
        if found is None:
            simple += 1
            continue
        sides = [shapely.LineString([points[i], points[(i + 1) % len(points)]]) for i in found]
        assert sides[0].intersects(sides[1]), points
        crossed, touched = crossed + sides[0].crosses(sides[1]), touched + sides[0].touches(sides[1])


def test_areas_have_the_sign_of_their_way_round() -> None:
    """Against shapely, wherever the polygon lies."""
    rng = np.random.default_rng(3)
    for _ in range(200):
        points = [(float(x), float(y)) for x, y in rng.normal(size=(int(rng.integers(3, 8)), 2)) + rng.normal(size=2)]
        shape = shapely.Polygon(points)
        ring = shapely.LinearRing(points)
        if ring.is_simple:
            assert signed_area(points) == pytest.approx(shape.area * (1.0 if ring.is_ccw else -1.0), rel=1e-9)
            assert signed_area(points[::-1]) == pytest.approx(-signed_area(points), rel=1e-9)
