"""How are beats and phases written for other programs?"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence

import numpy as np

from watchsim.analysis.beats import Beats
from watchsim.analysis.phases import Phase, each_phase
from watchsim.simulation.trajectory import Trajectory

BEAT_COLUMNS = ("beat", "t_s", "tick_s", "turn_s", "turn_at", "amplitude", "period_s", "rate_s_per_d", "beat_error_ms")
PARTS = ("wheel", "lever", "balance")
PHASE_COLUMNS = (
    *("beat", "phase", "t_s", "duration_ms"),
    *(f"{part}_{what}_deg" for part in PARTS for what in ("angle", "turn")),
)


def beats_csv(found: Beats) -> str:
    """One row per half swing: passage, tick, the turning point after it (time and place), amplitude, period, rate, beat error.

    Angles in degrees (turn_at_deg, amplitude_deg), of a sliding body metres (turn_at_m, amplitude_m); empty where unknown.
    """
    unit = "deg" if found.angular else "m"
    header = [f"{name}_{unit}" if name in ("turn_at", "amplitude") else name for name in BEAT_COLUMNS]
    scale = math.degrees(1.0) if found.angular else 1.0
    turn, amplitude = scale * found.end_at, scale * found.amplitude
    columns = (found.t, found.tick, found.end, turn, amplitude, found.period_s, found.rate_s_per_d, found.beat_error_ms)
    return _text(header, ([found.before + i + 1, *row] for i, row in enumerate(np.column_stack(columns).tolist())))


def phases_csv(run: Trajectory, found: Beats) -> str:
    """One row per phase: beat (as in beats.csv), name, start, duration, and for wheel, lever and balance the angle at its start
    and the turn during it."""
    return _text(PHASE_COLUMNS, (_phase_row(phase) for phase in each_phase(run, found)))


def _phase_row(phase: Phase) -> list[object]:
    turned = [math.degrees(x) for pair in zip(phase.angles, phase.turns, strict=True) for x in pair]
    return [phase.beat, phase.name, phase.start, 1e3 * (phase.end - phase.start), *turned]


def _text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(header)
    table.writerows(["" if isinstance(x, float) and not math.isfinite(x) else x for x in row] for row in rows)
    return out.getvalue()
