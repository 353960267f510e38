"""Does one drawing serve a whole mechanism, each pivot given once?"""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from made_scenes import circle, square

from watchsim.cli import main
from watchsim.commands.common.console import FINE
from watchsim.drawing.dxf.write_dxf import dxf_text
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc
from watchsim.results.provenance import lock_text
from watchsim.scene.errors import SceneError
from watchsim.scene.file.load import load

MM = 1e-3
WHEEL, LEVER = (1.0 * MM, 2.0 * MM), (1.5 * MM, 9.0 * MM)
TEXT = """
[scene]
schema = 1
[bodies.wheel]
drawing = "all.dxf"
layers = ["TEETH"]
draw = ["WHEEL_ARMS"]
pivot = "hole near [1.1 mm, 2 mm]"
inertia = "1 mg·cm²"
[bodies.lever]
drawing = "all.dxf"
layers = ["FORK"]
pivot = "LEVER_PIVOT"
inertia = "1 mg·cm²"
angle = "3°"
[bodies.plate]
drawing = "all.dxf"
layers = ["PLATE"]
motion = "fixed"
"""


def halves(x: float, y: float, radius: float, layer: str) -> Loop:
    """A circle in two arcs, as some programs draw it; clockwise, a hole."""
    arcs = tuple(Arc(x, y, radius, start, -math.pi) for start in (0.0, math.pi))
    return Loop(arcs, layer, hole=True)


@pytest.fixture
def desk(tmp_path: Path) -> Path:
    loops = (
        *(square(4 * MM, WHEEL, "TEETH"), halves(*WHEEL, 0.3 * MM, "TEETH"), square(1 * MM, WHEEL, "WHEEL_ARMS")),
        *(square(2 * MM, LEVER, "FORK"), circle(0.1 * MM, LEVER, "LEVER_PIVOT"), square(1 * MM, (9 * MM, 9 * MM), "PLATE")),
    )
    (tmp_path / "all.dxf").write_text(dxf_text(loops, (("MARK", (5 * MM, 5 * MM)),), {}), encoding="utf-8")
    return tmp_path


def scene_of(desk: Path, text: str = TEXT):
    (desk / "scene.toml").write_text(text, encoding="utf-8")
    return load(desk)


def faults(desk: Path, old: str, new: str) -> str:
    assert TEXT.count(old) == 1
    with pytest.raises(SceneError) as caught:
        scene_of(desk, TEXT.replace(old, new))
    return str(caught.value)


def test_positions_follow_from_pivots(desk: Path) -> None:
    scene = scene_of(desk)
    assert scene.body("wheel").position == pytest.approx(WHEEL, abs=1e-12)
    assert scene.body("lever").position == pytest.approx(LEVER, abs=1e-12)
    assert scene.body("plate").position == (0.0, 0.0)
    # Everything is where it is drawn: the wheel's outline about its own pivot, moved there.
    corner = scene.body("wheel").loops[0].edges[0].start
    assert (corner[0] + WHEEL[0], corner[1] + WHEEL[1]) == pytest.approx((-1 * MM, 0.0), abs=1e-12)
    (desk / "scene.lock.toml").write_text(lock_text(scene, desk), encoding="utf-8")
    assert load(desk / "scene.lock.toml") == scene


def test_a_position_that_is_given_counts(desk: Path) -> None:
    assert scene_of(desk).set("bodies.lever.position", [0.0, 0.005]).body("lever").position == (0.0, 0.005)
    alone = TEXT[: TEXT.index("[bodies.lever]")]
    assert scene_of(desk, alone).body("wheel").position == (0.0, 0.0)  # a drawing of its own says nothing of the movement
    asked = alone.replace("inertia", 'position = "as drawn"\ninertia')
    assert scene_of(desk, asked).body("wheel").position == pytest.approx(WHEEL, abs=1e-12)


def test_a_carried_body_is_placed_on_its_carrier(desk: Path) -> None:
    scene = scene_of(desk, TEXT.replace('angle = "3°"', 'on = "wheel"\nmass = "1 mg"'))
    x, y = scene.body("lever").position
    assert (x + WHEEL[0], y + WHEEL[1]) == pytest.approx(LEVER, abs=1e-12)


def test_drawn_layers_belong_to_their_body_only(desk: Path) -> None:
    scene = scene_of(desk)
    assert [loop.layer for loop in scene.body("wheel").decoration] == ["WHEEL_ARMS"]
    assert scene.body("lever").decoration == () and scene.body("wheel").layers == ("TEETH",)
    shut = scene_of(desk, TEXT[: TEXT.index("[bodies.lever]")].replace('["WHEEL_ARMS"]', "[]"))
    assert shut.body("wheel").decoration == ()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('["WHEEL_ARMS"]', '["WHEEL_ARM"]', 'the drawing has no such layer. Did you mean "WHEEL_ARMS"?'),
        ('["WHEEL_ARMS"]', '["TEETH"]', "this layer can touch, and is drawn anyway"),
        ('["WHEEL_ARMS"]', '["MARK"]', "there is no closed outline on this layer"),
        ("hole near [1.1 mm, 2 mm]", "hole near [1.1, 2]", 'write pivot = "hole near [1.1 mm, 2 mm]"'),
        ("hole near [1.1 mm, 2 mm]", "hole near [1.1 mm, 2]", 'write pivot = "hole near [1.1 mm, 2 mm]"'),
        ("hole near [1.1 mm, 2 mm]", "rivet near [1 mm, 2 mm]", "write hole, circle or point near a place"),
        ("hole near [1.1 mm, 2 mm]", "hole near 1 mm", "write hole, circle or point near a place"),
        ("hole near [1.1 mm, 2 mm]", "circle near [1.2 mm, 5.5 mm]", "are about equally near"),
        ('angle = "3°"', 'position = "drawn"', 'write ["1 mm", "0 mm"], or "as drawn"'),
    ],
)
def test_slips_are_named(old: str, new: str, words: str, desk: Path) -> None:
    assert words in faults(desk, old, new)


def test_other_marks(desk: Path) -> None:
    for pivot, place in (
        ("circle near [1.5 mm, 8 mm]", LEVER),
        ("point near [0 mm, 0 mm]", (5 * MM, 5 * MM)),
        ("MARK", (5 * MM, 5 * MM)),
    ):
        scene = scene_of(desk, TEXT.replace("hole near [1.1 mm, 2 mm]", pivot))
        assert scene.body("wheel").position == pytest.approx(place, abs=1e-12)


def test_inspect_lists_circles_and_points(desk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(desk / "all.dxf")]) == FINE
    said = capsys.readouterr().out
    assert "hole of radius 0.3 mm at (1, 2) mm" in said
    assert "pivot of radius 0.1 mm at (1.5, 9) mm" in said and "a point at (5, 5) mm" in said
    assert main(["inspect", str(desk / "all.dxf"), "--json"]) == FINE
    circles = json.loads(capsys.readouterr().out)["circles"]
    found = [
        (one["layer"], round(one["x_mm"], 9), round(one["y_mm"], 9), round(one["radius_mm"], 9), one["hole"]) for one in circles
    ]
    assert found == [("TEETH", 1.0, 2.0, 0.3, True), ("LEVER_PIVOT", 1.5, 9.0, 0.1, False)]


def test_check_takes_changes(desk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene_of(desk)
    assert main(["check", str(desk), "--set", "bodies.lever.inertia=7 mg·cm²", "--json"]) == FINE
    assert json.loads(capsys.readouterr().out)["bodies"]["lever"]["inertia_kg_m2"] == pytest.approx(7e-10)
