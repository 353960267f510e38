"""Which plots and movies come with a run, and what if one of them cannot be drawn?"""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.commands.console import Progress, say

if TYPE_CHECKING:
    from watchsim.simulation.trajectory import Trajectory

WHOLE_RUN = 10.0  # s that the movie of a whole run takes


def pictures(run: Trajectory, plots: bool, movie: bool, gif: bool) -> dict[str, Callable[[Path], object]]:
    """Name in the results folder -> what draws it into the file it is given."""
    found = _plots(run) if plots else {}
    if movie:
        found["movie.mp4"] = lambda path: _movie(run, path, slow=1 / 20)
    if gif:
        found["movie.gif"] = lambda path: _movie(run, path, slow=1 / 40)
    return {name: _drawn(draw) for name, draw in found.items()}


def _drawn(draw: Callable[[Path], object]) -> Callable[[Path], None]:
    """The same, but a picture that cannot be drawn costs a line, not the run."""

    def attempt(path: Path) -> None:
        try:
            draw(path)
        except Exception as error:
            path.unlink(missing_ok=True)
            say(f"{path.name} could not be drawn: {error}")

    return attempt


def _plots(run: Trajectory) -> dict[str, Callable[[Path], object]]:
    """Kinematic plots: all that was recorded, and the last beats."""
    from watchsim.render.plots import Kinematics, write_png

    if len(run.t) < 2:
        return {}
    windows = {"plots/kinematics.png": None, "plots/last_beats.png": last_beats(run)}
    shown = functools.cache(lambda: Kinematics(run))

    def plot(window: tuple[float, float] | None) -> Any:
        return lambda path: write_png(shown().show(window), path)

    return {name: plot(window) for name, window in windows.items()}


def last_beats(run: Trajectory, share: float = 1.5) -> tuple[float, float]:
    """The last one and a half oscillations, or the last tenth where nothing keeps time, of the last stretch recorded."""
    from watchsim.mechanism.oscillation import frequency
    from watchsim.mechanism.roles import keeps_time
    from watchsim.render.poses import recorded

    start, end = recorded(run)[-1]
    hertz = frequency(run.scene) if keeps_time(run.scene) else None
    length = share / hertz if hertz else 0.1 * (end - start)
    return max(start, end - length), end


def filmed(run: Trajectory, slow: float) -> tuple[tuple[float, float], float]:
    """What a movie shows, and how fast: the last oscillation at the speed `slow`; where nothing keeps time, all of it.

    All means the last stretch that was recorded without a gap, in WHOLE_RUN seconds.
    """
    from watchsim.mechanism.roles import keeps_time
    from watchsim.render.poses import recorded

    if keeps_time(run.scene):
        return last_beats(run, 1.1), slow
    start, end = recorded(run)[-1]
    return (start, end), (end - start) / WHOLE_RUN


def _movie(run: Trajectory, path: Path, slow: float) -> None:
    from watchsim.render.movie import movie

    window, speed = filmed(run, slow)
    progress = Progress(f"{path.name}, frames:")
    try:
        movie(run, path, window=window, speed=speed, progress=progress)
    finally:
        progress.close()
