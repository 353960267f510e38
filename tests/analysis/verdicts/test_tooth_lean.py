"""Is it seen which way teeth are made to turn?"""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import pytest
from analysis.made_beats import lever_scene, polygon, star
from analysis.made_faults import swiss, turned_over

from watchsim.analysis.timing.teeth import pitch
from watchsim.analysis.verdicts.tooth_lean import teeth
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load


def with_rim(loop):
    scene = lever_scene()
    return replace(scene, bodies=tuple(replace(one, loops=(loop,)) if one.name == "wheel" else one for one in scene.bodies))


def leaning(lean: float, count: int = 15, turned: float = 0.0):
    """Pointed teeth, rim 2.4 and root 1.9 mm, whose points stand `lean` (of the pitch) anticlockwise of their middle."""
    pitch = math.tau / count
    points = []
    for k in range(count):
        for radius, at in ((1.9e-3, -0.4), (2.4e-3, lean), (1.9e-3, 0.4)):
            angle = turned + (k + at) * pitch
            points.append(radius * complex(math.cos(angle), math.sin(angle)))
    return polygon(points)


@pytest.mark.parametrize("lean", [-0.35, -0.1, 0.1, 0.35])
@pytest.mark.parametrize("turned", [0.0, 2.0])
def test_pointed_teeth(lean, turned):
    """At a share h of their height the middle of the teeth is at lean · h: half the lean lies between the halves, or less."""
    found = teeth(with_rim(leaning(lean, turned=turned)), "wheel")
    assert found.direction == math.copysign(1.0, lean)
    assert 0.25 * abs(lean) < abs(found.lean) / found.pitch < 0.6 * abs(lean)


def test_upright_teeth_are_made_for_no_direction():
    assert teeth(with_rim(leaning(0.0)), "wheel").direction == 0.0


def test_wheels_of_the_profiles_turn_as_their_teeth_lean():
    for name in ("swiss_lever", "bench_lever"):
        scene = load(profiles_dir() / name)
        assert teeth(scene, "wheel").direction == -1.0
        assert teeth(turned_over(scene), "wheel").direction == 1.0


def test_a_plain_disc_has_no_teeth():
    assert teeth(with_rim(polygon([1e-3 * complex(math.cos(t), math.sin(t)) for t in (0.0, 2.0, 4.5)])), "wheel") is None


def test_teeth_too_shallow_for_an_inner_half_lean_neither_way():
    """Corners of a polygon are teeth, 1 - cos 12° = 0.022 of its rim deep; the inner half begins at 0.4 · 24° / 2 = 0.084."""
    corners = [2e-3 * cmath.rect(1.0, k * math.tau / 15) for k in range(15)]
    scene = with_rim(polygon(corners))
    assert pitch(scene, "wheel") == pytest.approx(math.tau / 15, rel=1e-12)
    assert teeth(scene, "wheel") is None


def test_teeth_are_counted_anticlockwise_from_the_x_axis():
    found = teeth(with_rim(star(15)), "wheel")
    numbers = [found.number(k * math.tau / 15 + 0.02) for k in range(-1, 16)]
    assert numbers == [15, *range(1, 16), 1]
    swiss_teeth = teeth(swiss(), "wheel")
    assert [swiss_teeth.number(math.radians(angle)) for angle in (0.0, 4.0, 24.1, -24.0, 360.0)] == [1, 1, 2, 15, 1]
