"""At which instants must a player in three dimensions know the places of bodies, if it draws straight lines between them?"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from watchsim.geometry.gltf_motion import MOST_TURN, Track
from watchsim.render.fewest_rows import kept_rows
from watchsim.render.frame.pose_history import Window, poses, stretch
from watchsim.scene.carriers import is_still
from watchsim.simulation.record.trajectory import Array, Trajectory

EVENLY = 2000  # instants besides the rows of the run
TURN = math.radians(0.02)  # what an angle may be off between keys
SHARE = 2e-4  # of its body's travel: what a place may be
CLOSEST = 1e-6  # s on the screen between two keys: single precision must tell them apart


def keyframes(run: Trajectory, window: Sequence[float] | None, speed: float) -> list[Track]:
    """A track for every body that can move; the window begins at 0 s and is played at `speed` (1/20: slow motion).

    ValueError for a window that was not recorded, or a speed that is not positive.
    """
    if not (math.isfinite(speed) and speed > 0.0):
        raise ValueError(f"speed = {speed}: give seconds of the watch per second of the animation, such as 1 or 1/20")
    span = stretch(run, window, unbroken=True)
    times = _instants(run, span, CLOSEST * speed)
    placed = poses(run, times)
    return [
        _track(body.name, (times - span[0]) / speed, placed[body.name])
        for body in run.scene.bodies
        if not is_still(run.scene, body)
    ]


def _instants(run: Trajectory, span: Window, apart: float) -> Array:
    inside = run.t[(run.t > span[0]) & (run.t < span[1])]
    times = np.union1d(np.linspace(*span, EVENLY), inside)
    # Of instants that lie closer together than that, the first is kept; both ends always.
    slots = np.floor((times - span[0]) / apart)
    first = np.concatenate(([True], np.diff(slots) > 0.0))
    return np.append(times[first][:-1], span[1]) if len(times) > 1 else times


def _track(name: str, t: Array, frames: Array) -> Track:
    """As few keys as straight lines allow."""
    travel = max(float(np.ptp(frames[:, :2], axis=0).max()), 1e-9)

    def fits(i: int, j: int) -> bool:
        if abs(frames[j, 2] - frames[i, 2]) > MOST_TURN:
            return False
        s = ((t[i + 1 : j] - t[i]) / (t[j] - t[i]))[:, None]
        off = np.abs(frames[i] + s * (frames[j] - frames[i]) - frames[i + 1 : j])
        return bool(np.all(off[:, 2] <= TURN) and np.all(off[:, :2] <= SHARE * travel))

    kept = kept_rows(len(t), fits)
    return Track(name, t[kept], frames[kept, :2], frames[kept, 2])
