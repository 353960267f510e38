"""What does the event loop read and write?

`State` is complete: with the model and the options it fixes the future.
"""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.dynamics.delassus import LARGEST
from watchsim.jit import by_reference
from watchsim.model.named_fields import blank
from watchsim.model.records import Model

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

ROOM, ROOM_PER_COORDINATE = 48, 2  # contacts closed at once: at least, and in large scenes
DECISIONS = 32  # sets of modes remembered at one instant
NO_CONTACT = -1  # in the place of a contact's number


class Clock:
    """Times, s."""

    time: float
    step: float  # length proposed for the next coupled step
    event: float  # when the last event was handled


class Now:
    """What the loop knows of this instant, besides q, u and the modes."""

    awake_contacts: int  # contacts in force of awake bodies: so many at the start of `active`
    sleeping_contacts: int  # those of sleeping bodies, behind them
    event_waits: int  # 1 if an event is to be handled before time goes on
    events: int  # handled at this instant
    touched: int  # the contact that has just closed, or NO_CONTACT
    decisions: int  # sets of modes decided at this instant
    lenience: float  # by how much more than usual forces and slips may miss their laws until the next instant


class Returning:
    """The contact that is hit again and again, see events/shrinking_play.py."""

    contact: int
    hits: int  # within `accumulation_time` of each other, at about the same gap rate
    last: float  # when it was hit last, s
    away: float  # for how long it was at first, s
    rate: float  # its gap rate at the hit that ended that, m/s


class Sums:
    """Energy that has come in and gone, J."""

    drive: float  # work of drives and weights
    damping: float
    friction: float
    impacts: float
    correction: float  # what time stepping has made of positions taken back


class Counts:
    """How often something was done; see `COUNT_NAMES`."""

    steps: int
    rejected_steps: int
    evaluations: int
    flights: int
    events: int
    impacts: int
    lcp: int
    lcp_failures: int
    accumulations: int
    energy_rescues: int
    gap_evaluations: int
    lcp_lemke: int
    lcp_copositive: int
    lcp_detours: int
    lcp_enumerated: int
    lcp_inexact: int
    jams: int
    redundant_sets: int
    instants: int  # at which events were settled
    cells_looked_up: int  # how often candidates were looked up in the table of cells
    lcp_sizes: Annotated[Integers, len(LARGEST) + 1]  # by size class


COUNT_NAMES = (
    *(name for name in Counts.__annotations__ if name != "lcp_sizes"),
    *(f"lcp_to_{size}" for size in LARGEST),  # with at most so many unknowns, more than the one before
    "lcp_larger",
)


class Worst:
    """The largest met so far."""

    penetration: float  # m
    kinetic_energy: float  # J


class State(NamedTuple):
    """t, q, u, modes, and what else the future depends on."""

    clock: Clock
    q: Array
    u: Array
    a: Array
    mode: NDArray[np.int8]  # by permanent number of the contact
    grip: NDArray[np.int8]  # by coordinate: what dry friction in its bearing does, see dynamics/bearing_friction.py
    awake: NDArray[np.int8]  # by coordinate; 0: asleep on its contacts
    active: Integers  # closed contacts of awake bodies, then those of sleeping ones, by island (contact_islands.py)
    upto: Integers  # by place in `active`, of awake bodies: the place behind the last contact of the same island
    now: Now
    returning: Returning
    side_u: NDArray[np.int8]  # last sign of the velocity of a sprung coordinate
    side_q: NDArray[np.int8]  # and of its distance from rest
    sums: Sums
    counts: Counts
    worst: Worst
    decided: Integers  # keys of the sets of modes decided at this instant, see mode_recurrence.py


StateRef = by_reference(State, __name__)


def room_for(model: Model) -> int:
    """How many contacts may be closed at once."""
    return max(ROOM, ROOM_PER_COORDINATE * len(model.coordinates))


def new_state(model: Model, q: Array, u: Array) -> State:
    """The state at t = 0 with nothing decided yet."""
    n = len(model.coordinates)
    rest, speed, joints = model.coordinates.rest.copy(), u.astype(float).copy(), model.joints[model.joints.watched == 1]
    rest[joints.coordinate] = joints.rest + q[joints.on]
    speed[joints.coordinate] -= u[joints.on]
    now = blank(Now)
    now.event_waits, now.touched, now.lenience = 1, NO_CONTACT, 1.0
    returning = blank(Returning)
    returning.contact = NO_CONTACT
    return State(
        clock=blank(Clock),
        q=q.astype(float).copy(),
        u=u.astype(float).copy(),
        a=np.zeros(n),
        mode=np.zeros(len(model.contacts), np.int8),
        grip=np.zeros(n, np.int8),
        awake=np.ones(n, np.int8),
        active=np.zeros(room_for(model), np.int64),
        upto=np.zeros(room_for(model), np.int64),
        now=now,
        returning=returning,
        side_u=np.sign(speed).astype(np.int8),
        side_q=np.sign(q - rest).astype(np.int8),
        sums=blank(Sums),
        counts=blank(Counts),
        worst=blank(Worst),
        decided=np.zeros(DECISIONS, np.int64),
    )
