"""Is the geometry of function of a co-axial escapement that of its construction, and what turning it by hand shows?"""

from __future__ import annotations

import math
from dataclasses import fields, replace

import pytest
from escapement.made import mirrored_scene, renamed_scene, turned_scene
from every_time import few

from watchsim.construction import known
from watchsim.construction.coaxial.coaxial_points import Points
from watchsim.designs import Maker
from watchsim.escapement.function_report import statics, text
from watchsim.escapement.impulses import Impulse
from watchsim.escapement.measure import Function, measure
from watchsim.escapement.pallets import Pallet
from watchsim.escapement.rules import judgements
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.turning.happenings import happenings
from watchsim.turning.turn import turn

PROFILE = profiles_dir() / "coaxial" / "scene.toml"
DESIGNS: dict[str, dict[str, object]] = {
    "as drawn": {},
    "another reach": {"direct_reach": "9°", "stone_ratio": 0.5, "stone_lag": "4°", "lift_angle": "42°"},
    "deep lock": {"lock": "2°", "lift": "8.5°", "draw": "11°", "indirect_offset": "0.2°"},
}


@pytest.fixture(scope="module")
def coaxial() -> Function:
    return measure(load(PROFILE))


def numbers(function: Function) -> dict[str, float]:
    """Every number in degrees, by stone."""
    assert function.pallets and function.fork and function.safety and function.impulses
    found: dict[str, float] = {}
    for k, stone in enumerate(("entry", "exit")):
        beat = 0 if function.sides[k] > 0.0 else 1
        groups = (function.pallets[k], Pallet), (function.impulses[beat], Impulse)
        for values, kind in groups:
            found |= {
                f"{stone} {one.name}": math.degrees(getattr(values, one.name).value)
                for one in fields(kind)
                if one.name != "kind"
            }
        for name in ("lift_angle", "unlocking", "impulse_end", "knocking"):
            found[f"{stone} {name}"] = math.degrees(getattr(function.fork, name)[beat].value)
        for name in ("guard", "horn", "worst"):
            found[f"{stone} {name}"] = math.degrees(getattr(function.safety[beat], name).value)
    return found


@pytest.mark.parametrize("name", few(DESIGNS, 1))
def test_measured_is_what_was_constructed(name):
    drawn = Maker(known.design("coaxial"))(**DESIGNS[name])
    points, function = Points(drawn.values), measure(drawn.scene())
    assert function.missing == () and function.teeth == 8 and function.sides == (1.0, -1.0)
    values, got = drawn.values, numbers(function)
    for stone, side in (("entry", 1), ("exit", -1)):
        assert got[f"{stone} total_lock"] == pytest.approx(values.lock + values.run, abs=1e-6)
        # At the corner the line to the lever's pivot is square to the radius; the face has turned with the lever since.
        assert got[f"{stone} draw_end"] == pytest.approx(values.draw + side * (values.lock + values.run), abs=1e-6)
        waiting = values.direct_lead + values.direct_reach if side > 0 else values.indirect_lead + values.indirect_reach
        assert got[f"{stone} catch_up"] + got[f"{stone} wheel"] == pytest.approx(waiting, abs=1e-6)
        # Lock and run are read where the lever has been left: the total is the drawing's.
        assert got[f"{stone} lock"] + got[f"{stone} run"] == pytest.approx(values.lock + values.run, abs=1e-6)
    assert function.impulses and [one.kind for one in function.impulses] == ["direct", "indirect"]
    assert got["entry ends"] == pytest.approx(points.direct_balance + values.stone_lag, abs=1e-6)
    assert got["exit lift"] == pytest.approx(points.unlocked + values.indirect_offset + values.indirect_lever, abs=1e-6)
    for stone in ("entry", "exit"):
        assert -got[f"{stone} begins"] == pytest.approx(got[f"{stone} lift_angle"] / 2.0 - got[f"{stone} unlocking"], abs=1e-6)


@pytest.mark.slow
def test_turning_by_hand_shows_the_same(coaxial):
    """`check --turn` leads the balance by small steps and knows nothing of gap functions."""
    scene = load(PROFILE)
    found = turn(scene, math.radians(60.0))
    names, rows = found.names, found.cycle.rows
    lever, balance, wheel = (names.index(name) for name in ("lever", "balance", "wheel"))
    stories = happenings(found)

    def places(kind: str, layer: str) -> list[tuple[float, ...]]:
        couples = found.cycle.assembly.couples
        return [
            tuple(math.degrees(rows[one.row][i]) for i in (lever, balance, wheel))
            for one in stories
            if one.kind == kind and one.couple is not None and layer in couples[one.couple].layers
        ]

    got = numbers(coaxial)
    ((_, end, _),) = places("leaves", "IMPULSE_STONE")[:1]
    assert end == pytest.approx(got["entry ends"], abs=2e-3)
    unlocked = places("leaves", "LOCKING_STONES")
    assert sorted(abs(lever) for lever, _, _ in unlocked) == pytest.approx([3.375, 3.375], abs=2e-3)
    assert sorted(balance for _, balance, _ in unlocked) == pytest.approx([got["entry begins"], -got["exit begins"]], abs=2e-3)
    drops = sorted(math.degrees(leap.way) for leap in found.cycle.leaps if leap.row >= found.first)
    assert drops[:2] == pytest.approx(sorted((got["entry drop"], got["exit drop"])), abs=3e-3)
    assert drops[2] == pytest.approx(got["entry catch_up"], abs=3e-3)
    recoils = sorted(math.degrees(one.way) for one in stories if one.kind == "back")
    assert recoils == pytest.approx(sorted((got["entry recoil"], got["exit recoil"])), abs=2e-3)


@pytest.mark.parametrize("angle", few([0.7, -3.0], 1))
def test_any_orientation(coaxial, angle):
    function = measure(turned_scene(load(PROFILE), angle, (3e-3, -5e-3)))
    assert numbers(function) == pytest.approx(numbers(coaxial), abs=1e-6, nan_ok=True)
    assert function.sides == coaxial.sides


def test_the_other_direction_of_rotation(coaxial):
    function = measure(turned_scene(mirrored_scene(load(PROFILE)), 0.4))
    assert function.parts and function.parts.way == 1.0 and function.sides == (-1.0, 1.0)
    assert numbers(function) == pytest.approx(numbers(coaxial), abs=1e-6, nan_ok=True)


@pytest.mark.slow
def test_names_do_not_matter(coaxial):
    names = {"wheel": "balance", "lever": "wheel", "balance": "Unruh 1", "banking": "lever"}
    layers = {"LOCKING_STONES": "PIN", "SMALL_TEETH": "1", "IMPULSE_STONE": "FORK", "FORK": "a", "PIN": "b"}
    function = measure(renamed_scene(load(PROFILE), names, layers))
    assert numbers(function) == pytest.approx(numbers(coaxial), abs=1e-6, nan_ok=True)


def test_what_is_reported(coaxial):
    found = statics(coaxial)
    assert found["entry"]["impulse"] == "direct" and found["exit"]["impulse"] == "indirect"
    assert found["entry"]["impulse_lever_deg"] is None
    assert found["exit"]["impulse_lever_deg"] == pytest.approx(8.375, abs=1e-6)
    assert any("direct" in line and "indirect" in line for line in text(coaxial))
    assert judgements(load(PROFILE), coaxial) == ()


def test_a_wheel_that_passes_under_the_roller_stone_runs_free():
    """The stone half a turn away, nothing catches the wheel once the first locking stone has let go."""
    scene = load(PROFILE)
    body = scene.body("balance")
    loops = tuple(loop.moved(math.pi, (0.0, 0.0)) if loop.layer == "IMPULSE_STONE" else loop for loop in body.loops)
    bodies = tuple(replace(one, loops=loops) if one is body else one for one in scene.bodies)
    function = measure(replace(scene, bodies=bodies))
    assert function.pallets is None and function.impulses is None
    assert "runs free" in function.missing[0][1] or "trips" in function.missing[0][1]
