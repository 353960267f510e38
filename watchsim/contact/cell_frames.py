"""In whose frame are the cells of two bodies given, and along which coordinates?

Two bodies on the same carrier, or one body and its carrier, do not care how the carrier stands: seen from it they depend on
relative angles alone. Everything else is seen from the movement.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.model import ARC, FIXED, FREE, FULL, LINE, PIVOT, SLIDE, Records

# Which rows of a table are named by a list of numbers, and as which of those?

Integers = NDArray[np.int64]


def named_rows(numbers: Integers, rows: int) -> tuple[Integers, Integers]:
    """The numbers that occur, ascending, each once, and for each of `numbers` its place among them; all below `rows`.

    As `np.unique` with `return_inverse`, in linear time: the lists are as long as the contacts, the tables are short.
    """
    present = np.zeros(rows, bool)
    present[numbers] = True
    return np.flatnonzero(present), (np.cumsum(present) - 1)[numbers]


# Which straight pieces stand for a primitive, and how far is the true curve from them?

Array = NDArray[np.float64]
MOST = 64  # pieces of one arc, unless requested otherwise


class Chords(NamedTuple):
    """Points along each primitive, in its body's frame."""

    points: Array  # (n, 2), m
    first: NDArray[np.int64]  # points of primitive i are first[i] : first[i + 1]
    sag: Array  # m, how far the primitive may lie from the line through its points

    @property
    def owner(self) -> NDArray[np.int64]:
        """The primitive that each point belongs to."""
        return np.repeat(np.arange(len(self.sag)), np.diff(self.first))


def chords(primitives: Records, sag: float, most: int = MOST) -> Chords:
    """Chords of all `primitives`: one point for a corner, two for a line, for an arc as many as keep within about `sag` m.

    No arc has more than `most`; how far its true curve then lies from them is returned.
    """
    rows = np.asarray(primitives)  # columns of a plain array are found much faster
    kind, radius = rows["kind"], rows["radius"]
    arc, line = kind == ARC, kind == LINE
    half = np.where(rows["extent"] == FULL, np.pi, np.arctan2(rows["half_sin"], rows["half_cos"]))
    # Sagitta of an arc of half angle h: 2 R sin²(h/2).
    with np.errstate(divide="ignore", invalid="ignore"):
        largest = 2.0 * np.arcsin(np.sqrt(np.minimum(1.0, sag / (2.0 * radius))))
        pieces = np.where(arc, np.clip(np.ceil(half / largest), 1, most), np.where(line, 1, 0)).astype(int)
    first = np.concatenate([[0], np.cumsum(pieces + 1)])
    owner = np.repeat(np.arange(len(primitives)), pieces + 1)
    share = (np.arange(len(owner)) - first[owner]) / np.maximum(pieces[owner], 1)
    straight, way = line[owner], rows["length"][owner] * share
    x = rows["x"][owner] + np.where(straight, way * rows["tx"][owner], 0.0)
    y = rows["y"][owner] + np.where(straight, way * rows["ty"][owner], 0.0)
    if arc.any():
        nx, ny = rows["side"] * rows["nx"], rows["side"] * rows["ny"]
        angle = np.arctan2(ny, nx)[owner] + half[owner] * (2.0 * share - 1.0)
        # From the middle of the arc, so that nothing is lost where the centre is far away.
        dx, dy = _swung(radius[owner], nx[owner], ny[owner], angle)
        curved = arc[owner]
        x, y = np.where(curved, rows["px"][owner] + dx, x), np.where(curved, rows["py"][owner] + dy, y)
    depth = 2.0 * radius * np.sin(0.5 * half / np.maximum(pieces, 1)) ** 2
    return Chords(np.stack([x, y], axis=1), first, np.where(arc, depth, 0.0))


def _swung(radius: Array, nx: Array, ny: Array, angle: Array) -> tuple[Array, Array]:
    """The way from the middle of an arc, in direction (nx, ny) from its centre, to its point in direction `angle`."""
    return radius * (np.cos(angle) - nx), radius * (np.sin(angle) - ny)


TURN, TRAVEL = 0, 1
MOVEMENT = -1


class Axis(NamedTuple):
    """A coordinate that the place of `body` depends on: less coordinate `on` (-1: nothing), an angle (TURN) or a TRAVEL.

    `arm` is how far from that turning axis the body's own origin lies, m.
    """

    body: int
    coordinate: int
    on: int
    kind: int
    arm: float


def choose_frames(bodies: Records, pairs: Records) -> None:
    """Fill in the frame of each pair of bodies."""
    for pair in pairs:
        both = (int(pair.a), int(pair.b))
        carriers = [int(bodies[b].carrier) for b in both if bodies[b].carrier >= 0]
        pair.frame = next((c for c in carriers if all(_is_seen(bodies, b, c) for b in both)), MOVEMENT)
        pair.on0 = pair.on1 = pair.on2 = -1


def _is_seen(bodies: Records, b: int, carrier: int) -> bool:
    """Does the frame of body b, seen from the carrier, only turn, by an angle that one cell coordinate gives?"""
    turns = bodies[carrier].motion != SLIDE
    if turns and _is_geared(bodies[b]) and bodies[b].first != angle_of(bodies[carrier]):
        return False
    return b == carrier or bodies[b].carrier == carrier or _is_coaxial(bodies[b], bodies[carrier])


def _is_coaxial(body: Any, carrier: Any) -> bool:
    both_turn = body.motion == carrier.motion == PIVOT and body.carrier < 0
    return bool(both_turn and body.x == carrier.x and body.y == carrier.y)


def _is_geared(body: Any) -> bool:
    return bool(body.ratio != 1.0 or body.phase != 0.0)


def seen_from(bodies: Records, b: int, frame: int) -> Any:
    """The record of body b as seen from the frame, in which it is carried no more; from the movement it stays as it is."""
    body = bodies[b].copy()
    if frame == MOVEMENT:
        return body
    carrier = bodies[frame]
    # The frame of a slide does not turn: it is seen from a frame that only shifts with it.
    c, s, angle = (carrier.c, carrier.s, carrier.angle) if carrier.motion == SLIDE else (1.0, 0.0, 0.0)
    if b == frame:
        body.motion, body.first, body.x, body.y = FIXED, -1, 0.0, 0.0
        body.angle, body.c, body.s = angle, c, s
    elif body.carrier == frame:
        body.carrier = -1
        body.x, body.y = c * body.x - s * body.y, s * body.x + c * body.y
    else:
        body.x, body.y = 0.0, 0.0
    if b != frame and carrier.motion != SLIDE and body.first == angle_of(carrier):
        body.ratio -= 1.0  # geared to the carrier, it turns by so much against it
    return body


def axes_of(bodies: Records, b: int, frame: int) -> list[Axis]:
    """What the place of body b in the frame depends on."""
    body = seen_from(bodies, b, frame)
    if body.carrier >= 0:
        arm = math.hypot(body.x, body.y)
        return [*_own(b, bodies[body.carrier], -1, arm), *_own(b, body, -1, 0.0)]
    turning = frame != MOVEMENT and bodies[frame].motion != SLIDE and body.first != angle_of(bodies[frame])
    return _own(b, body, angle_of(bodies[frame]) if turning else -1, 0.0)


def angle_of(body: Any) -> int:
    """The coordinate that is the angle of a turning body."""
    return int(body.first) + (2 if body.motion == FREE else 0)


def _own(b: int, moving: Any, on: int, arm: float) -> list[Axis]:
    first = int(moving.first)
    if moving.motion == FIXED:
        return []
    if moving.motion == PIVOT:
        return [Axis(b, first, on, TURN, arm)] if moving.ratio != 0.0 else []
    shifts = [Axis(b, first + i, -1, TRAVEL, 0.0) for i in range(2 if moving.motion == FREE else 1)]
    return [*shifts, Axis(b, first + 2, -1, TURN, arm)] if moving.motion == FREE else shifts


# Where is a body at given cell coordinates, and how far can it move while they change a little?


class _Body(NamedTuple):
    """What counts of a body, in plain numbers: reading a field of a record takes a microsecond."""

    motion: int
    first: int
    carrier: int
    x: float
    y: float
    angle: float
    axis_x: float
    axis_y: float
    ratio: float
    phase: float


class CellMotion:
    """The cell coordinates of one pair of bodies, read from its record (records.py), and the frame they are given in."""

    def __init__(self, bodies: Records, pair: Any) -> None:
        self.coordinates = [int(pair[f"c{i}"]) for i in range(pair.axes)]
        self.sizes = np.array([float(pair[f"size{i}"]) for i in range(pair.axes)])
        self.on = [int(pair[f"on{i}"]) for i in range(pair.axes)]
        self._seen = {int(b): _plain(seen_from(bodies, int(b), int(pair.frame))) for b in (pair.a, pair.b)}
        self._carrier = {b: _plain(bodies[body.carrier]) for b, body in self._seen.items() if body.carrier >= 0}

    def pose(self, b: int, at: Array) -> tuple[Array, Array, Array]:
        """Places x, y (m) and angles (rad) of body b at cell coordinates `at`, (places, axes)."""
        body = self._seen[int(b)]
        if int(b) not in self._carrier:
            return self._own(body, at)
        x, y, angle = self._own(self._carrier[int(b)], at)
        c, s = np.cos(angle), np.sin(angle)
        return x + c * body.x - s * body.y, y + s * body.x + c * body.y, self._own(body, at)[2]

    def _own(self, body: _Body, at: Array) -> tuple[Array, Array, Array]:
        """The same for a body that nothing carries."""
        value = {coordinate: at[:, axis] for axis, coordinate in enumerate(self.coordinates)}
        x, y, angle = (np.full(len(at), v) for v in (body.x, body.y, body.angle))
        if body.motion == PIVOT:
            angle = np.full(len(at), body.phase) if body.ratio == 0.0 else body.ratio * value[body.first] + body.phase
        elif body.motion == SLIDE:
            way = body.ratio * value[body.first] + body.phase
            x, y = x + way * body.axis_x, y + way * body.axis_y
        elif body.motion == FREE:
            x, y, angle = (value[body.first + i] for i in range(3))
        return x, y, angle

    def freedom(self, b: int, room: Array) -> tuple[float, float]:
        """How far (m) body b's origin may move and (rad) the body turn when each cell coordinate changes by up to `room`."""
        body = self._seen[int(b)]
        shift, turn = self._own_freedom(body, room)
        if int(b) in self._carrier:
            more, swing = self._own_freedom(self._carrier[int(b)], room)
            shift += more + swing * math.hypot(body.x, body.y)
        return shift, turn

    def _own_freedom(self, body: _Body, room: Array) -> tuple[float, float]:
        value = dict(zip(self.coordinates, room.tolist(), strict=True))
        if body.motion == FIXED or body.ratio == 0.0:
            return 0.0, 0.0
        if body.motion == FREE:
            return math.hypot(value[body.first], value[body.first + 1]), value[body.first + 2]
        way = abs(body.ratio) * value[body.first]
        return (0.0, way) if body.motion == PIVOT else (way, 0.0)


def _plain(body: Any) -> _Body:
    return _Body(*(body[name].item() for name in _Body._fields))


def turned(points: Array, angle: Array) -> Array:
    """Points (places or 1, n, 2), turned by one angle for each place."""
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return np.stack([c * points[..., 0] - s * points[..., 1], s * points[..., 0] + c * points[..., 1]], axis=-1)
