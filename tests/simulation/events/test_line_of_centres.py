"""Is motion smooth where friction has no lever arm, or one parallel to that of the normal force, in every orientation?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EventKind
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

MM = 1e-3


def turned(points: list[tuple[float, float]], angle: float) -> Loop:
    """A polygon (mm), turned in its own frame."""
    c, s = math.cos(angle), math.sin(angle)
    corners = [(MM * (x * c - y * s), MM * (x * s + y * c)) for x, y in points]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))


def blade(tilt: float, drawn: tuple[float, float] = (0.0, 0.0), friction: float = 0.12) -> Scene:
    """A tooth's tip pushes a radial blade past the line of centres; `tilt` turns all, `drawn` each outline in its own frame."""
    wheel = turned([(0.0, 2.4), (-0.3, 1.8), (-0.05, 1.8)], drawn[0])
    face = turned([(0.0, -1.08), (0.1, -1.08), (0.1, -0.6), (0.0, -0.6)], drawn[1])
    apart, eight, five = 3.372e-3, math.radians(8.0), math.radians(-5.0)
    bodies = (
        Body("wheel", "pivot", (0.0, 0.0), eight + tilt - drawn[0], inertia=5e-12, loops=(wheel,)),
        Body(
            "balance",
            "pivot",
            (-apart * math.sin(tilt), apart * math.cos(tilt)),
            five + tilt - drawn[1],
            velocity=(math.radians(3000.0),),
            inertia=1.2e-9,
            loops=(face,),
        ),
    )
    touching = (Contact((Side("wheel"), Side("balance")), friction, 0.0),)
    return Scene("blade", bodies, torques=(Torque("wheel", -1e-5),), contacts=touching, duration=0.015)


@pytest.mark.parametrize("friction", [0.0, 0.12])
def test_a_blade_passes_the_line_of_centres_alike_in_all_orientations(friction: float) -> None:
    rng = np.random.default_rng(7)
    reference = simulate(blade(0.0, friction=friction))
    assert reference.stop == Stop.DURATION
    assert abs(reference.energy["residual_relative"]) < 1e-8
    for _ in range(25):
        tilt, *drawn = rng.uniform(0.0, 2.0 * math.pi, 3)
        done = simulate(blade(tilt, (drawn[0], drawn[1]), friction))
        assert done.stop == Stop.DURATION
        np.testing.assert_allclose(done.end_u, reference.end_u, rtol=1e-8)
        turn = done.end_q - done.q[0]
        np.testing.assert_allclose(turn, reference.end_q - reference.q[0], rtol=1e-8)


def test_friction_takes_only_what_its_lever_arm_allows() -> None:
    """Near the line of centres friction does no work: the balance ends as fast as without it to first order of the arm."""
    with_friction, without = (simulate(blade(0.0, friction=mu)).end_u[1] for mu in (0.12, 0.0))
    assert with_friction == pytest.approx(without, rel=0.02)
    assert with_friction != without


def sliders(mirrored: bool, restitution: float, friction: float = 0.5) -> Scene:
    """Two sliders on parallel axes whose tilted faces meet: slip is a multiple of approach."""
    sign = -1.0 if mirrored else 1.0
    one = Body("one", "slide", (-8e-3, 0.0), velocity=(0.3,), mass=2e-2, loops=(turned(order(left_tip(sign)), 0.0),))
    two = Body("two", "slide", (8e-3, 0.0), mass=2e-2, loops=(turned(order([(-x, -y) for x, y in left_tip(sign)]), 0.0),))
    return Scene("sliders", (one, two), contacts=(Contact((Side("one"), Side("two")), friction, restitution),), duration=0.1)


def left_tip(sign: float) -> list[tuple[float, float]]:
    """A slider whose right end is cut off at 30 degrees, upwards or downwards."""
    cut = 5.0 * math.tan(math.radians(30.0))
    return [(-5.0, -5.0), (cut * sign, -5.0), (-cut * sign, 5.0), (-5.0, 5.0)]


def order(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Counter-clockwise."""
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1], strict=True))
    return points if area > 0.0 else points[::-1]


@pytest.mark.parametrize("restitution", [0.0, 0.4, 0.9])
def test_tilted_faces_on_parallel_axes_rebound_by_routh(restitution: float) -> None:
    """Friction acts against the slip in both phases: e' = e (cos - mu sin) / (cos + mu sin), mirrored or not."""
    mu, slope = 0.5, math.radians(30.0)
    back = restitution * (math.cos(slope) - mu * math.sin(slope)) / (math.cos(slope) + mu * math.sin(slope))
    for mirrored in (False, True):
        done = simulate(sliders(mirrored, restitution, mu))
        assert np.count_nonzero(done.events["kind"] == EventKind.IMPACT) >= 1
        np.testing.assert_allclose(done.end_u, [0.15 * (1.0 - back), 0.15 * (1.0 + back)], rtol=1e-9)


def test_a_disc_about_its_own_pivot_lets_a_bar_pass() -> None:
    """No motion changes their gap: nothing is corrected, nothing stops."""
    disc = Loop((Arc(0.0, 0.0, 3e-3, 0.0, 2.0 * math.pi),))
    bar = turned([(-40.0, -5.0), (40.0, -5.0), (40.0, 0.0), (-40.0, 0.0)], 0.0)
    bodies = (
        Body("disc", "pivot", (0.0, 3e-3), inertia=1e-7, loops=(disc,)),
        Body("bar", "slide", (0.0, 0.0), velocity=(0.1,), mass=0.1, loops=(bar,)),
    )
    done = simulate(Scene("disc", bodies, contacts=(Contact((Side("disc"), Side("bar")), 0.3, 0.2),), duration=0.2))
    assert done.stop == Stop.DURATION
    np.testing.assert_allclose(done.end_q, [0.0, 0.02], atol=1e-12)
