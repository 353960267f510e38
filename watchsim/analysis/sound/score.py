"""Which blows sound when, for as long as requested?

Those of the run; where the sound is to be longer, its last oscillations over and over. They are cut in the silence before a
beat, a whole number of oscillations apart, and a whole turn of the escape wheel where there is one, so that nothing jumps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.teeth import pitch
from watchsim.analysis.timing.timegrapher import noises
from watchsim.scene.recording import STATISTICS
from watchsim.scene.roles import keeps_time, roles, swings
from watchsim.simulation.record.trajectory import Array, Trajectory

BEFORE = 0.02  # of a half period before a beat's first noise: nothing sounds there
LEAST_TICKS = 3
SILENT = 1.5  # periods since the last tick: the watch stands


@dataclass(frozen=True)
class Loop:
    """The stretch from `start` to `end` (s of the run) is repeated: so many oscillations."""

    start: float
    end: float
    oscillations: int


@dataclass(frozen=True)
class Score:
    """`times` (s since the sound begins) and `energies` (J) of a run's blows, known until `known`; then `loop`."""

    times: Array
    energies: Array
    known: float
    loop: Loop | None

    def between(self, start: float, end: float) -> tuple[Array, Array]:
        """Times and energies of the blows from `start` up to `end`, s."""
        found = [self._part(start, min(end, self._turn), 0.0)]
        if self.loop is not None and end > self._turn:
            length = self.loop.end - self.loop.start
            first = max(0, math.floor((start - self.loop.end) / length))
            last = math.floor((end - self.loop.end) / length)
            for k in range(first, last + 1):
                shift = (k + 1) * length
                low, high = max(start, self.loop.end + k * length), min(end, self.loop.end + (k + 1) * length)
                found.append(self._part(low - shift, high - shift, shift))
        times, energies = zip(*found, strict=True)
        return np.concatenate(times), np.concatenate(energies)

    @property
    def _turn(self) -> float:
        return self.known if self.loop is None else self.loop.end

    def _part(self, start: float, end: float, shift: float) -> tuple[Array, Array]:
        first, last = np.searchsorted(self.times, (start, end), side="left")
        return self.times[first:last] + shift, self.energies[first:last]


def score(run: Trajectory, duration: float | None = None) -> Score:
    """The blows of a run; with a loop where `duration` (s) is longer than it. ValueError where then nothing beats."""
    times, energies = noises(run)
    begun = run.spans[-1][0] if run.keep == STATISTICS and run.spans else 0.0
    heard = (times >= begun) & (energies > 0.0)
    times, energies, known = times[heard] - begun, energies[heard], run.simulated - begun
    loop = None if duration is None or duration <= known else _loop(run, begun)
    return Score(times, energies, known, loop)


def _loop(run: Trajectory, begun: float) -> Loop:
    scene, holds = run.scene, f"the run holds {run.simulated - begun:.4g} s of sound"
    if not swings(scene) or not keeps_time(scene):
        raise ValueError(f"{holds}; nothing in it beats that could go on for longer")
    found = beats(run)
    if len(found) < LEAST_TICKS:
        raise ValueError(f"{holds}, too few beats to go on with")
    heard = np.isfinite(found.tick)
    ticks = found.tick - begun - BEFORE * 0.5 * found.nominal_period
    if not heard[-LEAST_TICKS:].all() or run.simulated - found.tick[-1] > SILENT * found.nominal_period:
        raise ValueError(f"{holds}; at its end it is silent, so it cannot go on for longer")
    # Ticks of one direction of swing, back from the last.
    same = np.arange(len(found) - 1, -1, -2)
    same = same[: np.argmin(heard[same]) if not heard[same].all() else len(same)][::-1]
    wheel = roles(scene).wheel
    whole = None if wheel is None else pitch(scene, wheel)
    turn = 1 if whole is None else round(math.tau / whole)
    steps = len(same) - 1
    count = turn * (steps // turn) if steps >= turn else steps
    return Loop(float(ticks[same[-1 - count]]), float(ticks[same[-1]]), count)
