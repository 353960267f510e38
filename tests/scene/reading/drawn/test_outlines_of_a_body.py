"""Which outlines of its drawing does a body get, for what, and which findings of the drawing concern it?"""

from __future__ import annotations

import itertools
from typing import Any

import pytest
from made_scenes import drawing, square

from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY
from watchsim.scene.outlines import Outlines, read_outlines
from watchsim.scene.values import Table

HEAD: dict[str, Any] = {"drawing": "a.dxf", "pivot": "P", "material": {"G": "left"}}
SOLIDS = [
    {"layer": "W", "bores": ["H", "A"]},
    {"layer": "X", "turned": "AXIS"},
    {"layer": "Y", "hairspring": True},
    {"layer": "Z", "hairspring": False},
    {"turned": [[0, 0], [1, 1]]},
    5,
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
