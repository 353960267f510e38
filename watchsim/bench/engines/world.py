"""What must another engine be able to do to be compared?"""

from __future__ import annotations

import importlib
import importlib.util
from dataclasses import dataclass
from typing import Any, Protocol

from watchsim.scene.scene import Scene

MODULES = {"pymunk": "pymunk", "box2d": "Box2D", "mujoco": "mujoco"}
HEAVY = 1e12  # kg: a pivoted body of this mass stays on its pivot without a joint; only its inertia matters


@dataclass(frozen=True, slots=True)
class Setup:
    """How an engine is set up for a scene: its best known way.

    units       length units per metre: engines have lengths of their own built in
    deviation   m, of chords from arcs
    iterations  of the contact solver: velocities, positions
    slop        m of penetration that is left alone, where the engine lets one choose
    ring        duration of a contact in steps, where contacts are springs
    """

    units: float
    deviation: float = 1e-7
    iterations: tuple[int, int] = (20, 10)
    slop: float = 1e-9
    ring: float = 3.2


class World(Protocol):
    """A scene in another engine, at its start."""

    def advance(self, steps: int) -> None:
        """Take that many steps."""

    def place(self, body: str) -> tuple[float, float, float]:
        """x, y (m) and angle (rad, not wrapped) of a body that moves."""


def is_installed(method: str) -> bool:
    """True if the engine can be imported."""
    return importlib.util.find_spec(MODULES[method]) is not None


def version_of(method: str) -> str:
    """The engine's version, as its package says."""
    from importlib.metadata import version

    return version(MODULES[method])


def build(method: str, scene: Scene, step: float, setup: Setup) -> World:
    """The scene in the engine `method`, to be advanced in steps of `step` seconds."""
    maker: Any = importlib.import_module(f"watchsim.bench.engines.{method}_world")
    world: World = maker.build(scene, step, setup)
    return world
