"""Which numbers does the designer of a snail and its rack choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class Snail:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    steps: int = dim(12, "", 3, 24, "of the snail: hours that it counts", "12; 4 for quarters")
    distance: float = dim(20.0, "mm", 2.0, 200.0, "of the axes of snail and rack", CHOSEN)
    tail: float = dim(20.0, "mm", 2.0, 200.0, "from the rack's axis to the pin of its tail", "Goodrich: as the distance")
    pin_radius: float = dim(0.4, "mm", 0.02, 5.0, "of that pin", CHOSEN)
    tooth: float = dim(2.5, "°", 0.2, 10.0, "of the rack, for one blow", CHOSEN)
    least: float = dim(4.0, "mm", 0.2, 100.0, "radius of the lowest step", CHOSEN)
    leaf_length: float = dim(50.0, "mm", 1.0, 300.0, "of the rack's spring, a leaf", CHOSEN)
    leaf_width: float = dim(1.5, "mm", 0.02, 20.0, "of the leaf, across the plane", CHOSEN)
    leaf_thickness: float = dim(0.25, "mm", 0.01, 5.0, "of the leaf", CHOSEN)
    leaf_arm: float = dim(3.0, "mm", 0.05, 50.0, "from the rack's axis to the force of the leaf", CHOSEN)
    leaf_force: float = dim(40.0, "mN", 0.1, 1e4, "of the leaf, with the rack gathered up", CHOSEN)
    lifting: float = dim(0.3, "mN·m", 1e-4, 1000.0, "torque that gathers the rack up", CHOSEN)
    hour: float = dim(0.5, "s", 0.01, 3600.0, "from step to step", "short, to be simulated")
    rack_inertia: float = dim(1000.0, "mg·cm²", 1e-3, 1e6, "rack with its tail", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction, in all contacts", "steel on oiled brass")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)
