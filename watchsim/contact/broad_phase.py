"""Which primitives of two bodies could touch while their coordinates stay near given ones?

Shapely answers, in two steps: for a whole block of cells, the primitives of one body against a tree of the other's, within
the distance that any point can travel in the block; then, cell by cell, the pairs found so, within the distance that any point
can travel in the cell. Errs only on the side of too many.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cell_frames import CellMotion, Chords, chords, named_rows, seen_from, turned
from watchsim.contact.cell_lookup import MARGIN
from watchsim.model import FIXED, FULL, LINE, PIVOT, SLIDE, Model, Records
from watchsim.tolerances import PLACE_ROUNDING, PLANE_ROUNDING

# Which pairs of primitives that come near each other could touch inside both of them?
#
# A contact lies where the normal falls into the fans of both primitives and onto their lengths. The many short pieces of a
# fine outline that lie near a corner are distinguished by that: the centre of the circle is opposite few of them. Errs only on
# the side of too many.

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class _Pieces(NamedTuple):
    """What counts of primitives, a column each: to pick rows of whole records takes longer than all that is done with them."""

    x: Array
    y: Array
    radius: Array
    nx: Array
    ny: Array
    tx: Array
    ty: Array
    side: Array
    length: Array
    kind: Array
    fan: Array

    def at(self, rows: Integers) -> _Pieces:
        return _Pieces._make([column[rows] for column in self])


def _pieces(primitives: Records, clearance: float) -> _Pieces:
    columns = [np.array(primitives[name], float) for name in _Pieces._fields[:-1]]
    return _Pieces._make([*columns, _fan(primitives, clearance)])


class Regions:
    """The contacts of one pair of bodies, and where they can lie."""

    def __init__(self, model: Model, p: int) -> None:
        pair = model.pairs[p]
        self._motion, self._clearance = CellMotion(model.bodies, pair), float(pair.clearance)
        self._bodies = (int(pair.a), int(pair.b))
        contacts = model.contacts[pair.start : pair.stop]
        self._circle, self._met = np.array(contacts.a), np.array(contacts.b)
        self._pieces = _pieces(model.primitives, self._clearance)
        self._is_first = np.asarray(model.primitives.body == pair.a)

    def possible(self, place: Integers, contact: Integers, at: Array, room: Array) -> NDArray[np.bool_]:
        """For each pair of numbers of `place` and `contact`: could it lie inside both primitives within `room` of at[place]?

        Contacts are numbered from the pair's first; `at` (places, axes) and `room` (axes) are cell coordinates.
        """
        keep = np.zeros(len(place), bool)
        for order in (False, True):
            rows = np.flatnonzero(self._is_first[self._circle[contact]] == order)
            if not len(rows):
                continue
            bodies = self._bodies if order else self._bodies[::-1]
            keep[rows] = self._possible(bodies, place[rows], contact[rows], at, room)
        return keep

    def _possible(self, bodies: tuple[int, int], place: Integers, contact: Integers, at: Array, room: Array) -> Any:
        """The same for contacts whose circle is on the first of `bodies`."""
        (ax, ay, turn_a), (bx, by, turn_b) = (tuple(v[place] for v in self._motion.pose(body, at)) for body in bodies)
        (shift_a, swing_a), (shift_b, swing_b) = (self._motion.freedom(body, room) for body in bodies)
        circle, met = self._pieces.at(self._circle[contact]), self._pieces.at(self._met[contact])
        # The circle's centre in the frame of the body that it meets, and how far it may be from there.
        x, y = _turned(circle.x, circle.y, turn_a)
        x, y = _turned(ax + x - bx, ay + y - by, -turn_b)
        arm, far = np.hypot(circle.x, circle.y), np.hypot(x, y)
        travel = shift_a + swing_a * arm
        travel = travel + shift_b + swing_b * (far + travel) + self._clearance
        travel = travel + PLACE_ROUNDING * (arm + far + circle.radius + met.radius)
        dx, dy = x - met.x, y - met.y
        straight = met.kind == LINE
        along = dx * met.tx + dy * met.ty
        distance = np.hypot(dx, dy)
        gap = np.where(straight, dx * met.nx + dy * met.ny, met.side * (distance - met.radius)) - circle.radius
        onto = ~straight | ((along >= -travel) & (along <= met.length + travel))
        # Along the outward normal of what is met; by how much its direction may change.
        nx, ny = (np.where(straight, n, met.side * d) for n, d in ((met.nx, dx), (met.ny, dy)))
        turn = np.arcsin(travel / np.maximum(travel, distance))
        swing = np.where(straight, 0.0, np.where(travel < distance, turn, np.pi))
        onto &= straight | (_angle(nx, ny, met.nx, met.ny) <= met.fan + swing)
        mx, my = _turned(-nx, -ny, turn_b - turn_a)
        inside = _angle(mx, my, circle.nx, circle.ny) <= circle.fan + swing + swing_a + swing_b
        return (gap <= travel) & onto & inside


def _turned(x: Array, y: Array, angle: Array) -> tuple[Array, Array]:
    c, s = np.cos(angle), np.sin(angle)
    return c * x - s * y, s * x + c * y


def _angle(x: Array, y: Array, nx: Array, ny: Array) -> Array:
    """Between two directions, rad, from 0 to pi."""
    return np.abs(np.arctan2(nx * y - ny * x, nx * x + ny * y))


def _fan(rows: Records, clearance: float) -> Array:
    """How far from its middle normal a contact may lie on each arc or corner, rad; a little beyond the ends still counts."""
    reach = np.maximum(rows.radius, rows.length)
    beyond = clearance / np.where(reach > 0.0, reach, clearance / np.pi)
    return np.where(rows.extent == FULL, np.pi, np.arctan2(rows.half_sin, rows.half_cos)) + beyond


# Which contacts of primitives that do not share a symmetry could touch in a cell, whatever part of the turn it stands for?
#
# Such a primitive counts as being everywhere on the ring that it sweeps about its body's origin.


class LooseContacts:
    """Contacts `ids` between loose primitives of one body and primitives of another that share its symmetry, or need none."""

    def __init__(self, model: Model, p: int, ids: Integers, loose: Integers, partner: Integers) -> None:
        """`loose`, `partner`: the two primitives of each contact."""
        pair, self._ids = model.pairs[p], ids
        self._motion, self._clearance = CellMotion(model.bodies, pair), float(pair.clearance)
        rings, self._ring = np.unique(loose, return_inverse=True)
        partners, self._partner = np.unique(partner, return_inverse=True)
        drawn = chords(model.primitives[rings], self._clearance)
        self._low, self._high = _range(np.hypot(*drawn.points.T), drawn.points[None], drawn.first, drawn.sag)
        self._drawn = chords(model.primitives[partners], self._clearance)
        self._reach = np.maximum.reduceat(np.hypot(*self._drawn.points.T), self._drawn.first[:-1]) + self._drawn.sag
        bodies = model.primitives.body
        self._turning, self._other = int(bodies[rings[0]]), int(bodies[partners[0]])

    def candidates(self, at: Array, room: Array) -> tuple[Integers, Integers]:
        """(places, contacts) that could touch when cell coordinates are within `room` of `at`, (places, axes)."""
        (ox, oy, _), (x, y, angle) = (self._motion.pose(body, at) for body in (self._turning, self._other))
        points = turned(self._drawn.points[None], angle) + np.stack([x - ox, y - oy], axis=1)[:, None, :]
        low, high = _range(np.hypot(points[..., 0], points[..., 1]), points, self._drawn.first, self._drawn.sag)
        shift, swing = self._motion.freedom(self._other, room)
        travel = shift + swing * self._reach + self._motion.freedom(self._turning, room)[0] + self._clearance
        low, high = (low - travel)[:, self._partner], (high + travel)[:, self._partner]
        place, found = np.nonzero((low <= self._high[..., self._ring]) & (self._low[..., self._ring] <= high))
        return place, self._ids[found]


def _range(distance: Array, points: Array, first: Integers, sag: Array) -> tuple[Array, Array]:
    """Bounds of the distance from the origin over each primitive, of whose points it is `distance`, (..., points)."""
    # A chord of length L between points at distances a and b comes no closer than (a + b - L)/2.
    length = np.hypot(*np.moveaxis(np.diff(points, axis=-2), -1, 0))
    inner = 0.5 * (distance[..., :-1] + distance[..., 1:] - length.reshape(distance[..., 1:].shape))
    inner = np.concatenate([inner, distance[..., -1:]], axis=-1)
    inner[..., first[1:] - 1] = distance[..., first[1:] - 1]
    low = np.minimum.reduceat(inner, first[:-1], axis=-1) - sag
    return np.maximum(low, 0.0), np.maximum.reduceat(distance, first[:-1], axis=-1) + sag


# Which declared pairs of primitives can ever touch?
#
# A primitive that turns about a pivot stays within a ring, one that slides within a strip. Pairs whose rings and strips keep
# apart never touch, whatever the bodies do; of a free body nothing is known. Errs only on the side of too many.


class _Span(NamedTuple):
    """Least and largest value over each of some primitives, m."""

    low: Array
    high: Array

    def of(self, rows: NDArray[np.int64]) -> _Span:
        return _Span(self.low[rows], self.high[rows])

    def meets(self, other: _Span) -> NDArray[np.bool_]:
        return np.asarray((self.low <= other.high) & (other.low <= self.high))


Meeting = Callable[[Integers, Integers], NDArray[np.bool_]]
Drawn = dict[tuple[bytes, float], Chords]  # of the primitives in those rows, that closely


def reachable(bodies: Records, primitives: Records, contacts: Records, pair: Any, drawn: Drawn) -> NDArray[np.bool_]:
    """For each contact of one pair of bodies: can its primitives come within the pair's clearance at any pose?

    `drawn` holds what was drawn for other pairs: each body meets many.
    """
    part = contacts[pair.start : pair.stop]
    part_a, part_b = np.array(part.a), np.array(part.b)
    a_first = (primitives.body == pair.a)[part_a]
    on_a, row_a = named_rows(np.where(a_first, part_a, part_b), len(primitives))
    on_b, row_b = named_rows(np.where(a_first, part_b, part_a), len(primitives))
    return reach(bodies, primitives, pair, (on_a, on_b), float(pair.clearance), drawn)(row_a, row_b)


def reach(
    bodies: Records, primitives: Records, pair: Any, rows: tuple[Integers, Integers], clearance: float, drawn: Drawn
) -> Meeting:
    """Can primitives of body a and of body b of a pair come so near each other at any pose?

    `rows`: which primitives of a and which of b; asked by their places in these, arrays that are broadcast.
    """
    a, b = (seen_from(bodies, int(number), int(pair.frame)) for number in (pair.a, pair.b))
    if any(body.carrier >= 0 and bodies[body.carrier].motion != PIVOT for body in (a, b)):
        return _always
    one, two = (_drawn(primitives, part, 0.5 * float(pair.clearance), drawn) for part in rows)
    if a.motion != PIVOT and (b.motion == PIVOT or a.motion == FIXED):
        other_way = _meeting(bodies, b, a, two, one, clearance)
        return lambda i, j: other_way(j, i)
    return _meeting(bodies, a, b, one, two, clearance)


def _always(i: Integers, j: Integers) -> NDArray[np.bool_]:
    return np.ones(np.broadcast(i, j).shape, bool)


def _meeting(bodies: Records, a: Any, b: Any, one: Chords, two: Chords, room: float) -> Meeting:
    """The same of two bodies as they are seen, of which a turns if either does."""
    centre_a, centre_b = _centre(bodies, a), _centre(bodies, b)
    if a.motion == PIVOT and b.motion == PIVOT:
        return _rings_meet(_ring(a, one, room), _ring(b, two, 0.0), math.dist(centre_a, centre_b))
    if a.motion == PIVOT and b.motion == FIXED:
        fixed = _away(two, _world(b, two.points) - centre_a, 0.0)
        return _spans_meet(_ring(a, one, room), fixed)
    if a.motion == PIVOT and b.motion == SLIDE:
        strip = _across(two, _world(b, two.points) - centre_a, b, 0.0)
        far = _ring(a, one, room).high
        return _spans_meet(_Span(-far, far), strip)
    if a.motion == SLIDE and (b.motion == FIXED or (b.motion == SLIDE and _parallel(a, b))):
        return _spans_meet(_across(one, _world(a, one.points), a, room), _across(two, _world(b, two.points), a, 0.0))
    return _always


def _spans_meet(one: _Span, two: _Span) -> Meeting:
    return lambda i, j: one.of(i).meets(two.of(j))


def _rings_meet(one: _Span, two: _Span, distance: float) -> Meeting:
    """Two rings whose centres are this far apart have a point in common."""

    def meet(i: Integers, j: Integers) -> NDArray[np.bool_]:
        a, b = one.of(i), two.of(j)
        apart = (distance > a.high + b.high) | (a.low > distance + b.high)
        return np.asarray(~(apart | (b.low > distance + a.high)))

    return meet


def _drawn(primitives: Records, rows: NDArray[np.int64], sag: float, drawn: Drawn) -> Chords:
    key = rows.tobytes(), sag
    if key not in drawn:
        drawn[key] = chords(primitives[rows], sag)
    return drawn[key]


def _centre(bodies: Records, body: Any) -> tuple[float, float]:
    """About which point a pivoted body, or its carrier, turns."""
    turning = bodies[body.carrier] if body.carrier >= 0 else body
    return float(turning.x), float(turning.y)


def _ring(body: Any, drawn: Chords, room: float) -> _Span:
    """Distances of a pivoted body's primitives from that point, widened by `room`, at any angles."""
    own = _away(drawn, drawn.points, room)
    if body.carrier < 0:
        return own
    arm = math.hypot(body.x, body.y)
    return _Span(np.maximum(0.0, np.maximum(arm - own.high, own.low - arm)), arm + own.high)


def _world(body: Any, points: Array) -> Array:
    """Points of a fixed body, or of a sliding one before it slides, in the world."""
    c, s = math.cos(body.angle), math.sin(body.angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]) + (body.x, body.y))


def _parallel(a: Any, b: Any) -> bool:
    """Exactly parallel axes: any other two cross somewhere, however far."""
    return bool(a.axis_x * b.axis_y == a.axis_y * b.axis_x)


def _away(drawn: Chords, points: Array, room: float) -> _Span:
    """Distances of primitives (their chords at `points`) from the origin, widened by `room`."""
    far = np.maximum.reduceat(np.hypot(*points.T), drawn.first[:-1])
    # The piece that begins at each point; the last point of a primitive begins none.
    step = np.diff(points, axis=0, append=points[-1:])
    step[drawn.first[1:] - 1] = 0.0
    square = (step**2).sum(axis=1)
    share = np.clip(-(points * step).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    near = np.minimum.reduceat(np.hypot(*(points + share[:, None] * step).T), drawn.first[:-1])
    return _Span(np.maximum(0.0, near - drawn.sag - room), far + drawn.sag + room)


def _across(drawn: Chords, points: Array, slider: Any, room: float) -> _Span:
    """Offsets of primitives across the axis of a sliding body, widened by `room`."""
    offset = points @ np.array([-slider.axis_y, slider.axis_x])
    low, high = (f.reduceat(offset, drawn.first[:-1]) for f in (np.minimum, np.maximum))
    return _Span(low - drawn.sag - room, high + drawn.sag + room)


def load_shapely() -> None:
    """Import the library, which takes a twentieth of a second once in a process."""
    import shapely  # noqa: F401


class PairSearch:
    """The primitives of one pair of bodies as shapely geometries, and the motion that a cell allows."""

    def __init__(self, model: Model, p: int, loose: Integers) -> None:
        """`loose`: primitives of either body that do not share the symmetry of its cells."""
        pair = model.pairs[p]
        self._motion, self._clearance = CellMotion(model.bodies, pair), float(pair.clearance)
        self._turns = [int(pair[f"wrap{i}"]) for i in range(pair.axes)]
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
        found = [self._alike(at, room, self._block(index)), *(loose.candidates(at, room) for loose in self._loose)]
        found.append((np.repeat(np.arange(len(at)), len(self._always)), np.tile(self._always, len(at))))
        cell, local = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return np.bincount(cell, minlength=len(at)), local[np.lexsort((local, cell))]

    def _block(self, index: Integers) -> tuple[Array, Array]:
        """Centre of the block of cell coordinates that holds these cells, and how far it reaches along each axis.

        Where a whole turn lies between cells, such as the first and the last one, the block goes the short way.
        """
        ends = []
        for cells, turn in zip(np.sort(index, axis=0).T, self._turns, strict=True):
            widest = int(np.argmax(np.diff(cells, append=cells[0] + turn))) + 1 if turn else len(cells)
            ends.append((cells[0], cells[-1]) if widest == len(cells) else (cells[widest] - turn, cells[widest - 1]))
        low, high = np.array(ends).T
        return 0.5 * (low + high + 1) * self._motion.sizes, (0.5 * (high - low + 1) + MARGIN) * self._motion.sizes

    def _alike(self, at: Array, room: Array, block: tuple[Array, Array]) -> tuple[Integers, Integers]:
        """(cells, contacts) that could touch within `room` of the cells' centres `at`, all of them in `block`, but for the
        loose ones."""
        import shapely

        mover, other = self._in_block(*block)
        used, row = np.unique(mover, return_inverse=True)
        if len(used) == 0:
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        points, distance = self._seen(at, room, used)
        first = _firsts(self._drawn, used)
        within = (distance[:, row] + self._still_sag[other]) * (1.0 + PLANE_ROUNDING)
        # Most are far apart, which circles around them show sooner; of the rest most cannot touch with their insides.
        cell, place = np.nonzero(self._circles_near(points, first, row, other, within))
        wanted = mover[place] * self._others + other[place]
        left = np.searchsorted(self._wanted, wanted, side="left")
        several = np.searchsorted(self._wanted, wanted, side="right") - left
        nth = np.arange(several.sum()) - np.repeat(np.cumsum(several) - several, several)
        cell, place, local = np.repeat(cell, several), np.repeat(place, several), self._local[np.repeat(left, several) + nth]
        possible = self._regions.possible(cell, local, at, room)
        cell, place, local = cell[possible], place[possible], local[possible]
        shapes = self._shapes_at(points, first, cell, row[place])
        near = shapely.dwithin(self._still[other[place]], shapes, within[cell, place])
        return cell[near], local[near]

    def _shapes_at(self, points: Array, first: Integers, place: Integers, row: Integers) -> Any:
        """The movers `row` at the places `place` of `points` (places, points, 2), each made once."""
        movers = len(first) - 1
        wanted, again = np.unique(place * movers + row, return_inverse=True)
        where, which = wanted // movers, wanted % movers
        count = np.diff(first)[which]
        ends = np.append(0, np.cumsum(count))
        each = np.arange(ends[-1]) + np.repeat(first[which] - ends[:-1], count)
        return _shapes(points[np.repeat(where, count), each], ends)[again]

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
