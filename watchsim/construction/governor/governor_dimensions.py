"""Which numbers does the designer of a governor fly choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class Governor:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    torque: float = dim(60.0, "mN·m", 1e-3, 1e5, "of the weight on its drum", CHOSEN)
    ratio: float = dim(600.0, "", 1.0, 1e5, "turns of the fly by those of the drum", "three arbors of 8 to 9 each")
    drum_radius: float = dim(20.0, "mm", 1.0, 500.0, "of the drum", CHOSEN)
    drum_inertia: float = dim(2.0, "kg·cm²", 1e-6, 1e6, "drum with the weight that hangs on it", CHOSEN)
    reach: float = dim(30.0, "mm", 1.0, 500.0, "of the fly's two vanes, from its axis", CHOSEN)
    root: float = dim(6.0, "mm", 0.0, 400.0, "from the axis to where the vanes begin", CHOSEN)
    height: float = dim(35.0, "mm", 1.0, 1000.0, "of the vanes along the axis", CHOSEN)
    thickness: float = dim(1.0, "mm", 0.05, 20.0, "of the vanes", CHOSEN)
    fly_inertia: float = dim(15.0, "g·cm²", 1e-4, 1e7, "fly with its arbor", CHOSEN)
    drag_coefficient: float = dim(
        1.2, "", 0.5, 2.5, "of a vane across the air", "plates across a stream: 1.1 to 2 (Hoerner 1965)"
    )
    air: float = dim(1.2, "kg/m³", 0.1, 5.0, "density", "at 20 °C and sea level")
