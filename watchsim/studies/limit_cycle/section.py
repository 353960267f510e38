"""Where does an oscillation begin and end?

At a turning point of the oscillator, while everything else stands still: the wheel locked, the lever on its banking. There one
number, how far it has swung, tells the whole future, because what stands still is held and comes back to the same place, the
wheel a tooth further. Along that number the return map is smooth: on the way it meets the same contacts in the same order.

A wheel may also rest on the oscillator itself, as in a dead-beat or a recoil escapement. Then it stands still while the
oscillator turns, and where it stands follows from how far that has swung (following.py).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.loop_state.state import NO_CONTACT, State
from watchsim.simulation.loop_state.state_arrays import arrays_of
from watchsim.studies.limit_cycle.following import follow, in_force
from watchsim.studies.limit_cycle.oscillator_and_wheel import Parts
from watchsim.studies.limit_cycle.run_from_state import Events, Loop, copied

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
    _begin_anew(state, parts, side)
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


def _begin_anew(state: State, parts: Parts, side: float) -> None:
    """Time 0, the oscillator at rest for an instant, nothing counted yet."""
    i = parts.coordinate
    state.clock.event -= state.clock.time
    state.clock.time = 0.0
    state.u[i] = 0.0
    state.side_u[i], state.side_q[i] = -side, side
    state.now.event_waits, state.now.touched = 1, NO_CONTACT  # which way dry friction in its bearing acts is decided anew
    anew = arrays_of(state)
    anew.sums[:], anew.counts[:], anew.worst[:] = 0.0, 0, 0.0
