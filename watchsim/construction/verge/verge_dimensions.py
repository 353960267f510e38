"""Which numbers does the designer of a verge escapement choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"
USUAL = "usual: 90° to 110° (Britten, The Watch and Clock Maker's Handbook)"


@dataclass(frozen=True)
class Verge:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(
        27, "", 5, 99, "teeth of the crown wheel; odd, so that the two sides are half a pitch apart", "usual: 11 to 31"
    )
    wheel_radius: float = dim(40.0, "mm", 1.0, 500.0, "of the crown wheel, to the tips of its teeth", CHOSEN)
    flag_angle: float = dim(95.0, "°", 2.0, 130.0, "between the two flags", USUAL)
    lift: float = dim(20.0, "°", 0.5, 40.0, "of the verge from the middle to where a flag lets go", CHOSEN)
    drop: float = dim(0.6, "mm", 0.001, 20.0, "of the wheel from there until the other side meets its flag", CHOSEN)
    undercut: float = dim(25.0, "°", 5.0, 45.0, "of the faces that push, against the wheel's axis", CHOSEN)
    slope: float = dim(38.0, "°", 10.0, 60.0, "of the backs of the teeth, against the wheel's axis", CHOSEN)
    length: int = dim(100, "", 5, 2000, "teeth drawn of each side, as many as pass in a run", CHOSEN)
    torque: float = dim(60.0, "mN·m", 1e-6, 1e5, "on the crown wheel", CHOSEN)
    wheel_inertia: float = dim(200.0, "g·cm²", 1e-6, 1e6, "of the crown wheel and its train", CHOSEN)
    foliot_inertia: float = dim(16.0, "kg·cm²", 1e-6, 1e5, "of verge and foliot", "two arms of 20 cm with 20 g each")
    viscous: float = dim(1.5, "mN·m·s/rad", 0.0, 1e5, "damping of the foliot", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.5, "coefficient of friction of teeth and flags", "steel on oiled brass")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution", CHOSEN)
