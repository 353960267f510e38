"""Which parts of a scene are wheel, lever, balance and banking, and which contacts lie between them?

By what touches what, never by name: the oscillator swings on its spring, the train leads from the driving torque to the last
wheel, the lever stands between the two, and the banking is what stands still beside the lever.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled
from watchsim.scene.carriers import is_still
from watchsim.scene.roles import drive_direction, partners, roles
from watchsim.scene.scene import Scene

Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Parts:
    """Names of the parts; `way` is the direction the drive turns the wheel in (±1, + is counter-clockwise).

    `lever` is the oscillator itself in an escapement whose anchor swings with it: `detached` is then False.
    `to_wheel`, `to_banking`, `to_balance` are the model's contacts of the lever; `to_roller` those of wheel and balance, where
    a lever stands between the two all the same (the direct impulse of a co-axial escapement). `guarded` says that the scene
    declares more than one of lever and balance: besides fork and pin, a safety action.
    """

    wheel: str
    lever: str
    balance: str
    way: float
    to_wheel: Integers
    to_banking: Integers
    to_balance: Integers
    to_roller: Integers
    guarded: bool

    @property
    def detached(self) -> bool:
        return self.lever != self.balance


def parts_of(scene: Scene, compiled: Compiled) -> Parts | str:
    """The parts, or a sentence saying why the scene is no escapement with a lever or an anchor."""
    found = roles(scene)
    if found.oscillator is None:
        return "nothing swings on a spring or by gravity"
    chain = _chain(scene, found.oscillator)
    if not chain:
        return f"no driven body leads to {found.oscillator}"
    if found.wheel is not None and found.lever is not None:
        chain = (found.oscillator, found.lever, found.wheel)
    if any(scene.body(name).motion != "pivot" for name in chain):
        return f"a part between {chain[-1]} and {chain[0]} does not turn about a pivot"
    lever, wheel = (chain[0], chain[1]) if len(chain) == 2 else (chain[1], chain[2])
    way = drive_direction(scene, chain[-1]) * (-1.0) ** (len(chain) - 1 - chain.index(wheel))
    still = {body.name for body in scene.bodies if body.name not in chain and _stands(scene, body.name, lever)}
    banking = _between(scene, compiled, lever, still) if lever != found.oscillator else np.zeros(0, np.int64)
    fork = _between(scene, compiled, lever, {found.oscillator}) if lever != found.oscillator else np.zeros(0, np.int64)
    declared = [one for one in scene.contacts if {side.body for side in one.sides} == {lever, found.oscillator}]
    to_wheel = _between(scene, compiled, lever, {wheel})
    roller = _between(scene, compiled, found.oscillator, {wheel}) if lever != found.oscillator else np.zeros(0, np.int64)
    return Parts(wheel, lever, found.oscillator, way, to_wheel, banking, fork, roller, len(declared) > 1)


def _stands(scene: Scene, name: str, lever: str) -> bool:
    """Does the body stand still where the lever's pivot does?"""
    body = scene.body(name)
    return body.motion == "fixed" and (body.on == scene.body(lever).on or is_still(scene, body))


def _chain(scene: Scene, oscillator: str) -> tuple[str, ...]:
    """The shortest way by contacts of moving bodies from the oscillator to a driven one."""
    driven = {torque.body for torque in scene.torques} - {oscillator}
    before: dict[str, str] = {oscillator: ""}
    waiting = deque([oscillator])
    while waiting:
        name = waiting.popleft()
        if name in driven:
            way = [name]
            while before[way[-1]]:
                way.append(before[way[-1]])
            return tuple(reversed(way))
        for other in sorted(partners(scene, name)):
            if other not in before and scene.body(other).motion != "fixed":
                before[other] = name
                waiting.append(other)
    return ()


def _between(scene: Scene, compiled: Compiled, name: str, others: set[str]) -> Integers:
    """The contacts of the model that can ever close between a body and some others."""
    groups = [i for i, one in enumerate(scene.contacts) if _joins({side.body for side in one.sides}, name, others)]
    near = compiled.model.near
    return np.ascontiguousarray(near[np.isin(compiled.model.contacts.group[near], groups)])


def _joins(sides: set[str], name: str, others: set[str]) -> bool:
    return name in sides and bool((sides - {name}) & others)
