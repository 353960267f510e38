"""What have weights given by falling?"""

from __future__ import annotations

import numpy as np

from watchsim.scene.carriers import start_poses
from watchsim.simulation.record.body_frames import frames
from watchsim.simulation.record.trajectory import Trajectory


def work_of_gravity(run: Trajectory) -> float:
    """J from the start to the end: what the ledger of a run takes for work of the drive is only lent and given back."""
    scene = run.scene
    if not any(scene.gravity) or run.end is None:
        return 0.0
    starts, ends = start_poses(scene), frames(scene, run.slices, run.end[0][None, :])
    total = 0.0
    for body in scene.bodies:
        (cx, cy), poses = body.centre_of_mass, np.array([starts[body.name], ends[body.name][0]])
        c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        way = np.diff(poses[:, :2] + np.stack((c * cx - s * cy, s * cx + c * cy), axis=1), axis=0)[0]
        total += body.mass * float(way @ np.array(scene.gravity))
    return total
