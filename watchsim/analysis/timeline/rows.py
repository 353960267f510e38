"""What happens in every phase of a beat: angles, velocities, impulse on the balance, and where the energy went?

Energies of a phase add up by themselves but for friction, which is what is left; `friction.py` works it out a second time from
the forces at the contacts, so that the books are checked.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import groupby, islice

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timeline.flows import Flows, flows
from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.body_contacts import between, contact_columns
from watchsim.analysis.timing.phases import Phase, each_phase
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.recording import STATISTICS
from watchsim.scene.roles import Roles, drive_direction, with_anchor
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.storage.columns import let_go

LOSSES = (EventKind.IMPACT, EventKind.JAM)
BEATS_AT_ONCE = 300  # some megabytes, which a processor has at hand
Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Energies:
    """Of one phase, J. supplied = stored + damping + friction + impacts.

    supplied    work of the drive
    stored      gain of kinetic energy, of springs, and of weights on turning bodies, such as a pendulum's
    to_balance  work of all contacts on the oscillator
    damping     taken by the air, by bearings
    friction    taken at the contacts: what is left of the books
    impacts     by pair of bodies
    """

    supplied: float
    stored: float
    to_balance: float
    damping: float
    friction: float
    impacts: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Stage:
    """A phase with everything reported of it; triples are of wheel, lever and oscillator, rad and rad/s.

    `pallet`: entry or exit, the stone that is unlocked in this beat; "" where that cannot be told. `impulse`: angular impulse
    of all contacts on the oscillator, N·m·s. Rates at the start are before impacts at that time, but after the lock's at the
    end of a drop and at the start of what follows.
    """

    phase: Phase
    pallet: str
    start_rates: Triple
    end_angles: Triple
    end_rates: Triple
    impulse: float
    energy: Energies

    @property
    def beat(self) -> int:
        return self.phase.beat

    @property
    def name(self) -> str:
        return self.phase.name


@dataclass(frozen=True, slots=True)
class Stages:
    """The stages of some beats in a row, column by column: (n,), of wheel, lever and oscillator (n, 3); names as in `Stage`."""

    phases: list[Phase]
    pallets: list[str]
    start_rates: Array
    end_angles: Array
    end_rates: Array
    impulse: Array
    supplied: Array
    stored: Array
    to_balance: Array
    damping: Array
    friction: Array
    impacts: list[dict[str, float]]

    def each(self) -> Iterator[Stage]:
        """One after the other."""
        triples = (map(_triple, values.tolist()) for values in (self.start_rates, self.end_angles, self.end_rates))
        energies = (values.tolist() for values in (self.supplied, self.stored, self.to_balance, self.damping, self.friction))
        rows = zip(self.phases, self.pallets, *triples, self.impulse.tolist(), *energies, self.impacts, strict=True)
        for phase, pallet, first, place, last, push, supplied, stored, gained, damped, rubbed, struck in rows:
            yield Stage(phase, pallet, first, place, last, push, Energies(supplied, stored, gained, damped, rubbed, struck))


def timeline(run: Trajectory, found: Beats | None = None, window: Sequence[float] | None = None) -> list[Stage]:
    """The phases of all beats recorded whole, or of those that begin within a window (s); empty without an escapement."""
    return list(each_stage(run, found, window))


def each_stage(run: Trajectory, found: Beats | None = None, window: Sequence[float] | None = None) -> Iterator[Stage]:
    """The same one after the other."""
    for part in stages(run, found, window):
        yield from part.each()


def stages(run: Trajectory, found: Beats | None = None, window: Sequence[float] | None = None) -> Iterator[Stages]:
    """The same in columns: the rows of a long run are read a few beats at a time."""
    parts, compiled = with_anchor(run.scene), compile_scene(run.scene)
    if not (parts.wheel and parts.lever):
        return
    rests = _rests(run, compiled, parts)
    beats_told = (list(rows) for _, rows in groupby(each_phase(run, found, window), key=lambda row: row.beat))
    wanted = (rows for rows in beats_told if window is None or window[0] <= rows[0].start <= window[1])
    while some := list(islice(wanted, BEATS_AT_ONCE)):
        told = [row for rows in some for row in rows]
        first = max(0, int(np.searchsorted(run.t, told[0].start, side="left")) - 1)
        last = int(np.searchsorted(run.t, told[-1].end, side="right")) + 1
        made = flows(run, compiled, slice(first, last))
        stones = _pallets(run, compiled, parts, rests, [rows[0] for rows in some])
        yield _columns(run, parts, compiled, made, told, stones)
        let_go(run.t, run.q, run.u, run.a, run.events)


def _columns(
    run: Trajectory, parts: Roles, compiled: Compiled, made: Flows, told: list[Phase], stones: dict[int, str]
) -> Stages:
    """Every number is a difference between two rows."""
    starts, ends = np.array([row.start for row in told]), np.array([row.end for row in told])
    # The impacts of the lock belong to the drop that ends with them, all others to the phase that they begin. A lever that is
    # on its bank before the lock has no run to it: then the lock also is where the free oscillation begins.
    locks = ends[[row.name == "drop" for row in told]]
    locked, locking = np.isin(starts, locks), np.isin(ends, locks)
    i, j = _rows(made.t, starts, locked), _rows(made.t, ends, locking)
    names = [name for name in (parts.wheel, parts.lever, parts.oscillator) if name]
    columns = [run.slices[name].start for name in names]
    balance = columns[2]
    c = compiled.model.coordinates[balance]

    def change(values: Array) -> Array:
        return np.asarray(values[j] - values[i])

    damping = change(made.damped)
    to_balance = change(made.own[:, balance]) + damping[:, balance] - change(made.driven[:, balance])
    impulse = c.mass * change(made.u[:, balance]) + c.viscous * change(made.q[:, balance])
    impulse += c.stiffness * (change(made.swept[:, balance]) - c.rest * change(made.t)) - c.force * change(made.t)
    impacts = _impacts(run, starts, ends, locked, locking)
    rates_i, rates_j = (compiled.relative(made.u[k], rates=True)[:, columns] for k in (i, j))
    supplied, stored, damped = change(made.drive), change(made.stored), damping.sum(axis=1)
    return Stages(
        phases=told,
        pallets=[stones.get(row.beat, "") for row in told],
        start_rates=rates_i,
        end_angles=compiled.relative(made.q[j])[:, columns],
        end_rates=rates_j,
        impulse=impulse,
        supplied=supplied,
        stored=stored,
        to_balance=to_balance,
        damping=damped,
        friction=supplied - stored - damped - np.array([sum(one.values()) for one in impacts]),
        impacts=impacts,
    )


def _triple(values: list[float]) -> Triple:
    first, second, third = values
    return first, second, third


def _rows(t: Array, times: Array, after: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The rows at some times: the first of several, or the last."""
    k = np.where(after, np.searchsorted(t, times, side="right") - 1, np.searchsorted(t, times, side="left"))
    return np.clip(k, 0, len(t) - 1)


def _impacts(
    run: Trajectory, starts: Array, ends: Array, locked: NDArray[np.bool_], locking: NDArray[np.bool_]
) -> list[dict[str, float]]:
    """What impacts took in each stretch, by pair of bodies, J."""
    # Bisection, not numpy's search: that would copy the whole column for each few beats.
    first, last = bisect_left(run.events["t"], starts[0]), bisect_right(run.events["t"], ends.max())
    own = run.events[first:last]
    own = own[np.isin(own["kind"], LOSSES)]
    names = {k: pair_name(run, k) for k in np.unique(own["contact"]).tolist()}
    pairs, lost = [names[k] for k in own["contact"].tolist()], own["energy_lost"].tolist()
    t = np.ascontiguousarray(own["t"])
    low = np.where(locked, np.searchsorted(t, starts, side="right"), np.searchsorted(t, starts, side="left"))
    high = np.where(locking, np.searchsorted(t, ends, side="right"), np.searchsorted(t, ends, side="left"))
    found: list[dict[str, float]] = []
    for first, last in zip(low.tolist(), high.tolist(), strict=True):
        one: dict[str, float] = {}
        for pair, value in zip(pairs[first:last], lost[first:last], strict=True):
            one[pair] = one.get(pair, 0.0) + value
        found.append(one)
    return found


def pair_name(run: Trajectory, contact: int) -> str:
    """The two bodies of a contact, in the order of the scene."""
    pair = run.pairs[contact]
    return "-".join(sorted((pair.body_a, pair.body_b), key=[body.name for body in run.scene.bodies].index))


def _rests(run: Trajectory, compiled: Compiled, parts: Roles) -> tuple[Array, NDArray[np.int64]]:
    """When wheel and lever touch or part, and the number of the contact."""
    assert parts.wheel and parts.lever
    times, contacts = contact_columns(run, between(parts.lever, {parts.wheel}), ["t", "contact"])
    known = contacts < len(compiled.model.contacts)
    return times[known], contacts[known]


def _pallets(
    run: Trajectory, compiled: Compiled, parts: Roles, rests: tuple[Array, NDArray[np.int64]], unlocking: list[Phase]
) -> dict[int, str]:
    """For each beat the stone on which the wheel rested before: that of the last contact of wheel and lever until then.

    None where there are none on either side: a balance that the wheel touches itself turns too far, and both pallets of a pin
    wheel's anchor lie on the same side.
    """
    if parts.lever == parts.oscillator and not _has_pallets(run, compiled, parts):
        return {}
    times, contacts = rests
    last = np.searchsorted(times, [row.start for row in unlocking], side="right") - 1
    found: dict[int, str] = {}
    sides: dict[int, str] = {}
    for row, k in zip(unlocking, last.tolist(), strict=True):
        if k >= 0:
            stone = _stone(compiled, parts, int(contacts[k]))
            if stone not in sides:
                sides[stone] = _side(run, compiled, parts, stone, row.start)
            found[row.beat] = sides[stone]
    return found


def _has_pallets(run: Trajectory, compiled: Compiled, parts: Roles) -> bool:
    """Does an anchor have pallets on either side of the line to its wheel?"""
    on_spring = any(spring.body == parts.oscillator for spring in run.scene.springs) and not any(run.scene.gravity)
    both = {parts.wheel, parts.lever}
    stones = {_stone(compiled, parts, k) for k, pair in enumerate(run.pairs) if {pair.body_a, pair.body_b} == both}
    return not on_spring and len({_side(run, compiled, parts, one, float(run.t[0])) for one in stones}) > 1


def _stone(compiled: Compiled, parts: Roles, contact: int) -> int:
    """The primitive of the lever in a contact with the wheel."""
    p = compiled.model.contacts[contact]
    return int(p.a if compiled.owners[int(p.a)] == parts.lever else p.b)


def _side(run: Trajectory, compiled: Compiled, parts: Roles, stone: int, time: float) -> str:
    """Entry where the stone lies before the line from wheel to lever, in the wheel's sense of turning."""
    assert parts.wheel and parts.lever
    x0, y0, _ = run.pose(parts.wheel, time)
    x1, y1, angle = run.pose(parts.lever, time)
    p = compiled.model.primitives[stone]
    c, s = math.cos(angle), math.sin(angle)
    x, y = x1 + c * p.px - s * p.py, y1 + s * p.px + c * p.py
    turn = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
    return "entry" if drive_direction(run.scene, parts.wheel) * turn < 0.0 else "exit"


def can_be_told(run: Trajectory) -> bool:
    """Do rows and events of this run carry energies: by events, and with all of them kept?"""
    return run.method == EVENT_DRIVEN and run.keep != STATISTICS
