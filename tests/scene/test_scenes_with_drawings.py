"""Do the scenes of the project load with their real drawings, and do faults of real drawings reach the user?"""

import json
import math
from itertools import pairwise
from pathlib import Path

import pytest
from every_time import few
from strangers import PIN_LEVER, needs, pin_lever_scene
from strangers import SCENES as SCENES_BESIDE

from watchsim.mechanism.overlap import overlaps
from watchsim.results.folder import lock_text
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load

ROOT = Path(__file__).resolve().parents[2]
BENCH = SCENES_BESIDE / "bench_lever.json"
SCENES = sorted(ROOT.glob("profiles/*/scene*.toml"))


@pytest.mark.parametrize("path", few(SCENES, 12), ids=lambda path: f"{path.parent.name}/{path.name}")
def test_profiles_load_do_not_overlap_and_lock(path, tmp_path):
    scene = load(path)
    assert overlaps(scene) == []
    locked = tmp_path / "scene.lock.toml"
    locked.write_text(lock_text(scene, tmp_path), encoding="utf-8")
    assert load(locked) == scene


@needs(BENCH)
def test_bench_lever_agrees_with_its_source():
    source = json.loads(BENCH.read_text())
    scene = load(ROOT / "profiles/bench_lever/scene.toml")
    wheel, lever, balance, banking = scene.bodies
    assert wheel.inertia == source["wheel"]["inertia_kg_m2"]
    assert lever.inertia == source["lever"]["inertia_kg_m2"]
    assert balance.inertia == source["balance"]["inertia_kg_m2"]
    assert scene.springs[0].stiffness == pytest.approx(source["balance"]["stiffness_N_m_per_rad"], rel=1e-14)
    assert scene.damping[0].viscous == pytest.approx(source["balance"]["viscous_N_m_s"], rel=1e-14)
    assert scene.torques[0].value == source["wheel"]["torque_N_m"]
    corners = {(round(edge.x0 * 1e3, 8), round(edge.y0 * 1e3, 8)) for loop in wheel.loops for edge in loop.edges}
    expected = {(round(x, 8), round(y, 8)) for tooth in source["wheel"]["teeth_mm_in_wheel_frame"] for x, y in tooth}
    assert corners == expected
    centres = sorted((loop.edges[0].x * 1e3, loop.edges[0].y * 1e3) for loop in banking.loops)
    assert [c for centre in centres for c in centre] == pytest.approx(
        [c for pin in source["banking_pins_mm"] for c in pin["centre"]], abs=1e-9
    )


@needs(PIN_LEVER)
@pytest.mark.parametrize("name", ["scene.toml", "scene_as_drawn.toml"])
def test_the_real_lever_loads(name, tmp_path):
    scene = load(pin_lever_scene(name, tmp_path))
    assert overlaps(scene) == []
    assert len(scene.body("wheel").loops) >= 1
    assert not scene.body("wheel").decoration, "the drawing holds all parts"


def dxf(path: Path, units: int, gap: float = 0.0) -> None:
    """A triangle of lines whose last corner is open by `gap`, on layer PLATE, and a point on layer PIVOT."""
    import ezdxf

    document = ezdxf.new()
    document.header["$INSUNITS"] = units
    corners = [(0.0, 0.0), (3.0, 0.0), (0.0, 4.0), (0.0, gap)]
    for start, end in pairwise(corners):
        document.modelspace().add_line(start, end, {"layer": "PLATE"})
    document.modelspace().add_point((1.0, 1.0), {"layer": "PIVOT"})
    document.saveas(path)


SCENE = (
    '[bodies.plate]\ndrawing = "plate.dxf"\npivot = "PIVOT"\n[[bodies.plate.solids]]\nthickness = "1 mm"\ndensity = "1 g/cm³"\n'
)


def test_a_triangle_from_the_file_to_its_inertia(tmp_path):
    dxf(tmp_path / "plate.dxf", units=4)
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    (plate,) = load(tmp_path / "scene.toml").bodies
    mass = 6e-6
    assert plate.mass == pytest.approx(mass, rel=1e-9, abs=0.0)
    assert plate.centre_of_mass == pytest.approx((0.0, 1e-3 / 3), abs=1e-9)
    about_centroid = mass * (3.0**2 + 4.0**2) / 18 * 1e-6
    assert plate.inertia == pytest.approx(about_centroid + mass * (1e-3 / 3) ** 2, rel=1e-6, abs=0.0)
    assert math.isclose(min(edge.x0 for edge in plate.loops[0].edges), -1e-3, rel_tol=1e-9)


def test_missing_units_and_open_outlines_are_told_with_their_cure(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE, encoding="utf-8")
    dxf(tmp_path / "plate.dxf", units=0)
    with pytest.raises(SceneError) as caught:
        load(scene)
    assert f"{scene}:2  bodies.plate.drawing -> plate.dxf\n  the drawing does not say its units" in str(caught.value)
    assert 'Set units = "mm" (or "inch") under [bodies.plate].' in str(caught.value)
    dxf(tmp_path / "plate.dxf", units=4, gap=0.023)
    with pytest.raises(SceneError) as caught:
        load(scene)
    assert "bodies.plate.drawing -> plate.dxf, layer PLATE\n  the outline is open: 23 µm between" in str(caught.value)
    assert 'set snap = "' in str(caught.value) and "under [bodies.plate]." in str(caught.value)


def test_the_cures_work(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.replace("[[", 'units = "inch"\nsnap = "600 µm"\n[[', 1), encoding="utf-8")
    dxf(tmp_path / "plate.dxf", units=0, gap=0.02)
    (plate,) = load(scene).bodies
    assert max(edge.y0 for edge in plate.loops[0].edges) == pytest.approx(3 * 0.0254, rel=1e-6)
