"""Which arrows stand for the contact forces of a run at the instants of a movie?

Each is drawn where the contact is, along the force on the body that receives it: the oscillator before the lever, the lever
before the wheel, whatever moves before what is fixed.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.contact_forces import forces
from watchsim.scene.roles import roles
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]
UNITS = ((1.0, "N"), (1e-3, "mN"), (1e-6, "µN"), (1e-9, "nN"))
OF_ALL = 99.0  # per cent of the forces that the longest arrow is for: a spike does not make all others vanish


class ForceArrows:
    """The arrows of a run at some times; ValueError where its forces are not known (fixed steps, events not kept)."""

    def __init__(self, run: Trajectory, times: Array) -> None:
        found = forces(run, times)
        turned = np.stack((-found.direction[..., 1], found.direction[..., 0]), axis=-1)
        on_a = found.normal[..., None] * found.direction + found.tangential[..., None] * turned
        first = _first(run)
        signs = np.array(
            [1.0 if first(run.pairs[k].body_a) <= first(run.pairs[k].body_b) else -1.0 for k in found.pairs.tolist()]
        )
        self._force, self._point = signs[None, :, None] * on_a, found.point
        size = np.hypot(self._force[..., 0], self._force[..., 1])
        size = size[np.isfinite(size) & (size > 0.0)]
        self.longest = float(np.percentile(size, OF_ALL)) if len(size) else 1.0
        """N, of the longest arrow; greater forces are drawn as long."""

    @property
    def meaning(self) -> str:
        """For the key of the movie."""
        factor, unit = next((one for one in UNITS if self.longest >= one[0]), UNITS[-1])
        return f"contact force, the longest {self.longest / factor:.3g} {unit}"

    def at(self, row: int) -> Array:
        """(n, 4): point (m) and force (parts of the longest) at the time of that number."""
        known = np.isfinite(self._force[row]).all(axis=1)
        force = self._force[row][known] / self.longest
        length = np.hypot(*force.T)
        return np.hstack((self._point[row][known], force / np.maximum(length, 1.0)[:, None]))


def _first(run: Trajectory):  # type: ignore[no-untyped-def]
    """The rank of a body: the lower one receives the force."""
    found = roles(run.scene)
    order = {name: rank for rank, name in enumerate((found.oscillator, found.lever, found.wheel)) if name is not None}
    fixed = {body.name for body in run.scene.bodies if body.motion == "fixed"}
    return lambda name: len(order) + 1 if name in fixed else order.get(name, len(order))
