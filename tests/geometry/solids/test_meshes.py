"""Do meshes have the volume, the inertia and the holes of what they were made of?"""

from __future__ import annotations

import io
import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from strangers import PIN_LEVER, marks

from watchsim.drawing.read import read
from watchsim.geometry.loops import Loop
from watchsim.geometry.meshes import Piece, Placed, glb, laid, plate, revolved, stl, turned_about
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.solids import mass_properties, turned

ROOT = Path(__file__).resolve().parents[3]
WHEELS = {"club_teeth": ROOT / "profiles/swiss_lever/escape_wheel.dxf", "pin_lever": PIN_LEVER / "siconos_pin_lever_wheel.dxf"}
HALF_DISC = Loop((Arc(0.0, 0.0, 1e-3, 0.0, math.pi), Line(-1e-3, 0.0, 1e-3, 0.0)), "BALL")


def loops_of(path: Path) -> tuple[Loop, ...]:
    return read(path, units="mm").loops


@pytest.mark.parametrize("path", [pytest.param(path, id=name, marks=marks(path)) for name, path in WHEELS.items()])
def test_a_real_escape_wheel_converges_to_the_closed_form(path: Path) -> None:
    """The mesh of chords errs by their height: a quarter of the deviation, a quarter of the error, in mass as in inertia."""
    loops, thickness, density = loops_of(path), 0.12e-3, 7850.0
    exact = mass_properties(loops, thickness, density)
    errors = []
    for deviation in (4e-6, 1e-6, 0.25e-6):
        mesh = plate(loops, 0.0, thickness, deviation)
        assert mesh is not None and mesh.is_watertight
        mesh.density = density * 1e-9  # kg/mm³
        errors.append(
            (mesh.mass / exact.mass - 1.0, mesh.moment_inertia[2, 2] * 1e-6 / exact.inertia_about(exact.centre) - 1.0)
        )
    ratios = np.array(errors[:-1]) / np.array(errors[1:])
    assert np.max(np.abs(errors[-1])) < 1e-3
    # Holes err the other way and chords come in whole numbers: the ratio is 4 on the whole, not at each step.
    assert np.all((ratios[0] * ratios[1] > 9.0) & (ratios[0] * ratios[1] < 30.0)), errors


def test_holes_are_kept() -> None:
    loops = loops_of(ROOT / "profiles/swiss_lever/escape_wheel.dxf")
    mesh = plate(loops, 0.0, 0.1e-3, 1e-6)
    assert mesh is not None
    holes = sum(loop.hole for loop in loops)
    assert holes == 5 and mesh.euler_number == 2 - 2 * holes


def test_a_plate_lies_where_it_was_asked_for() -> None:
    mesh = plate([Loop((Arc(1e-3, 2e-3, 0.5e-3, 0.0, TURN),))], 0.3e-3, 0.2e-3, 1e-7)
    assert mesh is not None
    assert mesh.bounds == pytest.approx(np.array([[0.5, 1.5, 0.3], [1.5, 2.5, 0.5]]), abs=2e-4)
    assert plate([Loop((Line(0.0, 0.0, 1e-3, 0.0),), closed=False)], 0.0, 1e-4, 1e-6) is None


def test_a_turned_part_with_a_groove_converges() -> None:
    groove = Loop((Arc(0.0, 0.5e-3, 0.2e-3, 0.0, -TURN),), "BALL", hole=True)
    exact = turned([HALF_DISC, groove], (0.0, 0.0), (1.0, 0.0))
    errors = []
    for deviation in (4e-6, 1e-6, 0.25e-6):
        mesh = revolved([HALF_DISC, groove], deviation)
        assert mesh is not None and mesh.is_watertight
        errors.append(abs(mesh.volume * 1e-9 / exact.volume - 1.0))
    assert errors[0] > 10.0 * errors[2] and errors[2] < 1e-3
    assert mesh.moment_inertia[2, 2] * 1e-15 == pytest.approx(exact.axial, rel=2e-3, abs=0.0)
    assert revolved([], 1e-6) is None


def test_a_lying_part_points_along_its_axis() -> None:
    rod = Loop((Line(1e-3, 0, 3e-3, 0), Line(3e-3, 0, 3e-3, 2e-4), Line(3e-3, 2e-4, 1e-3, 2e-4), Line(1e-3, 2e-4, 1e-3, 0)))
    mesh = revolved([rod], 1e-7)
    assert mesh is not None
    angle = 0.6
    lying = laid(mesh, (5e-3, 0.0), (math.cos(angle), math.sin(angle)), 0.4e-3)
    assert lying.center_mass == pytest.approx((5 + 2 * math.cos(angle), 2 * math.sin(angle), 0.4), abs=1e-9)
    assert lying.volume == pytest.approx(mesh.volume)
    assert turned_about(lying, (5e-3, 0.0), -angle).center_mass == pytest.approx((7.0, 0.0, 0.4), abs=1e-9)


def test_files_read_back_where_the_body_stands() -> None:
    """GLB in metres with the pose of the body, STL in millimetres in the frame of the body."""
    disc = plate([Loop((Arc(1e-3, 0.0, 0.5e-3, 0.0, TURN),))], 0.0, 0.2e-3, 1e-7)
    assert disc is not None
    body = Placed("wheel", [Piece("TEETH", disc, "#dcb862", 0.5)], (4e-3, 1e-3), math.pi / 2)
    scene = trimesh.load(io.BytesIO(glb([body])), file_type="glb")
    assert set(scene.geometry) == {"wheel.TEETH"} and "wheel" in scene.graph.nodes
    mesh = scene.to_mesh()
    assert mesh.center_mass == pytest.approx((4e-3, 2e-3, 1e-4), abs=1e-8)
    colour = next(iter(scene.geometry.values())).visual.material.baseColorFactor
    assert tuple(colour[:3]) == (0xDC, 0xB8, 0x62)
    back = trimesh.load(io.BytesIO(stl(body)), file_type="stl")
    assert back.is_watertight and back.center_mass == pytest.approx((1.0, 0.0, 0.1), abs=1e-6)
