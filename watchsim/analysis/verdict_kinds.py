"""What is a verdict?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.units import metric

TICKS, STOPS, KNOCKS, TRIPS = "ticks", "stops", "knocks", "trips"
OVERBANKS, BACKWARDS, UNSETTLED = "overbanks", "backwards", "unsettled"
VERDICTS = (TICKS, STOPS, KNOCKS, TRIPS, OVERBANKS, BACKWARDS, UNSETTLED)
SPOKEN = {BACKWARDS: "runs backwards", UNSETTLED: "has not settled"}  # after "the watch"; others as they are
BESIDE = {  # a number that would pass for good otherwise
    STOPS: "before it stopped",
    KNOCKS: "while it knocks",
    TRIPS: "while it trips",
    OVERBANKS: "before it overbanked",
    BACKWARDS: "running backwards",
    UNSETTLED: "not settled",
}

WATCHES = (1e-9, 1e-3)  # N·m


@dataclass(frozen=True, slots=True)
class Verdict:
    """`name` is one of VERDICTS, None where nothing keeps time; `message` a sentence for people.

    t       when it happened first, or since when it is so, s
    body    the body that does it
    pair    the contact at which it shows, in words
    torque  of the drive at the wheel then, N·m
    count   how often, where it is something that happens
    """

    name: str | None
    message: str | None = None
    t: float | None = None
    body: str | None = None
    pair: str | None = None
    torque: float | None = None
    count: int | None = None

    @property
    def works(self) -> bool:
        """False for a watch that is out of order; one that has yet to settle is not."""
        return self.name in (None, TICKS, UNSETTLED)


NOTHING = Verdict(None)


def when(t: float) -> str:
    """ "t = 0.8312 s"."""
    return f"t = {t:.4f} s"


def torque_text(value: float) -> str:
    """Without its sign: what counts is how much. In µN·m, as torques of watches are given, but for those of clocks."""
    size = abs(value)
    return f"{1e6 * size:.3g} µN·m" if WATCHES[0] <= size < WATCHES[1] else metric(size, "N·m", 3)


def degrees(value: float) -> str:
    """Of radians, with a true minus sign."""
    return f"{math.degrees(value):.3g}°".replace("-", "−")


def times(count: int) -> str:
    return {1: "once", 2: "twice"}.get(count, f"{count} times")
