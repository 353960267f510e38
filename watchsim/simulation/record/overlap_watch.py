"""Was there ever material inside material in a run?

Now and then a state is looked at, chosen from the recorded rows; the motion never depends on being watched. The outlines of
all declared contacts are compared as polygons (overlap_instants.py), which shares nothing with the gap functions: a contact
that the loop has lost is found by this.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled
from watchsim.model.records import records
from watchsim.scene.recording import WHOLE_RUN, Window
from watchsim.scene.scene import Scene
from watchsim.simulation.methods import MOREAU
from watchsim.simulation.record.body_frames import frames
from watchsim.simulation.record.overlap_instants import Layers, declared_pairs
from watchsim.simulation.record.overlap_sieve import PAIR, STRETCH, sieve
from watchsim.simulation.record.watched_instants import STRIDE, chosen_moves, instants_within, longest_moves
from watchsim.tolerances import OVERLAP_RESOLUTION, STEPPED_OVERLAP

Array = NDArray[np.float64]

CHORD = 1.0 / 8.0  # of the resolution: deviation of chords from arcs
TOGETHER = 24  # moves looked at together
STATES_TOGETHER = 4  # where no rows are recorded: states looked at together
DEEPER = 1.25  # times the worst so far: what is measured next
LOOKS = 16  # in a scene's duration, where no rows are recorded
NO_OVERLAP = -1  # in the place of a contact's number
# What has been found: rows seen, instants looked at; of the worst overlap its depth (m), time (s), place (m), contact.
FOUND = np.dtype([(name, "f8") for name in ("rows", "looks", "depth", "time", "x", "y", "contact")])


def warm_up() -> None:
    """Load or compile the kernels that look for overlaps."""
    none = np.zeros(0, np.int64)
    longest_moves(np.zeros((0, 1)), 0, 0, none, np.zeros(0), none)
    sieve(
        records(PAIR, 0),
        records(STRETCH, 0),
        np.zeros((0, 2)),
        np.zeros((0, 0, 3)),
        0.0,
        np.zeros((0, 2)),
        np.zeros((0, 0), bool),
    )


class OverlapWatch:
    """What has been seen so far. `numbers` is all that a saved state needs of it, `found` the same with names."""

    def __init__(self, scene: Scene, compiled: Compiled, method: str, windows: tuple[Window, ...]) -> None:
        self._scene, self._compiled = scene, compiled
        self.resolution = OVERLAP_RESOLUTION * compiled.size
        self._stepped = STEPPED_OVERLAP * compiled.size if method == MOREAU else 0.0
        self._sees_rows = windows == WHOLE_RUN
        self._layers: Layers | None = None
        self._scale = np.array(compiled.model.coordinates.scale)
        self._last: Array | None = None  # row
        self._waiting: list[tuple[Array, Array]] = []  # chosen moves: rows before and after
        self._states: list[tuple[float, Array]] = []  # times and coordinates that wait besides
        self._owed: list[tuple[int, int, Array]] = []  # numbers to be filled in; how many moves and states waited then
        self.numbers = np.zeros(len(FOUND.names or ()))
        self.found = self.numbers.view(FOUND).view(np.recarray)[0]
        self.found.contact = NO_OVERLAP

    def limit(self, admitted: float) -> float:
        """How deep bodies may overlap (m) where the gap functions have seen overlaps of `admitted`."""
        return max(self.resolution, self._stepped, 4.0 * admitted if self._stepped else 0.0)

    def fails(self, admitted: float) -> bool:
        """True if bodies have overlapped by more than the limit."""
        depth = float(self.found.depth)
        return depth > 0.0 and depth > self.limit(admitted)

    def next_look(self, t: float) -> float:
        """The time after t (s) at which the state must be looked at, for want of rows; infinity where there are rows."""
        if self._sees_rows:
            return math.inf
        spacing = self._scene.duration / LOOKS
        return (math.floor(t / spacing * (1.0 + 1e-12)) + 1.0) * spacing

    def see_rows(self, rows: Array) -> None:
        """Look, soon, at some of the next rows (t, q, u, a) of the run and between them."""
        first = int(self.found.rows)
        self.found.rows += len(rows)
        if not self._sees_rows or not len(rows):
            return
        if self._last is not None and self._is_far(rows[0]):
            # A long way between two parts of the rows is always looked at.
            self._waiting.append((self._last, rows[:1].copy()))
        self._last = rows[-1:].copy()
        moves = chosen_moves(rows, len(self._scale), first)
        if len(moves):
            self._waiting.append((rows[moves], rows[moves + 1]))
        if self._waits >= TOGETHER:
            self.see()

    @property
    def _waits(self) -> int:
        """How many moves wait to be looked at."""
        return sum(len(before) for before, _ in self._waiting)

    def _is_far(self, row: Array) -> bool:
        """Is it, from the last row seen to this one, further than what lies between any two rows may go unseen?"""
        assert self._last is not None
        way = np.abs(row[1 : 1 + len(self._scale)] - self._last[0, 1 : 1 + len(self._scale)]) / self._scale
        return bool(row[0] > self._last[0, 0] and way.max(initial=0.0) > STRIDE)

    def fill_in_later(self, numbers: Array) -> None:
        """Bring `numbers`, a copy of the watch's own, up to date when what waits now has been looked at: with what comes next,
        since each look at all pairs costs as much as a dozen instants."""
        self._owed.append((self._waits, len(self._states), numbers))

    def see_state(self, t: float, q: Array) -> None:
        """Look, soon, at a state: time (s) and coordinates of the model (n,)."""
        self._states.append((t, q))
        if len(self._states) >= STATES_TOGETHER:
            self.see()

    def see(self) -> None:
        """Look at all that waits."""
        waiting, states, owed = self._waiting, self._states, self._owed
        self._waiting, self._states, self._owed = [], [], []
        if self._layers is None:
            self._layers = declared_pairs(self._scene, CHORD * self.resolution)
        if not self._layers.pairs or not (waiting or states):
            return
        n = len(self._scale)
        none = np.zeros((0, 1 + 3 * n))
        before, after = map(np.concatenate, zip(*waiting, strict=True)) if waiting else (none, none)
        within = instants_within(before, after, self._scale, self._stepped > 0.0)
        times = np.concatenate((within.times, [t for t, _ in states]))
        q = np.concatenate([within.q, *(at[None] for _, at in states)])
        # Where rows are seen, there is no state but that at the end; elsewhere there are no moves.
        due = [(int(within.ends[moves]) + count, numbers) for moves, count, numbers in owed]
        self._look(self._layers, times, q, due)

    def _look(self, layers: Layers, times: Array, q: Array, owed: list[tuple[int, Array]]) -> None:
        """Look at all pairs at some instants; `owed`: numbers as they are after the first so many of these."""
        places = frames(self._scene, self._compiled.slices, self._compiled.relative(q))
        where = np.array([places[name] for name in layers.bodies])
        looks, done = int(self.found.looks), 0
        while done <= len(times):
            hits = layers.overlapping(where[:, done:], self._bar)
            at = done + (int(hits.any(axis=0).argmax()) if hits.any() else hits.shape[1])
            for count, numbers in owed:
                if done <= count <= at:
                    self.found.looks = looks + count
                    numbers[1:] = self.numbers[1:]  # all but the rows
            if at < len(times):
                self._measure(layers, hits[:, at - done], where[:, at], float(times[at]))
            done = at + 1
        self.found.looks = looks + len(times)

    @property
    def _bar(self) -> float:
        """How deep an overlap must be to be measured: one for all pairs, whatever is looked at together."""
        return max(self.resolution, DEEPER * float(self.found.depth))

    def _measure(self, layers: Layers, hit: NDArray[np.bool_], where: Array, t: float) -> None:
        """Measure the overlaps of the pairs that are `hit`, bodies being `where` (bodies, 3)."""
        for k in np.flatnonzero(hit):
            pair, found = layers.pairs[k], self.found
            depth, place = pair.deepest([where[layers.bodies.index(side.body)] for side in pair.sides])
            if depth > found.depth:
                found.depth, found.time, found.contact = depth, t, pair.contact
                found.x, found.y = place

    def words(self) -> str:
        """The worst overlap in words."""
        first, second = self._scene.contacts[int(self.found.contact)].sides
        x, y = (f"{1e3 * value:.4g}" for value in (self.found.x, self.found.y))
        depth, t = 1e6 * self.found.depth, self.found.time
        return f"{first} and {second} overlapped by {depth:.3g} µm at t = {t:.9g} s, at ({x}, {y}) mm"

    def result(self, admitted: float) -> dict[str, Any]:
        """What was found, as plain values for the summary."""
        depth, contact = float(self.found.depth), int(self.found.contact)
        sides = self._scene.contacts[contact].sides if contact != NO_OVERLAP else None
        return {
            "worst_m": depth,
            "resolution_m": self.resolution,
            "allowed_m": self.limit(admitted),
            "looks": int(self.found.looks),
            "between": [str(side) for side in sides] if sides else None,
            "t_s": float(self.found.time) if sides else None,
            "x_mm": 1e3 * float(self.found.x) if sides else None,
            "y_mm": 1e3 * float(self.found.y) if sides else None,
        }
