"""Which parts of a run make a watch, and where do they stand at any time?"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.body_contacts import Events, between, contact_events, contact_numbers
from watchsim.analysis.timing.escape_wheel import progress
from watchsim.analysis.timing.rows_at_hand import is_recorded
from watchsim.analysis.timing.teeth import pitch
from watchsim.analysis.verdicts.tooth_lean import Teeth, teeth
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.gear_trains import goes_with
from watchsim.scene.oscillation import oscillators
from watchsim.scene.recording import STATISTICS
from watchsim.scene.roles import drive_direction, keeps_time, partners, roles
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.record.trajectory import Array, Trajectory

SMALLEST_ADVANCE = 0.01  # rad, for a wheel whose pitch is not known


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
        """Whether the contacts of the run are those of its scene's outlines, so that their arms can be told."""
        return len(self.run.pairs) == len(self.compiled.model.contacts)

    @property
    def has_banking(self) -> bool:
        """Whether the lever may touch something fixed."""
        return self.lever is not None and bool(partners(self.run.scene, self.lever) & self.fixed)

    @property
    def has_modes(self) -> bool:
        """Whether the events say at any time which contacts are in force."""
        return self.run.method == EVENT_DRIVEN and self.run.keep != STATISTICS

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
        total, ratios = 0.0, goes_with(self.run.scene, self.wheel)
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
    """None where no driven wheel keeps an oscillator going."""
    parts = roles(run.scene)
    if parts.oscillator is None or parts.wheel is None or not keeps_time(run.scene) or not found.angular:
        return None
    if found.body != parts.oscillator:
        return None
    return Watch(run, found, parts.oscillator, parts.wheel, parts.lever)
