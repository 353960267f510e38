"""Which numbers does the designer of a grasshopper escapement choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

CHOSEN = "chosen for this design"


@dataclass(frozen=True)
class Grasshopper:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(60, "", 24, 180, "of the wheel", "Harrison: 120 at larger arcs")
    tip_radius: float = dim(30.0, "mm", 3.0, 300.0, "of the wheel, to the points of its teeth", CHOSEN)
    height: float = dim(2.0, "mm", 0.1, 20.0, "of the teeth", CHOSEN)
    span: int = dim(14, "", 2, 80, "whole pitches between the pallets; half a pitch more at rest", "Harrison: near 90°")
    release: float = dim(3.0, "°", 0.5, 10.0, "pendulum, from rest, where one pallet takes over from the other", CHOSEN)
    overswing: float = dim(0.7, "°", 0.05, 4.0, "pendulum, beyond that, for which the stops are set", CHOSEN)
    nib: float = dim(0.6, "mm", 0.02, 6.0, "of a pallet, reaching inside the circle of the points", CHOSEN)
    pallet_torque: float = dim(2.0, "µN·m", 0.01, 1000.0, "of a pallet's counterweight, which lifts it to its stop", CHOSEN)
    pallet_mass: float = dim(0.1, "g", 1e-4, 100.0, "of a pallet, poised on its pivot", CHOSEN)
    pallet_inertia: float = dim(40.0, "g·mm²", 1e-3, 1e6, "of a pallet", CHOSEN)
    pendulum: float = dim(250.0, "mm", 20.0, 5000.0, "from the pivot to the middle of the bob", "beats half seconds")
    bob_radius: float = dim(30.0, "mm", 2.0, 500.0, "of the bob, a disc", CHOSEN)
    bob_mass: float = dim(0.5, "kg", 1e-3, 100.0, "of the bob", CHOSEN)
    q_factor: float = dim(200.0, "", 5.0, 1e6, "quality factor of the pendulum without the escapement", "estimate: low")
    torque: float = dim(0.8, "mN·m", 1e-3, 1e4, "on the wheel", CHOSEN)
    wheel_inertia: float = dim(30.0, "g·mm²", 1e-3, 1e7, "wheel with the train as felt here", "light: a pallet drives it back")
    gravity: float = dim(9.81, "m/s²", 0.1, 100.0, "acceleration of gravity", "9.81 m/s²")
    friction: float = dim(
        0.2, "", 0.1, 0.5, "coefficient of friction, in all contacts; it holds the nibs", "wood on brass, dry"
    )
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)
