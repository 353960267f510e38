"""Does a remontoir give the escapement an even torque, whatever its train is driven by?"""

from __future__ import annotations

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import Trajectory

STIFFNESS, MIDDLE, TRAIN = 0.03e-6, math.radians(-1.8), 12e-6  # N·m/rad, where the spring gives 1 µN·m, N·m at the stop wheel


def remontoir(share: float = 1.0) -> Scene:
    return ws.load(ws.profiles_dir() / "remontoir").set("torques.1.value", share * TRAIN)


@pytest.fixture(scope="module")
def run() -> Trajectory:
    return ws.simulate(remontoir(), duration=5.0)


def column(run: Trajectory, name: str, times: np.ndarray) -> np.ndarray:
    angles: np.ndarray = run.sample(times)[0][:, run.slices[name].start]
    return angles


def test_half_a_turn_is_wound_every_fifteen_beats(run: Trajectory) -> None:
    times = np.linspace(0.0, 5.0, 50001)
    stop = np.degrees(column(run, "stop_wheel", times))
    winder = np.degrees(column(run, "winder", times))
    stop, winder = stop - stop[0], winder - winder[0]
    let_go = times[np.flatnonzero(np.diff(np.round(stop / 30.0)))]
    assert np.diff(let_go) == pytest.approx([15 * 0.125] * 2, abs=0.01)
    assert stop[-1] == pytest.approx(90.0, abs=1e-3)
    assert np.abs(winder + 6.0 * stop).max() < 1e-9
    resting = np.abs(stop - 30.0 * np.round(stop / 30.0)) < 1e-3
    assert resting.mean() > 0.995  # arcs about the lever's pivot neither turn it nor are turned by it
    assert run.energy["residual_relative"] < 1e-8


def test_the_torque_on_the_escape_wheel_is_even(run: Trajectory) -> None:
    """A quarter of a turn to either side of the middle, and what a recoil of the wheel adds."""
    times = np.linspace(0.0, 5.0, 50001)
    torque = 1e-6 + STIFFNESS * (column(run, "wheel", times) - column(run, "winder", times) - MIDDLE)
    assert torque.min() == pytest.approx(1e-6 - STIFFNESS * math.pi / 2.0, rel=0.01)
    assert torque.max() == pytest.approx(1e-6 + STIFFNESS * math.pi / 2.0, rel=0.01)


def test_the_train_winds_as_newton_says(run: Trajectory) -> None:
    """Half a pitch from rest: the train's torque less the spring's, six times as large at the stop wheel, on both inertias.

    The spring's rises with the angle: a swing about the angle at which both are equal.
    """
    inertia = (0.5 + 36.0 * 0.01) * 1e-10
    times = np.linspace(0.93, 0.96, 30001)
    stop, wheel, winder = (column(run, name, times) for name in ("stop_wheel", "wheel", "winder"))
    turned = stop - stop[0]
    begin = int(np.argmax(turned > 1e-4))
    spring = 1e-6 + STIFFNESS * (wheel[begin] - winder[begin] - MIDDLE)
    swing, reach = math.sqrt(36.0 * STIFFNESS / inertia), (TRAIN - 6.0 * spring) / (36.0 * STIFFNESS)
    reached = [math.acos(1.0 - angle / reach) / swing for angle in (0.05, 0.5)]
    took = times[np.argmax(turned > 0.5)] - times[np.argmax(turned > 0.05)]
    assert took == pytest.approx(reached[1] - reached[0], rel=0.01)


def test_the_other_method_winds_at_the_same_time() -> None:
    scene = remontoir()
    exact, stepped = (ws.simulate(scene, duration=1.0, **how) for how in ({}, {"method": "moreau", "step": 4e-6}))
    assert stepped.end_q[exact.slices["stop_wheel"].start] == pytest.approx(
        exact.end_q[exact.slices["stop_wheel"].start], abs=1e-4
    )
    assert stepped.end_q[exact.slices["balance"].start] == pytest.approx(exact.end_q[exact.slices["balance"].start], abs=2e-2)


@pytest.mark.slow
def test_the_amplitude_stays_while_the_drive_falls_by_two_fifths() -> None:
    """Within 1 %, which the lighter friction on the stop lever adds; without a remontoir it falls as the root of the torque."""
    turn = slice(-31, -1)  # beats of a turn of the escape wheel, which holds two windings
    strong, weak = (
        float(np.mean(ws.beats(ws.simulate(remontoir(share), duration=130.0, record="events")).amplitude_deg[turn]))
        for share in (1.0, 0.6)
    )
    plain = ws.designs.swiss_lever().scene().set("torques.0.value", -0.6e-6)
    without = float(np.mean(ws.beats(ws.simulate(plain, duration=130.0, record="events")).amplitude_deg[turn]))
    assert weak == pytest.approx(strong, rel=0.01)
    assert without < 0.8 * strong
