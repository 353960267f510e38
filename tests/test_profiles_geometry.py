"""Are the profiles drawn as they claim: units, outlines, lock, lift, drop, draw, freedoms, and a start that is clear?

The parts are turned against one another with shapely (tests/reference/measure_lever.py), which shares nothing with the
simulation.
"""

import json
import math
import sys
from pathlib import Path

import ezdxf
import pytest
import shapely
from reference import incline_closed_form as incline
from reference.measure_lever import measure, placed, read_layout, tomllib
from scipy.optimize import brentq
from shapely.affinity import rotate
from strangers import PIN_LEVER, needs, pin_lever_scene
from strangers import SCENES as SCENES_BESIDE

ROOT = Path(__file__).resolve().parents[1]
PROFILES = ROOT / "profiles"
sys.path.insert(0, str(ROOT / "scripts"))

import draw_profiles  # noqa: E402

from watchsim.construction.swiss_lever_outlines import Swiss  # noqa: E402

BENCH = SCENES_BESIDE / "bench_lever.json"


@pytest.fixture(scope="module")
def swiss():
    return measure(PROFILES / "swiss_lever" / "scene.toml")


def entities(path: Path) -> list[tuple[str, str, list[float]]]:
    """Type, layer and numbers of every entity of a drawing."""
    found = []
    for entity in ezdxf.readfile(path).modelspace():
        numbers: list[float] = []
        for name in ("location", "start", "end", "center"):
            if entity.dxf.hasattr(name):
                numbers += list(entity.dxf.get(name))
        numbers += [entity.dxf.get(name) for name in ("radius", "start_angle", "end_angle") if entity.dxf.hasattr(name)]
        if entity.dxftype() == "LWPOLYLINE":
            numbers += [value for corner in entity.get_points("xyb") for value in corner]
        found.append((entity.dxftype(), entity.dxf.layer, numbers))
    return found


@pytest.mark.parametrize("name", ["bench_lever", "swiss_lever", "balance"])
def test_drawings_in_the_profile_are_what_the_script_draws(name, tmp_path):
    draw_profiles.DRAWN[name](tmp_path)
    drawn = sorted(tmp_path.glob("*.dxf"))
    assert [path.name for path in drawn] == sorted(path.name for path in (PROFILES / name).glob("*.dxf"))
    for path in drawn:
        for new, kept in zip(entities(path), entities(PROFILES / name / path.name), strict=True):
            assert new[:2] == kept[:2]
            assert new[2] == pytest.approx(kept[2], abs=1e-9)


@pytest.mark.parametrize("path", sorted(PROFILES.glob("*/*.dxf")), ids=lambda path: f"{path.parent.name}/{path.name}")
def test_every_drawing_says_millimetres_and_has_one_pivot(path):
    sheet = ezdxf.readfile(path)
    assert sheet.header["$INSUNITS"] == 4
    assert len(sheet.modelspace().query('POINT[layer=="PIVOT"]')) == 1


def test_swiss_parts_have_lines_and_arcs_and_sound_outlines():
    scene = PROFILES / "swiss_lever" / "scene.toml"
    for name in ("escape_wheel", "lever", "roller"):
        kinds = {kind for kind, _, _ in entities(scene.parent / f"{name}.dxf")}
        assert {"LINE", "ARC"} <= kinds
    for part in read_layout(scene).parts.values():
        assert all(shape.is_valid and shape.area > 0.0 for shape in part.layers.values())
    wheel = read_layout(scene).parts["wheel"].layers["TEETH"]
    assert len(wheel.interiors) == 5  # four windows and the bore


SCENES = [PROFILES / "bench_lever" / "scene.toml", PROFILES / "swiss_lever" / "scene.toml"]


@needs(PIN_LEVER)
@pytest.mark.parametrize("name", ["scene.toml", "scene_as_drawn.toml"])
def test_nothing_overlaps_in_the_real_lever(name, tmp_path):
    test_nothing_overlaps_at_the_start(pin_lever_scene(name, tmp_path))


@pytest.mark.parametrize("scene", SCENES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_nothing_overlaps_at_the_start(scene):
    layout = read_layout(scene)
    for sides in layout.contacts:
        first, second = (
            placed(layout.parts[body].layers[layer], layout.parts[body].angle, layout.parts[body].position)
            for body, layer in sides
        )
        assert first.distance(second) > 0.0, sides


@pytest.mark.parametrize("scene", SCENES, ids=lambda path: path.parent.name)
def test_lever_starts_locked_on_its_bank(scene):
    layout = read_layout(scene)

    def gap(body, other):
        shapes = [
            placed(
                layout.shape(name, layout.layers_between(name, partner)), layout.parts[name].angle, layout.parts[name].position
            )
            for name, partner in ((body, other), (other, body))
        ]
        return shapes[0].distance(shapes[1])

    assert 1e-6 < gap("wheel", "lever") < 1e-4
    assert 1e-6 < gap("lever", "banking") < 1e-4


def test_swiss_lock_run_lift_and_drop_are_the_design(swiss):
    design = Swiss()
    for beat in swiss[:2]:
        assert beat.bank == pytest.approx(design.bank, abs=1e-3)
        assert beat.lock == pytest.approx(design.lock, abs=1e-3)
        assert beat.run == pytest.approx(design.run, abs=1e-3)
        assert beat.drop == pytest.approx(design.drop_inside, abs=1e-3)
        assert beat.unlock == pytest.approx(design.lock + design.run, abs=1e-3)
        assert beat.lift_stone + beat.lift_tooth == pytest.approx(design.lift, abs=1e-3)
        assert beat.lift_stone > 4.5
        assert beat.lift_tooth > 1.5


def test_swiss_draw_holds_against_the_friction_of_the_scene(swiss):
    scene = tomllib.loads((PROFILES / "swiss_lever" / "scene.toml").read_text(encoding="utf-8"))
    friction = scene["contacts"][0]["friction"]
    for beat in swiss[:2]:
        assert beat.draw == pytest.approx(Swiss().draw, abs=0.01)
        assert 0.1 < beat.recoil < 0.4
        assert math.tan(math.radians(beat.draw)) > 1.5 * friction


def test_swiss_wheel_passes_the_idle_stone(swiss):
    # a negative value here is what jams a lever on its first return
    assert min(beat.spare_mm for beat in swiss[:2]) > 0.02


def test_swiss_wheel_advances_half_a_pitch_per_beat(swiss):
    assert (swiss[0].wheel_start - swiss[1].wheel_start) % 24.0 == pytest.approx(12.0, abs=0.05)


def test_swiss_safety_action_is_clear_in_the_beat_and_holds_outside_it(swiss):
    safety = swiss[2]
    assert safety.lift_angle == pytest.approx(51.2, abs=0.1)
    assert 0.25 < safety.fork_play < 0.5
    assert safety.horn_clearance_mm == pytest.approx(Swiss().horn_clearance, abs=1e-4)
    assert 0.02 < safety.guard_clearance_mm < 0.04
    assert safety.beat_clearance_mm > 0.02
    assert safety.guard_freedom < Swiss().lock
    assert safety.horn_freedom < Swiss().lock
    assert safety.worst_freedom < Swiss().lock  # nan fails too


def test_bench_lever_measures_as_designed():
    for beat in measure(PROFILES / "bench_lever" / "scene.toml")[:2]:
        assert beat.unlock == pytest.approx(2.0, abs=1e-3)
        assert beat.run == pytest.approx(0.5, abs=1e-3)
        assert beat.lift_stone == pytest.approx(8.5, abs=1e-3)
        assert beat.draw == pytest.approx(13.0, abs=2.01)  # 13° between the banks: 11° and 15° on them
        assert beat.drop > 2.0


@pytest.mark.parametrize("name", ["bench_lever", "carriage"])
def test_bench_lift_angle_is_twice_the_angle_at_which_the_pin_meets_the_fork(name):
    """The lever on its banking; pin and fork as drawn, turned by shapely."""
    layout = tomllib.loads((PROFILES / name / "scene.toml").read_text(encoding="utf-8"))
    turn = math.degrees(float(layout["bodies"]["lever"]["angle"].split()[0]))
    fork = rotate(shapely.MultiPolygon([shapely.Polygon(half) for half in draw_profiles.FORK]), turn, (0.0, 0.0))
    reach = -draw_profiles.PIN_CENTRE[1]

    def gap(angle: float) -> float:
        pin = shapely.Point(reach * math.sin(angle), 4.6 - reach * math.cos(angle))
        return pin.distance(fork) - draw_profiles.BENCH_PIN_RADIUS

    meets = brentq(gap, math.radians(-60.0), math.radians(-15.0))
    assert 2.0 * math.degrees(-meets) == pytest.approx(46.933, abs=1e-3)
    assert float(layout["timegrapher"]["lift_angle"].rstrip("°")) == pytest.approx(2.0 * math.degrees(-meets), abs=0.05)


@needs(BENCH)
def test_bench_lever_is_the_published_scene():
    told = json.loads(BENCH.read_text(encoding="utf-8"))
    as_tuples = [tuple(map(tuple, tooth)) for tooth in told["wheel"]["teeth_mm_in_wheel_frame"]]
    assert as_tuples == list(draw_profiles.TEETH)
    assert [tuple(map(tuple, p)) for p in told["lever"]["pallets_mm_in_lever_frame"]] == list(draw_profiles.PALLETS)
    assert [tuple(map(tuple, p)) for p in told["lever"]["fork_mm_in_lever_frame"]] == list(draw_profiles.FORK)
    assert tuple(map(tuple, told["lever"]["arm_mm_in_lever_frame"])) == draw_profiles.ARM
    scene = tomllib.loads((PROFILES / "bench_lever" / "scene.toml").read_text(encoding="utf-8"))
    for name in ("wheel", "lever", "balance"):
        assert [float(value.split()[0]) for value in scene["bodies"][name]["position"]] == told["pivots_mm"][name]
        assert float(scene["bodies"][name]["angle"].split()[0]) == told["start_rad"][name]
        assert float(scene["bodies"][name]["inertia"].split()[0]) * 1e-10 == pytest.approx(
            told[name]["inertia_kg_m2"], rel=1e-15
        )


@pytest.mark.parametrize(("name", "mu"), [("scene", 0.3), ("scene_mu013", 0.13), ("scene_mu010", 0.10)])
def test_incline_scene_says_the_same(name, mu):
    scene = tomllib.loads((PROFILES / "incline" / f"{name}.toml").read_text(encoding="utf-8"))
    pull, press = (float(value.split()[0]) for value in scene["scene"]["gravity"])
    assert pull == float(incline.gravity()[0])
    assert press == -float(incline.gravity()[1])
    assert scene["contacts"][0]["friction"] == mu
    assert scene["contacts"][0]["restitution"] == float(incline.RESTITUTION)
    disc = scene["bodies"]["disc"]
    assert float(disc["inertia"].split()[0]) == float(incline.RADIUS**2 / 2)
    assert float(disc["position"][1].split()[0]) == float(1000 * (incline.RADIUS + incline.HEIGHT))
