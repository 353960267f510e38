"""Which dimensions of a pin-wheel escapement do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.outline import angle_of
from watchsim.construction.pin_wheel.pin_wheel_dimensions import PinWheel
from watchsim.construction.pin_wheel.pin_wheel_points import PinAnchor

LEAST_DRIVEN = 1.0  # degrees of the wheel
SLOPES = (20.0, 80.0)  # degrees of an impulse face from the resting face
LEAST_SPACE = 0.5  # of a pin's radius, between two pins
SPARE = 0.3  # degrees of resting face beyond the start


def conflicts(values: PinWheel) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    anchor = PinAnchor(values)
    if values.lock >= values.lift:
        yield Conflict("lock", f"must be less than the lift of {values.lift:g}°: the impulse would end before the middle")
    if values.start <= anchor.released:
        yield Conflict("start", f"must be more than {anchor.released:.4g}°, else no pin is let off")
    most = anchor.unlocked + values.reach - SPARE
    if values.start > most:
        words = f"must be more than {values.start - most + values.reach:.4g}°"
        yield Conflict("reach", f"{words}: pins would run past the resting faces")
    if anchor.driven < LEAST_DRIVEN:
        most = anchor.half_pitch - LEAST_DRIVEN
        yield Conflict("drop", f"must be at most {most:.4g}° with {values.pins} pins: nothing would be left for the impulse")
        return
    yield from _drive(values, anchor)
    chord = 2.0 * values.pin_circle * math.sin(math.radians(anchor.half_pitch))
    if (2.0 + LEAST_SPACE) * anchor.pin > chord:
        most = 2.0 * chord / (2.0 + LEAST_SPACE)
        yield Conflict("pin_diameter", f"must be at most {most:.3g} mm: there is hardly any space between two pins")
    for side in (1, -1):
        slope = _slope(anchor, side)
        if not SLOPES[0] <= slope <= SLOPES[1]:
            name = "pin_diameter" if slope > SLOPES[1] else "lift"
            words = f"gives an impulse face that falls by {slope:.3g}° from the resting face"
            yield Conflict(name, f"{words}; {SLOPES[0]:g}° to {SLOPES[1]:g}° work")


def _drive(values: PinWheel, anchor: PinAnchor) -> Iterator[Conflict]:
    """The swing that the drive would keep up if none of its work were lost but by damping: w = π k A² / 2 Q in a beat."""
    stiffness = values.bob_mass * values.gravity * 1e-3 * values.pendulum
    work = 1e-3 * values.torque * math.radians(anchor.driven)
    swing = math.degrees(math.sqrt(2.0 * work * values.q_factor / (math.pi * stiffness)))
    most = anchor.unlocked + values.reach - SPARE
    if swing > most:
        words = f"must be less than {values.torque * (most / swing) ** 2:.4g} mN·m"
        yield Conflict("torque", f"{words}: without friction the pendulum would swing by {swing:.3g}°, past the resting faces")
    if swing < anchor.released:
        words = f"must be more than {values.torque * (anchor.released / swing) ** 2:.4g} mN·m"
        yield Conflict("torque", f"{words}: the pendulum would swing by {swing:.3g}° at most, and let off no pin")


def _slope(anchor: PinAnchor, side: int) -> float:
    """Of an impulse face, from the direction in which the resting face goes on."""
    locking, let_off = anchor.corners(side)
    ahead = angle_of(locking) + side * 90.0
    return side * ((ahead - angle_of(let_off, locking) + 180.0) % 360.0 - 180.0)
