"""Does a scene take its bodies from SVG drawings as it does from DXF?"""

import math

import pytest

from watchsim.geometry.primitives import Arc
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load

ROLLER = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
 {page} viewBox="0 0 10 10">
 <g inkscape:groupmode="layer" inkscape:label="ROLLER" transform="translate(4,6)">
  <circle r="2"/>
 </g>
 <g inkscape:groupmode="layer" inkscape:label="PIN" transform="translate(4,6)">
  <path d="M 1.2,-0.25 h 0.3 a 0.25,0.25 0 0 1 0,0.5 h -0.3 z"/>
 </g>
 <circle id="PIVOT" cx="4" cy="6" r="{pivot}"/>
 <g id="DRESS"><path d="M 0 0 L 1 1"/><text>Hebelscheibe</text></g>
</svg>"""
SCENE = """[bodies.balance]
drawing = "roller.svg"
layers = ["ROLLER", "PIN"]
pivot = "PIVOT"
{units}
[[bodies.balance.solids]]
layer = "ROLLER"
thickness = "0.5 mm"
density = "8 g/cm³"
"""


def written(tmp_path, page='width="10mm" height="10mm"', units="", pivot="0.1"):
    (tmp_path / "roller.svg").write_text(ROLLER.format(page=page, pivot=pivot), encoding="utf-8")
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(units=units), encoding="utf-8")
    return scene


@pytest.mark.parametrize("pivot", ["0.1", "0"])
@pytest.mark.parametrize(
    ("page", "units", "unit"),
    [('width="10mm" height="10mm"', "", 1e-3), ("", 'units = "mm"', 1e-3), ('width="500"', 'units = "inch"', 0.0254)],
)
def test_a_roller_turns_about_its_pivot(tmp_path, page, units, unit, pivot):
    (balance,) = load(written(tmp_path, page, units, pivot)).bodies
    radius = 2 * unit
    mass = math.pi * radius**2 * 0.5e-3 * 8000
    assert balance.mass == pytest.approx(mass, rel=1e-12, abs=0.0)
    assert balance.inertia == pytest.approx(mass * radius**2 / 2, rel=1e-12, abs=0.0)
    assert sorted(loop.layer for loop in balance.loops) == ["PIN", "ROLLER"]
    (pin,) = (loop for loop in balance.loops if loop.layer == "PIN")
    (head,) = (edge for edge in pin.edges if isinstance(edge, Arc))
    assert (head.x, head.y, head.radius) == pytest.approx((1.5 * unit, 0.0, 0.25 * unit), abs=1e-14)


def test_a_page_without_unit_and_a_wrong_layer_are_told(tmp_path):
    with pytest.raises(SceneError) as caught:
        load(written(tmp_path, 'width="500" height="500"'))
    assert "bodies.balance.drawing -> roller.svg\n  the drawing does not say its units" in str(caught.value)
    scene = written(tmp_path)
    scene.write_text(scene.read_text(encoding="utf-8").replace('"PIN"]', '"PINS"]'), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load(scene)
    assert 'Did you mean "PIN"?' in str(caught.value)
