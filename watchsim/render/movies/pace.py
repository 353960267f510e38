"""Which instants of a run become frames, and how fast does the film go at each?

At an even speed, or adaptive: the stretches in which things happen get most of the film, the others are hurried through, and
between the two the speed changes smoothly.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.render.frame.pose_history import Window

Array = NDArray[np.float64]

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
