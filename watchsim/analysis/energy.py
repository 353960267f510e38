"""Which share of what the drive puts in reaches the oscillator?

What reaches it is what its own damping takes and what it gains; the rest is lost in the escapement, in friction and impacts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from watchsim.scene.roles import keeps_time, roles
from watchsim.scene.trains import start_poses
from watchsim.simulation.trajectory import Trajectory, frames
from watchsim.tolerances import LEDGER_SHARE


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


@dataclass(frozen=True, slots=True)
class Shares:
    """Energy supplied (J) by the drive and by what ran down, springs, weights and motion, and what share went where; they
    sum to 1. What `ran_down` gave is part of `supplied`."""

    supplied: float
    went_to: dict[str, float]
    ran_down: float = 0.0


def energy_shares(run: Trajectory) -> Shares:
    """The ledger of a run as shares; empty where nothing was put in.

    The ledger has the work of gravity among what is put in; here a weight stores what it can give by falling.
    """
    ledger, fallen = run.energy, work_of_gravity(run)
    drive, stored = float(ledger.get("in_J", 0.0)) - fallen, float(ledger.get("stored_J", 0.0)) - fallen
    if abs(drive) < LEDGER_SHARE * abs(fallen):
        drive = 0.0  # but for the rounding of a fall
    supplied = max(drive, 0.0) + max(-stored, 0.0)
    if not supplied > 0.0:
        return Shares(0.0, {})
    went = {cause: float(value) for cause, value in ledger.get("dissipated", {}).items()}
    went["stored"], went["given back to the drive"] = max(stored, 0.0), max(-drive, 0.0)
    return Shares(supplied, {cause: value / supplied for cause, value in went.items() if value != 0.0}, max(-stored, 0.0))


def efficiency(run: Trajectory) -> float | None:
    """From 0 to 1; None without an escapement, without work of the drive, or where damping of other bodies is in the sum."""
    scene, parts = run.scene, roles(run.scene)
    if parts.wheel is None or parts.oscillator is None or not keeps_time(scene):
        return None
    if any(damping.body != parts.oscillator for damping in scene.damping):
        return None
    if any(torque.body == parts.oscillator for torque in scene.torques):
        return None
    fallen = work_of_gravity(run)
    work = run.energy.get("in_J", 0.0) - fallen
    if not work > 0.0:
        return None
    reached = run.energy.get("dissipated", {}).get("damping", 0.0) + run.energy.get("stored_J", 0.0) - fallen
    return float(reached / work)
