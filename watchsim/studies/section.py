"""Where does a study begin when a changed dimension has pushed bodies into each other?

A scene is drawn so that bodies touch at the start: a tooth at its locking face, the lever at its banking. Shift a pivot by a
micrometre, and they overlap. A limit cycle does not depend on the start, so the coordinates may give way: by the smallest
change that leaves no gap negative.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cells import CellFinder
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import OVER_TIME, frozen
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Torque
from watchsim.scene.roles import drive_direction, frequency, keeps_time, nominal_frequency, pitch, roles
from watchsim.scene.scene import Scene
from watchsim.scene.teeth import train, turns_of_a_round
from watchsim.scene.trains import bonds, rides
from watchsim.simulation.event_loop import EVENTS_PER_CONTACT, ROWS_PER_STEP, advance
from watchsim.simulation.foregone import Foregone
from watchsim.simulation.options import Options, options_of
from watchsim.simulation.scratch import Until, new_record, new_scratch, new_until
from watchsim.simulation.start import clear_start, directions, kinematics_at, overlapping_rows, taken_back_from
from watchsim.simulation.start import warm_up as warm_up_start
from watchsim.simulation.state import NO_CONTACT, EventKind, State, Stop, arrays_of, copy_of_state, new_state, room_for
from watchsim.tolerances import FIRST_STEP


@dataclass(frozen=True)
class Parts:
    """The oscillator and, where there is one, the escape wheel; SI.

    coordinate  of the oscillator; `body` its number in the scene; `level` where it stands in balance
    wheel       coordinate of the escape wheel, -1 without one; `sense` the way it is driven; `pitch` None without equal teeth
    rounds      turns of it after which the same teeth of its train are in mesh; at most so many are looked at
    train       coordinates of all that turns with it, its own included: these go on and on, all others come back
    period      of small swings; `nominal` what the rate is measured against
    has_lever   True where a lever stands between the two
    touching    by contact: True where it touches the oscillator; a last False stands for no contact (-1)
    blocking    the same of contacts with the lever and with what is fixed, which may turn the oscillator back
    """

    coordinate: int
    body: int
    level: float
    wheel: int
    rounds: int
    train: tuple[int, ...]
    sense: float
    pitch: float | None
    period: float
    nominal: float
    has_lever: bool
    touching: NDArray[np.bool_]
    blocking: NDArray[np.bool_]

    @property
    def teeth(self) -> int | None:
        return round(2.0 * np.pi / self.pitch) if self.pitch else None


def parts_of(scene: Scene, compiled: Compiled) -> Parts | None:
    """None where nothing swings on its own."""
    found, hertz = roles(scene), frequency(scene)
    if found.oscillator is None or hertz is None:
        return None
    names = [body.name for body in scene.bodies]
    body, model = names.index(found.oscillator), compiled.model
    coordinate = compiled.slices[found.oscillator].start
    owner = model.primitives.body
    blocks = np.zeros(len(model.bodies), bool)  # behind those of the scene stand racks of gears and of springs' stops
    blocks[: len(names)] = [one.motion == "fixed" or one.name == found.lever for one in scene.bodies]
    touching = np.append((owner[model.contacts.a] == body) | (owner[model.contacts.b] == body), False)
    # A wheel geared to another body stands where that one's coordinate says.
    bound = bonds(scene.bodies, rides(scene.bodies))
    bond = bound[names.index(found.wheel)] if found.wheel else None
    part = pitch(scene, found.wheel) if found.wheel and keeps_time(scene) else None
    return Parts(
        coordinate,
        body,
        float(model.coordinates[coordinate].level),
        int(model.bodies[bond.to].first) if bond else -1,
        turns_of_a_round(scene, found.wheel) if found.wheel else 1,
        tuple({int(model.bodies[bound[names.index(name)].to].first) for name in train(scene, found.wheel)})
        if found.wheel
        else (),
        drive_direction(scene, found.wheel) * math.copysign(1.0, bond.given) if found.wheel and bond else 1.0,
        part / abs(bond.given) if part and bond else None,
        1.0 / hertz,
        1.0 / (nominal_frequency(scene) or hertz),
        found.lever is not None,
        touching,
        touching & np.append(blocks[owner[model.contacts.a]] | blocks[owner[model.contacts.b]], False),
    )


def with_springs_held(scene: Scene) -> Scene:
    """The scene with every mainspring kept as far wound as at the start: a watch settles in minutes, it runs down in days."""
    if not any(torque.mainspring for torque in scene.torques):
        return scene
    held = tuple(Torque(torque.body, torque.value) if torque.mainspring else torque for torque in scene.torques)
    return dataclasses.replace(scene, torques=held)


def why_no_section(compiled: Compiled, parts: Parts) -> str:
    """Why no turning point can stand for the whole state; "" where one can."""
    model = compiled.model
    if any(table.over >= OVER_TIME for table in model.tables):
        return "a torque over time drives the mechanism, so that no state of it comes back"
    if any(own == parts.coordinate for own, _, _ in compiled.against) or model.coordinates[parts.coordinate].watched == 0:
        return "the oscillator rides on a moving body"
    if compiled.loose:
        return f"the pivot of {min(compiled.loose)} has play, in which it does not come to rest while the oscillator turns back"
    return ""


DEEPEST = (1e-6, 1e-5)  # m: how deep an overlap may be; tried in turn, since far behind a face other faces are near


_last: tuple[Compiled, Options, NDArray[np.float64] | None] | None = None


def freed_start(compiled: Compiled, options: Options) -> NDArray[np.float64] | None:
    """Coordinates near the scene's start at which nothing overlaps; None where bodies overlap by more than a little.

    What was asked last is remembered: a sample's geometry is measured where its motion begins.
    """
    global _last  # noqa: PLW0603
    if _last is None or _last[0] is not compiled or _last[1] != options:
        _last = compiled, options, _freed(compiled, options)
    return _last[2]


def _freed(compiled: Compiled, options: Options) -> NDArray[np.float64] | None:
    ids = np.unique(compiled.model.near)
    model = compiled.model._replace(contacts=frozen(compiled.model.contacts[ids]))
    found = None
    for near in DEEPEST:
        if not len(overlapping_rows(model, kinematics_at(model, compiled.q), options, near, options.behind)):
            continue
        q = taken_back_from(model, compiled.q, options, near)
        if q is not None and not len(overlapping_rows(model, kinematics_at(model, q), options, DEEPEST[-1], options.behind)):
            return q
        found = q if found is None else found
    return found


# What `simulate` does around the compiled loop, reduced to what a return map needs: states that can be copied, changed and
# taken up again, and the events of an oscillation.

Events = NDArray[Any]

EVENTS = 4000  # room for those of a slice
STEPS = 4000.0  # at most between two looks at the clock
NO_ROWS = np.zeros((0, 2))  # the windows in which rows are kept


class SolverGaveUp(Exception):
    """The event loop could not go on; `stop` says why, `time` (s) when, counted from the state it was given."""

    def __init__(self, stop: Stop, time: float) -> None:
        self.stop, self.time = stop, time
        super().__init__(stop.sentence)


class Loop:
    """The compiled loop of one scene at one tolerance; states are values that it is given."""

    def __init__(self, scene: Scene, tolerance: float, like: Loop | None = None) -> None:
        """`like` is a loop of the same scene at another tolerance: what it knows need not be found again."""
        self.scene, self.tolerance = scene, tolerance
        self.compiled: Compiled = like.compiled if like else compile_scene(scene)
        model = self.compiled.model
        self.options = options_of(scene, self.compiled, tolerance)
        self.finder: CellFinder = like.finder if like else CellFinder(self.compiled.seen or model)
        self._scratch = new_scratch(model)
        self._record = new_record(model, ROWS_PER_STEP + 64, EVENTS + EVENTS_PER_CONTACT * room_for(model), NO_ROWS)
        self.simulated = 0.0  # s, over all states

    def warm_up(self) -> None:
        """Load or compile the kernels: a call that returns at once because it has no room to record."""
        nowhere = new_record(self.compiled.model, 0, 0, NO_ROWS)
        self._call(new_state(self.compiled.model, self.compiled.q, self.compiled.u), new_until(), nowhere)
        warm_up_start(self.scene, self.compiled.model)

    def begin(self) -> State:
        """The state at the scene's start; SceneError where bodies overlap there, but for a little (see beginning.py)."""
        try:
            q, _ = clear_start(self.scene, self.compiled, self.finder, self.options)
        except SceneError:
            freed = freed_start(self.compiled, self.options)
            if freed is None:
                raise
            q = freed
        state = new_state(self.compiled.model, q, self.compiled.u)
        state.clock.step = FIRST_STEP * self.options.max_step
        return state

    def on(self, state: State, time: float, exactly: bool = False) -> Events:
        """Bring `state` to the end of the step that passes `time` (s), or `exactly` there; the events on the way.

        SolverGaveUp where the loop cannot go on; KeyboardInterrupt between two slices.
        """
        begun = float(state.clock.time)
        until = new_until(time, time if exactly else math.inf, may_cut=True, steps=STEPS)
        parts = []
        while True:
            stop = self._call(state, until, self._record)
            if stop == Stop.CELL_UNKNOWN:
                self.finder.learn(int(self._scratch.requested.cell.pair), self._scratch.requested.at.copy(), state.u)
                continue
            events = int(self._record.used.events)
            parts.append(self._record.events[:events].copy())
            self._record.used.rows, self._record.used.events = 0, 0
            if stop == Stop.DURATION or (stop == Stop.SLICE and state.clock.time >= time):
                break
            if stop == Stop.SLICE:
                until.steps = STEPS
            elif stop != Stop.BUFFER_FULL:
                raise SolverGaveUp(stop, float(state.clock.time))
        self.simulated += float(state.clock.time) - begun
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def _call(self, state: State, until: Until, record: Any) -> Stop:
        return Stop(int(advance(self.compiled.model, self.finder.cells, state, self.options, until, self._scratch, record)))


def copied(state: State) -> State:
    """The same state in arrays of its own."""
    return copy_of_state(state)


# A dead-beat tooth stays where it is, since its locking arc has the oscillator's pivot as centre; a recoiling one gives way.
# The contacts in force stay closed: of all positions that keep their gaps, the nearest one in the metric of the mass matrix.

ROUNDS = 30  # of Newton's method; faces are lines and arcs
CLOSED = 0.1  # of what the event loop takes for a closed gap; some units in the last place


def in_force(state: State) -> NDArray[np.int64]:
    """The closed contacts."""
    return state.regime.active[: int(state.instant.awake_contacts + state.instant.sleeping_contacts)]


def follow(loop: Loop, state: State, coordinate: int) -> bool:
    """Move all but that coordinate until the contacts in force have the gap 0 again.

    False where that cannot be: the oscillator is turned too far, and another face would be touched.
    """
    ids = np.unique(in_force(state))
    if not len(ids):
        return True
    model = loop.compiled.model._replace(contacts=frozen(loop.compiled.model.contacts[ids].copy()))
    root = np.sqrt(model.coordinates.mass)
    for _ in range(ROUNDS):
        closed = kinematics_at(model, state.q)
        gaps = closed.kin.g
        if np.abs(gaps).max() <= CLOSED * loop.options.gap_zero:
            return bool((closed.kin.margin >= -loop.options.extent).all())
        ways = directions(closed, closed.w_N, len(state.q)) / root
        ways[:, coordinate] = 0.0
        change = -np.linalg.lstsq(ways, gaps, rcond=1e-9)[0]
        state.q[:] += change / root
        if np.abs(change / root / model.coordinates.scale).max() > 1.0:
            return False
    return False


# At a turning point of the oscillator, while everything else stands still: the wheel locked, the lever on its banking. There
# one number, how far it has swung, tells the whole future, because what stands still is held and comes back to the same
# place, the wheel a tooth further. Along that number the return map is smooth: on the way it meets the same contacts in the
# same order.
#
# A wheel may also rest on the oscillator itself, as in a dead-beat or a recoil escapement. Then it stands still while the
# oscillator turns, and where it stands follows from how far that has swung (following.py).

LOOKS = 8  # in a period, for turning points
LONGEST = 40  # periods until a clear turning point is met
MOST_TURNS = 2  # between two looks; more are a rattling, and each that is tried costs as much as the look
SILENT = 3  # periods without a turning point: it does not swing


@dataclass(frozen=True)
class Section:
    """A state at a turning point, with time 0 there.

    side       +1 or -1: the side of the rest position it lies on
    amplitude  from the rest position, rad or m
    touching   True where something rests on the oscillator
    """

    state: State
    side: float
    amplitude: float
    touching: bool = False

    def at(self, loop: Loop, parts: Parts, amplitude: float) -> State | None:
        """A copy of the state, with the oscillator turning at another amplitude; None where what rests on it cannot follow."""
        state = copied(self.state)
        state.q[parts.coordinate] = parts.level + self.side * amplitude
        return state if not self.touching or follow(loop, state, parts.coordinate) else None


@dataclass(frozen=True)
class NoSection:
    """Why none was met: `still` where the oscillator does not swing any more."""

    still: bool
    time: float  # s, simulated


def turns(events: Events, parts: Parts) -> Events:
    """The oscillator's turning points."""
    return events[(events["kind"] == EventKind.TURN) & (events["body"] == parts.body)]


def first_section(loop: Loop, parts: Parts, state: State) -> Section | NoSection:
    """The first turning point after `state`'s time at which everything else stands still; `state` is used up."""
    last, limit = float(state.clock.time), float(state.clock.time) + LONGEST * parts.period
    foregone = Foregone(loop.scene, loop.compiled, last, state.q)
    while state.clock.time < limit:
        before, begun = copied(state), float(state.clock.time)
        found = turns(loop.on(state, begun + parts.period / LOOKS), parts)
        for turn in found[-MOST_TURNS:]:
            last = float(turn["t"])
            section = section_at(loop, parts, before, last)
            if section is not None:
                return section
        if state.clock.time - last > SILENT * parts.period:
            return NoSection(True, float(state.clock.time))
        if foregone.look(float(state.clock.time), state.q, lambda: math.inf):  # the wheel races
            break
    return NoSection(False, float(state.clock.time))


def section_at(loop: Loop, parts: Parts, before: State, time: float) -> Section | None:
    """The section at a turning point at that time (s), reached from a state before it; None as in `section_from`."""
    state = copied(before)
    loop.on(state, time, exactly=True)
    return section_from(loop, parts, state)


def section_from(loop: Loop, parts: Parts, turning: State) -> Section | None:
    """The section of a state at a turning point; None where something else moves, or a lever holds the oscillator."""
    if not others_rest(loop, parts, turning) or (parts.has_lever and is_touched(parts, turning)):
        return None
    state = copied(turning)
    away = float(state.q[parts.coordinate]) - parts.level
    side, touching = 1.0 if away > 0.0 else -1.0, is_touched(parts, state)
    # Time 0, the oscillator at rest for an instant, nothing counted yet.
    i = parts.coordinate
    state.clock.event -= state.clock.time
    state.clock.time = 0.0
    state.u[i] = 0.0
    state.side_u[i], state.side_q[i] = -side, side
    # Which way dry friction in its bearing acts is decided again.
    state.instant.event_waits, state.instant.touched = 1, NO_CONTACT
    anew = arrays_of(state)
    anew.sums[:], anew.counts[:], anew.worst[:] = 0.0, 0, 0.0
    if touching:
        state.u[:] = 0.0
    return Section(state, side, abs(away), touching)


def is_touched(parts: Parts, state: State) -> bool:
    """True if something touches the oscillator."""
    return bool(parts.touching[in_force(state)].any())


def others_rest(loop: Loop, parts: Parts, state: State) -> bool:
    """True if nothing but the oscillator moves."""
    speeds = np.abs(state.u) * loop.options.size / loop.compiled.model.coordinates.scale
    speeds[parts.coordinate] = 0.0
    return bool((speeds <= loop.options.speed_zero).all())
