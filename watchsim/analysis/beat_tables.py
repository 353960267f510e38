"""How are beats and phases written for other programs?"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice

import numpy as np

from watchsim.analysis.timeline.rows import Stage, can_be_told, each_stage
from watchsim.analysis.timing.beats import Beats
from watchsim.simulation.record.trajectory import Trajectory

BEAT_COLUMNS = ("beat", "t_s", "tick_s", "turn_s", "turn_at", "amplitude", "period_s", "rate_s_per_d", "beat_error_ms")
PARTS = ("wheel", "lever", "balance")
ROWS_AT_ONCE = 1 << 12
PHASE_COLUMNS = (
    *("beat", "phase", "t_s", "duration_ms"),
    *(f"{part}_{what}_deg" for part in PARTS for what in ("angle", "turn")),
    *("on", "stone"),
    *(f"{part}_{what}_deg_per_s" for part in PARTS for what in ("start_rate", "end_rate")),
    *("impulse_on_balance_N_m_s", "supplied_J", "stored_J", "to_balance_J", "damping_J", "friction_J", "impacts_J"),
)


def beats_csv(found: Beats) -> Iterator[str]:
    """One row per half swing: passage, tick, the turning point after it (time and place), amplitude, period, rate, beat error.

    In pieces of some thousand rows. Angles in degrees (turn_at_deg, amplitude_deg), of a sliding body metres (turn_at_m,
    amplitude_m); empty where unknown.
    """
    unit = "deg" if found.angular else "m"
    header = [f"{name}_{unit}" if name in ("turn_at", "amplitude") else name for name in BEAT_COLUMNS]
    scale = math.degrees(1.0) if found.angular else 1.0
    turn, amplitude = scale * found.end_at, scale * found.amplitude
    columns = (found.t, found.tick, found.end, turn, amplitude, found.period_s, found.rate_s_per_d, found.beat_error_ms)
    return _text(header, ([found.before + i + 1, *row] for i, row in enumerate(np.column_stack(columns).tolist())))


def phases_csv(run: Trajectory, found: Beats) -> Iterator[str]:
    """One row per phase: beat (as in beats.csv), name, start, duration, for wheel, lever and balance the angle at its start and
    the turn during it, on what an impulse acts, which stone is unlocked in the beat, angular velocities, the angular impulse of
    all contacts on the oscillator, and where the energy went (see analysis/timeline/rows.py).

    Energies and impulse are empty for a run by fixed steps, whose contacts have no smooth forces.
    """
    known = can_be_told(run)
    return _text(PHASE_COLUMNS, (_phase_row(stage, known) for stage in each_stage(run, found)))


def _phase_row(stage: Stage, known: bool) -> list[object]:
    phase, e = stage.phase, stage.energy
    turned = [math.degrees(x) for pair in zip(phase.angles, phase.turns, strict=True) for x in pair]
    rates = [math.degrees(x) for pair in zip(stage.start_rates, stage.end_rates, strict=True) for x in pair]
    energies = [stage.impulse, e.supplied, e.stored, e.to_balance, e.damping, e.friction, sum(e.impacts.values())]
    times = [phase.start, 1e3 * (phase.end - phase.start)]
    return [phase.beat, phase.name, *times, *turned, phase.on, stage.pallet, *rates, *(energies if known else [math.nan] * 7)]


def _text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterator[str]:
    """Some thousand rows at a time: of a long run there are hundreds of thousands."""
    told = (["" if isinstance(x, float) and not math.isfinite(x) else x for x in row] for row in rows)
    lines = chain([header], told)
    while some := list(islice(lines, ROWS_AT_ONCE)):
        out = io.StringIO()
        csv.writer(out, lineterminator="\n").writerows(some)
        yield out.getvalue()
