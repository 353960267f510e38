"""Which forces act at contacts and pivots, at any time of a run?

A run keeps where its bodies were and which contact had which mode. Between events the forces follow from these: a contact in
force does not accelerate apart, a sticking one does not slip, a sliding one rubs (docs/theory/method.md 2.4).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.balanced_forces import Balanced, Mechanism, inertial, modes_in_force, pulled
from watchsim.mechanism.backlash import rack_ways
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.roles import loads
from watchsim.scene.scene import STATISTICS, Gear, Scene
from watchsim.scene.trains import Ride, rides, ungeared
from watchsim.simulation import EVENT_DRIVEN
from watchsim.simulation.trajectory import Array, Trajectory

# What a body's own equation of motion leaves over, with every body freed of its gears, is the torque of its teeth; of gears
# with play it is that of their racks. The force acts at the pitch point, where both bodies run alike, along the line of
# action, which leans from the common tangent by the pressure angle so that it presses the bodies apart (Niemann, Winter:
# Maschinenelemente II).


class Pressed(NamedTuple):
    """The force on one body of the scene, N (n, 2), from the tooth of another body, or of a fixed wheel."""

    body: int
    force: Array


class Motion(NamedTuple):
    """At n instants: times, coordinates, velocities and accelerations of a compiled scene, in the movement."""

    t: Array
    q: Array
    u: Array
    a: Array


class Loads(NamedTuple):
    """Of the contacts `ids`: normal and tangential forces (n, m, 2), and of all of them what presses on body A, N (n, m, 2)."""

    ids: NDArray[np.int64]
    force: Array
    pressed: Array


def mesh_forces(scene: Scene, compiled: Compiled, motion: Motion, loads: Loads) -> Iterator[Pressed]:
    """What the teeth of [[gears]] do to the bodies they join; nothing where both slide or turn about one axis."""
    if not scene.gears and not scene.rigid_gears:
        return
    names, hung = [body.name for body in scene.bodies], rides(scene.bodies)
    loose = [_of_racks(scene, compiled, k, loads) for k in range(len(scene.gears))]
    tight = _tight(scene, compiled, motion, loads, loose)
    for gear, torques in zip((*scene.gears, *scene.rigid_gears), (*loose, *tight), strict=True):
        first, second = (names.index(name) for name in gear.between)
        yield from _at_pitch_point(scene, compiled, motion, gear, (first, second), torques, hung)


def _of_racks(scene: Scene, compiled: Compiled, k: int, loads: Loads) -> tuple[Array, Array]:
    """The torques (N·m; sliding: forces) of gears with play on both bodies: what their racks press on each other."""
    gear, hung = scene.gears[k], rides(scene.bodies)
    ways = rack_ways(scene, hung, gear, compiled.size)
    group = compiled.model.contacts.group[loads.ids]
    before = len(scene.contacts) + len(compiled.loose) + sum(one.stop is not None for one in scene.springs)
    own = np.flatnonzero(group == before + k)
    on_first = compiled.model.primitives.body[compiled.model.contacts.a[loads.ids[own]]]
    racks = len(compiled.model.bodies) - 2 * (len(scene.gears) - k)  # number of the first body's rack
    force = np.einsum("k,nkx->nx", np.where(on_first == racks, 1.0, -1.0), loads.pressed[:, own])
    found = []
    for sign, way, askew in zip((1.0, -1.0), ways.far, ways.askew, strict=True):
        slope = askew if gear.efficiency < 1.0 else 0.0
        found.append(sign * way * ways.reach * (force[:, 0] + slope * force[:, 1]))
    return found[0], found[1]


def _tight(
    scene: Scene, compiled: Compiled, motion: Motion, loads: Loads, loose: list[tuple[Array, Array]]
) -> list[tuple[Array, Array]]:
    """The torques of gears without play on both bodies: those that the bodies' own equations of motion lack."""
    if not scene.rigid_gears:
        return []
    free = compile_scene(ungeared(scene))
    lacking, known = _lacking(scene, compiled, free, motion, loads)
    for gear, torques in zip(scene.gears, loose, strict=True):
        for name, torque in zip(gear.between, torques, strict=True):
            lacking[:, free.slices[name].start] -= torque
    hung, names = rides(scene.bodies), [body.name for body in scene.bodies]
    share = np.zeros((lacking.shape[1], len(scene.rigid_gears)))
    for k, gear in enumerate(scene.rigid_gears):
        first, second = (names.index(name) for name in gear.between)
        share[free.slices[gear.between[0]].start, k] = -_in_the_movement(gear.ratio, hung, first, second)
        share[free.slices[gear.between[1]].start, k] = 1.0
    torque = np.zeros((len(motion.t), len(scene.rigid_gears)))
    for rows in np.unique(known, axis=0):
        alike = (known == rows).all(axis=1)
        torque[alike] = np.linalg.lstsq(share[rows], lacking[np.ix_(alike, rows)].T, rcond=None)[0].T
    firsts = [free.slices[gear.between[0]].start for gear in scene.rigid_gears]
    return [(share[first, k] * torque[:, k], torque[:, k]) for k, first in enumerate(firsts)]


def _in_the_movement(ratio: float, hung: tuple[Ride, ...], first: int, second: int) -> float:
    """How far the second goes for one unit of the first, both in the movement: one may ride on the other."""
    if hung[second].turns_with == first:
        return 1.0 + ratio
    return ratio / (1.0 + ratio) if hung[first].turns_with == second else ratio


def _lacking(scene: Scene, compiled: Compiled, free: Compiled, motion: Motion, loads: Loads) -> tuple[Array, NDArray[np.bool_]]:
    """What the equation of each coordinate of the freed scene lacks, and which equations hold no other unknown force.

    The drive of a prescribed motion is one, dry friction of a bearing that stands is another.
    """
    q, u, a = (_freed(scene, compiled, free, values, rates) for values, rates in ((motion.q, 0), (motion.u, 1), (motion.a, 1)))
    here = loads.ids < len(free.model.contacts)  # those of racks of gears come last
    ids = loads.ids[here]
    mechanism = Mechanism(free)
    seen = mechanism.seen(motion.t, q, u, ids)
    force = loads.force[:, here]
    load = (force[:, None, :, 0] @ seen.w_N + force[:, None, :, 1] @ seen.w_T)[:, 0]
    lacking = np.asarray(free.model.coordinates.mass) * a - seen.h + mechanism.dry * np.sign(u) - load
    return lacking, ~(mechanism.prescribed | ((mechanism.dry > 0.0) & (u == 0.0)))


def _freed(scene: Scene, compiled: Compiled, free: Compiled, values: Array, rates: int) -> Array:
    """Coordinates of the freed scene, or their rates: bodies that shared one have their own."""
    out = np.zeros((len(values), len(free.q)))
    for i, body in enumerate(scene.bodies):
        own = free.slices.get(body.name)
        if own is not None and body.motion == "free":
            out[:, own] = values[:, compiled.slices[body.name]]
        elif own is not None and body.name in compiled.loose:
            out[:, free.columns(body.name)] = values[:, compiled.columns(body.name)]
        elif own is not None:
            out[:, own.start] = compiled.own(i, values, bool(rates))
    return out


def _at_pitch_point(
    scene: Scene,
    compiled: Compiled,
    motion: Motion,
    gear: Gear,
    numbers: tuple[int, int],
    torques: tuple[Array, Array],
    hung: tuple[Ride, ...],
) -> Iterator[Pressed]:
    """The force on both bodies, or only on the one that rolls round a fixed wheel on the other."""
    first, second = numbers
    if hung[first].turns_with == second:
        yield from _on_the_planet(scene, compiled, motion, gear, (second, first), torques[0], 1.0 / gear.ratio, hung)
    elif hung[second].turns_with == first:
        yield from _on_the_planet(scene, compiled, motion, gear, (first, second), torques[1], gear.ratio, hung)
    else:
        found = _on_the_second(scene, gear, (first, second), torques)
        if found is not None:
            yield Pressed(second, found)
            yield Pressed(first, -found)


def _on_the_second(scene: Scene, gear: Gear, numbers: tuple[int, int], torques: tuple[Array, Array]) -> Array | None:
    """Force on the second body of two in the movement. With an efficiency the mean of what both feel along the tangent."""
    a, b = (scene.bodies[number] for number in numbers)
    lean = math.tan(gear.pressure_angle)
    if a.motion == b.motion == "slide":
        return None
    if "slide" in (a.motion, b.motion):
        rack = b if b.motion == "slide" else a
        reach = gear.ratio if b.motion == "slide" else 1.0 / gear.ratio  # m/rad, of the rack
        sign, own, others = (1.0, torques[1], -torques[0] / reach) if rack is b else (-1.0, torques[0], -torques[1] / reach)
        along = 0.5 * (own + others)
        axis = np.array(rack.axis)
        away = math.copysign(1.0, reach) * np.array((axis[1], -axis[0]))
        return sign * (along[:, None] * axis + lean * np.abs(along)[:, None] * away)
    line = np.subtract(b.position, a.position)
    distance, r = float(np.hypot(*line)), gear.ratio
    if distance == 0.0 or r == 1.0:
        return None
    e = line / distance
    from_a = r * distance / (r - 1.0)  # of the pitch point, towards the second
    along = 0.5 * (torques[1] / (from_a - distance) - torques[0] / from_a)
    apart = 1.0 if r < 0.0 else -1.0  # outside gears are pressed apart, a pinion within a ring towards its axis
    return along[:, None] * np.array((-e[1], e[0])) + apart * lean * np.abs(along)[:, None] * e


def _on_the_planet(
    scene: Scene,
    compiled: Compiled,
    motion: Motion,
    gear: Gear,
    numbers: tuple[int, int],
    torque: Array,
    ratio: float,
    hung: tuple[Ride, ...],
) -> Iterator[Pressed]:
    """The force of the fixed wheel on a body that is carried round it, `ratio` times as fast against its carrier."""
    carrier, planet = numbers
    distance = math.hypot(*hung[planet].place)
    if distance == 0.0 or ratio == -1.0:
        return
    turned = compiled.own(carrier, motion.q) + math.atan2(hung[planet].place[1], hung[planet].place[0])
    e = np.stack((np.cos(turned), np.sin(turned)), axis=1)
    radius = distance / (1.0 + ratio)  # negative within a ring
    along = -torque / radius
    across = np.stack((-e[:, 1], e[:, 0]), axis=1)
    lean = math.copysign(math.tan(gear.pressure_angle), radius)
    yield Pressed(planet, along[:, None] * across + lean * np.abs(along)[:, None] * e)


@dataclass(frozen=True)
class Forces:
    """At times t (n,), s. Contacts are those that were in force at any of them, in the order of `pairs`.

    pairs       row of `Trajectory.pairs` of each contact (k,)
    normal      how hard it presses, N (n, k); 0 where it is open
    tangential  along t, the normal turned by +90°, on body A, N (n, k)
    direction   the normal, out of body B's material (n, k, 2); nan where it is open
    point       where it touches, m (n, k, 2); nan where it is open
    pivots      name of a pivoted body -> force on it from its bearing in the movement, N (n, 2), with that of the teeth of
                [[gears]] (`mesh_forces`); what springs between points do to it is left out
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

    @property
    def on_a(self) -> Array:
        """What each contact does to its body A, N (n, k, 2); nan where it is open."""
        across = np.stack((-self.direction[..., 1], self.direction[..., 0]), axis=-1)
        return np.asarray(self.normal[..., None] * self.direction + self.tangential[..., None] * across)

    def __repr__(self) -> str:
        most = f"up to {self.normal.max():.3g} N at {len(self.pairs)} contacts" if self.normal.size else "no contact in force"
        return f"<Forces at {len(self.t)} instants: {most}; pivots of {', '.join(self.pivots) or 'nothing'}>"


def forces(run: Trajectory, times: Iterable[float] | float | None = None) -> Forces:
    """Forces at these times (s) or this one, by default at all rows; after an impact where one happens at that time.

    Where contacts are redundant the smallest forces are given. ValueError for a run by fixed steps, whose contacts have
    impulses only, and where events were not kept.
    """
    if run.method != EVENT_DRIVEN:
        raise ValueError(f"forces need an event-driven run; {run.method} knows impulses over its steps only")
    if run.keep == STATISTICS:
        raise ValueError('forces need all events of a run: simulate with record = "events", "all" or windows')
    if isinstance(times, Iterable) and not isinstance(times, np.ndarray):
        times = list(times)
    t = np.atleast_1d(np.array(run.t if times is None else times, float))
    q, u = run.sample(t)
    compiled = compile_scene(run.scene)
    where, speed = absolute(compiled, q, False), absolute(compiled, u, True)
    mechanism = Mechanism(compiled)
    alike = modes_in_force(run, t)
    pairs = np.array(sorted({k for in_force in alike for k, _ in in_force}), np.int64)
    shape = (len(t), len(pairs), 2)
    force, pressed, load, turning = np.zeros((2, *shape[:2])), np.zeros(shape), np.zeros(where.shape), np.zeros(where.shape)
    out = Forces(t, pairs, force[0], force[1], np.full(shape, np.nan), np.full(shape, np.nan), {}, {})
    for in_force, rows in alike.items():
        found = mechanism.balanced(t[rows], where[rows], speed[rows], dict(in_force))
        place = np.ix_(np.array(rows), np.searchsorted(pairs, found.ids))
        out.normal[place], out.tangential[place] = found.force[:, :, 0], found.force[:, :, 1]
        out.direction[place], out.point[place], pressed[place] = found.normal, found.point, _pressed(found)
        load[rows], turning[rows] = found.load, found.acceleration
    motion = Motion(t, where, speed, turning)
    both = Loads(pairs, np.moveaxis(force, 0, 2), pressed)
    meshed = list(mesh_forces(run.scene, compiled, motion, both))
    out.pivots.update(_pivots(run, compiled, motion, both, meshed))
    out.drives.update(_drives(run, compiled, load, turning))
    return out


def bearing_friction(run: Trajectory, times: Array) -> Array:
    """Dry friction of the bearings at times (n,) of a run by events, N·m or N (n, coordinates); with a load, by what it is."""
    compiled = compile_scene(run.scene)
    mechanism = Mechanism(compiled)
    q, u = run.sample(times)
    q, u = absolute(compiled, q, False), absolute(compiled, u, True)
    dry = np.zeros(q.shape)
    for in_force, rows in modes_in_force(run, times).items():
        dry[rows] = mechanism.rubbed(
            mechanism.balanced(times[rows], q[rows], u[rows], dict(in_force)), times[rows], q[rows], u[rows]
        )
    return dry


def just_before(edges: Array, share: float) -> Array:
    """Times that a `share` of every stretch between `edges` (s) separates from its end: what is in force in it still is."""
    return np.asarray(edges[1:] - np.maximum(share * np.diff(edges), np.spacing(edges[1:])))


def absolute(compiled: Compiled, values: Array, rates: bool) -> Array:
    """Coordinates in the movement from those that the trajectory gives: the inverse of `Compiled.relative`."""
    out = np.array(values)
    out = out[:, : len(compiled.q)]  # what is geared to others follows from them
    for own, on, angle in compiled.against:  # carriers come before what they carry
        out[:, own] += (out[:, on] if on >= 0 else 0.0) + (0.0 if rates else angle)
    return out


def _pressed(found: Balanced) -> Array:
    """Force on body A of each contact, N (n, m, 2)."""
    across = np.stack((-found.normal[:, :, 1], found.normal[:, :, 0]), axis=2)
    return np.asarray(found.force[:, :, :1] * found.normal + found.force[:, :, 1:] * across)


def _pivots(
    run: Trajectory, compiled: Compiled, motion: Motion, loads_found: Loads, meshed: list[Pressed]
) -> Iterator[tuple[str, Array]]:
    """What the bearings in the movement take: change of momentum less all else, of a body with all it carries."""
    hung, weighed, _ = loads(run.scene.bodies)
    # The bodies of the model on both sides of each contact.
    contacts, primitives = compiled.model.contacts[loads_found.ids], compiled.model.primitives
    (on_a, on_b) = primitives.body[contacts.a], primitives.body[contacts.b]
    for i, (body, ride, load) in enumerate(zip(run.scene.bodies, hung, weighed, strict=True)):
        if body.motion != "pivot" or ride.host >= 0 or body.name in compiled.loose:  # with play its bearing is a contact
            continue
        own = [k for k, other in enumerate(hung) if i in (k, other.part_of, other.host)]
        sign = np.isin(on_a, own).astype(float) - np.isin(on_b, own).astype(float)
        angle, spin, turn = (
            compiled.own(i, values, rates) for values, rates in ((motion.q, False), (motion.u, True), (motion.a, True))
        )
        c, s = np.cos(angle), np.sin(angle)
        moment = np.stack((c * load.moment[0] - s * load.moment[1], s * load.moment[0] + c * load.moment[1]), axis=1)
        change = turn[:, None] * np.stack((-moment[:, 1], moment[:, 0]), axis=1) - (spin * spin)[:, None] * moment
        pressed = np.einsum("k,nkx->nx", sign, loads_found.pressed) + sum(one.force for one in meshed if one.body in own)
        shaken = inertial(compiled.model, motion.t, motion.q, motion.u, i)[0]
        sprung = pulled(compiled.model, i, motion.q, motion.u)
        yield body.name, change - load.mass * np.array(run.scene.gravity) - shaken - sprung - pressed


def _drives(run: Trajectory, compiled: Compiled, load: Array, a: Array) -> Iterator[tuple[str, Array]]:
    """Against the contacts, and for the acceleration of as much mass or inertia as the scene gives the body."""
    for body, mass in zip(run.scene.bodies, loads(run.scene.bodies)[2], strict=True):
        if body.prescribed is not None:
            j = compiled.slices[body.name].start
            yield body.name, mass * a[:, j] - load[:, j]
