"""Which forces act at contacts and pivots, at any time of a run?

A run keeps where its bodies were and which contact had which mode. Between events the forces follow from these: a contact in
force does not accelerate apart, a sticking one does not slip, a sliding one rubs (docs/theory/method.md 2.4).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.modes_in_force import modes_in_force
from watchsim.analysis.nonnegative import nonnegative
from watchsim.contact.index_sets import STICK
from watchsim.contact.kinematics import Closed, closed_contacts
from watchsim.contact.poses import poses
from watchsim.dynamics.equations_of_motion import balance
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.oscillation import loads
from watchsim.scene.recording import STATISTICS
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.record.trajectory import Array, Trajectory

SLACK = 1e-9  # of the largest force: rounding
GENTLE = 1e-4  # of a system scaled to 1: how much small forces are preferred
SMALLEST = 1e-12  # of the largest: what counts in a system of redundant contacts


@dataclass(frozen=True)
class Forces:
    """At times t (n,), s. Contacts are those that were in force at any of them, in the order of `pairs`.

    pairs       row of `Trajectory.pairs` of each contact (k,)
    normal      how hard it presses, N (n, k); 0 where it is open
    tangential  along t, the normal turned by +90°, on body A, N (n, k)
    direction   the normal, out of body B's material (n, k, 2); nan where it is open
    point       where it touches, m (n, k, 2); nan where it is open
    pivots      name of a pivoted body -> force on it from its bearing in the movement, N (n, 2); what gears ([[gears]] say no
                pressure angle) and springs between points do to it is left out
    drives      name of a driven body -> torque, N·m, or force along its axis, N, that keeps its motion up (n,)
    """

    t: Array
    pairs: NDArray[np.int64]
    normal: Array
    tangential: Array
    direction: Array
    point: Array
    pivots: dict[str, Array]
    drives: dict[str, Array]

    def __repr__(self) -> str:
        most = f"up to {self.normal.max():.3g} N at {len(self.pairs)} contacts" if self.normal.size else "no contact in force"
        return f"<Forces at {len(self.t)} instants: {most}; pivots of {', '.join(self.pivots) or 'nothing'}>"


@dataclass(frozen=True)
class _Instant:
    """Contacts in force with their forces (m, 2), normals (m, 2) and points (m, 2); of the coordinates what the contacts do to
    them (n,) and their accelerations (n,)."""

    ids: NDArray[np.int64]
    force: Array
    normal: Array
    point: Array
    load: Array
    acceleration: Array


def forces(run: Trajectory, times: Iterable[float] | None = None) -> Forces:
    """Forces at these times (s), by default at all rows; after an impact where one happens at that time.

    Where contacts are redundant the smallest forces are given. ValueError for a run by fixed steps, whose contacts have
    impulses only, and where events were not kept.
    """
    if run.method != EVENT_DRIVEN:
        raise ValueError(f"forces need a run by events; {run.method} knows impulses over its steps only")
    if run.keep == STATISTICS:
        raise ValueError('forces need all events of a run: simulate with record = "events", "all" or windows')
    t = np.array(run.t if times is None else list(times), float)
    q, u = run.sample(t)
    compiled = compile_scene(run.scene)
    where, speed = absolute(compiled, q, False), absolute(compiled, u, True)
    mechanism = _Mechanism(compiled)
    found = [_instant(mechanism, *row) for row in zip(t.tolist(), where, speed, modes_in_force(run, t), strict=True)]
    pairs = np.array(sorted({int(k) for one in found for k in one.ids}), np.int64)
    shape = (len(t), len(pairs))
    out = Forces(t, pairs, np.zeros(shape), np.zeros(shape), np.full((*shape, 2), np.nan), np.full((*shape, 2), np.nan), {}, {})
    for row, one in enumerate(found):
        columns = np.searchsorted(pairs, one.ids)
        out.normal[row, columns], out.tangential[row, columns] = one.force.T
        out.direction[row, columns], out.point[row, columns] = one.normal, one.point
    turning = np.array([one.acceleration for one in found])
    out.pivots.update(_pivots(run, compiled, out, where, speed, turning))
    out.drives.update(_drives(run, compiled, np.array([one.load for one in found]), turning))
    return out


def absolute(compiled: Compiled, values: Array, rates: bool) -> Array:
    """Coordinates in the movement from those that the trajectory gives: the inverse of `Compiled.relative`."""
    out = np.array(values)
    out = out[:, : len(compiled.q)]  # what is geared to others follows from them
    for own, on, angle in compiled.against:  # carriers come before what they carry
        out[:, own] += (out[:, on] if on >= 0 else 0.0) + (0.0 if rates else angle)
    return out


class _Mechanism:
    """What is the same at every instant, looked up once: mobilities, dry friction of bearings, friction of each contact."""

    def __init__(self, compiled: Compiled) -> None:
        model = self.model = compiled.model
        self.mobility, self.dry = 1.0 / np.asarray(model.coordinates.mass), np.asarray(model.coordinates.coulomb)
        self.prescribed = np.asarray(model.coordinates.driven) != 0
        self.friction = np.asarray(model.laws.friction)[np.asarray(model.contacts.group)]
        self.pose, self.closed = poses(len(model.bodies)), closed_contacts(1)

    def room(self, contacts: int) -> Closed:
        """Room for that many contacts, empty."""
        if len(self.closed.ids) < contacts:
            self.closed = closed_contacts(contacts)
        self.closed.slots[:] = 0
        return self.closed


def _instant(mechanism: _Mechanism, t: float, q: Array, u: Array, modes: dict[int, int]) -> _Instant:
    """Forces of the contacts in `modes` at one state."""
    ids = np.array(sorted(modes), np.int64)
    closed, normal, h = mechanism.room(len(ids)), np.zeros((len(ids), 2)), np.zeros(len(q))
    balance(mechanism.model, t, q, u, ids, mechanism.pose, closed, normal, h)
    dry, prescribed = mechanism.dry, mechanism.prescribed
    held = (dry > 0.0) & (u == 0.0)
    mobility = np.where(held | prescribed, 0.0, mechanism.mobility)
    h -= np.where(held, 0.0, dry * np.sign(u))
    free = np.where(prescribed, h, mobility * h)
    rows = len(ids)
    if not rows:
        return _Instant(ids, np.zeros((0, 2)), normal, np.zeros((0, 2)), np.zeros(len(q)), free)
    w_n, w_t = (_dense(closed, values, rows, len(q)) for values in (closed.w_N, closed.w_T))
    kin = closed.kin[:rows].view(np.ndarray)
    # Unknowns: the normal force of each contact, and the tangential one of those that stick.
    sticks = [i for i, k in enumerate(ids) if modes[int(k)] == STICK]
    friction = mechanism.friction[ids]
    slide = np.array([0.0 if modes[int(k)] == STICK else -friction[i] * modes[int(k)] for i, k in enumerate(ids)])
    hold, bar = np.vstack((w_n, w_t[sticks])), np.concatenate((kin["bar_N"], kin["bar_T"][sticks]))
    system, right = hold * mobility, -bar - hold @ free

    def loaded(force: Array) -> Array:
        return force[:, 0] @ w_n + force[:, 1] @ w_t

    unknown = _least(system @ np.vstack((w_n + slide[:, None] * w_t, w_t[sticks])).T, right)
    force = np.column_stack((unknown[:rows], slide * unknown[:rows]))
    force[sticks, 1] = unknown[rows:]
    if np.any(np.abs(force[:, 1]) > friction * force[:, 0] + SLACK * np.abs(force).max()):
        # Redundant contacts: among all that balance, forces that press and stay within their cones of friction.
        edges = np.array([[1.0, slide[i]] if i not in sticks else [1.0, friction[i]] for i in range(rows)])
        more = np.column_stack((np.ones(len(sticks)), -friction[sticks]))
        owner = np.concatenate((np.arange(rows), np.array(sticks, int)))
        corners = np.vstack((edges, more))
        ways = corners[:, :1] * w_n[owner] + corners[:, 1:] * w_t[owner]
        share = _pressing(system @ ways.T, right)
        force = np.zeros((rows, 2))
        np.add.at(force, owner, share[:, None] * corners)
    load = loaded(force)
    return _Instant(ids, force, normal, np.column_stack((kin["x"], kin["y"])), load, free + mobility * load)


def _dense(closed: Closed, values: Array, rows: int, width: int) -> Array:
    out = np.zeros((rows, width))
    for row in range(rows):
        for slot in range(closed.slots[row]):
            out[row, closed.coord[row, slot]] += values[row, slot]
    return out


def _least(system: Array, right: Array) -> Array:
    """The smallest solution, of a system scaled to a unit diagonal: contacts have lever arms of millimetres."""
    if system.size == 1 and system[0, 0] != 0.0:
        return np.asarray(right / system[0])
    scale = np.sqrt(np.abs(np.diag(system)))
    scale = np.where(scale > 0.0, 1.0 / np.where(scale > 0.0, scale, 1.0), 1.0)
    scaled: Array = np.linalg.lstsq(system * np.outer(scale, scale), right * scale, rcond=SMALLEST)[0]
    return scaled * scale


def _pressing(system: Array, right: Array) -> Array:
    """A solution without negative shares, near the smallest; as near to one as can be where rounding leaves none."""
    high = 1.0 / np.maximum(np.abs(system).max(axis=1), np.finfo(float).tiny)
    scaled, target = system * high[:, None], right * high
    count = scaled.shape[1]
    near = nonnegative(np.vstack((scaled, GENTLE * np.eye(count))), np.append(target, np.zeros(count)))
    used = near > SMALLEST * near.max(initial=0.0)
    # The push towards small forces leaves the balance off by its square; among those in use the rest is put right.
    near[used] += np.linalg.lstsq(scaled[:, used], target - scaled @ near, rcond=SMALLEST)[0]
    return near


def _pivots(run: Trajectory, compiled: Compiled, found: Forces, q: Array, u: Array, a: Array) -> Iterator[tuple[str, Array]]:
    """What the bearings in the movement take: change of momentum less weight less contacts, of a body with all it carries."""
    hung, weighed, _ = loads(run.scene.bodies)
    on_a, on_b = _bodies_of(compiled, found.pairs)
    across = np.stack((-found.direction[:, :, 1], found.direction[:, :, 0]), axis=2)
    pressed = np.nan_to_num(found.normal[:, :, None] * found.direction + found.tangential[:, :, None] * across)
    for i, (body, ride, load) in enumerate(zip(run.scene.bodies, hung, weighed, strict=True)):
        if body.motion != "pivot" or ride.host >= 0:
            continue
        own = [k for k, other in enumerate(hung) if i in (k, other.part_of, other.host)]
        sign = np.isin(on_a, own).astype(float) - np.isin(on_b, own).astype(float)
        angle, spin, turn = (compiled.own(i, values, rates) for values, rates in ((q, False), (u, True), (a, True)))
        c, s = np.cos(angle), np.sin(angle)
        moment = np.stack((c * load.moment[0] - s * load.moment[1], s * load.moment[0] + c * load.moment[1]), axis=1)
        change = turn[:, None] * np.stack((-moment[:, 1], moment[:, 0]), axis=1) - (spin * spin)[:, None] * moment
        yield body.name, change - load.mass * np.array(run.scene.gravity) - np.einsum("k,nkx->nx", sign, pressed)


def _drives(run: Trajectory, compiled: Compiled, load: Array, a: Array) -> Iterator[tuple[str, Array]]:
    """Against the contacts, and for the acceleration of as much mass or inertia as the scene gives the body."""
    for body, mass in zip(run.scene.bodies, loads(run.scene.bodies)[2], strict=True):
        if body.prescribed is not None:
            j = compiled.slices[body.name].start
            yield body.name, mass * a[:, j] - load[:, j]


def _bodies_of(compiled: Compiled, pairs: NDArray[np.int64]) -> tuple[Array, Array]:
    """The bodies of the model on both sides of each contact."""
    contacts, primitives = compiled.model.contacts[pairs], compiled.model.primitives
    return primitives.body[contacts.a], primitives.body[contacts.b]
