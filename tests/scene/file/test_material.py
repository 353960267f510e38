"""Do open chains of a drawing become one-sided faces, with the material where the scene says?"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.overlap import overlaps
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.scene import Scene

sys.path.append(str(Path(__file__).resolve().parents[2] / "drawing"))
import dxf_text as d

GROUND = d.line((-5, 0), (5, 0), layer="GROUND", handle="1A") + d.arc(5, 2, 2, 270, 360, layer="GROUND")
BACKWARD = d.lwpolyline([(7, 2, -0.41421356237309503), (5, 0), (-5, 0)], False, layer="GROUND")
CENTRE_LINE = d.line((0, -9), (0, 9), layer="AXES")
HEAD = '[bodies.ground]\ndrawing = "ground.dxf"\nmotion = "fixed"\n'
BALL = '[bodies.ball]\ncircle = "1 mm"\nmotion = "free"\nmass = "1 g"\nposition = ["0 mm", "2 mm"]\n'
CONTACT = '[[contacts]]\nbetween = ["ground.GROUND", "ball"]\n'


def scene(folder: Path, keys: str, entities: str = GROUND + CENTRE_LINE, contact: str = CONTACT, ball: str = BALL) -> Scene:
    (folder / "ground.dxf").write_bytes(d.dxf(entities))
    (folder / "scene.toml").write_text(HEAD + keys + ball + contact, encoding="utf-8")
    return load(folder / "scene.toml")


def faults(folder: Path, keys: str, entities: str = GROUND + CENTRE_LINE) -> str:
    with pytest.raises(SceneError) as caught:
        scene(folder, keys, entities)
    return str(caught.value)


@pytest.mark.parametrize("entities", [GROUND, BACKWARD], ids=["forward", "backward"])
@pytest.mark.parametrize("point", ['["-3 mm", "-0.2 mm"]', '["8 mm", "0 mm"]'])
def test_a_point_behind_the_face_says_it_however_it_was_drawn(tmp_path: Path, entities: str, point: str) -> None:
    (chain,) = scene(tmp_path, f"material = {{ GROUND = {point} }}\n", entities).body("ground").loops
    assert not chain.closed and chain.layer == "GROUND"
    line, arc = chain.edges if isinstance(chain.edges[0], Line) else reversed(chain.edges)
    assert isinstance(line, Line) and isinstance(arc, Arc)
    assert line.tangent(0.0) == pytest.approx((-1.0, 0.0), abs=1e-12), "material below is on the left of travel to the left"
    assert arc.sweep < 0.0, "material outside the circle"


def test_left_and_right_are_seen_along_the_drawn_direction(tmp_path: Path) -> None:
    for side, forward in (("left", 1.0), ("right", -1.0)):
        (chain,) = scene(tmp_path, f'layers = ["GROUND"]\nmaterial = "{side}"\n').body("ground").loops
        line = next(edge for edge in chain.edges if isinstance(edge, Line))
        assert line.tangent(0.0)[0] == pytest.approx(forward, abs=1e-12)


def test_without_layers_one_value_speaks_for_all_open_chains(tmp_path: Path) -> None:
    body = scene(tmp_path, 'material = "left"\n').body("ground")
    assert body.layers == ("GROUND", "AXES")
    only = scene(tmp_path, 'material = { GROUND = "left" }\n', GROUND + CENTRE_LINE + d.circle(0, 20, 1, layer="STUD")).body(
        "ground"
    )
    assert only.layers == ("STUD", "GROUND")


def test_contact_with_an_open_chain_of_unknown_side_is_an_error_that_says_how(tmp_path: Path) -> None:
    for keys in ("", 'layers = ["GROUND"]\n'):
        text = faults(tmp_path, keys)
        assert "the outline is open" in text and "LINE #1A" in text
        assert 'If it is to stay open: material = "left"' in text
    stray = faults(tmp_path, 'layers = ["AXES"]\n')
    assert "there is no closed outline on this layer. Its lines are open: close them, or write material" in stray


def test_mistakes_in_material(tmp_path: Path) -> None:
    assert "a side is left or right" in faults(tmp_path, 'material = "top"\n')
    text = faults(tmp_path, 'material = { GROND = "left", GROUND = ["1 mm"], AXES = ["0 mm", "1 mm"] }\n')
    assert "bodies.ground.material.GROND" in text and 'Did you mean "GROUND"?' in text
    assert "two values are needed here" in text
    assert "the point lies on the chain of layer AXES itself" in text
    assert 'add "AXES" to layers' in faults(tmp_path, 'layers = ["GROUND"]\nmaterial = { AXES = "left", GROUND = "right" }\n')
    assert "there is no open chain it could apply to" in faults(tmp_path, 'material = "left"\n', d.circle(0, 0, 1))
    with pytest.raises(SceneError, match="belongs to a drawing"):
        scene(tmp_path, 'material = "right"\n', ball=BALL + 'material = "left"\n')


@pytest.mark.parametrize(
    ("position", "depth"), [((5.3, 1.2), 0.0), ((6.2, 1.2), 0.4422205), ((0.0, 0.7), 0.3), ((0.0, 1.5), 0.0)]
)
def test_overlap_at_the_start_counts_behind_lines_and_arcs(tmp_path: Path, position: tuple[float, float], depth: float) -> None:
    x, y = position
    moved = BALL.replace('position = ["0 mm", "2 mm"]', f'position = ["{x} mm", "{y} mm"]')
    found = overlaps(scene(tmp_path, 'layers = ["GROUND"]\nmaterial = ["0 mm", "-1 mm"]\n', ball=moved))
    assert max((1e3 * overlap.depth for overlap in found), default=0.0) == pytest.approx(depth, abs=1e-4)


def test_outlines_that_cross_stop_contacts_and_masses_only(tmp_path: Path) -> None:
    plate = d.polygon([(0, 0), (1, 0), (1, 1)], layer="GROUND")
    cross = d.circle(9, 0, 1, layer="MARK") + d.circle(10, 0, 1, layer="MARK")
    loaded = scene(tmp_path, 'layers = ["GROUND"]\n', plate + cross, ball=BALL.replace("2 mm", "3 mm"))
    assert {(finding.code, finding.severity) for finding in loaded.findings} == {("crossing", "warning")}
    assert "two outlines cross at (9.5, 0.866025) mm" in faults(tmp_path, 'layers = ["GROUND", "MARK"]\n', plate + cross)
    solid = 'layers = ["GROUND"]\n[[bodies.ground.solids]]\nlayer = "MARK"\nthickness = "1 mm"\ndensity = "1 g/cm³"\n'
    assert "two outlines cross" in faults(tmp_path, solid, plate + cross)


@pytest.mark.parametrize(("unit", "beside", "refused"), [("mm", 1e-6, False), ("µm", 1e-6, False), ("mm", 1e-11, True)])
def test_a_point_counts_as_on_the_chain_by_a_share_of_its_length(
    tmp_path: Path, unit: str, beside: float, refused: bool
) -> None:
    """Chains of 10 mm and of 10 µm, points beside them in the same unit: less than a thousand-millionth says nothing."""
    code = {"mm": 4, "µm": 13}[unit]
    (tmp_path / "ground.dxf").write_bytes(d.dxf(d.line((-5, 0), (5, 0), layer="GROUND"), units=code))
    text = HEAD + f'material = {{ GROUND = ["0 {unit}", "{beside!r} {unit}"] }}\n' + BALL + CONTACT
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    if refused:
        with pytest.raises(SceneError, match="lies on the chain"):
            load(tmp_path / "scene.toml")
    else:
        assert load(tmp_path / "scene.toml").body("ground").loops[0].edges[0].tangent(0.0) == pytest.approx((1.0, 0.0))


def test_a_misspelt_layer_of_material_is_one_fault(tmp_path: Path) -> None:
    """That the side of the layer that was meant is not known only follows from it."""
    text = faults(tmp_path, 'layers = ["GROUND"]\nmaterial = { GROND = "left" }\n')
    assert 'Did you mean "GROUND"?' in text and "the outline is open" not in text and "no closed outline" not in text
