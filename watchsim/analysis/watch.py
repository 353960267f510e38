"""Which parts of a run make a watch, and where do they stand at any time?"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.balanced_forces import Mechanism, modes_in_force
from watchsim.analysis.escape_wheel import progress
from watchsim.analysis.forces import absolute
from watchsim.analysis.timing import Beats, Events, between, contact_events, contact_numbers, is_recorded, last_window
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.lean import Teeth, teeth
from watchsim.scene.roles import drive_direction, keeps_time, may_lock, oscillators, partners, pitch, roles
from watchsim.scene.teeth import train
from watchsim.simulation import EVENT_DRIVEN
from watchsim.simulation.recording import Pair
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory


def in_force(run: Trajectory, times: list[float]) -> list[list[int]]:
    """For each of the times (s), the numbers of the contacts that hold just after it."""
    found: list[list[int]] = [[] for _ in times]
    for holding, places in modes_in_force(run, np.array(times)).items():
        for place in places:
            found[place] = [contact for contact, _ in holding]
    return found


@dataclass(frozen=True)
class Arms:
    """Of k contacts at time `t`: forces N along the normal and T across it act on coordinate j
    with N·normal[:, j] and T·across[:, j].

    normal, across  (k, n): w_N and w_T, m for turning bodies
    point, way      (k, 2): where they touch, m, and the normal out of body B, in the movement
    places          body -> x, y, angle of its frame in the movement
    friction        (k,)
    loads, dry      (n,): torques and forces of all that is no contact, on bodies at rest; dry friction of their bearings
    """

    t: float
    pairs: tuple[Pair, ...]
    columns: dict[str, int]
    normal: Array
    across: Array
    point: Array
    way: Array
    places: dict[str, tuple[float, float, float]]
    friction: Array
    loads: Array
    dry: Array

    def of(self, row: int, body: str) -> tuple[float, float]:
        """Lever arms (m) of the normal and the tangential force of a contact on a body."""
        column = self.columns[body]
        return float(self.normal[row, column]), float(self.across[row, column])


def arms(run: Trajectory, compiled: Compiled, t: float, contacts: list[int]) -> Arms:
    """Of the contacts with these numbers at a recorded time; loads are those of bodies that stand still."""
    return arms_at(run, compiled, t, run.at(t)[0], contacts)


def arms_at(run: Trajectory, compiled: Compiled, t: float, q: Array, contacts: list[int]) -> Arms:
    """The same at coordinates q (n,) of the scene."""
    places = {body.name: run.pose_of(body.name, q) for body in run.scene.bodies}
    q = absolute(compiled, q[None], False)
    seen = Mechanism(compiled).seen(np.array([float(t)]), q, np.zeros(q.shape), np.array(contacts, np.int64))
    pairs = tuple(run.pairs[number] for number in contacts)
    return Arms(
        float(t),
        pairs,
        {name: columns.start for name, columns in run.slices.items() if columns.start < q.shape[1]},
        seen.w_N[0],
        seen.w_T[0],
        seen.point[0],
        seen.normal[0],
        places,
        np.array([compiled.model.laws[pair.group].friction for pair in pairs]),
        seen.h[0],
        np.array(compiled.model.coordinates.coulomb),
    )


# The parts stand still. The lever is thought to begin to turn one way; the contacts' directions say how wheel and oscillator
# go with it and how the contacts slip, and friction resists. The equilibrium of the part on the other side of a contact gives
# the force there, and its arms the torque at the lever.


def at_lever(found: Arms, row: int, other: str, lever: str, way: float) -> float | None:
    """N·m on the lever along `way` (+1 or -1) by what acts on body `other` through the contact `row`, as the lever begins to
    turn that way; negative where it resists. None where friction jams it or the contact cannot carry it.
    """
    (n_lever, t_lever), (n_other, t_other) = found.of(row, lever), found.of(row, other)
    if n_other == 0.0:
        return None
    turn = -n_lever * way / n_other  # of the other body, so that the contact neither opens nor overlaps
    slip = t_lever * way + t_other * turn
    rub = -float(found.friction[row]) * (math.copysign(1.0, slip) if slip else 0.0)
    column = found.columns[other]
    load = float(found.loads[column] - np.sign(turn) * found.dry[column])
    arm = n_other + rub * t_other
    if arm * n_other <= 0.0:  # friction alone holds what the normal force would move
        return None
    force = -load / arm
    return None if force < 0.0 else way * force * (n_lever + rub * t_lever)


SMALLEST_ADVANCE = 0.01  # rad, for a wheel whose pitch is not known
FEWEST_SWINGS = 4  # through the rest position, of what swings


@dataclass(frozen=True)
class Watch:
    """Oscillator, driven wheel and (where there is one) lever of a run, by name, and its half swings."""

    run: Trajectory
    found: Beats
    oscillator: str
    wheel: str
    lever: str | None

    @cached_property
    def pitch(self) -> float | None:
        """rad from tooth to tooth; None where that is not known."""
        return pitch(self.run.scene, self.wheel)

    @cached_property
    def rest(self) -> float:
        """Coordinate (rad) at which the oscillator rests."""
        return next(one.rest for one in oscillators(self.run.scene) if one.body == self.oscillator)

    @cached_property
    def fixed(self) -> set[str]:
        return {body.name for body in self.run.scene.bodies if body.motion == "fixed"}

    @cached_property
    def compiled(self) -> Compiled:
        return compile_scene(self.run.scene)

    @property
    def has_shapes(self) -> bool:
        """Whether the contacts of the run are those of its scene's outlines, so that their arms are known."""
        return len(self.run.pairs) == len(self.compiled.model.contacts)

    @property
    def has_banking(self) -> bool:
        """Whether the lever may touch something fixed."""
        return self.lever is not None and bool(partners(self.run.scene, self.lever) & self.fixed)

    @property
    def has_modes(self) -> bool:
        """Whether the events say which contacts are in force."""
        return self.run.method == EVENT_DRIVEN

    @cached_property
    def teeth(self) -> Teeth | None:
        return teeth(self.run.scene, self.wheel)

    @property
    def least_advance(self) -> float:
        """rad: a wheel that went less far has not passed a tooth."""
        return SMALLEST_ADVANCE if self.pitch is None else 0.25 * self.pitch

    def angle(self, body: str, times: Array) -> Array:
        """Coordinate (rad) of a body at recorded times (s)."""
        return self.run.positions(times, [self.run.slices[body].start])[:, 0]

    def progress(self, times: Array) -> Array:
        """How far (rad) the wheel has turned with its drive since the start, at recorded times (s)."""
        return progress(self.run, self.wheel, times)

    def recorded(self, times: Array) -> NDArray[np.bool_]:
        return is_recorded(self.run, times)

    def events(self, first: str, others: set[str], *kinds: EventKind) -> Events:
        """Contact events of body `first` with any of the others."""
        return contact_events(self.run, between(first, others), *kinds)

    def contacts(self, first: str, others: set[str]) -> set[int]:
        """The numbers of the contacts of body `first` with any of the others that ever had an event."""
        return contact_numbers(self.run, between(first, others))

    def drive(self, t: float) -> float:
        """N·m on the wheel, if only through gears, at time `t` (s); tables over angle are read where the body was.

        0 where that was not recorded.
        """
        total, ratios = 0.0, train(self.run.scene, self.wheel)
        for torque in self.run.scene.torques:
            if torque.body not in ratios:
                continue
            value = 0.0
            if not torque.table:
                value = torque.value
            elif torque.over == "time":
                value = torque.over_time(t)
            elif self.recorded(np.array([t]))[0]:
                value = float(np.interp(self.angle(torque.body, np.array([t]))[0], *np.array(torque.table).T))
            total += ratios[torque.body] * value
        return total

    @cached_property
    def direction(self) -> float:
        """+1 or -1: the way the drive turns the wheel."""
        return drive_direction(self.run.scene, self.wheel)


def watch_of(run: Trajectory, found: Beats) -> Watch | None:
    """None where no driven wheel keeps an oscillator going.

    A click that a spring presses on its wheel never passes its rest position; what does, swings, though the scene names neither
    a lever nor a lift angle.
    """
    parts = roles(run.scene)
    if parts.oscillator is None or parts.wheel is None or not found.angular:
        return None
    if not keeps_time(run.scene) and (len(found) < FEWEST_SWINGS or not may_lock(run.scene)):
        return None
    if found.body != parts.oscillator:
        return None
    return Watch(run, found, parts.oscillator, parts.wheel, parts.lever)


DRIVING = 0.05  # of the distance from the lever's pivot: with a longer arm the wheel drives the pallet out


@dataclass(frozen=True, slots=True)
class Face:
    """`tooth` counts from 1 (None where the teeth are not known), `pallet` is "entry" or "exit"; on an impulse face the wheel
    drives the pallet out of its way, on a locking face it holds it or draws it in. `out`: the way of the lever, +1 or -1,
    that takes the pallet out."""

    tooth: int | None
    pallet: str
    impulse: bool
    out: float

    def __str__(self) -> str:
        which = "a tooth" if self.tooth is None else f"tooth {self.tooth}"
        return f"{which} rests on the {self.pallet} {'impulse' if self.impulse else 'locking'} face"


def face(watch: Watch, found: Arms, row: int) -> Face:
    """Of a contact between wheel and lever."""
    assert watch.lever is not None
    (wx, wy, turned), (lx, ly, _) = found.places[watch.wheel], found.places[watch.lever]
    x, y = found.point[row].tolist()
    # The entry pallet is the one that a tooth passes before it passes the line of centres.
    from_line = math.remainder(math.atan2(y - wy, x - wx) - math.atan2(ly - wy, lx - wx), math.tau)
    pallet = "entry" if watch.direction * from_line < 0.0 else "exit"
    out = math.copysign(1.0, (ly - y) * (x - wx) + (x - lx) * (y - wy))
    arm, _ = found.of(row, watch.lever)
    tooth = None if watch.teeth is None else watch.teeth.number(math.atan2(y - wy, x - wx) - turned)
    return Face(tooth, pallet, out * arm > DRIVING * math.hypot(x - lx, y - ly), out)


# Between two beats a tooth should rest on a locking face and hold, or draw, the lever on its banking. A tooth that landed on
# an impulse face, or a wheel that turns the wrong way, drives the lever off instead, until its dart rubs on the roller. Where
# a lever has no banking, as in clocks with recoil, nothing can be said.

GRAZING = 0.05  # of the distance from the staff: a dart on its roller has less of an arm, a pin in the fork more
MANY = 8  # turning points


def unlocked(watch: Watch) -> list[tuple[float, str, Face]]:
    """Of the turning points in the last window: time (s), contact in words and face of each tooth that drives the lever off.

    A small swing turns back while the fork still holds the pin, on an impulse face too: that counts only where it is so always.
    """
    if watch.lever is None or not len(watch.found) or not watch.has_banking:
        return []
    start, _ = last_window(watch.run, watch.found.nominal_period)
    times = watch.found.end[watch.recorded(watch.found.end)]
    times = times[times >= start] if len(times) and times[-1] >= start else times[-MANY:]
    pallets, forks, bankings = (
        watch.contacts(watch.lever, others) for others in ({watch.wheel}, {watch.oscillator}, watch.fixed)
    )
    free, engaged = [], []
    for t, holding in zip(times.tolist(), in_force(watch.run, times.tolist()), strict=True):
        own, pins = ([number for number in holding if number in some] for some in (pallets, forks))
        if not own or bankings.intersection(holding):
            continue
        if not watch.has_shapes:
            return []
        reach = arms(watch.run, watch.compiled, t, [*own, *pins])
        driven = [(t, str(reach.pairs[row]), one) for row in range(len(own)) if (one := face(watch, reach, row)).impulse]
        if any(_engaged(watch, reach, row) for row in range(len(own), len(reach.pairs))):
            engaged += driven
        else:
            free += driven
    always = len(times) >= MANY and len(engaged) + len(free) >= len(times)
    return sorted(free + engaged, key=lambda one: one[0]) if always else free


def _engaged(watch: Watch, reach: Arms, row: int) -> bool:
    x, y, _ = reach.places[watch.oscillator]
    arm, _ = reach.of(row, watch.oscillator)
    return abs(arm) > GRAZING * math.hypot(reach.point[row, 0] - x, reach.point[row, 1] - y)
