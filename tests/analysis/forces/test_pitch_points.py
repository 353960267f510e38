"""Do the teeth of two gears press on one another where both go alike, with the moments that each body feels?

The pitch point is found here by solving for it; forces and moments are crossed out in the plane.
"""

from __future__ import annotations

import math
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis import mesh_forces as module
from watchsim.analysis.mesh_forces import _at_pitch_point, _in_the_movement, _on_the_second
from watchsim.scene.body import Body
from watchsim.scene.carriers import Ride
from watchsim.scene.gearing import Gear

LEAN = 0.35
ON_SECOND, ON_FIRST = np.array([3e-3, -4e-3, 0.7e-3]), np.array([5e-3, 1e-3, -2.2e-3])  # N·m, sliding: N


def told(first: Body, second: Body, ratio: float) -> Any:
    scene: Any = SimpleNamespace(bodies=(Body("other"), second, Body("another"), first))
    gear = Gear((first.name, second.name), ratio, 0.0, pressure_angle=LEAN)
    return _on_the_second(scene, gear, (3, 1), (ON_FIRST, ON_SECOND))


def cross(a: Any, b: Any) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


@pytest.mark.parametrize("places", [((1e-3, 2e-3), (7e-3, -6e-3)), ((0.0, 0.0), (-3e-3, 4e-3)), ((0.0, 5e-3), (0.0, 1e-3))])
@pytest.mark.parametrize("ratio", [-0.5, -3.0, 3.0, 0.25, 1.5, 5e-4])
def test_two_wheels(places: Any, ratio: float) -> None:
    """What both feel along the tangent is averaged; outside teeth press apart, those of a ring press the pinion inwards."""
    a, b = (np.array(place) for place in places)
    found = told(Body("first", position=places[0]), Body("second", position=places[1]), ratio)
    # ω_b = ratio ω_a, and at A + s (B - A) both go alike: s = ratio (s - 1).
    point = a + ratio / (ratio - 1.0) * (b - a)
    assert np.linalg.norm(point - a) == pytest.approx(abs(ratio) * np.linalg.norm(point - b), rel=1e-12, abs=0.0)
    along = (b - a) / np.linalg.norm(b - a)
    tangent = np.array((-along[1], along[0]))
    for mine, other, force in zip(ON_SECOND, ON_FIRST, found, strict=True):
        share = 0.5 * (mine / cross(point - b, tangent) - other / cross(point - a, tangent))
        assert force @ tangent == pytest.approx(share, rel=1e-12, abs=0.0)
        apart = math.tan(LEAN) * abs(share) * (1.0 if ratio < 0.0 else -1.0)
        assert force @ along == pytest.approx(apart, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("degrees", [0.0, 35.0, 160.0, -110.0])
@pytest.mark.parametrize("reach", [4e-3, -4e-3, 0.3e-3])
@pytest.mark.parametrize("rack_first", [True, False])
def test_a_wheel_and_a_rack(degrees: float, reach: float, rack_first: bool) -> None:
    """`reach`: metres of the rack for a radian of the wheel, about whose axis everything is measured."""
    axis = np.array((math.cos(math.radians(degrees)), math.sin(math.radians(degrees))))
    rack, wheel = Body("rack", "slide", axis=(axis[0], axis[1]), position=(9.0, 7.0)), Body("wheel", position=(3.0, -8.0))
    point = next(p for p in (abs(reach) * np.array((-axis[1], axis[0])), abs(reach) * np.array((axis[1], -axis[0])))
                 if cross(p, reach * axis) > 0.0)  # fmt: skip
    found = told(rack, wheel, 1.0 / reach) if rack_first else told(wheel, rack, reach)
    on_rack, on_wheel = (ON_FIRST, ON_SECOND) if rack_first else (ON_SECOND, ON_FIRST)
    for push, torque, force in zip(on_rack, on_wheel, found, strict=True):
        of_rack = -force if rack_first else force
        share = 0.5 * (push - torque / cross(point, axis))
        assert of_rack @ axis == pytest.approx(share, rel=1e-12, abs=0.0)
        assert of_rack @ point / abs(reach) == pytest.approx(math.tan(LEAN) * abs(share), rel=1e-12, abs=0.0)


def test_where_there_is_no_pitch_point_nothing_is_told() -> None:
    slides = Body("rack", "slide"), Body("other rack", "slide")
    assert told(*slides, 2.0) is None
    here = Body("first", position=(1e-3, 0.0)), Body("second", position=(1e-3, 0.0))
    there = Body("third", position=(1e-3, 1e-3))
    assert told(*here, 2.0) is None and told(here[0], there, 1.0) is None
    assert told(here[0], there, 1.25) is not None and told(here[0], there, -1.0) is not None


def test_a_body_that_rides_on_the_other() -> None:
    """A turn of the carrier takes its planet with it, and the gears turn it besides."""
    hung = (Ride(0), Ride(1, 0, (1e-3, 0.0), 0), Ride(2))
    for ratio in (-3.0, 0.4, 2.5):
        assert _in_the_movement(ratio, hung, 0, 1) == pytest.approx(1.0 + ratio, rel=1e-12)
        # The first, carried by the second, goes 1 / ratio against it.
        assert _in_the_movement(ratio, hung, 1, 0) == pytest.approx(1.0 / (1.0 / ratio + 1.0), rel=1e-12, abs=0.0)
        assert _in_the_movement(ratio, hung, 0, 2) == ratio == _in_the_movement(ratio, hung, 2, 1)


@pytest.mark.parametrize(("first", "second"), [(0, 1), (1, 0)])
def test_the_planet_is_asked_with_its_own_torque_and_ratio(monkeypatch: pytest.MonkeyPatch, first: int, second: int) -> None:
    hung = (Ride(0), Ride(1, 0, (1e-3, 0.0), 0))
    asked: list[Any] = []

    def noted(*args: Any) -> Any:
        asked.append(args[4:])
        return iter(())

    monkeypatch.setattr(module, "_on_the_planet", noted)
    nothing: Any = None
    gear = Gear(("a", "b"), 4.0, 0.0)
    torques = (ON_FIRST, ON_SECOND)
    assert list(_at_pitch_point(nothing, nothing, nothing, gear, (first, second), torques, hung)) == []
    (got,) = asked
    assert got[0] == (0, 1) and got[1] is torques[0 if first == 1 else 1] and got[2] == (0.25 if first == 1 else 4.0)


def test_what_presses_on_the_one_presses_back_on_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    force = np.array([[1.0, -2.0], [3.0, 0.5]])
    hung, nothing = (Ride(0), Ride(1), Ride(2)), SimpleNamespace()
    found: Any = force
    monkeypatch.setattr(module, "_on_the_second", lambda *_: found)
    for first, second in product((0, 2), (1,)):
        gear: Any = SimpleNamespace()
        one, other = _at_pitch_point(nothing, nothing, nothing, gear, (first, second), (ON_FIRST, ON_SECOND), hung)  # type: ignore[arg-type]
        assert (one.body, other.body) == (second, first)
        assert np.array_equal(one.force, force) and np.array_equal(other.force, -force)
    found = None
    assert list(_at_pitch_point(nothing, nothing, nothing, gear, (0, 1), (ON_FIRST, ON_SECOND), hung)) == []  # type: ignore[arg-type]
