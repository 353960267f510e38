"""Which dimensions does a co-axial escapement have?

Proportions after descriptions of the extra-flat form (George Daniels 1980; two coplanar impulses, three lever stones); no
manufacturer's drawing is public. Angles in degrees, lengths in millimetres. Where a limit is no matter of space it was found by
running: watchsim check --turn shows why.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

LAYOUT = "construction of the two overlapping circles, docs/coaxial.md"
RUNS = "chosen by runs from 150° to 330° of amplitude, docs/coaxial.md"
PLAYTNER = "H. R. Playtner, An Analysis of the Lever Escapement, 1910"
ESTIMATE = "estimate: not published for a watch"


@dataclass(frozen=True)
class Coaxial:
    """The numbers a designer chooses."""

    tip_radius: float = dim(2.25, "mm", 1.2, 4.0, "large wheel, to the tips; all that is not named here scales with it", "a wheel of 4.5 mm across is quoted for a modern co-axial watch (R. W. Smith)")  # fmt: skip
    direct_reach: float = dim(9.5, "°", 7.0, 10.5, "turn of the wheel on either side of the balance's line of centres in which the tips of wheel and roller stone overlap; a quarter of the pitch less the freedom of the passing stone", LAYOUT)  # fmt: skip
    direct_lead: float = dim(11.25, "°", 10.8, 11.7, "from the tooth that will give the direct impulse to that line, wheel locked on the first stone; 11.25 puts the passing stone midway between two teeth", LAYOUT)  # fmt: skip
    stone_ratio: float = dim(0.45, "", 0.3, 0.7, "from the balance's centre to the tip of the roller stone, by the radius of the large wheel", LAYOUT)  # fmt: skip
    stone_lag: float = dim(8.0, "°", 0.0, 12.0, "of the roller stone behind the unlocking pin, in the turn of the direct impulse: less, and the impulse is short; more, and the tooth passes under the stone", RUNS)  # fmt: skip
    indirect_reach: float = dim(9.5, "°", 7.0, 13.0, "the same for the small wheel and the lever's impulse stone", LAYOUT)
    indirect_lever: float = dim(4.5, "°", 3.5, 8.0, "turn of the lever on either side of its line of centres in which they overlap", LAYOUT)  # fmt: skip
    indirect_offset: float = dim(0.5, "°", -3.0, 3.0, "lever angle at which its impulse stone stands on that line", RUNS)
    indirect_lead: float = dim(11.25, "°", 7.5, 14.0, "from the small tooth that will give the indirect impulse to that line, wheel locked on the second stone", RUNS)  # fmt: skip
    lock: float = dim(1.5, "°", 0.75, 3.0, "lever angle from drop to unlocking, both locking stones", PLAYTNER)
    run: float = dim(0.5, "°", 0.1, 1.5, "lever angle from drop to the banking", PLAYTNER)
    lift: float = dim(8.25, "°", 6.0, 11.0, "lever angle from unlocking to the next drop", LAYOUT)
    draw: float = dim(12.0, "°", 8.0, 18.0, "of both locking faces, lever on the bank; friction must stay below its tangent", PLAYTNER)  # fmt: skip
    lift_angle: float = dim(38.0, "°", 30.0, 55.0, "turn of the balance with its pin in the fork", "38° is told for calibres 2500 and 8500 of Omega")  # fmt: skip
    undercut: float = dim(24.0, "°", 18.0, 32.0, "of the teeth's front, from the radius: more than the draw, so that only tips touch", PLAYTNER)  # fmt: skip
    pin_radius: float = dim(0.15, "mm", 0.08, 0.25, "unlocking pin, before part of it is ground away", PLAYTNER)
    shake: float = dim(0.02, "mm", 0.005, 0.05, "of the pin in the slot", PLAYTNER)
    horn_clearance: float = dim(0.04, "mm", 0.015, 0.08, "between the pin's edge and the horn it passes, lever on the bank", PLAYTNER)  # fmt: skip
    guard_clearance: float = dim(0.034, "mm", 0.015, 0.06, "of the guard pin from the safety roller, lever on the bank: its freedom must be less than the lock", PLAYTNER)  # fmt: skip
    wheel_inertia: float = dim(0.1, "mg·cm²", 0.01, 10.0, "both wheels and their arbor, with the train as felt there", ESTIMATE)
    lever_inertia: float = dim(0.06, "mg·cm²", 0.005, 5.0, "lever with its stones", ESTIMATE)
    balance_inertia: float = dim(12.0, "mg·cm²", 0.5, 200.0, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(25200.0, "vph", 14400.0, 36000.0, "of the balance on its hairspring, in beats per hour", "25 200 vph are told for calibres 2500 and 8500 of Omega")  # fmt: skip
    q_factor: float = dim(250.0, "", 50.0, 1000.0, "quality factor of the balance without the escapement", "often 200 to 300")
    torque: float = dim(0.48, "µN·m", 0.05, 20.0, "of the train on the escape wheel", "for 290° of amplitude, docs/coaxial.md")
    friction: float = dim(0.15, "", 0.0, 0.3, "coefficient of friction, in all contacts", "0.10 to 0.20, steel on ruby")
    restitution: float = dim(0.0, "", 0.0, 0.6, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(290.0, "°", 60.0, 330.0, "balance, from rest, where it is let go", "chosen")
