"""What does the event loop read and write?

`State` is complete: with the model and the options it fixes the future. `Scratch` is room to work in; `Record` what is kept.
"""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.kinematics import Closed, closed_contacts
from watchsim.contact.poses import poses
from watchsim.dynamics.delassus import LARGEST, ContactWork, contact_work
from watchsim.jit import by_reference
from watchsim.model.named_fields import blank
from watchsim.model.records import Model, Records
from watchsim.simulation.event_kinds import EVENT_DTYPE

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

ROOM, ROOM_PER_COORDINATE = 48, 2  # contacts closed at once: at least, and in large scenes
MONITORS = 4  # what is watched of each contact in force
DECISIONS = 32  # sets of modes remembered at one instant
RECENT = 64  # events remembered for the case that time does not advance
SUMS = 3  # integrated along with the motion: work in, damping, friction
NO_CONTACT = -1  # in the place of a contact's number
FLIGHT, COUPLED = 0, 1  # kinds of steps


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
    side_u: NDArray[np.int8]  # last sign of the velocity of a sprung coordinate
    side_q: NDArray[np.int8]  # and of its distance from rest
    sums: Sums
    counts: Counts
    worst: Worst
    decided: Integers  # keys of the sets of modes decided at this instant, see mode_recurrence.py


StateRef = by_reference(State, __name__)


class Until:
    """How far the loop is to run."""

    slice_end: float  # s: it may come back after that
    end: float  # s: the run's end
    may_cut: int  # 1 if the step that reaches the end may be cut short by it
    steps: float  # counted down; it may come back when none is left


class Span:
    """When a step lies, and what it is."""

    start: float  # s
    length: float  # s
    kind: int  # FLIGHT or COUPLED


class Step(NamedTuple):
    """One smooth step from (q, u): an exact flight, or a Runge-Kutta step with its continuous extension."""

    span: Span
    q: Array
    u: Array
    bound: Array  # bound of each |q''| over the step
    y0: Array  # q, u, sums
    y1: Array
    stages: Array  # (16, 2 n + SUMS)
    dense: Array  # (7, 2 n + SUMS)


StepRef = by_reference(Step, __name__)


class Ended:
    """What ended the last steps, see `ended_by` in advance.py; the newest overwrites the oldest."""

    number: int  # of steps ended so far
    by: Annotated[Integers, RECENT]


class UnknownCell:
    """Where the table of cells had no answer; the coordinates are in an array of their own."""

    pair: int  # of bodies


class Scratch(NamedTuple):
    """Room to work in, allocated once."""

    step: Step
    closed: Closed
    rest: Closed
    work: ContactWork
    pose: Any
    pace: Array  # largest magnitude of each velocity at the instant being settled
    zero: Array  # by row of `closed`: the gap rate that counts as zero, see zero_rates.py
    restitution: Array
    impulse: Array  # of the last impact, N and T by row
    rates: Array  # contact rates after it
    before: Array  # velocities before it
    q: Array
    u: Array
    y: Array
    dy: Array
    label: Integers  # by coordinate: the islands of the contacts closed at an event
    listed: Integers  # these contacts
    upto: Integers  # by place in `listed`
    engaged: NDArray[np.int8]  # bodies that the active contacts join
    doubt: Integers  # candidates that may close within a stretch
    monitors: Array  # at the state last evaluated, by code (coupled_motion.py)
    codes: Integers  # of those that fired
    trial: NDArray[np.int8]
    grip: NDArray[np.int8]
    load: Array  # force on each coordinate that dry friction holds
    terms: Array  # sum of the magnitudes it is made of
    ended: Ended
    unknown: UnknownCell
    at: Array  # coordinates where it was met


ScratchRef = by_reference(Scratch, __name__)


class Used:
    """How much of the buffers is filled."""

    rows: int
    events: int


class Record(NamedTuple):
    """Rows (t, q, u, a), events, and the times within which rows are kept."""

    rows: Array
    events: Records
    used: Used
    windows: Array  # (k, 2)


RecordRef = by_reference(Record, __name__)


def room_for(model: Model) -> int:
    """How many contacts may be closed at once."""
    return max(ROOM, ROOM_PER_COORDINATE * len(model.coordinates))


def new_state(model: Model, q: Array, u: Array) -> State:
    """The state at t = 0 with nothing decided yet."""
    n = len(model.coordinates)
    rest, speed, joints = model.coordinates.rest.copy(), u.astype(float).copy(), model.joints
    rest[joints.coordinate] = joints.rest + q[joints.on]
    speed[joints.coordinate] -= u[joints.on]
    now = blank(Now)
    now.event_waits, now.touched, now.lenience = 1, NO_CONTACT, 1.0
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
        side_u=np.sign(speed).astype(np.int8),
        side_q=np.sign(q - rest).astype(np.int8),
        sums=blank(Sums),
        counts=blank(Counts),
        worst=blank(Worst),
        decided=np.zeros(DECISIONS, np.int64),
    )


def new_scratch(model: Model) -> Scratch:
    """Room to work for one model."""
    n, room = len(model.coordinates), room_for(model)
    width = 2 * n + SUMS
    step = Step(
        span=blank(Span),
        q=np.zeros(n),
        u=np.zeros(n),
        bound=np.zeros(n),
        y0=np.zeros(width),
        y1=np.zeros(width),
        stages=np.zeros((16, width)),
        dense=np.zeros((7, width)),
    )
    return Scratch(
        step=step,
        pose=poses(len(model.bodies)),
        closed=closed_contacts(room),
        rest=closed_contacts(room),
        work=contact_work(room, n),
        pace=np.zeros(n),
        zero=np.zeros(room),
        restitution=np.zeros(room),
        impulse=np.zeros(2 * room),
        rates=np.zeros(2 * room),
        before=np.zeros(n),
        q=np.zeros(n),
        u=np.zeros(n),
        y=np.zeros(width),
        dy=np.zeros(width),
        label=np.zeros(n, np.int64),
        listed=np.zeros(room, np.int64),
        upto=np.zeros(room, np.int64),
        engaged=np.zeros(len(model.bodies), np.int8),
        doubt=np.zeros(len(model.contacts), np.int64),
        monitors=np.zeros(MONITORS * (room + n)),
        codes=np.zeros(MONITORS * (room + n), np.int64),
        trial=np.zeros(len(model.contacts), np.int8),
        grip=np.zeros(n, np.int8),
        load=np.zeros(n),
        terms=np.zeros(n),
        ended=blank(Ended),
        unknown=blank(UnknownCell),
        at=np.zeros(n),
    )


def new_record(model: Model, rows: int, events: int, windows: Array) -> Record:
    """Empty buffers."""
    n = len(model.coordinates)
    return Record(np.zeros((rows, 1 + 3 * n)), np.zeros(events, EVENT_DTYPE).view(np.recarray), blank(Used), windows)
