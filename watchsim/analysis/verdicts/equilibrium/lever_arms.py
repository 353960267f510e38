"""With which lever arms do contacts act at one instant?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from watchsim.analysis.balanced_forces import Mechanism
from watchsim.analysis.contact_forces import absolute
from watchsim.mechanism.compile import Compiled
from watchsim.simulation.record.trajectory import Array, Pair, Trajectory


@dataclass(frozen=True)
class Arms:
    """Of k contacts at time `t`: forces N along the normal and T across it act on coordinate j
    with N·normal[:, j] and T·across[:, j].

    normal, across  (k, n): w_N and w_T, m for turning bodies
    point, way      (k, 2): where they touch, m, and the normal out of body B, in the movement
    places          body -> x, y, angle of its frame in the movement
    friction        (k,)
    loads, dry      (n,): torques and forces of all that is no contact, on bodies at rest; dry friction of their bearings
    """

    t: float
    pairs: tuple[Pair, ...]
    columns: dict[str, int]
    normal: Array
    across: Array
    point: Array
    way: Array
    places: dict[str, tuple[float, float, float]]
    friction: Array
    loads: Array
    dry: Array

    def of(self, row: int, body: str) -> tuple[float, float]:
        """Lever arms (m) of the normal and the tangential force of a contact on a body."""
        column = self.columns[body]
        return float(self.normal[row, column]), float(self.across[row, column])


def arms(run: Trajectory, compiled: Compiled, t: float, contacts: list[int]) -> Arms:
    """Of the contacts with these numbers at a recorded time; loads are those of bodies that stand still."""
    q, _ = run.at(t)
    places = {body.name: run.pose_of(body.name, q) for body in run.scene.bodies}
    q = absolute(compiled, q[None], False)
    seen = Mechanism(compiled).seen(np.array([float(t)]), q, np.zeros(q.shape), np.array(contacts, np.int64))
    pairs = tuple(run.pairs[number] for number in contacts)
    return Arms(
        float(t),
        pairs,
        {name: columns.start for name, columns in run.slices.items() if columns.start < q.shape[1]},
        seen.w_N[0],
        seen.w_T[0],
        seen.point[0],
        seen.normal[0],
        places,
        np.array([compiled.model.laws[pair.group].friction for pair in pairs]),
        seen.h[0],
        np.array(compiled.model.coordinates.coulomb),
    )
