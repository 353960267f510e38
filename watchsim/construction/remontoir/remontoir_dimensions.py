"""Which numbers does the designer of a remontoir before a Swiss lever choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim
from watchsim.construction.swiss_lever.swiss_lever_dimensions import CHOSEN, ESTIMATE, SwissLever


@dataclass(frozen=True)
class Remontoir(SwissLever):
    """Those of the Swiss lever, of the spring, and of what winds it."""

    torque: float = dim(1.0, "µN·m", 1e-3, 1e3, "of the remontoir's spring in the middle between two windings", ESTIMATE)
    spring_rate: float = dim(0.03, "µN·m/rad", 1e-5, 100.0, "of the remontoir's spring", CHOSEN)
    train: float = dim(12.0, "µN·m", 1e-2, 1e5, "torque of the train on the stop wheel", CHOSEN)
    stop_teeth: int = dim(6, "", 5, 8, "teeth of the stop wheel, and its turns by those of the winder", CHOSEN)
    stop_radius: float = dim(1.5, "mm", 0.3, 10.0, "of the stop wheel, to the points of its teeth", CHOSEN)
    stop_lock: float = dim(0.3, "°", 0.05, 2.0, "stop lever, by which a pallet covers a tooth in the lever's middle", CHOSEN)
    arm: float = dim(4.5, "mm", 1.0, 30.0, "from the stop lever's pivot to the axis of the escape wheel", CHOSEN)
    disc: float = dim(0.4, "mm", 0.05, 5.0, "radius of the eccentric disc", CHOSEN)
    eccentricity: float = dim(0.18, "mm", 0.01, 3.0, "of the disc on the escape wheel", CHOSEN)
    slot_play: float = dim(0.004, "mm", 0.0005, 0.1, "by which the fork's slot is wider than the disc", CHOSEN)
    winder_inertia: float = dim(0.01, "mg·cm²", 1e-4, 100.0, "what holds the outer end of the spring", ESTIMATE)
    stop_wheel_inertia: float = dim(0.5, "mg·cm²", 1e-3, 1e4, "stop wheel with the train as felt there", ESTIMATE)
    stop_lever_inertia: float = dim(0.05, "mg·cm²", 1e-4, 1e3, "stop lever", ESTIMATE)
    stop_friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction at stop lever and disc", "steel on oiled steel")
