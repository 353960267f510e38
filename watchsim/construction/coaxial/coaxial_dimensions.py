"""Which dimensions does a co-axial escapement have?

Proportions after descriptions of the flat form (two coplanar impulses, three stones on the lever); no maker's drawing is
public. Angles in degrees: of the wheel, where nothing else is said. Why limits are where they are: docs/guide/coaxial.md, and
`watchsim check --turn` of a design beyond them.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

LAYOUT = "construction by overlapping circles, docs/guide/coaxial.md"
RUNS = "chosen by runs from 60° to 330°, docs/guide/coaxial.md"
PLAYTNER = "as in a lever, Playtner 1910"
WEIGHED = "as drawn in steel 0.06 to 0.09, and the train, docs/guide/coaxial.md"
ESTIMATE = "estimate: not published for a watch"


@dataclass(frozen=True)
class Coaxial:
    """The numbers a designer chooses; lengths that are not named here scale with the wheel."""

    tip_radius: float = dim(2.25, "mm", 1.2, 4.0, "of the large wheel, to its tips", "R. W. Smith names 4.5 mm across")
    direct_reach: float = dim(9.5, "°", 7.0, 10.5, "half overlap of the tip circle and the roller stone's", LAYOUT)
    direct_lead: float = dim(
        11.25, "°", 10.8, 11.7, "from the waiting tooth to the line wheel-balance, first stone locked", LAYOUT
    )
    stone_ratio: float = dim(0.45, "", 0.3, 0.7, "roller stone's reach from the balance's centre, by the tip radius", LAYOUT)
    stone_lag: float = dim(8.0, "°", 0.0, 12.0, "balance, of the roller stone behind the unlocking pin", RUNS)
    indirect_reach: float = dim(9.5, "°", 7.0, 13.0, "half overlap of the small tip circle and the lever stone's", LAYOUT)
    indirect_lever: float = dim(4.5, "°", 3.5, 8.0, "the same at the lever", LAYOUT)
    indirect_offset: float = dim(0.5, "°", -3.0, 3.0, "lever, with its stone on the line wheel-lever", RUNS)
    indirect_lead: float = dim(11.25, "°", 7.5, 14.0, "from the waiting small tooth to that line, second stone locked", RUNS)
    lock: float = dim(1.5, "°", 0.75, 3.0, "lever, total lock of both stones less the run", PLAYTNER)
    run: float = dim(0.5, "°", 0.1, 1.5, "lever, before the banking, taken off the total lock", PLAYTNER)
    lift: float = dim(8.25, "°", 6.0, 11.0, "lever, from bank to bank less lock and both runs", LAYOUT)
    draw: float = dim(12.0, "°", 8.0, 18.0, "of the locking faces, the lever on its bank", PLAYTNER)
    lift_angle: float = dim(
        38.0, "°", 30.0, 55.0, "balance, while its pin is in the fork", "published for calibres 2500 and 8500 of Omega"
    )
    undercut: float = dim(24.0, "°", 18.0, 32.0, "of the teeth's fronts from the radius, so that tips lock", PLAYTNER)
    pin_radius: float = dim(0.15, "mm", 0.08, 0.25, "of the unlocking pin before part of it is ground away", PLAYTNER)
    shake: float = dim(0.02, "mm", 0.005, 0.05, "by which the slot of the fork is wider than the pin", PLAYTNER)
    horn_clearance: float = dim(0.04, "mm", 0.015, 0.08, "between pin and horn, the lever on its bank", PLAYTNER)
    guard_clearance: float = dim(
        0.034, "mm", 0.015, 0.06, "between guard pin and safety roller, the lever on its bank", PLAYTNER
    )
    wheel_inertia: float = dim(0.1, "mg·cm²", 0.01, 10.0, "both wheels with the train as felt there", WEIGHED)
    lever_inertia: float = dim(0.06, "mg·cm²", 0.005, 5.0, "lever with its stones", ESTIMATE)
    balance_inertia: float = dim(12.0, "mg·cm²", 0.5, 200.0, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(
        25200.0, "vph", 14400.0, 36000.0, "of the balance, in beats per hour", "calibres 2500 and 8500 of Omega"
    )
    q_factor: float = dim(250.0, "", 50.0, 1000.0, "quality factor of the balance without the escapement", "often 200 to 300")
    torque: float = dim(0.48, "µN·m", 0.05, 20.0, "of the train on the escape wheel", "for 290°, docs/guide/coaxial.md")
    friction: float = dim(0.15, "", 0.0, 0.3, "coefficient of friction, in all contacts", "0.10 to 0.20, steel on ruby")
    restitution: float = dim(0.0, "", 0.0, 0.6, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(290.0, "°", 60.0, 330.0, "balance, from rest, where it is let go", "chosen")
