"""Do the solids for other programs weigh what the scene says, bores of other layers included?"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh

from watchsim.cli import main
from watchsim.drawing.write import dxf_text
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.render.keyframes import placed_solids
from watchsim.scene.layer_heights import slabs
from watchsim.scene.load import load
from watchsim.scene.scene import Scene

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
