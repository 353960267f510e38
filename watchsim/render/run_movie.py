"""How does a run become a movie?

    movie(run, "beat.mp4", window=(19.4, 19.75), speed=1 / 20)

Any frame can also be drawn alone with `frame`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from watchsim.render.encoder import check_path, encode
from watchsim.render.force_arrows import ForceArrows
from watchsim.render.frame.pose_history import Window, poses, stretch
from watchsim.render.frame.stage import Stage
from watchsim.render.frame.touching_points import ContactMarks
from watchsim.render.gif_colours import shared_palette
from watchsim.render.palette import CONTACT
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]
Pixels = NDArray[np.uint8]

MP4_FPS, GIF_FPS = 60.0, 25.0
MP4_SIZE, GIF_SIZE = (1280, 720), (800, 450)
SIZES = (64, 8192)  # pixels a side
MOST_FRAMES = 1e6
SAMPLES = 12  # frames from which a GIF takes its colours


@dataclass(frozen=True)
class Plan:
    """Which instants become frames: `times` (s) and the rate at which they are shown."""

    times: Array
    fps: float


def movie(
    run: Trajectory,
    path: str | os.PathLike[str],
    window: Sequence[float] | None = None,
    speed: float = 1.0,
    *,
    fps: float | None = None,
    size: tuple[int, int] | None = None,
    contacts: bool = False,
    forces: bool = False,
    zoom: Sequence[str] | None = None,
    turn: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write a run as MP4 or GIF, by the ending of `path`, and return the path.

    window   (from, to) in seconds; default all that was recorded
    speed    seconds of the watch per second of the movie: 1/20 is slow motion
    fps      frames per second; default 60, GIF 25 (a GIF keeps time in hundredths of a second: the nearest rate it can hold)
    size     (width, height) in pixels, rounded up to even numbers; default 1280 × 720, GIF 800 × 450
    contacts marks the contacts that are closed
    forces   draws the forces of the contacts as arrows
    zoom     names of the bodies to frame; default all
    turn     radians by which the picture is turned; default: gravity down, or the quarter turn that fills the frame best
    progress called with (frames done, frames in all)

    ValueError for arguments that make no sense, OSError where the file cannot be written; the file is written whole or not
    at all.
    """
    target = check_path(path)
    gif = target.suffix.lower() == ".gif"
    span = stretch(run, window, unbroken=True)
    plan = _plan(span, speed, fps if fps is not None else (GIF_FPS if gif else MP4_FPS), gif)
    pixels = _even(size if size is not None else (GIF_SIZE if gif else MP4_SIZE))
    arrows = ForceArrows(run, plan.times) if forces else None
    told = None if arrows is None else arrows.meaning
    stage = Stage(run, pixels, span, zoom=zoom, turn=turn, speed=speed, step=speed / plan.fps, arrows=told)
    palette = None
    if gif:
        sampled = np.unique(np.linspace(0, len(plan.times) - 1, SAMPLES).astype(int))
        chosen = None if arrows is None else [arrows.at(k) for k in sampled]
        palette = shared_palette(
            [picture.copy() for picture in _pictures(stage, run, plan.times[sampled], contacts, None, chosen)]
        )
    drawn = None if arrows is None else [arrows.at(k) for k in range(len(plan.times))]
    encode(_pictures(stage, run, plan.times, contacts, progress, drawn), target, pixels, plan.fps, palette)
    return target


def frame(
    run: Trajectory,
    t: float,
    size: tuple[int, int] = MP4_SIZE,
    window: Sequence[float] | None = None,
    *,
    contacts: bool = False,
    zoom: Sequence[str] | None = None,
    turn: float | None = None,
) -> Pixels:
    """The picture (height, width, 3), 8 bits, of the instant `t` (s), framed as in a movie over `window`."""
    span = stretch(run, window)
    if not span[0] <= t <= span[1]:
        raise ValueError(f"t = {t:.9g} s lies outside {span[0]:.9g} s to {span[1]:.9g} s")
    stage = Stage(run, _checked(size), span, zoom=zoom, turn=turn)
    picture = next(_pictures(stage, run, np.array([float(t)]), contacts, None))
    return np.ascontiguousarray(picture[..., :3])


def _plan(span: Window, speed: float, fps: float, gif: bool) -> Plan:
    if not (math.isfinite(speed) and speed > 0.0):
        raise ValueError(f"speed = {speed}: give seconds of the watch per second of the movie, such as 1 or 1/20")
    if not (math.isfinite(fps) and 1.0 <= fps <= 240.0):
        raise ValueError(f"fps = {fps}: give 1 to 240 frames per second")
    if gif:
        fps = 100.0 / max(2, round(100.0 / fps))  # players slow down anything shorter than two hundredths
    if not (span[1] - span[0]) * fps / speed <= MOST_FRAMES:
        raise ValueError(f"speed = {speed:g}: more than {MOST_FRAMES:g} frames; show a shorter window, or show it faster")
    count = math.floor((span[1] - span[0]) * fps / speed + 1e-6) + 1
    return Plan(np.minimum(span[0] + np.arange(count) * (speed / fps), span[1]), fps)


def _checked(size: tuple[int, int]) -> tuple[int, int]:
    try:
        width, height = (int(side) for side in size)
    except (TypeError, ValueError):
        raise ValueError(f"size = {size!r}: give (width, height) in pixels") from None
    if not all(SIZES[0] <= side <= SIZES[1] for side in (width, height)):
        raise ValueError(f"size = {width}x{height}: each side must be {SIZES[0]} to {SIZES[1]} pixels")
    return width, height


def _even(size: tuple[int, int]) -> tuple[int, int]:
    """The colour planes of an MP4 have half the size, so its sides must be even."""
    width, height = _checked(size)
    return width + width % 2, height + height % 2


def _pictures(
    stage: Stage,
    run: Trajectory,
    times: Array,
    contacts: bool,
    progress: Callable[[int, int], None] | None,
    arrows: Sequence[Array] | None = None,
) -> Iterator[Pixels]:
    """One picture after the other, each in the same memory."""
    where = poses(run, times)
    marks = ContactMarks(run) if contacts else None
    for k, t in enumerate(times):
        frames = {name: rows[k] for name, rows in where.items()}
        points = marks.points(float(t), frames) if marks else None
        yield stage.draw(float(t), frames, points, CONTACT, None if arrows is None else arrows[k])
        if progress is not None:
            progress(k + 1, len(times))
