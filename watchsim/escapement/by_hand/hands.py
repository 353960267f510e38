"""Parts turned by hand: where do they touch, and what would the touch do?

Absolute angles in rad. Nothing here knows forces or time.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.poses import poses
from watchsim.escapement.by_hand.turning import describe, turn_to_touch
from watchsim.geometry.primitives import Point
from watchsim.mechanism.compile import Compiled
from watchsim.tolerances import JOINT_RESOLUTION

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

ROOM = 1e-10  # of the scene's size: a contact counts so far beyond the ends of its primitives, so that joints are tight
SLACK = 1e-5  # rad: a body that the drawing puts against another stands nearer to it than that


@dataclass(frozen=True, slots=True)
class Touch:
    """A body at `angle` rests against another with contact `contact`."""

    angle: float
    contact: int


@dataclass(frozen=True, slots=True)
class Meeting:
    """A contact at a given position: its point (m) in the movement, the unit normal there, on which primitives.

    `rates` gives for each of the two bodies (numbers in the model) how fast the gap opens as it turns, m/rad.
    `flat` is the body that holds the line or the rounder arc, along whose face the other one's corner slides.
    """

    point: Point
    normal: Point
    rates: Mapping[int, float]
    primitives: tuple[int, int]
    flat: int


class Hands:
    """Turns the bodies of a compiled scene."""

    def __init__(self, compiled: Compiled) -> None:
        self.compiled, self.model = compiled, compiled.model
        self.room = ROOM * compiled.size
        self.resolution = JOINT_RESOLUTION * compiled.size  # m: what outlines leave open
        self._pose, self._row = poses(len(self.model.bodies)), np.zeros(5)
        self._pairs = np.column_stack((self.model.contacts.a, self.model.contacts.b))
        self._owner = np.array(self.model.primitives.body)

    def coordinate(self, name: str) -> int:
        return self.compiled.slices[name].start

    def touch(
        self, name: str, ids: Integers, q: Array, sense: float, reach: float = math.pi, behind: float = 0.0
    ) -> Touch | None:
        """Where body `name` first touches, turned from q in direction `sense` by -`behind` to `reach` rad; None: nowhere."""
        i = self.coordinate(name)
        body = int(self.model.coordinates.body[i])
        turn, contact = turn_to_touch(self.model, ids, q, body, sense, (-behind, reach), self.room, self._pose)
        return Touch(float(q[i]) + sense * turn, int(contact)) if contact >= 0 else None

    def meeting(self, contact: int, q: Array) -> Meeting:
        describe(self.model, contact, q, self._pose, self._row)
        _, nx, ny, x, y = self._row.tolist()
        first, second = (int(k) for k in self._pairs[contact])
        rates = {}
        for sign, primitive in ((1.0, first), (-1.0, second)):
            body = int(self._owner[primitive])
            pose = self._pose[body]
            rates[body] = sign * ((x - float(pose.x)) * ny - (y - float(pose.y)) * nx)
        return Meeting((x, y), (nx, ny), rates, (first, second), int(self._owner[second]))

    def gap(self, contact: int, q: Array) -> float:
        """How far apart the two primitives of a contact are, m."""
        describe(self.model, contact, q, self._pose, self._row)
        return float(self._row[0])

    def flat_of(self, contact: int) -> int:
        """The body that holds the line or the rounder arc of a contact, out of whose material its normal points."""
        return int(self._owner[self._pairs[contact][1]])

    def body(self, name: str) -> int:
        """The number in the model of a pivoted body."""
        return int(self.model.coordinates.body[self.coordinate(name)])

    def pivot(self, name: str, q: Array) -> Point:
        """Where a body's origin is (m)."""
        describe(self.model, 0, q, self._pose, self._row)
        pose = self._pose[self.body(name)]
        return float(pose.x), float(pose.y)

    def error(self, rate: float) -> float:
        """Of an angle at which a contact closes at this rate (m/rad), by what outlines leave open, rad."""
        return self.resolution / max(abs(rate), self.resolution)
