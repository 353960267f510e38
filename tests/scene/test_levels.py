"""Does every layer find a height at which nothing stands in its way?"""

from __future__ import annotations

import math
from itertools import combinations
from pathlib import Path

import pytest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.geometry.solids import region
from watchsim.scene.layer_heights import Slab, slabs
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.scene.solids import PLATE, UPRIGHT, Solid, Weight

ROOT = Path(__file__).resolve().parents[2]
HEAD = '[bodies.wheel]\ncircle = "3 mm"\ninertia = "1 mg·cm²"\n'
COVER = '[bodies.cover]\ncircle = "1 mm"\nposition = ["1 mm", "0 mm"]\nmotion = "fixed"\n'
BESIDE = '[bodies.beside]\ncircle = "1 mm"\nposition = ["4.5 mm", "0 mm"]\nmotion = "fixed"\n'


def heights(tmp_path: Path, text: str) -> dict[str, Slab]:
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return {slab.body: slab for slab in slabs(load(path), 0.2e-3)}


def test_what_covers_lies_above_and_what_stands_beside_does_not(tmp_path: Path) -> None:
    found = heights(tmp_path, HEAD + COVER + BESIDE)
    assert found["wheel"].middle == pytest.approx(0.1e-3)
    assert found["cover"].middle == pytest.approx(0.32e-3)  # a tenth of the thickness of air
    assert found["beside"].middle == pytest.approx(0.1e-3)


def test_what_touches_lies_at_one_height(tmp_path: Path) -> None:
    contact = '[[contacts]]\nbetween = ["cover", "beside"]\n'
    found = heights(tmp_path, HEAD + COVER.replace('motion = "fixed"', 'inertia = "1 mg·cm²"') + BESIDE + contact)
    assert found["cover"].middle == found["beside"].middle != found["wheel"].middle


def test_thickness_comes_from_the_scene(tmp_path: Path) -> None:
    solid = '[[bodies.wheel.solids]]\nthickness = "0.5 mm"\ndensity = "8 g/cm³"\n'
    found = heights(tmp_path, HEAD + solid + COVER)
    assert (found["wheel"].thickness, found["wheel"].middle) == pytest.approx((0.5e-3, 0.25e-3))
    assert found["wheel"].solid is not None and found["cover"].solid is None
    assert found["cover"].middle == pytest.approx(0.65e-3)


def test_no_two_layers_of_the_swiss_lever_share_a_place() -> None:
    scene = load(ROOT / "profiles/swiss_lever/scene.toml")
    found = slabs(scene, 0.2e-3)
    assert len(found) == 10
    by_name = {(slab.body, slab.layer): slab.middle for slab in found}
    for contact in scene.contacts:
        first, second = (by_name[side.body, side.layer] for side in contact.sides)
        assert first == second
    for a, b in combinations(found, 2):
        if a.middle == b.middle:
            shapes = [
                region((loop.moved(scene.body(s.body).angle, scene.body(s.body).position) for loop in s.loops), 1e-6)
                for s in (a, b)
            ]
            assert shapes[0].intersection(shapes[1]).area < 1e-3 * min(shape.area for shape in shapes), (a.layer, b.layer)


def test_a_plate_without_a_layer_takes_that_of_its_body(tmp_path: Path) -> None:
    plate = '[[bodies.wheel.solids]]\nthickness = "0.5 mm"\ndensity = "8 g/cm³"\n'
    path = tmp_path / "scene.toml"
    path.write_text(HEAD + plate, encoding="utf-8")
    scene = load(path)
    (slab,) = slabs(scene, 0.2e-3)
    assert [slab.layer] == list(scene.body("wheel").layers) and slab.layer != "plate"


@pytest.mark.parametrize(
    ("kind", "layers", "name"), [(PLATE, ("RIM",), "RIM"), (PLATE, ("RIM", "HUB"), PLATE), (UPRIGHT, ("RIM",), UPRIGHT)]
)
def test_a_solid_without_a_layer_is_called_after_the_only_one_if_it_is_a_plate(
    kind: str, layers: tuple[str, ...], name: str
) -> None:
    rings = tuple(Loop((Arc(0.0, 0.0, 1e-3 * k, 0.0, math.tau),), layer) for k, layer in enumerate(layers, 1))
    solid = Solid(kind, "", Weight(1e-6, (0.0, 0.0), 1e-12), 8e3, rings[:1], 0.2e-3)
    body = Body("balance", "pivot", inertia=1e-12, loops=rings, solids=(solid,))
    assert slabs(Scene("one", (body,)), 0.2e-3)[0].layer == name


@pytest.mark.parametrize(("apart", "together"), [(0.0, True), (0.019, True), (0.021, False), (1.0, False)])
def test_layers_of_one_body_that_meet_lie_at_one_height(apart: float, together: bool) -> None:
    """A wide plate covers the one layer, so that it lies higher; the other goes with it where they are side by side."""

    def block(layer: str, x: float, width: float, height: float) -> Loop:
        corners = [(x, 0.0), (x + width, 0.0), (x + width, height), (x, height)]
        ends = corners[1:] + corners[:1]
        return Loop(tuple(Line(*(1e-3 * c for c in (*a, *b))) for a, b in zip(corners, ends, strict=True)), layer)

    wide = Body("wide", "fixed", loops=(block("PLATE", -9.0, 9.5, 5.0),))
    two = Body("two", "pivot", inertia=1e-9, loops=(block("LEFT", 0.0, 1.0, 1.0), block("RIGHT", 1.0 + apart, 1.0, 1.0)))
    found = {slab.layer: slab.middle for slab in slabs(Scene("beside", (wide, two)), 0.2e-3)}
    assert found["LEFT"] > found["PLATE"] == pytest.approx(0.1e-3)
    assert (found["RIGHT"] == found["LEFT"]) == together
    assert together or found["RIGHT"] == found["PLATE"]


@pytest.mark.parametrize(("share", "above"), [(0.9e-3, False), (1.1e-3, True)])
@pytest.mark.parametrize("larger", [1.0, 3.0])
def test_what_covers_no_thousandth_of_the_smaller_stands_beside_it(share: float, above: bool, larger: float) -> None:
    def square(name: str, x: float, size: float) -> Body:
        corners = [(x, 0.0), (x + size, 0.0), (x + size, size), (x, size)]
        ends = corners[1:] + corners[:1]
        lines = tuple(Line(*(1e-3 * c for c in (*a, *b))) for a, b in zip(corners, ends, strict=True))
        return Body(name, "fixed", loops=(Loop(lines, name),))

    scene = Scene("two", (square("first", 0.0, larger), square("second", larger - share, 1.0)))
    first, second = slabs(scene, 0.4e-3)
    assert first.middle == pytest.approx(0.2e-3)
    assert second.middle == pytest.approx(0.2e-3 + (0.44e-3 if above else 0.0))
