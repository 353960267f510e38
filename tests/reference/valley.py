"""How does a point mass, or a disc, move without friction along two lines joined by an arc?

The path of its centre is a line that falls by `slope`, an arc of signed radius (positive: a valley, negative: a crest) that
turns it level, and a level line. Energy gives the speed everywhere and geometry the force; the times are elliptic integrals,
so everything is given as a function of place.
"""

import math
from typing import NamedTuple


class Path(NamedTuple):
    """Lengths in metres; the arc ends at x = 0 where the level line begins."""

    slope: float  # rad, > 0 for a valley, < 0 for a crest (then the path rises towards x = 0 and is level after)
    radius: float  # of the centre's path, > 0
    gravity: float = 9.81


def height(path: Path, x: float) -> float:
    """Of the path above its level part; for a crest below it."""
    side = math.copysign(1.0, path.slope)
    turn = abs(path.slope)
    start = path.radius * math.sin(turn)
    if x >= 0.0:
        return 0.0
    if x >= -start:
        return side * (path.radius - math.sqrt(path.radius**2 - x * x))
    return side * (path.radius * (1.0 - math.cos(turn)) + (-start - x) * math.tan(turn))


def incline(path: Path, x: float) -> float:
    """Angle of the path at x, negative where it falls."""
    turn, side = abs(path.slope), math.copysign(1.0, path.slope)
    return -side * math.asin(min(max(-x / path.radius, 0.0), math.sin(turn)))


def speed(path: Path, x: float, x0: float, v0: float, share: float = 1.0) -> float:
    """Along the path, from v0 at x0; `share`: mass over effective mass (2/3 for a rolling disc)."""
    return math.sqrt(v0 * v0 + 2.0 * share * path.gravity * (height(path, x0) - height(path, x)))


def force(path: Path, x: float, v: float, mass: float) -> float:
    """Of the ground on the mass."""
    start = -path.radius * math.sin(abs(path.slope))
    bend = math.copysign(1.0 / path.radius, path.slope) if start < x < 0.0 else 0.0
    return mass * (path.gravity * math.cos(incline(path, x)) + v * v * bend)
