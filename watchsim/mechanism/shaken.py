"""What do the kernels read of [[shocks]]?"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.model import SHOCK, WEIGHED, Records, records
from watchsim.scene.scene import Scene
from watchsim.scene.trains import Weighed


def shaken(scene: Scene, weighed: tuple[Weighed, ...], bodies: Records) -> tuple[Records, NDArray[np.float64], Records]:
    """Records of the shocks, rows of their recordings with the integrals of Φ'', and what the moving bodies weigh."""
    shocks, jolts = records(SHOCK, len(scene.shocks)), [np.zeros((0, 6))]
    for row, shock in zip(shocks, scene.shocks, strict=True):
        row.start, row.duration, (row.x, row.y), row.turn = shock.at, shock.duration, shock.acceleration, shock.turn
        row.about_x, row.about_y = shock.about
        row.gravity_x, row.gravity_y = scene.gravity
        row.first, row.count = sum(map(len, jolts)), len(shock.rows)
        if shock.rows:
            jolts.append(_integrated(np.array(shock.rows)))
        turning = shock.turn != 0.0 if not shock.rows else bool(np.any(jolts[-1][-1, 4:] != 0.0))
        row.over = math.inf if turning else shock.at + shock.duration
    rows = [i for i, body in enumerate(scene.bodies) if scene.shocks and bodies[i].first >= 0 and body.prescribed is None]
    found = records(WEIGHED, len(rows))
    for row, i in zip(found, rows, strict=True):
        own = weighed[i]
        row.body, row.mass, (row.moment_x, row.moment_y), row.inertia = i, own.mass, own.moment, own.inertia
    return shocks, np.concatenate(jolts), found


def _integrated(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 6): with Φ' and Φ at each row, Φ'' being linear between them."""
    h, turn = np.diff(rows[:, 0]), rows[:, 3]
    spin = np.concatenate(([0.0], np.cumsum(0.5 * h * (turn[:-1] + turn[1:]))))
    angle = np.concatenate(([0.0], np.cumsum(h * spin[:-1] + h * h * (turn[:-1] / 3.0 + turn[1:] / 6.0))))
    return np.column_stack((rows, spin, angle))


def feels(row: Records, motion: str, turns: bool) -> bool:
    """True if the motion of the case acts on this body: one that is poised feels no shock unless the case turns."""
    return turns or motion != "pivot" or row.moment_x != 0.0 or row.moment_y != 0.0
