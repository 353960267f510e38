"""How does a run, or a mechanism turned by hand, become a movie?

movie(run, "beat.mp4", window=(19.4, 19.75), speed=1 / 20)

At an even speed, or adaptive: the stretches in which things happen get most of the film, the others are hurried through, and
between the two the speed changes smoothly. Each blow sounds when its instant is on the screen; it keeps its pitch and dies away
as it does in the watch. Any frame can also be drawn alone with `frame`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.phases import Phase
from watchsim.analysis.phases import phases as named_phases
from watchsim.analysis.sound import Score, blows, write_score
from watchsim.escapement.turn import Turn
from watchsim.render.encoder import (
    AUTO,
    GIF_SIZE,
    MP4_SIZE,
    Palette,
    check_path,
    checked,
    encode,
    even_sides,
    fitting,
    shared_palette,
)
from watchsim.render.insets import strip_body
from watchsim.render.marks import Clock, ContactMarks, ForceArrows
from watchsim.render.palette import DARK, LIGHT
from watchsim.render.part_names import part_names
from watchsim.render.stage import Extras, Stage
from watchsim.render.view import Pixels, Window, poses, stretch
from watchsim.simulation.state import EVENT_DTYPE, EventKind, Stop
from watchsim.simulation.trajectory import Array, Trajectory, frames
from watchsim.storage.columns import rows_where

LIVELY = (EventKind.IMPACT, EventKind.CLOSE, EventKind.OPEN, EventKind.JAM, EventKind.ACCUMULATION)  # slow where these happen
AROUND = 0.004  # of the window: what is slow around an event where no phases are known
MERGED = 2.0  # times that: quiet stretches so short are not worth a hurry


def busy(run: Trajectory, found: list[Phase], window: Window) -> list[Window]:
    """Stretches in which things happen: from unlocking to the banking where phases are known, else around every event."""
    lively = [(one.start, one.end) for one in found if one.name != "locked" and one.end > window[0] and one.start < window[1]]
    if lively:
        longest = max(end - start for start, end in lively)
        spans = np.array([(start - 0.1 * longest, end + 0.1 * longest) for start, end in lively])
        return _merged(spans, longest, window)
    events = rows_where(
        run.events, lambda part: np.isin(part["kind"], LIVELY) & (part["t"] >= window[0]) & (part["t"] <= window[1])
    )
    times = np.unique(events["t"])
    around = AROUND * (window[1] - window[0])
    return _merged(np.column_stack((times - around, times + around)), MERGED * around, window)


def _merged(spans: Array, gap: float, window: Window) -> list[Window]:
    """The spans in order, united where no more than `gap` (s) lies between them, cut to the window."""
    found: list[list[float]] = []
    for start, end in sorted(spans.tolist()):
        if found and start <= found[-1][1] + gap:
            found[-1][1] = max(found[-1][1], end)
        else:
            found.append([start, end])
    return [(max(start, window[0]), min(end, window[1])) for start, end in found]


MOST_FRAMES = 1e6
BUSY_SHARE = 0.8  # of the film, for the stretches in which things happen
SLOWEST = 1e-9  # of the fast speed: a stretch of rounding size is none to dwell on
RAMP = 0.3  # s of the film from one speed to the other


@dataclass(frozen=True)
class Plan:
    """Which instants become frames: `times` (s), seconds of the watch per second of the film at each, and frames per second."""

    times: Array
    speeds: Array
    fps: float


def even(span: Window, speed: float, fps: float) -> Plan:
    """Frames at one speed, seconds of the watch per second of the film."""
    if not (math.isfinite(speed) and speed > 0.0):
        raise ValueError(f"speed = {speed}: give seconds of the watch per second of the movie, such as 1 or 1/20")
    if not (span[1] - span[0]) * fps / speed <= MOST_FRAMES:
        raise ValueError(f"speed = {speed:g}: more than {MOST_FRAMES:g} frames; show a shorter window, or show it faster")
    count = math.floor((span[1] - span[0]) * fps / speed + 1e-6) + 1
    return Plan(np.minimum(span[0] + np.arange(count) * (speed / fps), span[1]), np.full(count, speed), fps)


def adaptive(span: Window, busy: Sequence[Window], length: float, fps: float) -> Plan:
    """A film of `length` seconds that is slow in the `busy` stretches (in order, apart) and fast between them.

    At one speed where that would show the busy stretches faster than the others: when they fill most of the window, or none.
    """
    if not (math.isfinite(length) and length > 0.0):
        raise ValueError(f"length = {length}: give the seconds that the movie shall last")
    if length * fps > MOST_FRAMES:
        raise ValueError(f"length = {length:g}: more than {MOST_FRAMES:g} frames; make a shorter movie")
    whole = span[1] - span[0]
    lively = sum(end - start for start, end in busy)
    count = max(2, math.floor(length * fps + 1e-6) + 1)
    slow, fast = lively / (BUSY_SHARE * length), (whole - lively) / ((1.0 - BUSY_SHARE) * length)
    slow = max(slow, SLOWEST * fast)
    if lively <= 0.0 or fast <= slow:
        return Plan(np.linspace(*span, count), np.full(count, whole / length), fps)
    t, log_speed = _knots(span, busy, slow, fast)
    film = np.concatenate(([0.0], np.cumsum(_lasts(t, log_speed))))
    scale = film[-1] / length  # ramps take from the film what they do not take evenly from both sides
    shown = np.linspace(0.0, film[-1], count)
    times = np.clip(_instants(shown, film, t, log_speed), *span)
    return Plan(times, np.exp(np.interp(times, t, log_speed)) * scale, fps)


def _knots(span: Window, busy: Sequence[Window], slow: float, fast: float) -> tuple[Array, Array]:
    """Times and logarithms of the speed there, which is linear in between: ramps lie in the quiet stretches."""
    edges = [span[0], *(t for stretch in busy for t in stretch), span[1]]
    low, high = math.log(slow), math.log(fast)
    ramp = RAMP * slow * fast * (high - low) / (fast - slow)  # it then lasts RAMP in the film
    t: list[float] = []
    v: list[float] = []
    for k in range(0, len(edges), 2):
        start, end = edges[k], edges[k + 1]
        if end <= start:
            continue
        rises, falls = k > 0, k + 2 < len(edges)  # a busy stretch before it, one after it
        own = min(ramp, (end - start) / (rises + falls)) if rises or falls else 0.0
        top = low + (high - low) * own / ramp if own < ramp else high
        if rises:
            t, v = [*t, start], [*v, low]
        t, v = [*t, start + own * rises, end - own * falls], [*v, top, top]
        if falls:
            t, v = [*t, end], [*v, low]
    if edges[0] == edges[1]:
        t, v = [edges[0], *t], [low, *v]
    if edges[-2] == edges[-1]:
        t, v = [*t, edges[-1]], [*v, low]
    return np.array(t), np.array(v)


def _lasts(t: Array, log_speed: Array) -> Array:
    """How long each piece lasts in the film: the integral of dt / v with log v linear in t."""
    step, rise = np.diff(t), np.diff(log_speed)
    steep = np.abs(rise) > 1e-9
    mean = np.where(steep, -np.expm1(-rise) / np.where(steep, rise, 1.0), 1.0)
    return step * np.exp(-log_speed[:-1]) * mean


def _instants(shown: Array, film: Array, t: Array, log_speed: Array) -> Array:
    """The instants of the watch at those seconds of the film: the inverse of the integral, piece by piece."""
    piece = np.clip(np.searchsorted(film, shown, side="right") - 1, 0, len(t) - 2)
    rest = (shown - film[piece]) * np.exp(log_speed[piece])
    step = np.diff(t)[piece]
    slope = np.diff(log_speed)[piece] / np.where(step > 0.0, step, 1.0)
    steep = np.abs(slope * step) > 1e-9
    bent = -np.log1p(-np.minimum(rest * slope, 1.0 - 1e-12)) / np.where(steep, slope, 1.0)
    return t[piece] + np.where(steep, bent, rest)


AT_ONCE = 1000  # instants whose poses are asked for together: memory does not grow with the film


@dataclass(frozen=True)
class Film:
    """What it takes to draw any frame of a plan."""

    stage: Stage
    run: Trajectory
    plan: Plan
    marks: ContactMarks | None
    arrows: ForceArrows | None
    shows_speed: bool

    def pictures(self, numbers: NDArray[np.int64], progress: Callable[[int, int], None] | None = None) -> Iterator[Pixels]:
        """Frames of these numbers, one after the other, each in the same memory."""
        for start in range(0, len(numbers), AT_ONCE):
            part = numbers[start : start + AT_ONCE]
            where = poses(self.run, self.plan.times[part])
            for k, number in enumerate(part.tolist()):
                yield self._picture(number, {name: rows[k] for name, rows in where.items()})
                if progress is not None:
                    progress(start + k + 1, len(numbers))

    def _picture(self, number: int, frames: dict[str, NDArray[np.float64]]) -> Pixels:
        t = float(self.plan.times[number])
        return self.stage.draw(
            t,
            frames,
            self.marks.points(t, frames) if self.marks else None,
            press=self.arrows.at(number) if self.arrows else None,
            speed=float(self.plan.speeds[number]) if self.shows_speed else None,
        )


def soundtrack(run: Trajectory, plan: Plan) -> Score:
    """The blows within a plan, in seconds of the film. ValueError where there are none."""
    times, energies = blows(run)
    heard = (energies > 0.0) & (times >= plan.times[0]) & (times <= plan.times[-1])
    if not heard.any():
        raise ValueError("sound: nothing sounds between the first and the last picture, or no impacts were kept")
    shown = np.arange(len(plan.times)) / plan.fps
    return Score(np.interp(times[heard], plan.times, shown), energies[heard], len(plan.times) / plan.fps, None)


ADAPTIVE = "adaptive"  # a speed

MP4_FPS, GIF_FPS = 60.0, 25.0
LENGTH = 10.0  # s: a movie at adaptive speed
ORDERED = 25  # instants of a movie for which names on the parts are put in order
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
    names: bool = False,
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
    zoom      names of the bodies to frame, or "all"; default: what touches, with the whole small beside it, or all where that
              is hardly smaller
    turn      radians by which the picture is turned; default: gravity down, or the quarter turn that fills the frame best
    insets    places to enlarge: "lever", "lever.STONES", "lever.STONES.2" (its second outline), "entry stone", "exit stone",
              or a rectangle of the movement in mm, "-1.4, 1.9 : -0.8, 2.5"
    strip     the body whose angle and velocity run below the mechanism; True: the oscillator
    phases    names the phase of a beat
    names     on the parts, as in `watchsim.report`
    forces    arrows for the forces at contacts, of a run by events
    sound     the ticking: each blow when its instant is shown, at slow and adaptive speed, too, with its own pitch
    dark      with a dark background
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
    extras = _extras(run, insets, strip, phases, arrows, np.linspace(*span, ORDERED).tolist() if names else ())
    pixels, turn = _size(run, span, extras, size, zoom, turn, gif)
    steady, step = (None if speed == ADAPTIVE else float(speed)), float(plan.speeds.min()) / plan.fps
    style = DARK if dark else LIGHT
    stage = Stage(run, pixels, span, zoom=zoom, turn=turn, speed=steady, step=step, extras=extras, style=style)
    film = Film(stage, run, plan, ContactMarks(run) if contacts else None, arrows, speed == ADAPTIVE)
    palette = _palette(film.pictures, len(plan.times), style.phases.values() if phases else ()) if gif else None
    write = None if heard is None else (lambda place: write_score(place, heard, heard.known))
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
    names: bool = False,
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
    extras = _extras(run, insets, strip, phases, arrows, (float(t),) if names else ())
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


def _palette(pictures: Callable[[NDArray[np.int64]], Iterator[Pixels]], count: int, named: Iterable[str] = ()) -> Palette:
    """The colours of some of so many frames, and these `named` ones exactly."""
    sampled = np.unique(np.linspace(0, count - 1, SAMPLES).astype(int))
    return shared_palette([picture.copy() for picture in pictures(sampled)], named)


def _extras(
    run: Trajectory,
    insets: Sequence[str],
    strip: str | bool,
    phases: bool,
    arrows: ForceArrows | None,
    ordered: Sequence[float],
) -> Extras:
    places = (insets,) if isinstance(insets, str) else tuple(insets)
    body = None if strip is False else strip_body(run, None if strip is True else strip)
    names = tuple(part_names(run.scene)) if len(ordered) else ()
    if len(ordered) and not names:
        raise ValueError("names: the parts of this scene have none, since no escape wheel drives anything that swings")
    force, scale = (arrows.largest, arrows.round_force) if arrows else (0.0, 0.0)
    return Extras(places, body, tuple(named_phases(run)) if phases else (), force, scale, names, tuple(ordered))


FPS = 30.0
LEAP = math.radians(0.6)  # of a pressed body per frame
LED = math.radians(0.35)  # of the led body per frame while others move
AFAR = math.radians(6.0)  # and while nothing else moves


class ByHand(Clock):
    """Where the time stands in the movie of a run."""

    def text(self, t: float, step: float) -> str:
        return "by hand"


def turn_movie(found: Turn, path: str | os.PathLike[str], dark: bool = False) -> Path:
    """Write the last cycle as MP4 or GIF, by the ending of `path`, on a light or dark background; touches are ringed."""
    target = check_path(path)
    gif = target.suffix.lower() == ".gif"
    size, fps = (GIF_SIZE, GIF_FPS) if gif else (MP4_SIZE, FPS)
    rows, source = _frames(found)
    # The frames as a run of one second each, for those who frame and draw runs.
    columns = [number for number, body in enumerate(found.scene.bodies) if body.motion != "fixed"]
    slices = {found.names[number]: slice(k, k + 1) for k, number in enumerate(columns)}
    q = rows[:, columns]
    rest, no_events = np.zeros_like(q), np.zeros(0, EVENT_DTYPE)
    run = Trajectory(found.scene, np.arange(len(q), dtype=float), q, rest, rest, slices, no_events, (), Stop.DURATION)
    stage = Stage(run, size, (0.0, float(run.t[-1])), clock=ByHand(0.0, 1.0, ""), style=DARK if dark else LIGHT)

    def pictures(numbers: NDArray[np.int64]) -> Iterator[Pixels]:
        where = frames(found.scene, slices, q[numbers])
        for k, row in enumerate(source[numbers].tolist()):
            touches = found.cycle.touches[row] if row >= 0 else ()
            marks = np.array([touch.place for touch in touches]).reshape(-1, 2)
            yield stage.draw(float(k), {name: poses[k] for name, poses in where.items()}, marks)

    palette = _palette(pictures, len(rows)) if gif else None
    encode(pictures(np.arange(len(rows))), target, size, fps, palette)
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
