"""Where do bodies touch at this instant?

A contact is closed from the event that closed it to the one that opened it; its point lies on the circle it was compiled
to, in the direction of the other side.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.model import LINE
from watchsim.render.poses import placed
from watchsim.simulation.trajectory import EventKind, Trajectory

Array = NDArray[np.float64]


class ContactMarks:
    """The closed contacts of a run. ValueError where its events number contacts that the scene does not have."""

    def __init__(self, run: Trajectory) -> None:
        self._names = [body.name for body in run.scene.bodies]
        self._model = compile_scene(run.scene).model
        told = run.events[np.isin(run.events["kind"], (EventKind.CLOSE, EventKind.OPEN))]
        if len(told) and told["contact"].max() >= len(self._model.contacts):
            raise ValueError("contacts cannot be marked: the events of this run do not belong to its scene")
        self._history = {int(k): told[told["contact"] == k] for k in np.unique(told["contact"])}

    def closed(self, t: float) -> list[int]:
        """The numbers of the contacts that are closed at `t` (s)."""
        found = []
        for k, events in self._history.items():
            last = int(np.searchsorted(events["t"], t, side="right")) - 1
            if last >= 0 and events["kind"][last] == EventKind.CLOSE:
                found.append(k)
        return found

    def points(self, t: float, frames: dict[str, Array]) -> Array:
        """(n, 2) points of the contacts closed at `t`, metres, for the poses x, y, angle of that instant."""
        return np.array([self._point(k, frames) for k in self.closed(t)]).reshape(-1, 2)

    def _point(self, k: int, frames: dict[str, Array]) -> Array:
        """From the circle's centre towards B's material by its radius, along B's outward normal reversed."""
        contact = self._model.contacts[k]
        a, b = self._model.primitives[contact.a], self._model.primitives[contact.b]
        on_b = frames[self._names[b.body]]
        centre = _world(frames[self._names[a.body]], a.x, a.y)
        if b.kind == LINE:
            outward = _world(on_b, b.ty, -b.tx) - on_b[:2]
        else:
            apart = centre - _world(on_b, b.x, b.y)
            outward = b.side * apart / max(float(np.hypot(*apart)), 1e-300)
        return centre - a.radius * outward


def _world(frame: Array, x: float, y: float) -> Array:
    return placed(np.array([[x, y]]), frame[None, :])[0, 0]
