"""How do fork and pin, dart and rollers of a drawn lever play together?

The second half of measure_lever.py: the lift angle of the balance, the play of the pin in the fork, and whether dart and
horns keep the lever on its bank wherever the balance stands. Degrees at the part's own pivot, millimetres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import shapely
from measure_shapes import Layout, first, placed
from shapely.geometry import Polygon, box
from shapely.geometry.base import BaseGeometry

FAR = 180.0  # of the balance: the pin is opposite the fork
SWING = 1.0  # step of the balance in the scans


@dataclass(frozen=True)
class Safety:
    """Fork and safety action. Degrees unless the name says mm; nan where the scene has no dart."""

    lift_angle: float  # balance, from the pin's meeting the fork on one bank to its leaving on the other
    fork_play: float  # lever, with the pin in the middle of the slot
    horn_clearance_mm: float  # the pin's farthest point to the horn it passes, lever on the bank
    horn_freedom: float  # lever, from the bank to the horn's meeting the pin, where the dart faces the crescent: largest
    guard_clearance_mm: float  # dart to safety roller, lever on the bank
    guard_freedom: float  # lever, from the bank to the dart's meeting the roller
    worst_freedom: float  # lever, from the bank, over all places of the balance with the pin outside the fork
    worst_at: float  # balance angle of that
    beat_clearance_mm: float  # dart to safety roller while the pin is in the fork: smallest


class Roller:
    """Fork, pin, dart and safety roller: where they touch."""

    def __init__(self, layout: Layout, bank: float) -> None:
        pairs = layout.pairs("lever", "balance")
        self.bank = bank
        self.lever_at, self.balance_at = layout.parts["lever"].position, layout.parts["balance"].position
        self.fork, self.pin = layout.shape("lever", [pairs[0][0]]), layout.shape("balance", [pairs[0][1]])
        self.guarded = len(pairs) > 1
        self.dart = layout.shape("lever", [pairs[1][0]]) if self.guarded else Polygon()
        self.safety = layout.shape("balance", [pairs[1][1]]) if self.guarded else Polygon()

    def fork_touches(self, a: float, theta: float) -> bool:
        return bool(self.lever(self.fork, a).intersects(self.balance(self.pin, theta)))

    def dart_touches(self, a: float, theta: float) -> bool:
        return bool(self.lever(self.dart, a).intersects(self.balance(self.safety, theta)))

    def dart_gap(self, a: float, theta: float) -> float:
        """Distance from the dart to the safety roller; infinite without a dart."""
        if not self.guarded:
            return math.inf
        return float(self.lever(self.dart, a).distance(self.balance(self.safety, theta)))

    def lever(self, shape: BaseGeometry, a: float) -> BaseGeometry:
        return placed(shape, a, self.lever_at)

    def balance(self, shape: BaseGeometry, theta: float) -> BaseGeometry:
        return placed(shape, theta, self.balance_at)

    def freedom(self, theta: float, horns: bool = True, guard: bool = True) -> float:
        """How far the lever can be turned off its entry bank before it is stopped; nan if it never is."""

        def stopped(d: float) -> bool:
            a = self.bank - d
            return (horns and self.fork_touches(a, theta)) or (guard and self.dart_touches(a, theta))

        found = first(stopped, 0.0, 2.0 * self.bank, 0.1)
        return math.nan if found is None else found


def measure_safety(layout: Layout, bank: float) -> Safety:
    """All of it, for a lever that swings to ±`bank` degrees."""
    m = Roller(layout, bank)
    enters, leaves = lift(m)
    guard = m.freedom(FAR, horns=False) if m.guarded else 0.0
    places = _angles(-FAR, enters - SWING) if m.guarded else []
    outside = [(m.freedom(theta), theta) for theta in places]
    worst = max(outside or [(math.nan, math.nan)], key=lambda pair: math.inf if math.isnan(pair[0]) else pair[0])
    horn = [m.freedom(theta, guard=False) for _, theta in outside if m.freedom(theta, horns=False) > 1.5 * guard]
    return Safety(
        lift_angle=leaves - enters,
        fork_play=fork_play(m),
        horn_clearance_mm=horn_clearance(m),
        horn_freedom=max(horn, default=math.nan),
        guard_clearance_mm=m.dart_gap(bank, FAR) if m.guarded else math.nan,
        guard_freedom=guard if m.guarded else math.nan,
        worst_freedom=worst[0],
        worst_at=worst[1],
        beat_clearance_mm=beat_clearance(m, enters, leaves),
    )


def lift(m: Roller) -> tuple[float, float]:
    """Balance angles at which the pin meets the fork on the entry bank, and leaves it on the exit bank."""
    enters = first(lambda d: m.fork_touches(m.bank, d - FAR), 0.0, FAR, SWING)
    leaves = first(lambda d: m.fork_touches(-m.bank, FAR - d), 0.0, FAR, SWING)
    if enters is None or leaves is None:
        raise ValueError("the pin never meets the fork")
    return enters - FAR, FAR - leaves


def fork_play(m: Roller) -> float:
    """Free travel of the lever with the balance at rest."""
    up = first(lambda d: m.fork_touches(d, 0.0), 0.0, m.bank, 0.05)
    down = first(lambda d: m.fork_touches(-d, 0.0), 0.0, m.bank, 0.05)
    return math.nan if up is None or down is None else up + down


def horn_clearance(m: Roller) -> float:
    """On the entry bank the pin comes from the left: the left half of the fork against the pin's farthest point."""
    left = m.fork.intersection(box(-100.0, -100.0, 0.0, 100.0))
    reach = max(math.hypot(x, y) for x, y in shapely.get_coordinates(m.pin))
    return float(m.lever(left, m.bank).distance(shapely.Point(m.balance_at))) - reach


def beat_clearance(m: Roller, enters: float, leaves: float) -> float:
    """Carry the lever over with the pin and watch the dart at both ends of the play."""
    a, least = m.bank, math.inf
    for theta in _angles(enters - SWING, leaves + SWING):
        a, far = _play(m, a, theta)
        least = min(least, m.dart_gap(a, theta), m.dart_gap(far, theta))
    return least


def _play(m: Roller, a: float, theta: float) -> tuple[float, float]:
    """The lever angles between which the pin leaves it free, coming from `a` on the entry side."""
    push = first(lambda d: not m.fork_touches(a - d, theta), 0.0, 2.0 * m.bank, 0.02)
    if push is None:
        raise ValueError(f"the pin jams in the fork at {theta:.1f} degrees of the balance")
    near = a - push
    free = first(lambda d: m.fork_touches(near - d, theta), 1e-6, 2.0 * m.bank, 0.02)
    return near, -m.bank if free is None else max(near - free, -m.bank)


def _angles(start: float, end: float) -> list[float]:
    return [start + i * SWING for i in range(int((end - start) / SWING) + 1)]
