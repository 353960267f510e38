"""Which body is the oscillator, which the escape wheel, which the lever?

Names in a scene are free, so the roles follow from what the bodies do: the oscillator swings on a spring or as a pendulum,
the wheel is driven, the lever touches both.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from watchsim.scene.gear_trains import goes_with
from watchsim.scene.oscillation import oscillators
from watchsim.scene.scene import Scene


@dataclass(frozen=True, slots=True)
class Roles:
    """Names of bodies; None where a scene has no such part."""

    oscillator: str | None
    wheel: str | None
    lever: str | None


def roles(scene: Scene) -> Roles:
    """The first that swings, a driven pivoted body besides it, and a moving body in contact with both.

    A body may be driven through gears, and touch by way of what it carries.

    Of several driven bodies the wheel is the first that has such a lever, whatever the order of the torques: a lever may be
    knocked by a torque of its own.
    """
    oscillator = next((one.body for one in oscillators(scene)), None)
    driven = [name for torque in scene.torques for name in goes_with(scene, torque.body) if torque.body != oscillator]
    wheels = [name for name in driven if scene.body(name).motion == "pivot"]
    found = [(wheel, None if oscillator is None else _lever(scene, oscillator, wheel)) for wheel in wheels]
    wheel, lever = next((one for one in found if one[1] is not None), found[0] if found else (None, None))
    return Roles(oscillator, wheel, lever)


def with_anchor(scene: Scene) -> Roles:
    """The same; a pendulum with its anchor, driven by the wheel itself, is the lever, too; so is one with hinged pallets."""
    found = roles(scene)
    if hinged_pallets(scene):
        return replace(found, lever=found.oscillator)
    if found.wheel is None or found.oscillator is None or found.lever is not None or not keeps_time(scene):
        return found
    return replace(found, lever=found.oscillator) if found.oscillator in partners(scene, found.wheel) else found


def hinged_pallets(scene: Scene) -> tuple[str, ...]:
    """The bodies, two or more, that turn on the oscillator itself and touch the wheel, as in a grasshopper escapement."""
    found = roles(scene)
    if found.oscillator is None or found.wheel is None or not keeps_time(scene):
        return ()
    touched = partners(scene, found.wheel)
    hinged = [b.name for b in scene.bodies if b.on == found.oscillator and b.motion == "pivot" and b.name in touched]
    return tuple(hinged) if len(hinged) > 1 else ()


def _lever(scene: Scene, oscillator: str, wheel: str) -> str | None:
    both = partners(scene, oscillator) & partners(scene, wheel) - {oscillator, wheel}
    pivoted = [body.name for body in scene.bodies if body.motion == "pivot"]
    direct = next((name for name in pivoted if name in both), None)
    return direct or next((name for name in pivoted if _reaches(scene, name, oscillator, wheel)), None)


def _reaches(scene: Scene, name: str, oscillator: str, wheel: str) -> bool:
    """Does the body touch both by way of what it carries, as a detent does with its passing spring?"""
    own = {name} | {body.name for body in scene.bodies if body.on == name}
    touched = set().union(*(partners(scene, one) for one in own))
    return not own & {oscillator, wheel} and {oscillator, wheel} <= touched


def swings(scene: Scene) -> bool:
    """Does anything swing, on a spring or by gravity?"""
    return bool(oscillators(scene))


def keeps_time(scene: Scene) -> bool:
    """True for an oscillator that swings alone or is kept going by an escapement; False for a ratchet's click on its spring.

    A driven wheel makes an escapement where a lever stands between it and the oscillator, or where the scene names a lift
    angle; a wheel that touches the sprung body itself may as well be held by it.
    """
    found = roles(scene)
    return found.oscillator is not None and (found.wheel is None or found.lever is not None or scene.lift_angle is not None)


def only_presses(scene: Scene) -> bool:
    """Is the spring there to press, as that of a jumper, a click or a cam's follower?

    The sprung body then rests on a driven wheel that is no escapement's, or all that drives are bodies moved as the scene says.
    """
    found = roles(scene)
    if found.oscillator is None:
        return False
    if found.wheel is not None:
        return not keeps_time(scene)
    return not is_driven(scene) and any(body.prescribed is not None for body in scene.bodies)


def is_driven(scene: Scene) -> bool:
    """Does a torque or a force put work in?"""
    return any(torque.table or torque.value for torque in scene.torques)


def partners(scene: Scene, name: str) -> set[str]:
    """The bodies that a declared contact lets touch body `name`."""
    pairs = [{side.body for side in contact.sides} for contact in scene.contacts]
    return set().union(*(pair - {name} for pair in pairs if name in pair))


def drive_direction(scene: Scene, name: str) -> float:
    """+1 or -1: the way the torques on body `name`, and on what is geared to it, turn it (the mean of a table)."""
    total, ratios = 0.0, goes_with(scene, name)
    for torque in scene.torques:
        if torque.body in ratios:
            mean = sum(value for _, value in torque.table) / len(torque.table) if torque.table else torque.value
            total += ratios[torque.body] * mean
    return -1.0 if total < 0.0 else 1.0
