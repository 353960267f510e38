"""Which phases of which beats pass while a window is shown, where it shows so few that they can be seen?"""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby

from watchsim.analysis.timing.beats import beats, beats_within
from watchsim.analysis.timing.phases import Phase, phases
from watchsim.render.frame.pose_history import Window
from watchsim.scene.roles import keeps_time, roles
from watchsim.simulation.record.trajectory import Trajectory

MOST = 12  # beats; of more the phases would be hairlines


def passing(run: Trajectory, window: Window) -> list[list[Phase]]:
    """The phases of each beat that is in sight, cut to the window; none where there is no escapement, or too much is shown."""
    found = roles(run.scene)
    if found.wheel is None or found.lever is None or not keeps_time(run.scene):
        return []
    near = beats_within(beats(run), window)
    if not 0 < len(near) <= MOST + 2:
        return []
    start, end = window
    cut = (
        replace(one, start=max(one.start, start), end=min(one.end, end))
        for one in phases(run, near)
        if one.end > start and one.start < end
    )
    return [list(own) for _, own in groupby(cut, key=lambda one: one.beat)]
