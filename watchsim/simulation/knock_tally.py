"""What can be said of blows that turn the oscillator back, without keeping its events?"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bits = NDArray[np.bool_]

OUTSIDE = math.pi  # rad from rest: so far round the impulse pin cannot be in the slot
TOGETHER = 4  # contacts of one half swing that are remembered
CONTACT, FIRST, LAST, ANGLE, PLACE = range(5)  # columns of `KnockTally.contacts`


class KnockTally:
    """Is given, in order, the impacts of the oscillator with what could turn it back, from one passage to the next.

    contacts  one row each: its number, when its first and last blow were (s), how far from rest the last one was (rad), and the
              coordinates of the scene at the first one, nan where not known
    together  one row for each set of contacts with which it knocked at one turning point: numbers, -1 for none, how often
    """

    def __init__(self, rest: float, stops: Bits, width: int) -> None:
        """`stops`: for each contact, whether it is with something fixed; `width` coordinates has the scene."""
        self.rest, self._stops = rest, stops
        self.contacts = np.zeros((0, PLACE + width))
        self.together = np.zeros((0, TOGETHER + 1), np.int64)

    def turn(
        self, t: Array, contact: NDArray[Any], places: Array, passed: tuple[float, float], turned: float, reach: float
    ) -> None:
        """Impacts at times t (s) about a turning point at `turned` (s), the coordinate `reach` (rad); the oscillator passed its
        rest position at `passed` before and after it. `places`: coordinates of the scene (impacts, n)."""
        begins = np.where((t > turned) | math.isnan(passed[0]), passed[1], passed[0])
        way = np.where(begins == turned, math.inf, turned - begins)
        angle = (reach - self.rest) * np.sin(0.5 * math.pi * np.minimum((t - begins) / way, 1.0))
        outside = (np.abs(angle) > OUTSIDE) | self._stops[contact]
        for k in np.flatnonzero(outside).tolist():
            row = np.flatnonzero(self.contacts[:, CONTACT] == contact[k])
            if not len(row):
                new = np.concatenate([[contact[k], t[k], t[k], angle[k]], places[k]])
                self.contacts = np.concatenate([self.contacts, new[None]])
            else:
                self.contacts[row[0], [LAST, ANGLE]] = t[k], angle[k]
        met = np.unique(contact[outside])[:TOGETHER]
        if len(met):
            key = np.append(met, np.full(TOGETHER - len(met), -1))
            row = np.flatnonzero((self.together[:, :TOGETHER] == key).all(axis=1))
            if not len(row):
                self.together = np.concatenate([self.together, np.append(key, 0)[None]])
                row = np.array([len(self.together) - 1])
            self.together[row[0], TOGETHER] += 1

    def finished(self) -> dict[str, Any]:
        """As plain numbers."""
        return {"contacts": self.contacts.tolist(), "together": self.together.tolist()}
