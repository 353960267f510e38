"""Does a GLB file move as the run does, and are STL files closed?"""

import json
import math
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh
from every_time import few
from render.fake_runs import watch_run
from scipy.spatial.transform import Rotation, Slerp

from watchsim.cli import main
from watchsim.drawing.write import dxf_text
from watchsim.geometry.loops import Loop
from watchsim.geometry.meshes import Track, glb
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.paths import profiles_dir
from watchsim.render.keyframes import bends, closed_solids, keyframes, placed_solids, ribbons
from watchsim.render.view import hairsprings, poses
from watchsim.results.folder import write_results
from watchsim.scene.layer_heights import slabs
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

PROFILES = Path(str(profiles_dir()))


def chunks(data: bytes) -> tuple[dict, bytes]:
    """The JSON and the binary part of a GLB file (glTF 2.0 specification, 4.4)."""
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    return json.loads(data[20 : 20 + size]), data[20 + size + 8 :]


def values(tree: dict, blob: bytes, number: int) -> np.ndarray:
    accessor = tree["accessors"][number]
    view = tree["bufferViews"][accessor["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    found = np.frombuffer(blob, "<f4", accessor["count"] * width, view["byteOffset"]).reshape(-1, width)
    assert found.min(axis=0) == pytest.approx(accessor["min"]) and found.max(axis=0) == pytest.approx(accessor["max"])
    return found.astype(float)


def played(data: bytes) -> dict[tuple[str, str], tuple[np.ndarray, np.ndarray]]:
    """(body, what) -> times and values of the animation."""
    tree, blob = chunks(data)
    (animation,) = tree["animations"]
    found = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        node = tree["nodes"][channel["target"]["node"]]
        assert "matrix" not in node and sampler["interpolation"] == "LINEAR"
        t = values(tree, blob, sampler["input"])[:, 0]
        assert t[0] == 0.0 and np.all(np.diff(t) > 0.0)
        found[node["name"], channel["target"]["path"]] = (t, values(tree, blob, sampler["output"]))
    return found


@pytest.mark.parametrize(
    ("profile", "window"), [("swiss_lever", (0.1, 0.4)), ("carriage", (0.1, 0.3)), ("incline", (0.0, 1.0))]
)
def test_the_animation_is_the_motion(profile: str, window: tuple[float, float]) -> None:
    run = simulate(load(PROFILES / profile / "scene.toml"), duration=window[1])
    solids = placed_solids(run.scene, slabs(run.scene, 0.2e-3), 2e-6)
    speed = 0.05
    seen = played(glb(solids, keyframes(run, window, speed)))
    times = np.random.default_rng(8).uniform(*window, 500)
    frames = poses(run, times)
    moving = {name for name, _ in seen}
    assert moving == {solid.name for solid in solids if solid.name in run.slices or run.scene.body(solid.name).on}
    for name in moving:
        t, places = seen[name, "translation"]
        along = np.stack([np.interp((times - window[0]) / speed, t, places[:, k]) for k in range(2)], axis=1)
        travel = max(float(np.ptp(frames[name][:, :2], axis=0).max()), 1e-9)
        assert np.abs(along - frames[name][:, :2]).max() < 5e-4 * travel + 2e-9 + 1e-7 * np.abs(frames[name][:, :2]).max()
        t, turns = seen[name, "rotation"]
        told = Slerp(t, Rotation.from_quat(turns))(np.clip((times - window[0]) / speed, 0.0, t[-1])).as_rotvec()[:, 2]
        off = np.remainder(told - frames[name][:, 2] + np.pi, 2.0 * np.pi) - np.pi
        assert np.abs(np.degrees(off)).max() < 0.05


def test_a_hairspring_bends_in_the_animation_as_in_pictures() -> None:
    run = simulate(load(PROFILES / "swiss_lever" / "scene.toml"), duration=0.4)
    window, speed = (0.1, 0.4), 0.05
    solids, tracks = placed_solids(run.scene, slabs(run.scene, 0.2e-3), 2e-6), keyframes(run, window, speed)
    drawn = ribbons(run.scene, solids)
    tree, blob = chunks(glb([*solids, *drawn], tracks, bends(run.scene, tracks, drawn)[1]))
    (mesh,) = (mesh for mesh in tree["meshes"] if "weights" in mesh)
    primitive = mesh["primitives"][0]
    start = values(tree, blob, primitive["attributes"]["POSITION"])
    ways = np.stack([values(tree, blob, target["POSITION"]) for target in primitive["targets"]])
    (channel,) = (one for one in tree["animations"][0]["channels"] if one["target"]["path"] == "weights")
    sampler = tree["animations"][0]["samplers"][channel["sampler"]]
    t = values(tree, blob, sampler["input"])[:, 0]
    shares = values(tree, blob, sampler["output"]).reshape(len(t), len(ways))
    (spring,) = hairsprings(run.scene)
    top = max(piece.mesh.bounds[1][2] for solid in solids for piece in solid.pieces) / 1e3
    x, y = run.scene.body("balance").position
    for instant in np.random.default_rng(3).uniform(*window, 40).tolist():
        played_at = (instant - window[0]) / speed
        weights = [np.interp(played_at, t, column) for column in shares.T]
        seen = start + np.tensordot(weights, ways, 1)
        frames = {name: rows[0] for name, rows in poses(run, np.array([instant])).items()}
        line = spring.line(frames, len(seen) // 2 - 1) - (x, y)
        assert np.abs(seen[: len(line), :2] - line).max() < 0.01 * spring.coil.outer
        assert seen[:, 2].min() > top


def test_a_track_that_turns_too_far_at_once_is_refused() -> None:
    run = watch_run()
    solids = placed_solids(run.scene, slabs(run.scene, 0.2e-3), 2e-6)
    with pytest.raises(ValueError, match="give more of them"):
        glb(solids, [Track("wheel", np.arange(4.0), np.zeros((4, 2)), np.array([0.0, 0.5, -2.5, -2.0]))])
    for speed in (0.0, -1.0, float("nan")):
        with pytest.raises(ValueError, match="speed"):
            keyframes(run, None, speed)


def test_without_motion_nothing_is_animated() -> None:
    run = watch_run()
    tree, _ = chunks(glb(placed_solids(run.scene, slabs(run.scene, 0.2e-3), 2e-6)))
    assert "animations" not in tree


@pytest.mark.parametrize("profile", few(["swiss_lever", "coaxial", "bench_lever", "balance", "geneva", "graham"], 3))
def test_stl_files_are_closed(profile: str, tmp_path: Path) -> None:
    scene = load(PROFILES / profile / "scene.toml")
    assert main(["export", str(PROFILES / profile), "-o", str(tmp_path / "out"), "--format", "stl"]) == 0
    for solid in closed_solids(scene, slabs(scene, 0.2e-3), 2e-7):
        mesh = trimesh.load(tmp_path / "out" / f"{solid.name}.stl")
        assert mesh.is_watertight and mesh.volume > 0.0, solid.name


def test_export_of_a_run_moves_and_of_a_scene_does_not(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = simulate(load(PROFILES / "bench_lever" / "scene.toml"), duration=0.5)
    folder = write_results(run, tmp_path / "run")
    options = ["--format", "glb", "--window", "0.2 s:0.4 s", "--speed", "1/10"]
    assert main(["export", str(folder), "-o", str(tmp_path / "out"), *options]) == 0
    seen = played((tmp_path / "out" / "scene.glb").read_bytes())
    assert {name for name, _ in seen} == {"wheel", "lever", "balance"}
    assert all(t[-1] == pytest.approx(2.0, rel=1e-6) for t, _ in seen.values())
    assert main(["export", str(PROFILES / "bench_lever"), "-o", str(tmp_path / "still"), *options]) == 2
    assert "only a results folder has a motion" in capsys.readouterr().err


SCENE = """\
[bodies.lever]
drawing = "lever.dxf"
pivot = "PIVOT"
angle = "30°"

[[bodies.lever.solids]]
layer = "LEVER"
thickness = "0.2 mm"
density = "7.85 g/cm³"
bores = ["LEVER_BORE", "SLOT", "STONE"]

[[bodies.lever.solids]]
layer = "STONE"
thickness = "0.3 mm"
density = "3.98 g/cm³"
"""


def bar(layer: str, x0: float, y0: float, x1: float, y1: float) -> Loop:
    corners = [(1e-3 * x, 1e-3 * y) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), layer)


def disc(layer: str, x: float, y: float, r: float) -> Loop:
    return Loop((Arc(1e-3 * x, 1e-3 * y, 1e-3 * r, 0.0, TURN),), layer)


@pytest.fixture
def lever(tmp_path: Path) -> Path:
    """A lever with two bores, a slot that reaches its border and a stone set in it, read from a DXF file."""
    bores = (disc("LEVER_BORE", 0.0, 0.0, 0.3), disc("LEVER_BORE", 2.0, 0.0, 0.1), bar("SLOT", 1.0, -0.5, 1.3, -0.2))
    loops = (bar("LEVER", -1.0, -0.5, 3.0, 0.5), *bores, disc("STONE", 2.6, 0.1, 0.2))
    (tmp_path / "lever.dxf").write_text(dxf_text(loops, (("PIVOT", (0.0, 0.0)),), {}), encoding="utf-8")
    path = tmp_path / "scene.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


def meshes(scene: Scene, deviation: float) -> list[trimesh.Trimesh]:
    (placed,) = placed_solids(scene, slabs(scene, 0.2e-3), deviation)
    return [piece.mesh for piece in placed.pieces]


def test_solids_with_bores_converge_to_mass_centre_and_inertia(lever: Path) -> None:
    """The mesh of chords errs by their height: a quarter of the deviation, a quarter of the error."""
    scene = load(lever)
    body = scene.body("lever")
    by_hand = 7850 * 0.2e-9 * (4 - math.pi * (0.09 + 0.01 + 0.04) - 0.09) + 3980 * 0.3e-9 * math.pi * 0.04
    assert body.mass == pytest.approx(by_hand, rel=1e-12)
    errors = []
    for deviation in (4e-6, 1e-6, 0.25e-6, 0.0625e-6):
        mass, moment, inertia = 0.0, np.zeros(2), 0.0
        for mesh, solid in zip(meshes(scene, deviation), body.solids, strict=True):
            assert mesh.is_watertight
            mesh.density = solid.density * 1e-9  # kg/mm³
            x, y = mesh.center_mass[:2] * 1e-3
            mass, moment = mass + mesh.mass, moment + mesh.mass * np.array([x, y])
            inertia += mesh.moment_inertia[2, 2] * 1e-6 + mesh.mass * (x * x + y * y)
        centre = math.dist(moment / mass, body.centre_of_mass) / math.hypot(*body.centre_of_mass)
        errors.append((abs(mass / body.mass - 1.0), centre, abs(inertia / body.inertia - 1.0)))
    assert np.all(np.array(errors[-1]) < 1e-4), errors
    assert np.all(np.array(errors[0]) > 20.0 * np.array(errors[-1])), errors


def test_exported_files_have_the_bores(lever: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    assert main(["export", str(lever), "-o", str(folder), "--format", "glb,stl", "--json"]) == 0
    assert '"bores": [\n' in capsys.readouterr().out
    lever_solid, stone = load(lever).body("lever").solids
    found = trimesh.load(folder / "lever.glb").geometry
    for name, solid in (("lever.LEVER", lever_solid), ("lever.STONE", stone)):
        assert found[name].volume * solid.density == pytest.approx(solid.weight.mass, rel=2e-3)
    assert found["lever.LEVER"].euler_number == 2 - 2 * 3  # the slot is open at its border
    whole = trimesh.load(folder / "lever.stl").volume * 1e-9
    parts = [solid.weight.mass / solid.density for solid in (lever_solid, stone)]
    assert whole == pytest.approx(math.fsum(parts), rel=2e-3)
