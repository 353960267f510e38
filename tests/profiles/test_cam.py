"""Does the follower of an eccentric cam rise as the closed form says, and leave the cam just above the speed limit?"""

from __future__ import annotations

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim import designs
from watchsim.simulation.state import EventKind

R, E, END, MASS, FORCE, RATE = 5e-3, 1.5e-3, 1e-3, 2e-3, 0.2, 100.0  # SI, the design's defaults
REACH = R + END


def rise(angle: np.ndarray) -> np.ndarray:
    """Of the follower above its lowest place; the disc's middle starts below the axis."""
    phi = angle - 0.5 * math.pi
    return E * np.sin(phi) + np.sqrt(REACH**2 - (E * np.cos(phi)) ** 2) - (REACH - E)


def test_rise_and_force_follow_the_closed_form() -> None:
    run = ws.simulate(designs.cam(friction=0.0).scene())
    times = np.linspace(0.05, 0.89, 400)
    q, u = run.sample(times)
    cam, follower = q.T
    assert np.abs(follower - rise(cam)).max() < 1e-10
    # Speed and acceleration by differences of the closed form, force along the slide by Newton's law.
    w, step = math.radians(1200.0), 1e-5
    speed = w * (rise(cam + step) - rise(cam - step)) / (2.0 * step)
    bend = w * w * (rise(cam + step) - 2.0 * rise(cam) + rise(cam - step)) / step**2
    assert np.abs(u[:, 1] - speed).max() < 1e-8
    along = MASS * bend + FORCE + RATE * rise(cam)
    found = ws.forces(run, times)
    assert found.normal[:, 0] * found.direction[:, 0, 1] == pytest.approx(along, rel=1e-4)
    # Without friction the cam takes what the follower gets: torque × angle = force × rise.
    assert found.drives["cam"] == pytest.approx(along * speed / w, rel=1e-3, abs=1e-8)
    # It comes back to where it began: nothing was lost but what the start took (the follower starts at rest).
    assert run.energy["residual_relative"] < 1e-8


def leaves_at() -> float:
    """°/s, written down apart from the design: at the top the spring just keeps the follower on the cam."""
    fastest = (FORCE + RATE * 2.0 * E) / (MASS * E * (1.0 + E / REACH))
    return math.degrees(math.sqrt(fastest))


def test_it_leaves_the_cam_just_above_the_limit() -> None:
    slow = designs.cam(friction=0.0, restitution=0.0, speed=f"{0.995 * leaves_at()!r} °/s").scene()
    for speed, leaves in ((0.995, False), (1.005, True)):
        run = ws.simulate(slow.set("bodies.cam.velocity", f"{speed * leaves_at()!r} °/s"), duration=0.9 * 360.0 / leaves_at())
        after = run.events["t"] > 0.1 * 360.0 / leaves_at()
        opened = run.events[after & (run.events["kind"] == EventKind.OPEN)]
        assert bool(len(opened)) == leaves
        if leaves:  # near the top, half a turn from the start
            assert run.at(float(opened["t"][0]))[0][0] == pytest.approx(math.pi, abs=0.15)


def test_too_fast_and_too_eccentric_are_refused() -> None:
    with pytest.raises(ws.SceneError, match="leaves the cam at the top from"):
        designs.cam(speed=f"{1.01 * leaves_at()!r} °/s")
    with pytest.raises(ws.SceneError, match="no room in the disc"):
        designs.cam(eccentricity="4.5 mm")
