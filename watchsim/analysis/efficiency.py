"""Which share of what the drive puts in reaches the oscillator?

What reaches it is what its own damping takes and what it gains; the rest is lost in the escapement, in friction and impacts.
"""

from __future__ import annotations

import numpy as np

from watchsim.scene.roles import keeps_time, roles
from watchsim.simulation.record.body_frames import frames
from watchsim.simulation.record.trajectory import Trajectory


def efficiency(run: Trajectory) -> float | None:
    """From 0 to 1; None without an escapement, without work of the drive, or where damping of other bodies is in the sum."""
    scene, parts = run.scene, roles(run.scene)
    if parts.wheel is None or parts.oscillator is None or not keeps_time(scene):
        return None
    if any(damping.body != parts.oscillator for damping in scene.damping):
        return None
    if any(torque.body == parts.oscillator for torque in scene.torques):
        return None
    fallen = _work_of_gravity(run)
    work = run.energy.get("in_J", 0.0) - fallen
    if not work > 0.0:
        return None
    reached = run.energy.get("dissipated", {}).get("damping", 0.0) + run.energy.get("stored_J", 0.0) - fallen
    return float(reached / work)


def _work_of_gravity(run: Trajectory) -> float:
    """J from the start to the end: what the account takes for work of the drive is only lent and given back."""
    scene = run.scene
    if not any(scene.gravity) or run.end is None or not len(run.t):
        return 0.0
    ends = frames(scene, run.slices, np.stack((run.q[0], run.end[0])))
    total = 0.0
    for body in scene.bodies:
        (cx, cy), poses = body.centre_of_mass, ends[body.name]
        c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        way = np.diff(poses[:, :2] + np.stack((c * cx - s * cy, s * cx + c * cy), axis=1), axis=0)[0]
        total += body.mass * float(way @ np.array(scene.gravity))
    return total
