"""Which numbers does the designer of a pin-pallet lever escapement choose?

A Roskopf pocket watch's size. Angles of lock, run and lift are at the lever's pivot, of the drop at the wheel's, lift angle and
horn at the balance's.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim

PLAYTNER, CHOSEN, USUAL = "as in a Swiss lever, Playtner 1910", "chosen for this design", "usual in pin-lever watches"
ESTIMATE = "estimate: not published"


@dataclass(frozen=True)
class PinPallet:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    teeth: int = dim(15, "", 12, 21, "teeth of the escape wheel", USUAL)
    embraced: float = dim(2.5, "", 1.5, 4.5, "tooth spaces between the two pins, a whole number and a half", USUAL)
    tip_radius: float = dim(3.6, "mm", 0.8, 20.0, "escape wheel, to the front corners of its teeth", CHOSEN)
    pallet_pin: float = dim(0.24, "mm", 0.05, 2.0, "diameter of the steel pins that are the pallets", CHOSEN)
    lock: float = dim(2.0, "°", 0.5, 4.0, "lever, from the drop of a tooth on a pin to unlocked", "more than with stones")
    run: float = dim(0.5, "°", 0.1, 2.0, "lever, from the drop to the banking; lock and run are the total lock", PLAYTNER)
    lift: float = dim(10.0, "°", 5.0, 12.0, "lever, from unlocked to let off; all of it is on the teeth", CHOSEN)
    drop: float = dim(
        3.0, "°", 0.5, 6.0, "wheel, from where a heel is below a pin's centre to the next lock, the same on both sides", CHOSEN
    )
    draw: float = dim(12.0, "°", 5.0, 20.0, "by the fronts of the teeth, on the pin with less, lever on its bank", PLAYTNER)
    lever_to_balance: float = dim(6.5, "mm", 1.5, 40.0, "centre distance of lever and balance", CHOSEN)
    lift_angle: float = dim(52.0, "°", 30.0, 75.0, "balance, while the jewel is in the fork", CHOSEN)
    jewel_width: float = dim(0.48, "mm", 0.08, 4.0, "diameter of the impulse pin before its flat is ground", CHOSEN)
    shake: float = dim(0.03, "mm", 0.003, 0.3, "by which the slot of the fork is wider than the impulse pin", PLAYTNER)
    guard_freedom: float = dim(1.0, "°", 0.2, 2.5, "lever, from its bank until the dart meets the safety roller", PLAYTNER)
    safety_ratio: float = dim(0.62, "", 0.5, 0.75, "radius of the safety roller by that of the impulse pin's flat", PLAYTNER)
    crescent: float = dim(25.0, "°", 12.0, 40.0, "half opening of the crescent, at the balance's centre", CHOSEN)
    wheel_inertia: float = dim(0.3, "mg·cm²", 1e-3, 100.0, "escape wheel with the train as felt there", ESTIMATE)
    lever_inertia: float = dim(0.2, "mg·cm²", 1e-3, 100.0, "lever with pins and dart", ESTIMATE)
    balance_inertia: float = dim(35.0, "mg·cm²", 1.0, 1e4, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(18000.0, "vph", 7200.0, 28800.0, "of the balance on its hairspring, in beats per hour", USUAL)
    q_factor: float = dim(150.0, "", 20.0, 1000.0, "quality factor of the balance without the escapement", ESTIMATE)
    torque: float = dim(2.0, "µN·m", 0.01, 1e3, "of the train on the escape wheel", ESTIMATE)
    friction: float = dim(0.12, "", 0.0, 0.3, "coefficient of friction, in all contacts", "oiled steel on brass 0.11 to 0.19")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(250.0, "°", 60.0, 300.0, "balance, from rest, where it is let go", CHOSEN)
