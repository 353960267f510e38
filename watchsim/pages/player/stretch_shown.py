"""Which stretch of a run does its page play?"""

from __future__ import annotations

from collections.abc import Sequence

from watchsim.render.frame.pose_history import Window, recorded, stretch
from watchsim.scene.oscillation import frequency
from watchsim.scene.roles import keeps_time
from watchsim.simulation.record.trajectory import Trajectory

BEATS = 10
WHOLE = 0.95  # of what was recorded: nearly all of it is shown as all of it


def shown(run: Trajectory, window: Sequence[float] | None) -> Window:
    """As asked; by default the last ten beats, or all of the last unbroken stretch where nothing keeps time.

    ValueError where the window is empty or was not recorded.
    """
    if window is not None:
        return stretch(run, window)
    start, end = recorded(run)[-1]
    hertz = frequency(run.scene) if keeps_time(run.scene) else None
    beats = 0.5 * BEATS / hertz if hertz else 0.0
    if 0.0 < beats < WHOLE * (end - start):
        start = end - beats
    return stretch(run, (start, end)) if start < end else stretch(run, None)
