"""Do drawings of our own, written by `export` and read back, have what test_pin_lever_drawings and test_real_drawings look for
in those of strangers: closed layers, units, counts, teeth, the same matter in DXF and SVG, in a single
part and in the assembly?"""

import math
from pathlib import Path

import pytest
from proposal.assemblies import assembly, scene_of

import watchsim as ws
from watchsim.cli import main
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read
from watchsim.geometry.loops import Loop, extents
from watchsim.geometry.solids import mass_properties

TEETH = {"swiss_lever": 15, "coaxial": 8, "graham": 30, "pin_pallet": 15, "detent": 15}


@pytest.fixture(scope="module", params=TEETH)
def exported(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    folder = tmp_path_factory.mktemp("exported") / request.param
    assert main(["export", str(ws.profiles_dir() / request.param), "--format", "dxf,svg", "-o", str(folder)]) == 0
    return request.param, folder


def drawings(folder: Path) -> list[tuple[Drawing, Drawing]]:
    found = [(read(path), read(path.with_suffix(".svg"))) for path in sorted(folder.glob("*.dxf"))]
    assert found
    return found


def test_every_layer_is_closed_and_nothing_is_wrong(exported: tuple[str, Path]) -> None:
    for pair in drawings(exported[1]):
        for one in pair:
            assert (one.open_chains, one.findings, one.ignored, one.units) == ((), (), {}, "mm")


def test_dxf_and_svg_hold_the_same_layers_and_matter(exported: tuple[str, Path]) -> None:
    for dxf, svg in drawings(exported[1]):
        outlined = {loop.layer for loop in dxf.loops}
        assert outlined <= {loop.layer for loop in svg.loops}
        for layer in outlined:
            one, other = ([loop for loop in drawing.loops if loop.layer == layer] for drawing in (dxf, svg))
            assert len(one) == len(other)
            assert sum(loop.length for loop in one) == pytest.approx(sum(loop.length for loop in other), rel=1e-9)
            assert matter(one) == pytest.approx(matter(other), rel=1e-7, abs=1e-15)


def matter(loops: list[Loop]) -> tuple[float, ...]:
    """Mass, inertia about its centre; centre and far corner as seen from the near one: a page has an origin of its own."""
    box, whole = extents(loops), mass_properties(loops, 1e-4, 7800.0)
    assert box is not None
    (x, y), (left, low, right, top) = whole.centre, box
    return whole.mass, 1e6 * whole.inertia_about((x, y)), x - left, y - low, right - left, top - low


def test_the_wheel_has_its_teeth(exported: tuple[str, Path]) -> None:
    """Its outline comes out furthest once for each tooth."""
    name, folder = exported
    for path in (folder / "wheel.dxf", folder / "wheel.svg"):
        outline = max((loop for loop in read(path).loops if loop.layer == "TEETH"), key=lambda loop: loop.length)
        x0, y0 = mass_properties([outline], 1e-4, 7800.0).centre
        points = [(x - x0, y - y0) for x, y in (edge.point(f) for edge in outline.edges for f in (0.0, 0.5))]
        reach = max(math.hypot(x, y) for x, y in points)
        tips = sorted(math.atan2(y, x) for x, y in points if math.hypot(x, y) > reach - 1e-7)
        gaps = [b - a for a, b in zip(tips, [*tips[1:], tips[0] + math.tau], strict=True)]
        assert sum(gap > math.pi / TEETH[name] / 2 for gap in gaps) == TEETH[name]


PARTS = {  # profile -> its drawings of single parts, each with its pivot as a point, and the bodies that they are of
    "swiss_lever": {"escape_wheel": "wheel", "lever": "lever", "roller": "balance", "banking": "banking"},
    "bench_lever": {"wheel": "wheel", "lever": "lever", "balance": "balance", "banking": "banking"},
}


@pytest.mark.parametrize(("profile", "part"), [(profile, part) for profile, parts in PARTS.items() for part in parts])
def test_single_parts_are_the_same_as_in_the_assembly(profile: str, part: str, tmp_path: Path) -> None:
    """Layer by layer, of the same mass and of the same inertia about the pivot, wherever it stands there."""
    scene = scene_of(profile)
    body = scene.body(PARTS[profile][part])
    whole = read(assembly(scene, tmp_path / "whole.dxf", "body"))
    alone = read(ws.profiles_dir() / profile / f"{part}.dxf")
    (pivot,) = ((x, y) for layer, x, y in alone.points if layer == "PIVOT")
    assert not whole.findings and not alone.findings
    pivots = sorted(one.position for one in scene.bodies if one.motion != "fixed")
    for (_, x, y), place in zip(sorted(whole.points), pivots, strict=True):
        assert (x, y) == pytest.approx(place, abs=1e-12)
    layers = {loop.layer for loop in alone.loops}
    assert layers and {f"{body.name}_{layer}" for layer in layers} <= set(whole.layers)
    for layer in layers:
        one, other = (
            mass_properties([loop for loop in drawing.loops if loop.layer == name], 1.5e-4, 7750.0)
            for drawing, name in ((alone, layer), (whole, f"{body.name}_{layer}"))
        )
        assert other.mass == pytest.approx(one.mass, rel=1e-9, abs=0)
        assert other.inertia_about(body.position) == pytest.approx(one.inertia_about(pivot), rel=1e-9, abs=0)
