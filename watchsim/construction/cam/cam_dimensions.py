"""Which numbers does the designer of an eccentric cam and its follower choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class Cam:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    radius: float = dim(5.0, "mm", 0.2, 200.0, "of the cam, a disc", CHOSEN)
    eccentricity: float = dim(1.5, "mm", 0.0, 150.0, "of the disc's middle from the axis: half of the lift", CHOSEN)
    roller_radius: float = dim(1.0, "mm", 0.05, 50.0, "of the round end of the follower", CHOSEN)
    mass: float = dim(2.0, "g", 1e-3, 1e4, "of the follower", CHOSEN)
    preload: float = dim(0.2, "N", 1e-4, 1e4, "of the spring when the follower is lowest", CHOSEN)
    rate: float = dim(0.1, "N/mm", 1e-4, 1e4, "by which that force grows as the follower is lifted", CHOSEN)
    speed: float = dim(1200.0, "°/s", 0.1, 1e6, "of the cam", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction of cam and follower", "steel on oiled steel")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution", CHOSEN)
