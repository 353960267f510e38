"""Which numbers does the designer of a pin-wheel escapement choose?

A tower clock's size. Angles of lock and lift are at the pendulum's pivot, of the drop at the wheel's.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN, GOODRICH = "chosen for this design", "Goodrich, The Modern Clock (1905), ch. IX"
AS_GRAHAM = "as usual with a dead-beat anchor"


@dataclass(frozen=True)
class PinWheel:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    pins: int = dim(30, "", 16, 60, "of the escape wheel, half round", CHOSEN)
    pin_circle: float = dim(50.0, "mm", 5.0, 300.0, "radius of the circle of the pins' centres", CHOSEN)
    pin_diameter: float = dim(2.4, "mm", 0.2, 15.0, "of the pins before their upper half is cut away", CHOSEN)
    arm_ratio: float = dim(1.0, "", 0.75, 1.5, "length of the anchor's arms by the diameter of the pin circle", GOODRICH)
    lift: float = dim(2.0, "°", 0.5, 5.0, "pendulum, while a pin drives an impulse face", AS_GRAHAM)
    lock: float = dim(0.5, "°", 0.05, 2.0, "pendulum, from the drop of a pin until it is on the impulse face", AS_GRAHAM)
    drop: float = dim(1.2, "°", 0.1, 4.0, "wheel, free from a let-off to the next lock", AS_GRAHAM)
    reach: float = dim(4.0, "°", 1.0, 10.0, "of the dead faces, at the pivot, from their corners", CHOSEN)
    pendulum: float = dim(994.0, "mm", 100.0, 5000.0, "from the pivot to the middle of the bob", "beats seconds")
    bob_radius: float = dim(110.0, "mm", 5.0, 600.0, "of the bob, a disc", CHOSEN)
    bob_mass: float = dim(12.0, "kg", 0.01, 500.0, "of the bob", CHOSEN)
    q_factor: float = dim(
        300.0, "", 5.0, 1e6, "quality factor of the pendulum without the escapement", "estimate: low, settles soon"
    )
    torque: float = dim(24.0, "mN·m", 1e-3, 1e5, "of the train on the escape wheel", CHOSEN)
    wheel_inertia: float = dim(2e5, "g·mm²", 1.0, 1e9, "escape wheel with the train as felt there", CHOSEN)
    gravity: float = dim(9.81, "m/s²", 0.1, 30.0, "acceleration of gravity", "mean on the ground")
    friction: float = dim(0.1, "", 0.0, 0.4, "coefficient of friction, pins on pallets", "hardened steel, oiled")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, pins on pallets", CHOSEN)
    start: float = dim(2.4, "°", 0.3, 10.0, "pendulum, from rest, where it is let go", CHOSEN)
