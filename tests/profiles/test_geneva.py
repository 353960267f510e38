"""Does the wheel of a Geneva drive turn as geometry says while the pin drives it, and stand still while it is locked?

Closed form: the pin's middle lies `play` beside the slot's middle line, on the trailing side. With the pin at x, y from the
wheel's axis, W = atan2(y, x) + asin(play / hypot(x, y)); the speed is its derivative, taken by hand. The pin enters along the
slot and takes up the play within the first few degrees, which are left out.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim import designs
from watchsim.simulation.trajectory import Trajectory

TAKEN_UP = 0.15  # rad of the driver from the entry until the play is taken up
CLEAR = 0.02  # rad of the driver before the entry and after the exit


def wheel_and_speed(angle, speed, crank, distance, play):
    """Of the driven wheel while the pin rests on the driving side; the driver's angle counts from the line of centres."""
    x, y = distance + crank * np.cos(angle), crank * np.sin(angle)
    square = x * x + y * y
    far = np.sqrt(square)
    polar_speed = crank * (crank + distance * np.cos(angle)) / square
    far_speed = -distance * crank * np.sin(angle) / far
    lag_speed = -play * far_speed / (far * np.sqrt(square - play * play))
    return np.unwrap(np.arctan2(y, x)) + np.arcsin(play / far), speed * (polar_speed + lag_speed)


def departures(run: Trajectory, slots: int, crank: float, play: float) -> tuple[float, float, float]:
    """Largest differences from the closed form (rad, driver's speeds), and the largest turning while locked (rad)."""
    distance = crank / math.sin(math.pi / slots)
    entry, pitch = math.pi / 2.0 + math.pi / slots, 2.0 * math.pi / slots
    t = np.linspace(0.0, run.t[-1], 20001)
    q, u = run.sample(t)
    driver, wheel = q[:, 0], q[:, 1]
    turn = np.floor(driver / (2.0 * math.pi))
    inside = np.mod(driver, 2.0 * math.pi)
    driven = (inside > entry + TAKEN_UP) & (inside < 2.0 * math.pi - entry - CLEAR)
    assert np.count_nonzero(driven) > 1000
    angle, speed = wheel_and_speed(inside[driven], u[driven, 0], crank, distance, play)
    locked = (inside < entry - CLEAR) | (inside > 2.0 * math.pi - entry + CLEAR)
    standing = math.pi / slots - pitch * (turn + (inside > math.pi))
    return (
        float(np.abs(wheel[driven] + pitch * turn[driven] - angle).max()),
        float(np.abs((u[driven, 1] - speed) / u[driven, 0]).max()),
        float(np.abs(wheel[locked] - standing[locked]).max()),
    )


def test_the_profile_follows_the_closed_form():
    run = ws.simulate(ws.load(ws.profiles_dir() / "geneva" / "scene.toml"))
    angle, speed, locked = departures(run, 4, 10e-3, 0.01e-3)
    assert angle < 1e-8
    assert speed < 1e-6
    assert locked < math.radians(0.5)
    assert run.worst_penetration < 1e-9


@pytest.mark.parametrize(
    ("slots", "lock", "friction", "load"),
    [(3, "7 mm", 0.0, "1 mN·m"), (6, "7 mm", 0.2, "0.1 mN·m"), (8, "7.5 mm", 0.1, "0.1 mN·m")],
)
def test_other_numbers_of_slots(slots, lock, friction, load):
    drawn = designs.geneva(slots=slots, lock_radius=lock, pin_radius="1 mm", friction=friction, load=load)
    run = ws.simulate(drawn.scene())
    angle, speed, locked = departures(run, slots, 10e-3, 0.01e-3)
    assert angle < 1e-8
    assert speed < 1e-6
    assert locked < math.radians(0.5)


def test_what_does_not_fit_is_told():
    with pytest.raises(ws.SceneError, match="run into each other"):
        designs.geneva(slots=3, pin_radius="2 mm")
    with pytest.raises(ws.SceneError, match="the pin stands beside the disc"):
        designs.geneva(lock_radius="8.6 mm")
    with pytest.raises(ws.SceneError, match="does not reach into the wheel"):
        designs.geneva(lock_radius="3 mm")
