"""Where do bodies touch at this instant?

A contact is closed from the event that closed it to the one that opened it; its point lies on the circle it was compiled
to, in the direction of the other side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Point
from watchsim.mechanism.compile import compile_scene
from watchsim.model.records import LINE, Records
from watchsim.simulation.record.trajectory import EventKind, Trajectory
from watchsim.storage.columns import blocks

Array = NDArray[np.float64]


class ContactMarks:
    """The closed contacts of a run. ValueError where its events number contacts that the scene does not have."""

    def __init__(self, run: Trajectory) -> None:
        names = [body.name for body in run.scene.bodies]
        model = compile_scene(run.scene).model
        told = np.concatenate([_told(part) for (part,) in blocks(run.events)] or [_told(run.events)])
        if len(told) and told["contact"].max() >= len(model.contacts):
            raise ValueError("contacts cannot be marked: the events of this run do not belong to its scene")
        self._history: dict[int, tuple[Array, NDArray[np.bool_]]] = {}
        self._sides: dict[int, tuple[Side, Side]] = {}
        for k in map(int, np.unique(told["contact"])):
            events, contact = told[told["contact"] == k], model.contacts[k]
            self._history[k] = np.array(events["t"]), events["closes"]
            self._sides[k] = _side(model.primitives[contact.a], names), _side(model.primitives[contact.b], names)

    def closed(self, t: float) -> list[int]:
        """The numbers of the contacts that are closed at `t` (s)."""
        last = ((k, int(times.searchsorted(t, side="right")) - 1, closes) for k, (times, closes) in self._history.items())
        return [k for k, row, closes in last if row >= 0 and closes[row]]

    @property
    def numbers(self) -> tuple[int, ...]:
        """The contacts that are closed at any time of the run."""
        return tuple(self._history)

    def stretches(self, number: int, window: tuple[float, float]) -> list[tuple[float, float]]:
        """From when to when (s) that contact is closed, as far as it lies in the window."""
        start, stop = window
        found: list[tuple[float, float]] = []
        since: float | None = None
        for t, closes in zip(*(column.tolist() for column in self._history[number]), strict=True):
            if since is not None and t > since:
                found.append((since, t))
            since = t if closes else None
        if since is not None:
            found.append((since, stop))
        return [(max(low, start), min(high, stop)) for low, high in found if low < stop and high > start]

    def sides(self, number: int) -> tuple[Side, Side]:
        """The two primitives of that contact: a circle or corner, and what it touches."""
        return self._sides[number]

    def points(self, t: float, frames: dict[str, Array]) -> Array:
        """(n, 2) points of the contacts closed at `t`, metres, for the poses x, y, angle of that instant."""
        return np.array([_touch(*self._sides[k], frames) for k in self.closed(t)]).reshape(-1, 2)


def _told(events: NDArray[Any]) -> NDArray[Any]:
    """(t, contact, closes) of everything that closes or opens a contact; a hand-over does both."""
    kinds = (EventKind.CLOSE, EventKind.OPEN, EventKind.HANDOVER)
    rows: list[tuple[float, int, bool]] = []
    for event in events[np.isin(events["kind"], kinds)]:
        if event["kind"] == EventKind.HANDOVER:
            rows.append((event["t"], int(event["value"]), False))
        rows.append((event["t"], event["contact"], event["kind"] != EventKind.OPEN))
    return np.array(rows, dtype=[("t", "f8"), ("contact", "i8"), ("closes", "?")])


@dataclass(frozen=True)
class Side:
    """A primitive in its body's frame: a circle's centre, radius and side; a line has its outward normal instead."""

    body: str
    x: float
    y: float
    radius: float
    side: float
    normal: Point | None


def _side(primitive: Records, names: list[str]) -> Side:
    # Outward normal of a line: the direction of travel turned by -90 degrees.
    normal = (float(primitive.ty), -float(primitive.tx)) if primitive.kind == LINE else None
    x, y, radius, side = (float(primitive[name]) for name in ("x", "y", "radius", "side"))
    return Side(names[primitive.body], x, y, radius, side, normal)


def _touch(a: Side, b: Side, frames: dict[str, Array]) -> Point:
    """From the circle's centre towards B's material by its radius, against B's outward normal."""
    x, y = _world(frames[a.body], a.x, a.y)
    bx, by, turn = frames[b.body]
    if b.normal is not None:
        nx, ny = _world((0.0, 0.0, turn), *b.normal)
    else:
        px, py = _world((bx, by, turn), b.x, b.y)
        apart = b.side * math.hypot(x - px, y - py) or 1.0
        nx, ny = (x - px) / apart, (y - py) / apart
    return x - a.radius * nx, y - a.radius * ny


def _world(frame: Sequence[float] | Array, x: float, y: float) -> Point:
    c, s = math.cos(frame[2]), math.sin(frame[2])
    return frame[0] + c * x - s * y, frame[1] + s * x + c * y
