"""How is a return map looked at where the parts rest otherwise than at the section that is known?

A second wheel is let off by large swings only, a tooth rests on another face. There the mechanism is brought by itself: on
its way in the oscillator gets the velocity that belongs to the other amplitude, and the next clear turning point is a section.
"""

from __future__ import annotations

import math

import numpy as np

from watchsim.analysis.verdicts.verdict_kinds import UNSETTLED
from watchsim.simulation.loop_state.state import NO_CONTACT, State
from watchsim.studies.limit_cycle.return_map import Return, ReturnMap
from watchsim.studies.limit_cycle.run_from_state import SolverGaveUp
from watchsim.studies.limit_cycle.section import NoSection, Section, first_section

INSIDE = 0.5  # of the smaller amplitude: where on the way in the velocity is changed
TURNS = 3  # clear turning points until one lies on the right side
LATER = 0.1  # of a period: from one turning point on to the next


class Swings:
    """One return map, from sections as they are needed; the first one is known."""

    def __init__(self, known: ReturnMap) -> None:
        self.known = known
        self._maps = [known]

    def __call__(self, amplitude: float, oscillations: int = 1) -> Return:
        """So many oscillations that begin at that amplitude (rad, m)."""
        chosen = self.map_at(amplitude)
        if chosen is None:
            return Return(np.nan, 0.0, UNSETTLED, None, np.zeros(0))
        return chosen(amplitude, oscillations)

    def state_at(self, amplitude: float) -> State | None:
        """The mechanism at a turning point of that amplitude; None where it cannot be brought there."""
        chosen = self.map_at(amplitude)
        return None if chosen is None else chosen.section.at(self.known.loop, self.known.parts, amplitude)

    def map_at(self, amplitude: float) -> ReturnMap | None:
        """The return map from a section where the parts rest as they do at that amplitude; None where there is none."""
        loop, parts = self.known.loop, self.known.parts
        nearest = sorted(self._maps, key=lambda one: abs(math.log(one.section.amplitude / amplitude)))
        for one in nearest:
            if one.section.at(loop, parts, amplitude) is not None:
                return one
        section = self._brought(nearest[0].section, amplitude)
        if section is None or section.at(loop, parts, amplitude) is None:
            return None
        self._maps.append(ReturnMap(loop, parts, section))
        return self._maps[-1]

    def _brought(self, section: Section, amplitude: float) -> Section | None:
        """A section near that amplitude, on the same side; None where the mechanism does not come to one."""
        loop, parts = self.known.loop, self.known.parts
        state, i, omega = section.at(loop, parts, section.amplitude), parts.coordinate, math.tau / parts.period
        if state is None:
            return None
        inside = INSIDE * min(1.0, amplitude / section.amplitude)
        try:
            loop.on(state, math.acos(inside) / omega, exactly=True)
            away = float(state.q[i]) - parts.level
            if abs(away) >= amplitude:
                return None
            state.u[i] = -section.side * omega * math.sqrt(amplitude**2 - away**2)
            state.now.event_waits, state.now.touched = 1, NO_CONTACT
            for _ in range(TURNS):
                found = first_section(loop, parts, state)
                if isinstance(found, NoSection) or found.side == section.side:
                    return None if isinstance(found, NoSection) else found
                state = found.state
                loop.on(state, LATER * parts.period, exactly=True)
        except SolverGaveUp:
            pass
        return None
