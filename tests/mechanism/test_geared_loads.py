"""What does gravity do to a geared rack, and where do the gears of a planet roll?"""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from made_gears import read

from watchsim.mechanism.backlash import rack_ways
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.carriers import rides

RACK = """
[scene]
gravity = ["2 m/s²", "-9.81 m/s²"]
[bodies.wheel]
inertia = "1 g·cm²"
[bodies.rack]
motion = "slide"
axis = [3, 4]
mass = "50 g"
position = ["9 mm", "0 mm"]
[[gears]]
between = ["wheel", "rack"]
ratio = "40 mm/rad"
"""
PLANET = """
[bodies.carriage]
inertia = "20 mg·cm²"
[bodies.planet]
on = "carriage"
position = ["3 mm", "4 mm"]
mass = "10 mg"
inertia = "1 mg·cm²"
[[gears]]
between = ["carriage", "planet"]
ratio = {ratio}
backlash = "0.5°"
"""


def test_gravity_pulls_an_oblique_rack_along_its_axis(tmp_path: Path) -> None:
    """By virtual work: the weight goes 40 mm along (0.6, 0.8) for each radian of the wheel."""
    (pull,) = compile_scene(read(tmp_path, RACK)).model.coordinates["force"]
    assert pull == pytest.approx(50e-3 * 40e-3 * (0.6 * 2.0 - 0.8 * 9.81), rel=1e-12)


@pytest.mark.parametrize("ratio", [8.0, -3.0, 0.25])
def test_a_planet_rolls_where_its_rim_stands_still(ratio: float, tmp_path: Path) -> None:
    """Carried 5 mm from the axis at unit rate, turning at 1 + ratio: at the pitch point both speeds cancel."""
    scene = read(tmp_path, PLANET.format(ratio=ratio))
    ways = rack_ways(scene, rides(scene.bodies), scene.gears[0], 1.0)
    inwards = math.copysign(ways.reach, 1.0 + ratio)
    assert 5e-3 - (1.0 + ratio) * inwards == pytest.approx(0.0, abs=1e-15)
