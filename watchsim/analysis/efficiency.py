"""Which share of what the drive puts in reaches the oscillator?

What reaches it is what its own damping takes and what it gains; the rest is lost in the escapement, in friction and impacts.
"""

from __future__ import annotations

from watchsim.analysis.weights_fallen import work_of_gravity
from watchsim.scene.roles import keeps_time, roles
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
    fallen = work_of_gravity(run)
    work = run.energy.get("in_J", 0.0) - fallen
    if not work > 0.0:
        return None
    reached = run.energy.get("dissipated", {}).get("damping", 0.0) + run.energy.get("stored_J", 0.0) - fallen
    return float(reached / work)
