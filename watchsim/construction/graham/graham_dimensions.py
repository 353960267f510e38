"""Which numbers does the designer of a dead-beat escapement with its pendulum choose?

Angles of lock and lift are at the pendulum's pivot, of drop and tooth at the wheel's.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN, USUAL = "chosen for this design", "usual in pendulum clocks"


@dataclass(frozen=True)
class Graham:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(30, "", 12, 60, "teeth of the escape wheel", USUAL)
    embraced: float = dim(7.5, "", 2.5, 14.5, "tooth spaces between the two lockings, a whole number and a half", USUAL)
    tip_radius: float = dim(20.0, "mm", 2.0, 200.0, "escape wheel, to the tips of its teeth", CHOSEN)
    tip_width: float = dim(0.15, "°", 0.02, 2.0, "of a tooth's tip, at the wheel's centre", CHOSEN)
    undercut: float = dim(6.0, "°", 1.0, 20.0, "of a tooth's front, from the radius", "about 5°")
    back: float = dim(14.0, "°", 2.0, 40.0, "of a tooth's back, from the radius", CHOSEN)
    lift: float = dim(2.0, "°", 0.3, 8.0, "pendulum, while a tooth drives an impulse face", f"{USUAL}: 1.5° to 3°")
    lock: float = dim(
        0.4, "°", 0.02, 3.0, "pendulum, from the drop of a tooth until it is on the impulse face", f"{USUAL}: ¼° to ½°"
    )
    drop: float = dim(1.5, "°", 0.1, 5.0, "wheel, free from a let-off to the next lock", f"{USUAL}: 1° to 2°")
    pendulum: float = dim(248.5, "mm", 20.0, 5000.0, "from the pivot to the middle of the bob", "beats half seconds")
    bob_radius: float = dim(30.0, "mm", 2.0, 500.0, "of the bob, a disc", CHOSEN)
    bob_mass: float = dim(0.5, "kg", 1e-3, 100.0, "of the bob", CHOSEN)
    q_factor: float = dim(
        200.0, "", 5.0, 1e6, "quality factor of the pendulum without the escapement", "estimate: low, settles soon"
    )
    torque: float = dim(0.24, "mN·m", 1e-4, 1e4, "of the train on the escape wheel", CHOSEN)
    wheel_inertia: float = dim(400.0, "g·mm²", 1e-2, 1e8, "escape wheel with the train as felt there", CHOSEN)
    gravity: float = dim(9.81, "m/s²", 0.1, 30.0, "acceleration of gravity", "mean on the ground")
    friction: float = dim(0.1, "", 0.0, 0.5, "coefficient of friction, teeth on pallets", "hardened steel, oiled")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, teeth on pallets", CHOSEN)
    start: float = dim(2.0, "°", 0.5, 12.0, "pendulum, from rest, where it is let go", CHOSEN)
