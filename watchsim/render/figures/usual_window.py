"""Which stretch of a run does a plot show that needs no more than one cycle?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from watchsim.analysis.timeline.shown_beats import BEGINNING, RESTING
from watchsim.analysis.timing.phases import Phase
from watchsim.render.figures.passing_phases import passing
from watchsim.render.frame.pose_history import Window, recorded, stretch
from watchsim.scene.oscillation import frequency
from watchsim.scene.roles import keeps_time
from watchsim.simulation.record.trajectory import Trajectory

SEARCHED = 3.1  # oscillations from the end: two whole beats lie in them
LONGER = 1.02  # so that the curve closes


@dataclass(frozen=True)
class Shown:
    """A stretch of time (s), and the phases of the beats of an escapement in it, a list for each beat."""

    window: Window
    phases: list[list[Phase]]


def one_cycle(run: Trajectory) -> Shown:
    """The last two beats of an escapement that are whole; else the last oscillation, or all of the last stretch recorded.

    ValueError where nothing was recorded.
    """
    start, end = recorded(run)[-1]
    if not end > start:
        raise ValueError(f"nothing to draw: the run holds only the instant {start:.9g} s")
    hertz = frequency(run.scene) if keeps_time(run.scene) else None
    if not hertz:
        return Shown((start, end), [])
    told = passing(run, (max(start, end - SEARCHED / hertz), end))
    whole = [beat for beat in told if beat[0].name in BEGINNING and beat[-1].name in RESTING][-2:]
    if len(whole) == 2:
        return Shown((whole[0][0].start, whole[1][-1].end), whole)
    return Shown((max(start, end - LONGER / hertz), end), told)


def shown(run: Trajectory, window: Sequence[float] | None) -> Shown:
    """The window as asked (s), or one cycle; ValueError where it was not recorded."""
    if window is None:
        return one_cycle(run)
    span = stretch(run, window)
    return Shown(span, passing(run, span))
