"""How do hairsprings that bend and weigh come into the model, and what is to be said of one?

Gravity does work on the strip as its centre of gravity c moves with the angle: a torque m g · dc/dθ on the balance, to first
order in the weight, whatever holds the strip. What is elastic follows from the same motion (geometry/elastic_coil.py), scaled
so that the stiffness about rest is the declared one.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from watchsim.geometry.elastic_coil import bending
from watchsim.geometry.primitives import Point
from watchsim.model import COIL, COIL_ENERGY, COIL_TORQUE, Model, Records, records
from watchsim.scene.forces import Spring
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]


def windings(spring: Spring, gravity: Point) -> tuple[float, Array]:
    """(the angle that the series reach, rad; their terms (terms, 4) as `Model.windings`)."""
    assert spring.wound is not None
    bent = bending(spring.wound)
    torque = spring.stiffness * bent.torque
    drawn = spring.coil_mass / bent.furthest * np.asarray(gravity)
    torque[:-1] += drawn @ np.stack([chebyshev.chebder(part) for part in bent.centre])
    energy = -bent.furthest * chebyshev.chebint(torque)
    energy[0] -= chebyshev.chebval(0.0, energy)
    terms = np.zeros((len(energy), 4))
    terms[:-1, 0], terms[:, 1] = torque, energy
    terms[:-1, 2:] = spring.stiffness * bent.force.T
    return bent.furthest, terms


def coiled(scene: Scene) -> tuple[list[Spring], Records, Array]:
    """The springs of a scene that bend and weigh, their rows and terms."""
    springs = [spring for spring in scene.springs if spring.wound is not None]
    rows, terms = records(COIL, len(springs)), [np.zeros((0, 4))]
    for row, spring in zip(rows, springs, strict=True):
        row.furthest, found = windings(spring, scene.gravity)
        row.first, row.count = sum(map(len, terms)), len(found)
        terms.append(found)
    return springs, rows, np.concatenate(terms)


# What is said of it?

DAY = 86400.0
SWINGS = (100.0, 200.0, 300.0)  # degrees
NOTHING = 0.005  # mm: a centre of gravity this near to the axis is on it (Phillips)
PHASES = 720


def rate(spring: Spring, gravity: Point, amplitude: float) -> float:
    """What the coil changes of the rate at that amplitude (rad), s per day: the mean of its torque over a swing."""
    furthest, terms = windings(spring, gravity)
    phase = math.tau * (np.arange(PHASES) + 0.5) / PHASES
    torque = chebyshev.chebval(np.clip(amplitude / furthest * np.cos(phase), -1.0, 1.0), terms[:, 0])
    return -DAY * float(np.mean(torque * np.cos(phase))) / (spring.stiffness * amplitude)


def coil_lines(spring: Spring) -> Iterator[str]:
    """Centre of gravity, side force and isochronism of a hairspring, for `watchsim check`."""
    assert spring.wound is not None
    bent = bending(spring.wound)
    x, y = (1e3 * float(chebyshev.chebval(0.0, part)) for part in bent.centre)
    far, toward = math.hypot(x, y), math.degrees(math.atan2(y, x))
    strip = f"{spring.wound.turns:g} turns, {1e3 * bent.length:.4g} mm long, {1e6 * spring.coil_mass:.4g} mg"
    if far <= NOTHING:
        yield f"    coil: {strip}; centre of gravity on the axis at rest: Phillips's condition holds"
    else:
        yield (
            f"    coil: {strip}; centre of gravity {far:.3f} mm from the axis at rest, towards {toward:.0f}°: "
            "Phillips's condition (on the axis) does not hold"
        )
    reach = min(bent.furthest, math.radians(SWINGS[-1])) / bent.furthest
    ends = np.array([-reach, reach])
    pull = spring.stiffness * max(np.hypot(*(chebyshev.chebval(ends, part) for part in bent.force)))
    yield f"    coil: side force on the pivots up to {1e6 * pull:.4g} µN at {math.degrees(reach * bent.furthest):.0f}°"
    swings = [a for a in SWINGS if math.radians(a) <= bent.furthest]
    own = ", ".join(f"{rate(spring, (0.0, 0.0), math.radians(a)):+.1f} s/d at {a:.0f}°" for a in swings)
    yield f"    coil: isochronism of its two pinnings (Grossmann): {own}"
    if spring.coil_mass:
        sides = ((9.80665, 0.0), (0.0, 9.80665))

        def poise(a: float) -> float:
            plain = rate(spring, (0.0, 0.0), a)
            return math.hypot(*(rate(spring, side, a) - plain for side in sides))

        upright = ", ".join(f"{poise(math.radians(a)):.2f} s/d at {a:.0f}°" for a in swings)
        yield f"    coil: its weight, upright, changes the rate by up to {upright}"


def of_coil(model: Model, k: int, column: int, way: Array) -> Array:
    """One series of the coil of coordinate k at many angles from rest, as `dynamics.coils` has it at one."""
    row = model.coils[model.coordinates[k].coil - 1]
    terms = model.windings[row.first : row.first + row.count]
    near = np.clip(way, -row.furthest, row.furthest)
    value = chebyshev.chebval(near / row.furthest, terms[:, column])
    if column == COIL_ENERGY:
        value = value - chebyshev.chebval(near / row.furthest, terms[:, COIL_TORQUE]) * (way - near)
    return np.asarray(value)
