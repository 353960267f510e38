"""Which numbers does the designer of a cylinder escapement choose?

Angles of lift and lock are the balance's, of teeth and drop the wheel's.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

HEADRICK = "Headrick 1997, Clock and Watch Escapement Mechanics, ch. 18"
CHOSEN, ESTIMATE, USUAL = "chosen for this design", "estimate: not published", "usual in cylinder watches"


@dataclass(frozen=True)
class Cylinder:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(15, "", 10, 20, "of the escape wheel", HEADRICK)
    centre_distance: float = dim(4.5, "mm", 1.0, 20.0, "of wheel and balance", CHOSEN)
    tooth_width: float = dim(10.0, "°", 4.0, 15.0, "of a tooth's impulse face, at the wheel's centre", HEADRICK)
    drop: float = dim(1.4, "°", 0.1, 4.0, "wheel, free from a let-off to the next rest, the same inside and outside", CHOSEN)
    lift: float = dim(40.0, "°", 20.0, 70.0, "balance, while a tooth drives a lip; mean of both lips", USUAL)
    lock: float = dim(
        8.0, "°", 1.0, 20.0, "balance, from the drop of a tooth until its point is at the lip; of the lesser", USUAL
    )
    wheel_inertia: float = dim(0.4, "mg·cm²", 1e-3, 100.0, "escape wheel with the train as felt there", ESTIMATE)
    balance_inertia: float = dim(15.0, "mg·cm²", 0.5, 1e3, "balance with cylinder and hairspring", ESTIMATE)
    frequency: float = dim(18000.0, "vph", 7200.0, 21600.0, "of the balance on its hairspring, in beats per hour", USUAL)
    q_factor: float = dim(150.0, "", 20.0, 1000.0, "quality factor of the balance without the escapement", ESTIMATE)
    torque: float = dim(0.4, "µN·m", 1e-3, 100.0, "of the train on the escape wheel", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.25, "coefficient of friction, teeth on the cylinder", "oiled steel on steel")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, teeth on the cylinder", CHOSEN)
    start: float = dim(155.0, "°", 40.0, 190.0, "balance, from rest, where it is let go", CHOSEN)
