"""What were amplitude, rate and beat error over the whole run, from its first beat to its last?

From sums made as the run went, so that nothing of it need have been kept.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from watchsim.analysis.timing.beats import DAY, HEARD, Beats
from watchsim.simulation.record.trajectory import Trajectory

Moments = Mapping[str, float]


def whole_run(run: Trajectory, found: Beats) -> dict[str, Any] | None:
    """`beats`; `amplitude_deg` and `period_s`, each {mean, spread, least, largest}, spread being the standard deviation;
    `rate_s_per_d` of the mean period; `beat_error_ms` of the mean difference. Null where unknown; None without beats.
    """
    sums = run.sums
    if not sums.get("half_swings"):
        return None
    period = sums["period"]
    heard = sums["ticks"] >= HEARD * sums["half_swings"]
    uneven = sums["uneven_ticks" if heard else "uneven_passages"]
    return {
        "beats": sums["half_swings"],
        "amplitude_deg": _told(sums["amplitude"], math.degrees(1.0)) if found.angular else None,
        "period_s": _told(period, 1.0),
        "rate_s_per_d": DAY * (found.nominal_period / period["mean"] - 1.0) if period else None,
        "beat_error_ms": 500.0 * abs(uneven["mean"]) if uneven else None,
    }


def _told(moments: Moments | None, factor: float) -> dict[str, float] | None:
    if moments is None:
        return None
    spread = math.sqrt(moments["squares"] / max(moments["number"] - 1.0, 1.0))
    values = {"mean": moments["mean"], "spread": spread, "least": moments["least"], "largest": moments["largest"]}
    return {name: factor * value for name, value in values.items()}
