"""Which lift angle has an anchor whose scene names none?

Whether a body that touches the wheel itself is an anchor or a click on its spring, no contact says; the geometry of function
does: two pallets that lock or drive, and let go. What it measures serves as lift angle for the phases of a run.
"""

from __future__ import annotations

from dataclasses import replace

from watchsim.escapement.measure import measure
from watchsim.scene.roles import partners, roles
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Trajectory


def measured_lift(scene: Scene) -> float | None:
    """The way (rad) from where one pallet lets go of a tooth to where the other does; None where no anchor does so.

    Nor where the scene names a lift angle.
    """
    found = roles(scene)
    if scene.lift_angle is not None or found.wheel is None or found.oscillator is None or found.lever is not None:
        return None
    if found.oscillator not in partners(scene, found.wheel):
        return None
    function = measure(scene, few=1, fork_too=False)
    if function.pallets is None or function.swung is None:
        return None
    return 0.5 * (function.swung[0] - function.swung[1])  # it was led half as far again as from let-off to let-off


def with_measured_lift(run: Trajectory) -> Trajectory:
    """The run as of a scene that names the measured lift angle, so that its beats have phases; the same where there is none."""
    lift = measured_lift(run.scene)
    return run if lift is None else replace(run, scene=replace(run.scene, lift_angle=lift))
