"""How are beats and phases written for other programs?"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timeline.rows import Stages, can_be_told, stages
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
    numbers = range(found.before + 1, found.before + 1 + len(found.t))
    return _text(header, zip(numbers, *map(_cells, columns), strict=True))


def phases_csv(run: Trajectory, found: Beats) -> Iterator[str]:
    """One row per phase: beat (as in beats.csv), name, start, duration, for wheel, lever and balance the angle at its start and
    the turn during it, on what an impulse acts, which stone is unlocked in the beat, angular velocities, the angular impulse of
    all contacts on the oscillator, and where the energy went (see analysis/timeline/rows.py).

    Energies and impulse are empty for a run by fixed steps, whose contacts have no smooth forces.
    """
    known = can_be_told(run)
    return _text(PHASE_COLUMNS, (row for part in stages(run, found) for row in _phase_rows(part, known)))


def _phase_rows(part: Stages, known: bool) -> Iterator[Sequence[object]]:
    phases = part.phases
    starts, ends = (np.array([getattr(row, name) for row in phases]) for name in ("start", "end"))
    turned, rates = (
        np.degrees(np.stack(pair, axis=2)).reshape(len(phases), -1)  # of each body one beside the other
        for pair in (
            (np.array([row.angles for row in phases]), np.array([row.turns for row in phases])),
            (part.start_rates, part.end_rates),
        )
    )
    energies = [part.impulse, part.supplied, part.stored, part.to_balance, part.damping, part.friction]
    energies.append(np.array([sum(one.values()) for one in part.impacts]))
    columns = [
        *([row.beat for row in phases], [row.name for row in phases], starts, 1e3 * (ends - starts), *turned.T),
        *([row.on for row in phases], part.pallets, *rates.T),
        *(energies if known else [np.full(len(phases), math.nan)] * len(energies)),
    ]
    return zip(*(_cells(one) if isinstance(one, np.ndarray) else one for one in columns), strict=True)


def _cells(column: NDArray[np.float64]) -> list[object]:
    """The numbers; "" for what is not finite."""
    values = column.tolist()
    return values if np.isfinite(column).all() else [x if math.isfinite(x) else "" for x in values]


def _text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterator[str]:
    """Some thousand rows at a time: of a long run there are hundreds of thousands."""
    lines = chain([header], rows)
    while some := list(islice(lines, ROWS_AT_ONCE)):
        out = io.StringIO()
        csv.writer(out, lineterminator="\n").writerows(some)
        yield out.getvalue()
