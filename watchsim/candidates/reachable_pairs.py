"""Which declared pairs of primitives can ever touch?

A primitive that turns about a pivot stays within a ring, one that slides within a strip. Pairs whose rings and strips keep
apart never touch, whatever the bodies do; of a free body nothing is known. Errs only on the side of too many.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_frame import seen_from
from watchsim.candidates.chords import Chords, chords
from watchsim.candidates.named_rows import named_rows
from watchsim.model.records import FIXED, PIVOT, SLIDE, Records

Array = NDArray[np.float64]


class _Span(NamedTuple):
    """Least and largest value over each of some primitives, m."""

    low: Array
    high: Array

    def of(self, rows: NDArray[np.int64]) -> _Span:
        return _Span(self.low[rows], self.high[rows])

    def meets(self, other: _Span) -> NDArray[np.bool_]:
        return np.asarray((self.low <= other.high) & (other.low <= self.high))


Drawn = dict[tuple[bytes, float], Chords]  # of the primitives in those rows, that closely


def reachable(bodies: Records, primitives: Records, contacts: Records, pair: Any, drawn: Drawn) -> NDArray[np.bool_]:
    """For each contact of one pair of bodies: can its primitives come within the pair's clearance at any pose?

    `drawn` holds what was drawn for other pairs: each body meets many.
    """
    part = contacts[pair.start : pair.stop]
    part_a, part_b = np.array(part.a), np.array(part.b)
    a, b = (seen_from(bodies, int(number), int(pair.frame)) for number in (pair.a, pair.b))
    if any(body.carrier >= 0 and bodies[body.carrier].motion != PIVOT for body in (a, b)):
        return np.ones(len(part), bool)
    a_first = (primitives.body == pair.a)[part_a]
    on_a, on_b = np.where(a_first, part_a, part_b), np.where(a_first, part_b, part_a)
    if a.motion != PIVOT and (b.motion == PIVOT or a.motion == FIXED):
        a, b, on_a, on_b = b, a, on_b, on_a
    movers, row_a = named_rows(on_a, len(primitives))
    others, row_b = named_rows(on_b, len(primitives))
    one, two = (_drawn(primitives, rows, 0.5 * float(pair.clearance), drawn) for rows in (movers, others))
    centre_a, centre_b = _centre(bodies, a), _centre(bodies, b)
    if a.motion == PIVOT and b.motion == PIVOT:
        ring_a, ring_b = _ring(a, one, pair.clearance).of(row_a), _ring(b, two, 0.0).of(row_b)
        distance = math.dist(centre_a, centre_b)
        # Two rings whose centres are this far apart have a point in common.
        apart = (distance > ring_a.high + ring_b.high) | (ring_a.low > distance + ring_b.high)
        return np.asarray(~(apart | (ring_b.low > distance + ring_a.high)))
    if a.motion == PIVOT and b.motion == FIXED:
        fixed = _away(two, _world(b, two.points) - centre_a, 0.0)
        return _ring(a, one, pair.clearance).of(row_a).meets(fixed.of(row_b))
    if a.motion == PIVOT and b.motion == SLIDE:
        strip = _across(two, _world(b, two.points) - centre_a, b, 0.0)
        far = _ring(a, one, pair.clearance).of(row_a).high
        return _Span(-far, far).meets(strip.of(row_b))
    if a.motion == SLIDE and (b.motion == FIXED or (b.motion == SLIDE and _parallel(a, b))):
        strip = _across(one, _world(a, one.points), a, pair.clearance)
        return strip.of(row_a).meets(_across(two, _world(b, two.points), a, 0.0).of(row_b))
    return np.ones(len(part), bool)


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
