"""Are teeth counted, whatever their shape?"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from analysis.made_beats import lever_scene, polygon, star

from watchsim.analysis.timing.teeth import pitch, tooth_count
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line


def circle(x: float, y: float, radius: float, hole: bool = False) -> Loop:
    return Loop((Arc(x, y, radius, 0.0, -math.tau if hole else math.tau),), "TEETH", True, hole)


def regular(corners: int) -> Loop:
    return polygon([2e-3 * complex(math.cos(k * math.tau / corners), math.sin(k * math.tau / corners)) for k in range(corners)])


@pytest.mark.parametrize("teeth", [2, 8, 15, 20, 31, 120])
def test_pointed_teeth(teeth):
    assert tooth_count([star(teeth)]) == teeth
    assert tooth_count([star(teeth).moved(0.3, (0.0, 0.0))]) == teeth


def test_arms_and_bore_do_not_count():
    bore, window = circle(0.0, 0.0, 3e-4, hole=True), polygon([1e-3 + 0j, 1.2e-3 + 1e-4j, 1e-3 + 2e-4j], hole=True)
    scene = lever_scene()
    wheel = replace(scene.body("wheel"), loops=(star(15), bore, window))
    bodies = tuple(wheel if body.name == "wheel" else body for body in scene.bodies)
    assert pitch(replace(scene, bodies=bodies), "wheel") == pytest.approx(math.radians(24.0))


def test_layers_that_touch_nothing_do_not_count():
    scene = lever_scene()
    mark = replace(star(1, 1e-3, 9e-4), layer="MARK")
    wheel = replace(scene.body("wheel"), loops=(star(15), mark))
    bodies = tuple(wheel if body.name == "wheel" else body for body in scene.bodies)
    assert math.tau / pitch(replace(scene, bodies=bodies), "wheel") == pytest.approx(15.0)


def test_pins_of_a_lantern_wheel():
    pins = [circle(2e-3 * math.cos(k * math.tau / 12), 2e-3 * math.sin(k * math.tau / 12), 1e-4) for k in range(12)]
    assert tooth_count(pins) == 12


def test_two_wheels_on_one_arbor():
    assert tooth_count([star(8), star(8, 1.0e-3, 8e-4).moved(0.2, (0.0, 0.0))]) == 8
    assert tooth_count([star(12), star(8, 1.0e-3, 8e-4)]) == 4


def test_slightly_inaccurate_drawings():
    """Each corner off by 2 µm in 2.5 mm."""
    points = [edge.start for edge in star(15).edges]
    shaken = [complex(x, y) + 2e-6 * complex(math.cos(7.0 * i * i), math.sin(11.0 * i * i)) for i, (x, y) in enumerate(points)]
    assert tooth_count([polygon(shaken)]) == 15


def test_what_has_no_teeth():
    assert tooth_count([circle(0.0, 0.0, 2e-3)]) == 0
    assert tooth_count([]) == 0
    assert tooth_count([Loop((Line(1e-3, 0.0, 1e-3, 0.0), Line(0.0, 0.0, 0.0, 0.0)), "TEETH", True)]) == 0
    assert tooth_count([regular(3).moved(0.0, (1e-3, 0.0))]) == 1
    scene = lever_scene()
    assert pitch(scene, "lever") is None and pitch(scene, "banking") is None


def test_wheels_that_share_an_outline_have_their_own_teeth() -> None:
    """Asked one after the other, and again: what is known of one is not taken for another."""
    rim, scene = star(12), lever_scene()
    for teeth, known in ((8, 4), (6, 6), (2, 2), (9, 3), (8, 4), (5, None), (6, 6)):
        wheel = replace(scene.body("wheel"), loops=(rim, star(teeth, 1.6e-3, 1.1e-3)))
        found = pitch(replace(scene, bodies=(wheel, *scene.bodies[:2])), "wheel")
        assert found is None if known is None else found == pytest.approx(math.tau / known, rel=1e-12)


def test_wheels_of_other_outlines_have_their_own_teeth() -> None:
    scene = lever_scene()
    for teeth in (12, 8, 9, 12):
        wheel = replace(scene.body("wheel"), loops=(star(teeth),))
        found = pitch(replace(scene, bodies=(wheel, *scene.bodies[:2])), "wheel")
        assert found == pytest.approx(math.tau / teeth, rel=1e-12)


@pytest.mark.parametrize(("share", "count"), [(0.0475, 15), (0.0525, 5)])
def test_inaccuracies_are_less_than_a_twentieth_of_the_largest_moment(share: float, count: int) -> None:
    """Fifteen short pieces, and five at half the radius: moments go with their length and the square of that."""
    turns = [complex(math.cos(k * math.tau / 15), math.sin(k * math.tau / 15)) for k in range(15)]
    pieces = [(1e-3 * z, 1e-6) for z in turns] + [(5e-4 * z, 4e-6 * 3.0 * share / (1.0 - share)) for z in turns[::3]]
    ends = [(z - 0.5j * w * z / abs(z), z + 0.5j * w * z / abs(z)) for z, w in pieces]
    edges = tuple(Line(a.real, a.imag, b.real, b.imag) for a, b in ends)
    assert tooth_count([Loop(edges, "TEETH", True)]) == count


@pytest.mark.parametrize(("teeth", "count"), [(240, 240), (241, 0)])
def test_a_wheel_has_up_to_240_teeth(teeth: int, count: int) -> None:
    assert tooth_count([star(teeth)]) == count
