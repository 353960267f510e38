"""Which stretch of a run does a plot show that needs no more than one cycle?"""

from __future__ import annotations

from watchsim.render.figures.passing_phases import passing
from watchsim.render.frame.pose_history import Window, recorded
from watchsim.scene.oscillation import frequency
from watchsim.scene.roles import keeps_time
from watchsim.simulation.record.trajectory import Trajectory

SEARCHED = 3.1  # oscillations from the end: two whole beats lie in them
LONGER = 1.02  # so that the curve closes


def one_cycle(run: Trajectory) -> Window:
    """The last two beats of an escapement that are whole; else the last oscillation, or all of the last stretch recorded, s.

    ValueError where nothing was recorded.
    """
    start, end = recorded(run)[-1]
    if not end > start:
        raise ValueError(f"nothing to draw: the run holds only the instant {start:.9g} s")
    hertz = frequency(run.scene) if keeps_time(run.scene) else None
    if not hertz:
        return start, end
    told = passing(run, (max(start, end - SEARCHED / hertz), end))
    whole = [beat for beat in told if beat[0].name == "unlock" and beat[-1].name == "locked"][-2:]
    if len(whole) == 2:
        return whole[0][0].start, whole[1][-1].end
    return max(start, end - LONGER / hertz), end
