"""Which forces balance the same contacts, in the same modes, at many instants?

A contact in force does not accelerate apart, a sticking one does not slip, a sliding one rubs (docs/theory/method.md 2.4). The
linear systems of all instants are solved together.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import OPEN, STICK, closed_contacts, poses
from watchsim.dynamics.bearings import LOAD_ROUNDS
from watchsim.dynamics.forces import Seen, balance, room, spring_pulls
from watchsim.dynamics.moving_frame import inertial_rows
from watchsim.mechanism.compile import Compiled
from watchsim.model import Model
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.columns import blocks
from watchsim.tolerances import LOAD_ROUGH

# Events say how modes change. At the first of the times a contact's mode follows from the last event of its own; from there
# on each event is followed.

MODES = (EventKind.CLOSE, EventKind.OPEN, EventKind.STICK, EventKind.SLIDE, EventKind.HANDOVER)

InForce = tuple[tuple[int, int], ...]  # contacts with their modes, by number of the contact


def modes_in_force(run: Trajectory, times: Array) -> dict[InForce, list[int]]:
    """What is in force -> at which of the times it is: their places among `times`, the earliest first."""
    order = np.argsort(times, kind="stable")
    sorted_times, places = times[order], order.tolist()
    modes: dict[int, int] = {}
    found: dict[InForce, list[int]] = {}
    asked = 0  # how many of the times are done
    for (part,) in blocks(run.events):
        if asked == len(places):
            break
        changes = np.compress(np.isin(part["kind"], MODES), part)  # a third of the time of indexing
        t = np.ascontiguousarray(changes["t"])
        done = int(np.searchsorted(t, sorted_times[0], side="right"))
        modes = _Changes(changes[:done], modes).modes()
        here = sorted_times[asked : int(np.searchsorted(sorted_times, part["t"][-1]))]
        for stop, times_there in zip(*np.unique(np.searchsorted(t, here, side="right"), return_counts=True), strict=True):
            _follow(modes, changes[done:stop])
            found.setdefault(tuple(sorted(modes.items())), []).extend(places[asked : asked + times_there])
            done, asked = stop, asked + times_there
        if asked < len(places):
            _follow(modes, changes[done:])
    if asked < len(places):
        found.setdefault(tuple(sorted(modes.items())), []).extend(places[asked:])
    return found


class _Changes:
    """Events that change modes, by contact: what a contact's mode is follows from the last of its own, not from all before."""

    def __init__(self, events: NDArray[Any], earlier: dict[int, int]) -> None:
        """`earlier`: the modes before the first of the events."""
        gained, lost = events["contact"].astype(np.int64), events["value"].astype(np.int64)
        handed = events["kind"] == EventKind.HANDOVER
        self._events, self._earlier = events, earlier
        of = np.concatenate((gained, lost[handed]))
        at = np.concatenate((np.arange(len(events)), np.flatnonzero(handed)))
        order = np.lexsort((at, of))
        contacts, first = np.unique(of[order], return_index=True)
        self._numbers = dict(zip(contacts.tolist(), np.split(at[order], first[1:]), strict=False))  # of each contact's events

    def modes(self) -> dict[int, int]:
        """Contact -> mode of what is in force after all of the events."""
        found = {contact: self._mode(contact) for contact in {*self._numbers, *self._earlier}}
        return {contact: mode for contact, mode in found.items() if mode is not None}

    def _mode(self, contact: int) -> int | None:
        """The mode of a contact after all of the events; None where it is open."""
        otherwise, before = None, len(self._events)
        while (number := self._last_of(contact, before)) is not None:
            event = self._events[number]
            if int(event["kind"]) != EventKind.HANDOVER:
                own: dict[int, int] = {}
                change(own, int(event["kind"]), contact, event["value"])
                return own.get(contact, otherwise)
            if int(event["contact"]) != contact:  # to that one, from this
                return otherwise
            otherwise, contact, before = STICK, int(event["value"]), number
        return self._earlier.get(contact, otherwise)

    def _last_of(self, contact: int, before: int) -> int | None:
        """The number of the last event before another that says something about a contact."""
        own = self._numbers.get(contact, ())
        k = int(np.searchsorted(own, before))
        return int(own[k - 1]) if k else None


def _follow(modes: dict[int, int], events: NDArray[Any]) -> None:
    for kind, contact, value in zip(*(events[name].tolist() for name in ("kind", "contact", "value")), strict=True):
        change(modes, kind, contact, value)


def change(modes: dict[int, int], kind: int, contact: int, value: float) -> None:
    if kind == EventKind.HANDOVER:
        modes[contact] = modes.pop(int(value), STICK)
    elif kind == EventKind.STICK:
        modes[contact] = STICK
    elif kind == EventKind.OPEN or (kind == EventKind.CLOSE and int(value) == OPEN):
        modes.pop(contact, None)
    else:
        modes[contact] = int(value)


SLACK = 1e-9  # of the largest force: rounding
GENTLE = 1e-4  # of a system scaled to 1: how much small forces are preferred
SMALLEST = 1e-12  # of the largest: what counts in a system of redundant contacts


def inertial(model: Model, t: Array, q: Array, u: Array, body: int = -1) -> tuple[Array, Array]:
    """What the motion of the case does: force on a body, N (n, 2), and power on each body of `model.weighed`, W (n, bodies)."""
    force, power = np.zeros((len(t), 2)), np.zeros((len(t), len(model.weighed)))
    if len(model.shocks):
        t, q, u = (np.ascontiguousarray(values) for values in (t, q, u))
        inertial_rows(model, body, t, q, u, force, power)
    return force, power


class Balanced(NamedTuple):
    """At n instants the m contacts `ids` with their forces, normals and points, each (n, m, 2); what the contacts do to the
    coordinates, and their accelerations, (n, coordinates)."""

    ids: NDArray[np.int64]
    force: Array
    normal: Array
    point: Array
    load: Array
    acceleration: Array


def pulled(model: Model, body: int, q: Array, u: Array) -> Array:
    """The force of springs between points, and of its coil, on a body, N (n, 2)."""
    found = np.zeros((len(q), 2))
    if len(model.lines) or len(model.coils):
        spring_pulls(model, body, np.ascontiguousarray(q), np.ascontiguousarray(u), found)
    return found


class Mechanism:
    """What is the same at every instant, looked up once: mobilities, dry friction of bearings, law of each contact."""

    def __init__(self, compiled: Compiled) -> None:
        model = self.model = compiled.model
        self.mobility, self.dry = 1.0 / np.asarray(model.coordinates.mass), np.asarray(model.coordinates.coulomb)
        self.prescribed = np.asarray(model.coordinates.driven) != 0
        contacts, primitives = model.contacts, model.primitives
        self.sides = primitives.body[contacts.a], primitives.body[contacts.b]
        self.laws = model.laws[np.asarray(model.contacts.group)]

    def balanced(self, t: Array, q: Array, u: Array, modes: Mapping[int, int]) -> Balanced:
        """Forces of the contacts in `modes` at times t (n,) with coordinates q and velocities u (n, coordinates)."""
        ids = np.array(sorted(modes), np.int64)
        seen = self.seen(t, q, u, ids)
        held = ((self.dry > 0.0) | (np.asarray(self.model.coordinates.loaded) != 0)) & (u == 0.0)
        mobility = np.where(held | self.prescribed, 0.0, self.mobility)
        codes = np.array([modes[k] for k in ids.tolist()])
        slip = np.einsum("nmc,nc->nm", seen.w_T, u) + 0.0 if len(ids) else np.zeros((len(t), 0))
        friction, dry = self._coefficients(ids, codes, slip), np.broadcast_to(self.dry, u.shape)
        for _ in range(LOAD_ROUNDS):
            h = seen.h - dry * np.sign(u)
            free = np.where(self.prescribed, h, mobility * h)
            force = self._forces(seen, mobility, free, friction, codes)
            load = (force[:, :, :1] * seen.w_N + force[:, :, 1:] * seen.w_T).sum(axis=1)
            found = Balanced(ids, force, seen.normal, seen.point, load, free + mobility * load)
            loaded = self.rubbed(found, t, q, u)
            if np.allclose(loaded, dry, rtol=LOAD_ROUGH, atol=0.0):
                break
            dry = loaded
        return found

    def rubbed(self, found: Balanced, t: Array, q: Array, u: Array) -> Array:
        """Dry friction of the bearings (n, coordinates), N·m or N; with a load, by what it is."""
        dry = np.broadcast_to(self.dry, u.shape)
        across = np.stack((-found.normal[:, :, 1], found.normal[:, :, 0]), axis=2)
        pressed = found.force[:, :, :1] * found.normal + found.force[:, :, 1:] * across
        for one in self.model.bearings:
            j, (on_a, on_b) = int(one.coordinate), (side[found.ids] == one.body for side in self.sides)
            body = self.model.bodies[one.body]
            c, s = np.cos(body.ratio * q[:, j] + body.phase), np.sin(body.ratio * q[:, j] + body.phase)
            arm = np.stack((c * one.moment_x - s * one.moment_y, s * one.moment_x + c * one.moment_y), axis=1)
            weight = np.array([one.weight_x, one.weight_y])
            carried = np.einsum("k,nkx->nx", on_b.astype(float) - on_a, pressed) - weight
            carried -= u[:, j : j + 1] ** 2 * arm - found.acceleration[:, j : j + 1] * np.stack((-arm[:, 1], arm[:, 0]), axis=1)
            carried -= pulled(self.model, int(one.body), q, u) + inertial(self.model, t, q, u, int(one.body))[0]
            dry = np.array(dry)
            dry[:, j] += one.grip * (np.hypot(*carried.T) - np.hypot(*weight))
        return np.asarray(dry)

    def seen(self, t: Array, q: Array, u: Array, ids: NDArray[np.int64]) -> Seen:
        """Kinematics of these contacts, and all other forces."""
        seen = room(len(t), len(ids), q.shape[1])
        t, q, u = (np.ascontiguousarray(values) for values in (t, q, u))  # else the kernel is compiled once more
        balance(self.model, t, q, u, ids, poses(len(self.model.bodies)), closed_contacts(1), seen)
        return seen

    def _coefficients(self, ids: NDArray[np.int64], modes: NDArray[np.int64], slip: Array) -> Array:
        """(n, m): of friction, by mode and speed of slip (m/s); of what sticks, up to which it holds."""
        laws = self.laws[ids]
        speed = np.where(modes == STICK, 0.0, np.maximum(modes * slip, 0.0))
        decay = np.asarray(laws.decay)
        left = np.where(decay > 0.0, np.exp(-speed / np.where(decay > 0.0, decay, 1.0)), modes == STICK)
        return np.asarray(laws.friction) - np.asarray(laws.drop) * (1.0 - left) + np.asarray(laws.rise) * speed

    def _forces(self, seen: Seen, mobility: Array, free: Array, friction: Array, modes: NDArray[np.int64]) -> Array:
        """(n, m, 2): along normal and tangent. The smallest where contacts are redundant. `friction` (n, m)."""
        rows = len(modes)
        force = np.zeros((len(free), rows, 2))
        if not rows:
            return force
        # Unknowns: the normal force of each contact, and the tangential one of those that stick.
        sticks = np.flatnonzero(modes == STICK)
        slide = np.where(modes == STICK, 0.0, -friction * modes)
        hold = np.concatenate((seen.w_N, seen.w_T[:, sticks]), axis=1)
        bar = np.concatenate((seen.bar[:, 0], seen.bar[:, 1, sticks]), axis=1)
        push = np.concatenate((seen.w_N + slide[:, :, None] * seen.w_T, seen.w_T[:, sticks]), axis=1)
        system, right = hold * mobility[:, None, :], -bar - (hold @ free[:, :, None])[:, :, 0]
        unknown = _least(system @ push.transpose(0, 2, 1), right)
        force[:, :, 0], force[:, :, 1] = unknown[:, :rows], slide * unknown[:, :rows]
        force[:, sticks, 1] = unknown[:, rows:]
        most = np.abs(force).max(axis=(1, 2))
        beyond = (np.abs(force[:, :, 1]) > friction * force[:, :, 0] + SLACK * most[:, None]).any(axis=1)
        if beyond.any():
            directions = (seen.w_N[beyond], seen.w_T[beyond])
            laws = (sticks, slide[beyond], friction[beyond])
            force[beyond] = _within_cones(system[beyond], right[beyond], directions, laws)
        return force


def _least(system: Array, right: Array) -> Array:
    """The smallest solutions (n, m), of systems scaled to a unit diagonal: contacts have lever arms of millimetres."""
    scale = np.sqrt(np.abs(np.diagonal(system, axis1=1, axis2=2)))
    scale = np.where(scale > 0.0, scale, 1.0)
    inverse = np.linalg.pinv(system / scale[:, :, None] / scale[:, None, :], rcond=SMALLEST)
    solved: Array = (inverse @ (right / scale)[:, :, None])[:, :, 0] / scale
    return solved


def _within_cones(
    system: Array, right: Array, directions: tuple[Array, Array], laws: tuple[NDArray[np.int64], Array, Array]
) -> Array:
    """Forces (n, m, 2) of redundant contacts: of all that balance, those that press and stay within their cones of friction."""
    (w_n, w_t), (sticks, slide, friction) = directions, laws
    rows = slide.shape[1]
    # Along the edges of the cones: one of a contact that slides; of one that sticks two, the second behind all others.
    owner = np.concatenate((np.arange(rows), sticks))
    lean = np.concatenate((slide, -friction[:, sticks]), axis=1)
    lean[:, sticks] = friction[:, sticks]
    ways = w_n[:, owner] + lean[:, :, None] * w_t[:, owner]
    shares = _pressing(system @ ways.transpose(0, 2, 1), right)
    force = np.stack((shares, lean * shares), axis=2)
    force[:, sticks] += force[:, rows:]
    return force[:, :rows]


def _pressing(system: Array, right: Array) -> Array:
    """Solutions (n, edges) without negative shares, near the smallest; as near to one as can be where rounding leaves none."""
    high = 1.0 / np.maximum(np.abs(system).max(axis=2), np.finfo(float).tiny)
    scaled, target = system * high[:, :, None], right * high
    count = scaled.shape[2]
    small = np.broadcast_to(GENTLE * np.eye(count), (len(scaled), count, count))
    ways, load = np.concatenate((scaled, small), axis=1), np.append(target, np.zeros((len(target), count)), axis=1)
    # Least squares without bounds, where they have no negative share, are least squares with bounds.
    near = (np.linalg.pinv(ways) @ load[:, :, None])[:, :, 0]
    pulling = np.flatnonzero((near < 0.0).any(axis=1))
    if len(pulling):
        from scipy.optimize import nnls  # a fifth of a second to load

        near[pulling] = [nnls(ways[k], load[k])[0] for k in pulling]
    # The push towards small forces leaves the balance off by its square; among those in use the rest is put right.
    off = target - (scaled @ near[:, :, None])[:, :, 0]
    used = near > SMALLEST * near.max(axis=1, keepdims=True)
    for alike in np.unique(used, axis=0):
        of = (used == alike).all(axis=1)
        inverse = np.linalg.pinv(scaled[of][:, :, alike], rcond=SMALLEST)
        near[np.ix_(of, alike)] += (inverse @ off[of, :, None])[:, :, 0]
    return near
