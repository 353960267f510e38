"""Which numbers does the designer of a pair of involute gears choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class InvolutePair:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    pinion_teeth: int = dim(20, "", 6, 60, "teeth of the driven pinion", CHOSEN)
    wheel_teeth: int = dim(40, "", 8, 150, "teeth of the driving wheel", CHOSEN)
    module: float = dim(0.2, "mm", 0.02, 10.0, "pitch diameter by number of teeth", "small gears: 0.1 mm to 0.3 mm")
    pressure_angle: float = dim(20.0, "°", 14.0, 28.0, "of the basic rack", "ISO 53: 20°")
    shift: float = dim(
        0.0, "", 0.0, 0.7, "profile shift of the pinion in modules, of the wheel the opposite", "0.4 for 8 teeth"
    )
    addendum: float = dim(1.0, "", 0.5, 1.2, "height of a tooth above the pitch circle, in modules", "ISO 53: 1")
    dedendum: float = dim(1.25, "", 0.7, 1.5, "depth of a gap below the pitch circle, in modules", "ISO 53: 1.25")
    spread: float = dim(0.05, "", 0.002, 0.3, "by which the centres are further apart than without play, in modules", CHOSEN)
    arcs: int = dim(8, "", 1, 16, "arcs that each flank is drawn with, through points of the involute", CHOSEN)
    torque: float = dim(20.0, "µN·m", 1e-4, 1e6, "driving the wheel", CHOSEN)
    drag: float = dim(2.0, "µN·m·s/rad", 1e-6, 1e6, "load on the pinion, in proportion to its speed", CHOSEN)
    pinion_inertia: float = dim(5.0, "mg·cm²", 1e-4, 1e6, "pinion with what it turns", CHOSEN)
    wheel_inertia: float = dim(50.0, "mg·cm²", 1e-4, 1e6, "wheel with what turns it", CHOSEN)
    friction: float = dim(0.0, "", 0.0, 0.4, "coefficient of friction between flanks", "0: to see the form of the teeth alone")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution between flanks", CHOSEN)
