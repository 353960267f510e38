"""What happens in every phase of a beat: angles, velocities, impulse on the balance, and where the energy went?

Energies of a phase add up by themselves but for friction, which is what is left; `friction.py` works it out a second time from
the forces at the contacts, so that the books are checked.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.beats import Beats
from watchsim.analysis.phases import Phase, phases
from watchsim.analysis.timeline.flows import Flows, flows
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.mechanism.recording import STATISTICS
from watchsim.mechanism.roles import Roles, drive_direction, roles
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.trajectory import Array, Trajectory

LOSSES = (EventKind.IMPACT, EventKind.JAM)
Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Energies:
    """Of one phase, J. supplied = stored + damping + friction + impacts.

    supplied    work of the drive and of weights
    stored      gain of kinetic energy and of springs
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
    """A phase with everything told of it; triples are of wheel, lever and oscillator, rad and rad/s.

    `pallet`: entry or exit, the stone that is unlocked in this beat; "" where that cannot be told. `impulse`: angular impulse of
    all contacts on the oscillator, N·m·s. Rates at the start are before impacts at that time, but after the lock's at the end of
    a drop and at the start of what follows.
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


def timeline(run: Trajectory, found: Beats | None = None, window: Sequence[float] | None = None) -> list[Stage]:
    """The phases of all beats recorded whole, or of those that begin within a window (s); empty without an escapement."""
    told = phases(run, found)
    if window is not None:
        inside = {row.beat for row in told if row.name == "unlock" and window[0] <= row.start <= window[1]}
        told = [row for row in told if row.beat in inside]
    if not told:
        return []
    parts, compiled = roles(run.scene), compile_scene(run.scene)
    first = max(0, int(np.searchsorted(run.t, told[0].start, side="left")) - 1)
    last = min(len(run.t), int(np.searchsorted(run.t, told[-1].end, side="right")) + 1)
    made = flows(run, compiled, slice(first, last))
    losses = _losses(run)
    sides = {row.beat: _pallet(run, compiled, parts, row) for row in told if row.name == "unlock"}
    return [_stage(run, parts, compiled, made, losses, row, sides.get(row.beat, "")) for row in told]


@dataclass(frozen=True)
class _Losses:
    t: Array
    lost: Array
    pair: tuple[str, ...]


def _losses(run: Trajectory) -> _Losses:
    own = run.events[np.isin(run.events["kind"], LOSSES)]
    names = {k: _bodies(run, k) for k in np.unique(own["contact"]).tolist()}
    return _Losses(own["t"], own["energy_lost"], tuple(names[k] for k in own["contact"].tolist()))


def _bodies(run: Trajectory, contact: int) -> str:
    pair = run.pairs[contact]
    return "-".join(sorted((pair.body_a, pair.body_b), key=[body.name for body in run.scene.bodies].index))


def _stage(
    run: Trajectory, parts: Roles, compiled: Compiled, made: Flows, losses: _Losses, row: Phase, pallet: str
) -> Stage:
    # The impacts of the lock belong to the drop that ends with them, all others to the phase that they begin.
    i = _row(made.t, row.start, after=row.name == "run to banking")
    j = _row(made.t, row.end, after=row.name == "drop")
    low = np.searchsorted(losses.t, row.start, side="right" if row.name == "run to banking" else "left")
    high = np.searchsorted(losses.t, row.end, side="right" if row.name == "drop" else "left")
    impacts: dict[str, float] = {}
    for k in range(int(low), int(high)):
        impacts[losses.pair[k]] = impacts.get(losses.pair[k], 0.0) + float(losses.lost[k])
    names = (parts.wheel, parts.lever, parts.oscillator)
    columns = [run.slices[name].start for name in names if name]
    balance = columns[2]
    c = compiled.model.coordinates[balance]
    supplied, stored = float(made.drive[j] - made.drive[i]), float(made.stored[j] - made.stored[i])
    damping = float((made.damped[j] - made.damped[i]).sum())
    gained = float(made.own[j, balance] - made.own[i, balance])
    to_balance = gained + float(made.damped[j, balance] - made.damped[i, balance])
    to_balance -= float(made.driven[j, balance] - made.driven[i, balance])
    turned, time = float(made.q[j, balance] - made.q[i, balance]), float(made.t[j] - made.t[i])
    swept = float(made.swept[j, balance] - made.swept[i, balance])
    impulse = c.mass * float(made.u[j, balance] - made.u[i, balance]) + c.viscous * turned
    impulse += c.stiffness * (swept - c.rest * time) - c.force * time
    friction = supplied - stored - damping - sum(impacts.values())
    energy = Energies(supplied, stored, to_balance, damping, friction, impacts)
    rates = compiled.relative(made.u[[i, j]], rates=True)[:, columns]
    angles = compiled.relative(made.q[[j]])[0, columns]
    return Stage(row, pallet, _triple(rates[0]), _triple(angles), _triple(rates[1]), float(impulse), energy)


def _triple(values: Array) -> Triple:
    first, second, third = values.tolist()
    return first, second, third


def _row(t: NDArray[np.float64], time: float, after: bool) -> int:
    """The row at a time: the first of several, or the last."""
    k = int(np.searchsorted(t, time, side="right")) - 1 if after else int(np.searchsorted(t, time, side="left"))
    return min(max(k, 0), len(t) - 1)


def _pallet(run: Trajectory, compiled: Compiled, parts: Roles, row: Phase) -> str:
    """The stone on which the wheel rested before it was unlocked: that of the last contact of wheel and lever before."""
    assert parts.wheel and parts.lever
    events = run.events[(run.events["contact"] >= 0) & (run.events["t"] <= row.start)]
    for contact in events["contact"][::-1].tolist():
        pair = run.pairs[contact]
        if {pair.body_a, pair.body_b} == {parts.wheel, parts.lever}:
            return _side(run, compiled, parts, contact, row.start)
    return ""


def _side(run: Trajectory, compiled: Compiled, parts: Roles, contact: int, time: float) -> str:
    """Entry where the stone lies before the line from wheel to lever, in the wheel's sense of turning."""
    assert parts.wheel and parts.lever
    model = compiled.model
    table = model.contacts[contact]
    x0, y0, _ = run.pose(parts.wheel, time)
    x1, y1, angle = run.pose(parts.lever, time)
    owners = compiled.owners
    k = int(table.a if owners[int(table.a)] == parts.lever else table.b)
    p = model.primitives[k]
    c, s = math.cos(angle), math.sin(angle)
    x, y = x1 + c * p.px - s * p.py, y1 + s * p.px + c * p.py
    turn = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
    return "entry" if drive_direction(run.scene, parts.wheel) * turn < 0.0 else "exit"


def can_be_told(run: Trajectory) -> bool:
    """Do rows and events of this run carry energies: by events, and with all of them kept?"""
    return run.method == EVENT_DRIVEN and run.keep != STATISTICS
