"""Does a lever somebody else drew run, and does the tool say why it jams where it jams?

The drawing is a section of a public CAD model; it is no part of the project.
"""

import tempfile
from pathlib import Path

import numpy as np
import pytest
from strangers import PIN_LEVER, marks, pin_lever_scene

import watchsim as ws
from watchsim.analysis.summary import summary_text
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

PITCH = 2.0 * np.pi / 15

pytestmark = marks(PIN_LEVER)


def simulated(name: str, duration: float) -> Trajectory:
    with tempfile.TemporaryDirectory() as folder:
        scene = ws.load(pin_lever_scene(name, Path(folder)))
    return ws.simulate(scene, duration=duration)


def advance(run: Trajectory) -> float:
    """Half pitches by which the wheel has advanced."""
    return abs(run.q[-1, run.slices["wheel"]][0] - run.q[0, run.slices["wheel"]][0]) / (0.5 * PITCH)


def half_swings(run: Trajectory) -> int:
    return int(np.count_nonzero(run.events["kind"] == EventKind.CROSS))


def test_as_drawn_it_jams_and_the_tool_says_where() -> None:
    """Negative drop: while the wheel recoils, a corner of the entering stone meets the back of the passing tooth."""
    run = simulated("scene_as_drawn.toml", 1.5)
    assert run.stop.name == "DURATION" and advance(run) < 1.0
    told = ws.summary(run)
    assert told["stopped"]
    text = summary_text(run)
    assert "lever.PALLET_A corner" in text and "wheel.ESCAPE_WHEEL_z-1.30 line" in text
    last = run.q[-1]
    assert np.ptp(run.q[run.t > 1.0], axis=0).max() < 1e-9
    assert 5.0 < abs(np.degrees(last[run.slices["lever"]][0])) < 12.0  # far from its bank: not the lever's normal rest


def test_with_the_wheel_moved_away_it_ticks() -> None:
    run = simulated("scene.toml", 3.0)
    assert run.stop.name == "DURATION" and run.worst_penetration < 1e-9
    assert abs(advance(run) - half_swings(run)) <= 1.5


@pytest.mark.slow
def test_it_ticks_for_twenty_seconds() -> None:
    run = simulated("scene.toml", 20.0)
    assert run.stop.name == "DURATION" and run.worst_penetration < 1e-9
    assert abs(advance(run) - half_swings(run)) <= 1.5
    assert half_swings(run) >= 118
