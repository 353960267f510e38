"""Is the geometry of function that of the drawing, whatever the parts are called and however they stand?"""

from __future__ import annotations

import functools
import math
from dataclasses import fields, replace

import measure_lever
import pytest
from escapement.made import mirrored_scene, renamed_scene, swiss_scene, turned_scene
from every_time import few

from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.construction.swiss_lever.swiss_lever_roller import banking
from watchsim.escapement.function_report import text
from watchsim.escapement.measure import Function, measure
from watchsim.escapement.pallets import Pallet
from watchsim.escapement.quantity import Quantity
from watchsim.escapement.safety import Safety
from watchsim.geometry.primitives import Line
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load

SWISS = profiles_dir() / "swiss_lever" / "scene.toml"
BENCH = profiles_dir() / "bench_lever" / "scene.toml"
DESIGNS: dict[str, dict[str, object]] = {
    "as drawn": {},
    "deep lock": {"lock": "2.2°", "run": "0.3°", "draw": "11°"},
    "20 teeth": {"teeth": 20, "embraced": 3.5, "tooth_width": "3.2°", "drop_inside": "0.9°", "drop_outside": "0.9°"},
    "unequal drops": {"drop_inside": "1°", "drop_outside": "1.6°", "lift_angle": "46°", "guard_freedom": "0.9°"},
}


@pytest.fixture(scope="module")
def swiss() -> Function:
    return measure(load(SWISS))


def degrees(one: Quantity) -> float:
    return math.degrees(one.value)


def numbers(function: Function) -> dict[str, float]:
    """Every number in degrees, by stone; the beats of the balance too."""
    assert function.pallets and function.fork and function.safety
    found = {}
    for k, stone in enumerate(("entry", "exit")):
        beat = 0 if function.sides[k] > 0.0 else 1
        for field in fields(Pallet):
            found[f"{stone} {field.name}"] = degrees(getattr(function.pallets[k], field.name))
        for name in ("lift_angle", "unlocking", "impulse_end", "knocking"):
            found[f"{stone} {name}"] = degrees(getattr(function.fork, name)[beat])
        found[f"{stone} from_rest"] = abs(degrees(function.fork.from_rest[beat]))
        for name in ("guard", "horn", "worst"):
            found[f"{stone} {name}"] = degrees(getattr(function.safety[beat], name))
    return found | {"pin_shake": degrees(function.fork.pin_shake)}


@functools.cache
def made(name: str) -> tuple[Swiss, Function]:
    """A design, and what is measured of its drawing."""
    scene, design = swiss_scene(**DESIGNS[name])
    return design, measure(scene)


@pytest.mark.parametrize("name", few(DESIGNS, 2))
def test_measured_is_what_was_chosen(name):
    """The drawing's decimals move what they make by some 1e-8°."""
    design, function = made(name)
    assert function.missing == () and function.teeth == design.teeth
    assert function.pallets and function.banks and function.fork and function.safety
    assert math.degrees(function.banks[0] - function.banks[1]) == pytest.approx(2.0 * design.bank, abs=1e-6)
    told = {key: float(str(value).rstrip("°")) for key, value in DESIGNS[name].items()}
    for one, drop in zip(function.pallets, ("drop_inside", "drop_outside"), strict=True):
        assert degrees(one.lock) == pytest.approx(told.get("lock", 1.5), abs=1e-6)
        assert degrees(one.run) == pytest.approx(told.get("run", 0.5), abs=1e-6)
        assert degrees(one.total_lock) == pytest.approx(told.get("lock", 1.5) + told.get("run", 0.5), abs=1e-6)
        assert degrees(one.lift) == pytest.approx(7.5, abs=1e-6)
        assert degrees(one.lift_stone) + degrees(one.lift_tooth) == pytest.approx(7.5, abs=1e-6)
        assert degrees(one.drop) == pytest.approx(told.get(drop, 1.2), abs=1e-6)
        assert one.lock.spread < 1e-7 and one.drop.spread < 1e-7
    assert degrees(function.pallets[0].lift_stone) == pytest.approx(4.8, abs=1e-6)
    for one in function.fork.lift_angle:
        assert degrees(one) == pytest.approx(told.get("lift_angle", 51.2), abs=1e-6)
    for guard in function.safety:
        assert degrees(guard.guard) == pytest.approx(told.get("guard_freedom", 0.765), abs=1e-6)


@pytest.mark.parametrize("name", DESIGNS)
def test_draw_and_recoil_follow_from_the_construction(name):
    """The face leans by the draw from the radius of the wheel at the corner; the toe stands beside that corner."""
    design, function = made(name)
    assert function.pallets
    for side, one in zip((1, -1), function.pallets, strict=True):
        # At the corner the line to the lever's pivot is square to the radius: the face has turned with the lever since.
        assert degrees(one.draw_end) == pytest.approx(design.draw + side * (design.lock + design.run), abs=1e-6)
        corner = design.in_movement(design.locking_corner(side), side * design.bank)
        towards = math.radians(design.face_direction(side) + side * design.bank)
        x, y = corner
        # Where the face meets the tip circle: |corner + s direction| = R.
        along = x * math.cos(towards) + y * math.sin(towards)
        s = -along + math.sqrt(along**2 - (x * x + y * y) + design.tip_radius**2)
        toe = (x + s * math.cos(towards), y + s * math.sin(towards))
        px, py = design.lever_pivot
        square = math.atan2(toe[1] - py, toe[0] - px) + 0.5 * math.pi
        draw = (math.degrees(towards - square) + 90.0) % 180.0 - 90.0
        assert degrees(one.draw) == pytest.approx(abs(draw), abs=1e-6)
        recoil = 90.0 + side * design.half_span - math.degrees(math.atan2(toe[1], toe[0]))
        assert degrees(one.recoil) == pytest.approx(recoil, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [SWISS, pytest.param(BENCH, marks=pytest.mark.slow)], ids=lambda path: path.parent.name)
def test_turning_polygons_by_small_steps_gives_the_same(scene):
    """scripts/checks/measure_lever.py turns shapely polygons and shares nothing with the package."""
    function = measure(load(scene))
    assert function.pallets and function.fork
    *beats, safety = measure_lever.measure(scene)
    for beat, one, other in zip(beats, function.pallets, function.pallets[::-1], strict=True):
        assert degrees(one.draw) == pytest.approx(beat.draw, abs=2e-4)
        assert degrees(one.total_lock) == pytest.approx(beat.unlock, abs=1e-3)
        assert degrees(one.recoil) == pytest.approx(beat.recoil, abs=1e-3)
        # Which looks in steps of 0.04°.
        assert degrees(one.lift_stone) == pytest.approx(beat.lift_stone, abs=0.045)
        assert degrees(one.lift_tooth) == pytest.approx(beat.lift_tooth, abs=0.045)
        assert degrees(one.drop) == pytest.approx(beat.drop, abs=1e-3)
        assert degrees(other.lock) == pytest.approx(beat.lock, abs=1e-3)
        assert degrees(other.run) == pytest.approx(beat.run, abs=1e-3)
    for one in function.fork.lift_angle:
        assert degrees(one) == pytest.approx(safety.lift_angle, abs=1e-3)
    assert degrees(function.fork.pin_shake) == pytest.approx(safety.fork_play, abs=1e-3)
    if function.safety is None:
        assert math.isnan(safety.guard_freedom)
        return
    for one in function.safety:
        assert degrees(one.guard) == pytest.approx(safety.guard_freedom, abs=1e-3)
        assert 1e3 * one.guard_clearance == pytest.approx(safety.guard_clearance_mm, abs=3e-5)  # chords of 10 nm
        assert degrees(one.worst) >= safety.worst_freedom - 1e-3  # which looks in steps of a degree


@pytest.mark.parametrize(("k", "side"), [(0, 1), (1, -1)])
def test_lift_passes_from_stone_to_tooth_where_polygons_say(swiss, k, side, monkeypatch):
    """Just before, the toe of a tooth touches the stone; just after, it touches nothing."""
    monkeypatch.setattr(measure_lever, "TOE", 1e-4)
    action = measure_lever.Escapement(measure_lever.read_layout(SWISS))
    passage = swiss.passages[k]
    change = side * math.degrees(passage.unlocked.lever) - degrees(swiss.pallets[k].lift_stone)
    wheel = math.degrees(passage.driven[0].last.wheel)
    for beyond, toe in ((-0.002, True), (0.002, False)):
        stone = action.stone(side, change - beyond)
        rest = action.rest(wheel + 0.1, stone, 1.0)
        assert action.at_toe(rest, stone) is toe


def test_the_largest_freedom_is_found_between_the_steps(swiss):
    """As a step of a degree misses it, so a finer one approaches it from below."""
    layout = measure_lever.read_layout(SWISS)
    bank = measure_lever.Escapement(layout).bank(1)
    from measure_lever import Roller

    roller = Roller(layout, bank)
    assert swiss.safety
    one: Safety = swiss.safety[0]
    near = [roller.freedom(math.degrees(one.worst_at) - step) for step in (0.3, 0.1, 0.03, 0.01)]
    assert near == sorted(near) and near[-1] == pytest.approx(degrees(one.worst), abs=2e-3)


@pytest.mark.parametrize("angle", few([0.7, 2.5, -3.0], 1))
def test_any_orientation(swiss, angle):
    function = measure(turned_scene(load(SWISS), angle, (3e-3, -5e-3)))
    assert numbers(function) == pytest.approx(numbers(swiss), abs=1e-6)
    assert function.sides == swiss.sides


def test_the_other_direction_of_rotation(swiss):
    function = measure(turned_scene(mirrored_scene(load(SWISS)), 0.4))
    assert function.parts and function.parts.way == 1.0 and function.sides == (-1.0, 1.0)
    assert numbers(function) == pytest.approx(numbers(swiss), abs=1e-6)


def test_names_do_not_matter(swiss):
    names = {"wheel": "balance", "lever": "wheel", "balance": "Unruh 1", "banking": "lever"}
    function = measure(renamed_scene(load(SWISS), names, {"TEETH": "PINS", "STONES": "0", "FORK": "TEETH", "PINS": "a"}))
    assert function.parts and (function.parts.wheel, function.parts.lever) == ("balance", "wheel")
    assert numbers(function) == pytest.approx(numbers(swiss), abs=1e-6)


def test_a_carried_escapement_is_the_same():
    found = [measure(load(profiles_dir() / name / "scene.toml")) for name in ("bench_lever", "carriage")]
    for field in fields(Pallet):
        one, other = (degrees(getattr(function.pallets[0], field.name)) for function in found if function.pallets)
        assert one == pytest.approx(other, abs=1e-5)


@pytest.mark.parametrize("tooth", few([5, 1, 15], 1))
def test_a_chipped_tooth_is_named(swiss, tooth):
    """A toe that is 10 µm short locks 10 µm less deep, at the radius of the locking; on either stone it is the same tooth."""
    scene = load(SWISS)
    wheel = scene.body("wheel")
    short = 10e-6
    x, y = math.cos((tooth - 1) * math.tau / 15.0), math.sin((tooth - 1) * math.tau / 15.0)
    toe = (2.4e-3 * x, 2.4e-3 * y)

    def chipped(point):
        return (toe[0] - short * x, toe[1] - short * y) if math.dist(point, toe) < 1e-9 else point

    loops = tuple(
        replace(loop, edges=tuple(Line(*chipped(e.start), *chipped(e.end)) if isinstance(e, Line) else e for e in loop.edges))
        for loop in wheel.loops
    )
    bodies = tuple(replace(body, loops=loops) if body is wheel else body for body in scene.bodies)
    function = measure(replace(scene, bodies=bodies))
    assert function.pallets and swiss.pallets
    for one, whole in zip(function.pallets, swiss.pallets, strict=True):
        less = degrees(whole.lock) - math.degrees(one.lock.worst)
        # Tangent locking: the tip circle is square to the line to the lever's pivot, R tan 30° away.
        assert less == pytest.approx(math.degrees(short / (2.4e-3 * math.tan(math.radians(30.0)))), rel=0.02)
        assert one.lock.tooth == tooth and degrees(one.lock) == pytest.approx(degrees(whole.lock) - less / 15.0, abs=1e-6)
    told = "\n".join(text(function))
    assert f"at tooth {tooth} (entry)" in told and f"at tooth {tooth} (exit)" in told and "counted anticlockwise" in told
    assert "counted anticlockwise" not in "\n".join(text(swiss))


@pytest.mark.parametrize("name", ["incline", "balance"])
def test_what_is_no_escapement_is_said(name):
    function = measure(load(profiles_dir() / name / "scene.toml"))
    assert function.pallets is None and function.parts is None
    assert function.missing and "no escapement" in function.missing[0][1]


def test_without_banking_it_is_said(swiss):
    scene = load(SWISS)
    function = measure(replace(scene, contacts=scene.contacts[:3]))
    assert function.pallets is None and "no banking" in function.missing[0][1]


def test_a_lever_that_is_held_too_close_lets_off_nothing():
    """Banking pins drawn for a smaller travel: the tooth is never let off."""
    scene, design = swiss_scene()
    narrow = replace(design, run=-0.6)
    pins = tuple(
        replace(loop, edges=tuple(replace(e, x=1e-3 * e.x, y=1e-3 * e.y, radius=1e-3 * e.radius) for e in loop.edges))
        for loop in banking(narrow)
    )
    changes = {"banking": {"loops": pins}, "lever": {"angle": math.radians(narrow.bank - 0.01)}}
    bodies = tuple(replace(body, **changes.get(body.name, {})) for body in scene.bodies)
    function = measure(replace(scene, bodies=bodies))
    assert function.pallets is None
    assert "before the tooth is let off" in function.missing[0][1]
