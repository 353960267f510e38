"""Which numbers does the designer of a calendar star and its jumper choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class Jumper:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(7, "", 5, 16, "teeth of the star", "7: days of the week")
    tip_radius: float = dim(4.0, "mm", 0.5, 20.0, "of the star, to the points of its teeth", CHOSEN)
    depth: float = dim(1.2, "mm", 0.05, 8.0, "of the teeth, from point to root", CHOSEN)
    tip_rounding: float = dim(0.08, "mm", 0.005, 1.0, "radius of the points of the teeth", CHOSEN)
    beak_radius: float = dim(0.4, "mm", 0.02, 4.0, "of the round beak of the jumper", CHOSEN)
    jumper_length: float = dim(6.0, "mm", 0.5, 40.0, "jumper, from its pivot to the middle of the beak", CHOSEN)
    preload: float = dim(20.0, "mN", 0.1, 2000.0, "with which the beak is pressed into the star at rest", CHOSEN)
    rate: float = dim(8.0, "mN/mm", 0.01, 2000.0, "by which that force grows as the beak is lifted", CHOSEN)
    crank: float = dim(2.5, "mm", 0.2, 20.0, "finger, from its axis to the middle of its pin", CHOSEN)
    pin_radius: float = dim(0.3, "mm", 0.02, 3.0, "of the pin", CHOSEN)
    push: float = dim(0.75, "", 0.55, 0.95, "share of a pitch over which the pin carries a tooth", CHOSEN)
    speed: float = dim(360.0, "°/s", 0.1, 3600.0, "of the finger; a calendar's turns once a day", "fast, to be simulated")
    star_inertia: float = dim(30.0, "mg·cm²", 1e-3, 1e6, "star with its disc", CHOSEN)
    jumper_inertia: float = dim(5.0, "mg·cm²", 1e-3, 1e6, "jumper", CHOSEN)
    drag: float = dim(2.0, "µN·m", 0.0, 1e4, "dry friction of the star in its bearing", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction, in all contacts", "steel on oiled steel")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)
