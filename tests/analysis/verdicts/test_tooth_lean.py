"""Is it seen which way teeth are made to turn?"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from analysis.made_beats import lever_scene, polygon, star
from analysis.made_faults import swiss, turned_over
from scipy.integrate import quad
from scipy.optimize import brentq

from watchsim.analysis.timing.teeth import pitch
from watchsim.analysis.verdicts.tooth_lean import Teeth, _points, teeth
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load


def with_rim(*loops):
    scene = lever_scene()
    return replace(scene, bodies=tuple(replace(one, loops=loops) if one.name == "wheel" else one for one in scene.bodies))


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


def phase(lean: float, low: float, high: float) -> float:
    """Of ∫∫ exp(i Z φ) dφ dr over the tooth of `leaning` at angle 0, between two radii (m)."""
    pitch = math.tau / 15

    def flank(at: float, radius: float) -> float:
        foot, tip = cmath.rect(1.9e-3, at * pitch), cmath.rect(2.4e-3, lean * pitch)
        share = brentq(lambda part: abs(foot + part * (tip - foot)) - radius, 0.0, 1.0, xtol=1e-15) if radius < 2.4e-3 else 1.0
        return cmath.phase(foot + share * (tip - foot))

    def across(radius: float, part: Callable[[float], float]) -> float:
        mean = quad(lambda angle: part(15 * angle), flank(-0.4, radius), flank(0.4, radius))
        return float(mean[0])

    real, imag = (quad(across, low, high, args=(part,))[0] for part in (math.cos, math.sin))
    return math.atan2(imag, real)


@pytest.mark.parametrize("lean", [-0.3, 0.12])
@pytest.mark.parametrize("turned", [0.0, 0.05])
@pytest.mark.parametrize("further", [False, True])
def test_the_middle_of_two_halves_of_a_tooth(lean, turned, further):
    """Down to 0.4 of the pitch at the rim. A smaller toothed outline beside it lies below that."""
    outlines = [leaning(lean, turned=turned), *([star(15, 1.1e-3, 0.9e-3)] if further else [])]
    found = teeth(with_rim(*outlines), "wheel")
    depth = 0.4 * math.tau / 15 * 2.4e-3
    outer, inner = phase(lean, 2.4e-3 - 0.5 * depth, 2.4e-3), phase(lean, 2.4e-3 - depth, 2.4e-3 - 0.5 * depth)
    assert found.pitch == pytest.approx(math.tau / 15, rel=1e-12)
    assert found.lean == pytest.approx((outer - inner) / 15, rel=2e-4)
    assert found.first == pytest.approx(outer / 15 + turned, rel=2e-4)


@pytest.mark.parametrize(("lean", "way"), [(0.019, 0.0), (-0.019, 0.0), (0.021, 1.0), (-0.021, -1.0)])
def test_a_fiftieth_of_the_pitch_is_a_lean(lean, way):
    assert Teeth(0.4, lean * 0.4, 0.1).direction == way


@pytest.mark.parametrize("count", [7, 15])
@pytest.mark.parametrize("first", [0.01, -0.11, 0.9, 3.0])
def test_each_tooth_has_a_number(count, first):
    """The one nearest to the x axis is the first, whichever of them was looked at; up to half a pitch off it is still that."""
    pitch = math.tau / count
    middles = sorted((first + k * pitch for k in range(count)), key=lambda angle: abs(math.remainder(angle, math.tau)))
    for k in range(-3, 2 * count):
        for off in (-0.49, 0.2, 0.49):
            assert Teeth(pitch, 0.1, first).number(middles[0] + (k + off) * pitch) == k % count + 1
    assert Teeth(pitch, 0.1, first).count == count


def test_points_go_round_an_outline_once():
    corners = [3e-3 + 1e-3j, 2e-3 + 5e-3j, -4e-3 - 2e-3j]
    found = _points(polygon(corners))
    assert found[0] == found[-1] == corners[0] and abs(found[1] - found[0]) > 0.0
    length = sum(abs(b - a) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True))
    assert abs(np.diff(found)).sum() == pytest.approx(length, rel=1e-12, abs=0.0)
