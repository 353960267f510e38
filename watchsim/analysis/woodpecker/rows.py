"""Does the woodpecker toy come out?"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.compared import Row, compared
from watchsim.analysis.woodpecker.cycle import Cycle, find_cycle
from watchsim.analysis.woodpecker.motion import moments
from watchsim.analysis.woodpecker.stepping import step_to
from watchsim.analysis.woodpecker.toy import BEAK, LOWER, UPPER, Toy, modal, start

NAME = "woodpecker toy"
# One peck: the sleeve, jammed on its lower edge, breaks loose, slides and lets go; its upper edge meets the pole; the beak
# pecks; thrown back the upper edge slides up the pole; the lower edge meets it twice, slides down and jams.
ORDER = (
    ("start", -1),
    ("open", LOWER),
    ("impact", UPPER),
    ("impact", BEAK),
    ("impact", UPPER),
    ("open", UPPER),
    ("impact", LOWER),
    ("impact", LOWER),
    ("reverse", LOWER),
    ("slip", LOWER),
)
# The published run: Siconos, Moreau's time stepping with steps of 2e-5 s, examples/mechanics/Woodpecker/Woodpecker.ref.
PUBLISHED_TIME, PUBLISHED_STEP = 0.29998, 2e-5
PUBLISHED = {"height of the sleeve [m]": -0.04134818676833654, "tilt of the bird [rad]": -0.3409339755504301}
STEPS, SLOW_STEPS = (5e-5, 5e-6), (5e-5, 5e-6, 5e-7)
FASTEST = 250.0  # rad/s: what a step too early or late at each of the impacts does to the tilt of the bird after a peck


def woodpecker_rows(steps: tuple[float, ...] = STEPS) -> list[Row]:
    """Order of events, closing of the cycle, a published run, and Moreau's time stepping with these steps, s."""
    toy = Toy()
    cycle = find_cycle(toy)
    return [*_cycle_rows(cycle), *_published_rows(toy), *(_twin_row(toy, cycle, h) for h in steps)]


def _cycle_rows(cycle: Cycle) -> list[Row]:
    wrong = sum((event.cause, event.contact) != wanted for event, wanted in zip(cycle.events, ORDER, strict=False))
    wrong += abs(len(cycle.events) - len(ORDER))
    source = (
        "the toy of Glocker 1995 and of Leine, Glocker, van Campen, DETC 2001: a stable cycle, one peck after the other; the "
        "order of events as found here, no printed one was at hand"
    )
    return [
        compared(NAME, "events of a peck out of order", 0.0, float(wrong), 0.0, source),
        compared(NAME, "tilts and rates after one period, scaled", 0.0, cycle.gap, 1e-9, source),
        compared(NAME, "slope of the map beyond 1 (unstable)", 0.0, max(0.0, abs(cycle.slope) - 1.0), 0.0, source),
    ]


def _published_rows(toy: Toy) -> list[Row]:
    """The other code's steps shift each of the nine impacts and changes of mode by up to a step."""
    model = modal(toy)
    end = list(moments(model, *start(toy, model), PUBLISHED_TIME))[-1]
    source = "siconos-tutorials, examples/mechanics/Woodpecker/Woodpecker.ref, steps of 2e-5 s"
    got = {"height of the sleeve [m]": end.q[0], "tilt of the bird [rad]": end.q[2]}
    return [
        compared(NAME, f"{word} at {PUBLISHED_TIME:g} s", value, float(got[word]), FASTEST * PUBLISHED_STEP, source)
        for word, value in PUBLISHED.items()
    ]


def _twin_row(toy: Toy, cycle: Cycle, h: float) -> Row:
    model = modal(toy)
    first, last = cycle.events[0], cycle.events[-1]
    e, _ = step_to(model, model.into(first.q), model.into(first.u), cycle.period, h)
    tilts = float(np.abs((model.basis @ e - last.q)[1:]).max())
    source = "first order: the error of the event-driven solution would not go with the step"
    return compared(NAME, f"Moreau, steps of {h:g} s: tilts after a peck [rad]", 0.0, tilts, FASTEST * h, source)
