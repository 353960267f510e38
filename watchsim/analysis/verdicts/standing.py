"""Where does a watch that stopped stand, and what holds it?"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.timing.standstill import standstill
from watchsim.analysis.verdicts.equilibrium.in_force import in_force
from watchsim.analysis.verdicts.equilibrium.lever_arms import Arms, arms
from watchsim.analysis.verdicts.equilibrium.statics import at_lever
from watchsim.analysis.verdicts.faces import Face, face
from watchsim.analysis.verdicts.verdict_kinds import STOPS, Verdict, degrees, torque_text, when
from watchsim.analysis.verdicts.watch import Watch

HELD = 1e-4  # rad: an oscillator that moved less for half a period is held


def standing(watch: Watch) -> Verdict | None:
    """The wheel has not advanced for three half swings: on what it rests, and why that does not go on."""
    stands = standstill(watch.run, watch.found)
    if stands is None:
        return None
    why, pair = "", None
    if watch.lever is not None and watch.has_shapes and watch.recorded(np.array([watch.run.simulated]))[0]:
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
        held = not watch.has_modes or any(watch.wheel in both for both in sides.values())
        return "" if held else f"{watch.wheel} touches nothing that holds it", None
    if len(teeth) > 1:
        return _caught(watch, lever, arms(run, watch.compiled, end, teeth)), str(run.pairs[teeth[0]])
    found = arms(run, watch.compiled, end, [teeth[0], *pins])
    rests, pair = face(watch, found, 0), str(found.pairs[0])
    moving = _still_moving(watch)
    if not pins or moving:
        return f"{rests}; {_without_pin(watch, moving, rests)}", pair
    why = _torques(watch, lever, found, rests)
    return (f"{rests}; {why}", pair) if why else ("", pair)


def _caught(watch: Watch, lever: str, found: Arms) -> str:
    """Two contacts of the wheel hold the lever: as where, for want of drop, the recoiling wheel meets the other pallet."""
    places = [f"{face(watch, found, row)} ({pair})" for row, pair in enumerate(found.pairs)]
    held = [name for name, way in (("anticlockwise", 1.0), ("clockwise", -1.0)) if not _passes(watch.wheel, lever, found, way)]
    end = f": as {lever} turns {' or '.join(held)}, {watch.wheel} cannot make way for both" if held else ""
    return " and ".join(places) + end


def _passes(wheel: str, lever: str, found: Arms, way: float) -> bool:
    """Whether some turn of the wheel keeps all gaps open as the lever begins to turn one way."""
    least, most = -np.inf, np.inf
    for row in range(len(found.pairs)):
        opens, by_wheel = found.of(row, lever)[0] * way, found.of(row, wheel)[0]
        if by_wheel > 0.0:
            least = max(least, -opens / by_wheel)
        elif by_wheel < 0.0:
            most = min(most, -opens / by_wheel)
        elif opens < 0.0:
            return False
    return bool(least <= most)


def _still_moving(watch: Watch) -> bool:
    run = watch.run
    late = run.t >= run.simulated - 0.5 * watch.found.nominal_period
    return bool(np.ptp(run.q[late, run.slices[watch.oscillator].start], axis=0) > HELD)


def _without_pin(watch: Watch, moving: bool, rests: Face) -> str:
    at = degrees(float(watch.angle(watch.oscillator, np.array([watch.run.simulated]))[0]) - watch.rest)
    if moving:
        why = f"and {watch.wheel} does not drive it on" if rests.impulse else "but too little to unlock it"
        return f"{watch.oscillator} still swings, now at {at}, {why}"
    return f"{watch.oscillator} is at rest at {at} and does not touch {watch.lever}"


def _torques(watch: Watch, lever: str, found: Arms, rests: Face) -> str:
    """What the one side gives at the lever, and what the other needs: on lock the oscillator drives, on impulse the wheel.

    "" where that would be enough: then something else holds the lever.
    """
    by_wheel = at_lever(found, 0, watch.wheel, lever, rests.out)
    by_pin = [at_lever(found, row, watch.oscillator, lever, rests.out) for row in range(1, len(found.pairs))]
    if by_wheel is None:
        return "friction jams it there"
    given = max((value for value in by_pin if value is not None), key=abs, default=0.0)
    if rests.impulse:
        if abs(by_wheel) > abs(given):
            return ""
        less, more = _told_apart(by_wheel, given)
        needed = f"is below the {more} needed to move {watch.oscillator} (set on impulse)"
        return f"the torque of {watch.wheel} at {lever}, {less}, {needed}"
    if given <= 0.0:
        return f"{watch.oscillator} does not push {lever} out (set on lock)"
    if given > abs(by_wheel):
        return ""
    less, more = _told_apart(given, by_wheel)
    return f"the torque of {watch.oscillator} at {lever}, {less}, is below the {more} needed to unlock (set on lock)"


def _told_apart(first: float, second: float) -> tuple[str, str]:
    """With as many digits as it takes."""
    for digits in (2, 3, 5):
        texts = torque_text(first, digits), torque_text(second, digits)
        if texts[0] != texts[1]:
            break
    return texts
