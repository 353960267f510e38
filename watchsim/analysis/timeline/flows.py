"""Where was the energy of a run at its rows, and what has flowed between them, friction and impacts of contacts apart?

Between two rows positions are quintics and velocities cubics (simulation.trajectory), so that the integrals over a step are
finite sums: Gauss's rule with five points is exact for their squares.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.contact_forces import absolute
from watchsim.analysis.timeline.line_spring_rows import held_by_lines, line_spring_energies, line_spring_power
from watchsim.mechanism.compile import Compiled
from watchsim.model.records import OVER_TIME, REPEATED, Model
from watchsim.simulation.record.trajectory import Array, Trajectory

NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)
QUIET = 1e-12  # of the forces that act: an acceleration that they explain to this owes nothing to contacts
NODES, WEIGHTS = 0.5 * (NODES + 1.0), 0.5 * WEIGHTS


@dataclass(frozen=True)
class Flows:
    """One entry per row of the run, SI.

    t       s
    q, u    absolute coordinates and velocities (rows, n)
    stored  kinetic energy, energy of springs and of the weight of turning bodies, such as a pendulum, J
    own     the same of each coordinate (rows, n); springs between carried bodies count with neither
    drive   work of torques, forces and tables so far, J
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
    hung = np.flatnonzero((c.weight_x != 0.0) | (c.weight_y != 0.0))  # what the weight of turning bodies has done
    own[:, hung] -= np.asarray(c.weight_y)[hung] * np.sin(q[:, hung]) + np.asarray(c.weight_x)[hung] * np.cos(q[:, hung])
    own[:, np.asarray(c.driven) != 0] = 0.0  # a prescribed motion holds no energy that counts
    stored = own.sum(axis=1)
    for joint in model.joints:
        wound = q[:, joint.coordinate] - q[:, joint.on] - joint.rest
        stored = stored + 0.5 * joint.stiffness * wound**2
    stored = stored + line_spring_energies(model, q)
    h = np.diff(t)
    step = h[:, None]
    # A constant force works on the way, the integral of the cubics; only what changes on the way needs Gauss's rule.
    driven = _constant_work(model, 0.5 * step * (u[:-1] + u[1:]) + step * step / 12.0 * (a[:-1] - a[1:]))
    damped = np.zeros_like(driven)
    moved, slowed = _changing(model)
    if moved or slowed:
        place, speed = _position(step, (q, u, a), moved), _velocity(h, (u, a), sorted({*moved, *slowed}))
        for node, weight in zip(NODES, WEIGHTS, strict=True):
            us = speed(node)
            if moved:
                driven += weight * step * _changing_power(model, t[:-1] + node * h, place(node), us)
            if slowed:
                damped += weight * step * _damping_power(model, us)
            if len(model.lines):
                held, taken = line_spring_power(model, place(node), us)
                driven += weight * step * held
                damped += weight * step * taken
    free = _in_flight(model, own, (q, u, a)) & (h > 0.0)[:, None]
    damped = np.where(free, own[:-1] - own[1:] + driven, damped)
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


Row = dict[int, Array]  # coordinate -> its values over all steps


def _changing(model: Model) -> tuple[list[int], list[int]]:
    """The coordinates on which a force changes with place or time, and those with damping or a joint, whose powers are
    integrated."""
    c = model.coordinates
    moved = {int(k) for joint in model.joints if c.driven[joint.on] for k in (joint.coordinate, joint.on)}
    slowed = {int(k) for k in np.flatnonzero((c.coulomb != 0.0) | (c.viscous != 0.0) | (c.quadratic != 0.0))}
    for table in model.tables:
        moved |= {int(table.coordinate), *([int(table.on)] if table.on >= 0 else [])}
    for joint in model.joints:
        slowed |= {int(joint.coordinate), int(joint.on)}
    return sorted(moved | held_by_lines(model)), sorted(slowed)


def _position(h: Array, rows: tuple[Array, Array, Array], wanted: list[int]) -> Callable[[float], Row]:
    """What gives the positions of some coordinates at a fraction of every step."""
    q, u, a = (values[:, wanted] for values in rows)
    q0, u0, a0 = q[:-1], h * u[:-1], h * h * a[:-1]
    d, u1, a1 = q[1:] - q0, h * u[1:], h * h * a[1:]
    c3 = 10.0 * d - 6.0 * u0 - 4.0 * u1 - 1.5 * a0 + 0.5 * a1
    c4 = -15.0 * d + 8.0 * u0 + 7.0 * u1 + 1.5 * a0 - a1
    c5 = 6.0 * d - 3.0 * (u0 + u1) - 0.5 * (a0 - a1)

    def at(s: float) -> Row:
        return dict(zip(wanted, (q0 + s * (u0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))).T, strict=True))

    return at


def _velocity(h: Array, rows: tuple[Array, Array], wanted: list[int]) -> Callable[[float], Row]:
    """The same of their velocities."""
    step = h[:, None]
    u, a = (values[:, wanted] for values in rows)
    u0, d, a0, a1 = u[:-1], u[1:] - u[:-1], step * a[:-1], step * a[1:]
    c2, c3 = 3.0 * d - 2.0 * a0 - a1, a0 + a1 - 2.0 * d

    def at(s: float) -> Row:
        return dict(zip(wanted, (u0 + s * (a0 + s * (c2 + s * c3))).T, strict=True))

    return at


def _constant_work(model: Model, way: Array) -> Array:
    """What constant forces do on the way of every coordinate over every step, J (steps, n)."""
    work = np.asarray(model.coordinates.force) * way
    for joint in model.joints:
        work[:, joint.coordinate] += joint.force * way[:, joint.coordinate]
        work[:, joint.on] -= joint.force * way[:, joint.on]
    work[:, np.asarray(model.coordinates.driven) != 0] = 0.0
    return np.asarray(work)


def _changing_power(model: Model, t: Array, q: Row, u: Row) -> Array:
    """Power of tables on each coordinate, W (steps, n)."""
    c = model.coordinates
    power = np.zeros((len(t), len(c)))
    for table in model.tables:
        knots = model.knots[table.start : table.start + table.count]
        own, on = int(table.coordinate), int(table.on)
        x = t if table.over >= OVER_TIME else q[own] - (q[on] if on >= 0 else 0.0)
        if table.over == REPEATED:
            x = knots[0, 0] + (t - knots[0, 0]) % (knots[-1, 0] - knots[0, 0])
        value = np.interp(x, knots[:, 0], knots[:, 1])
        power[:, own] += value * u[own]
        if on >= 0:
            power[:, on] -= value * u[on]
    power[:, np.asarray(c.driven) != 0] = 0.0
    for joint in model.joints:
        if c.driven[joint.on]:  # what keeps the prescribed motion up against spring and damping
            own, on = int(joint.coordinate), int(joint.on)
            w = u[own] - u[on]
            held = joint.stiffness * (q[own] - q[on] - joint.rest) + w * (joint.viscous + joint.quadratic * np.abs(w))
            power[:, on] -= held * u[on]
    return power


def _damping_power(model: Model, u: Row) -> Array:
    """What damping and dry bearings take, W (steps, n); of a carried body it counts with that body."""
    c = model.coordinates
    power = np.zeros((len(next(iter(u.values()))), len(c)))
    for k, value in u.items():
        speed = np.abs(value)
        power[:, k] = speed * (c.coulomb[k] + speed * (c.viscous[k] + c.quadratic[k] * speed))
    for joint in model.joints:
        w = np.abs(u[int(joint.coordinate)] - u[int(joint.on)])
        power[:, joint.coordinate] += w * w * (joint.viscous + joint.quadratic * w)
    return power
