"""Which primitives of two bodies could touch while their coordinates stay near given ones?

Shapely answers, in two steps: for a whole block of cells, the primitives of one body against a tree of the other's, within
the distance that any point can travel in the block; then, cell by cell, the pairs found so, within the distance that any point
can travel in the cell. Errs only on the side of too many.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.asymmetric_contacts import LooseContacts
from watchsim.candidates.cell_lookup import MARGIN
from watchsim.candidates.cell_motion import CellMotion, turned
from watchsim.candidates.chords import Chords, chords
from watchsim.candidates.named_rows import named_rows
from watchsim.candidates.normal_fans import Regions
from watchsim.model.records import Model
from watchsim.tolerances import PLANE_ROUNDING

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def load_shapely() -> None:
    """Import the library, which takes a twentieth of a second once in a process."""
    import shapely  # noqa: F401


class PairSearch:
    """The primitives of one pair of bodies as shapely geometries, and the motion that a cell allows."""

    def __init__(self, model: Model, p: int, loose: Integers) -> None:
        """`loose`: primitives of either body that do not share the symmetry of its cells."""
        pair = model.pairs[p]
        self._motion, self._clearance = CellMotion(model.bodies, pair), float(pair.clearance)
        self._regions = Regions(model, p)
        ids = model.near[pair.near_start : pair.near_stop]
        circle, met = model.contacts.a[ids], model.contacts.b[ids]
        a_first = (model.primitives.body == pair.a)[circle]
        on_a, on_b = np.where(a_first, circle, met), np.where(a_first, met, circle)
        is_loose = np.zeros(len(model.primitives), bool)
        is_loose[loose] = True
        loose_a, loose_b = is_loose[on_a], is_loose[on_b]
        local = ids - pair.start
        self._always = local[loose_a & loose_b]
        self._loose = [
            LooseContacts(model, p, local[only], one[only], other[only])
            for only, one, other in ((loose_a & ~loose_b, on_a, on_b), (loose_b & ~loose_a, on_b, on_a))
            if only.any()
        ]
        alike = ~(loose_a | loose_b)
        sides = [(int(pair.a), on_a[alike]), (int(pair.b), on_b[alike])]
        # The side with fewer primitives is moved, the other one stays in the tree.
        sides.sort(key=lambda side: len(named_rows(side[1], len(model.primitives))[0]))
        self._set_shapes(model, sides, local[alike])

    def _set_shapes(self, model: Model, sides: list[tuple[int, Integers]], local: Integers) -> None:
        """The primitives of the contacts `local`; `sides`: the body that is moved and the other, and their primitives."""
        import shapely

        self._bodies = [body for body, _ in sides]
        movers, mover_row = named_rows(sides[0][1], len(model.primitives))
        others, other_row = named_rows(sides[1][1], len(model.primitives))
        # Several contacts share a pair of primitives where several groups name it.
        wanted = mover_row * len(others) + other_row
        order = np.argsort(wanted, kind="stable")
        self._others, self._wanted, self._local = len(others), wanted[order], local[order]
        self._drawn = chords(model.primitives[movers], 0.5 * self._clearance)
        self._owner = self._drawn.owner
        still = chords(model.primitives[others], 0.5 * self._clearance)
        self._still_sag = still.sag
        self._reach = _largest(np.hypot(*self._drawn.points.T), self._drawn.first) + self._drawn.sag
        self._still = _shapes(still.points, still.first)
        shapely.prepare(self._still)
        (self._still_centre,), (self._still_radius,) = _circles(still.points[None], still.first)
        self._tree = shapely.STRtree(self._still)

    def candidates(self, index: Integers) -> tuple[Integers, Integers]:
        """Candidates of the cells with these indices, (cells, axes): how many each has, and all of them, ascending by cell.

        Candidates are numbered from the pair's first contact.
        """
        at, room = (index + 0.5) * self._motion.sizes, (0.5 + MARGIN) * self._motion.sizes
        found = [self._alike(at, room), *(loose.candidates(at, room) for loose in self._loose)]
        found.append((np.repeat(np.arange(len(at)), len(self._always)), np.tile(self._always, len(at))))
        cell, local = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return np.bincount(cell, minlength=len(at)), local[np.lexsort((local, cell))]

    def _alike(self, at: Array, room: Array) -> tuple[Integers, Integers]:
        """(cells, contacts) that could touch within `room` of the cells' centres `at`, but for the loose ones."""
        import shapely

        low, high = at.min(axis=0), at.max(axis=0)
        mover, other = self._in_block(0.5 * (low + high), 0.5 * (high - low) + room)
        used, row = np.unique(mover, return_inverse=True)
        if len(used) == 0:
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        points, distance = self._seen(at, room, used)
        first, cells = _firsts(self._drawn, used), len(at)
        within = (distance[:, row] + self._still_sag[other]) * (1.0 + PLANE_ROUNDING)
        # Most are far apart, which circles around them tell sooner.
        cell, place = np.nonzero(self._circles_near(points, first, row, other, within))
        every = np.append((first[:-1] + points.shape[1] * np.arange(cells)[:, None]).ravel(), points.shape[0] * points.shape[1])
        shapes = _shapes(points.reshape(-1, 2), every).reshape(cells, len(used))
        near = shapely.dwithin(self._still[other[place]], shapes[cell, row[place]], within[cell, place])
        cell, place = cell[near], place[near]
        wanted = mover[place] * self._others + other[place]
        left = np.searchsorted(self._wanted, wanted, side="left")
        several = np.searchsorted(self._wanted, wanted, side="right") - left
        nth = np.arange(several.sum()) - np.repeat(np.cumsum(several) - several, several)
        cell, local = np.repeat(cell, several), self._local[np.repeat(left, several) + nth]
        possible = self._regions.possible(cell, local, at, room)
        return cell[possible], local[possible]

    def _circles_near(self, points: Array, first: Integers, row: Integers, other: Integers, within: Array) -> NDArray[np.bool_]:
        """(places, pairs): come the circles around mover `row` and still primitive `other` as near as `within`?"""
        centre, radius = _circles(points, first)
        apart = np.abs(centre[:, row] - self._still_centre[other])
        return apart * (1.0 - PLANE_ROUNDING) <= within + radius[:, row] + self._still_radius[other]

    def _in_block(self, centre: Array, room: Array) -> tuple[Integers, Integers]:
        """Pairs (row of mover, row of other) that could touch within `room` of `centre` along each axis."""
        if len(self._wanted) == 0:
            return self._wanted, self._wanted
        points, distance = self._seen(centre[None, :], room, np.arange(len(self._reach)))
        shapes = _shapes(points[0], self._drawn.first)
        within = (distance[0] + self._still_sag.max()) * (1.0 + PLANE_ROUNDING)
        mover, other = self._tree.query(shapes, predicate="dwithin", distance=within)
        wanted = mover * self._others + other
        declared = self._wanted[np.minimum(np.searchsorted(self._wanted, wanted), len(self._wanted) - 1)] == wanted
        return mover[declared], other[declared]

    def _seen(self, at: Array, room: Array, used: Integers) -> tuple[Array, Array]:
        """Points of movers `used` in the other body's frame, (places, points, 2), and how near others count, (places, movers).

        `at`: cell coordinates (places, axes); `room`: how far each may change.
        """
        local, first = self._drawn.points, self._drawn.first
        if len(used) < len(self._reach):
            is_used = np.zeros(len(self._reach), bool)
            is_used[used] = True
            local, first = local[is_used[self._owner]], _firsts(self._drawn, used)
        (ax, ay, turn_a), (bx, by, turn_b) = (self._motion.pose(body, at) for body in self._bodies)
        world = turned(local[None], turn_a) + np.stack([ax - bx, ay - by], axis=1)[:, None, :]
        points = turned(world, -turn_b)
        (shift, swing), (shift_b, swing_b) = (self._motion.freedom(body, room) for body in self._bodies)
        travel, sag = shift + swing * self._reach[used], self._drawn.sag[used]
        arm = _largest(np.hypot(points[..., 0], points[..., 1]), first) + sag
        return points, travel + shift_b + swing_b * (arm + travel) + sag + self._clearance


def _largest(values: Array, first: Integers) -> Array:
    """The largest value of each primitive's points, (..., points)."""
    return np.maximum.reduceat(values, first[:-1], axis=-1) if len(first) > 1 else values


def _circles(points: Array, first: Integers) -> tuple[NDArray[np.complex128], Array]:
    """Centres and radii (places, primitives) of circles around each primitive's points, (places, points, 2)."""
    low, high = (extreme.reduceat(points, first[:-1], axis=1) for extreme in (np.minimum, np.maximum))
    half = 0.5 * (high - low)
    return 0.5 * ((low + high) @ (1.0, 1.0j)), np.hypot(half[..., 0], half[..., 1])


def _firsts(drawn: Chords, used: Integers) -> Integers:
    """Where the points of each of some primitives begin once only theirs are kept; the last entry is their number."""
    return np.concatenate([[0], np.cumsum(np.diff(drawn.first)[used])])


def _shapes(points: Array, first: Integers) -> Any:
    """Shapely geometries of points[first[i] : first[i + 1]]: a point, or a line through them."""
    import shapely

    count = np.diff(first)
    out = np.empty(len(count), object)
    out[count == 1] = shapely.points(points[first[:-1][count == 1]])
    long = count > 1
    if long.any():
        keep = np.repeat(long, count)
        out[long] = shapely.linestrings(points[keep], indices=np.repeat(np.arange(np.count_nonzero(long)), count[long]))
    return out
