"""Where does the event loop work? Room allocated once, by owner.

Each part belongs to the kernels that its docstring names; what a kernel finds it returns, or leaves in the part it is given.
"""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import OPEN, STICK, Closed, ClosedRef, circles_around, closed_contacts, poses
from watchsim.dynamics.bearings import PivotsRef
from watchsim.dynamics.delassus import ContactSystem, ContactSystemRef, contact_system
from watchsim.dynamics.friction import FrictionProblem, FrictionProblemRef, KnownProblemRef, friction_problem, problem_size
from watchsim.dynamics.impact import ImpactPhases, ImpactPhasesRef, impact_phases
from watchsim.dynamics.lcp import LcpWorkRef, lcp_work
from watchsim.dynamics.redundant import FreeForcesRef, ModeSystem, ModeSystemRef, mode_system
from watchsim.jit import by_reference, inlined, kernel
from watchsim.model import Model, Records, blank, dtype_of, records
from watchsim.simulation.state import EVENT_DTYPE, EventKind, RegimeRef, StateRef, room_for

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Modes = NDArray[np.int8]

MONITORS = 4  # what is watched of each contact in force
RECENT = 64  # events remembered for the case that time does not advance
SUMS = 3  # integrated along with the motion: work in, damping, friction
FLIGHT, COUPLED = 0, 1  # kinds of steps


class Until:
    """How far the loop is to run."""

    slice_end: float  # s: it may come back after that
    end: float  # s: the run's end
    may_cut: int  # 1 if the step that reaches the end may be cut short by it
    steps: float  # counted down; it may come back when none is left


def new_until(slice_end: float = 0.0, end: float = 0.0, may_cut: bool = False, steps: float = 0.0) -> Until:
    """How far the loop is to run."""
    until = blank(Until)
    until.slice_end, until.end, until.may_cut, until.steps = slice_end, end, int(may_cut), steps
    return until


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


def new_record(model: Model, rows: int, events: int, windows: Array) -> Record:
    """Empty buffers."""
    n = len(model.coordinates)
    return Record(np.zeros((rows, 1 + 3 * n)), np.zeros(events, EVENT_DTYPE).view(np.recarray), blank(Used), windows)


@kernel
def is_kept(record, t, length):
    """True if rows within `length` seconds after t lie in one of the windows."""
    for j in range(len(record.windows)):
        if record.windows[j, 0] <= t + length and t <= record.windows[j, 1]:
            return True
    return False


@kernel
def keep_row(record, t, q, u, a):
    """Append a row unless t lies outside all windows."""
    if not is_kept(record, t, 0.0):
        return
    row = record.used.rows
    n = len(q)
    record.rows[row, 0] = t
    for i in range(n):
        record.rows[row, 1 + i] = q[i]
        record.rows[row, 1 + n + i] = u[i]
        record.rows[row, 1 + 2 * n + i] = a[i]
    record.used.rows = row + 1


@kernel
def keep_event(record, clock, counts, kind, contact, body, value):
    """Append an event at the current time and return its row."""
    row = record.used.events
    event = record.events[row]
    event.t, event.kind, event.contact, event.body, event.value = clock.time, kind, contact, body, value
    event.impulse_normal, event.impulse_tangential, event.energy_lost = 0.0, 0.0, 0.0
    record.used.events = row + 1
    counts.events += 1
    return row


@kernel
def keep_change(record, clock, counts, k, old, new):
    """Write down how contact k's mode changed."""
    if new == old:
        return
    if old == OPEN:
        keep_event(record, clock, counts, EventKind.CLOSE, k, -1, float(new))
    elif new == OPEN:
        keep_event(record, clock, counts, EventKind.OPEN, k, -1, 0.0)
    elif new == STICK:
        keep_event(record, clock, counts, EventKind.STICK, k, -1, 0.0)
    else:
        keep_event(record, clock, counts, EventKind.SLIDE, k, -1, float(new))


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
    awake: Modes  # by coordinate, and its grip: those of the state, for the whole step
    grip: Modes
    side: Modes  # of their curb pins, see curb_pins.py
    bound: Array  # bound of each |q''| over the step
    y0: Array  # q, u, sums
    y1: Array
    stages: Array  # (16, 2 n + SUMS)
    dense: Array  # (7, 2 n + SUMS)


StepRef = by_reference(Step, __name__)


class ContactWork(NamedTuple):
    """What is written to, and by whom."""

    system: ContactSystem  # what acts on the gaps, and the contact forces: whoever poses a problem
    modes: ModeSystem  # the equality system of decided modes: `solve_mode`
    problem: FrictionProblem  # the complementarity problem: `decide_modes`, `impact`, `plastic_impact`
    phases: ImpactPhases  # impulses and rates of an impact: `impact`, `plastic_impact`


ContactWorkRef = by_reference(ContactWork, __name__)


def contact_work(room: int, coordinates: int) -> ContactWork:
    """Room for that many closed contacts."""
    lcp = lcp_work(problem_size(room, coordinates))
    return ContactWork(
        contact_system(room, coordinates),
        mode_system(room, coordinates, lcp),
        friction_problem(room, coordinates, lcp),
        impact_phases(room, coordinates),
    )


@inlined
def contact_work_by_reference(work):
    """As nested structs."""
    modes, problem = work.modes, work.problem
    return ContactWorkRef(
        ContactSystemRef(*work.system),
        ModeSystemRef(FreeForcesRef(LcpWorkRef(*modes.redundant.lcp), *modes.redundant[1:]), *modes[1:]),
        FrictionProblemRef(LcpWorkRef(*problem.lcp), KnownProblemRef(*problem.known), PivotsRef(*problem.pivots), *problem[3:]),
        ImpactPhasesRef(*work.phases),
    )


class Held:
    """What holds for the whole of a coupled step, see `engage`."""

    contacts: int  # in force, of awake bodies
    lenience: float  # that of the instant at which they were decided
    jammed: int  # 1: see `LastProblem`
    pinned: int  # 1: springs play between curb pins


class Smooth(NamedTuple):
    """A coupled step, and the motion at one time of it (coupled_motion.py, integrator.py)."""

    step: Step
    system: ContactSystem  # that of `ContactWork`, and its equality system
    modes: ModeSystem
    held: Held
    y: Array  # q, u, sums
    dy: Array  # their time derivatives
    pose: Any  # of the bodies that contacts in force join
    closed: Closed  # the contacts of one island after another
    engaged: Modes  # by body: 1 if a contact in force touches it
    monitors: Array  # by code (coupled_motion.py)
    before: Array  # the same at an earlier time of the step, at first at its start
    fired: Integers  # codes of those that are not positive (integrator.py)
    load: Array  # force on each coordinate that dry friction holds
    terms: Array  # sum of the magnitudes it is made of


SmoothRef = by_reference(Smooth, __name__)


class Projection(NamedTuple):
    """What takes back drift off the contacts in force (coupled_motion.py); positions in m, velocities in m/s."""

    G: Array  # of the contacts whose drift is taken back
    row: Integers  # of G, by row of A
    wanted: Array  # scaled by `scale`: by how much a gap shall change
    A: Array
    change: Array  # right-hand side: by how much each row shall change
    scale: Array  # see `solve_small`
    order: Integers
    x: Array
    correction: Array  # what makes the change, by row of G: impulses, or for positions impulses times a second


ProjectionRef = by_reference(Projection, __name__)


class Waiting:
    """A contact that may close, or, with `contact` NO_CONTACT, a pair of bodies that then enters its next cell."""

    contact: int
    pair: int
    start: float  # s in the step: where the next look begins
    until: float  # s in the step: where the pair leaves its cell
    stays_open: float  # s in the step: it cannot close before


class Search:
    """The search for the first contact that closes in a step."""

    number: int  # of searches so far


class Path(NamedTuple):
    """Where bodies are within a step (step_path.py), and which contacts may close there (first_closing.py)."""

    q: Array
    u: Array
    pose: Any
    probe: Closed  # kinematics of one contact
    waiting: Any  # records of `Waiting`: contacts that may close, the one that could be first in front
    around: Records  # by primitive: `CIRCLE`
    search: Search
    spared: Integers  # by contact: the last search that has found it to stay open all the time


PathRef = by_reference(Path, __name__)


class EventRoom(NamedTuple):
    """The contacts closed at an event (`handle_event` and what it calls)."""

    pose: Any
    closed: Closed  # of one island
    rest: Closed  # those of them in I_N
    peak_speed: Array  # largest magnitude of each velocity at this instant
    zero: Array  # m/s, by row of `closed`: the gap rate that counts as zero
    loose: Modes  # by coordinate: 1 where contacts in force allow the accelerations of its island
    disturbed: Modes  # by island: 1 if its modes are to be decided
    waits: Modes  # by row of `closed`: 1 if it may wait behind a parallel one
    label: Integers  # by coordinate: its island
    listed: Integers  # the closed contacts, by island
    upto: Integers  # by place in `listed`: the place behind the last contact of the same island
    decided: Modes  # by contact, of those in I_N: the modes the complementarity problem has decided
    trial: Modes  # by contact: the modes in which velocities are corrected
    in_force: Integers  # contacts in force, before those of awake bodies are put first
    touched: Modes  # by island: 1 if a contact or bearing holds it
    terms: Array  # sum of the magnitudes of the forces on each coordinate


EventRoomRef = by_reference(EventRoom, __name__)


class ImpactRoom(NamedTuple):
    """One impact and the end of a chatter (impacts.py)."""

    restitution: Array  # by row of the closed contacts
    impulse: Array  # N and T by row
    before: Array  # velocities before it
    rates_before: Array  # of the contacts, N and T by row
    rates: Array  # after it
    grip: Modes  # by coordinate, right after it
    ending: Array  # impulses that end a chatter, N and T by row of `EventRoom.rest`
    mode: Modes  # by contact: in which a chatter ends


ImpactRoomRef = by_reference(ImpactRoom, __name__)


class UnknownCell:
    """Where the table of cells had no answer."""

    pair: int  # of bodies


class CellRequest(NamedTuple):
    """What Python is to look up when the loop comes back with CELL_UNKNOWN."""

    cell: UnknownCell
    at: Array  # coordinates


CellRequestRef = by_reference(CellRequest, __name__)


@kernel
def request_cell(out_request, p, q):
    """Note the cell of body pair p at coordinates q."""
    out_request.cell.pair = p
    for i in range(len(q)):
        out_request.at[i] = q[i]


class Ended:
    """What ended the last steps, see `_note_end` in event_loop.py; the newest overwrites the oldest."""

    number: int  # of steps ended so far
    by: Annotated[Integers, RECENT]


class Scratch(NamedTuple):
    """All of it."""

    step: Step
    work: ContactWork
    projection: Projection
    smooth: Smooth
    path: Path
    event: EventRoom
    impact: ImpactRoom
    requested: CellRequest
    ended: Ended


ScratchRef = by_reference(Scratch, __name__)


@inlined
def state_by_reference(state):
    """A state as nested structs."""
    return StateRef(state.clock, state.q, state.u, state.a, RegimeRef(*state.regime), *state[5:])


@inlined
def scratch_by_reference(scratch):
    """The scratch arrays as nested structs; what holds structs itself names them first."""
    smooth, path, event = scratch.smooth, scratch.path, scratch.event
    step, work = StepRef(*scratch.step), contact_work_by_reference(scratch.work)
    closed = ClosedRef(*smooth.closed)
    return ScratchRef(
        step,
        work,
        ProjectionRef(*scratch.projection),
        SmoothRef(step, work.system, work.modes, smooth.held, smooth.y, smooth.dy, smooth.pose, closed, *smooth[8:]),
        PathRef(path.q, path.u, path.pose, ClosedRef(*path.probe), *path[4:]),
        EventRoomRef(event.pose, ClosedRef(*event.closed), ClosedRef(*event.rest), *event[3:]),
        ImpactRoomRef(*scratch.impact),
        CellRequestRef(*scratch.requested),
        scratch.ended,
    )


def cell_request(coordinates: int) -> CellRequest:
    """Room for one question."""
    return CellRequest(blank(UnknownCell), np.zeros(coordinates))


def _step_room(n: int) -> Step:
    width = 2 * n + SUMS
    parts: dict[str, Any] = {name: np.zeros(n) for name in ("q", "u", "bound")}
    parts |= {name: np.zeros(n, np.int8) for name in ("awake", "grip", "side")} | {
        name: np.zeros(width) for name in ("y0", "y1")
    }
    return Step(span=blank(Span), stages=np.zeros((16, width)), dense=np.zeros((7, width)), **parts)


def _projection_room(n: int, room: int) -> Projection:
    rows = 2 * room + n
    parts: dict[str, Any] = {name: np.zeros(rows) for name in ("wanted", "change", "scale", "x", "correction")}
    parts |= {name: np.zeros(rows, np.int64) for name in ("row", "order")}
    return Projection(G=np.zeros((rows, rows)), A=np.zeros((rows, rows)), **parts)


def _smooth_room(step: Step, work: ContactWork, bodies: int, room: int) -> Smooth:
    n = len(step.q)
    width, monitors = 2 * n + SUMS, MONITORS * (room + n)
    return Smooth(
        step=step,
        system=work.system,
        modes=work.modes,
        held=blank(Held),
        y=np.zeros(width),
        dy=np.zeros(width),
        pose=poses(bodies),
        closed=closed_contacts(room),
        engaged=np.zeros(bodies, np.int8),
        monitors=np.zeros(monitors),
        before=np.zeros(monitors),
        fired=np.zeros(monitors, np.int64),
        load=np.zeros(n),
        terms=np.zeros(n),
    )


def _event_room(n: int, bodies: int, contacts: int, room: int) -> EventRoom:
    return EventRoom(
        pose=poses(bodies),
        closed=closed_contacts(room),
        rest=closed_contacts(room),
        peak_speed=np.zeros(n),
        zero=np.zeros(room),
        loose=np.zeros(n, np.int8),
        disturbed=np.zeros(n, np.int8),
        waits=np.zeros(room, np.int8),
        label=np.zeros(n, np.int64),
        listed=np.zeros(room, np.int64),
        upto=np.zeros(room, np.int64),
        decided=np.zeros(contacts, np.int8),
        trial=np.zeros(contacts, np.int8),
        in_force=np.zeros(room, np.int64),
        touched=np.zeros(n, np.int8),
        terms=np.zeros(n),
    )


def _impact_room(n: int, contacts: int, room: int) -> ImpactRoom:
    by_row = {name: np.zeros(2 * room) for name in ("impulse", "rates_before", "rates", "ending")}
    grip, mode = np.zeros(n, np.int8), np.zeros(contacts, np.int8)
    return ImpactRoom(restitution=np.zeros(room), before=np.zeros(n), grip=grip, mode=mode, **by_row)


def _path_room(n: int, model: Model) -> Path:
    contacts = len(model.contacts)
    waiting = records(dtype_of(Waiting), contacts + len(model.pairs))
    places = np.zeros(n), np.zeros(n), poses(len(model.bodies)), closed_contacts(1)
    return Path(*places, waiting, circles_around(model.primitives), blank(Search), np.zeros(contacts, np.int64))


def new_scratch(model: Model) -> Scratch:
    """Room to work for one model."""
    n, bodies, contacts, room = len(model.coordinates), len(model.bodies), len(model.contacts), room_for(model)
    step, work = _step_room(n), contact_work(room, n)
    work.system.dry[:] = model.coordinates.coulomb
    return Scratch(
        step=step,
        work=work,
        projection=_projection_room(n, room),
        smooth=_smooth_room(step, work, bodies, room),
        path=_path_room(n, model),
        event=_event_room(n, bodies, contacts, room),
        impact=_impact_room(n, contacts, room),
        requested=cell_request(n),
        ended=blank(Ended),
    )
