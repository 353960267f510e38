"""What must be true of every escapement, however long it runs, and what does time stepping say of it?"""

import math

import numpy as np

import watchsim as ws
from watchsim.simulation.trajectory import Trajectory


def of_profile(name: str, duration: float) -> Trajectory:
    return ws.simulate(ws.load(ws.profiles_dir() / name / "scene.toml"), duration=duration)


def check_running(run: Trajectory, pitch_deg: float, half_pitches: float) -> None:
    """So many half pitches of the wheel, no beat missed, nothing overlaps, energy closes."""
    assert run.stop.name == "DURATION"
    assert ws.summary(run)["missed_beats"] == 0
    wheel = run.slices["wheel"].start
    gone = math.degrees(run.q[0, wheel] - run.q[-1, wheel]) / (0.5 * pitch_deg)
    assert abs(gone - half_pitches) < 1.5
    assert run.worst_penetration < 1e-9
    assert abs(run.energy["residual_relative"]) < 1e-9


def stepping_errors(scene: ws.Scene, duration: float, steps: tuple[float, ...]) -> list[float]:
    """Largest difference of the half swings' amplitudes (°) by time stepping from those by events, for each step (s)."""
    true = ws.beats(ws.simulate(scene, duration=duration, tolerance=1e-11)).amplitude_deg
    found = [ws.beats(ws.simulate(scene, duration=duration, method="moreau", step=step)).amplitude_deg for step in steps]
    return [float(np.abs(one - true).max()) for one in found]
