"""What happens in every phase of a beat: angles, velocities, impulse on the balance, and where the energy went?

Energies of a phase add up by themselves but for friction, which is what is left; `friction.py` works it out a second time from
the forces at the contacts, so that the books are checked.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timeline.flows import Flows, flows
from watchsim.analysis.timeline.impact_losses import Losses, impact_losses
from watchsim.analysis.timeline.stones_unlocked import StonesUnlocked
from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.marks.stretches import NAMES
from watchsim.analysis.timing.phases import Phase, Phases, phase_columns
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.recording import STATISTICS
from watchsim.scene.roles import Roles, with_anchor
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.storage.columns import let_go

DROP = NAMES.index("drop")
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

    phases: Phases
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
    impacts: Losses

    def each(self) -> Iterator[Stage]:
        """One after the other."""
        triples = (map(_triple, values.tolist()) for values in (self.start_rates, self.end_angles, self.end_rates))
        energies = (values.tolist() for values in (self.supplied, self.stored, self.to_balance, self.damping, self.friction))
        losses = self.impacts.by_pair()
        rows = zip(self.phases.each(), self.pallets, *triples, self.impulse.tolist(), *energies, losses, strict=True)
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
    staged = Staging(run)
    for some in phase_columns(run, found, window):
        if len(some):
            yield staged.of(some)


class Staging:
    """What makes stages of the phases of a run, in an escapement with a lever or an anchor."""

    def __init__(self, run: Trajectory) -> None:
        self._run, self._parts, self._compiled = run, with_anchor(run.scene), compile_scene(run.scene)

    @cached_property
    def _stones(self) -> StonesUnlocked:
        return StonesUnlocked(self._run, self._compiled, self._parts)

    def of(self, some: Phases) -> Stages:
        """The stages of some beats in a row, at least one."""
        run, told = self._run, some.rows
        first = int(np.searchsorted(run.t, told.start[0], side="left"))
        last = int(np.searchsorted(run.t, told.end[-1], side="right")) + 1
        made = flows(run, self._compiled, slice(first, last))
        begins = told.first
        rested = np.array(self._stones.at(told.start[begins]), object)
        pallets = np.repeat(rested, np.diff(np.append(begins, len(told)))).tolist()
        columns = _columns(run, self._parts, self._compiled, made, some, pallets)
        let_go(run.t, run.q, run.u, run.a, run.events)
        return columns


def _columns(run: Trajectory, parts: Roles, compiled: Compiled, made: Flows, told: Phases, pallets: list[str]) -> Stages:
    """Every number is a difference between two rows."""
    starts, ends = told.rows.start, told.rows.end
    # The impacts of the lock belong to the drop that ends with them, all others to the phase that they begin. A lever that is
    # on its bank before the lock has no run to it: then the lock also is where the free oscillation begins.
    locks = ends[told.rows.name == DROP]
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
    impacts = impact_losses(run, starts, ends, locked, locking)
    rates_i, rates_j = (compiled.relative(made.u[k], rates=True)[:, columns] for k in (i, j))
    supplied, stored, damped = change(made.drive), change(made.stored), damping.sum(axis=1)
    return Stages(
        phases=told,
        pallets=pallets,
        start_rates=rates_i,
        end_angles=compiled.relative(made.q[j])[:, columns],
        end_rates=rates_j,
        impulse=impulse,
        supplied=supplied,
        stored=stored,
        to_balance=to_balance,
        damping=damped,
        friction=supplied - stored - damped - impacts.whole,
        impacts=impacts,
    )


def _triple(values: list[float]) -> Triple:
    first, second, third = values
    return first, second, third


def _rows(t: Array, times: Array, after: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The rows at some times: the first of several, or the last."""
    k = np.where(after, np.searchsorted(t, times, side="right") - 1, np.searchsorted(t, times, side="left"))
    return np.clip(k, 0, len(t) - 1)


def can_be_told(run: Trajectory) -> bool:
    """Do rows and events of this run carry energies: by events, and with all of them kept?"""
    return run.method == EVENT_DRIVEN and run.keep != STATISTICS
