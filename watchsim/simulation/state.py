"""As which plain arrays is a state saved, whatever its records are called?

The names and places are those of all saved states: `state.npz` is read by later versions.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.dynamics.friction import LARGEST
from watchsim.jit import by_reference
from watchsim.model import Model, blank, copy_of, row_of, words_of

# What can happen between two smooth steps, and what is kept of it?


class EventKind(IntEnum):
    """What happened. IMPACT..ACCUMULATION and JAM name a contact pair; TURN and CROSS name a body with a spring."""

    IMPACT = 1  # approach ended by impulses; impulses and energy lost are given
    CLOSE = 2  # the contact now rests (its normal force acts)
    OPEN = 3  # the contact lets go
    STICK = 4  # sliding ended
    SLIDE = 5  # sliding began; `value` is the direction, +1 or -1
    HANDOVER = 6  # a contact in force passed from its primitives, contact number `value`, to their neighbours: `contact`
    ACCUMULATION = 7  # a sequence of rebounds was finished by rule; `value` is the time at which it would have ended
    TURN = 8  # a turning point of a sprung body; `value` is its coordinate
    CROSS = 9  # a sprung body passes its rest position; `value` is its velocity
    JAM = 10  # a sliding contact that no finite force could hold apart was stopped by impulses (Painlevé); `value` is its slip


EVENT_DTYPE = np.dtype(
    [
        ("t", "f8"),
        ("kind", "i4"),
        ("contact", "i4"),  # row of `Trajectory.pairs`, -1 for TURN and CROSS
        ("body", "i4"),  # index in scene.bodies for TURN and CROSS, else -1
        ("impulse_normal", "f8"),  # N·s (between pivoted bodies too: at the contact point)
        ("impulse_tangential", "f8"),
        ("energy_lost", "f8"),  # J
        ("value", "f8"),
    ]
)


# Why did the loop stop? Each cause carries its sentence.


class Stop(IntEnum):
    """Cause of a return from the event loop. RUNNING to BUFFER_FULL and LAST_STEP never reach a user."""

    RUNNING = 0
    SLICE = 1
    CELL_UNKNOWN = 2
    BUFFER_FULL = 3
    DURATION = 4
    INTERRUPTED = 5
    TOO_MANY_EVENTS = 6
    LCP_FAILED = 7
    STEP_TOO_SMALL = 8
    NOT_FINITE = 9
    TOO_MANY_CONTACTS = 10
    LAST_STEP = 11
    OUT_OF_MEMORY = 12
    FAR_AWAY = 13
    FOREGONE = 14
    BEARING_JAMS = 15
    BLOCKED = 16
    OVERLAP = 20
    UNEXPLAINED = 21
    LEDGER = 22

    @property
    def sentence(self) -> str:
        """The cause in words."""
        return _SENTENCES[self]

    @property
    def is_wrong(self) -> bool:
        """True when a check that the run makes of itself says that its result is wrong."""
        return self in (Stop.OVERLAP, Stop.UNEXPLAINED, Stop.LEDGER)

    @property
    def gave_up(self) -> bool:
        """True when the solver could not go on, or its result is known to be wrong (exit status 3)."""
        others = (Stop.OUT_OF_MEMORY, Stop.FAR_AWAY, Stop.BEARING_JAMS, Stop.BLOCKED)
        could_not = Stop.TOO_MANY_EVENTS <= self <= Stop.TOO_MANY_CONTACTS or self in others
        return could_not or self.is_wrong


_SENTENCES = {
    Stop.RUNNING: "still running",
    Stop.SLICE: "a slice of simulated time is done",
    Stop.CELL_UNKNOWN: "a cell of the configuration space was entered for the first time",
    Stop.BUFFER_FULL: "the record buffer is full",
    Stop.LAST_STEP: "the next step might reach the end",
    Stop.DURATION: "the requested duration was simulated",
    Stop.FOREGONE: "nothing can change any more",
    Stop.INTERRUPTED: "interrupted by the user; everything up to here is kept",
    Stop.TOO_MANY_EVENTS: "too many events at one instant: time does not advance",
    Stop.LCP_FAILED: (
        "no solution of a complementarity problem was found; lcp_failure.json holds it. Less friction or restitution at the "
        "contacts it names, or a tighter tolerance, may help"
    ),
    Stop.BEARING_JAMS: (
        "a bearing jams: no friction goes with the load that it makes, for a force on its body passes nearer to the pivot than "
        "friction times radius. A smaller radius or less friction under [[bearings]] helps, or coulomb in place of them"
    ),
    Stop.BLOCKED: "a driven body runs into what cannot give way",
    Stop.STEP_TOO_SMALL: "the step became too small for the requested tolerance",
    Stop.NOT_FINITE: "a coordinate or velocity is no longer a finite number",
    Stop.FAR_AWAY: "a body has gone so far that contacts are lost in the rounding of its position",
    Stop.OUT_OF_MEMORY: "there is no memory left to keep more; --record statistics needs the least",
    Stop.TOO_MANY_CONTACTS: "more contacts closed at once than there is room for",
    Stop.UNEXPLAINED: "velocities changed at an instant by more than the impulses there explain",
    Stop.LEDGER: "the energy ledger does not close",
    Stop.OVERLAP: "bodies overlapped, so the motion is wrong from there on at the latest",
}


# Which ways of stepping through time are there?

USUAL_STEP = 1e-5  # s, of Moreau's time stepping


# What does the event loop read and write?
#
# `State` is complete: with the model and the options it fixes the future.

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


class Instant:
    """What the loop knows of this instant, besides q, u and the modes."""

    awake_contacts: int  # contacts in force of awake bodies: so many at the start of `active`
    sleeping_contacts: int  # those of sleeping bodies, behind them
    event_waits: int  # 1 if an event is to be handled before time goes on
    events: int  # handled at this instant
    touched: int  # the contact that has just closed, or NO_CONTACT
    decisions: int  # sets of modes decided at this instant
    struck: int  # one more than the contact that has closed or whose mode has ended; 0: decide all islands
    lenience: float  # by how much more than usual forces and slips may miss their laws until the next instant


class ReboundWatch:
    """The contact that is hit again and again, see `stop_repeated_rebounds` in impacts.py."""

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
    instants: int  # at which events were handled
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


class Regime(NamedTuple):
    """What was decided at the last event: events change it, smooth motion only reads it."""

    mode: NDArray[np.int8]  # by permanent number of the contact
    grip: NDArray[np.int8]  # by coordinate: what dry friction in its bearing does, see dynamics/forces.py
    awake: NDArray[np.int8]  # by coordinate; 0: asleep on its contacts
    active: Integers  # closed contacts of awake bodies, then those of sleeping ones, by island (coupled_motion.py)
    upto: Integers  # by place in `active`, of awake bodies: the place behind the last contact of the same island


RegimeRef = by_reference(Regime, __name__)


class State(NamedTuple):
    """t, q, u, modes, and what else the future depends on."""

    clock: Clock
    q: Array
    u: Array
    a: Array
    regime: Regime
    instant: Instant
    returning: ReboundWatch
    side_u: NDArray[np.int8]  # last sign of the velocity of a sprung coordinate
    side_q: NDArray[np.int8]  # and of its distance from rest
    sums: Sums
    counts: Counts
    worst: Worst
    decided: Integers  # keys of the sets of modes decided at this instant, see `decide_once` in modes.py


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
    instant = blank(Instant)
    instant.event_waits, instant.touched, instant.lenience = 1, NO_CONTACT, 1.0
    returning = blank(ReboundWatch)
    returning.contact = NO_CONTACT
    return State(
        clock=blank(Clock),
        q=q.astype(float).copy(),
        u=u.astype(float).copy(),
        a=np.zeros(n),
        regime=Regime(
            mode=np.zeros(len(model.contacts), np.int8),
            grip=np.zeros(n, np.int8),
            awake=np.ones(n, np.int8),
            active=np.zeros(room_for(model), np.int64),
            upto=np.zeros(room_for(model), np.int64),
        ),
        instant=instant,
        returning=returning,
        side_u=np.sign(speed).astype(np.int8),
        side_q=np.sign(q - rest).astype(np.int8),
        sums=blank(Sums),
        counts=blank(Counts),
        worst=blank(Worst),
        decided=np.zeros(DECISIONS, np.int64),
    )


# As which plain arrays is a state saved, whatever its records are called?

NUMBERS = 7  # integer fields of `Instant`; its lenience is an array of its own
HITS = 2  # integer fields of `ReboundWatch`, the first


class StateArrays(NamedTuple):
    """All a state holds; arrays share its memory."""

    clock: Array
    q: Array
    u: Array
    a: Array
    mode: NDArray[np.int8]
    grip: NDArray[np.int8]
    awake: NDArray[np.int8]
    active: Integers
    upto: Integers
    numbers: Integers
    side_u: NDArray[np.int8]
    side_q: NDArray[np.int8]
    sums: Array
    counts: Integers
    worst: Array
    decided: Integers
    lenience: Array
    returning: Integers
    returned: Array


def arrays_of(state: State) -> StateArrays:
    """The arrays of a state: what is written into them is written into the state."""
    parts: dict[str, NDArray[Any]] = state._asdict() | state.regime._asdict()
    parts = {name: parts[name] for name in StateArrays._fields if name in parts}
    parts |= {name: words_of(parts[name], float) for name in ("clock", "sums", "worst")}
    parts["counts"] = words_of(state.counts, int)
    parts["numbers"], parts["lenience"] = words_of(state.instant, int)[:NUMBERS], row_of(state.instant)["lenience"]
    parts["returning"], parts["returned"] = words_of(state.returning, int)[:HITS], words_of(state.returning, float)[HITS:]
    return StateArrays(**parts)


def copy_of_state(state: State) -> State:
    """A state of its own."""
    parts: dict[str, Any] = {
        name: part.copy() if isinstance(part, np.ndarray) else copy_of(part)
        for name, part in state._asdict().items()
        if name != "regime"
    }
    return State(**parts | {"regime": Regime._make(part.copy() for part in state.regime)})


def write_state(state: State, other: State) -> None:
    """Write `other` into `state`."""
    new = arrays_of(other)._asdict()
    for name, part in arrays_of(state)._asdict().items():
        part[...] = new[name]
