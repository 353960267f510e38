"""Which motion of the woodpecker toy repeats itself?

While the lower edge sticks only the bird moves, and the edge breaks loose at one tilt of the bird: what the toy does next
depends on one number, the bird's rate there. A cycle is a fixed point of the map from that number to the one a peck later.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from watchsim.verification.woodpecker.exact_motion import Moment, moments
from watchsim.verification.woodpecker.toy import LOWER, Array, Modal, Toy, modal, start

LONG = 0.5  # s: more than two pecks
SETTLED = 1e-13  # relative change of the fixed point


@dataclass(frozen=True)
class Cycle:
    """One peck: its events from one breaking loose to the next, the period, how far it is from closing, the map's slope."""

    events: list[Moment]
    period: float
    descent: float
    gap: float  # largest difference of tilts (rad) and of rates over 10 rad/s and 0.1 m/s, after one period
    slope: float


def breaks_loose(moment: Moment) -> bool:
    """True where the section is: the sleeve's lower edge gives way."""
    return moment.cause == "slip" and moment.contact == LOWER


def one_peck(model: Modal, q: Array, u: Array) -> list[Moment]:
    """Events from the state (q, u) to the next breaking loose, included."""
    events = []
    for moment in moments(model, model.into(q), model.into(u), LONG):
        events.append(moment)
        if len(events) > 1 and breaks_loose(moment):
            break
    return events


def find_cycle(toy: Toy) -> Cycle:
    """From the papers' start to the section, then the secant method."""
    model = modal(toy)
    first = next(moment for moment in moments(model, *start(toy, model), LONG) if breaks_loose(moment))
    place = np.array([0.0, *first.q[1:]])

    def after(rate: float) -> float:
        return float(one_peck(model, place, np.array([0.0, 0.0, rate]))[-1].u[2])

    rate, image = float(first.u[2]), after(float(first.u[2]))
    slope = 0.0
    for _ in range(20):
        new = rate + (image - rate) / (1.0 - slope)
        if abs(new - rate) <= SETTLED * abs(rate):
            break
        new_image = after(new)
        slope = (new_image - image) / (new - rate)
        rate, image = new, new_image
    events = one_peck(model, place, np.array([0.0, 0.0, rate]))
    last = events[-1]
    tilts = np.abs(last.q[1:] - place[1:]).max()
    rates = max(abs(last.u[0]) / 0.1, abs(last.u[1]) / 10.0, abs(last.u[2] - rate) / 10.0)
    return Cycle(events, last.t, -float(last.q[0]), float(max(tilts, rates)), slope)
