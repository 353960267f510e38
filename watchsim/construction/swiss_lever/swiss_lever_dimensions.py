"""Which numbers does the designer of a Swiss lever escapement choose?

Angles of lock, run, lift and draw are at the lever's pivot and locking corner, of tooth and drop at the wheel's, lift angle and
horn at the balance's. Playtner: H. R. Playtner, An Analysis of the Lever Escapement (1910).
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

PLAYTNER, CHOSEN, USUAL = "Playtner 1910", "chosen for this design", "usual in wristwatches"
ESTIMATE = "estimate: not published for a watch"


@dataclass(frozen=True)
class SwissLever:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(15, "", 9, 30, "teeth of the escape wheel", USUAL)
    embraced: float = dim(2.5, "", 1.5, 7.5, "tooth spaces between the two lockings, a whole number and a half", PLAYTNER)
    tip_radius: float = dim(2.4, "mm", 0.5, 20.0, "escape wheel, to the toes of its teeth", CHOSEN)
    tooth_width: float = dim(4.5, "°", 1.5, 8.0, "of a club tooth from toe to heel, at the wheel's centre", PLAYTNER)
    undercut: float = dim(24.0, "°", 16.0, 32.0, "of a tooth's locking face, from the radius", f"{PLAYTNER}: 20° to 28°")
    lock: float = dim(1.5, "°", 0.1, 4.0, "lever, from the drop of a tooth on the locking face to unlocked", PLAYTNER)
    run: float = dim(0.5, "°", 0.05, 3.0, "lever, from the drop to the banking; lock and run are the total lock", USUAL)
    lift_on_stone: float = dim(4.8, "°", 1.0, 9.0, "lever, a toe driving the impulse face of the entry stone", USUAL)
    lift_on_tooth: float = dim(2.7, "°", 0.3, 6.0, "lever, a tooth's impulse face driving the entry stone", USUAL)
    drop_inside: float = dim(1.2, "°", 0.2, 4.0, "wheel, free from the entry stone's let-off to the exit's lock", USUAL)
    drop_outside: float = dim(1.2, "°", 0.2, 4.0, "wheel, free from the exit stone's let-off to the entry's lock", USUAL)
    draw: float = dim(13.0, "°", 5.0, 25.0, "of the locking faces with the lever on its bank", f"{PLAYTNER}: 12°")
    lever_to_balance: float = dim(4.36, "mm", 1.0, 40.0, "centre distance of lever and balance", CHOSEN)
    lift_angle: float = dim(51.2, "°", 25.0, 75.0, "balance, while the jewel is in the fork", "calibre tables: 44° to 54°")
    jewel_width: float = dim(0.32, "mm", 0.05, 4.0, "diameter of the impulse jewel before its flat is ground", CHOSEN)
    jewel_ground: float = dim(3.0 / 7.0, "", 0.2, 0.5, "of its diameter ground away, to make it D-shaped", PLAYTNER)
    shake: float = dim(0.02, "mm", 0.002, 0.3, "by which the slot of the fork is wider than the jewel", f"{PLAYTNER}: ¼°")
    horn_clearance: float = dim(0.042, "mm", 0.005, 0.5, "between jewel and horn, the lever on its bank", CHOSEN)
    horn_end: float = dim(62.0, "°", 35.0, 80.0, "how far a horn reaches round the balance, the lever on its bank", CHOSEN)
    guard_freedom: float = dim(0.765, "°", 0.1, 2.5, "lever, from its bank until the dart meets the safety roller", CHOSEN)
    safety_ratio: float = dim(
        0.66, "", 0.5, 0.75, "radius of the safety roller by that of the jewel's flat", f"{PLAYTNER}: 4/7 to 2/3"
    )
    crescent: float = dim(22.0, "°", 12.0, 40.0, "half opening of the crescent, at the balance's centre", CHOSEN)
    wheel_inertia: float = dim(0.05, "mg·cm²", 1e-4, 100.0, "escape wheel with the train as felt there", ESTIMATE)
    lever_inertia: float = dim(0.03, "mg·cm²", 1e-4, 100.0, "lever with stones and dart", ESTIMATE)
    balance_inertia: float = dim(12.0, "mg·cm²", 0.1, 1e4, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(28800.0, "vph", 7200.0, 72000.0, "of the balance on its hairspring, in beats per hour", USUAL)
    q_factor: float = dim(250.0, "", 20.0, 2000.0, "quality factor of the balance without the escapement", "often 200 to 300")
    torque: float = dim(1.0, "µN·m", 1e-3, 1e3, "of the train on the escape wheel", ESTIMATE)
    friction: float = dim(0.12, "", 0.0, 0.5, "coefficient of friction, in all contacts", "0.10 to 0.20, steel on oiled ruby")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(270.0, "°", 60.0, 300.0, "balance, from rest, where it is let go", CHOSEN)
