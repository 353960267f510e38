"""In which state is the watch: which way is up, how warm is it, and how long ago was it wound?

[watch] is read when all else of the scene is known, and changes it: gravity by the position, springs, inertia, damping and
friction by the temperature, the mainspring by the time since it was wound. Rates stay against the frequency of the scene
without it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from watchsim.geometry.primitives import Point
from watchsim.scene.errors import Faults
from watchsim.scene.forces import G, Torque
from watchsim.scene.keys import AT_HOME, THERMAL, WATCH
from watchsim.scene.roles import nominal_frequency, pitch, roles
from watchsim.scene.scene import Scene
from watchsim.scene.values import Table, shown

LYING = ("CH", "CB")  # dial up (cadran en haut), dial down
UPRIGHT = ("12H", "3H", "6H", "9H")
HOUR = re.compile(r"(\d{1,2})H([0-5]\d)?")
NO_MAINSPRING = 'needs a mainspring: a torque with over = "barrel" that drives an escape wheel with equal teeth'


def up_of(position: str, twelve: float = 0.5 * math.pi, from_back: bool = False) -> float | None:
    """Direction (rad) in the movement of what is up in a position of ISO 3158, None where the watch lies; ValueError for
    another text.

    Of a standing watch that hour is up, such as "9H" or "10H30". Hours run clockwise from the direction `twelve`, in a movement
    drawn from its back the other way.
    """
    text = position.strip().upper()
    if text in LYING:
        return None
    found = HOUR.fullmatch(text)
    if found is None or not 1 <= int(found[1]) <= 12:
        listed = ", ".join((*LYING, *UPRIGHT))
        raise ValueError(f'"{position}" is no position. There are {listed}, and those between, such as 10H30')
    hours = int(found[1]) + int(found[2] or 0) / 60.0
    turned = math.remainder(hours, 12.0) * math.tau / 12.0
    return twelve + (turned if from_back else -turned)


@dataclass(frozen=True)
class WatchState:
    """`gravity` m/s², None where the scene's own counts; `warmer` K than where the scene's numbers hold; `since_wound` s, None
    where the scene's `run_down` counts; `thermal` coefficients, 1/K."""

    gravity: Point | None = None
    warmer: float = 0.0
    since_wound: float | None = None
    thermal: Mapping[str, float] = field(default_factory=dict)


def read_watch(mapping: Mapping[str, Any], faults: Faults) -> WatchState:
    table = Table(mapping.get("watch", {}), "watch", WATCH, faults)
    inner = Table(table.mapping.get("thermal", {}), "watch.thermal", THERMAL, faults)
    thermal = {key: inner.quantity(key) for key in THERMAL if key in inner}
    gravity, twelve = None, table.quantity("twelve")
    from_back = table.one_of("seen_from", "dial") == "back"
    if position := table.text("position"):
        try:
            gravity = _pull(up_of(position, twelve, from_back))
        except ValueError as error:
            table.fault("position", str(error))
    since_wound = table.quantity("since_wound") if "since_wound" in table else None
    return WatchState(gravity, table.quantity("temperature") - AT_HOME, since_wound, thermal)


def _pull(up: float | None) -> Point:
    """Gravity in the plane, with the rounding of right angles taken off."""
    return (0.0, 0.0) if up is None else (-G * round(math.cos(up), 15) + 0.0, -G * round(math.sin(up), 15) + 0.0)


def in_state(scene: Scene, state: WatchState, faults: Faults) -> Scene:
    """The scene in that state; itself where [watch] says nothing that changes it."""
    by = {key: math.exp(each * state.warmer) for key, each in state.thermal.items() if each * state.warmer != 0.0}
    if state.gravity is None and not by and state.since_wound is None:
        return scene
    hertz = nominal_frequency(scene)
    torques = scene.torques if state.since_wound is None else _run_down(scene, state.since_wound, hertz, faults)
    scene = replace(scene, nominal=hertz, torques=torques, gravity=scene.gravity if state.gravity is None else state.gravity)
    return _warmed(scene, by) if by else scene


def _warmed(scene: Scene, by: Mapping[str, float]) -> Scene:
    """Stiffness of the oscillator's springs and its inertia, damping, and dry friction, times these factors."""
    stiffness, inertia, damping, friction = (by.get(key, 1.0) for key in ("stiffness", "inertia", "damping", "friction"))
    swinging = roles(scene).oscillator
    return replace(
        scene,
        springs=tuple(
            replace(one, stiffness=one.stiffness * stiffness, cubic=one.cubic * stiffness) if one.body == swinging else one
            for one in scene.springs
        ),
        bodies=tuple(replace(one, inertia=one.inertia * inertia) if one.name == swinging else one for one in scene.bodies),
        damping=tuple(
            replace(one, viscous=one.viscous * damping, quadratic=one.quadratic * damping, coulomb=one.coulomb * friction)
            for one in scene.damping
        ),
        bearings=tuple(replace(one, friction=one.friction * friction) for one in scene.bearings),
        contacts=tuple(replace(one, friction=one.friction * friction, slip=one.slip.times(friction)) for one in scene.contacts),
    )


def _run_down(scene: Scene, seconds: float, hertz: float | None, faults: Faults) -> tuple[Torque, ...]:
    """The torques, the barrel having turned since it was wound: the wheel goes on by a pitch in each oscillation."""
    wheel = roles(scene).wheel
    each = None if wheel is None else pitch(scene, wheel)
    if each is None or hertz is None or all(one.mainspring is None for one in scene.torques):
        faults.add("watch.since_wound", NO_MAINSPRING, shown(scene.source["watch"]["since_wound"]))
        return scene.torques
    return tuple(_unwound(scene, one, seconds * hertz * each) for one in scene.torques)


def _unwound(scene: Scene, torque: Torque, turned: float) -> Torque:
    """The torque of a mainspring after its wheel has turned by so much (rad) since it was wound; others as they are."""
    spring = torque.mainspring
    if spring is None:
        return torque
    run_down = turned / abs(spring.ratio)
    shift = (spring.run_down - run_down) * spring.ratio
    angles, values = np.array(torque.table).T
    angles = angles + shift
    value = float(np.interp(scene.body(torque.body).angle, angles, values))
    spring = replace(spring, run_down=run_down, torque=value * spring.ratio / spring.efficiency)
    return replace(torque, value=value, table=tuple(zip(angles.tolist(), values.tolist(), strict=True)), mainspring=spring)
