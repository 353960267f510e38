"""How is the timeline of some beats printed: one table of motion, one of energy?"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.flows import Flows, Losses, flows, friction_by_pair, impact_losses
from watchsim.analysis.phases import NAMES, Phase, Phases, phase_columns
from watchsim.analysis.timing import Beats, beats, between, contact_columns, nominal_period
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.roles import Roles, drive_direction, pallet_name, partners, with_anchor
from watchsim.scene.scene import STATISTICS
from watchsim.simulation import EVENT_DRIVEN
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.columns import let_go


class StonesUnlocked:
    """`at` names the stone on which the wheel rested until a beat began: that of the last contact of wheel and lever.

    None where there are none on either side: a balance that the wheel touches itself turns too far, and both pallets of a pin
    wheel's anchor lie on the same side.
    """

    def __init__(self, run: Trajectory, compiled: Compiled, parts: Roles) -> None:
        self._run, self._compiled, self._parts = run, compiled, parts
        self._times, self._contacts = _rests(run, compiled, parts)
        self._known = parts.lever != parts.oscillator or _has_pallets(run, compiled, parts)

    def at(self, starts: Array) -> list[str]:
        """For beats that begin at these times (s): "entry", "exit", or "" where that is not known."""
        if not self._known:
            return [""] * len(starts)
        last = np.searchsorted(self._times, starts, side="right") - 1
        known = last >= 0
        used, of_contact = np.unique(self._contacts[last[known]], return_inverse=True)
        stone_of = np.array([_stone(self._compiled, self._parts, contact) for contact in used.tolist()], np.int64)
        stones, first, of_stone = np.unique(stone_of[of_contact], return_index=True, return_inverse=True)
        rested = zip(stones.tolist(), starts[known][first].tolist(), strict=True)
        sides = [pallet_side(self._run, self._compiled, self._parts, stone, time) for stone, time in rested]
        found = np.full(len(starts), "", object)
        found[known] = np.array(sides, object)[of_stone]
        return found.tolist()


def _rests(run: Trajectory, compiled: Compiled, parts: Roles) -> tuple[Array, NDArray[np.int64]]:
    """When wheel and lever touch or part, and the number of the contact."""
    assert parts.wheel and parts.lever
    times, contacts = contact_columns(run, between(parts.lever, {parts.wheel}), ["t", "contact"])
    known = contacts < len(compiled.model.contacts)
    return times[known], contacts[known]


def _has_pallets(run: Trajectory, compiled: Compiled, parts: Roles) -> bool:
    """Does an anchor have pallets on either side of the line to its wheel?"""
    on_spring = any(spring.body == parts.oscillator for spring in run.scene.springs) and not any(run.scene.gravity)
    both = {parts.wheel, parts.lever}
    stones = {_stone(compiled, parts, k) for k, pair in enumerate(run.pairs) if {pair.body_a, pair.body_b} == both}
    return not on_spring and len({pallet_side(run, compiled, parts, one, float(run.t[0])) for one in stones}) > 1


def _stone(compiled: Compiled, parts: Roles, contact: int) -> int:
    """The primitive of the lever in a contact with the wheel."""
    p = compiled.model.contacts[contact]
    return int(p.a if compiled.owners[int(p.a)] == parts.lever else p.b)


def pallet_side(run: Trajectory, compiled: Compiled, parts: Roles, stone: int, time: float) -> str:
    """Entry where the stone lies before the line from wheel to lever, in the wheel's sense of turning."""
    assert parts.wheel and parts.lever
    x0, y0, _ = run.pose(parts.wheel, time)
    x1, y1, angle = run.pose(parts.lever, time)
    p = compiled.model.primitives[stone]
    c, s = math.cos(angle), math.sin(angle)
    x, y = x1 + c * p.px - s * p.py, y1 + s * p.px + c * p.py
    turn = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
    return "entry" if drive_direction(run.scene, parts.wheel) * turn < 0.0 else "exit"


# Energies of a phase add up by themselves but for friction, which is what is left; `friction.py` works it out a second time
# from the forces at the contacts, so that the books are checked.

DROP = NAMES.index("drop")
Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Energies:
    """Of one phase, J. supplied = stored + damping + friction + impacts.

    supplied    work of the drive
    stored      gain of kinetic energy, of springs, and of weights on turning bodies, such as a pendulum's
    to_balance  work of all contacts on the oscillator
    damping     taken by the air, by bearings
    friction    dissipated at the contacts: the remainder of the energy balance
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

    `pallet`: entry or exit, the stone that is unlocked in this beat; "" where that is not known. `impulse`: angular impulse
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
        run, rows = self._run, some.rows
        first = int(np.searchsorted(run.t, rows.start[0], side="left"))
        last = int(np.searchsorted(run.t, rows.end[-1], side="right")) + 1
        made = flows(run, self._compiled, slice(first, last))
        begins = rows.first
        rested = np.array(self._stones.at(rows.start[begins]), object)
        pallets = np.repeat(rested, np.diff(np.append(begins, len(rows)))).tolist()
        columns = _columns(run, self._parts, self._compiled, made, some, pallets)
        let_go(run.t, run.q, run.u, run.a, run.events)
        return columns


def _columns(run: Trajectory, parts: Roles, compiled: Compiled, made: Flows, some: Phases, pallets: list[str]) -> Stages:
    """Every number is a difference between two rows."""
    starts, ends = some.rows.start, some.rows.end
    # The impacts of the lock belong to the drop that ends with them, all others to the phase that they begin. A lever that is
    # on its bank before the lock has no run to it: then the lock also is where the free oscillation begins.
    locks = ends[some.rows.name == DROP]
    locked, locking = np.isin(starts, locks), np.isin(ends, locks)
    i, j = _rows(made.t, starts, locked), _rows(made.t, ends, locking)
    names = [name for name in (parts.wheel, parts.lever, parts.oscillator) if name]
    columns = [run.slices[name].start for name in names]
    balance = columns[2]
    c = compiled.model.coordinates[balance]

    def change(values: Array) -> Array:
        return np.asarray(values[j] - values[i])

    damping = change(made.damped)
    given = change(made.driven[:, balance]) + change(made.joined[:, balance])
    to_balance = change(made.own[:, balance]) + damping[:, balance] - given
    took = change(made.t)
    impulse = c.mass * change(made.u[:, balance]) + c.viscous * change(made.q[:, balance]) - c.force * took
    impulse += c.stiffness * (change(made.swept[:, balance]) - c.rest * took) - change(made.bent[:, balance])
    for joint in compiled.model.joints:  # the spring of a carried balance, or one between two
        for side, other, rest in ((joint.coordinate, joint.on, joint.rest), (joint.on, joint.coordinate, -joint.rest)):
            if side == balance:
                wound = change(made.swept[:, side] - made.swept[:, other]) - rest * took
                push = joint.force if side == joint.coordinate else -joint.force
                impulse += joint.stiffness * wound - push * took
                impulse += joint.viscous * change(made.q[:, side] - made.q[:, other])
    impacts = impact_losses(run, starts, ends, locked, locking)
    rates_i, rates_j = (compiled.relative(made.u[k], rates=True)[:, columns] for k in (i, j))
    supplied, stored, damped = change(made.drive), change(made.stored), damping.sum(axis=1)
    return Stages(
        phases=some,
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


def knows_energies(run: Trajectory) -> bool:
    """Do rows and events of this run carry energies: by events, and with all of them kept?"""
    return run.method == EVENT_DRIVEN and run.keep != STATISTICS


BEGINNING = ("unlock", "impulse")  # the first phase of a beat
RESTING = ("locked", "recoil")  # and the last


@dataclass(frozen=True)
class Beat:
    """One beat: its phases in order, and of each what friction took by pair of bodies, J (empty where that was not asked for).

    `residual`: what is missing from the energy balance of the beat, J, friction as worked out from forces. `pallet`: what is
    unlocked, "entry stone" or the like; "" where that is not known.
    """

    stages: tuple[Stage, ...]
    friction: tuple[dict[str, float], ...]
    pallet: str = ""

    @property
    def start(self) -> float:
        return self.stages[0].phase.start

    @property
    def first(self) -> str:
        """What the beat begins with: the unlocking, or the impulse where the tooth slides straight onto the face."""
        return f"beginning of the {'unlocking' if self.stages[0].name == 'unlock' else 'impulse'}"

    @property
    def end(self) -> float:
        return self.stages[-1].phase.end

    @property
    def residual(self) -> float:
        taken = sum(value for one in self.friction for value in one.values())
        return sum(stage.energy.friction for stage in self.stages) - taken


def shown_beats(run: Trajectory, window: Sequence[float] | None = None, rubbed: bool = True) -> list[Beat]:
    """The beats that begin within a window (s), by default those of the last oscillation that was recorded whole.

    Without `rubbed` what friction took is not worked out by pair, which takes most of the time. ValueError in words where there
    are none.
    """
    parts = with_anchor(run.scene)
    name = parts.oscillator
    if name is None:
        raise ValueError("nothing in this scene swings, so it has no beats")
    if parts.wheel is None:
        raise ValueError(f"phases are those of an escapement, and no driven wheel keeps {name} swinging")
    if parts.lever is None:
        if parts.wheel in partners(run.scene, name):
            raise ValueError(
                f"whether {name}, which touches {parts.wheel} itself, is its anchor is not known: say so by "
                "timegrapher.lift_angle, the angle from where one pallet lets go of a tooth to where the other does"
            )
        raise ValueError(f"phases exist where there is a lever or an anchor; none stands between {parts.wheel} and {name}")
    if not knows_energies(run):
        raise ValueError("a timeline needs an event-driven run with all its events kept")
    found = beats(run)
    if window is None:
        last = float(found.end[-1]) if len(found) else run.simulated
        window = (last - 3.1 * nominal_period(run, name), last)
        stages = timeline(run, found, window)
        chosen = sorted({one.beat for one in stages})
        whole = [beat for beat in chosen if any(one.beat == beat and one.name in RESTING for one in stages)][-2:]
        stages = [one for one in stages if one.beat in whole]
    else:
        stages = timeline(run, found, window)
    if not stages:
        raise ValueError("no beat of an escapement was recorded whole there")
    beats_shown = ([one for one in stages if one.beat == beat] for beat in sorted({one.beat for one in stages}))
    return [_beat(run, own) if rubbed else Beat(tuple(own), (), _pallet(run, own)) for own in beats_shown]


def _pallet(run: Trajectory, stages: list[Stage]) -> str:
    return pallet_name(run.scene, stages[0].pallet) if stages[0].pallet else ""


def _beat(run: Trajectory, stages: list[Stage]) -> Beat:
    ends = [one.phase.start for one in stages] + [stages[-1].phase.end]
    return Beat(tuple(stages), tuple(friction_by_pair(run, ends)), _pallet(run, stages))


NANO, KILO = 1e9, 1e-3  # bodies that reach 1000 °/s have their velocity in thousands
WIDTH = 20


def title(stage: Stage) -> str:
    """What a phase is called, with what is pushed: as in phases.csv and on the page."""
    return f"{stage.name} on {stage.phase.on}" if stage.phase.on else stage.name


def timeline_text(run: Trajectory, beats_shown: list[Beat] | None = None) -> str:
    """Both tables of some beats (see `shown_beats`), by default of the last oscillation; ValueError as there."""
    beats_shown = beats_shown or shown_beats(run)
    return "\n".join([*_motion(run, beats_shown), "", *_energy(beats_shown)])


def _motion(run: Trajectory, beats_shown: list[Beat]) -> Iterator[str]:
    parts = with_anchor(run.scene)
    bodies = (parts.wheel, parts.lever, parts.oscillator)
    shown = [k for k, name in enumerate(bodies) if name not in bodies[:k]]  # an anchor is its own oscillator
    names = [str(bodies[k])[:13] for k in shown]
    yield f"Timeline, t = {beats_shown[0].start:.6f} s to {beats_shown[-1].end:.6f} s"
    start = beats_shown[0].first
    stages = [stage for beat in beats_shown for stage in beat.stages]
    fastest = [max(abs(rate) for one in stages for rate in (one.start_rates[k], one.end_rates[k])) for k in shown]
    fast = [math.degrees(rate) >= 1.0 / KILO for rate in fastest]
    yield f"angles and angular velocities at the start of each phase; times in ms from the {start}"
    yield f"{'':{WIDTH}}{'start':>9}{'length':>9} " + "".join(f" {name:>19}" for name in names)
    yield f"{'':{WIDTH}}{'ms':>9}{'ms':>9} " + "".join(f" {'°':>10} {'1000°/s' if one else '°/s':>8}" for one in fast)
    for beat in beats_shown:
        yield _heading(beat)
        for stage in beat.stages:
            phase = stage.phase
            times = f"{1e3 * (phase.start - beat.start):9.3f}{1e3 * (phase.end - phase.start):9.3f} "
            yield f"  {title(stage):{WIDTH - 2}}{times}" + _places(phase.angles, stage.start_rates, shown, fast)
        last = beat.stages[-1]
        places = _places(last.end_angles, last.end_rates, shown, fast)
        yield f"  {'end':{WIDTH - 2}}{1e3 * (beat.end - beat.start):9.3f}{'':9} {places}"


def _places(angles: Triple, rates: Triple, shown: list[int], fast: list[bool]) -> str:
    return "".join(
        f" {math.degrees(angles[k]):10.3f} {round(math.degrees(rates[k]) * (KILO if one else 1.0), 3) + 0.0:8.3f}"
        for k, one in zip(shown, fast, strict=True)
    )


def _heading(beat: Beat) -> str:
    of = f", {beat.pallet}" if beat.pallet else ""
    return f"beat {beat.stages[0].beat}{of}, t = {beat.start:.6f} s"


def _energy(beats_shown: list[Beat]) -> Iterator[str]:
    rubbed = sorted({pair for beat in beats_shown for one in beat.friction for pair in one})
    struck = sorted({pair for beat in beats_shown for stage in beat.stages for pair in stage.energy.impacts})
    columns = ["supplied", "to balance", "stored", "damping"]
    columns += [*(f"f {pair}" for pair in rubbed), *(f"i {pair}" for pair in struck)]
    wide = [max(11, len(name) + 2) for name in columns]
    yield "energy in nJ; f: friction, i: impacts; to balance: work of all contacts on the oscillator; impulse on it in nN·m·s"
    yield f"{'':{WIDTH}}{'impulse':>9}" + "".join(f"{name:>{w}}" for name, w in zip(columns, wide, strict=True))
    for beat in beats_shown:
        yield _heading(beat)
        lines = [_values(stage, one, rubbed, struck) for stage, one in zip(beat.stages, beat.friction, strict=True)]
        sums = [sum(column) for column in zip(*lines, strict=True)]
        names = (*map(title, beat.stages), "together")
        impulses = [stage.impulse for stage in beat.stages]
        for name, impulse, values in zip(names, (*impulses, sum(impulses)), (*lines, sums), strict=True):
            cells = "".join(f"{_nano(value):>{w}}" for value, w in zip(values, wide, strict=True))
            yield f"  {name:{WIDTH - 2}}{NANO * impulse:9.3f}{cells}"
        if sums[0] > 0.0:
            yield f"  {'of what is supplied':{WIDTH - 2}}{'':8}" + "".join(
                f"{100.0 * value / sums[0]:>{w - 2}.2f} %" for value, w in zip(sums, wide, strict=True)
            )
            yield f"  the account closes to {abs(beat.residual):.1e} J, {abs(beat.residual) / sums[0]:.1e} of what is supplied"


def _values(stage: Stage, friction: dict[str, float], rubbed: list[str], struck: list[str]) -> list[float]:
    e = stage.energy
    pairs = [*(friction.get(pair, 0.0) for pair in rubbed), *(e.impacts.get(pair, 0.0) for pair in struck)]
    return [e.supplied, e.to_balance, e.stored, e.damping, *pairs]


def _nano(value: float) -> str:
    """In nJ; a dash where it is nothing."""
    return "-" if value == 0.0 else f"{NANO * value + 0.0:.4f}"
