"""Does the watch still tick, and if not, since when and held by what?"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.body_contacts import holding_at_end
from watchsim.analysis.timing.escape_wheel import progress
from watchsim.analysis.timing.rows_at_hand import is_recorded, nominal_period
from watchsim.analysis.timing.teeth import pitch
from watchsim.scene.roles import keeps_time, roles
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.columns import rows_where

HALF_SWINGS = 3  # without any advance of the wheel: the watch stands
SMALLEST_ADVANCE = 0.01  # rad, for a wheel whose pitch is not known
STILL = 0.1  # of the advance that counts: less is trembling
VISIBLE = 1e-4  # rad; an oscillator that moved less for half a period is held


@dataclass(frozen=True, slots=True)
class Standstill:
    """`since`, s, and a sentence for people."""

    since: float
    message: str


def standstill(run: Trajectory, found: Beats) -> Standstill | None:
    """None while the watch ticks, where the run is shorter than three half swings, or where there is no escapement.

    The watch stands if the wheel did not advance (by half of what a beat takes) in the last three half swings; where that was
    not recorded, if the oscillator did not pass its rest position in that time.
    """
    parts = roles(run.scene)
    if parts.oscillator is None or parts.wheel is None or not keeps_time(run.scene):
        return None
    start = run.simulated - HALF_SWINGS * 0.5 * nominal_period(run, parts.oscillator)
    if start <= 0.0:
        return None
    whole = pitch(run.scene, parts.wheel)
    least = SMALLEST_ADVANCE if whole is None else 0.25 * whole
    ends = np.array([start, run.simulated])
    if is_recorded(run, ends).all():
        first, last = progress(run, parts.wheel, ends)
        if last - first >= least:
            return None
        earlier = np.flatnonzero(np.abs(progress(run, parts.wheel, run.t) - last) > STILL * least)
        since = float(run.t[earlier[-1]]) if len(earlier) else float(run.t[0])
    else:
        crossings = rows_where(run.events, lambda part: part["kind"] == EventKind.CROSS)["t"]
        since = float(crossings[-1]) if len(crossings) else 0.0
        if since >= start:
            return None
    return Standstill(
        since, f"the escape wheel has stood still since t = {since:.4g} s" + _circumstances(run, found, parts.oscillator)
    )


def _circumstances(run: Trajectory, found: Beats, oscillator: str) -> str:
    """Where the oscillator is, how far it last swung, and what touches what."""
    words = ""
    if found.angular and is_recorded(run, np.array([run.simulated])).all():
        column = run.slices[oscillator].start
        angle = f"{math.degrees(run.q[-1, column]):.4g}°".replace("-", "−")
        moved = np.flatnonzero(np.abs(run.q[:, column] - run.q[-1, column]) > VISIBLE)
        held_since = float(run.t[moved[-1]]) if len(moved) else 0.0
        if run.simulated - held_since > 0.5 * found.nominal_period:
            words += f"; {oscillator} held at {angle} since t = {held_since:.4g} s"
        else:
            words += f"; {oscillator} swinging, now at {angle}"
    if len(found) and found.angular:
        words += f"; last amplitude {found.amplitude_deg[-1]:.3g}°"
    holding = holding_at_end(run)
    return words + (f"; in contact: {'; '.join(map(str, holding))}" if holding else "; nothing in contact")
