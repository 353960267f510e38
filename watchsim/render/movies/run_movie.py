"""How does a run become a movie?

    movie(run, "beat.mp4", window=(19.4, 19.75), speed=1 / 20)

Any frame can also be drawn alone with `frame`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.phases import phases as named_phases
from watchsim.render.frame.marks.extras import Extras
from watchsim.render.frame.marks.force_arrows import ForceArrows
from watchsim.render.frame.marks.strip import strip_body
from watchsim.render.frame.marks.touching_points import ContactMarks
from watchsim.render.frame.pose_history import Window, stretch
from watchsim.render.frame.stage import Stage
from watchsim.render.movies.busy_stretches import busy
from watchsim.render.movies.encoder import check_path, encode
from watchsim.render.movies.film import Film
from watchsim.render.movies.gif_colours import Palette, shared_palette
from watchsim.render.movies.pace import Plan, adaptive, even
from watchsim.render.movies.picture_size import AUTO, GIF_SIZE, MP4_SIZE, checked, even_sides, fitting
from watchsim.render.movies.soundtrack import soundtrack, write_soundtrack
from watchsim.render.picture_style import DARK, LIGHT
from watchsim.simulation.record.trajectory import Trajectory

Pixels = NDArray[np.uint8]

ADAPTIVE = "adaptive"  # a speed

MP4_FPS, GIF_FPS = 60.0, 25.0
LENGTH = 10.0  # s: a movie at adaptive speed
SAMPLES = 12  # frames from which a GIF takes its colours


def movie(  # noqa: PLR0913 - options, by name
    run: Trajectory,
    path: str | os.PathLike[str],
    window: Sequence[float] | None = None,
    speed: float | str = 1.0,
    *,
    length: float | None = None,
    fps: float | None = None,
    size: tuple[int, int] | str | None = None,
    contacts: bool = False,
    zoom: Sequence[str] | None = None,
    turn: float | None = None,
    insets: Sequence[str] = (),
    strip: str | bool = False,
    phases: bool = False,
    forces: bool = False,
    sound: bool = False,
    dark: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write a run as MP4 or GIF, by the ending of `path`, and return the path.

    window    (from, to) in seconds; default all that was recorded
    speed     seconds of the watch per second of the movie: 1/20 is slow motion; "adaptive": slow where things happen,
              with the speed written in each frame
    length    seconds that a movie at adaptive speed lasts; default 10
    fps       frames per second; default 60, GIF 25 (a GIF keeps time in hundredths of a second: the nearest rate it can hold)
    size      (width, height) in pixels, rounded up to even numbers; default 1280 × 720, GIF 800 × 450; "auto": the
              mechanism the way up that it is drawn, in the wide, square or tall format that shows it largest
    contacts  rings around the contacts that are closed
    zoom      names of the bodies to frame; default all
    turn      radians by which the picture is turned; default: gravity down, or the quarter turn that fills the frame best
    insets    places to enlarge: "lever", "lever.STONES", "lever.STONES.2" (its second outline), "entry stone", "exit stone",
              or a rectangle of the movement in mm, "-1.4, 1.9 : -0.8, 2.5"
    strip     the body whose angle and velocity run below the mechanism; True: the oscillator
    phases    names the phase of a beat
    forces    arrows for the forces at contacts, of a run by events
    sound     the ticking: each blow when its instant is shown, at slow and adaptive speed, too, with its own pitch
    dark      on dark ground
    progress  called with (frames done, frames in all)

    ValueError for arguments that make no sense, OSError where the file cannot be written; the file is written whole or not
    at all.
    """
    target = check_path(path)
    gif = target.suffix.lower() == ".gif"
    span = stretch(run, window, unbroken=True)
    plan = _plan(run, span, speed, length, fps if fps is not None else (GIF_FPS if gif else MP4_FPS), gif)
    if sound and gif:
        raise ValueError("sound: a GIF holds none; choose a name that ends in .mp4")
    heard = soundtrack(run, plan) if sound else None
    arrows = ForceArrows(run, plan.times) if forces else None
    extras = _extras(run, insets, strip, phases, arrows)
    pixels, turn = _size(run, span, extras, size, zoom, turn, gif)
    told, step = (None if speed == ADAPTIVE else float(speed)), float(plan.speeds.min()) / plan.fps
    style = DARK if dark else LIGHT
    stage = Stage(run, pixels, span, zoom=zoom, turn=turn, speed=told, step=step, extras=extras, style=style)
    film = Film(stage, run, plan, ContactMarks(run) if contacts else None, arrows, speed == ADAPTIVE)
    palette = _palette(film, plan, style.phases.values() if phases else ()) if gif else None
    write = None if heard is None else partial(write_soundtrack, heard=heard)
    encode(film.pictures(np.arange(len(plan.times)), progress), target, pixels, plan.fps, palette, write)
    return target


def frame(  # noqa: PLR0913 - options, by name
    run: Trajectory,
    t: float,
    size: tuple[int, int] | str = MP4_SIZE,
    window: Sequence[float] | None = None,
    *,
    contacts: bool = False,
    zoom: Sequence[str] | None = None,
    turn: float | None = None,
    insets: Sequence[str] = (),
    strip: str | bool = False,
    phases: bool = False,
    forces: bool = False,
    dark: bool = False,
) -> Pixels:
    """The picture (height, width, 3), 8 bits, of the instant `t` (s), framed as in a movie over `window`.

    Arrows for `forces` have the scale of this instant.
    """
    span = stretch(run, window)
    if not span[0] <= t <= span[1]:
        raise ValueError(f"t = {t:.9g} s lies outside {span[0]:.9g} s to {span[1]:.9g} s")
    plan = Plan(np.array([float(t)]), np.ones(1), 1.0)
    arrows = ForceArrows(run, plan.times) if forces else None
    extras = _extras(run, insets, strip, phases, arrows)
    pixels, turn = _size(run, span, extras, size, zoom, turn, False) if isinstance(size, str) else (checked(size), turn)
    stage = Stage(run, pixels, span, zoom=zoom, turn=turn, extras=extras, style=DARK if dark else LIGHT)
    marks = ContactMarks(run) if contacts else None
    picture = next(Film(stage, run, plan, marks, arrows, False).pictures(np.zeros(1, int)))
    return np.ascontiguousarray(picture[..., :3])


def _plan(run: Trajectory, span: Window, speed: float | str, length: float | None, fps: float, gif: bool) -> Plan:
    if not (math.isfinite(fps) and 1.0 <= fps <= 240.0):
        raise ValueError(f"fps = {fps}: give 1 to 240 frames per second")
    if gif:
        fps = 100.0 / max(2, round(100.0 / fps))  # players slow down anything shorter than two hundredths
    if speed == ADAPTIVE:
        return adaptive(span, busy(run, named_phases(run), span), LENGTH if length is None else length, fps)
    if isinstance(speed, str):
        raise ValueError(f'speed = "{speed}": give a number, or "{ADAPTIVE}"')
    if length is not None:
        raise ValueError(f'length = {length:g}: only a movie at speed = "{ADAPTIVE}" has a length of its own')
    return even(span, speed, fps)


def _size(
    run: Trajectory,
    span: Window,
    extras: Extras,
    size: tuple[int, int] | str | None,
    zoom: Sequence[str] | None,
    turn: float | None,
    gif: bool,
) -> tuple[tuple[int, int], float | None]:
    """Width and height of the pictures, and how they are turned."""
    if size == AUTO:
        found, way_up = fitting(run, span, extras, zoom, gif, turn)
        return found, way_up
    if isinstance(size, str):
        raise ValueError(f'size = "{size}": give (width, height) in pixels, or "{AUTO}"')
    return even_sides(size if size is not None else (GIF_SIZE if gif else MP4_SIZE)), turn


def _palette(film: Film, plan: Plan, named: Iterable[str]) -> Palette:
    """The colours of some frames, and these `named` ones exactly."""
    sampled = np.unique(np.linspace(0, len(plan.times) - 1, SAMPLES).astype(int))
    return shared_palette([picture.copy() for picture in film.pictures(sampled)], named)


def _extras(run: Trajectory, insets: Sequence[str], strip: str | bool, phases: bool, arrows: ForceArrows | None) -> Extras:
    places = (insets,) if isinstance(insets, str) else tuple(insets)
    body = None if strip is False else strip_body(run, None if strip is True else strip)
    force, scale = (arrows.largest, arrows.round_force) if arrows else (0.0, 0.0)
    return Extras(places, body, tuple(named_phases(run)) if phases else (), force, scale)
