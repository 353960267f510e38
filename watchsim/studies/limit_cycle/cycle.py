"""What is known about a limit cycle?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from watchsim.displays import notebook_html

JSON_NAMES = (
    *("found", "verdict", "message", "amplitude_deg", "amplitude_deg_error", "period_s", "period_s_error"),
    *(
        "rate_s_per_d",
        "rate_s_per_d_error",
        "beat_error_ms",
        "beat_error_ms_error",
        "uneven_ms",
        "multipliers",
        "multipliers_error",
    ),
    *("oscillations", "tooth_spread_deg", "simulated_s", "cells_s", "wall_s"),
)


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
    tooth_spread_deg  largest minus smallest amplitude within a turn of the wheel
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
    tooth_spread_deg: float | None = None
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

    def numbers(self) -> dict[str, Any]:
        """What `steady --json` prints."""
        return {name: list(value) if isinstance(value := getattr(self, name), tuple) else value for name in JSON_NAMES}
