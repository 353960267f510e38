"""Are gears read as written, bound to one coordinate, and refused by name where they cannot be simulated?"""

from __future__ import annotations

import math

import pytest
from scene.made_gears import wheels

from watchsim.mechanism.check import check_report, check_text
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Gear, Geared
from watchsim.scene.trains import goes_with

THIRD = '[bodies.third]\nposition = ["20 mm", "0 mm"]\ninertia = "1 g·cm²"\n'


def faults(folder, **parts) -> dict[str, str]:
    with pytest.raises(SceneError) as caught:
        wheels(folder, **parts)
    return {fault.key: fault.message for fault in caught.value.faults}


def test_what_goes_with_a_body_either_way(tmp_path) -> None:
    scene = wheels(tmp_path)
    assert goes_with(scene, "wheel") == {"wheel": 1.0, "pinion": -8.0}
    assert goes_with(scene, "pinion") == {"pinion": 1.0, "wheel": -0.125}


def test_gears_without_play_bind_the_second_body_to_the_first(tmp_path) -> None:
    scene = wheels(tmp_path)
    assert scene.gears == () and scene.body("wheel").geared is None
    assert scene.body("pinion").geared == Geared("wheel", -8.0)
    compiled = compile_scene(scene)
    assert compiled.model.coordinates.mass.tolist() == [1e-7 + 64e-8]
    assert compiled.slices == {"wheel": slice(0, 1), "pinion": slice(1, 2)}


def test_gears_with_play_keep_both_coordinates(tmp_path) -> None:
    scene = wheels(tmp_path, gears='backlash = "0.5°"\nrestitution = 0.2\nefficiency = 0.95')
    assert scene.gears == (Gear(("wheel", "pinion"), -8.0, math.radians(0.5), 0.2, 0.95),)
    assert compile_scene(scene).model.coordinates.mass.tolist() == [1e-7, 1e-8]


def test_a_train_is_bound_to_one_of_its_wheels(tmp_path) -> None:
    """The one with a spring holds the coordinate; ratios multiply along the way."""
    more = THIRD + '[[gears]]\nbetween = ["third", "pinion"]\nratio = -0.5\n[[springs]]\nbody = "third"\nfrequency = "2 Hz"'
    scene = wheels(tmp_path, more=more)
    assert scene.body("third").geared is None
    assert scene.body("pinion").geared == Geared("third", -0.5)
    assert scene.body("wheel").geared == Geared("third", 0.0625)
    mass = 1e-7 + 0.25 * 1e-8 + 0.0625**2 * 1e-7
    assert compile_scene(scene).model.coordinates.mass == pytest.approx([mass], rel=1e-12)
    assert scene.springs[0].stiffness == pytest.approx(mass * (4.0 * math.pi) ** 2, rel=1e-12)


def test_a_velocity_is_that_of_all(tmp_path) -> None:
    scene = wheels(tmp_path, pinion='velocity = "80 °/s"')
    assert scene.body("wheel").velocity == pytest.approx((math.radians(-10.0),))
    found = faults(tmp_path, pinion='velocity = "80 °/s"', wheel='velocity = "10 °/s"')
    assert "contradicts" in found["bodies.pinion.velocity"]


def test_values_that_cannot_be_are_faults(tmp_path) -> None:
    found = faults(tmp_path, gears='backlash = "-1°"\nrestitution = 2\nefficiency = 0\nplay = 1')
    assert set(found) == {"gears.0.backlash", "gears.0.restitution", "gears.0.efficiency", "gears.0.play"}
    assert "must not be 0" in faults(tmp_path, ratio=0.0)["gears.0.ratio"]
    assert 'backlash = "0.5°"' in faults(tmp_path, gears="efficiency = 0.9")["gears.0.efficiency"]


def test_unknown_and_fixed_bodies_are_faults(tmp_path) -> None:
    found = faults(tmp_path, more='[[gears]]\nbetween = ["wheel", "pinon"]\nratio = 2')
    assert 'Did you mean "pinion"?' in found["gears.1.between.1"]
    found = faults(tmp_path, pinion='motion = "fixed"')
    assert "turn or slide" in found["gears.0.between.1"]
    assert "two bodies" in faults(tmp_path, more="[[gears]]\nbetween = 3\nratio = 2")["gears.1.between"]


def test_the_ratio_of_a_rack_is_a_length(tmp_path) -> None:
    rack = '[bodies.rack]\nmotion = "slide"\naxis = [1.0, 0.0]\nmass = "1 g"\n[[gears]]\nbetween = ["wheel", "rack"]\nratio = '
    for text in ('"10 mm/rad"', '"10 mm"', f'"{20.0 * math.pi!r} mm/rev"'):
        assert wheels(tmp_path, more=rack + text).body("rack").geared.ratio == pytest.approx(0.01)
    assert "mm/rad" in faults(tmp_path, more=rack + "10")["gears.1.ratio"]
    back = rack.replace('["wheel", "rack"]', '["rack", "wheel"]') + '"0.1 rad/mm"'
    assert wheels(tmp_path, more=back).body("wheel").geared is None
    assert wheels(tmp_path, more=back).body("rack").geared.ratio == pytest.approx(0.01)


def test_gears_that_bind_the_same_bodies_twice_are_a_fault(tmp_path) -> None:
    third = THIRD + '[[gears]]\nbetween = ["third", "pinion"]\nratio = -0.5\n'
    found = faults(tmp_path, more=third + '[[gears]]\nbetween = ["third", "wheel"]\nratio = 3.0')
    assert "already" in found["gears.2.between"]
    found = faults(tmp_path, more='[[gears]]\nbetween = ["wheel", "pinion"]\nratio = 3.0\nbacklash = "1°"')
    assert "already" in found["gears.1.between"]


def test_two_that_gravity_turns_cannot_be_bound(tmp_path) -> None:
    heavy = 'mass = "10 g"\ncentre_of_mass = ["1 mm", "0 mm"]'
    parts = {"scene": 'gravity = ["0 m/s²", "-9.81 m/s²"]', "pinion": heavy}
    assert wheels(tmp_path, **parts).body("pinion").geared is None
    found = faults(tmp_path, **parts, wheel=heavy)["gears.0.between"]
    assert "gravity turns pinion" in found and "gravity turns wheel" in found


def test_nothing_acts_on_what_is_geared_to_a_driven_body(tmp_path) -> None:
    parts = {"wheel": 'motion = "driven"\nvelocity = "10 rpm"', "more": '[[torques]]\nbody = "pinion"\nvalue = "1 µN·m"'}
    found = faults(tmp_path, **parts)
    assert "geared" in found["torques.0.body"]


def test_check_tells_of_gears(tmp_path) -> None:
    scene = wheels(tmp_path, more=THIRD + '[[gears]]\nbetween = ["third", "pinion"]\nratio = -0.5\nbacklash = "0.5°"')
    text = check_text(check_report(scene, ()), scene)
    assert "pinion is geared to wheel: -8 turns for one turn of it" in text
    assert "felt at wheel with all that is geared to it: 7400 mg·cm²" in text
    assert "gears third - pinion: -0.5 turns for one turn, play 0.5°" in text
