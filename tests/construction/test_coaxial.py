"""Is a co-axial escapement drawn as its dimensions say, and does it run?"""

import dataclasses
import math
import random
from pathlib import Path

import pytest

import watchsim as ws
from watchsim.construction import registry
from watchsim.construction.coaxial import Coaxial, Points, guard_freedom, locking_stone, roller_stone, sheets
from watchsim.construction.design import Design
from watchsim.construction.registry import design
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read_data, read_sheet
from watchsim.scene.designed import designed
from watchsim.simulation.state import EventKind

ROOT = Path(__file__).resolve().parents[2]
COAXIAL = design("coaxial")


@pytest.mark.parametrize("name", ["escape_wheel", "lever", "roller", "banking"])
def test_the_profile_is_drawn_byte_by_byte(name):
    assert sheets(Coaxial())[name].dxf() == (ROOT / "profiles" / "coaxial" / f"{name}.dxf").read_bytes()


def test_both_lockings_push_through_the_pivot():
    points = Points(Coaxial())
    for side in (1, -1):
        x, y = points.in_movement(points.locking_corner(side), side * points.unlocked)
        assert math.hypot(x, y) == pytest.approx(2.25)
        px, py = points.lever_pivot
        assert x * (px - x) + y * (py - y) == pytest.approx(0.0, abs=1e-12), (
            "radius and the way to the pivot are at right angles"
        )


def test_circles_overlap_as_far_as_asked():
    """The tip of the stone, turned to the end of its overlap, stands on the tip circle."""
    points = Points(Coaxial())
    tip = roller_stone(points).tip
    angle = math.radians(points.direct_balance + Coaxial().stone_lag)
    x, y = (math.cos(angle) * tip[0] - math.sin(angle) * tip[1], math.sin(angle) * tip[0] + math.cos(angle) * tip[1])
    assert math.dist((x, y), (-points.balance_pivot[0], -points.balance_pivot[1])) == pytest.approx(2.25)


def test_a_locking_stone_lets_the_tip_pass_behind_its_corner():
    points = Points(Coaxial())
    for side in (1, -1):
        stone = locking_stone(points, side)
        x, y = points.in_movement(stone.at(stone.relief, stone.width), side * points.unlocked)
        assert math.hypot(x, y) > 2.25


def test_the_guard_is_free_by_less_than_the_lock():
    assert 0.2 < guard_freedom(Points(Coaxial())) < Coaxial().lock


@pytest.mark.parametrize(
    ("chosen", "blamed"),
    [
        ({"friction": 0.25}, "draw"),
        ({"undercut": 18.0, "draw": 16.0}, "undercut"),
        ({"direct_reach": 10.5, "direct_lead": 10.9}, "direct_reach"),
        ({"stone_lag": 12.0}, "stone_lag"),
        ({"indirect_reach": 11.0}, "indirect_reach"),
        ({"indirect_lever": 3.5}, "indirect_lever"),
        ({"indirect_offset": 2.0}, "indirect_lever"),
        ({"guard_clearance": 0.06, "lock": 0.75}, "guard_clearance"),
        ({"tip_radius": 9.0}, "tip_radius"),
    ],
)
def test_conflicts_name_what_to_change_first(chosen, blamed):
    assert blamed in [one.dimension for one in COAXIAL.refusals(chosen)]


def impulses(run):
    """Oscillations, those with a touch of wheel and roller stone, and those with one of small wheel and lever stone."""
    events = run.events
    closing = events[events["kind"] == EventKind.CLOSE]
    period = 2.0 / 7.0
    number = (closing["t"] / period).astype(int)
    pairs = [run.pairs[k] if k >= 0 else None for k in closing["contact"].tolist()]
    direct = {n for n, pair in zip(number, pairs, strict=True) if pair and {pair.body_a, pair.body_b} == {"wheel", "balance"}}
    small = {n for n, pair in zip(number, pairs, strict=True) if pair and "SMALL_TEETH" in (pair.layer_a, pair.layer_b)}
    whole = set(range(int(run.simulated / period + 1e-6)))
    return whole, direct & whole, small & whole


def checked(duration, start):
    scene = ws.load(ROOT / "profiles" / "coaxial").set("bodies.balance.angle", f"{-start}°")
    run = ws.simulate(scene, duration=duration, record="events")
    whole, direct, small = impulses(run)
    assert direct == whole
    assert small == whole
    column = run.slices["wheel"].start
    turned = run.end_q[column] - math.radians(math.degrees(scene.body("wheel").angle))
    assert -turned / (math.tau / 8.0) == pytest.approx(len(whole), abs=1e-3)
    assert abs(run.energy["residual_relative"]) < 1e-9
    assert run.worst_penetration < 1e-9
    return ws.summary(run)


@pytest.mark.parametrize("start", [150.0, 330.0])
def test_one_tooth_and_two_impulses_in_each_oscillation(start):
    checked(2.0, start)


@pytest.mark.slow
def test_three_minutes_from_both_ends_come_to_the_same():
    low, high = checked(180.0, 150.0), checked(180.0, 330.0)
    assert low["amplitude_deg"] == pytest.approx(high["amplitude_deg"], abs=1e-3)
    assert low["rate_s_per_d"] == pytest.approx(high["rate_s_per_d"], abs=0.01)


@pytest.mark.slow
def test_time_stepping_comes_to_the_same_amplitude():
    """Worst beat of a second; over 4 s, and for other steps, see docs/guide/coaxial.md."""
    scene = ws.load(ROOT / "profiles" / "coaxial").set("bodies.balance.angle", "-289.9°")
    true = ws.beats(ws.simulate(scene, duration=1.0, tolerance=1e-11, record="all")).amplitude_deg
    twin = ws.beats(ws.simulate(scene, duration=1.0, method="moreau", step=2.5e-7, record="all")).amplitude_deg
    assert abs(twin - true).max() < 1e-3


# A design's sheet is read without the detour by its DXF file: nothing may differ but the handles in the names of entities.


def without_handles(drawing: Drawing) -> Drawing:
    findings = tuple(dataclasses.replace(one, message=one.message.split("#")[0], fix="") for one in drawing.findings)
    return dataclasses.replace(drawing, findings=findings)


def drawn_at_random(design: Design, seed: int) -> dict[str, float]:
    chance = random.Random(f"{design.name}{seed}")
    share = 0.001 * seed
    return {
        one.name: one.default * (1.0 + share * chance.uniform(-1.0, 1.0))
        for one in design.dimensions
        if not one.count and one.name != "embraced"  # a whole number and a half
    }


@pytest.mark.parametrize("name", registry.names())
def test_a_sheet_gives_what_its_file_gives(name: str) -> None:
    design = designed(name)
    for seed in range(3):
        chosen = drawn_at_random(design, seed)
        assert not design.refusals(chosen)
        for file, sheet in design.sheets(design.chosen(chosen)).items():
            direct, read = read_sheet(sheet, Path(file)), read_data(sheet.dxf(), Path(file))
            assert without_handles(direct) == without_handles(read)
            assert direct.loops
