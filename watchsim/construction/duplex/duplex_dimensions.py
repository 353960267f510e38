"""Which numbers does the designer of a duplex escapement choose?

Angles of notch, drop and letting go are the balance's, of the reach the wheel's.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

ABBOTT = "Abbott, The American Watchmaker and Jeweler (1893), Duplex Escapement"
CHOSEN, ESTIMATE, USUAL = "chosen for this design", "estimate: not published", "usual in duplex watches"


@dataclass(frozen=True)
class Duplex:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(15, "", 10, 16, "of the escape wheel: so many long ones that rest, so many upright ones that drive", USUAL)
    tip_radius: float = dim(6.0, "mm", 1.5, 15.0, "escape wheel, to the points of the resting teeth", CHOSEN)
    roller_ratio: float = dim(1.0 / 15.0, "", 0.04, 0.1, "radius of the roller by that of the resting teeth", ABBOTT)
    intersection: float = dim(
        25.0, "°", 12.0, 40.0, "half of the roller's arc within the circle of the points", f"{ABBOTT}: about 30°"
    )
    notch: float = dim(22.0, "°", 12.0, 40.0, "breadth of the notch, at the roller's centre", CHOSEN)
    impulse_ratio: float = dim(2.0 / 3.0, "", 0.55, 0.75, "radius of the impulse teeth by that of the resting teeth", ABBOTT)
    reach: float = dim(8.5, "°", 6.0, 13.0, "wheel, half overlap of the circles of impulse teeth and pallet", CHOSEN)
    drop: float = dim(10.0, "°", 3.0, 16.0, "balance, by which the pallet is ahead of the tooth that will drive it", ABBOTT)
    letting_go: float = dim(2.0, "°", -40.0, 30.0, "balance, from rest, where the notch lets a tooth go", CHOSEN)
    undercut: float = dim(16.0, "°", 8.0, 21.0, "of the fronts of the teeth, so that points touch", CHOSEN)
    wheel_inertia: float = dim(0.5, "mg·cm²", 1e-3, 100.0, "escape wheel with the train as felt there", ESTIMATE)
    balance_inertia: float = dim(60.0, "mg·cm²", 2.0, 1e4, "balance with roller, pallet and hairspring", ESTIMATE)
    frequency: float = dim(18000.0, "vph", 9000.0, 21600.0, "of the balance on its hairspring, in beats per hour", USUAL)
    q_factor: float = dim(200.0, "", 20.0, 1000.0, "quality factor of the balance without the escapement", ESTIMATE)
    torque: float = dim(4.0, "µN·m", 0.01, 500.0, "of the train on the escape wheel", CHOSEN)
    friction: float = dim(0.07, "", 0.0, 0.2, "coefficient of friction, in all contacts", "oiled brass on polished ruby")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)
    start: float = dim(220.0, "°", 60.0, 280.0, "balance, from rest, where it is let go", CHOSEN)
