"""How does a mechanism turned by hand become a short movie?"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from watchsim.render.frame.marks.readouts import Clock
from watchsim.render.frame.stage import Stage
from watchsim.render.movies.encoder import check_path, encode
from watchsim.render.movies.gif_colours import shared_palette
from watchsim.render.movies.picture_size import GIF_SIZE, MP4_SIZE
from watchsim.render.movies.run_movie import GIF_FPS
from watchsim.render.picture_style import DARK, LIGHT
from watchsim.simulation.record.body_frames import frames
from watchsim.simulation.record.trajectory import EVENT_DTYPE, Stop, Trajectory
from watchsim.turning.turn import Turn

Array = NDArray[np.float64]
Pixels = NDArray[np.uint8]

FPS = 30.0
LEAP = math.radians(0.6)  # of a pressed body per frame
LED = math.radians(0.35)  # of the led body per frame while others move
AFAR = math.radians(6.0)  # and while nothing else moves


class ByHand(Clock):
    """Where the time stands in the movie of a run."""

    def text(self, t: float, step: float) -> str:
        return "by hand"


def turn_movie(found: Turn, path: str | os.PathLike[str], dark: bool = False) -> Path:
    """Write the last cycle as MP4 or GIF, by the ending of `path`, on light or on dark ground; touches are ringed."""
    target = check_path(path)
    gif = target.suffix.lower() == ".gif"
    size, fps = (GIF_SIZE, GIF_FPS) if gif else (MP4_SIZE, FPS)
    rows, source = _frames(found)
    run = _as_run(found, rows)
    stage = Stage(run, size, (0.0, float(run.t[-1])), clock=ByHand(0.0, 1.0, ""), style=DARK if dark else LIGHT)
    palette = None
    if gif:
        some = np.unique(np.linspace(0, len(rows) - 1, 12).astype(int))
        palette = shared_palette([picture.copy() for picture in _pictures(stage, run, rows[some], source[some], found)])
    encode(_pictures(stage, run, rows, source, found), target, size, fps, palette)
    return target


def _frames(found: Turn) -> tuple[Array, NDArray[np.int64]]:
    """(frames, bodies) coordinates, and of each the row whose touches hold (-1: in between)."""
    q, led = found.cycle.q, found.cycle.led
    out, source = [q[found.first]], [found.first]
    for row in range(found.first + 1, len(q)):
        others = max(
            (abs(q[row, n] - out[-1][n]) for n in range(q.shape[1]) if n != led and not math.isnan(q[row, n])), default=0.0
        )
        went = abs(q[row, led] - out[-1][led])
        leap = max((abs(q[row, n] - q[row - 1, n]) for n in found.cycle.pressed), default=0.0)
        if leap > 2.0 * LEAP:
            count = math.ceil(leap / LEAP)
            for k in range(1, count):
                out.append(q[row - 1] + (q[row] - q[row - 1]) * k / count)
                source.append(-1)
        elif went < (LED if others > 1e-6 else AFAR) and row < len(q) - 1:
            continue
        out.append(q[row])
        source.append(row)
    return np.array(out), np.array(source)


def _as_run(found: Turn, rows: Array) -> Trajectory:
    """The frames as a run of one second each, for those who frame and draw runs."""
    columns = [number for number, body in enumerate(found.scene.bodies) if body.motion != "fixed"]
    slices = {found.names[number]: slice(k, k + 1) for k, number in enumerate(columns)}
    q = rows[:, columns]
    t = np.arange(len(q), dtype=float)
    rest = np.zeros_like(q)
    return Trajectory(found.scene, t, q, rest, rest, slices, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION)


def _pictures(stage: Stage, run: Trajectory, rows: Array, source: NDArray[np.int64], found: Turn) -> Iterator[Pixels]:
    columns = [number for number, body in enumerate(found.scene.bodies) if body.motion != "fixed"]
    where = frames(found.scene, run.slices, rows[:, columns])
    for k in range(len(rows)):
        touches = found.cycle.touches[source[k]] if source[k] >= 0 else ()
        marks = np.array([touch.place for touch in touches]).reshape(-1, 2)
        yield stage.draw(float(k), {name: poses[k] for name, poses in where.items()}, marks)
