"""Does a remontoir give the escapement an even torque, whatever its train is driven by?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from every_time import few
from scipy.optimize import brentq

import watchsim as ws
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Trajectory

STIFFNESS, TRAIN = 0.03e-6, 12e-6  # N·m/rad, N·m at the stop wheel
ARM, OFF, LOCK, PLAY = 4.5, 0.18, math.radians(0.3), 0.002  # mm: lever to axis, eccentricity, half of what the slot is wider


def remontoir(share: float = 1.0) -> Scene:
    return ws.load(ws.profiles_dir() / "remontoir").set("design.train", share * TRAIN)


def middle(scene: Scene) -> float:
    """Angle of the wheel against the winder half way between the first two windings: a quarter of a turn before the first.

    By the place of the disc in the drawing, turned until it has led the lever down by the lock and the play.
    """
    disc = scene.body("eccentric").position
    ahead, wheel = math.atan2(disc[1], disc[0]), scene.body("wheel").angle
    led = LOCK + PLAY / ARM

    def beyond(turn: float) -> float:
        x, y = ARM + OFF * math.cos(ahead + turn), OFF * math.sin(ahead + turn)
        return math.atan2(y, x) + led

    return brentq(beyond, wheel - ahead - math.pi / 4.0, wheel - ahead + math.pi / 4.0) + math.pi / 2.0


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
    torque = 1e-6 + STIFFNESS * (column(run, "wheel", times) - column(run, "winder", times) - middle(run.scene))
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
    spring = 1e-6 + STIFFNESS * (wheel[begin] - winder[begin] - middle(run.scene))
    swing, reach = math.sqrt(36.0 * STIFFNESS / inertia), (TRAIN - 6.0 * spring) / (36.0 * STIFFNESS)
    reached = [math.acos(1.0 - angle / reach) / swing for angle in (0.05, 0.5)]
    took = times[np.argmax(turned > 0.5)] - times[np.argmax(turned > 0.05)]
    assert took == pytest.approx(reached[1] - reached[0], rel=0.01)


@pytest.mark.slow
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


OTHERS = [{"stop_teeth": 5}, {"teeth": 16}, {"stop_teeth": 8, "train": "16 µN·m"}, {"arm": "6 mm", "eccentricity": "0.25 mm"}]


@pytest.mark.parametrize("changed", few(OTHERS, 2))
def test_others_wind_too(changed: dict[str, object]) -> None:
    """Half a pitch of the stop wheel for half a turn of the escape wheel, none missed."""
    made = ws.designs.remontoir(**changed).scene()
    run = ws.simulate(made, duration=4.5)
    teeth = int(changed.get("stop_teeth", 6))  # type: ignore[call-overload]
    turned = run.end_q[run.slices["stop_wheel"].start] - run.q[0, run.slices["stop_wheel"].start]
    escape = run.end_q[run.slices["wheel"].start] - run.q[0, run.slices["wheel"].start]
    halves = math.floor((-escape + middle(made) - made.body("wheel").angle + math.pi / 2.0) / math.pi)
    assert ws.summary(run)["missed_beats"] == 0
    assert turned == pytest.approx(halves * math.pi / teeth, abs=1e-3)
    assert run.worst_penetration < 1e-9


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"train": "6 µN·m"}, "the wound spring asks for 6.28 µN·m"),
        ({"eccentricity": "0.03 mm"}, "clear of both pallets"),
        ({"eccentricity": "0.5 mm"}, "leave its fork"),
        ({"arm": "2 mm"}, "no room"),
        ({"lock": "2°", "guard_freedom": "2.5°"}, "less than the total lock"),
    ],
)
def test_what_does_not_fit_is_told(wrong: dict[str, str], words: str) -> None:
    with pytest.raises(ws.SceneError, match=words):
        ws.designs.remontoir(**wrong)
