"""Which bodies are led and pressed when a scene is turned by hand, and how far?

With an oscillator: it is led through one whole oscillation and the driven wheel is pressed. Without one: the driven wheel is
led by one pitch, and what springs pull is pressed (a click on its ratchet).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from watchsim.candidates.symmetry import turn_symmetry
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.gear_trains import goes_with
from watchsim.scene.oscillation import Oscillator, oscillators
from watchsim.scene.roles import drive_direction, keeps_time
from watchsim.scene.scene import Scene
from watchsim.tolerances import CLEARANCE
from watchsim.turning.moves import assembly
from watchsim.turning.turned_cycle import Cycle

SWING = math.radians(180.0)  # of a balance whose scene starts nearer to rest
BALANCE = math.radians(60.0)  # what starts further from rest swings as far as it starts
CLOSED = 1e-3  # of a pitch, or rad: a cycle that ends so close to where it began is closed


@dataclass(frozen=True)
class Turn:
    """A scene turned by hand: its cycle, and the row from which the last whole cycle counts."""

    scene: Scene
    cycle: Cycle
    teeth: int
    oscillator: str | None
    wheel: str
    first: int

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(body.name for body in self.scene.bodies)

    @property
    def advanced(self) -> float:
        """Teeth by which the wheel went on over the last cycle, in the direction of its drive."""
        number = self.names.index(self.wheel)
        q = self.cycle.q
        return float(drive_direction(self.scene, self.wheel) * (q[-1, number] - q[self.first, number]) / self.cycle.pitch)


def turn(scene: Scene, swing: float | None = None) -> Turn:
    """Lead the scene through a cycle; `swing` (rad, or m) is how far the oscillator goes to either side of its rest.

    SceneError where nothing is driven, or where a part moves in a way that one coordinate does not tell.
    """
    _refuse(scene)
    oscillator = swinging(scene)
    name = None if oscillator is None else oscillator.body
    wheel = _driven(scene, name)
    names = [body.name for body in scene.bodies]
    parts = assembly(scene)
    sign, number = drive_direction(scene, wheel), names.index(wheel)
    teeth = _teeth(scene, wheel)
    pitch = math.tau / teeth
    if oscillator is None:
        rests = {names.index(one.body): one.rest for one in scene.springs}
        pressed = {i: math.copysign(1.0, rest - parts.q[i]) for i, rest in rests.items()}
        parts.stay.update(parts.train(number))
        cycle = Cycle(parts, number, pressed, pitch, rests)
        cycle.follow([parts.q[number] + sign * pitch])
        return Turn(scene, cycle, teeth, None, wheel, 0)
    led = names.index(oscillator.body)
    parts.stay.update(parts.train(led))
    start = parts.q[led] - oscillator.rest
    reach = swing if swing is not None else abs(start) if abs(start) > BALANCE or _hangs(scene, led) else SWING
    far, near = oscillator.rest + math.copysign(reach, start or -1.0), oscillator.rest - math.copysign(reach, start or -1.0)
    cycle = Cycle(parts, led, {number: sign}, pitch)
    ends = [far] if parts.q[led] != far else []
    cycle.follow([*ends, near, far])
    first = cycle.turned[len(ends)] if len(cycle.turned) > len(ends) else 0
    return Turn(scene, cycle, teeth, oscillator.body, wheel, first)


def swinging(scene: Scene) -> Oscillator | None:
    """The oscillator that an escapement keeps going; not the click that a spring presses on a ratchet."""
    found = next(iter(oscillators(scene)), None)
    return found if found is not None and (found.spring == 0.0 or keeps_time(scene)) else None


def closes(found: Turn) -> bool:
    """Does the cycle end as it began, but for whole teeth?"""
    q = found.cycle.q
    back = np.abs(q[-1] - q[found.first])
    train = goes_with(found.scene, found.wheel)
    others = [back[i] for i, body in enumerate(found.scene.bodies) if body.motion != "fixed" and body.name not in train]
    return abs(found.advanced - round(found.advanced)) < CLOSED and all(way < CLOSED for way in others)


def _driven(scene: Scene, oscillator: str | None) -> str:
    """The wheel that is pressed: what is driven, or the first in its train that may touch something."""
    driven = next(torque.body for torque in scene.torques if torque.body != oscillator)
    touching = {side.body for contact in scene.contacts for side in contact.sides}
    return next((name for name in goes_with(scene, driven) if name in touching and scene.body(name).motion == "pivot"), driven)


def _hangs(scene: Scene, led: int) -> bool:
    """Does it swing without a spring, as a pendulum does?"""
    return all(spring.body != scene.bodies[led].name for spring in scene.springs)


def _teeth(scene: Scene, wheel: str) -> int:
    """By how many parts of a turn the wheel's outer outlines come back onto themselves; windows between arms do not count."""
    bodies = tuple(
        replace(body, loops=tuple(loop for loop in body.loops if not loop.hole)) if body.name == wheel else body
        for body in scene.bodies
    )
    compiled = compile_scene(replace(scene, bodies=bodies))
    number = [body.name for body in scene.bodies].index(wheel)
    own = compiled.model.primitives[compiled.model.primitives.body == number]
    return turn_symmetry(own, 0.5 * CLEARANCE * compiled.size).fold


def _refuse(scene: Scene) -> None:
    """SceneError with all that keeps a scene from being turned by hand."""
    faults = []
    found = swinging(scene)
    name = None if found is None else found.body
    if not any(torque.body != name for torque in scene.torques):
        faults.append(
            Fault(
                "torques",
                "nothing is driven: --turn presses a driven wheel against what holds it. Add [[torques]] on the wheel",
            )
        )
    touching = {side.body for contact in scene.contacts for side in contact.sides}
    for body in scene.bodies:
        if body.motion == "free" and body.name in touching:
            faults.append(
                Fault(
                    f"bodies.{body.name}.motion", "free: --turn leads bodies along one coordinate; give it a pivot or an axis"
                )
            )
        if body.on is not None:
            faults.append(
                Fault(f"bodies.{body.name}.on", f'"{body.on}": --turn does not know carried bodies; put them on the movement')
            )
    if faults:
        raise SceneError(faults)
