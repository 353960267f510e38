"""Does the woodpecker toy come out?"""

from __future__ import annotations

import numpy as np

from watchsim.verification.compared import Row, compared
from watchsim.verification.woodpecker.published import FASTEST, NAME, published_rows
from watchsim.verification.woodpecker.toy import Toy, modal
from watchsim.verification.woodpecker.toy_stepping import step_to
from watchsim.verification.woodpecker.woodpecker_cycle import Cycle, find_cycle

STEPS, SLOW_STEPS = (5e-5, 5e-6), (5e-5, 5e-6, 5e-7)


def woodpecker_rows(steps: tuple[float, ...] = STEPS) -> list[Row]:
    """Closing of the cycle, published runs with their order of events, and Moreau's time stepping with these steps, s."""
    toy = Toy()
    cycle = find_cycle(toy)
    return [*_cycle_rows(cycle), *published_rows(toy, cycle), *(_twin_row(toy, cycle, h) for h in steps)]


def _cycle_rows(cycle: Cycle) -> list[Row]:
    source = "the toy of Glocker 1995 and of Leine, Glocker, van Campen, DETC 2001: a stable cycle, one peck after the other"
    return [
        compared(NAME, "tilts and rates after one period, scaled", 0.0, cycle.gap, 1e-9, source),
        compared(NAME, "slope of the map beyond 1 (unstable)", 0.0, max(0.0, abs(cycle.slope) - 1.0), 0.0, source),
    ]


def _twin_row(toy: Toy, cycle: Cycle, h: float) -> Row:
    model = modal(toy)
    first, last = cycle.events[0], cycle.events[-1]
    e, _ = step_to(model, model.into(first.q), model.into(first.u), cycle.period, h)
    tilts = float(np.abs((model.basis @ e - last.q)[1:]).max())
    source = "first order: the error of the event-driven solution would not go with the step"
    return compared(NAME, f"Moreau, steps of {h:g} s: tilts after a peck [rad]", 0.0, tilts, FASTEST * h, source)
