"""Which numbers does the designer of a winding click with recoil choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class WindingClick:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(18, "", 8, 80, "teeth of the ratchet wheel on the barrel's arbor", CHOSEN)
    tip_radius: float = dim(3.0, "mm", 0.3, 50.0, "of the wheel, to the points of its teeth", CHOSEN)
    depth: float = dim(0.6, "mm", 0.02, 10.0, "of the teeth", CHOSEN)
    undercut: float = dim(10.0, "°", 0.0, 30.0, "of the locking faces against the radius", CHOSEN)
    click_length: float = dim(2.0, "mm", 0.2, 50.0, "from the click's pivot to the middle of its nose", CHOSEN)
    nose_radius: float = dim(0.1, "mm", 0.005, 2.0, "of the round nose of the click", CHOSEN)
    reach: float = dim(0.35, "mm", 0.01, 8.0, "of the nose into the circle of the points, on the line of centres", CHOSEN)
    bank: float = dim(
        2.0, "°", -40.0, 40.0, "of the click on its bank, past the line of centres as the wheel runs back", CHOSEN
    )
    leaf_length: float = dim(6.0, "mm", 0.3, 60.0, "of the click's spring, a leaf", CHOSEN)
    leaf_width: float = dim(0.3, "mm", 0.02, 5.0, "of the leaf, across the plane", CHOSEN)
    leaf_thickness: float = dim(0.06, "mm", 0.01, 1.0, "of the leaf", CHOSEN)
    leaf_arm: float = dim(1.5, "mm", 0.05, 20.0, "from the click's pivot to the force of the leaf", CHOSEN)
    leaf_force: float = dim(10.0, "mN", 0.1, 1000.0, "of the leaf, with the click on its bank", CHOSEN)
    mainspring: float = dim(0.5, "mN·m", 0.001, 1000.0, "torque on the wheel, until its coils lie on each other", CHOSEN)
    full: float = dim(120.0, "°", 1.0, 3600.0, "from the start until they do", "short, to be simulated")
    bound: float = dim(4.0, "mN·m/rad", 0.01, 1e5, "stiffness of the coils that lie on each other", CHOSEN)
    winding: float = dim(1.5, "mN·m", 0.002, 3000.0, "torque of the hand that winds", CHOSEN)
    wound_for: float = dim(0.3, "s", 0.01, 10.0, "time for which it winds", CHOSEN)
    viscous: float = dim(0.1, "mN·m·s/rad", 1e-5, 1000.0, "of whatever is wound: keeps the speed down", CHOSEN)
    wheel_inertia: float = dim(50.0, "mg·cm²", 1e-3, 1e6, "wheel with what it turns", CHOSEN)
    click_inertia: float = dim(0.5, "mg·cm²", 1e-4, 1e4, "click", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction of click and wheel", "steel on oiled steel")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution", CHOSEN)
