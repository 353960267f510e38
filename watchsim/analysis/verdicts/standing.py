"""Where does a watch that stopped stand, and what holds it?"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.standstill import standstill
from watchsim.analysis.verdicts.arms import Arms, arms
from watchsim.analysis.verdicts.faces import Face, face
from watchsim.analysis.verdicts.in_force import in_force
from watchsim.analysis.verdicts.statics import at_lever
from watchsim.analysis.verdicts.watch import Watch
from watchsim.analysis.verdicts.words import STOPS, Verdict, degrees, torque_text, when

HELD = 1e-4  # rad: an oscillator that moved less for half a period is held


def standing(watch: Watch) -> Verdict | None:
    """The wheel has not advanced for three half swings: on what it rests, and why that does not go on."""
    stands = standstill(watch.run, watch.found)
    if stands is None:
        return None
    why, pair = "", None
    if watch.lever is not None and watch.has_shapes and watch.recorded(np.array([watch.run.simulated])).all():
        why, pair = _why(watch, watch.lever)
    last = f". Last amplitude {watch.found.amplitude_deg[-1]:.3g}°" if len(watch.found) else ""
    words = f"{when(stands.since)}  the watch stands: " + (why + last if why else stands.message)
    return Verdict(STOPS, words, stands.since, watch.wheel, pair, watch.drive(watch.run.simulated))


def _why(watch: Watch, lever: str) -> tuple[str, str | None]:
    """A sentence, and the contact of wheel and lever in words."""
    run, end = watch.run, watch.run.simulated
    holding = in_force(run, [end])[0]
    sides = {number: {run.pairs[number].body_a, run.pairs[number].body_b} for number in holding}
    teeth = [number for number in holding if sides[number] == {watch.wheel, lever}]
    pins = [number for number in holding if sides[number] == {watch.oscillator, lever}]
    if not teeth:
        return f"{watch.wheel} touches nothing that holds it" if not any(watch.wheel in both for both in sides.values()) else "", None
    found = arms(run, watch.compiled, end, [teeth[0], *pins])
    rests, pair = face(watch, found, 0), str(found.pairs[0])
    moving = _still_moving(watch)
    if not pins or moving:
        return f"{rests}; {_without_pin(watch, moving)}", pair
    return f"{rests}; {_torques(watch, lever, found, rests)}", pair


def _still_moving(watch: Watch) -> bool:
    run = watch.run
    late = run.t >= run.simulated - 0.5 * watch.found.nominal_period
    return bool(np.ptp(run.q[late, run.slices[watch.oscillator].start], axis=0) > HELD)


def _without_pin(watch: Watch, moving: bool) -> str:
    at = degrees(float(watch.angle(watch.oscillator, np.array([watch.run.simulated]))[0]))
    if moving:
        return f"{watch.oscillator} still swings, now at {at}, but too little to unlock it"
    return f"{watch.oscillator} is at rest at {at} and does not touch {watch.lever}"


def _torques(watch: Watch, lever: str, found: Arms, rests: Face) -> str:
    """What the one side gives at the lever, and what the other needs: on lock the oscillator drives, on impulse the wheel."""
    by_wheel = at_lever(found, 0, watch.wheel, lever, rests.out)
    by_pin = [at_lever(found, row, watch.oscillator, lever, rests.out) for row in range(1, len(found.pairs))]
    pushes = [value for value in by_pin if value is not None]
    given = max(pushes, key=abs) if pushes else 0.0
    if rests.impulse:
        if by_wheel is None:
            return "friction jams it there"
        return (
            f"the wheel's torque at the lever, {torque_text(by_wheel)}, is below the {torque_text(given)} needed to lift {watch.oscillator} "
            "(set on impulse)"
        )
    if by_wheel is None:
        return "friction jams it there"
    if given <= 0.0:
        return f"{watch.oscillator} does not push {lever} out (set on lock)"
    return (
        f"the {watch.oscillator}'s torque at the lever, {torque_text(given)}, is below the {torque_text(by_wheel)} needed to unlock "
        "(set on lock)"
    )
