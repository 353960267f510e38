"""How are beats and phases written for other programs?"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timeline.rows import Stages, Staging, can_be_told
from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.phases import stretches, with_angles
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
    yield _row(header)
    for first in range(0, len(found), ROWS_AT_ONCE):
        some = [_cells(column[first : first + ROWS_AT_ONCE]) for column in columns]
        numbers = range(found.before + 1 + first, found.before + 1 + first + len(some[0]))
        yield _lines([list(map(str, numbers)), *some])


def phases_csv(run: Trajectory, found: Beats) -> Iterator[str]:
    """One row per phase: beat (as in beats.csv), name, start, duration, for wheel, lever and balance the angle at its start and
    the turn during it, on what an impulse acts, which stone is unlocked in the beat, angular velocities, the angular impulse of
    all contacts on the oscillator, and where the energy went (see analysis/timeline/rows.py).

    Energies and impulse are empty for a run by fixed steps, whose contacts have no smooth forces.
    """
    yield _row(PHASE_COLUMNS)
    staging, known = Staging(run), can_be_told(run)
    for part in stretches(run, found):
        some = with_angles(run, part)
        yield _lines(_phase_columns(staging.of(some), known)) if len(some) else ""


def _phase_columns(part: Stages, known: bool) -> list[list[str]]:
    phases, count = part.phases, len(part.phases)
    rows = phases.rows
    turned, rates = (
        np.degrees(np.stack(pair, axis=2)).reshape(count, -1)  # of each body one beside the other
        for pair in ((phases.angles, phases.turns), (part.start_rates, part.end_rates))
    )
    energies = [part.impulse, part.supplied, part.stored, part.to_balance, part.damping, part.friction, part.impacts.whole]
    if not known:
        energies = [np.full(count, math.nan)] * len(energies)
    numbers = (_cells(one) for one in (rows.start, 1e3 * (rows.end - rows.start), *turned.T))
    beats = list(map(str, rows.beat.tolist()))
    return [beats, rows.names, *numbers, rows.faces, part.pallets, *map(_cells, rates.T), *map(_cells, energies)]


def _cells(column: NDArray[np.float64]) -> list[str]:
    """The numbers, such that they read back as the same; nothing for what is not finite."""
    told = list(map(repr, column.tolist()))
    for k in np.flatnonzero(~np.isfinite(column)).tolist():
        told[k] = ""
    return told


def _row(fields: Sequence[str]) -> str:
    """One line; no name in these tables needs quotes."""
    return ",".join(fields) + "\n"


def _lines(columns: Sequence[Sequence[str]]) -> str:
    return "".join(map(_row, zip(*columns, strict=True)))
