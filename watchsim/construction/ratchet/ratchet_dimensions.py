"""Which numbers does the designer of a ratchet wheel and its click choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class Ratchet:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(24, "", 8, 80, "teeth of the ratchet wheel", "usual: 20 to 60")
    tip_radius: float = dim(3.0, "mm", 0.3, 50.0, "of the wheel, to the points of its teeth", CHOSEN)
    depth: float = dim(0.4, "mm", 0.02, 10.0, "of the teeth", CHOSEN)
    undercut: float = dim(5.0, "°", 0.0, 30.0, "of the locking faces against the radius", CHOSEN)
    click_length: float = dim(3.0, "mm", 0.3, 50.0, "from the click's pivot to its nose", CHOSEN)
    click_angle: float = dim(45.0, "°", 10.0, 80.0, "from the radius at the nose to the click", CHOSEN)
    nose_radius: float = dim(0.08, "mm", 0.005, 2.0, "of the round nose of the click", CHOSEN)
    click_force: float = dim(5.0, "mN", 0.01, 1000.0, "of the click's spring at its nose", CHOSEN)
    mainspring: float = dim(0.5, "mN·m", 0.001, 1000.0, "torque on the wheel, which the click holds", CHOSEN)
    winding: float = dim(1.5, "mN·m", 0.002, 3000.0, "torque against it, while the watch is wound", CHOSEN)
    viscous: float = dim(0.1, "mN·m·s/rad", 1e-5, 1000.0, "of whatever is wound: keeps the speed down", CHOSEN)
    wheel_inertia: float = dim(50.0, "mg·cm²", 1e-3, 1e6, "wheel with what it turns", CHOSEN)
    click_inertia: float = dim(0.5, "mg·cm²", 1e-4, 1e4, "click", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction of click and wheel", "steel on oiled steel")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution", CHOSEN)
