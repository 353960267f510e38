"""What can be said of the escape wheel without keeping where it was?

How far it came from turning point to turning point of the oscillator is counted as the run goes, so that missed beats and trips
do not depend on what is recorded.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FAST = 2.0  # times as many teeth as the oscillator can let go: a wheel that runs free
AHEAD = 1  # half pitches gained within two half swings: a trip
MOST_STEPS = 8  # half pitches in a half swing that are counted each by themselves; their median is 0, 1 or 2
STAYED = 0.05  # half pitches: a wheel that moved less has stayed where it was
SLIPPED = 1.5  # half pitches: what the wheel loses after it has gone so far is not what it slipped off
# What `WheelTally` holds besides its counts; nan where it is not known yet.
NAMES = (
    *("first", "first_angle"),  # at the first turning point where it is known: how many half swings were over, and the angle
    *("last", "angle"),  # the same at the last one
    *("gained", "gained_before"),  # half pitches more than half swings since the first one, there and at the one before
    *("tripped", "trip_start", "trip_end", "trip_t", "trip_contact"),  # see `Trips`
    *("place", "moved"),  # where it stays, and when that was first seen, s
    *("least", "least_t"),  # how far behind a wheel that runs free it was at most, and when, s; it started beside that
)


@dataclass(frozen=True, slots=True)
class Trips:
    """How often the wheel ran past; the half swing (s, s) in which it first did; when (s) and which contact it lost there,
    -1 where that is not known."""

    count: int
    start: float
    end: float
    t: float
    contact: int


@dataclass(frozen=True, slots=True)
class Lost:
    """Events in which the wheel met or lost what locks it: times (s), contacts, and how far it had come by then (rad)."""

    t: Array
    contact: NDArray[np.int64]
    angle: Array


class WheelTally:
    """Is given the wheel's angle (rad, in the sense of its drive, from the start of the run) at turning points, in order.

    Between two of them that are known, half swings and half pitches are only counted. Where the wheel goes on by a whole pitch
    in every other half swing, as with a detent, whole pitches are due.
    """

    def __init__(self, half_pitch: float, period: float) -> None:
        """`period`: the oscillator's nominal one, s."""
        self.half_pitch, self.free = half_pitch, 2.0 * FAST * half_pitch / period
        self.first = self.first_angle = self.last = self.angle = self.gained = self.gained_before = math.nan
        self.trip_start = self.trip_end = self.trip_t = self.trip_contact = self.place = self.moved = math.nan
        self.tripped = self.least = self.least_t = 0.0
        # Half pitches too many or too few: if one is due each time, or two after even, or odd, half swings.
        self.off = np.zeros(3)
        self.steps = np.zeros((2, 2 * MOST_STEPS + 1), np.int64)  # how often each step was made, by parity of the half swing

    def turn(self, number: int, start: float, end: float, angle: float, lost: Callable[[], Lost]) -> None:
        """The angle, nan where not known, at the end of a half swing from `start` to `end` (s), after which `number` are over;
        `lost` gives what the wheel lost in it."""
        if not math.isfinite(angle / self.half_pitch):
            return
        if angle - self.free * end < self.least:
            self.least, self.least_t = angle - self.free * end, end
        if not abs(angle - self.place) <= STAYED * self.half_pitch:
            self.place, self.moved = angle, end
        if math.isnan(self.first):
            self.first, self.first_angle, self.last, self.angle, self.gained = number, angle, number, angle, 0.0
            return
        last, step = int(self.last), round((angle - self.angle) / self.half_pitch)
        if step != number - last:
            self.off[0] += abs(step - number + last)
        for parity in (0, 1):
            self.off[1 + parity] += abs(step - 2 * (_of(number, parity) - _of(last, parity)))
        if number == last + 1:
            self.steps[last % 2, min(max(step, -MOST_STEPS), MOST_STEPS) + MOST_STEPS] += 1
        gained, before = round((angle - self.first_angle) / self.half_pitch) - (number - self.first), self.gained_before
        if gained - self.gained >= 2 * AHEAD if math.isnan(before) else gained - max(self.gained, before) >= AHEAD:
            self.tripped += 1.0
            if self.tripped == 1.0:
                self.trip_start, self.trip_end = start, end
                self.trip_t, self.trip_contact = self._slip(start, lost())
        self.last, self.angle, self.gained, self.gained_before = number, angle, gained, self.gained

    def _slip(self, start: float, lost: Lost) -> tuple[float, int]:
        """When (s) and from which contact the wheel slipped: the last that it lost before it had gone too far."""
        if not len(lost.t):
            return start, -1
        within = np.flatnonzero(lost.angle <= SLIPPED * self.half_pitch)
        which = within[-1] if len(within) else 0
        return float(lost.t[which]), int(lost.contact[which])

    @property
    def trips(self) -> Trips | None:
        """None where it never ran past."""
        if not self.tripped:
            return None
        return Trips(int(self.tripped), self.trip_start, self.trip_end, self.trip_t, int(self.trip_contact))

    @property
    def numbers(self) -> Array:
        """Of `NAMES`, to be saved."""
        return np.array([getattr(self, name) for name in NAMES])

    @numbers.setter
    def numbers(self, values: Array) -> None:
        for name, value in zip(NAMES, values.tolist(), strict=True):
            setattr(self, name, value)

    @property
    def missed(self) -> int | None:
        """Half swings in which the wheel did not go on by half a pitch, or half pitches it went too far; None where not known.

        From the start to the first turning point the first half swing is given the benefit of the doubt: the wheel may start
        on either side of it.
        """
        if math.isnan(self.first):
            return None
        only = self._only()
        one = 1.0 if only is None else 2.0  # half pitches
        missed = float(self.off[0 if only is None else 1 + only]) / one
        if self.first > 0:
            missed += max(0.0, abs(round(self.first_angle / self.half_pitch) - (self.first + 1.0)) - one) / one
        return int(missed)

    def _only(self) -> int | None:
        """The parity, 0 or 1, of the half swings that alone give the wheel a step, a whole pitch; None where all do."""
        usual = [_median(counts) for counts in self.steps]
        return usual.index(2.0) if sorted(usual) == [0.0, 2.0] else None

    def finished(self) -> dict[str, Any]:
        """As plain numbers."""
        trips, moved = None if self.trips is None else asdict(self.trips), None if math.isnan(self.moved) else self.moved
        return {"missed": self.missed, "moved": moved, "least": [self.least_t, self.least], "trips": trips}


def trips_of(sums: Mapping[str, Any]) -> Trips | None:
    """From the sums of a run."""
    trips = sums.get("wheel", {}).get("trips")
    return None if trips is None else Trips(**trips)


def _of(half_swings: int, parity: int) -> int:
    """How many half swings of that parity there are before so many."""
    return (half_swings + 1 - parity) // 2


def _median(counts: NDArray[np.int64]) -> float:
    """Of the steps that were counted; nan where none was."""
    total, below = int(counts.sum()), np.cumsum(counts)
    if not total:
        return math.nan
    low, high = (int(np.searchsorted(below, place, side="right")) for place in ((total - 1) // 2, total // 2))
    return 0.5 * (low + high) - MOST_STEPS
