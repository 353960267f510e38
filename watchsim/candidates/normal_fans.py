"""Which pairs of primitives that come near each other could touch inside both of them?

A contact lies where the normal falls into the fans of both primitives and onto their lengths. The many short pieces of a fine
outline that lie near a corner are distinguished by that: the centre of the circle is opposite few of them. Errs only on the
side of too many.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_motion import CellMotion
from watchsim.model.records import FULL, LINE, Model, Records
from watchsim.tolerances import PLACE_ROUNDING

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
