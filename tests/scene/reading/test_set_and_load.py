"""Do values of --set take the place of the file's before anything is judged?"""

from __future__ import annotations

import pytest
from made_scenes import drawing, square

from watchsim.scene.errors import SceneError
from watchsim.scene.load import changed, load, load_set


def test_a_faulty_value_is_replaced(desk, good):
    bad = desk.scene(good.replace('drawing = "wheel.dxf"', 'drawing = "lost.dxf"').replace('"180 s"\n', "180\n"))
    mended = load_set(bad, {"bodies.wheel.drawing": "wheel.dxf", "run.duration": "20 s"})
    assert mended == changed(load(desk.scene(good)), {"run.duration": "20 s"})


def test_every_fault_is_told_once_with_its_source(desk, good):
    bad = desk.scene(good.replace("friction = 0.12", "friction = -1"))
    with pytest.raises(SceneError) as caught:
        load_set(bad, {"torques.0.value": "3 mm", "bodies.whel.angle": "1°"})
    assert {(fault.key, fault.place.rpartition("/")[2]) for fault in caught.value.faults} == {
        ("contacts.0.friction", "scene.toml:42"),
        ("torques.0.value", "--set"),
        ("bodies.whel.angle", "--set"),
    }


def test_one_coordinate_of_a_place_that_the_drawing_gives(desk):
    """The pivot is at (5, -7) mm in the drawing, where the body stands; a new pivot moves what is not said."""
    desk.put(drawing("plate.dxf", (square(2e-3, (5e-3, -7e-3), "B"),), points=(("Q", 5e-3, -7e-3),)))
    path = desk.scene('[bodies.b]\ndrawing = "plate.dxf"\nlayers = ["B"]\nposition = "as drawn"\npivot = "Q"\nmass = "2 g"\n')
    assert load_set(path, {"bodies.b.position.0": "6 mm"}).body("b").position == pytest.approx((6e-3, -7e-3))
    both = {"bodies.b.position.0": "6 mm", "bodies.b.pivot": ["5 mm", "-8 mm"]}
    assert load_set(path, both).body("b").position == pytest.approx((6e-3, -8e-3))
    with pytest.raises(SceneError, match=r'^--set  bodies\.b\.position\.0 = "6 s"\n.*here a length is needed'):
        load_set(path, {"bodies.b.position.0": "6 s"})


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("bodies = 5", "bodies.wheel.angle"),
        ("[bodies]\nwheel = 5", "bodies.wheel.angle"),
        ("run = 5", "run.duration"),
        ("expect = 5", "expect.rate.value"),
        ("springs = 5", "springs.0.rest"),
        ("springs = [5]", "springs.0.rest"),
        ("[bodies.wheel]\nsolids = 5", "bodies.wheel.solids.0.density"),
        ("[bodies.wheel]\nsolids = [5]", "bodies.wheel.solids.0.density"),
        ("[bodies.wheel]\nswing = 5", "bodies.wheel.swing.phase"),
        ("[[torques]]\ntrain = [5]", "torques.0.train.0.ratio"),
    ],
)
def test_what_is_no_table_is_left_to_the_reader(desk, text, key):
    with pytest.raises(SceneError) as caught:
        load_set(desk.scene(text), {key: "1"})
    assert caught.value.faults and key not in [fault.key for fault in caught.value.faults]


def test_a_design_takes_its_values_first(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('[design]\nof = "swiss_lever"\nlock = "95°"\n', encoding="utf-8")
    assert load_set(path, {"design.lock": "2°"}).path == path
    with pytest.raises(SceneError, match=r'^--set  design\.lock = "96°"'):
        load_set(path, {"design.lock": "96°"})
