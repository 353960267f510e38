"""Is a Swiss lever drawn as its dimensions say?

What is drawn is measured with shapely, which shares nothing with the drawing.
"""

import cmath
import math
import random
import sys
from pathlib import Path

import pytest
from reference.measure_lever import measure
from scipy.optimize import brentq
from shapely import Polygon
from shapely.affinity import rotate, translate

from watchsim.cli import main
from watchsim.construction.design import drawing_of
from watchsim.construction.registry import design
from watchsim.construction.swiss_lever import drop_after_recoil, sheets, swiss
from watchsim.construction.swiss_lever_outlines import Swiss
from watchsim.designs import Drawn
from watchsim.mechanism.overlap import overlap_faults

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "checks"))

from try_designs import numbers  # noqa: E402

LEVER = design("swiss_lever")
OTHERS = [
    {"lock": 2.0, "draw": 10.0, "run": 0.3, "drop_inside": 0.9, "drop_outside": 1.6, "lift_angle": 46.0, "guard_freedom": 0.6},
    {"teeth": 20, "embraced": 3.5, "tooth_width": 3.4, "drop_inside": 1.0, "lift_on_stone": 5.5},
    {"teeth": 12, "embraced": 1.5, "lever_to_balance": 6.0, "crescent": 26.0, "tip_radius": 3.0},
]


@pytest.mark.parametrize("name", ["escape_wheel", "lever", "roller", "banking"])
def test_the_profile_is_drawn_byte_by_byte(name):
    assert sheets(Swiss())[name].dxf() == (ROOT / "profiles" / "swiss_lever" / f"{name}.dxf").read_bytes()


def checked(chosen, folder):
    values = LEVER.chosen(chosen)
    place = Drawn(LEVER, values).write(folder / "lever")
    entry, exit_, safety = measure(place / "scene.toml", values.teeth)
    for beat in (entry, exit_):
        assert beat.draw == pytest.approx(values.draw, abs=2e-3)
        assert beat.lock == pytest.approx(values.lock, abs=1e-3)
        assert beat.run == pytest.approx(values.run, abs=1e-3)
        assert beat.lift_stone + beat.lift_tooth == pytest.approx(values.lift_on_stone + values.lift_on_tooth, abs=1e-3)
        assert beat.spare_mm > 0.0
    assert entry.drop == pytest.approx(values.drop_inside, abs=1e-3)
    assert exit_.drop == pytest.approx(values.drop_outside, abs=1e-3)
    assert entry.lift_tooth == pytest.approx(values.lift_on_tooth, abs=0.03), "the measurement finds a toe to 0.02°"
    assert safety.lift_angle == pytest.approx(values.lift_angle, abs=2e-3)
    assert safety.guard_freedom == pytest.approx(values.guard_freedom, abs=1e-3)
    assert safety.horn_clearance_mm == pytest.approx(values.horn_clearance, abs=1e-4)
    assert safety.beat_clearance_mm > 0.0


@pytest.mark.slow
def test_dimensions_are_those_measured_from_the_drawing(tmp_path):
    checked(OTHERS[0], tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("chosen", [{}, *OTHERS[1:]], ids=["default", "20 teeth", "12 teeth"])
def test_dimensions_of_other_designs_are_those_measured(chosen, tmp_path):
    checked(chosen, tmp_path)


def test_the_crescent_needed_is_what_the_dart_sweeps_beside_the_jewel(tmp_path, capsys):
    """Jewel and dart turned about the lever's staff as complex numbers; with play, breadth and rounding of the edge."""
    lever = swiss(LEVER.chosen({}))
    staff, farthest = lever.lever_to_balance, 0.0
    for k in range(61):
        a = math.radians(lever.bank * k / 60)
        along = staff * math.cos(a) - math.sqrt(lever.pin_reach**2 - (staff * math.sin(a)) ** 2)
        jewel, dart = (length * cmath.rect(1.0, a) - staff for length in (along, lever.dart_centre))
        if abs(dart) < lever.safety_radius + lever.dart_tip:
            beside = abs(math.degrees(cmath.phase(dart / jewel)))
            farthest = max(farthest, beside + math.degrees((lever.dart_tip + 0.02 * lever.lever_scale) / abs(dart)))
    play = math.degrees((lever.slot_width - 2.0 * lever.pin_radius) / lever.pin_reach)
    assert main(["new", "swiss_lever", "--crescent", "12°", "-o", str(tmp_path / "lever")]) == 2
    assert f"must be at least {farthest + play:.4g}°: the dart enters the roller" in capsys.readouterr().err
    assert not (tmp_path / "lever").exists()


REFUSED = [
    ({"lock": 9.0}, "lock", "must be from 0.1° to 4°"),
    ({"teeth": 15.5}, "teeth", "a whole number from 9 to 30"),
    ({"embraced": 3.0}, "embraced", "a whole number and a half"),
    ({"teeth": 30}, "drop_inside", "leave 0.3° for the stone, which needs 0.8°"),
    ({"draw": 18.0, "undercut": 17.0}, "draw", "must be less than the undercut of the teeth, 17°"),
    ({"guard_freedom": 2.1}, "guard_freedom", "must be less than the total lock, 2°"),
    ({"lift_angle": 75.0, "lever_to_balance": 4.0, "crescent": 12.0}, "crescent", "must be at least"),
    ({"tip_radius": 20.0}, "tip_radius", "must be from 1.09 mm to 5.23 mm"),
    ({"horn_end": 35.0}, "horn_end", "for the horn beside the slot"),
    ({"safety_ratio": 0.5, "lift_on_stone": 9.0, "lift_angle": 75.0}, "safety_ratio", "swings past"),
]


@pytest.mark.parametrize(("chosen", "name", "words"), REFUSED)
def test_impossible_dimensions_are_refused_with_the_reason(chosen, name, words):
    found = LEVER.refusals(chosen)
    assert any(one.dimension == name and words in one.message for one in found), found


WIDE = {  # 11 teeth a wide way apart: between unlocking and drop little room is left
    **{"teeth": 11, "embraced": 2.5, "tooth_width": 4.864, "draw": 14.976, "lever_to_balance": 4.6851, "safety_ratio": 0.69871},
    **{"lift_on_stone": 4.2143, "lift_on_tooth": 2.2595, "jewel_width": 0.38893, "jewel_ground": 0.39509, "crescent": 17.669},
}


@pytest.mark.parametrize(("name", "side"), [("drop_outside", 1), ("drop_inside", -1)], ids=["entry unlocks", "exit unlocks"])
def test_the_recoil_may_not_use_up_the_drop(name, side):
    """Just above the least drop that is accepted nothing overlaps while a stone unlocks, just below it two outlines do."""
    usual = {**WIDE, "drop_inside": 2.0, "drop_outside": 2.0}

    def left(drop):
        return drop_after_recoil(swiss(LEVER.chosen({**usual, name: drop})), side)

    least = brentq(left, 0.2, 2.0, xtol=1e-9)
    for drop, clear in ((least + 0.01, True), (least - 0.01, False)):
        chosen = {**usual, name: drop}
        assert (LEVER.refusals(chosen) == ()) is clear
        assert meet_while_unlocking(chosen, side) is not clear
    (refusal,) = LEVER.refusals({**usual, name: least - 0.01})
    assert refusal.dimension == name
    assert refusal.message.startswith("is 0.01")


def meet_while_unlocking(chosen, side):
    """Do wheel and stones overlap as drawn, the lever at the end of unlocking and the wheel held back by the locking face?"""
    values = LEVER.chosen(chosen)
    design, sheets = swiss(values), LEVER.draw(values)
    (px, py), (cx, cy) = design.lever_pivot, design.in_movement(design.locking_corner(side), side * design.unlocked)
    contour = max((loop for loop in sheets["escape_wheel"].loops if not loop.hole), key=lambda loop: len(loop.edges))
    # The wheel stands a little off the locking corner, the least angle that separates the two for certain.
    wheel = rotate(filled(contour), math.degrees(math.atan2(cy, cx)) + 1e-4, origin=(0.0, 0.0))
    stones = [filled(loop) for loop in sheets["lever"].loops if loop.layer == "STONES"]
    placed = [translate(rotate(stone, side * design.unlocked, origin=(0.0, 0.0)), px, py) for stone in stones]
    return any(wheel.intersection(stone).area > 1e-12 for stone in placed)


def filled(loop):
    """With 200 points an edge, so that chords of the arcs lie within some nanometres."""
    return Polygon([edge.point(part / 200) for edge in loop.edges for part in range(200)])


def test_all_limits_are_checked_at_once():
    assert {one.dimension for one in LEVER.refusals({"lock": 9.0, "draw": 1.0, "run": 50.0})} == {"lock", "draw", "run"}


def test_every_default_lies_within_its_limits_and_is_drawn():
    assert LEVER.refusals({}) == ()
    assert all(one.low <= one.default <= one.high and one.meaning and one.source for one in LEVER.dimensions)


@pytest.mark.parametrize("count", [8, pytest.param(40, marks=pytest.mark.slow)])
def test_random_designs_are_refused_or_sound_and_clear(count):
    chance = random.Random(7)
    accepted = 0
    for _ in range(count):
        chosen = numbers(LEVER, chance)
        refusals = LEVER.refusals(chosen)
        assert all(one.message for one in refusals)
        if not refusals:
            accepted += 1
            assert overlap_faults(Drawn(LEVER, LEVER.chosen(chosen)).scene()) == []
    assert accepted >= count // 5


def test_only_sheets_that_change_are_read_again():
    before = drawing_of.cache_info().misses
    LEVER.refusals({"torque": 1.23})
    LEVER.refusals({"torque": 1.24})
    assert drawing_of.cache_info().misses <= before + 4
    now = drawing_of.cache_info().misses
    LEVER.refusals({"crescent": 23.0})
    assert drawing_of.cache_info().misses == now + 1
