"""What does the Swiss lever do when one number of it is changed? Limit cycles, each by `watchsim.steady`.

All of them begin from one scene whose spring counts by its stiffness and whose damping counts by its coefficient: given by
frequency and Q, a heavier balance would be given a stiffer spring.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import watchsim as ws
from watchsim.studies.limit_cycle.cycle import Cycle

Floats = NDArray[np.float64]
CONTACTS = range(4)
STONES, JEWEL = 0, 1  # contacts of the scene: wheel with stones, fork with the roller's jewel
DAY = 86400.0  # s
NOMINAL = 4.0  # Hz
CLEAR = math.radians(35.0)  # beyond this angle the jewel is out of the fork: the lift angle is 51°
REST = 40.0  # s, of the run on which the work is measured
MEASURED = 10  # beats whose work is measured


@dataclass(frozen=True)
class Series:
    """Limit cycles over one quantity, in its SI unit."""

    at: Floats
    cycles: tuple[Cycle, ...]

    def of(self, name: str) -> Floats:
        """A number of every cycle; nan where there is none."""
        values = [getattr(cycle, name) if cycle.found else None for cycle in self.cycles]
        return np.array([math.nan if value is None else value for value in values], float)


def watch() -> ws.Scene:
    """The scene of all studies."""
    scene = ws.load(ws.profiles_dir() / "swiss_lever")
    stiffness, viscous = scene.springs[0].stiffness, scene.damping[0].viscous
    fixed = scene.set("timegrapher.frequency", NOMINAL).set("springs.0.stiffness", stiffness)
    return fixed.set("damping.0.viscous", viscous)


def everywhere(scene: ws.Scene, key: str, value: float) -> ws.Scene:
    """The same number in all declared contacts."""
    for i in CONTACTS:
        scene = scene.set(f"contacts.{i}.{key}", value)
    return scene


def over(scene: ws.Scene, key: str, values: Iterable[float]) -> Series:
    """The limit cycle for each value of one key."""
    at = np.array(list(values), float)
    return Series(at, tuple(ws.steady(scene.set(key, float(value))) for value in at))


def over_torque(scene: ws.Scene, torques: Iterable[float]) -> Series:
    """Over the torque at the escape wheel, N·m, counted positive; the wheel turns clockwise."""
    at = np.array(list(torques), float)
    return Series(at, over(scene, "torques.0.value", -at).cycles)


def both(scene: ws.Scene, key: str, values: Iterable[float]) -> Series:
    """Over a number that is the same in all contacts."""
    at = np.array(list(values), float)
    return Series(at, tuple(ws.steady(everywhere(scene, key, float(value))) for value in at))


def work_per_beat(scene: ws.Scene, cycle: Cycle) -> float:
    """J that the fork gives the balance in a beat, measured at the end of a run that starts near the cycle.

    The balance's energy is read where the jewel is out of the fork, before and after; what the air took in between is added.
    No use is made of what the solver itself books as work.
    """
    run = ws.simulate(scene.set("bodies.balance.angle", f"-{cycle.amplitude_deg}°"), REST)
    column = run.slices["balance"].start
    angle, velocity = run.q[:, column], run.u[:, column]
    stiffness, viscous = scene.springs[0].stiffness, scene.damping[0].viscous
    energy = 0.5 * scene.body("balance").inertia * velocity**2 + 0.5 * stiffness * angle**2
    out = np.abs(angle) > CLEAR
    starts = np.flatnonzero(out[:-1] & ~out[1:])
    ends = np.flatnonzero(~out[:-1] & out[1:]) + 1
    works = []
    for start in starts:
        end = ends[np.searchsorted(ends, start)] if start < ends[-1] else None
        if end is None:
            break
        middle = 0.5 * (velocity[start + 1 : end + 1] + velocity[start:end])
        air = viscous * float(np.sum(middle * np.diff(angle[start : end + 1])))
        works.append(float(energy[end] - energy[start]) + air)
    return float(np.mean(works[-MEASURED:]))


def amplitude_of_work(scene: ws.Scene, cycle: Cycle, work: float) -> float:
    """°: where a harmonic swing loses as much to viscous damping in half a period as it is given, A = √(2w / (π c ω))."""
    assert cycle.period_s is not None
    omega = 2.0 * math.pi / cycle.period_s
    return math.degrees(math.sqrt(2.0 * work / (math.pi * scene.damping[0].viscous * omega)))


def free_period(inertia: float, stiffness: float) -> float:
    """s, of balance and spring alone."""
    return 2.0 * math.pi * math.sqrt(inertia / stiffness)


def deviation_ppm(period: Floats, free: Floats) -> Floats:
    """The escapement's own share of the period, in millionths of it."""
    return 1e6 * (period / free - 1.0)


def slopes(scene: ws.Scene) -> dict[str, tuple[float, float]]:
    """d ln T / d ln I and d ln T / d ln k of the limit cycle, and what of them is the escapement's.

    T = 2π √(I/k) (1 + δ). How δ changes with I and k follows from the derivatives by the other quantities and from mechanics:
    forces have no unit of their own and time has none, so δ's elasticities add up to zero in two ways.
    """
    names = {
        "I": "bodies.balance.inertia",
        "k": "springs.0.stiffness",
        "torque": "torques.0.value",
        "damping": "damping.0.viscous",
        "wheel": "bodies.wheel.inertia",
        "lever": "bodies.lever.inertia",
    }
    found = ws.sensitivity(scene, names.values(), outputs=["rate"])
    assert found.cycle.rate_s_per_d is not None
    scale = DAY + found.cycle.rate_s_per_d
    elastic: dict[str, float] = {}
    for effect in found.effects:
        per_unit = effect.by["rate_s_per_d"].value
        assert per_unit is not None
        elastic[effect.quantity.key] = -per_unit * effect.quantity.value / scale
    by = {name: elastic[key] for name, key in names.items()}
    of_stiffness = -by["torque"] - 0.5 * by["damping"]
    of_inertia = -by["wheel"] - by["lever"] - 0.5 * by["damping"]
    return {"I": (by["I"], of_inertia), "k": (by["k"], of_stiffness)}


def unpoised(scene: ws.Scene, mass: float, offset: tuple[float, float], gravity: tuple[float, float]) -> Cycle:
    """The limit cycle of a balance of that mass (kg) whose centre of mass lies off its staff by so much (m)."""
    inertia = scene.body("balance").inertia
    for key, value in (("mass", mass), ("inertia", inertia), ("centre_of_mass", offset)):
        scene = scene.set(f"bodies.balance.{key}", value)
    return ws.steady(scene.set("scene.gravity", gravity))
