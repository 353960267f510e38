"""Where are the bodies, over any stretch of time?

Everything is asked of the trajectory's interpolation, so a picture may be drawn at any time and in any order.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from watchsim.render.drawn_rows import taken, thinned
from watchsim.scene.body import Body
from watchsim.simulation.record.body_frames import frames as body_frames
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]
Window = tuple[float, float]

SWEEP_STEP = math.radians(3.0)  # a chord this long leaves its circle by 0.03 % of the radius
PATH_SAMPLES = 400


def recorded(run: Trajectory) -> tuple[Window, ...]:
    """The stretches of time (s) in which the motion is known, in order; ValueError where no rows were kept."""
    if len(run.t) == 0:
        raise ValueError("nothing to draw: no row of this run was kept (see --record)")
    first, last = float(run.t[0]), float(run.t[-1])
    spans = [(max(start, first), min(stop, last)) for start, stop in run.spans]
    return tuple((start, stop) for start, stop in spans if start < stop) or ((first, last),)


def stretch(run: Trajectory, window: Sequence[float] | None, unbroken: bool = False) -> Window:
    """The window to draw (s): as asked, or all that was recorded.

    ValueError where it is empty, reversed, or holds times that were not recorded; with `unbroken` also where nothing was
    asked and the record has gaps.
    """
    spans = recorded(run)
    kept = " and ".join(f"{start:.9g} s to {stop:.9g} s" for start, stop in spans)
    if spans[-1][1] <= spans[0][0]:
        raise ValueError(f"nothing to draw: the run holds only the instant {spans[0][0]:.9g} s")
    if window is None:
        if unbroken and len(spans) > 1:
            raise ValueError(f"{kept} were recorded: choose a window within one of them")
        return spans[0][0], spans[-1][1]
    try:
        start, stop = (float(value) for value in window)
    except (TypeError, ValueError):
        raise ValueError(f"window = {window!r}: give two times in seconds, (from, to), within {kept}") from None
    if not start < stop:
        raise ValueError(f"window from {start:.9g} s to {stop:.9g} s is empty; give (from, to) within {kept}")
    slack = 1e-9 * (stop - start)
    for low, high in spans:
        if low - slack <= start and stop <= high + slack:
            return max(start, low), min(stop, high)
    raise ValueError(f"window from {start:.9g} s to {stop:.9g} s: only {kept} was recorded")


def moving(run: Trajectory) -> tuple[Body, ...]:
    """The bodies that have coordinates, in the scene's order."""
    return tuple(body for body in run.scene.bodies if body.name in run.slices)


def choose(run: Trajectory, names: Sequence[str] | None) -> tuple[Body, ...]:
    """The moving bodies of those names (default all); ValueError naming the choices where one is unknown or fixed."""
    bodies = {body.name: body for body in moving(run)}
    if names is None:
        return tuple(bodies.values())
    asked = (names,) if isinstance(names, str) else tuple(names)
    unknown = [name for name in asked if name not in bodies]
    if unknown or not asked:
        wrong = ", ".join(repr(name) for name in unknown) or "none given"
        raise ValueError(f"bodies: no moving body is called {wrong}; there are: {', '.join(bodies) or 'none'}")
    return tuple(bodies[name] for name in asked)


def poses(run: Trajectory, times: Array) -> dict[str, Array]:
    """For every body (len(times), 3): x, y (m) and angle (rad) of its frame."""
    q, _ = run.sample(times)
    return body_frames(run.scene, run.slices, q)


def placed(points: Array, frames: Array) -> Array:
    """(len(frames), n, 2): the body points (n, 2) in the plane, for every pose x, y, angle."""
    c, s = np.cos(frames[:, 2:3]), np.sin(frames[:, 2:3])
    x = frames[:, 0:1] + c * points[:, 0] - s * points[:, 1]
    y = frames[:, 1:2] + s * points[:, 0] + c * points[:, 1]
    return np.stack((x, y), axis=2)


def sampled(run: Trajectory, body: Body, window: Window) -> Array:
    """(m, 3) poses at some hundred instants of the window, rows among them."""
    inside = run.t[(run.t >= window[0]) & (run.t <= window[1])]
    thinned = inside[:: max(1, len(inside) // PATH_SAMPLES)]
    return poses(run, np.union1d(np.linspace(*window, PATH_SAMPLES), thinned))[body.name]


def swept(run: Trajectory, body: Body, window: Window) -> Array:
    """(m, 3) poses dense enough to show the room the body takes within the window.

    A pivoted body is turned evenly through the angles it really reaches (at most one turn), others are sampled in time.
    """
    frames = sampled(run, body, window)
    if body.motion != "pivot" or body.on is not None:
        return frames
    low, high = float(frames[:, 2].min()), float(frames[:, 2].max())
    high = min(high, low + 2.0 * math.pi)
    angles = np.linspace(low, high, 2 + int((high - low) / SWEEP_STEP))
    return np.column_stack((np.tile(body.position, (len(angles), 1)), angles))


def dense(run: Trajectory, window: Window, least: int = 2000, accelerations: bool = True) -> tuple[Array, Array, Array, Array]:
    """t (m,), q, u and a (m, n) over the window: every row that a picture shows, and points between rows far apart.

    Without `accelerations` there are none of them, (0, n): to gather them takes as long as any of the others.
    At an impact both rows of that instant are kept, so that a jump stays a jump. Stretches that were not recorded are NaN.
    """
    start, stop = window
    inside = thinned(run, window)
    at_rows = taken(run.t, inside)
    times = np.concatenate(([start], at_rows, [stop]))
    gaps = np.diff(times)
    extra = np.maximum(np.ceil(gaps * (least / (stop - start))).astype(int) - 1, 0)
    left = np.repeat(np.arange(len(gaps)), extra)
    rank = np.arange(len(left)) - np.repeat(np.cumsum(extra) - extra, extra) + 1
    between = times[left] + gaps[left] * rank / (extra[left] + 1)
    added = np.concatenate(([start], between, [stop]))
    place = np.searchsorted(at_rows, between, side="right")

    def merged(rows: Array, new: Array) -> Array:
        inner = np.insert(rows, place, new[1:-1], 0) if len(place) else rows
        return np.concatenate((new[:1], inner, new[-1:]))

    t = merged(at_rows, added)
    q, u = (merged(taken(rows, inside), new) for rows, new in zip((run.q, run.u), run.sample(added), strict=True))
    a = merged(taken(run.a, inside), run.acceleration(added)) if accelerations else run.a[:0]
    spans = recorded(run)
    if len(spans) > 1:
        known = np.any([(t >= low) & (t <= high) for low, high in spans], axis=0)[:, None]
        q, u, a = (np.where(known, values, np.nan) if len(values) else values for values in (q, u, a))
    return t, q, u, a
