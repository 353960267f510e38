"""Does no bore pass in silence: neither one that is forgotten nor one that takes nothing out?"""

from __future__ import annotations

import json
import math

import pytest
from made_scenes import circle, drawing, square

from watchsim.mechanism.check import check_report, check_text
from watchsim.scene.load import load

PLATE = 'layer = "LEVER"\nthickness = "0.2 mm"\ndensity = "8 g/cm³"\n'
HEAD = 'drawing = "lever.dxf"\nlayers = ["LEVER"]\npivot = "PIVOT"\n'
WHOLE, BORE = 8000 * 0.2e-3 * 16e-6, 8000 * 0.2e-3 * math.pi * 0.25e-6  # kg
BORES = (circle(0.5e-3, (1e-3, 0.0), "LEVER_BORE"), circle(0.5e-3, (-1e-3, 0.0), "LEVER_BORE"))


def put(desk, *loops) -> None:
    desk.put(drawing("lever.dxf", [square(4e-3, layer="LEVER"), *loops], points=(("PIVOT", 0.0, 0.0),)))


def lever(desk, *solids: str, head: str = HEAD, more: str = ""):
    entries = "".join(f"[[bodies.lever.solids]]\n{solid}" for solid in solids)
    return load(desk.scene(f"[bodies.lever]\n{head}{entries}{more}"))


def notices(scene) -> list[tuple[str, str]]:
    return [(finding.message, finding.fix) for finding in scene.findings if finding.code == "bore"]


def test_a_forgotten_layer_is_told_with_its_mass_and_the_line_to_add(desk) -> None:
    put(desk, *BORES)
    scene = lever(desk, PLATE)
    ((message, fix),) = notices(scene)
    assert message == "lever: not taken out of the plate LEVER: 2 bores of LEVER_BORE lying in it"
    assert 'Write bores = ["LEVER_BORE"] beside its thickness: 25.6 mg become 23.0867 mg' in fix
    by_hand = (1e6 * WHOLE, 1e6 * (WHOLE - 2 * BORE))
    assert by_hand == pytest.approx((25.6, 23.0867), abs=5e-5)
    told = lever(desk, PLATE + 'bores = ["LEVER_BORE"]\n')
    assert told.body("lever").mass == pytest.approx(WHOLE - 2 * BORE, rel=1e-12) and not notices(told)
    assert f"notice: {message}. {fix}" in check_text(check_report(scene, ()), scene)


def test_an_empty_list_says_that_the_plate_is_whole(desk) -> None:
    put(desk, *BORES)
    scene = lever(desk, PLATE + "bores = []\n")
    assert scene.body("lever").mass == pytest.approx(WHOLE, rel=1e-12) and not notices(scene)


def test_the_line_to_add_keeps_what_is_named_already(desk) -> None:
    put(desk, BORES[0], circle(0.2e-3, (1e-3, 1e-3), "SLOT"), circle(0.1e-3, (0.0, -1e-3), "PIN_HOLE"))
    ((message, fix),) = notices(lever(desk, PLATE + 'bores = ["SLOT"]\n'))
    assert "2 bores of LEVER_BORE, PIN_HOLE lying in it" in message
    assert 'bores = ["SLOT", "LEVER_BORE", "PIN_HOLE"]' in fix


def test_marks_outlines_beside_and_holes_in_holes_are_not_told(desk) -> None:
    hole = square(1e-3, (1e-3, 1e-3), "LEVER", hole=True)
    put(desk, hole, circle(0.2e-3, (1e-3, 1e-3), "BORE"), circle(0.1e-3, layer="PIVOT"), circle(1e-3, (9e-3, 0.0), "BORES"))
    assert not notices(lever(desk, PLATE))


def test_a_plate_of_all_that_touches_must_not_weigh_its_bores(desk) -> None:
    put(desk, *BORES)
    bare = PLATE.replace('layer = "LEVER"\n', "")
    scene = lever(desk, bare, head=HEAD.replace('["LEVER"]', '["LEVER", "LEVER_BORE"]'))
    assert scene.body("lever").mass == pytest.approx(WHOLE + 2 * BORE, rel=1e-12, abs=0.0)
    ((message, fix),) = notices(scene)
    assert "counted as material of the plate: 2 bores of LEVER_BORE" in message
    assert fix.startswith("Take LEVER_BORE out of layers and write") and "28.1133 mg become 23.0867 mg" in fix
    scene = lever(desk, bare, head=HEAD.replace('layers = ["LEVER"]\n', ""))
    assert notices(scene)[0][1].startswith('Write bores = ["LEVER_BORE"]')
    scene = scene.set("bodies.lever.solids.0.bores", ["LEVER_BORE"])
    assert scene.body("lever").mass == pytest.approx(WHOLE - 2 * BORE, rel=1e-12)


def test_a_bore_across_the_outline_is_told_with_its_place(desk) -> None:
    put(desk, circle(0.5e-3, (2e-3, 0.0), "BORE"))
    ((message, fix),) = notices(lever(desk, PLATE))
    assert "the bore at (2, 0) mm of layer BORE lies across an outline of the plate LEVER" in message
    assert fix == "Draw what is missing there in the outline itself."


def test_named_bores_that_take_nothing_out_are_told(desk) -> None:
    hole = square(1e-3, (1e-3, 1e-3), "LEVER", hole=True)
    more = (circle(0.2e-3, (1e-3, 1e-3), "X"), circle(0.2e-3, (5e-3, 0.0), "X"), circle(0.1e-3, (-1e-3, 0.0), "X"))
    put(desk, hole, circle(0.4e-3, (-1e-3, 0.0), "X"), *more)
    scene = lever(desk, PLATE + 'bores = ["X"]\n')
    assert scene.body("lever").mass == pytest.approx(8000 * 0.2e-3 * (15e-6 - math.pi * 0.16e-6), rel=1e-12, abs=0.0)
    assert [message for message, _ in notices(scene)] == [
        "lever: the bore at (1, 1) mm of layer X lies in a hole that is drawn already",
        "lever: the bore at (5, 0) mm of layer X lies outside of every plate that names it",
        "lever: the bore at (-1, 0) mm of layer X lies in another bore, taken out with it",
    ]


def test_one_layer_of_bores_may_serve_several_plates(desk) -> None:
    put(desk, *BORES, square(4e-3, (8e-3, 0.0), "COVER"), circle(0.3e-3, (8e-3, 0.0), "LEVER_BORE"))
    line = 'bores = ["LEVER_BORE"]\n'
    scene = lever(desk, PLATE + line, PLATE.replace("LEVER", "COVER") + line)
    assert [len(solid.drilled) for solid in scene.body("lever").solids] == [2, 1] and not notices(scene)


def test_what_another_body_of_the_drawing_names_is_not_told(desk) -> None:
    put(desk, square(8e-3, layer="WHEEL"), *BORES)
    other = f"[bodies.wheel]\n{HEAD.replace('LEVER', 'WHEEL')}[[bodies.wheel.solids]]\n{PLATE.replace('LEVER', 'WHEEL')}"
    assert [message[:6] for message, _ in notices(lever(desk, PLATE, more=other))] == ["lever:", "wheel:"]
    scene = lever(desk, PLATE + 'bores = ["LEVER_BORE"]\n', more=other)
    assert not notices(scene)
    assert {loop.layer for loop in scene.body("lever").decoration} == {"LEVER_BORE"}
    assert not scene.body("wheel").decoration


def test_a_bore_that_can_be_touched_is_told(desk) -> None:
    put(desk, *BORES)
    scene = lever(desk, PLATE + 'bores = ["LEVER_BORE"]\n', head=HEAD.replace('["LEVER"]', '["LEVER", "LEVER_BORE"]'))
    (finding,) = scene.findings
    assert finding.severity == "warning" and "can be touched as if it were filled" in finding.message
    filled = PLATE.replace("LEVER", "LEVER_BORE")
    head = HEAD.replace('["LEVER"]', '["LEVER", "LEVER_BORE"]')
    assert not lever(desk, PLATE + 'bores = ["LEVER_BORE"]\n', filled, head=head).findings


def test_a_mass_spread_over_outlines_is_told(desk) -> None:
    put(desk, *BORES)
    ((message, fix),) = notices(lever(desk, head=HEAD + 'mass = "1 mg"\n'))
    assert "2 bores of LEVER_BORE lying in them count as filled" in message and "Give solids" in fix
    ((message, _),) = notices(lever(desk, head=HEAD.replace('layers = ["LEVER"]', 'mass = "1 mg"')))
    assert "count as one more part" in message
    assert not notices(lever(desk, head=HEAD + 'mass = "1 mg"\ninertia = "1 mg·cm²"\n'))


def test_check_names_the_bores_of_a_plate(desk) -> None:
    put(desk, *BORES)
    scene = lever(desk, PLATE + 'bores = ["LEVER_BORE"]\n')
    report = check_report(scene, ())
    (solid,) = report["bodies"]["lever"]["solids"]
    assert solid["bores"] == ["LEVER_BORE"] and solid["mass_kg"] == pytest.approx(WHOLE - 2 * BORE, rel=1e-12)
    json.dumps(report)
    assert "plate of 0.2 mm less 2 bores" in check_text(report, scene)
