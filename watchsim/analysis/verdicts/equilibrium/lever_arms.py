"""With which lever arms do contacts act at one instant?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from watchsim.analysis.contact_forces import absolute
from watchsim.contact.kinematics import closed_contacts
from watchsim.contact.poses import poses
from watchsim.dynamics.equations_of_motion import balance
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
    q, u = (np.array(row) for row in run.at(t))
    places = {body.name: run.pose_of(body.name, q) for body in run.scene.bodies}
    q, u = absolute(compiled, q[None], False)[0], absolute(compiled, u[None], True)[0]
    k, ids = len(contacts), np.array(contacts, np.int64)
    closed, way, h = closed_contacts(max(1, k)), np.zeros((k, 2)), np.zeros(len(q))
    balance(compiled.model, float(t), q, np.zeros(len(u)), ids, poses(len(compiled.model.bodies)), closed, way, h)
    normal, across = np.zeros((2, k, len(q)))
    for row in range(k):
        for slot in range(closed.slots[row]):
            normal[row, closed.coord[row, slot]] += closed.w_N[row, slot]
            across[row, closed.coord[row, slot]] += closed.w_T[row, slot]
    pairs = tuple(run.pairs[number] for number in contacts)
    return Arms(
        float(t),
        pairs,
        {name: columns.start for name, columns in run.slices.items() if columns.start < len(q)},
        normal,
        across,
        np.column_stack((closed.kin.x, closed.kin.y))[:k],
        way,
        places,
        np.array([compiled.model.laws[pair.group].friction for pair in pairs]),
        h,
        np.array(compiled.model.coordinates.coulomb),
    )
