"""How is a random scene put together from outlines, and which numbers does it get?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations
from typing import TypeVar

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point
from watchsim.geometry.solids import mass_properties
from watchsim.scene.forces import Contact, Damping, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene

T = TypeVar("T")


class Dice:
    """A seeded source: number `k` of seed `s` is the same mechanism on every machine."""

    def __init__(self, seed: int, number: int) -> None:
        self._rng = np.random.default_rng([seed, number])

    def uniform(self, low: float, high: float) -> float:
        """Evenly between both, four significant digits."""
        return float(f"{self._rng.uniform(low, high):.4g}")

    def log(self, low: float, high: float) -> float:
        """Evenly in the logarithm, four significant digits."""
        return float(f"{10.0 ** self._rng.uniform(np.log10(low), np.log10(high)):.4g}")

    def chance(self, share: float) -> bool:
        return bool(self._rng.random() < share)

    def sign(self) -> float:
        return 1.0 if self.chance(0.5) else -1.0

    def number(self, low: int, high: int) -> int:
        """A whole number, both ends included."""
        return int(self._rng.integers(low, high + 1))

    def pick(self, choices: Sequence[T]) -> T:
        return choices[int(self._rng.integers(len(choices)))]

    def friction(self) -> float:
        return 0.0 if self.chance(0.3) else 1.0 if self.chance(0.05) else self.uniform(0.01, 1.0)

    def restitution(self) -> float:
        return 0.0 if self.chance(0.4) else 1.0 if self.chance(0.1) else self.uniform(0.01, 0.99)

    def kink(self, largest: float = 1.5) -> float:
        """An angle between two edges, rad: from rounding to a right angle, either way."""
        return self.sign() * self.log(1e-10, largest)


MM = 1e-3
GRAVITY = (0.0, -9.81)


def fixed(name: str, *loops: Loop, position: Point = (0.0, 0.0), angle: float = 0.0) -> Body:
    return Body(name, "fixed", position, angle, loops=loops)


def pivoted(
    name: str, loop: Loop, position: Point, angle: float = 0.0, spin: float = 0.0, mass: float = 0.0, inertia: float = 0.0
) -> Body:
    """A plate of that `mass`, or poised with that `inertia`."""
    centre = (0.0, 0.0)
    if not inertia:
        found = mass_properties([loop], 1.0, 1.0)
        inertia, centre = found.inertia * mass / found.mass, found.centre
    return Body(name, "pivot", position, angle, (spin,), mass=mass, inertia=inertia, centre_of_mass=centre, loops=(loop,))


def sliding(name: str, loop: Loop, position: Point, direction: float, speed: float, mass: float, angle: float = 0.0) -> Body:
    """Slides along the angle `direction` (rad)."""
    axis = (math.cos(direction), math.sin(direction))
    axis = tuple(0.0 if abs(c) < 1e-15 else c for c in axis)  # type: ignore[assignment]
    return Body(name, "slide", position, angle, (speed,), axis, mass=mass, loops=(loop,))


def free(
    name: str,
    loop: Loop,
    position: Point,
    mass: float,
    angle: float = 0.0,
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Body:
    """A plate whose outline stands where it would with its origin at `position`."""
    found = mass_properties([loop], 1.0, 1.0)
    cx, cy = found.centre
    if math.hypot(cx, cy) < 1e-15:
        cx = cy = 0.0
    c, s = math.cos(angle), math.sin(angle)
    place = (position[0] + c * cx - s * cy, position[1] + s * cx + c * cy)
    inertia = found.inertia_about((cx, cy)) * mass / found.mass
    return Body(name, "free", place, angle, velocity, mass=mass, inertia=inertia, loops=(loop.moved(0.0, (-cx, -cy)),))


def scene(
    dice: Dice,
    title: str,
    bodies: list[Body],
    duration: float,
    *,
    gravity: bool = False,
    torques: tuple[Torque, ...] = (),
    springs: tuple[Spring, ...] = (),
    damping: tuple[Damping, ...] = (),
    law: tuple[float, float] | None = None,
) -> Scene:
    """All pairs of bodies can touch; `law` is (friction, restitution) of all contacts, else drawn, for all or for each."""
    shared = law or ((dice.friction(), dice.restitution()) if dice.chance(0.6) else None)
    contacts = []
    for a, b in combinations(bodies, 2):
        if a.motion == b.motion == "fixed":
            continue
        friction, restitution = shared or (dice.friction(), dice.restitution())
        contacts.append(Contact((Side(a.name), Side(b.name)), friction, restitution))
    return Scene(
        title, tuple(bodies), springs, torques, damping, tuple(contacts), GRAVITY if gravity else (0.0, 0.0), duration=duration
    )
