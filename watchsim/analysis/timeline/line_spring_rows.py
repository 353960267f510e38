"""What have springs between points of bodies stored at the rows of a run, and what do they take and get on the way?"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from watchsim.dynamics.line_springs import line_spring_energies as _energies
from watchsim.dynamics.line_springs import line_spring_powers
from watchsim.model.records import FREE, Model
from watchsim.simulation.record.trajectory import Array


def line_spring_energies(model: Model, q: Array) -> Array:
    """(rows,), J."""
    out = np.zeros(len(q))
    if len(model.lines):
        _energies(model, q, out)
    return out


def held_by_lines(model: Model) -> set[int]:
    """The coordinates that move the ends of springs between points."""
    return {k for line in model.lines for k in _coordinates(model, line.a) + _coordinates(model, line.b)}


def line_spring_power(model: Model, q: Mapping[int, Array], u: Mapping[int, Array]) -> tuple[Array, Array]:
    """What keeps prescribed motions up against them, and what they take by damping, W (rows, coordinates).

    `q` and `u` by coordinate, for all that move their ends. Damping counts with the first end that moves.
    """
    places, speeds = _rows(model, q), _rows(model, u)
    driven, damped = np.zeros_like(places), np.zeros_like(places)
    taken, held = np.zeros((len(places), len(model.lines))), np.zeros(len(places))
    line_spring_powers(model, places, speeds, taken, held)
    for j, line in enumerate(model.lines):
        damped[:, (_coordinates(model, line.a) + _coordinates(model, line.b))[0]] += taken[:, j]
    prescribed = [k for k in sorted(held_by_lines(model)) if model.coordinates[k].driven]
    if prescribed:
        driven[:, prescribed[0]] = held
    return driven, damped


def _rows(model: Model, values: Mapping[int, Array]) -> Array:
    """(rows, coordinates), 0 where nothing is known."""
    out = np.zeros((len(next(iter(values.values()))), len(model.coordinates)))
    for k, value in values.items():
        out[:, k] = value
    return out


def _coordinates(model: Model, body: int) -> list[int]:
    first = int(model.bodies[body].first) if body >= 0 else -1
    if first < 0:
        return []
    return list(range(first, first + (3 if model.bodies[body].motion == FREE else 1)))
