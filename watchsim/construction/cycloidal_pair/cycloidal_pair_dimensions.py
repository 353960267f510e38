"""Which numbers does the designer of a wheel and pinion of a watch train choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"
HALF = "half a pitch"


@dataclass(frozen=True)
class CycloidalPair:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    pinion_teeth: int = dim(10, "", 6, 30, "leaves of the driven pinion", "watch trains: 6 to 12")
    wheel_teeth: int = dim(80, "", 20, 150, "teeth of the driving wheel", "watch trains: 6 to 10 times the leaves")
    module: float = dim(0.12, "mm", 0.02, 10.0, "pitch diameter by number of teeth", "watch trains: 0.08 mm to 0.2 mm")
    addendum: float = dim(1.4, "", 0.5, 2.0, "height of the wheel's teeth above the pitch circle, in modules", CHOSEN)
    wheel_dedendum: float = dim(1.57, "", 0.5, 2.5, "depth of the wheel's gaps below the pitch circle, in modules", HALF)
    pinion_dedendum: float = dim(1.75, "", 0.5, 2.5, "depth of the pinion's gaps below the pitch circle, in modules", CHOSEN)
    tooth: float = dim(1.57, "", 1.0, 1.8, "width of the wheel's teeth on the pitch circle, in modules", HALF)
    leaf: float = dim(1.05, "", 0.7, 1.5, "width of the leaves on the pitch circle, in modules", "a third of a pitch")
    ogive: float = dim(
        1.333, "", 1.0, 3.0, "radius of the leaves' rounding by that of a round top", "1: round tops, above: ogives (BS 978-2)"
    )
    spread: float = dim(
        0.0, "", -0.05, 0.2, "by which the centres are further apart than the pitch circles, in modules", CHOSEN
    )
    arcs: int = dim(
        6, "", 1, 16, "arcs that the addendum of each flank is drawn with, through points of the epicycloid", CHOSEN
    )
    torque: float = dim(40.0, "µN·m", 1e-4, 1e6, "driving the wheel", CHOSEN)
    drag: float = dim(1.0, "µN·m·s/rad", 1e-6, 1e6, "load on the pinion, in proportion to its speed", CHOSEN)
    pinion_inertia: float = dim(10.0, "mg·cm²", 1e-4, 1e6, "pinion with what it turns", "a brass wheel of 8 mm on its arbor")
    wheel_inertia: float = dim(50.0, "mg·cm²", 1e-4, 1e6, "wheel with what turns it", CHOSEN)
    friction: float = dim(0.0, "", 0.0, 0.4, "coefficient of friction between flanks", "0: to see the form of the teeth alone")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution between flanks", CHOSEN)
