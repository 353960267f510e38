"""Does a jumper hold its star between two teeth, ride on its outline, and throw it on by exactly one tooth in each turn?"""

from __future__ import annotations

import numpy as np
import pytest
from shapely.geometry import LinearRing, Point

import watchsim as ws
from watchsim import designs
from watchsim.simulation.trajectory import Trajectory

BEAK, LENGTH = 0.4e-3, 6e-3


def angles(run: Trajectory, name: str, times: np.ndarray) -> np.ndarray:
    return run.sample(times)[0][:, run.slices[name].start]


@pytest.mark.parametrize(
    ("teeth", "changed"),
    [
        (7, {}),
        (5, {"crank": "5 mm"}),
        (12, {"depth": "0.8 mm", "pin_radius": "0.2 mm"}),
        (7, {"friction": 0.0, "restitution": 0.6}),
    ],
)
def test_a_turn_is_a_tooth(teeth: int, changed: dict[str, str | float]) -> None:
    run = ws.simulate(designs.jumper(teeth=teeth, **changed).scene())
    pitch = 2.0 * np.pi / teeth
    # Seated in its root by both flanks, against the dry friction of the star, at rest before the pin comes again.
    turned = angles(run, "star", np.array([0.0, 1.0, 2.0]))
    assert turned == pytest.approx([0.0, pitch, 2.0 * pitch], abs=1e-6)
    assert angles(run, "jumper", np.array([1.0, 2.0])) == pytest.approx([0.0, 0.0], abs=1e-6)
    assert run.energy["residual_relative"] < 1e-8


def test_the_beak_rides_on_the_star() -> None:
    """By distances of the drawn outline itself, with arcs as chords of 1e-9 m rise: it never comes nearer than its radius."""
    run = ws.simulate(ws.load(ws.profiles_dir() / "jumper"), duration=0.7)
    star = run.scene.body("star")
    points = [edge.point(i / 400) for edge in max(star.loops, key=lambda loop: len(loop.edges)).edges for i in range(400)]
    ring, (x, y) = LinearRing(points), run.scene.body("jumper").position
    times = np.linspace(0.0, 0.7, 1401)
    apart = []
    for turn, lift in zip(angles(run, "star", times), angles(run, "jumper", times), strict=True):
        beak = complex(x + LENGTH * np.sin(lift), y - LENGTH * np.cos(lift)) * np.exp(-1j * turn)
        apart.append(ring.distance(Point(beak.real, beak.imag)) - BEAK)
    riding = times < 0.5
    assert np.abs(np.array(apart)[riding]).max() < 3e-9
    assert min(apart) > -3e-9


def test_what_the_finger_takes_is_what_the_spring_gets() -> None:
    """Slowly and without friction the torque on the finger is the spring's energy over the finger's angle."""
    slow = designs.jumper(friction=0.0, restitution=0.0, drag="0 µN·m", speed="3.6 °/s").scene()
    run = ws.simulate(slow, duration=49.0)
    spring = slow.springs[0]
    times = np.linspace(43.5, 46.0, 26)

    def energy(t: np.ndarray) -> np.ndarray:
        return 0.5 * spring.stiffness * (angles(run, "jumper", t) - spring.rest) ** 2

    step, speed = 1e-3, np.radians(-3.6)
    expected = (energy(times + step) - energy(times - step)) / (2.0 * step * speed)
    torque = ws.forces(run, times).drives["finger"]
    assert np.abs(expected).min() > 1e-6
    assert torque == pytest.approx(expected, rel=1e-3)


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(ws.SceneError, match="root radius"):
        designs.jumper(depth="3.5 mm")
    with pytest.raises(ws.SceneError, match="does not fit between"):
        designs.jumper(teeth=16, pin_radius="0.45 mm")
    with pytest.raises(ws.SceneError, match="does not carry a tooth that far"):
        designs.jumper(crank="1 mm")
    with pytest.raises(ws.SceneError, match="too large to lie"):
        designs.jumper(beak_radius="3 mm")
