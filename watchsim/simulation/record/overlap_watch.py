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
from watchsim.scene.recording import WHOLE_RUN, Window
from watchsim.scene.scene import Scene
from watchsim.simulation.methods import MOREAU
from watchsim.simulation.record.body_frames import frames
from watchsim.simulation.record.overlap_instants import PairOfLayers, Poses, declared_pairs
from watchsim.simulation.record.trajectory import between
from watchsim.tolerances import OVERLAP_RESOLUTION, STEPPED_OVERLAP

Array = NDArray[np.float64]

CHORD = 1.0 / 8.0  # of the resolution: deviation of chords from arcs
BLOCK = 32768  # rows, of which the longest moves of each coordinate are looked at. Large: less is seen; small: costs time
EVERY = 2  # of the blocks: one in so many. Large, small: as above
FEW = 8  # coordinates whose longest moves are looked at in one block; of more, others in the next
STRIDE = 0.1  # of the scene's size: moves between two rows are looked at in such steps
MOST_STEPS = 7  # in one move
TOGETHER = 64  # instants looked at together
EARLY = (0, 1, 4, 16, 64, 256, 1024)  # rows looked at in any case
DEEPER = 1.25  # times the worst so far: what is measured next
LOOKS = 16  # in a scene's duration, where no rows are recorded
NO_OVERLAP = -1  # in the place of a contact's number
# What has been found: rows seen, instants looked at; of the worst overlap its depth (m), time (s), place (m), contact.
FOUND = np.dtype([(name, "f8") for name in ("rows", "looks", "depth", "time", "x", "y", "contact")])


class OverlapWatch:
    """What has been seen so far. `numbers` is all that a saved state needs of it, `found` the same with names."""

    def __init__(self, scene: Scene, compiled: Compiled, method: str, windows: tuple[Window, ...]) -> None:
        self._scene, self._compiled = scene, compiled
        self.resolution = OVERLAP_RESOLUTION * compiled.size
        self._stepped = STEPPED_OVERLAP * compiled.size if method == MOREAU else 0.0
        self._sees_rows = windows == WHOLE_RUN
        self._pairs: list[PairOfLayers] | None = None
        self._scale = np.array(compiled.model.coordinates.scale)
        self._last: Array | None = None  # row
        self._waiting: list[tuple[Array, Array]] = []  # times and coordinates of chosen rows
        self.numbers = np.zeros(len(FOUND.names or ()))
        self.found = self.numbers.view(FOUND).view(np.recarray)[0]
        self.found.contact = NO_OVERLAP

    def limit(self, admitted: float) -> float:
        """How deep bodies may overlap (m) where the gap functions have seen overlaps of `admitted`."""
        return max(self.resolution, self._stepped, 4.0 * admitted if self._stepped else 0.0)

    def fails(self, admitted: float) -> bool:
        """True if bodies have overlapped by more than the limit."""
        return bool(self.found.depth > self.limit(admitted))

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
            self._waiting.append(self._instants(np.concatenate([self._last, rows[:1]]), np.zeros(1, np.int64)))
        self._last = rows[-1:].copy()
        moves = chosen_moves(rows, len(self._scale), first)
        if len(moves):
            self._waiting.append(self._instants(rows, moves))
        if sum(len(times) for times, _ in self._waiting) >= TOGETHER:
            self.see()

    def _is_far(self, row: Array) -> bool:
        """Is it, from the last row seen to this one, further than what lies between any two rows may go unseen?"""
        assert self._last is not None
        way = np.abs(row[1 : 1 + len(self._scale)] - self._last[0, 1 : 1 + len(self._scale)]) / self._scale
        return bool(row[0] > self._last[0, 0] and way.max(initial=0.0) > STRIDE)

    def _instants(self, rows: Array, moves: NDArray[np.int64]) -> tuple[Array, Array]:
        """Times and coordinates within the moves from rows `moves` to the next ones; only at rows where time is stepped."""
        n = len(self._scale)
        if self._stepped:
            return rows[moves + 1, 0], rows[moves + 1, 1 : 1 + n]
        way = np.abs(rows[moves + 1, 1 : 1 + n] - rows[moves, 1 : 1 + n]) / self._scale
        steps = np.clip(np.ceil(way.max(axis=1, initial=0.0) / STRIDE), 1, MOST_STEPS).astype(np.int64)
        move = np.repeat(moves, steps)
        nth = np.arange(len(move)) - np.repeat(np.cumsum(steps) - steps, steps)
        share = ((nth + 1.0) / (np.repeat(steps, steps) + 1.0))[:, None]
        h = (rows[move + 1, 0] - rows[move, 0])[:, None]
        ends = [(at[:, 1 : 1 + n], at[:, 1 + n : 1 + 2 * n], at[:, 1 + 2 * n :]) for at in (rows[move], rows[move + 1])]
        q, _ = between(share, h, ends[0], ends[1], np.zeros(n))
        return rows[move, 0] + share[:, 0] * h[:, 0], q

    def see(self, *now: tuple[Array, Array]) -> None:
        """Look at what waits, and at further instants: times, and coordinates of the model (instants, n)."""
        instants, self._waiting = [*self._waiting, *now], []
        if self._pairs is None:
            self._pairs = list(declared_pairs(self._scene, self._bar, CHORD * self.resolution))
        if not instants or not self._pairs:
            return
        times, q = (np.concatenate(parts) for parts in zip(*instants, strict=True))
        self.found.looks += len(times)
        places = frames(self._scene, self._compiled.slices, self._compiled.relative(q))
        poses = {name: (place[:, 0] + 1j * place[:, 1], np.exp(1j * place[:, 2])) for name, place in places.items()}
        both = [(poses[pair.sides[0].body], poses[pair.sides[1].body]) for pair in self._pairs]
        done = 0
        while done < len(times):
            done = self._next_overlap(self._pairs, times, both, done)

    @property
    def _bar(self) -> float:
        """How deep an overlap must be to be measured: one for all pairs, whatever is looked at together."""
        return max(self.resolution, DEEPER * float(self.found.depth))

    def _next_overlap(self, pairs: list[PairOfLayers], times: Array, both: list[tuple[Poses, Poses]], done: int) -> int:
        """Measure the overlaps of the next instant, from number `done`, that has any; returns the number of the one after."""
        left = slice(done, None)
        hits = [
            done + pair.overlapping(((a[0][left], a[1][left]), (b[0][left], b[1][left])))
            for pair, (a, b) in zip(pairs, both, strict=True)
        ]
        if not any(len(hit) for hit in hits):
            return len(times)
        at = min(int(hit[0]) for hit in hits if len(hit))
        before = self._bar
        for pair, hit, poses in zip(pairs, hits, both, strict=True):
            if len(hit) and hit[0] == at:
                depth, place = pair.deepest(poses, at)
                if depth > self.found.depth:
                    found = self.found
                    found.depth, found.time, found.contact = depth, times[at], pair.contact
                    found.x, found.y = place
        if self._bar > before:
            for pair in pairs:
                pair.look_for(self._bar)
        return at + 1

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


def chosen_moves(rows: Array, n: int, first: int) -> NDArray[np.int64]:
    """Between which rows to look: places of the rows before. n coordinates; `first` rows of the run came before these.

    A contact that is lost shows in a long way without an event: of each block of rows the longest moves of the coordinates are
    chosen; and some of the first rows, since what is lost at the start may be over soon after.
    """
    chosen: list[int] = []
    for start in range(0, len(rows) - 1, BLOCK):
        number = (first + start) // BLOCK
        if number % EVERY:
            continue
        for i in range(n) if n <= FEW else (number // EVERY * FEW + np.arange(FEW)) % n:
            q = rows[start : start + BLOCK + 1, 1 + i]
            way = q[1:] - q[:-1]
            up, down = int(np.argmax(way)), int(np.argmin(way))
            chosen.append(start + (up if way[up] >= -way[down] else down))
    chosen += [number - first for number in EARLY if 0 <= number - first < len(rows) - 1]
    places = np.unique(np.array(chosen, np.int64))
    return places[rows[places + 1, 0] > rows[places, 0]]
