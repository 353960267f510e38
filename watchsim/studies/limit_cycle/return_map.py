"""Where does the oscillator turn next time, when it turned at this amplitude?

One oscillation, from a turning point to the next one on the same side, and what else must be true of it: two turning points,
all else at rest at the last one, and the wheel one tooth further.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from watchsim.analysis.verdicts.verdict_kinds import BACKWARDS, KNOCKS, STOPS, TRIPS, UNSETTLED
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.loop_state.state import State
from watchsim.studies.limit_cycle.oscillator_and_wheel import Parts
from watchsim.studies.limit_cycle.run_from_state import Events, Loop, SolverGaveUp, copied
from watchsim.studies.limit_cycle.section import Section, is_touched, others_rest, turns

EARLY, LATE = 0.03, 0.06  # of a period: how long before its end an oscillation is looked at, and for how long after
LONGER = 1.5  # times the time of the last oscillation: how long the next one may take
NEAR = 0.05  # of a pitch: by how much the wheel may miss a whole number of teeth
FAR, LIFT = 2.0, 0.3  # times where the lift begins, and of the amplitude: what is struck further out is no lift


class Return(NamedTuple):
    """One oscillation or several; SI.

    amplitude  at the turning point it ends with; `time` of it, from that at which it began
    trouble    "" for a regular one, else the verdict that it suggests
    state      at its end, or shortly before where nothing touches the oscillator; all but that at rest. None after trouble
    events     all of it
    """

    amplitude: float
    time: float
    trouble: str
    state: State | None
    events: Events


class ReturnMap:
    """Oscillations from one section, at any amplitude. `period` (s) follows what was found last."""

    def __init__(self, loop: Loop, parts: Parts, section: Section) -> None:
        self.loop, self.parts, self.section = loop, parts, section
        self.period = parts.period
        self.returns = 0  # oscillations computed so far

    def __call__(self, amplitude: float, oscillations: int = 1) -> Return:
        """So many oscillations that begin at that amplitude."""
        begin = self.section.at(self.loop, self.parts, amplitude)
        if begin is None:
            return Return(np.nan, 0.0, UNSETTLED, None, np.zeros(0))
        try:
            got, usual = self._followed(copied(begin), oscillations), self.period
            if got.trouble in (UNSETTLED, STOPS) and self._timed_anew(begin, oscillations):
                got = self._followed(begin, oscillations)
                self.period = usual if got.trouble else self.period
            return got
        except SolverGaveUp as failure:
            return Return(np.nan, failure.time, str(failure), None, np.zeros(0))

    def _timed_anew(self, begin: State, oscillations: int) -> bool:
        """True where it swings in another time than the last one did: `period` is then that time."""
        state = copied(begin)
        own = turns(self.loop.on(state, LONGER * oscillations * self.period), self.parts)
        if len(own) < 2 * oscillations:
            return False
        period = float(own[2 * oscillations - 1]["t"]) / oscillations
        other = abs(period - self.period) > 0.5 * EARLY * self.period
        self.period = period if other else self.period
        return other

    def _followed(self, state: State, oscillations: int) -> Return:
        end = oscillations * self.period
        self.returns += oscillations
        events = self.loop.on(state, end - EARLY * self.period, exactly=True)
        seen = len(turns(events, self.parts))
        advance = self._advance(state)
        kept = copied(state)
        events = np.concatenate([events, self.loop.on(state, end + LATE * self.period)])
        own = turns(events, self.parts)
        trouble = self._trouble(seen, own, events, oscillations, advance)
        if trouble:
            return Return(np.nan, end, trouble, None, events)
        last = own[2 * oscillations - 1]
        if self.section.touching:
            self.loop.on(kept, float(last["t"]), exactly=True)
        if is_touched(self.parts, kept) != self.section.touching or not others_rest(self.loop, self.parts, kept):
            return Return(np.nan, end, UNSETTLED, None, events)
        self.period = float(last["t"]) / oscillations
        away = self.section.side * (float(last["value"]) - self.parts.level)
        return Return(away, float(last["t"]), "", kept, events[events["t"] <= last["t"]])

    def _advance(self, state: State) -> float:
        """How far the wheel has come, rad."""
        i = self.parts.wheel
        return self.parts.sense * float(state.q[i] - self.section.state.q[i]) if i >= 0 else 0.0

    def _trouble(self, seen: int, own: Events, events: Events, oscillations: int, advance: float) -> str:
        parts = self.parts
        if parts.has_lever and knocked(events, own, parts):
            return KNOCKS
        teeth = advance / parts.pitch if parts.pitch else None
        if teeth is not None:
            if teeth < -NEAR:
                return BACKWARDS
            if teeth > oscillations + NEAR:
                return TRIPS
            if teeth < oscillations - NEAR:
                return STOPS
        elif parts.wheel >= 0 and advance <= 0.0:
            return BACKWARDS if advance < 0.0 else STOPS
        if len(own) < 2 * oscillations:
            return STOPS
        sides = np.sign(own["value"][: 2 * oscillations] - parts.level) * self.section.side
        regular = seen == 2 * oscillations - 1 and (sides == np.resize([-1.0, 1.0], 2 * oscillations)).all()
        return "" if regular else UNSETTLED


def knocked(events: Events, own: Events, parts: Parts) -> bool:
    """Was the oscillator struck on its way out, far outside the lift?

    The first noise of a beat is heard where the lift begins, on the way in; the lift ends as far on the other side. How far
    from the rest position a noise was heard follows from its time: between passage and turning point nearly a sine.
    """
    noises = events["t"][(events["kind"] == EventKind.IMPACT) & parts.touching[events["contact"]]]
    passages = events["t"][(events["kind"] == EventKind.CROSS) & (events["body"] == parts.body)]
    reached = np.append(0.0, own["t"])
    for passage in passages:
        before, after = reached[reached < passage], reached[reached > passage]
        if not len(before) or not len(after):
            continue
        heard = noises[(noises > before[-1]) & (noises <= after[0])]
        phase = (heard - passage) / np.where(heard < passage, passage - before[-1], after[0] - passage)
        away = np.sin(0.5 * np.pi * phase)
        if len(away) and away.max() > max(FAR * abs(min(away[0], 0.0)), LIFT):
            return True
    return False
