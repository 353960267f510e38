"""Does the check echo what the scene amounts to, in the fixed names?"""

import dataclasses
import json

import pytest

from watchsim.mechanism.pair_table import PairCount
from watchsim.mechanism.static_check import _poise_lines, check_report, check_text
from watchsim.scene.file.load import load
from watchsim.scene.oscillation import loads

PAIRS = (PairCount(("wheel", "lever"), 120, 17, 3, 5, 2),)


def test_report(desk):
    report = check_report(load(desk.scene()), PAIRS)
    assert set(report) == {"bodies", "theory", "pairs", "statics", "findings"}
    assert report["bodies"]["lever"] == {
        "mass_kg": 0.0,
        "inertia_kg_m2": pytest.approx(3e-12),
        "position_m": [0.0, 0.009],
        "coordinates": 1,
        "centre_of_mass_m": [0.0, 0.0],
        "solids": [],
        "driven": False,
    }
    assert report["bodies"]["banking"]["coordinates"] == 0
    assert report["theory"] == {"frequency_hz": pytest.approx(4.0, rel=1e-15), "vph": pytest.approx(28800.0, rel=1e-15)}
    assert {name: report["pairs"][name] for name in ("declared", "reachable", "typical")} == {
        "declared": 120,
        "reachable": 17,
        "typical": 3,
    }
    (finding,) = report["findings"]
    assert set(finding) == {"code", "severity", "layer", "x_mm", "y_mm", "message", "fix"}
    json.dumps(report)


def test_no_oscillator(desk):
    report = check_report(load(desk.scene('[bodies.a]\ninertia = "1 g·cm²"\n')), PAIRS)
    assert report["theory"] == {"frequency_hz": None, "vph": None}


def test_overlaps_are_findings(desk, good):
    report = check_report(load(desk.scene(good.replace('["0 mm", "9 mm"]', '["0 mm", "4 mm"]'))), PAIRS)
    found = [finding for finding in report["findings"] if finding["code"] == "overlap"]
    assert [finding["severity"] for finding in found] == ["error"]
    assert "wheel and lever overlap by" in found[0]["message"]


def test_gravity_on_a_body_without_mass_is_mentioned(desk, good):
    text = good.replace("[scene]", '[scene]\ngravity = ["0 m/s²", "-9.81 m/s²"]').replace(
        'circle = "0.2 mm"', 'circle = "0.2 mm"\nmass = "1 mg"'
    )
    poised = [
        finding["message"] for finding in check_report(load(desk.scene(text)), PAIRS)["findings"] if finding["code"] == "poised"
    ]
    assert [message.split()[0] for message in poised] == ["wheel", "lever"]


def test_text_for_people(desk):
    scene = load(desk.scene())
    text = check_text(check_report(scene, PAIRS), scene)
    assert text.startswith("Small lever\n")
    for part in (
        "inertia 12 mg·cm²",
        "10 mm × 10 mm",
        "turned by -270°",
        "centre distance wheel - lever: 9 mm",
        "4 Hz = 28800 vph",
        "drive on wheel: -1 µN·m",
        "Q = 250",
        "contact wheel.TEETH - lever: friction 0.12, restitution 0.2",
        "wheel - lever                   120               17                      3",
        "warning: wheel.dxf: an edge was drawn twice.",
    ):
        assert part in text, part
    assert "nothing overlaps at the start" in text


def test_a_mass_is_told_where_there_is_one(desk, good):
    weighed = good.replace('circle = "0.2 mm"', 'circle = "0.2 mm"\nmass = "1 mg"')
    bare, told = (
        check_text(check_report(scene, PAIRS), scene) for scene in (load(desk.scene(text)) for text in (good, weighed))
    )
    assert "mass" not in bare
    assert told.count("mass 1 mg") == 1


def test_what_is_carried_is_weighed_with_its_carrier_however_light(desk):
    """A balance of 40 mg on a carriage: together 140 mg, and what turns with the carriage is its inertia and m r²."""
    text = '[bodies.carriage]\nmass = "100 mg"\ninertia = "30 mg·cm²"\n[bodies.balance]\non = "carriage"\n'
    text += 'position = ["5 mm", "0 mm"]\nmass = "40 mg"\ninertia = "12 mg·cm²"\n'
    scene = load(desk.scene(text))
    words = check_text(check_report(scene, ()), scene)
    assert "with balance: mass 140 mg, inertia 40 mg·cm²" in words


@pytest.mark.parametrize(("metres", "told"), [(4e-12, False), (6e-12, True), (1e-8, True)])
def test_a_centre_of_mass_off_the_pivot_by_rounding_is_not_told(desk, metres, told):
    """A thousand millionth of half of 10 mm."""
    scene = load(desk.scene())
    wheel = dataclasses.replace(scene.body("wheel"), mass=1e-6, centre_of_mass=(0.0, metres))
    assert any("beside the pivot" in line for line in _poise_lines(scene, wheel, loads((wheel,))[1][0])) is told
