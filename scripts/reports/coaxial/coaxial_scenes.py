"""Which two scenes are compared, and what is changed in them?

Both with a balance of 12 mg·cm², 25 200 vph, Q 250, friction 0.15, restitution 0, and the same work of the drive in an
oscillation. Spring and damping count by stiffness and coefficient.
"""

from __future__ import annotations

import math
from pathlib import Path

import watchsim as ws
from watchsim.scene.file.read_scene import changed
from watchsim.scene.scene import Scene

IMAGES = Path(__file__).resolve().parents[3] / "docs" / "images"
TORQUE = 0.48  # µN·m on the co-axial wheel
PULL = TORQUE * 15.0 / 8.0  # on the lever's escape wheel: the same work in an oscillation
FRICTION = 0.15
NAMES = {"coaxial": "co-axial", "swiss_lever": "Swiss lever"}
PITCHES = {"coaxial": math.tau / 8.0, "swiss_lever": math.tau / 15.0}  # rad of the wheel in an oscillation
FREQUENCY = 3.5  # Hz
INERTIA, Q_FACTOR = 12e-10, 250.0  # kg·m²
STIFFNESS = INERTIA * (math.tau * FREQUENCY) ** 2  # N·m/rad


def scenes() -> dict[str, Scene]:
    """The two, everything recorded."""
    found = {}
    for name, pull in (("coaxial", TORQUE), ("swiss_lever", PULL)):
        alike = {
            "springs.0.frequency": "25200 vph",
            "torques.0.value": f"{-pull} µN·m",
            "damping.0.q_factor": Q_FACTOR,
            "run.record": "all",
            "bodies.balance.inertia": "12 mg·cm²",
        }
        scene = changed(ws.load(ws.profiles_dir() / name), alike)
        viscous = scene.damping[0].viscous
        scene = scene.set("timegrapher.frequency", FREQUENCY).set("springs.0.stiffness", scene.springs[0].stiffness)
        found[name] = everywhere(scene.set("damping.0.viscous", viscous), FRICTION, 0.0)
    return found


def everywhere(scene: Scene, friction: float, restitution: float) -> Scene:
    """All contacts alike."""
    asked: dict[str, float] = {}
    for number in range(len(scene.contacts)):
        asked |= {f"contacts.{number}.friction": friction, f"contacts.{number}.restitution": restitution}
    return changed(scene, asked)


def pulled(scene: Scene, share: float) -> Scene:
    """With a share of the torque."""
    return scene.set("torques.0.value", scene.torques[0].value * share)


def supplied(name: str, scene: Scene) -> float:
    """J that the drive puts in during an oscillation."""
    return abs(scene.torques[0].value) * PITCHES[name]


def bound(work: float) -> float:
    """Amplitude (°) if all of the work in an oscillation reached the balance: work = π k A² / Q."""
    return math.degrees(math.sqrt(work * Q_FACTOR / (math.pi * STIFFNESS)))
