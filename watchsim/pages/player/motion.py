"""Which rows of a run must a page hold, so that every outline stands where the run has it?

Each body keeps rows of its own: a locked wheel needs none while the balance swings. Between rows the page interpolates as
`Trajectory.sample` does, by quintics through q, u and a.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.pages.player.packed import doubles, floats
from watchsim.render.fewest_rows import kept_rows
from watchsim.render.frame.filled_parts import loops_of, outline
from watchsim.render.frame.pose_history import Window
from watchsim.render.frame.view import COARSE, size_of
from watchsim.scene.body import Body
from watchsim.simulation.record.trajectory import Array, Trajectory, between

FINE, COARSEST = 5e-7, 1e-3  # of the picture's size: what outlines may be off, at first, and where there is too much to keep
LEAST_ARM = 0.25  # of the picture's size
STEP = 4.0  # from one try to the next coarser one
MOST = 360_000  # bytes of motion, before they are put into text
SLOPE, CURVE = 1e-4, 2e-3  # of their largest values: what velocities and accelerations may be off where FINE holds


class TooMuch(ValueError):
    """The window holds more motion than a page can."""


@dataclass(frozen=True)
class Channel:
    """Rows of one body: t (s), and for its coordinates q - base, u, a, (rows, 3n)."""

    body: str
    t: Array
    base: Array
    values: Array

    @property
    def bytes(self) -> int:
        return 8 * len(self.t) + 4 * self.values.size

    def packed(self) -> dict[str, object]:
        return {"t": doubles(self.t), "base": self.base.tolist(), "rows": floats(self.values)}


def channels(run: Trajectory, window: Window, size: float) -> tuple[list[Channel], float]:
    """Rows of every moving body for a window, and how far outlines are off at most (m); `size` (m) is the picture's.

    TooMuch where that would be more than a thousandth of the picture.
    """
    first = max(int(np.searchsorted(run.t, window[0], side="right")) - 1, 0)
    last = min(int(np.searchsorted(run.t, window[1], side="left")) + 1, len(run.t))
    t = run.t[first:last]
    middle = 0.5 * (t[:-1] + t[1:])
    halfway = run.sample(middle)
    kept = slice(first, last)
    told = [_of(run, body, kept, middle, *halfway) for body in run.scene.bodies if body.name in run.slices]
    share = FINE
    while share <= COARSEST:
        found, taken = [], 0
        for one in told:
            found.append(_channel(one, _weights(run, one.body, LEAST_ARM * size), share * size, share / FINE))
            taken += found[-1].bytes
            if taken > MOST:
                break
        if taken <= MOST:
            return found, share * size
        share *= STEP
    raise TooMuch(
        f"{window[0]:.9g} s to {window[1]:.9g} s hold more motion than a page can, which is {MOST / 1e3:.0f} kB of it; "
        "choose a shorter window"
    )


@dataclass(frozen=True)
class _Told:
    """What the run says of one body: q, u, a (rows, n) at times t, and q, u midway between rows."""

    body: Body
    t: Array
    q: Array
    u: Array
    a: Array
    middle: Array
    q_middle: Array
    u_middle: Array


def _of(run: Trajectory, body: Body, kept: slice, middle: Array, q_middle: Array, u_middle: Array) -> _Told:
    """The columns of that body, of the rows `kept` and midway between them."""
    own = run.slices[body.name]
    rows = run.t[kept], run.q[kept, own], run.u[kept, own], run.a[kept, own]
    return _Told(body, *rows, middle, q_middle[:, own], u_middle[:, own])


def _channel(told: _Told, weight: Array, off: float, looser: float) -> Channel:
    """The rows of one body; outlines may be off by `off` metres, velocities by `looser` times their share.

    `weight` says how many metres an outline moves per unit of each coordinate.
    """
    t, q, u, a, middle = told.t, told.q, told.u, told.a, told.middle
    largest = [np.maximum(np.abs(values).max(axis=0, initial=0.0), 1e-300) for values in (u, a)]
    noise = np.zeros(q.shape[1])

    def fits(i: int, j: int) -> bool:
        h = t[j] - t[i]
        if h <= 0.0:
            return True  # rows of one instant, between which nothing of note has happened to this body
        times = np.concatenate((t[i + 1 : j], middle[i:j]))
        s = ((times - t[i]) / h)[:, None]
        place, rate = between(s, np.full_like(s, h), (q[i], u[i], a[i]), (q[j], u[j], a[j]), noise)
        if np.max(np.abs(place - np.concatenate((q[i + 1 : j], told.q_middle[i:j]))) @ weight) > off:
            return False
        if np.any(np.abs(rate - np.concatenate((u[i + 1 : j], told.u_middle[i:j]))) > looser * SLOPE * largest[0]):
            return False
        pull = _acceleration(s[: j - i - 1], h, (u[i], a[i]), (u[j], a[j]))
        return not np.any(np.abs(pull - a[i + 1 : j]) > looser * CURVE * largest[1])

    # Both rows of an impact that this body has felt; those of the others' are rows like any.
    felt = np.any(np.abs(np.diff(u, axis=0)) > looser * SLOPE * largest[0], axis=1)
    felt |= np.any(np.abs(np.diff(a, axis=0)) > looser * CURVE * largest[1], axis=1)
    jumps = np.flatnonzero((np.diff(t) <= 0.0) & felt)
    kept = kept_rows(len(t), fits, (*jumps.tolist(), *(jumps + 1).tolist()))
    kept = _without_repeats(kept, q, u, a)
    base = q[0] if len(q) else np.zeros(q.shape[1])
    return Channel(told.body.name, t[kept], base, np.hstack((q[kept] - base, u[kept], a[kept])))


def _acceleration(s: Array, h: float, left: tuple[Array, Array], right: tuple[Array, Array]) -> Array:
    """The slope of the cubic in u: what the page draws as force or torque."""
    way = (right[0] - left[0]) / h
    return left[1] + s * (6.0 * way - 4.0 * left[1] - 2.0 * right[1] + s * (3.0 * (left[1] + right[1]) - 6.0 * way))


def _without_repeats(kept: NDArray[np.int64], q: Array, u: Array, a: Array) -> NDArray[np.int64]:
    """Without the rows of events at which this body did not notice anything, if those around them show the same rest."""
    if len(kept) < 3:
        return kept
    values = np.hstack((q[kept], u[kept], a[kept]))
    same = np.all(values[1:] == values[:-1], axis=1) & np.all(u[kept][1:] == 0.0, axis=1) & np.all(a[kept][1:] == 0.0, axis=1)
    inner = np.concatenate(([False], same[:-1] & same[1:], [False]))
    return kept[~inner]


def _weights(run: Trajectory, body: Body, least: float) -> Array:
    """How far (m) an outline of the body, or of one that it carries, moves per unit of each coordinate.

    Angles count as if every body reached at least `least` metres: they are read as numbers, too.
    """
    if body.motion == "slide":
        return np.ones(1)
    arm = max(_reach(run, body), least)
    return np.array([arm]) if body.motion == "pivot" else np.array([1.0, 1.0, arm])


def _reach(run: Trajectory, body: Body) -> float:
    """The largest distance (m) of a point that moves with the body from its origin."""
    loops = loops_of(body)
    points = outline(loops, COARSE * size_of(body)) if loops else np.zeros((1, 2))
    carried = (one for one in run.scene.bodies if one.on == body.name)
    loads = [float(np.hypot(*one.position)) + _reach(run, one) for one in carried]
    return max(float(np.hypot(points[:, 0], points[:, 1]).max()), *loads, 0.0)
