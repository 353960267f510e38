"""Does a click hold a ratchet wheel exactly where its teeth are, after a recoil of about a tooth at most?"""

from __future__ import annotations

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim import designs


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"teeth": 40, "depth": "0.25 mm", "nose_radius": "0.04 mm"},
        {"teeth": 12, "click_angle": "30°", "undercut": "10°"},
        {"friction": 0.0, "restitution": 0.6},
    ],
)
def test_it_is_held_at_a_whole_number_of_teeth(changed: dict[str, str | float]) -> None:
    drawn = designs.ratchet(**changed)
    run = ws.simulate(drawn.scene(), duration=1.0)
    pitch = math.tau / changed.get("teeth", 24)
    wheel = run.sample(np.linspace(0.0, 1.0, 2001))[0][:, 0]
    teeth = wheel[-1] / pitch
    assert round(teeth) >= 3
    assert teeth == pytest.approx(round(teeth), abs=1e-7)
    assert np.abs(run.u[-1]).max() < 1e-9
    # It runs back by no more than the tooth on which the click was, and the nose that has not yet fallen behind its point.
    assert (np.maximum.accumulate(wheel) - wheel).max() < pitch + 2.0 * 0.08 / 3.0
    assert run.energy["residual_relative"] < 1e-8


def test_the_torque_of_the_mainspring_rests_on_the_click() -> None:
    """So do the moments of the forces on its nose: about the wheel's axis the mainspring's, about its pivot its spring's."""
    scene = designs.ratchet(friction=0.0).scene()
    run = ws.simulate(scene, duration=0.04)
    found = ws.forces(run, [0.03])
    push = found.normal[0, :, None] * found.direction[0]  # on the nose, from each of the two flanks
    x, y = found.point[0].T
    assert (x * push[:, 1] - y * push[:, 0]).sum() == pytest.approx(-0.5e-3, rel=1e-9)
    px, py = scene.body("click").position
    spring = scene.springs[0]
    held = spring.stiffness * (spring.rest - run.q[-1][1])
    assert ((x - px) * push[:, 1] - (y - py) * push[:, 0]).sum() == pytest.approx(-held, rel=1e-9)


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(ws.SceneError, match="else the click lies in the teeth"):
        designs.ratchet(click_angle="75°")
    with pytest.raises(ws.SceneError, match="does not wind the mainspring"):
        designs.ratchet(winding="0.5 mN·m")
    with pytest.raises(ws.SceneError, match="does not reach deep enough"):
        designs.ratchet(nose_radius="0.4 mm")


def test_it_sleeps_once_the_hand_has_let_go() -> None:
    """The torque of the hand is a table over time; behind its last knot nothing changes any more, and no step is needed."""
    scene = ws.load(ws.profiles_dir() / "ratchet")
    short, long = (ws.simulate(scene, duration=duration) for duration in (1.0, 5.0))
    assert long.counts["steps"] < short.counts["steps"] + 20
    assert (long.end_q == short.end_q).all()
