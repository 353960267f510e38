"""What of a mechanism does a return map look at?"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.teeth import pitch
from watchsim.mechanism.compile import Compiled
from watchsim.model.records import OVER_TIME
from watchsim.scene.carriers import rides
from watchsim.scene.force import Torque
from watchsim.scene.gear_trains import bonds
from watchsim.scene.oscillation import frequency, nominal_frequency
from watchsim.scene.roles import drive_direction, keeps_time, roles
from watchsim.scene.scene import Scene


@dataclass(frozen=True)
class Parts:
    """The oscillator and, where there is one, the escape wheel; SI.

    coordinate  of the oscillator; `body` its number in the scene; `level` where it stands in balance
    wheel       coordinate of the escape wheel, -1 without one; `sense` the way it is driven; `pitch` None without equal teeth
    period      of small swings; `nominal` what the rate is measured against
    has_lever   True where a lever stands between the two
    touching    by contact: True where it touches the oscillator; a last False stands for no contact (-1)
    """

    coordinate: int
    body: int
    level: float
    wheel: int
    sense: float
    pitch: float | None
    period: float
    nominal: float
    has_lever: bool
    touching: NDArray[np.bool_]

    @property
    def teeth(self) -> int | None:
        return round(2.0 * np.pi / self.pitch) if self.pitch else None


def parts_of(scene: Scene, compiled: Compiled) -> Parts | None:
    """None where nothing swings on its own."""
    found, hertz = roles(scene), frequency(scene)
    if found.oscillator is None or hertz is None:
        return None
    names = [body.name for body in scene.bodies]
    body, model = names.index(found.oscillator), compiled.model
    coordinate = compiled.slices[found.oscillator].start
    owner = model.primitives.body
    touching = np.append((owner[model.contacts.a] == body) | (owner[model.contacts.b] == body), False)
    # A wheel geared to another body stands where that one's coordinate says.
    bond = bonds(scene.bodies, rides(scene.bodies))[names.index(found.wheel)] if found.wheel else None
    part = pitch(scene, found.wheel) if found.wheel and keeps_time(scene) else None
    return Parts(
        coordinate,
        body,
        float(model.coordinates[coordinate].level),
        int(model.bodies[bond.to].first) if bond else -1,
        drive_direction(scene, found.wheel) * math.copysign(1.0, bond.told) if found.wheel and bond else 1.0,
        part / abs(bond.told) if part and bond else None,
        1.0 / hertz,
        1.0 / (nominal_frequency(scene) or hertz),
        found.lever is not None,
        touching,
    )


def with_springs_held(scene: Scene) -> Scene:
    """The scene with every mainspring kept as far wound as at the start: a watch settles in minutes, it runs down in days."""
    if not any(torque.mainspring for torque in scene.torques):
        return scene
    held = tuple(Torque(torque.body, torque.value) if torque.mainspring else torque for torque in scene.torques)
    return dataclasses.replace(scene, torques=held)


def why_no_section(compiled: Compiled, parts: Parts) -> str:
    """Why no turning point can stand for the whole state; "" where one can."""
    model = compiled.model
    if any(table.over >= OVER_TIME for table in model.tables):
        return "a torque over time drives the mechanism, so that no state of it comes back"
    if any(own == parts.coordinate for own, _, _ in compiled.against) or model.coordinates[parts.coordinate].watched == 0:
        return "the oscillator rides on a moving body"
    return ""
