"""Which numbers does a random mechanism get?

Rounded to a few digits, so that scenes can be read; the values at which laws change (0, 1, equal) come up often.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np

T = TypeVar("T")


class Dice:
    """A seeded source: number `k` of seed `s` is the same mechanism on every machine."""

    def __init__(self, seed: int, number: int) -> None:
        self._rng = np.random.default_rng([seed, number])

    def uniform(self, low: float, high: float) -> float:
        """Evenly between both, four significant digits."""
        return float(f"{self._rng.uniform(low, high):.4g}")

    def log(self, low: float, high: float) -> float:
        """Evenly in the logarithm, four significant digits."""
        return float(f"{10.0 ** self._rng.uniform(np.log10(low), np.log10(high)):.4g}")

    def chance(self, share: float) -> bool:
        return bool(self._rng.random() < share)

    def sign(self) -> float:
        return 1.0 if self.chance(0.5) else -1.0

    def number(self, low: int, high: int) -> int:
        """A whole number, both ends included."""
        return int(self._rng.integers(low, high + 1))

    def pick(self, choices: Sequence[T]) -> T:
        return choices[int(self._rng.integers(len(choices)))]

    def friction(self) -> float:
        return 0.0 if self.chance(0.3) else 1.0 if self.chance(0.05) else self.uniform(0.01, 1.0)

    def restitution(self) -> float:
        return 0.0 if self.chance(0.4) else 1.0 if self.chance(0.1) else self.uniform(0.01, 0.99)

    def kink(self, largest: float = 1.5) -> float:
        """An angle between two edges, rad: from rounding to a right angle, either way."""
        return self.sign() * self.log(1e-10, largest)
