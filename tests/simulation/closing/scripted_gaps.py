"""Which gaps are functions of time that a test has made up?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
from plain_kernels import in_python

from watchsim.model.records import LINE
from watchsim.simulation.first_closing import time_of_impact

START, END = 0.5, 2.5
OPTIONS = SimpleNamespace(gap_zero=1e-13, behind=1e-8, extent=1e-9, speed_zero=1e-9, size=3.0)
RADIUS = 0.4


class Search:
    """A search for the closing of contact 1, whose gap, and how far it is inside either primitive, are functions of time.

    Bounds are those of the gap over a stretch, or over `longest` of it; `instead` stands in for other parts of the search.
    """

    def __init__(self, gap: Any, inside: tuple[Any, Any] = (None, None), **given: Any) -> None:
        self.gap, self.inside = gap, [one or (lambda t: 1.0) for one in inside]
        self.longest, self.kind = given.pop("longest", math.inf), given.pop("kind", LINE)
        self.now, self.looks, self.calls, self.instead = math.nan, [], [], given  # type: ignore[var-annotated]

    def place(self, model, state, bodies, tau, step, path) -> None:
        assert bodies == (7, 8)
        self.now = float(tau)

    def placed_gap(self, model, k, pose) -> tuple[float, float, float, float]:
        assert k == 1
        self.looks.append(self.now)
        return self.gap(self.now), self.gap.deriv()(self.now), self.inside[0](self.now), self.inside[1](self.now)

    def next_stretch(self, model, options, k, left, step, path) -> tuple[float, float, float, float]:
        assert left == self.end - self.now
        length = min(left, self.longest)
        times = np.linspace(self.now, self.now + length, 200)
        closing, bend = (1.001 * float(np.abs(self.gap.deriv(order)(times)).max()) + 1e-9 for order in (1, 2))
        return length, closing, bend, 0.3

    def found(self, start: float = START, end: float = END) -> tuple[float, bool]:
        """Searched on from where a turn of looks ended."""
        primitives = [None, SimpleNamespace(body=7, radius=0.0, length=RADIUS), SimpleNamespace(body=8, radius=RADIUS)]
        primitives[2].kind = self.kind  # type: ignore[union-attr]
        model = SimpleNamespace(contacts=[None, SimpleNamespace(a=1, b=2)], primitives=primitives)
        state = SimpleNamespace(counts=SimpleNamespace(gap_evaluations=5))
        instead = {
            "_place": self.place,
            "placed_gap": self.placed_gap,
            "next_stretch": self.next_stretch,
            "centre_distance": lambda *_: math.inf,
            "sunk_level": lambda *_: 0.0,
            **{name: lambda *_: 0.0 for name in ("time_still", "time_apart", "time_immovable", "time_held")},
            **self.instead,
        }
        search = in_python(time_of_impact.crossing, **instead)
        self.turns, self.end = 0, end
        while True:
            before = len(self.looks)
            time, closes = search(model, state, OPTIONS, 1, start, end, None, SimpleNamespace(pose=None))
            self.turns += 1
            assert self.turns < 100
            assert len(self.looks) - before <= 16 and state.counts.gap_evaluations == 5 + len(self.looks)
            if closes or time >= end:
                return float(time), bool(closes)
            start = time
