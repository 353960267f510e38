"""What is known about a limit cycle?"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from watchsim.analysis.timing import HEARD
from watchsim.displays import notebook_html
from watchsim.simulation.recording import first_noises, unevenness
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array
from watchsim.studies.section import Events, Parts, turns

# The same definitions as for the beats of a run, over exactly one turn of the wheel: half swings from turning point to
# turning point, noises with the silence before them. As the cycle closes, the first half swing has its predecessors too.


class Measures(NamedTuple):
    """Means over a cycle; SI. `spread` is the largest minus the smallest amplitude of whole oscillations, `each` all of them.

    uneven  half of: the half period that ends in a swing upwards, less the one that ends in a swing downwards; the beat error
            is its magnitude
    """

    amplitude: float
    period: float
    uneven: float
    spread: float
    each: tuple[float, ...] = ()


def measures(events: Events, parts: Parts, start: float, time: float) -> Measures:
    """Of a cycle that begins at time 0 at the turning point `start` (rad or m) and ends after `time` (s) at the last one."""
    own = turns(events, parts)
    reached = np.append(start, own["value"])
    ways = np.diff(reached)
    amplitude = 0.5 * np.abs(ways)
    whole = 0.5 * (amplitude[0::2] + amplitude[1::2])
    marks = _marks(events, parts, np.append(0.0, own["t"]))
    around = np.concatenate([marks[-2:] - time, marks])
    uneven = np.sign(ways) * unevenness(around)[2:]
    period = time / (len(ways) // 2)
    return Measures(float(amplitude.mean()), period, 0.5 * float(uneven.mean()), float(np.ptp(whole)), tuple(whole.tolist()))


def _marks(events: Events, parts: Parts, ends: Array) -> Array:
    """What the beat error is measured by: first noises where they are heard, else passages; one for each half swing."""
    noises = events["t"][(events["kind"] == EventKind.IMPACT) & parts.touching[events["contact"]]]
    heard = first_noises(noises, ends[:-1], ends[1:], 0.5 * parts.period)
    passages = events["t"][(events["kind"] == EventKind.CROSS) & (events["body"] == parts.body)]
    if len(passages) != len(heard) or np.isfinite(heard).mean() >= HEARD:
        return heard
    return passages


JSON_NAMES = (
    *("found", "verdict", "message", "amplitude_deg", "amplitude_deg_error", "period_s", "period_s_error"),
    *("rate_s_per_d", "rate_s_per_d_error", "beat_error_ms", "beat_error_ms_error", "uneven_ms", "multipliers"),
    "multipliers_error",
    *("oscillations", "amplitudes_deg", "tooth_spread_deg", "cycles", "starts", "simulated_s", "cells_s", "wall_s"),
)


@dataclass(frozen=True)
class Orbit:
    """One of the cycles that a mechanism has, stable or not.

    amplitudes_deg  of each of its oscillations, one after the other
    multiplier      of a whole round of it; `stable` where its magnitude is below 1
    """

    amplitudes_deg: tuple[float, ...]
    period_s: float
    rate_s_per_d: float
    multiplier: float | None
    stable: bool


@dataclass(frozen=True)
class Range:
    """What becomes of a swing that turns between `from_deg` and `to_deg` from rest: the cycle of that number, else `verdict`.

    side  of the rest position on which it turns: +1 or -1
    """

    side: int
    from_deg: float
    to_deg: float
    verdict: str
    cycle: int | None


@dataclass(frozen=True)
class Cycle:
    """The limit cycle of a scene, or what there is instead.

    found          True for a stable cycle: the mechanism repeats itself, and comes back to it when disturbed
    verdict        ticks, stops, knocks, trips, overbanks, backwards or unsettled; None where nothing keeps time
    message        a sentence for people; "" where a cycle was found and there is nothing to add
    amplitude_deg  mean of all half swings of the cycle, each half the way between its turning points; period_s, rate_s_per_d
                   against the nominal frequency and beat_error_ms as in `watchsim.beats`. None without a cycle, or for a body
                   that slides (amplitude)
    uneven_ms      the beat error with a sign: positive where half periods that end in a swing upwards are the longer ones
    ..._error      how far off the number may be: the tolerance of the solver, what the search left over, and the scatter from
                   tooth to tooth divided by the root of their number
    multipliers    of the return map: what is left of a small disturbance after one oscillation (of one turn of the wheel where
                   its teeth differ: see `oscillations`). Only that of the amplitude is listed: what else could be disturbed is
                   at rest at the section, and held there
    oscillations   in one return
    amplitudes_deg  of these oscillations one after the other, where the swing repeats itself only after several of them though
                   the teeth are equal, as after period doubling; else ()
    tooth_spread_deg  largest minus smallest amplitude within a turn of the wheel
    cycles, starts  what `all_cycles` found: every cycle (`Orbit`), and which of them swings of what size lead to (`Range`)
    simulated_s    simulated time it took; `cells_s` the search for candidate contacts, s, and `wall_s` everything but start-up
    """

    found: bool
    verdict: str | None
    message: str = ""
    amplitude_deg: float | None = None
    amplitude_deg_error: float | None = None
    period_s: float | None = None
    period_s_error: float | None = None
    rate_s_per_d: float | None = None
    rate_s_per_d_error: float | None = None
    beat_error_ms: float | None = None
    beat_error_ms_error: float | None = None
    uneven_ms: float | None = None
    multipliers: tuple[float, ...] = ()
    multipliers_error: tuple[float, ...] = ()
    oscillations: int = 1
    amplitudes_deg: tuple[float, ...] = ()
    tooth_spread_deg: float | None = None
    cycles: tuple[Orbit, ...] | None = None
    starts: tuple[Range, ...] | None = None
    simulated_s: float = 0.0
    cells_s: float = 0.0
    wall_s: float = 0.0

    def __repr__(self) -> str:
        if not self.found:
            return f"<No limit cycle: {self.verdict}{f'; {self.message}' if self.message else ''}>"
        swing = "" if self.amplitude_deg is None else f"{self.amplitude_deg:.3f}°, "
        rate = "" if self.rate_s_per_d is None else f"{self.rate_s_per_d:.3f} s/d, "
        even = "" if self.beat_error_ms is None else f"beat error {self.beat_error_ms:.3g} ms, "
        return f"<Cycle: {swing}{rate}{even}multiplier {', '.join(f'{value:.4g}' for value in self.multipliers)}>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    def left_after_one(self) -> tuple[float | None, float | None]:
        """The multiplier and its error for one oscillation, the mean of several: as watches with and without alike teeth
        compare."""
        value, error = max(self.multipliers, key=abs, default=None), max(self.multipliers_error, default=None)
        if value is None or self.oscillations == 1:
            return value, error
        one = abs(value) ** (1.0 / self.oscillations)
        return one, error and value and error * one / (abs(value) * self.oscillations)

    def numbers(self) -> dict[str, Any]:
        """What `steady --json` prints."""
        found = {name: list(value) if isinstance(value := getattr(self, name), tuple) else value for name in JSON_NAMES}
        for name in ("cycles", "starts"):
            found[name] = None if found[name] is None else [dataclasses.asdict(one) for one in found[name]]
        return found
