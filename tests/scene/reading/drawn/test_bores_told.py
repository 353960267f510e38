"""Where are bores that a designer should know of, how much do they weigh, and whose are they?"""

from __future__ import annotations

from typing import Any

import pytest
from made_scenes import circle, drawing, square

from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY
from watchsim.scene.outlines import Outlines
from watchsim.scene.read_bodies import read_bodies
from watchsim.scene.read_bores import bore_notices, uniform_notices
from watchsim.scene.read_solids import read_solids
from watchsim.scene.solids import Weight
from watchsim.scene.values import Table

PLATE = {"layer": "P", "thickness": "0.2 mm", "density": "8 g/cm³"}
HOLE = Loop(square(1e-3, (2e-3, -3e-3), "BORE").reversed().edges, "BORE")  # drawn the other way round
RINGS = (circle(0.5e-3, (-3e-3, 4e-3), "SLOTS"), circle(0.2e-3, (4e-3, 3e-3), "DRILL"))
MORE = (circle(0.4e-3, (0.0, 20e-3), "SLOTS"), circle(0.3e-3, (30e-3, 5e-3), "SLOTS"))


def told(
    entry: dict[str, Any], *rest: Loop, touching: tuple[Loop, ...] = (), elsewhere: frozenset[str] = frozenset()
) -> tuple[Finding, ...]:
    outlines = Outlines((square(20e-3, layer="P"), *touching), rest)
    table = Table(
        {"solids": [{**PLATE, **entry}], "layers": ["P", *(loop.layer for loop in touching)]}, "bodies.b", BODY, Faults()
    )
    solids = read_solids(table, outlines)
    assert not table.faults.found
    return bore_notices(table, outlines, solids, elsewhere)


def test_what_is_forgotten_is_weighed_whichever_way_it_was_drawn() -> None:
    """400 mm² of 0.2 mm are 640 mg; a square bore of 1 mm² and a round one of 0.126 mm² take 1.6 mg and 0.2 mg away."""
    (one,) = told({}, HOLE, RINGS[1])
    assert one.message == "b: not taken out of the plate P: 2 bores of BORE, DRILL lying in it"
    assert 'Write bores = ["BORE", "DRILL"] beside its thickness: 640 mg become 638.199 mg.' in one.fix
    assert (one.x_mm, one.y_mm, one.layer, one.severity) == (pytest.approx(2.0), pytest.approx(-3.0), "BORE", "notice")
    (two,) = told({"bores": ["SLOTS"]}, RINGS[0], HOLE)
    assert 'Write bores = ["SLOTS", "BORE"] beside its thickness: 638.743 mg become 637.143 mg.' in two.fix
    (three,) = told({"count": 3, "layer": "Q"}, square(20e-3, layer="Q"), HOLE)
    assert "1920 mg become 1915.2 mg." in three.fix


def test_what_is_idle_and_what_can_be_touched_is_told_with_its_place() -> None:
    idle = told({"bores": ["SLOTS"]}, RINGS[0], *MORE)
    assert [(one.x_mm, one.y_mm) for one in idle] == [pytest.approx((0.0, 20.0)), pytest.approx((30.0, 5.0))]
    assert all("outside of every plate that names it" in one.message for one in idle)
    assert told({"bores": ["SLOTS"]}, RINGS[0]) == ()
    (touched,) = told({"bores": ["SLOTS"]}, touching=(circle(0.1e-3, (9e-3, 9e-3), "T"), RINGS[0]))
    assert (touched.layer, touched.severity, touched.x_mm, touched.y_mm) == (
        "SLOTS",
        "warning",
        pytest.approx(-3.0),
        pytest.approx(4.0),
    )
    assert "layer SLOTS is taken out as a bore, but can be touched" in touched.message


def test_what_another_body_takes_out_is_its_own() -> None:
    assert told({}, HOLE, elsewhere=frozenset({"BORE"})) == () and len(told({}, HOLE, elsewhere=frozenset({"DRILL"}))) == 1
    assert told({"bores": []}, HOLE) == ()


def test_a_mass_alone_is_spread_over_what_touches() -> None:
    outlines = Outlines((square(20e-3, layer="P"),), (HOLE, *RINGS))
    table = Table({"mass": "1 g"}, "bodies.b", BODY, Faults())
    (one,) = uniform_notices(table, outlines, Weight(1e-3, (0.0, 0.0), 1e-9), frozenset())
    assert one.message == (
        "b: its mass is spread evenly over its outlines, and 2 bores of BORE, DRILL lying in them count as filled"
    )
    assert (one.x_mm, one.y_mm) == (pytest.approx(2.0), pytest.approx(-3.0))
    assert uniform_notices(table, outlines, Weight(1e-3, (0.0, 0.0), 1e-9), frozenset({"BORE", "DRILL"})) == ()
    both = Outlines((square(20e-3, layer="P"), HOLE), ())
    assert (
        "1 bore of BORE lying in them count as one more part"
        in uniform_notices(table, both, Weight(1e-3, (0.0, 0.0), 1e-9), frozenset())[0].message
    )


@pytest.mark.parametrize(
    ("first", "second", "file", "told_of"),
    [
        ([], ["BORE"], "plate.dxf", []),
        (None, ["BORE"], "plate.dxf", []),
        (None, None, "plate.dxf", ["a", "b"]),
        (["BORE"], None, "plate.dxf", []),
        (["BORE"], ["BORE"], "plate.dxf", []),
        (None, ["BORE"], "copy.dxf", ["a"]),
    ],
)
def test_bores_belong_to_the_bodies_of_one_drawing(desk: Any, first: Any, second: Any, file: str, told_of: list[str]) -> None:
    """A body that names them itself, or another one of the same drawing."""
    for name in ("plate.dxf", "copy.dxf"):
        desk.put(drawing(name, (square(20e-3, layer="P"), square(10e-3, layer="Q"), HOLE)))

    def body(layer: str, bores: Any, path: str) -> dict[str, Any]:
        solid = {**PLATE, "layer": layer, **({} if bores is None else {"bores": bores})}
        return {"drawing": path, "layers": [layer], "pivot": ["0 mm", "0 mm"], "solids": [solid]}

    found = read_bodies({"a": body("P", first, "plate.dxf"), "b": body("Q", second, file)}, desk.folder, Faults())
    assert [one.message[0] for one in found.findings if one.code == "bore"] == told_of
    assert sorted(found.drawings) == sorted({"plate.dxf", file}) and found.sound == {"a", "b"}
