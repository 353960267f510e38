"""Which numbers does the designer of a detent escapement choose?

A marine chronometer's size. Angles are those of the detent, where nothing else is said.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

LAYOUT = "construction by overlapping circles, docs/guide/mechanisms.md"
USUAL, CHOSEN = "usual in marine chronometers", "chosen for this design"
ESTIMATE = "estimate: not published"


@dataclass(frozen=True)
class Detent:
    """The dimensions with their defaults; lengths that are not named here scale with the wheel."""

    teeth: int = dim(15, "", 12, 18, "of the escape wheel", USUAL)
    tip_radius: float = dim(6.5, "mm", 2.0, 10.0, "escape wheel, to its tips", CHOSEN)
    reach: float = dim(10.5, "°", 8.0, 11.0, "wheel, half overlap of the circles of tips and impulse stone", LAYOUT)
    stone_ratio: float = dim(0.5, "", 0.4, 0.6, "impulse stone's reach from the balance's centre, by the tip radius", LAYOUT)
    inside: float = dim(
        6.0, "°", 2.0, 12.0, "balance, by which the impulse stone is in the overlap when the tooth is let go", LAYOUT
    )
    lock: float = dim(1.2, "°", 0.6, 2.0, "from its bank until the tooth is let go", LAYOUT)
    travel: float = dim(3.0, "°", 2.0, 4.5, "from its bank until the discharging stone lets it go", LAYOUT)
    clearance: float = dim(
        0.5, "°", 0.2, 1.5, "by which the passing spring's tip stands before the line from pivot to balance", LAYOUT
    )
    draw: float = dim(12.0, "°", 9.0, 18.0, "of the locking face", "as in a lever, Playtner 1910")
    foot: float = dim(1.1, "", 0.8, 1.6, "from the locking to the detent's pivot, by the tip radius", LAYOUT)
    discharge_ratio: float = dim(
        0.24, "", 0.18, 0.3, "discharging stone's reach from the balance's centre, by the tip radius", LAYOUT
    )
    discharge_radius: float = dim(0.22, "mm", 0.1, 0.3, "of the discharging stone, a round pin", CHOSEN)
    undercut: float = dim(25.0, "°", 18.0, 32.0, "of the teeth's fronts from the radius, so that tips lock", USUAL)
    letting_go: float = dim(-22.5, "°", -40.0, 0.0, "balance, from rest, where the tooth is let go", "impulse even about rest")
    wheel_inertia: float = dim(15.0, "mg·cm²", 1.0, 200.0, "escape wheel with the train as felt there", ESTIMATE)
    detent_inertia: float = dim(8.0, "mg·cm²", 0.5, 100.0, "detent without the passing spring", ESTIMATE)
    detent_torque: float = dim(6.0, "µN·m", 0.5, 100.0, "of the detent's spring, on its bank", CHOSEN)
    detent_stiffness: float = dim(40.0, "µN·m/rad", 1.0, 1000.0, "of the detent's spring", CHOSEN)
    passing_inertia: float = dim(0.02, "mg·cm²", 0.001, 1.0, "passing spring, a leaf of gold, as felt at its root", ESTIMATE)
    passing_torque: float = dim(0.8, "µN·m", 0.05, 10.0, "of the passing spring against the detent's horn", CHOSEN)
    passing_stiffness: float = dim(5.0, "µN·m/rad", 0.1, 100.0, "of the passing spring at its root", CHOSEN)
    balance_inertia: float = dim(4000.0, "mg·cm²", 50.0, 20000.0, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(14400.0, "vph", 9000.0, 21600.0, "of the balance, in beats per hour", USUAL)
    q_factor: float = dim(400.0, "", 50.0, 2000.0, "quality factor of the balance without the escapement", ESTIMATE)
    torque: float = dim(45.0, "µN·m", 1.0, 500.0, "of the train on the escape wheel", CHOSEN)
    friction: float = dim(0.12, "", 0.0, 0.2, "coefficient of friction, in all contacts", "0.10 to 0.20, steel on ruby")
    restitution: float = dim(0.0, "", 0.0, 0.6, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(250.0, "°", 60.0, 320.0, "balance, from rest, where it is let go", CHOSEN)
