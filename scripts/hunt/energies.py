"""What do the forces of a scene give its bodies? Computed from the scene and the rows of a run, not taken from the ledger."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hunt.generator.material import reach
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Trajectory

Array = NDArray[np.float64]


def masses(scene: Scene) -> Array:
    """(n,): of each coordinate."""
    each = {"fixed": lambda b: (), "pivot": lambda b: (b.inertia,), "slide": lambda b: (b.mass,)}
    each["free"] = lambda b: (b.mass, b.mass, b.inertia)
    return np.array([m for body in scene.bodies for m in each[body.motion](body)])


def potential(scene: Scene, run: Trajectory) -> Array:
    """(rows,): of springs, constant drives and gravity, J."""
    found = np.zeros(len(run.t))
    for spring in scene.springs:
        q = run.q[:, run.slices[spring.body].start]
        found += 0.5 * spring.stiffness * (q - spring.rest) ** 2
    for torque in scene.torques:
        q = run.q[:, run.slices[torque.body].start]
        found -= torque.value * (q - q[0])
    gx, gy = scene.gravity
    for body in scene.bodies if gx or gy else ():
        if body.motion == "fixed":
            continue
        q = run.q[:, run.slices[body.name]]
        if body.motion == "pivot":
            (x, y), c, s = body.centre_of_mass, np.cos(q[:, 0]), np.sin(q[:, 0])
            found -= body.mass * (gx * (c * x - s * y) + gy * (s * x + c * y))
        elif body.motion == "slide":
            found -= body.mass * q[:, 0] * (gx * body.axis[0] + gy * body.axis[1])
        else:
            found -= body.mass * (gx * q[:, 0] + gy * q[:, 1])
    return found


def pulls(scene: Scene, run: Trajectory, row: int) -> Array:
    """(n,): forces of springs, constant drives and gravity at a row, the slope of `potential`, N or N·m."""
    found = np.zeros(run.q.shape[1])
    for spring in scene.springs:
        k = run.slices[spring.body].start
        found[k] -= spring.stiffness * (run.q[row, k] - spring.rest)
    for torque in scene.torques:
        found[run.slices[torque.body].start] += torque.value
    gx, gy = scene.gravity
    for body in scene.bodies:
        if body.motion == "pivot":
            k = run.slices[body.name].start
            (x, y), c, s = body.centre_of_mass, math.cos(run.q[row, k]), math.sin(run.q[row, k])
            found[k] += body.mass * (gy * (c * x - s * y) - gx * (s * x + c * y))
        elif body.motion == "slide":
            found[run.slices[body.name].start] += body.mass * (gx * body.axis[0] + gy * body.axis[1])
        elif body.motion == "free":
            found[run.slices[body.name]] += (body.mass * gx, body.mass * gy, 0.0)
    return found


def unopposed(scene: Scene, time: float) -> float:
    """What weights and constant drives would give the bodies if nothing held them, J.

    Blocks that creep down a slope of 1e-5 turn over 1e-11 J, while the floor holds off 0.1 J of weight, to rounding.
    """
    loads = {torque.body: abs(torque.value) for torque in scene.torques}
    g, found = math.hypot(*scene.gravity), 0.0
    for body in scene.bodies:
        if body.motion == "pivot":
            arm = math.hypot(*body.centre_of_mass)
            found += 0.5 * (loads.get(body.name, 0.0) + body.mass * g * arm) ** 2 / body.inertia * time**2
        elif body.motion != "fixed":
            found += 0.5 * (loads.get(body.name, 0.0) + body.mass * g) ** 2 / body.mass * time**2
    return found


def of_a_step(scene: Scene, tolerance: float, kinetic: float) -> float:
    """What errors of one step do to the energy where forces are large against the motion, J.

    The tolerance is a share of the size L (of one radian) and of the speed that a force F gives over it, sqrt(F L / m). Of
    positions it makes F L, of velocities at a kinetic energy T the share sqrt(2 T F L).
    """
    size, found = reach(scene), 0.0
    lengths = {body.name: 1.0 if body.motion == "pivot" else size for body in scene.bodies}
    work = [abs(torque.value) * lengths[torque.body] for torque in scene.torques]
    for body in scene.bodies:
        if body.motion != "fixed":
            arm = math.hypot(*body.centre_of_mass) if body.motion == "pivot" else size
            work.append(body.mass * math.hypot(*scene.gravity) * arm)
    for given in work:
        found += given + math.sqrt(2.0 * kinetic * given)
    return tolerance * found
