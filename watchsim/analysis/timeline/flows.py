"""Where was the energy of a run at its rows, and what has flowed between them, friction and impacts of contacts apart?

Between two rows positions are quintics and velocities cubics (simulation.trajectory), so that the integrals over a step are
finite sums: Gauss's rule with five points is exact for their squares.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.contact_forces import absolute
from watchsim.mechanism.compile import Compiled
from watchsim.model.records import OVER_TIME, Model
from watchsim.simulation.record.trajectory import Array, Trajectory

NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)
QUIET = 1e-12  # of the forces that act: an acceleration that they explain to this owes nothing to contacts
NODES, WEIGHTS = 0.5 * (NODES + 1.0), 0.5 * WEIGHTS


@dataclass(frozen=True)
class Flows:
    """One entry per row of the run, SI.

    t       s
    q, u    absolute coordinates and velocities (rows, n)
    stored  kinetic energy and energy of springs, J
    own     the same of each coordinate (rows, n); springs between carried bodies count with neither
    drive   work of torques, weights and tables so far, J
    driven  the same on each coordinate
    damped  what damping and dry bearings of each coordinate have taken so far, J (rows, n)
    swept   integral of each coordinate over time so far, rad s
    """

    t: Array
    q: Array
    u: Array
    stored: Array
    own: Array
    drive: Array
    driven: Array
    damped: Array
    swept: Array


def flows(run: Trajectory, compiled: Compiled, rows: slice = slice(None)) -> Flows:
    """Of some rows that follow each other without a gap."""
    model, t = compiled.model, run.t[rows]
    q, u = absolute(compiled, run.q[rows], False), absolute(compiled, run.u[rows], True)
    a = absolute(compiled, run.a[rows], True)
    c = model.coordinates
    way = q - np.asarray(c.rest)
    own = 0.5 * (np.asarray(c.mass) * u**2 + np.asarray(c.stiffness) * way**2)
    own[:, np.asarray(c.driven) != 0] = 0.0  # a prescribed motion holds no energy that counts
    stored = own.sum(axis=1)
    for joint in model.joints:
        wound = q[:, joint.coordinate] - q[:, joint.on] - joint.rest
        stored = stored + 0.5 * joint.stiffness * wound**2
    h = np.diff(t)
    driven, damped = np.zeros((len(h), q.shape[1])), np.zeros((len(h), q.shape[1]))
    for node, weight in zip(NODES, WEIGHTS, strict=True):
        qs, us = _at(node, h[:, None], (q, u, a))
        time = t[:-1] + node * h
        driven += weight * h[:, None] * _drive_power(model, time, qs, us)
        damped += weight * h[:, None] * _damping_power(model, us)
    free = _in_flight(model, own, (q, u, a)) & (h > 0.0)[:, None]
    damped = np.where(free, own[:-1] - own[1:] + driven, damped)
    step = h[:, None]
    swept = step * (0.5 * (q[:-1] + q[1:]) + step * (0.1 * (u[:-1] - u[1:]) + step * (a[:-1] + a[1:]) / 120.0))
    driven, damped, swept = (_so_far(values) for values in (driven, damped, swept))
    return Flows(t, q, u, stored, own, driven.sum(axis=1), driven, damped, swept)


def _in_flight(model: Model, own: Array, rows: tuple[Array, Array, Array]) -> NDArray[np.bool_]:
    """Steps (n - 1, coordinates) over which nothing but spring, drive and damping acts on a coordinate.

    Flights are long steps in closed form, over which polynomials are not exact enough: there, damping takes what is lost.
    """
    q, u, a = rows
    c = model.coordinates
    alone = np.asarray(c.linear) != 0
    for table in model.tables:
        alone[table.coordinate] = False
        if table.on >= 0:
            alone[table.on] = False
    for joint in model.joints:
        alone[[joint.coordinate, joint.on]] = False
    stiffness, viscous, mass = np.asarray(c.stiffness), np.asarray(c.viscous), np.asarray(c.mass)
    pull = np.asarray(c.force) - stiffness * (q - np.asarray(c.rest)) - viscous * u - np.asarray(c.coulomb) * np.sign(u)
    scale = np.abs(np.asarray(c.force)) + stiffness * np.abs(q - np.asarray(c.rest)) + viscous * np.abs(u)
    quiet = alone & (np.abs(mass * a - pull) <= QUIET * scale) & (own > 0.0)
    return np.asarray(quiet[:-1] & quiet[1:])


def _so_far(steps: Array) -> Array:
    return np.concatenate((np.zeros((1, steps.shape[1])), np.cumsum(steps, axis=0)))


def _at(s: float, h: Array, rows: tuple[Array, Array, Array]) -> tuple[Array, Array]:
    """Positions and velocities at a fraction of every step."""
    q, u, a = rows
    q0, u0, a0 = q[:-1], h * u[:-1], h * h * a[:-1]
    d, u1, a1 = q[1:] - q0, h * u[1:], h * h * a[1:]
    c3 = 10.0 * d - 6.0 * u0 - 4.0 * u1 - 1.5 * a0 + 0.5 * a1
    c4 = -15.0 * d + 8.0 * u0 + 7.0 * u1 + 1.5 * a0 - a1
    c5 = 6.0 * d - 3.0 * (u0 + u1) - 0.5 * (a0 - a1)
    where = q0 + s * (u0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))
    fast = u0 + s * (a0 + s * (3.0 * (u1 - u0) - 2.0 * a0 - a1 + s * (2.0 * (u0 - u1) + a0 + a1)))
    return where, np.divide(fast, h, out=np.zeros_like(fast), where=h > 0.0)


def _drive_power(model: Model, t: Array, q: Array, u: Array) -> Array:
    """Power of all that is neither spring nor damping, on each coordinate, W (rows, n)."""
    c = model.coordinates
    force = np.asarray(c.force) + np.cos(q) * np.asarray(c.weight_y) - np.sin(q) * np.asarray(c.weight_x)
    power = np.asarray(force * u)
    for joint in model.joints:
        power[:, joint.coordinate] += joint.force * u[:, joint.coordinate]
        power[:, joint.on] -= joint.force * u[:, joint.on]
    for table in model.tables:
        knots = model.knots[table.start : table.start + table.count]
        x = t if table.over == OVER_TIME else q[:, table.coordinate] - (q[:, table.on] if table.on >= 0 else 0.0)
        value = np.interp(x, knots[:, 0], knots[:, 1])
        power[:, table.coordinate] += value * u[:, table.coordinate]
        if table.on >= 0:
            power[:, table.on] -= value * u[:, table.on]
    power[:, np.asarray(c.driven) != 0] = 0.0
    return power


def _damping_power(model: Model, u: Array) -> Array:
    """What damping and dry bearings take, W (rows, n); of a carried body it counts with that body."""
    c, speed = model.coordinates, np.abs(u)
    power = speed * (np.asarray(c.coulomb) + speed * (np.asarray(c.viscous) + np.asarray(c.quadratic) * speed))
    for joint in model.joints:
        w = np.abs(u[:, joint.coordinate] - u[:, joint.on])
        power[:, joint.coordinate] += w * w * (joint.viscous + joint.quadratic * w)
    return np.asarray(power)
