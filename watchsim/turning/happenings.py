"""What happens in a cycle, in the order in which it does: what meets, parts, goes free, and passes by how little."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from watchsim.geometry.primitives import Point
from watchsim.turning.turn import Turn

PASSING = 1.5e-4  # m: what comes closer without a touch is reported
ALIKE = 5e-7  # m: passings of the same layers that differ by less are one
FORGOTTEN = 3  # rows: a touch that comes back so soon was never lost


@dataclass(frozen=True)
class Stretch:
    """Two layers in touch from row `first` to row `last`, sliding along each other by `slid` (m)."""

    couple: int
    first: int
    last: int
    slid: float


@dataclass(frozen=True)
class Passing:
    """Two layers that came within `distance` (m) of each other at row `row` without a touch there."""

    couple: int
    row: int
    distance: float


@dataclass(frozen=True)
class Happening:
    """One line of the story: `kind` is meets, leaves, face (the touch goes over to another edge), free (the pressed body goes
    `way` without being held) or back (it stands furthest back, having recoiled by `way`)."""

    kind: str
    row: int
    couple: int | None
    way: float = 0.0
    place: Point | None = None


def stretches(found: Turn) -> list[Stretch]:
    """All touches of the last cycle."""
    cycle = found.cycle
    out: list[Stretch] = []
    for k in range(len(cycle.assembly.couples)):
        rows = [row for row in range(found.first, len(cycle.rows)) if any(touch.couple == k for touch in cycle.touches[row])]
        if not rows:
            continue
        cuts = [0, *(i for i in range(1, len(rows)) if rows[i] - rows[i - 1] > FORGOTTEN), len(rows)]
        for begin, end in pairwise(cuts):
            first, last = rows[begin], rows[end - 1]
            out.append(Stretch(k, first, last, sum(cycle.slid[row][k] for row in range(first + 1, last + 1))))
    return sorted(out, key=lambda one: (one.first, one.last))


def passings(found: Turn) -> list[Passing]:
    """Where two layers pass closely: the smallest distance of each stretch apart that neither begins nor ends there."""
    cycle = found.cycle
    out: list[Passing] = []
    distances = np.array(cycle.distances)[found.first :]
    for k in range(len(cycle.assembly.couples)):
        d = distances[:, k]
        for row in range(1, len(d) - 1):
            around = d[max(0, row - 40) : row + 41]
            closest = 2e-8 < d[row] < PASSING and d[row] == around.min() and d[row] < min(around[0], around[-1])
            if closest and not any(one.couple == k and abs(one.distance - d[row]) < ALIKE for one in out):
                out.append(Passing(k, found.first + row, float(d[row])))
    return sorted(out, key=lambda one: one.distance)


def happenings(found: Turn) -> list[Happening]:
    """The story of the last cycle."""
    cycle = found.cycle
    out: list[Happening] = []
    for one in stretches(found):
        place = {touch.couple: touch.place for touch in cycle.touches[one.first]}
        if one.first > found.first:
            out.append(Happening("meets", one.first, one.couple, 0.0, place[one.couple]))
        if one.last < len(cycle.rows) - 1:
            end = {touch.couple: touch.place for touch in cycle.touches[one.last]}
            out.append(Happening("leaves", one.last, one.couple, one.slid, end[one.couple]))
        out += _faces(found, one)
    for leap in cycle.leaps:
        if leap.row >= found.first:
            held = [
                touch
                for touch in cycle.touches[min(leap.row, len(cycle.rows) - 1)]
                if leap.body in _bodies(found, touch.couple)
            ]
            out.append(Happening("free", leap.row, held[0].couple if held else None, leap.way, held[0].place if held else None))
    out += _recoils(found)
    order = {"leaves": 0, "back": 1, "free": 2, "meets": 3, "face": 4}
    return sorted(out, key=lambda one: (one.row, order[one.kind]))


def _faces(found: Turn, one: Stretch) -> list[Happening]:
    """Where a touch goes over from one edge to another and stays there."""
    cycle = found.cycle
    out: list[Happening] = []
    seen = [
        (row, touch.faces, touch.place)
        for row in range(one.first, one.last + 1)
        for touch in cycle.touches[row]
        if touch.couple == one.couple and touch.faces != (-1, -1)
    ]
    face = seen[0][1] if seen else None
    for (row, now, place), (_, then, _), (_, later, _) in zip(seen, seen[1:], seen[2:], strict=False):
        if now != face and now == then == later:
            out.append(Happening("face", row, one.couple, 0.0, place))
            face = now
    return out


def _bodies(found: Turn, couple: int) -> tuple[int, int]:
    one = found.cycle.assembly.couples[couple]
    return one.a, one.b


def _recoils(found: Turn) -> list[Happening]:
    """Where a pressed body stands furthest back before it goes on."""
    cycle = found.cycle
    out: list[Happening] = []
    q = cycle.q
    for number, sign in cycle.pressed.items():
        way = sign * q[:, number]
        high, low = way[found.first], way[found.first]
        row_low = found.first
        for row in range(found.first, len(way)):
            if way[row] < low:
                low, row_low = way[row], row
            if way[row] > low + 1e-5 and high - low > 5e-4:
                out.append(Happening("back", row_low, None, high - low))
                high = low = way[row]
            if way[row] > high:
                high = low = way[row]
                row_low = row
    return out
