"""Where was the energy of a run at its rows, what has flowed between them, and which share of it reaches the oscillator?

Between two rows positions are quintics and velocities cubics (simulation.trajectory), so that the integrals over a step are
finite sums: Gauss's rule with five points is exact for their squares.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.balanced_forces import inertial
from watchsim.analysis.forces import Forces, absolute, bearing_friction, forces
from watchsim.analysis.timing import Beats, Window, beats, is_recorded, last_window
from watchsim.dynamics.forces import line_spring_energies, line_spring_powers
from watchsim.mechanism.coiled import of_coil
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import COIL_ENERGY, COIL_TORQUE, DAMPING_LAWS, FREE, OVER_TIME, REPEATED, Model, resistance
from watchsim.scene.roles import keeps_time, roles
from watchsim.scene.scene import STATISTICS, Body, Scene
from watchsim.scene.trains import start_poses
from watchsim.simulation import EVENT_DRIVEN
from watchsim.simulation.recording import FEWEST_TURNS
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory, frames, speeds
from watchsim.tolerances import LEDGER_SHARE


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


LOSSES = (EventKind.IMPACT, EventKind.JAM)


@dataclass(frozen=True, slots=True)
class Losses:
    """Of n stretches of time: J by pair of bodies, (n, len(pairs)), and how many impacts that were."""

    pairs: tuple[str, ...]
    taken: Array
    count: NDArray[np.int64]

    @property
    def whole(self) -> Array:
        """(n,): of all pairs."""
        return self.taken.sum(axis=1)

    def by_pair(self) -> list[dict[str, float]]:
        """Of each stretch those pairs that struck."""
        rows = zip(self.taken.tolist(), (self.count > 0).tolist(), strict=True)
        return [{pair: value for pair, value, struck in zip(self.pairs, *row, strict=True) if struck} for row in rows]


def impact_losses(
    run: Trajectory, starts: Array, ends: Array, after_start: NDArray[np.bool_], with_end: NDArray[np.bool_]
) -> Losses:
    """Of the stretches from `starts` to `ends` (s).

    Impacts at its start belong to a stretch but for those of `after_start`, impacts at its end only to those of `with_end`.
    """
    # Bisection, not numpy's search: that would copy the whole column for each few beats.
    first, last = bisect_left(run.events["t"], starts[0]), bisect_right(run.events["t"], ends.max())
    own = run.events[first:last]
    own = own[np.isin(own["kind"], LOSSES)]
    used, contact = np.unique(own["contact"], return_inverse=True)
    named = [pair_name(run, k) for k in used.tolist()]
    pairs = tuple(dict.fromkeys(named))
    pair = np.array([pairs.index(name) for name in named], np.int64)[contact]
    t = np.ascontiguousarray(own["t"])
    low = np.where(after_start, np.searchsorted(t, starts, side="right"), np.searchsorted(t, starts, side="left"))
    high = np.where(with_end, np.searchsorted(t, ends, side="right"), np.searchsorted(t, ends, side="left"))
    number = np.maximum(high - low, 0)
    of = np.repeat(np.arange(len(starts)), number)
    k = low[of] + np.arange(len(of)) - (np.cumsum(number) - number)[of]
    cell, cells = of * len(pairs) + pair[k], len(starts) * len(pairs)
    taken = np.asarray(np.bincount(cell, own["energy_lost"][k], cells), np.float64).reshape(len(starts), len(pairs))
    return Losses(pairs, taken, np.bincount(cell, minlength=cells).reshape(taken.shape))


def pair_name(run: Trajectory, contact: int) -> str:
    """The two bodies of a contact, in the order of the scene."""
    pair = run.pairs[contact]
    return "-".join(sorted((pair.body_a, pair.body_b), key=[body.name for body in run.scene.bodies].index))


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
    joined  what springs between bodies have given each coordinate so far, less what `damped` counts of theirs, J
    swept   integral of each coordinate over time so far, rad s
    bent    integral over time of what is neither constant nor linear on each coordinate: weight, bent springs,
            drag, dry friction, N·m·s
    """

    t: Array
    q: Array
    u: Array
    stored: Array
    own: Array
    drive: Array
    driven: Array
    damped: Array
    joined: Array
    swept: Array
    bent: Array


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
    own += 0.25 * np.asarray(c.cubic) * way**4
    own += 0.5 * np.asarray(c.pinned) * (way - np.clip(way, c.pin_low, c.pin_high)) ** 2
    for k in np.flatnonzero(c.coil).tolist():
        own[:, k] += of_coil(model, k, COIL_ENERGY, way[:, k])
    own[:, np.asarray(c.driven) != 0] = 0.0  # a prescribed motion holds no energy that counts
    stored = own.sum(axis=1)
    for joint in model.joints:
        wound = q[:, joint.coordinate] - q[:, joint.on] - joint.rest
        stored = stored + 0.5 * joint.stiffness * wound**2
    if len(model.lines):
        lines = np.zeros(len(q))
        line_spring_energies(model, q, lines)
        stored = stored + lines
    h = np.diff(t)
    step = h[:, None]
    # A constant force works on the way, the integral of the cubics; only what changes on the way needs Gauss's rule.
    driven = _constant_work(model, 0.5 * step * (u[:-1] + u[1:]) + step * step / 12.0 * (a[:-1] - a[1:]))
    damped, joined, bent = (np.zeros_like(driven) for _ in range(3))
    moved, slowed = _changing(model)
    curved = np.flatnonzero((c.weight_x != 0.0) | (c.weight_y != 0.0) | (c.bent != 0)).tolist()
    moved = sorted({*moved, *curved})
    if moved or slowed:
        place, speed = _position(step, (q, u, a), moved), _velocity(h, (u, a), sorted({*moved, *slowed}))
        for node, weight in zip(NODES, WEIGHTS, strict=True):
            us = speed(node)
            if moved:
                driven += weight * step * _changing_power(model, t[:-1] + node * h, place(node), us)
            if slowed:
                damped += weight * step * _damping_power(model, us)
            bent += weight * step * _bent(model, place(node), us, curved)
            if len(model.joints):
                joined += weight * step * _joint_power(model, place(node), us)
            if len(model.lines):
                held, taken = line_spring_power(model, place(node), us)
                driven += weight * step * held
                damped += weight * step * taken
            if len(model.shocks):
                driven += weight * step * _shaken(model, t[:-1] + node * h, place(node), us)
            if len(model.bearings) and run.keep != STATISTICS and run.method == EVENT_DRIVEN:
                dry = bearing_friction(run, t[:-1] + node * h)
                damped += weight * step * _rows(model, {k: np.abs(v) for k, v in us.items()}) * (dry - np.asarray(c.coulomb))
    free = _in_flight(model, own, (q, u, a)) & (h > 0.0)[:, None]
    damped = np.where(free, own[:-1] - own[1:] + driven, damped)
    swept = step * (0.5 * (q[:-1] + q[1:]) + step * (0.1 * (u[:-1] - u[1:]) + step * (a[:-1] + a[1:]) / 120.0))
    driven, damped, joined, swept, bent = (_so_far(values) for values in (driven, damped, joined, swept, bent))
    return Flows(t, q, u, stored, own, driven.sum(axis=1), driven, damped, joined, swept, bent)


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
    moved = {int(k) for joint in model.joints for k in (joint.coordinate, joint.on)}
    slowed = {int(k) for k in np.flatnonzero(np.any([c[law] != 0.0 for law in ("coulomb", "loaded", *DAMPING_LAWS)], axis=0))}
    for table in model.tables:
        moved |= {int(table.coordinate), *([int(table.on)] if table.on >= 0 else [])}
    for joint in model.joints:
        slowed |= {int(joint.coordinate), int(joint.on)}
    felt = {k for row in model.weighed for k in _coordinates(model, int(row.body))}
    return sorted(moved | held_by_lines(model) | felt), sorted(slowed)


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


def _shaken(model: Model, t: Array, q: Row, u: Row) -> Array:
    """Work of the motion of the case on each coordinate, W (steps, n); all of a body's on its first one."""
    power = np.zeros((len(t), len(model.coordinates)))
    power[:, model.bodies.first[model.weighed.body]] = inertial(model, t, _rows(model, q), _rows(model, u))[1]
    return power


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
            held = joint.stiffness * (q[own] - q[on] - joint.rest) + w * resistance(joint, np.abs(w))
            power[:, on] -= held * u[on]
    return power


def _damping_power(model: Model, u: Row) -> Array:
    """What damping and dry bearings take, W (steps, n); of a carried body it counts with that body."""
    c = model.coordinates
    power = np.zeros((len(next(iter(u.values()))), len(c)))
    for k, value in u.items():
        speed = np.abs(value)
        power[:, k] = speed * (c.coulomb[k] + speed * resistance(c[k], speed))
    for joint in model.joints:
        w = np.abs(u[int(joint.coordinate)] - u[int(joint.on)])
        power[:, joint.coordinate] += w * w * resistance(joint, w)
    return power


def _bent(model: Model, q: Row, u: Row, curved: list[int]) -> Array:
    """The torques on each coordinate that are neither constant nor linear, N·m (steps, n)."""
    c = model.coordinates
    torque = np.zeros((len(next(iter(u.values()))), len(c)))
    for k, speed in u.items():
        torque[:, k] -= c.coulomb[k] * np.sign(speed) + c.quadratic[k] * np.abs(speed) * speed
    for k in curved:
        way = q[k] - c.rest[k]
        torque[:, k] += np.cos(q[k]) * c.weight_y[k] - np.sin(q[k]) * c.weight_x[k] - c.cubic[k] * way**3
        torque[:, k] -= c.pinned[k] * (way - np.clip(way, c.pin_low[k], c.pin_high[k]))
        if c.coil[k]:
            torque[:, k] += of_coil(model, k, COIL_TORQUE, way)
    return torque


def _joint_power(model: Model, q: Row, u: Row) -> Array:
    """What the springs and dampers of joints do on each of their two coordinates, W (steps, n); what is lost in them counts
    as damping of the first and not here."""
    power = np.zeros((len(next(iter(u.values()))), len(model.coordinates)))
    for joint in model.joints:
        own, on = int(joint.coordinate), int(joint.on)
        w = u[own] - u[on]
        slowing = w * resistance(joint, np.abs(w))
        held = joint.stiffness * (q[own] - q[on] - joint.rest) + slowing
        power[:, own] += w * slowing - held * u[own]
        power[:, on] += held * u[on]
    return power


# Worked out from forces and slip at the contacts, not from what is missing in the books: that the two agree is a check of
# both.


def friction_by_pair(run: Trajectory, ends: Sequence[float]) -> list[dict[str, float]]:
    """J taken by each pair of bodies from each of the times `ends` (s) to the next; they must be times of rows."""
    first, last = np.searchsorted(run.t, ends[0], side="left"), np.searchsorted(run.t, ends[-1], side="right")
    rows = np.unique(run.t[first:last])
    h = np.diff(rows)
    times = (rows[:-1, None] + h[:, None] * NODES).ravel()
    weights = (h[:, None] * WEIGHTS).ravel()
    found = forces(run, times)
    taken = -weights[:, None] * found.tangential * slips(run, found)
    stretch = np.searchsorted(np.asarray(ends), times, side="right") - 1
    names = [pair_name(run, int(k)) for k in found.pairs]
    out: list[dict[str, float]] = [{} for _ in range(len(ends) - 1)]
    for k, name in enumerate(names):
        for i, one in enumerate(out):
            value = float(taken[stretch == i, k].sum())
            if value != 0.0:
                one[name] = one.get(name, 0.0) + value
    return out


def slips(run: Trajectory, found: Forces) -> Array:
    """How fast body A slides along t over body B at each contact, m/s (n, k); 0 where it is open."""
    q, u = run.sample(found.t)
    places, rates = frames(run.scene, run.slices, q), speeds(run.scene, run.slices, q, u)
    along = np.zeros(found.tangential.shape)
    for k, contact in enumerate(found.pairs):
        pair = run.pairs[int(contact)]
        held = np.isfinite(found.point[:, k, 0])
        point, normal = found.point[held, k], found.direction[held, k]
        slip = _speed(pair.body_a, places, rates, held, point)
        if pair.body_b != pair.body_a:  # that of a shaft in its hole, which stands still
            slip -= _speed(pair.body_b, places, rates, held, point)
        along[held, k] = -normal[:, 1] * slip[:, 0] + normal[:, 0] * slip[:, 1]
    return along


def _speed(body: str, places: dict[str, Array], rates: dict[str, Array], held: Array, point: Array) -> Array:
    """Velocity of a body's material at points, m/s (n, 2)."""
    arm = point - places[body][held, :2]
    spin = rates[body][held, 2]
    return rates[body][held, :2] + np.column_stack((-spin * arm[:, 1], spin * arm[:, 0]))


def work_of_gravity(run: Trajectory) -> float:
    """J from the start to the end: what the ledger of a run takes for work of the drive is only lent and given back."""
    if run.end is None:
        return 0.0
    ends = frames(run.scene, run.slices, run.end[0][None, :])
    starts = start_poses(run.scene)
    return _fallen(run.scene, run.scene.bodies, {name: np.array([starts[name], ends[name][0]]) for name in starts})


def _fallen(scene: Scene, bodies: Iterable[Body], poses: Mapping[str, Array]) -> float:
    """J that gravity does on bodies from the first of their poses to the second."""
    total = 0.0
    for body in bodies if any(scene.gravity) else ():
        (cx, cy), pose = body.centre_of_mass, poses[body.name]
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        way = np.diff(pose[:, :2] + np.stack((c * cx - s * cy, s * cx + c * cy), axis=1), axis=0)[0]
        total += body.mass * float(way @ np.array(scene.gravity))
    return total


@dataclass(frozen=True, slots=True)
class Shares:
    """Energy supplied (J) by the drive and by what ran down, springs, weights and motion, and what share went where; they
    sum to 1. What `ran_down` gave is part of `supplied`."""

    supplied: float
    went_to: dict[str, float]
    ran_down: float = 0.0


def energy_shares(run: Trajectory) -> Shares:
    """The ledger of a run as shares; empty where nothing was put in.

    The ledger has the work of gravity among what is put in; here a weight stores what it can give by falling.
    """
    ledger, fallen = run.energy, work_of_gravity(run)
    drive, stored = float(ledger.get("in_J", 0.0)) - fallen, float(ledger.get("stored_J", 0.0)) - fallen
    if abs(drive) < LEDGER_SHARE * abs(fallen):
        drive = 0.0  # but for the rounding of a fall
    supplied = max(drive, 0.0) + max(-stored, 0.0)
    if not supplied > 0.0:
        return Shares(0.0, {})
    went = {cause: float(value) for cause, value in ledger.get("dissipated", {}).items()}
    went["stored"], went["given back to the drive"] = max(stored, 0.0), max(-drive, 0.0)
    return Shares(supplied, {cause: value / supplied for cause, value in went.items() if value != 0.0}, max(-stored, 0.0))


def efficiency(run: Trajectory, found: Beats | None = None, window: Window | None = None) -> float | None:
    """Share of the drive's work that reached the oscillator by its contacts, as its losses and its gain.

    In the whole oscillations of a window (s; default the last one, that of amplitude and rate), from turning point to turning
    point.

    None without an escapement, without work of the drive or a whole oscillation there, or where its rows were not kept.
    """
    scene, parts = run.scene, roles(run.scene)
    if parts.wheel is None or parts.oscillator is None or not keeps_time(scene):
        return None
    if any(torque.body == parts.oscillator for torque in scene.torques):
        return None
    compiled, found = compile_scene(scene), beats(run) if found is None else found
    start, end = window or last_window(run, found.nominal_period)
    ends = found.end[(found.end >= start) & (found.end <= end)]
    ends = ends[is_recorded(run, ends)]
    ends = ends[(len(ends) + 1) % 2 :]
    if len(ends) < FEWEST_TURNS or (len(compiled.model.bearings) and run.keep == STATISTICS):
        return None  # what bearings take is known only where all events are kept
    first, last = (np.searchsorted(run.t, ends[[0, -1]], side="right") - 1).tolist()
    made, own = flows(run, compiled, slice(first, last + 1)), run.slices[parts.oscillator].start
    reached, drive = made.own[:, own] + made.damped[:, own] - made.driven[:, own] - made.joined[:, own], made.drive
    loose = [body for body in scene.bodies if body.motion in ("slide", "free")]  # the weight of others is among what is stored
    work = float(drive[-1] - drive[0]) - _fallen(scene, loose, frames(scene, run.slices, run.q[[first, last]]))
    return float((reached[-1] - reached[0]) / work) if work > 0.0 else None
