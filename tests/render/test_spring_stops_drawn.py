"""Is the stop of a spring drawn as a pin that the body touches where it comes to its stop, and nowhere else?"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import tomllib
from shapely.affinity import rotate, translate
from shapely.geometry import Point as Spot
from shapely.geometry import Polygon

import watchsim as ws
from watchsim.render.palette import FIXED
from watchsim.render.patches import stop_pins
from watchsim.render.stage import Stage
from watchsim.render.view import poses
from watchsim.scene.load import from_mapping
from watchsim.scene.scene import Scene

ARM = [(-1.0, -0.6), (9.0, -0.3), (10.0, 0.0), (9.0, 0.4), (-1.0, 0.7)]  # mm
CORNERS = ", ".join(f'["{x} mm", "{y} mm"]' for x, y in ARM)
SPRING = '[[springs]]\nbody = "click"\nstiffness = "50 µN·m/rad"\n'


def scene_of(spring: str, more: str = "", body: str = "") -> Scene:
    click = f'[bodies.click]\npolygon = [{CORNERS}]\ninertia = "100 g·mm²"\n{body}\n'
    return from_mapping(tomllib.loads(f'{click}{SPRING}{spring}\n{more}\n[run]\nduration = "0.1 s"\n'), Path("x/scene.toml"))


@pytest.mark.parametrize(("stop", "rest"), [("10°", "30°"), ("-5°", "-40°"), ("100°", "140°")])
def test_the_pin_touches_the_arm_at_the_stop_on_the_side_of_the_spring(stop: str, rest: str) -> None:
    scene = scene_of(f'stop = "{stop}"\nrest = "{rest}"', body='position = ["3 mm", "-2 mm"]')
    (pin,) = stop_pins(scene)
    at, to = (float(text.rstrip("°")) for text in (stop, rest))
    disc = Spot(1e3 * pin.place[0], 1e3 * pin.place[1]).buffer(1e3 * pin.radius, 256)

    def overlap(angle: float) -> float:
        return float(translate(rotate(Polygon(ARM), angle, origin=(0, 0)), 3.0, -2.0).intersection(disc).area)

    towards = math.copysign(1.0, to - at)
    assert pin.on is None
    assert overlap(at - 0.2 * towards) == 0.0  # free before the stop
    assert overlap(at + 0.2 * towards) > 0.0  # and inside the pin just behind it
    assert overlap(at - 90.0 * towards) == 0.0


def test_a_slider_stands_before_its_pin() -> None:
    body = 'motion = "slide"\naxis = [0.0, 1.0]\nmass = "1 g"'
    click = f'[bodies.click]\npolygon = [{CORNERS}]\n{body}\n[[springs]]\nbody = "click"\nstiffness = "10 N/m"\n'
    scene = from_mapping(tomllib.loads(f'{click}stop = "-1 mm"\nrest = "-2 mm"\n'), Path("x/scene.toml"))
    (pin,) = stop_pins(scene)
    assert pin.place[1] + pin.radius == pytest.approx(-1.6e-3, abs=1e-12)  # lowest corner, a millimetre down


def test_on_another_body_it_goes_with_that() -> None:
    other = '[bodies.wheel]\ncircle = "1 mm"\nposition = ["5 mm", "0 mm"]\nangle = "30°"\ninertia = "300 g·mm²"\n'
    scene = scene_of('against = "wheel"\nstop = "-10°"\nrest = "20°"', other, body='angle = "-20°"')
    (pin,) = stop_pins(scene)
    assert pin.on == "wheel"
    # In the movement, with the wheel at 30°, the arm comes to it at 20°.
    place = complex(5.0, 0.0) + 1e3 * complex(*pin.place) * np.exp(1j * math.radians(30.0))
    arm = rotate(Polygon(ARM), 20.0, origin=(0, 0))
    assert arm.distance(Spot(place.real, place.imag)) == pytest.approx(1e3 * pin.radius, abs=2e-3)


def test_pictures_show_it() -> None:
    scene = scene_of('stop = "-5°"\nrest = "-40°"', body='angle = "20°"')
    run = ws.simulate(scene, duration=0.01)
    stage = Stage(run, (960, 540), (0.0, 0.01))
    frames = {name: rows[0] for name, rows in poses(run, np.array([0.0])).items()}
    (pin,) = stop_pins(scene)
    x, y, _ = stage.view.matrix(stage.view.centre_at(frames)) @ (*pin.place, 1.0)
    seen = stage.draw(0.0, frames)[540 - 1 - math.floor(y), math.floor(x), :3].astype(int)
    assert np.abs(seen - [int(FIXED.fill[k : k + 2], 16) for k in (1, 3, 5)]).max() < 10
