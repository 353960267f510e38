"""Can the wheel make way for two contacts at once, whatever its lever arms are?"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any

from watchsim.analysis.verdicts.standing import _passes, _told_apart

ARMS = (0.0, 1e-5, -1e-5, 9e-4, -9e-4, 2.5e-3, -2.5e-3)  # m


@dataclass
class Contacts:
    """Rates at which two gaps open, by body: m for a turn of one radian."""

    lever: tuple[float, float]
    wheel: tuple[float, float]

    @property
    def pairs(self) -> tuple[int, int]:
        return (0, 1)

    def of(self, row: int, name: str) -> tuple[float, float]:
        return (getattr(self, name)[row], 0.0)


def some_turn(found: Contacts, way: float) -> bool:
    """By trying the turns at which one gap just stays, and those far beyond them."""
    tried = [0.0, -1e9, 1e9]
    tried += [-way * a / b for a, b in zip(found.lever, found.wheel, strict=True) if b]
    return any(all(way * a + b * x >= -1e-12 for a, b in zip(found.lever, found.wheel, strict=True)) for x in tried)


def test_as_by_trying_all_turns() -> None:
    """Every combination."""
    for a, b, c, d, way in product(ARMS, ARMS, ARMS, ARMS, (1.0, -1.0)):
        found: Any = Contacts((a, b), (c, d))
        edges = sorted(-way * lever / wheel for lever, wheel in ((a, c), (b, d)) if wheel)
        if len(edges) < 2 or edges[1] - edges[0] > 1e-9 or edges[0] == edges[1]:
            assert _passes("wheel", "lever", found, way) is some_turn(found, way)


def test_two_torques_have_the_fewest_digits_that_tell_them_apart() -> None:
    assert _told_apart(1.6e-6, 4.3e-6) == ("1.6 µN·m", "4.3 µN·m")
    assert _told_apart(1.234567e-6, 1.21e-6) == ("1.23 µN·m", "1.21 µN·m")
    assert _told_apart(1.234567e-6, 1.23e-6) == ("1.2346 µN·m", "1.23 µN·m")
