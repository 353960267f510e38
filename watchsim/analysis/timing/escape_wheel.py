"""How far did the escape wheel go, and did it miss a beat?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.rows_at_hand import is_recorded
from watchsim.analysis.timing.teeth import pitch
from watchsim.scene.roles import drive_direction
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.storage.columns import blocks


@dataclass(frozen=True)
class Advance:
    """The wheel at recorded turning points: half swings since the run's first turning point, and how far it has come (rad)."""

    half_pitch: float
    half_swings: Array
    angle: Array

    @property
    def steps(self) -> Array:
        """Half pitches from each of these turning points to the next."""
        return np.diff(self.angle) / self.half_pitch


def progress(run: Trajectory, wheel: str, times: Array) -> Array:
    """Angle (rad) the wheel has turned since the start of the run in the sense of its drive, at recorded times (s)."""
    column = run.slices[wheel].start
    angles = [run.positions(part, [column])[:, 0] for (part,) in blocks(times)]
    return drive_direction(run.scene, wheel) * (np.concatenate(angles or [np.zeros(0)]) - run.scene.body(wheel).angle)


def advance(run: Trajectory, wheel: str, found: Beats) -> Advance | None:
    """The wheel's progress at all recorded turning points; None for a wheel without equal teeth or with none recorded."""
    whole = pitch(run.scene, wheel)
    if whole is None or len(found) == 0:
        return None
    times, half_swings = np.append(found.start[:1], found.end), found.before + np.arange(len(found) + 1.0)
    kept = is_recorded(run, times)
    if not kept.any():
        return None
    return Advance(0.5 * whole, half_swings[kept], progress(run, wheel, times[kept]))


def missed_beats(run: Trajectory, wheel: str, found: Beats) -> int | None:
    """Half swings in which the wheel did not advance by half a pitch, or half pitches it went too far; None where not known.

    Where it goes on by a whole pitch in every other half swing, as with a detent, whole pitches are counted. Between recorded
    windows, and from the start to the first of them, half swings and half pitches are only counted. There the first half swing
    is given the benefit of the doubt: the wheel may start on either side of it.
    """
    moved = advance(run, wheel, found)
    if moved is None:
        return None
    only = _giving(moved)
    one = 1.0 if only is None else 2.0  # half pitches
    due = np.diff(moved.half_swings) if only is None else 2.0 * np.diff(_of_parity(moved.half_swings, only))
    missed = float(np.abs(np.rint(moved.steps) - due).sum()) / one
    if moved.half_swings[0] > 0:
        before = abs(np.rint(moved.angle[0] / moved.half_pitch) - (moved.half_swings[0] + 1.0))
        missed += max(0.0, before - one) / one
    return int(missed)


def _giving(moved: Advance) -> int | None:
    """0 or 1: only the half swings of that parity give the wheel a step, of a whole pitch; None where all of them do."""
    single = np.diff(moved.half_swings) == 1.0
    steps, parity = np.rint(moved.steps[single]), moved.half_swings[:-1][single] % 2.0
    usual = [np.median(steps[parity == k]) if (parity == k).any() else np.nan for k in (0.0, 1.0)]
    return usual.index(2.0) if sorted(usual) == [0.0, 2.0] else None


def _of_parity(half_swings: Array, parity: int) -> Array:
    """How many half swings of that parity there were before each of these."""
    return np.floor((half_swings + (1.0 - parity)) / 2.0)
