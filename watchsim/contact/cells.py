"""Which pairs of primitives could touch while two bodies stay in one cell of their configuration space?

Shapely answers, once per cell: the primitives of one body, in the frame of the other as seen from the middle of the
cell, against a tree of the other's, within the distance that any point can travel in the cell. The answer errs only on
the side of too many. Neighbouring cells are asked about together, since they will be entered next.
"""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.lookup import MARGIN, cell_key, find_slot
from watchsim.mechanism.model import CORNER, FREE, LINE, PIVOT, SLIDE, WIDE, Cells, Model

Array = NDArray[np.float64]
POINT = 1e-9  # m; a corner as a line this long, since shapely finds no distance to a line of no length
ARC_PIECES = 24  # straight pieces that stand for an arc
AROUND = {1: 12, 2: 3, 3: 1}  # cells asked about together, to each side, by number of axes


class CellFinder:
    """Knows, for one model, the candidate contacts of every cell asked about so far."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.seconds = 0.0
        self._pairs = [_PairGeometry(model, p) if model.pairs[p].axes else None for p in range(len(model.pairs))]
        self._known: dict[int, NDArray[np.int64]] = {}
        self.cells = _empty(64, 256)
        self._entries = 0

    def learn(self, p: int, q: Array) -> Cells:
        """Find the cell of body pair p at q and its neighbours; returns the new table."""
        import time

        start = time.perf_counter()
        pair = self.model.pairs[p]
        new: dict[int, Array] = {}
        for steps in itertools.product(range(-AROUND[pair.axes], AROUND[pair.axes] + 1), repeat=int(pair.axes)):
            centre = self._centre(pair, q, steps)
            key = int(cell_key(self.model, p, centre))
            if key >= 0 and key not in self._known:
                new.setdefault(key, centre)
        geometry = self._pairs[p]
        assert geometry is not None
        for key, found in zip(new, geometry.candidates(list(new.values())), strict=True):
            self._known[key] = found
            self._insert(key, found)
        self.seconds += time.perf_counter() - start
        return self.cells

    def _insert(self, key: int, found: NDArray[np.int64]) -> None:
        """Put one cell's answer into the table, which grows so that it is never more than half full."""
        keys, start, count, entries = self.cells
        if 2 * len(self._known) > len(keys):
            grown = _empty(2 * len(keys), 1)
            for slot in np.flatnonzero(keys >= 0):
                place = find_slot(grown.keys, keys[slot])
                grown.keys[place], grown.start[place], grown.count[place] = keys[slot], start[slot], count[slot]
            keys, start, count = grown.keys, grown.start, grown.count
        if self._entries + len(found) > len(entries):
            entries = np.concatenate([entries, np.zeros(len(entries) + len(found), np.int64)])
        slot = find_slot(keys, key)
        keys[slot], start[slot], count[slot] = key, self._entries, len(found)
        entries[self._entries : self._entries + len(found)] = found
        self._entries += len(found)
        self.cells = Cells(keys, start, count, entries)

    @staticmethod
    def _centre(pair: Any, q: Array, steps: tuple[int, ...]) -> Array:
        """Coordinates at the centre of the cell that lies `steps` cells from the one of q."""
        centre = q.copy()
        for axis, step in enumerate(steps):
            i, size = pair[f"c{axis}"], pair[f"size{axis}"]
            centre[i] = (math.floor(q[i] / size) + step + 0.5) * size
        return centre


def _empty(slots: int, entries: int) -> Cells:
    """An open-addressing table without cells."""
    return Cells(np.full(slots, -1, np.int64), *(np.zeros(size, np.int64) for size in (slots, slots, entries)))


class _PairGeometry:
    """The primitives of one pair of bodies as shapely geometries, and the motion a cell allows."""

    def __init__(self, model: Model, p: int) -> None:
        import shapely

        self.model, self.pair = model, model.pairs[p]
        contacts = model.contacts[self.pair.start : self.pair.stop]
        bodies = model.primitives.body
        a_first = bodies[contacts.a] == self.pair.a
        on_a, on_b = np.where(a_first, contacts.a, contacts.b), np.where(a_first, contacts.b, contacts.a)
        self.movers, mover_row = np.unique(on_a, return_inverse=True)
        self.others, other_row = np.unique(on_b, return_inverse=True)
        # Up to two contacts share a pair of primitives only if two groups name them; each keeps its own table.
        order = np.lexsort((np.arange(len(contacts)), other_row, mover_row))
        self.sorted_pairs = mover_row[order] * len(self.others) + other_row[order]
        self.sorted_ids = self.pair.start + order
        self.points = [primitive_points(model.primitives[i]) for i in self.movers]
        self.reach = np.array([np.hypot(*points.T).max() for points, _ in self.points])
        self.sag = np.array([sag for _, sag in self.points])
        other_points = [primitive_points(model.primitives[i]) for i in self.others]
        self.other_sag = max((sag for _, sag in other_points), default=0.0)
        self.tree = shapely.STRtree([_geometry(points) for points, _ in other_points])
        self.coordinates = np.concatenate([points for points, _ in self.points])
        # Plain values: reading a field of a record array from Python takes a microsecond each time.
        self.bodies = [_Body(*model.bodies[b].tolist()[: len(_Body._fields)]) for b in (self.pair.a, self.pair.b)]
        self.freedom = [self._freedom(b) for b in (self.pair.a, self.pair.b)]
        self.piece = np.repeat(np.arange(len(self.points)), [len(points) for points, _ in self.points])

    def candidates(self, centres: list[Array]) -> list[NDArray[np.int64]]:
        """Candidate contacts of the cells with these centres (coordinate vectors)."""
        import shapely

        if not centres:
            return []
        count = len(self.movers)
        moved = [self._in_other_frame(q) for q in centres]
        lines = shapely.linestrings(
            np.concatenate([points for points, _ in moved]),
            indices=np.concatenate([self.piece + cell * count for cell in range(len(centres))]),
        )
        distance = np.concatenate([travel for _, travel in moved]) + np.tile(self.sag, len(centres)) + self.other_sag
        found, other = self.tree.query(lines, predicate="dwithin", distance=distance * (1.0 + 1e-9))
        cell, mover = found // count, found % count
        return [self._ids(mover[cell == i], other[cell == i]) for i in range(len(centres))]

    def _ids(self, mover: NDArray[np.int64], other: NDArray[np.int64]) -> NDArray[np.int64]:
        """Contacts between these primitives, ascending."""
        wanted = mover * len(self.others) + other
        left = np.searchsorted(self.sorted_pairs, wanted, side="left")
        right = np.searchsorted(self.sorted_pairs, wanted, side="right")
        rows = [self.sorted_ids[i:j] for i, j in zip(left, right, strict=True) if j > i]
        return np.sort(np.concatenate(rows)) if rows else np.zeros(0, np.int64)

    def _in_other_frame(self, q: Array) -> tuple[Array, Array]:
        """Points of body a's primitives in body b's frame, and how far each primitive may move relative to b in the cell."""
        (ax, ay, angle), (bx, by, turn) = (_pose(body, q) for body in self.bodies)
        world = _turned(self.coordinates, angle) + np.array((ax - bx, ay - by))
        points = _turned(world, -turn)
        shift_a, swing_a = self.freedom[0]
        shift_b, swing_b = self.freedom[1]
        travel = shift_a + swing_a * self.reach
        arm = np.zeros(len(self.movers))
        np.maximum.at(arm, self.piece, np.hypot(*points.T))
        return points, travel + shift_b + swing_b * (arm + travel)

    def _freedom(self, b: int) -> tuple[float, float]:
        """How far body b's origin may move, and turn, from the cell's centre within the cell and its margin."""
        body, shift, swing = self.model.bodies[b], 0.0, 0.0
        for axis in range(self.pair.axes):
            offset = self.pair[f"c{axis}"] - body.first
            room = (0.5 + MARGIN) * self.pair[f"size{axis}"]
            if (body.motion == PIVOT and offset == 0) or (body.motion == FREE and offset == 2):
                swing += room
            elif (body.motion == SLIDE and offset == 0) or (body.motion == FREE and offset in (0, 1)):
                shift += room
        return shift, swing


class _Body(NamedTuple):
    """The fields of a body record (model.py)."""

    motion: int
    first: int
    x: float
    y: float
    angle: float
    axis_x: float
    axis_y: float


def _pose(body: _Body, q: Array) -> tuple[float, float, float]:
    if body.motion == PIVOT:
        return body.x, body.y, q[body.first]
    if body.motion == SLIDE:
        return body.x + q[body.first] * body.axis_x, body.y + q[body.first] * body.axis_y, body.angle
    if body.motion == FREE:
        return q[body.first], q[body.first + 1], q[body.first + 2]
    return body.x, body.y, body.angle


def _turned(points: Array, angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def primitive_points(primitive: Any) -> tuple[Array, float]:
    """Points along a primitive (at least two, for shapely) and how far the true curve may lie from the line through them."""
    x, y = primitive.x, primitive.y
    if primitive.kind == CORNER:
        return np.array([(x, y), (x + POINT, y)]), POINT
    if primitive.kind == LINE:
        end = (x + primitive.length * primitive.tx, y + primitive.length * primitive.ty)
        return np.array([(x, y), end]), 0.0
    first = math.atan2(primitive.e0y, primitive.e0x)
    sweep = (math.atan2(primitive.e1y, primitive.e1x) - first) % (2.0 * math.pi)
    if primitive.extent > WIDE or (sweep == 0.0 and primitive.extent == WIDE):
        sweep = 2.0 * math.pi
    angles = first + sweep * np.linspace(0.0, 1.0, ARC_PIECES + 1)
    sag = primitive.radius * (1.0 - math.cos(0.5 * sweep / ARC_PIECES))
    return np.stack([x + primitive.radius * np.cos(angles), y + primitive.radius * np.sin(angles)], axis=1), sag


def _geometry(points: Array) -> Any:
    import shapely

    return shapely.LineString(points)
