"""When in a film does each blow of a run sound?

At the moment its instant is on the screen, whatever the speed: in slow motion blows are heard further apart, at adaptive speed
as the pictures go. A blow itself is not stretched; it keeps its pitch and dies away as it does in the watch.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from watchsim.analysis.sound.score import Score
from watchsim.analysis.sound.wav import write_score
from watchsim.analysis.timing.timegrapher import noises
from watchsim.render.movies.pace import Plan
from watchsim.simulation.record.trajectory import Trajectory


def soundtrack(run: Trajectory, plan: Plan) -> Score:
    """The blows within a plan, in seconds of the film. ValueError where there are none."""
    times, energies = noises(run)
    heard = (energies > 0.0) & (times >= plan.times[0]) & (times <= plan.times[-1])
    if not heard.any():
        raise ValueError("sound: nothing sounds between the first and the last picture, or no impacts were kept")
    shown = np.arange(len(plan.times)) / plan.fps
    return Score(np.interp(times[heard], plan.times, shown), energies[heard], len(plan.times) / plan.fps, None)


def write_soundtrack(place: Path, heard: Score) -> None:
    """Write it as WAV, as long as the film."""
    write_score(place, heard, heard.known)
