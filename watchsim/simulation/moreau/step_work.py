"""What does Moreau's time stepping keep from step to step, and where does it work?"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.kinematics import Closed, closed_contacts
from watchsim.contact.poses import poses
from watchsim.jit import by_reference
from watchsim.model.named_fields import blank
from watchsim.model.records import Model
from watchsim.simulation.loop_state.scratch import Asked, asked_of
from watchsim.simulation.loop_state.state import room_for
from watchsim.simulation.moreau.percussion_laws import Laws, laws

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class KeptSteps:
    """What is kept from step to step."""

    depth: float  # deepest penetration of the last step, m
    row_time: float  # when the last row was written, s
    violation: float  # worst residual of the laws so far
    sweeps: int  # of relaxation so far


class MoreauWork(NamedTuple):
    """Room to work in; `memory` (percussions of the last step by contact) and `kept` belong to the state.

    Rows of `rates` and `more` are those of `laws`: N, T of each of the m closed contacts, then the bearings.
    """

    closed: Closed
    laws: Laws
    asked: Asked
    memory: Array  # (contacts, 2)
    kept: KeptSteps
    pose: object
    q: Array  # at the middle of the step
    u: Array  # after the impacts, before the forces
    free: Array  # with the forces, without contacts
    foreseen: Array  # velocities at the middle as the last step foresees them
    start: Array  # coordinates at the start of the step
    wound: Array  # by coordinate: twice the energy of its spring before positions are taken back
    force: Array  # drives and gravity at the middle
    damping: Array
    line: Array  # what line springs do to each coordinate
    joint: Array  # force of the damping between two coordinates
    mass: Array
    inverse: Array
    change: Array  # of velocities, by one percussion
    rates: Array
    more: Array
    restitution: Array
    dry: Integers  # coordinate of each bearing with dry friction


MoreauWorkRef = by_reference(MoreauWork, __name__)


def moreau_work(model: Model) -> MoreauWork:
    """Room for one model."""
    n, room = len(model.coordinates), room_for(model)
    dry = np.flatnonzero(model.coordinates.coulomb > 0.0)
    rows = 2 * room + len(dry)
    vectors = {
        name: np.zeros(n)
        for name in ("q", "u", "free", "force", "damping", "line", "mass", "inverse", "change", "foreseen", "start", "wound")
    }
    by_row = {name: np.zeros(rows) for name in ("rates", "more")}
    return MoreauWork(
        memory=np.zeros((len(model.contacts), 2)),
        kept=blank(KeptSteps),
        pose=poses(len(model.bodies)),
        closed=closed_contacts(room),
        laws=laws(room, len(dry)),
        restitution=np.zeros(room),
        dry=dry,
        asked=asked_of(n),
        joint=np.zeros(len(model.joints)),
        **vectors,
        **by_row,
    )
