"""Which numbers does the designer of a Geneva drive choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class Geneva:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    slots: int = dim(4, "", 3, 16, "slots of the driven wheel", "usual: 4 to 8")
    crank: float = dim(10.0, "mm", 0.2, 200.0, "driver, from its axis to the middle of the pin", CHOSEN)
    pin_radius: float = dim(1.5, "mm", 0.02, 30.0, "of the driving pin", CHOSEN)
    pin_play: float = dim(0.01, "mm", 0.0005, 1.0, "between the pin and either side of a slot", CHOSEN)
    bottom_play: float = dim(0.3, "mm", 0.001, 10.0, "between the pin and the bottom of a slot", CHOSEN)
    lock_radius: float = dim(7.0, "mm", 0.1, 190.0, "of the hollows in the wheel, in which the driver's disc locks it", CHOSEN)
    lock_play: float = dim(0.02, "mm", 0.0005, 1.0, "between the locking disc and a hollow", CHOSEN)
    speed: float = dim(360.0, "°/s", 1.0, 36000.0, "of the driver", CHOSEN)
    wheel_inertia: float = dim(200.0, "g·mm²", 1e-3, 1e9, "driven wheel with what it turns", CHOSEN)
    load: float = dim(0.1, "mN·m", 0.0, 1e6, "dry friction of the driven wheel in its bearing", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.5, "coefficient of friction, in all contacts", "steel on oiled steel")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)
