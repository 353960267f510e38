"""Does a lever that we drew jam where its wheel stands too near, and tick where it stands further away than drawn?"""

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim.analysis.summary import summary_text
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

PITCH, BANK = 2.0 * math.pi / 15, 5.0  # rad; °, of the lever


def simulated(nearer_mm: float, turned_deg: float, duration: float) -> Trajectory:
    """The Swiss lever with its wheel nearer to the lever, and turned back so that nothing overlaps."""
    scene = ws.load(ws.profiles_dir() / "swiss_lever")
    angle = math.degrees(scene.body("wheel").angle) + turned_deg
    return ws.simulate(
        scene.set("bodies.wheel.position", ["0 mm", f"{nearer_mm} mm"]).set("bodies.wheel.angle", f"{angle}°"),
        duration=duration,
    )


def half_pitches(run: Trajectory) -> float:
    """By which the wheel has advanced: clockwise, its angle falls."""
    wheel = run.q[:, run.slices["wheel"]][:, 0]
    return float(wheel[0] - wheel[-1]) / (0.5 * PITCH)


def half_swings(run: Trajectory) -> int:
    return int(np.count_nonzero(run.events["kind"] == EventKind.CROSS))


@pytest.mark.parametrize("nearer", [0.015, 0.03])
def test_with_the_wheel_too_near_it_jams_and_the_tool_says_where(nearer: float) -> None:
    """A tooth is caught between both stones: what one lets go the other one holds."""
    run = simulated(nearer, 0.5, 1.0)
    assert run.stop.name == "DURATION" and run.worst_penetration < 1e-9
    assert abs(half_pitches(run)) < 0.1 and half_swings(run) == 0
    assert np.ptp(run.q[run.t > 0.5], axis=0).max() < 1e-9
    assert abs(math.degrees(run.q[-1, run.slices["lever"]][0])) < BANK - 1.0  # not the lever's normal rest
    assert ws.summary(run)["stopped"]
    text = summary_text(run)
    assert "the watch stands" in text and "wheel cannot make way for both" in text
    assert "wheel.TEETH corner" in text and "lever.STONES corner" in text


@pytest.mark.parametrize("further", [0.0, 0.03])
def test_with_the_wheel_where_it_is_drawn_or_further_away_it_ticks(further: float) -> None:
    run = simulated(-further, 0.0, 2.0)
    assert run.stop.name == "DURATION" and run.worst_penetration < 1e-9
    assert half_swings(run) >= 15
    assert abs(half_pitches(run) - half_swings(run)) <= 1.5
