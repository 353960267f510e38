"""What binds the coordinate of one body to that of another?"""

from __future__ import annotations

import math
from dataclasses import dataclass

PRESSURE_ANGLE = math.radians(20.0)  # of gears that say nothing else: ISO 53


@dataclass(frozen=True, slots=True)
class Geared:
    """A body that has no coordinate of its own: it goes `ratio` times as far as the body `to`, as gears without play make it.

    rad/rad, m/rad, rad/m or m/m, of coordinates as the scene gives them: of a body that `to` carries, against that one.
    """

    to: str
    ratio: float


@dataclass(frozen=True, slots=True)
class Gear:
    """Gears between two bodies; with play each has a coordinate of its own (or is geared without play to one that has).

    ratio        how far the second goes for one unit of the first: rad/rad, m/rad, rad/m or m/m
    backlash     how far the second can go while the first is held, rad or m; in the middle of it at the start
    restitution  Poisson's, of the impacts when the play is used up
    efficiency   share of the work put in at either body that comes out at the other; the rest is friction of the teeth
    pressure_angle  rad, of the line of action to the common tangent; changes no motion, only what bearings take
    """

    between: tuple[str, str]
    ratio: float
    backlash: float
    restitution: float = 0.0
    efficiency: float = 1.0
    pressure_angle: float = PRESSURE_ANGLE
