"""Was there ever material inside material in a run?

Now and then a state is looked at, chosen from the recorded rows; the motion never depends on being watched. The outlines of
all declared contacts are compared as polygons (overlap_instants.py), which shares nothing with the gap functions: a contact
that the loop has lost is found by this.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point
from watchsim.mechanism.compile import Compiled
from watchsim.mechanism.overlap import chord_points, corner_depth, face_depth, material, placed, regions_depth
from watchsim.model import Records, records
from watchsim.scene.forces import Side
from watchsim.scene.scene import WHOLE_RUN, Scene, Window
from watchsim.simulation import MOREAU
from watchsim.simulation.overlap_sieve import PAIR, STRETCH, STRIDE, chosen_moves, instants_within, longest_moves, sieve
from watchsim.simulation.trajectory import frames
from watchsim.tolerances import OVERLAP_RESOLUTION, STEPPED_OVERLAP

# How is a layer written so that its overlap with another one is soon found?
#
# As chords; as stretches of them, each with a circle around it, for the sieve (overlap_sieve.py); and as the material within,
# for the polygons (overlap_instants.py). The last two also shrunk by a depth.

Array = NDArray[np.float64]

CHORDS = 32  # of a ring in one stretch, at most
LONGEST = 1.0 / 4.0  # of an outline's size: longer chords are divided, longer stretches cut


@dataclass(frozen=True, eq=False)
class Outlines:
    """One layer, or all of a body's, in the body's frame (m): rings around material with a word for holes, and open faces."""

    rings: tuple[tuple[Array, bool], ...]
    faces: tuple[Array, ...]
    centre: tuple[float, float]  # of a circle around everything
    radius: float
    smallest: float  # radius of a circle around its smallest outer ring

    @property
    def points(self) -> int:
        return sum(len(points) for points, _ in self.rings)

    def shrunk_rings(self, depth: float) -> list[tuple[Array, bool]]:
        """Its rings, `depth` further inside the material; corners stay sharp."""
        return [(_shifted(points, depth, closed=True), hole) for points, hole in self.rings]

    def shifted_faces(self, depth: float) -> list[Array]:
        """Its open faces, `depth` further inside their material."""
        return [_shifted(points, depth, closed=False) for points in self.faces]


@functools.lru_cache(maxsize=256)
def outlines_of(loops: tuple[Loop, ...], deviation: float) -> Outlines:
    """Outlines with chords no further than `deviation` (m) from their arcs."""
    drawn = [(chord_points(loop, deviation), loop) for loop in loops if loop.edges]
    rings = tuple((points, loop.hole) for points, loop in drawn if loop.closed)
    faces = tuple(points for points, loop in drawn if not loop.closed)
    every = np.concatenate([np.zeros((0, 2)), *(points for points, _ in rings), *faces])
    if not len(every):
        return Outlines(rings, faces, (0.0, 0.0), -np.inf, np.inf)
    smallest = min((_circle(points)[1] for points, hole in rings if not hole), default=np.inf)
    return Outlines(rings, faces, *_circle(every), smallest)


def _circle(points: Array) -> tuple[tuple[float, float], float]:
    """Centre and radius of a circle around points."""
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return (float(middle[0]), float(middle[1])), float(np.hypot(*(points - middle).T).max())


@functools.lru_cache(maxsize=256)
def stretches_of(outlines: Outlines, depth: float) -> tuple[Records, Array]:
    """The rings, shrunk by `depth`, in stretches of CHORDS chords (STRETCH), and the points (n, 2) that these join."""
    rings = outlines.shrunk_rings(depth) if depth > 0.0 else outlines.rings
    longest = LONGEST * outlines.radius
    parts, firsts, lasts, begins, begun = [np.zeros((0, 2))], [], [], [], 0
    for ring, hole in rings:
        points = _divided(ring, longest)
        chords = len(points) - 1
        way = np.cumsum(np.hypot(*np.diff(points, axis=0).T)) // longest
        first = np.flatnonzero((np.arange(chords) % CHORDS == 0) | np.append(False, way[1:] != way[:-1]))
        firsts.append(begun + first)
        lasts.append(begun + np.append(first[1:], chords))
        begins.append((first == 0) & (not hole))
        parts.append(points)
        begun += len(points)
    joined = np.concatenate(parts)
    out = records(STRETCH, sum(map(len, firsts)))
    if len(out):
        out.first, out.last, out.begins = (np.concatenate(values) for values in (firsts, lasts, begins))
        _put_circles(out, joined)
    return out, joined


def _put_circles(stretches: Records, points: Array) -> None:
    """Fill in the circles around stretches, and their longest chords."""
    ends = np.column_stack([stretches.first, stretches.last + 1]).ravel()  # each second range is of no stretch
    more = np.concatenate([points, points[-1:]])
    low, high = np.minimum.reduceat(more, ends)[::2], np.maximum.reduceat(more, ends)[::2]
    stretches.x, stretches.y = (0.5 * (low + high)).T
    stretches.radius = 0.5 * np.hypot(*(high - low).T)
    chords = np.append(np.hypot(*np.diff(points, axis=0).T), 0.0)
    stretches.half = 0.5 * np.maximum.reduceat(chords, ends - [0, 1] * len(stretches))[::2]


def _divided(points: Array, longest: float) -> Array:
    """The same chain, with points on its chords so that none is longer than `longest` (m): circles around them are smaller."""
    pieces = np.maximum(1, np.ceil(np.hypot(*np.diff(points, axis=0).T) / longest)).astype(np.int64)
    chord = np.repeat(np.arange(len(pieces)), pieces)
    share = (np.arange(len(chord)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[chord]
    return np.concatenate([points[chord] + share[:, None] * np.diff(points, axis=0)[chord], points[-1:]])


@functools.lru_cache(maxsize=256)
def shrunk_material(outlines: Outlines, depth: float) -> Any:
    """Their material, shrunk by `depth`, as one prepared geometry."""
    import shapely

    found = shapely.union_all(material(outlines.shrunk_rings(depth)))
    shapely.prepare(found)
    return found


def _shifted(points: Array, depth: float, closed: bool) -> Array:
    """The chain of chords, each moved by `depth` to its left, where the material is."""
    points = points[np.append(True, np.any(np.diff(points, axis=0) != 0.0, axis=1))]
    along = np.diff(points, axis=0)
    left = np.column_stack((-along[:, 1], along[:, 0])) / np.hypot(*along.T)[:, None]
    before, after = (left[-1:], left[:1]) if closed else (left[:1], left[-1:])
    one, two = np.concatenate([before, left]), np.concatenate([left, after])
    # Where the outline turns back on itself the corner of the shifted chords would lie nowhere.
    bend = np.maximum(1.0 + (one * two).sum(axis=1), 0.02)
    return points + depth * (one + two) / bend[:, None]


# Do two layers overlap at some of many instants, by more than a given depth?
#
# Both are polygons of chords. A compiled sieve lets pass what stays away (overlap_sieve.py); of the rest polygons judge: one
# layer is shrunk by that depth, and the other's outline must not reach into it. No gap function of a contact is asked. Points
# and poses are complex numbers: a pose is (place of the frame's origin, turn of unit size).

Complex = NDArray[np.complex128]
Poses = tuple[Complex, Complex]
Bits = NDArray[np.bool_]
Integers = NDArray[np.int64]

MARGIN = 0.5  # of the depth: how near the shrunk outline the other one is left to the polygons


class PairOfLayers:
    """The two sides of a declared contact."""

    def __init__(self, contact: int, sides: tuple[Side, Side], loops: tuple[tuple[Loop, ...], ...], chord: float):
        self.contact, self.sides, self._loops = contact, sides, loops
        self._outlines = [outlines_of(one, chord) for one in loops]
        # The larger side stays where it is.
        self._is_second = int(self._outlines[1].points > self._outlines[0].points)
        self.still, self.mover = self._outlines[self._is_second], self._outlines[1 - self._is_second]
        self.bodies = sides[self._is_second].body, sides[1 - self._is_second].body
        self.swallows = self.still.smallest <= self.mover.radius  # can the mover hold a ring of the other within?
        self.has_faces = bool(self.still.faces or self.mover.faces)

    def overlapping(self, still: Array, mover: Array, depth: float) -> Bits:
        """Whether they overlap by more than `depth` (m); `still` and `mover` (instants, 3): x, y (m), angle (rad)."""
        back = np.exp(-1j * still[:, 2])
        shift = (mover[:, 0] - still[:, 0] + 1j * (mover[:, 1] - still[:, 1])) * back
        seen = shift, np.exp(1j * mover[:, 2]) * back
        hit = _reaches_into(self.mover, shrunk_material(self.still, depth), seen)
        if self.swallows:
            hit |= _reaches_into(self.still, shrunk_material(self.mover, depth), _inverse(seen))
        if self.has_faces:
            hit |= self._behind(self._is_second, _inverse(seen), depth) | self._behind(1 - self._is_second, seen, depth)
        return hit

    def _behind(self, side: int, seen: Poses, depth: float) -> Bits:
        """Does something of the other side reach behind the open faces of this one, between their ends?"""
        import shapely

        hit = np.zeros(len(seen[0]), bool)
        whole = shrunk_material(self._outlines[1 - side], 0.0)
        for face in self._outlines[side].shifted_faces(depth):
            at = seen[1][:, None] * (face[:, 0] + 1j * face[:, 1]) + seen[0][:, None]
            lines, ends = shapely.linestrings(_real(at)), at[:, [0, -1]]
            for part in shapely.get_parts(whole):
                # What hangs over an end of the face has come round it.
                round_it = shapely.intersects_xy(part, ends.real, ends.imag).any(axis=1)
                hit |= shapely.intersects(part, lines) & ~round_it
            for other in self._outlines[1 - side].faces:
                met = shapely.intersection(shapely.LineString(other), lines)
                hit |= shapely.get_num_geometries(met) >= 2
        return hit

    def deepest(self, where: Sequence[Array]) -> tuple[float, Point]:
        """How deep they overlap (m), and where in the movement; `where` the two bodies are: x, y (m), angle (rad)."""
        import shapely

        regions, faces = [], []
        for outlines, loops, at in zip(self._outlines, self._loops, where, strict=True):
            x, y, angle = at.tolist()
            rings = [(placed(points, (x, y, angle)), hole) for points, hole in outlines.rings]
            regions.append(shapely.union_all(material(rings)))
            edges = [loop.moved(angle, (x, y)).edges for loop in loops if loop.edges and not loop.closed]
            faces.append([(placed(points, (x, y, angle)), own) for points, own in zip(outlines.faces, edges, strict=True)])
        found = [regions_depth(regions[0], regions[1], 0.0)]
        for one, other in ((0, 1), (1, 0)):
            shapes = [regions[other], *(shapely.LineString(points) for points, _ in faces[other])]
            found += [face_depth(points, edges, shape, 0.0) for points, edges in faces[one] for shape in shapes]
            found += [corner_depth(points, part) for points, _ in faces[one] for part in shapely.get_parts(regions[other])]
        return max(found)


class Layers:
    """All pairs of layers of a scene."""

    def __init__(self, pairs: tuple[PairOfLayers, ...]) -> None:
        self.pairs = pairs
        self.bodies = sorted({side.body for pair in pairs for side in pair.sides})
        self._sieve: tuple[float, Records, Records, Array] | None = None  # depth, pairs, stretches, points
        self._room = np.zeros((CHORDS + 1, 2))

    def overlapping(self, where: Array, depth: float) -> Bits:
        """(pairs, instants): do they overlap by more than `depth` (m)?

        `where` (bodies, instants, 3): x, y (m) and angle (rad) of `bodies`.
        """
        if self._sieve is None or self._sieve[0] != depth:
            self._sieve = depth, *self._records(depth)
        found = np.zeros((len(self.pairs), where.shape[1]), bool)
        sieve(*self._sieve[1:], np.ascontiguousarray(where), MARGIN * depth, self._room, found)
        if found.any():
            for pair, left in zip(self.pairs, found, strict=True):
                still, mover = (where[self.bodies.index(body)][left] for body in pair.bodies)
                left[left] = pair.overlapping(still, mover, depth)
        return found

    def _records(self, depth: float) -> tuple[Records, Records, Array]:
        """What the sieve reads: pairs, stretches and points."""
        rows = records(PAIR, len(self.pairs))
        stretches, points = [records(STRETCH, 0)], [np.zeros((0, 2))]
        for row, pair in zip(rows, self.pairs, strict=True):
            row.still, row.mover = (self.bodies.index(body) for body in pair.bodies)
            (row.still_x, row.still_y), (row.mover_x, row.mover_y) = pair.still.centre, pair.mover.centre
            row.still_radius, row.mover_radius = pair.still.radius, pair.mover.radius
            row.swallows, row.open = pair.swallows, pair.has_faces
            for name, (some, joined) in (("still", stretches_of(pair.still, depth)), ("mover", stretches_of(pair.mover, 0.0))):
                first, before = sum(len(part) for part in stretches), sum(len(part) for part in points)
                row[f"{name}_first"], row[f"{name}_stop"] = first, first + len(some)
                moved = some.copy()
                moved.first += before
                moved.last += before
                stretches.append(moved)
                points.append(joined)
        return rows, np.concatenate(stretches).view(np.recarray), np.concatenate(points)


def _reaches_into(outlines: Outlines, shrunk: Any, seen: Poses) -> Bits:
    """Does a ring reach into some material, or lie within? `seen`: where its frame stands in the frame of the material."""
    import shapely

    hit = np.zeros(len(seen[0]), bool)
    for ring, hole in outlines.rings:
        at = seen[1][:, None] * (ring[:, 0] + 1j * ring[:, 1]) + seen[0][:, None]
        hit |= shapely.intersects(shrunk, shapely.linestrings(_real(at)))
        if not hole:
            # What nothing crosses lies wholly within where one of its points does.
            hit |= shapely.intersects_xy(shrunk, at[:, 0].real, at[:, 0].imag)
    return hit


def _inverse(seen: Poses) -> Poses:
    """Where the first frame stands in the second one."""
    shift, twist = seen
    back = twist.conj()
    return -shift * back, back


def _real(points: Complex) -> Array:
    """Points as (…, 2) coordinates."""
    return np.ascontiguousarray(points).view(np.float64).reshape(*points.shape, 2)


_last: list[tuple[Any, float, Layers]] = []  # the scene looked at last, which most often is the next one


def declared_pairs(scene: Any, chord: float) -> Layers:
    """The two sides of every declared contact whose bodies can move against each other."""
    if not _last or _last[0][0] is not scene or _last[0][1] != chord:
        _last[:] = [(scene, chord, Layers(tuple(_pairs(scene, chord))))]
    return _last[0][2]


def _pairs(scene: Any, chord: float) -> Iterator[PairOfLayers]:
    for number, contact in enumerate(scene.contacts):
        bodies = [scene.body(side.body) for side in contact.sides]
        loops = tuple(
            tuple(loop for loop in body.loops if side.layer in (None, loop.layer))
            for body, side in zip(bodies, contact.sides, strict=True)
        )
        if all(loops):
            yield PairOfLayers(number, contact.sides, loops, chord)


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
        # Twice as far apart whenever the time has doubled since the end of the scene's duration.
        doublings = max(math.frexp(t / self._scene.duration)[1] - 1, 0)
        spacing = math.ldexp(self._scene.duration / LOOKS, doublings)
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
        if not (waiting or states):
            return
        if self._layers is None:
            self._layers = declared_pairs(self._scene, CHORD * self.resolution)
        if not self._layers.pairs:
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
