"""How does the sound of a run become a WAV file?

48 kHz, 16 bits, one channel, made and written second by second. The loudest moment is nearly full scale.
"""

from __future__ import annotations

import math
import os
import wave
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timegrapher import noises
from watchsim.analysis.timing import beats
from watchsim.scene.roles import keeps_time, pitch, roles, swings
from watchsim.scene.scene import STATISTICS
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.write import write_file

# A case rings on a few tones that die away. Which ones is no result of the simulation: these are typical of a small watch on
# a microphone. When a blow sounds and how loud is: it begins at its instant, between samples too, with an amplitude that
# grows with the root of the energy lost.
#
# A blow that goes from the wheel through the lever to the balance is many impacts within a microsecond, which no microphone
# tells apart: what follows within BLOW is one blow with the energy of all. Ringing one by one they would add up to two or three
# times that loudness, beside which instruments miss the first noise of a beat.
#
# A tone that dies away is one complex number per blow, turned and shrunk from sample to sample: y[n] = z y[n-1] + x[n]. Tails
# are therefore exact however long, and a sound can be made block by block.

SAMPLES = 48000  # per second
BLOW = 20e-6  # s: a quarter of a period of the highest tone; much longer, and noises that can be told apart are one
TONES = ((3400.0, 0.9e-3, 0.45), (6100.0, 0.6e-3, 0.35), (11300.0, 0.3e-3, 0.2))  # Hz, decay time s, share of the start


def blows(run: Trajectory, start: float = -math.inf, end: float = math.inf) -> tuple[Array, Array]:
    """Instants (s) at which a blow begins, and the energy (J) that all its impacts lose."""
    times, energies = noises(run, start, end)
    first: list[int] = []
    for k, t in enumerate(times.tolist()):
        if not first or t - times[first[-1]] > BLOW:
            first.append(k)
    return times[first], np.add.reduceat(energies, first) if first else energies


# Many instruments wait for a noise that is loud enough. Where the first one of a beat is soft, and the loud one follows later
# in tick than in tock, they show another beat error than the balance has (docs/guide/coaxial.md, "To the ear").

WAITED_FOR = 0.3  # of the loudest noise
APART = 0.2e-3  # s between both beat errors that are worth a word
FEWEST, LISTENED = 6, 10  # beats


def another_beat_error(run: Trajectory, window: Sequence[float]) -> str:
    """Why an instrument that waits for a loud noise shows another beat error than one that hears the first of each beat; ""
    where it does not, and where not every beat of the window (s), or of the last ten before its end, is heard."""
    if not keeps_time(run.scene):
        return ""
    found = beats(run)
    start, end = min(window[0], window[1] - 0.5 * LISTENED * found.nominal_period), window[1]  # noises are known for longer
    times, energies = blows(run, start, end)
    if not len(times) or not energies.max() > 0.0:
        return ""
    loud = np.sqrt(np.maximum(energies, 0.0) / energies.max())
    inside = (found.start >= start) & (found.end <= end)
    if inside.sum() < FEWEST or not np.isfinite(found.tick[inside]).all():
        return ""
    waited, soft = [], []
    for tick, over in zip(found.tick[inside].tolist(), found.end[inside].tolist(), strict=True):
        first, last = np.searchsorted(times, (tick - BLOW, over))
        enough = np.flatnonzero(loud[first:last] >= WAITED_FOR)
        if not len(enough):
            return ""
        waited.append(float(times[first + enough[0]]))
        soft.append(float(loud[first]))
    own, other = (_half_difference(np.array(marks)) for marks in (found.tick[inside], waited))
    if abs(own - other) < APART or np.mean(soft) >= WAITED_FOR:
        return ""
    late = sorted(1e3 * float(np.mean((np.array(waited) - found.tick[inside])[side::2])) for side in (0, 1))
    return (
        f"The first noise of a beat is soft, {np.mean(soft):.2f} of the loudest; the first above {WAITED_FOR:g} follows "
        f"{late[0]:.2f} ms later in one direction of swing, {late[1]:.2f} ms in the other. An instrument that waits for a "
        f"loud noise shows a beat error of {1e3 * other:.2f} ms, one that hears the first {1e3 * own:.2f} ms, as the balance "
        "has it; nor does a loud noise end the lift, so that it may find no amplitude."
    )


def _half_difference(marks: Array) -> float:
    """Half of what the two halves of an oscillation differ by, s."""
    halves = np.diff(marks)
    return 0.5 * abs(float(np.mean(halves[::2]) - np.mean(halves[1::2])))


@dataclass
class Ringing:
    """Goes on from block to block; `sampled` counts the samples made."""

    sampled: int = 0
    _state: list[NDArray[np.complex128]] = field(default_factory=lambda: [np.zeros(1, complex) for _ in TONES])

    def block(self, count: int, times: Array, loudness: Array) -> Array:
        """The next `count` samples: what still rings, and the blows at `times` (s) within them."""
        from scipy.signal import lfilter  # half a second to load, which a movie without sound need not wait for

        place = np.ceil(times * SAMPLES).astype(np.int64)
        late = place / SAMPLES - times
        own = place - self.sampled
        if len(own) and not (own.min() >= 0 and own.max() < count):
            raise ValueError("a blow lies outside the block of sound it was given with")
        out = np.zeros(count)
        for k, (hertz, decay, share) in enumerate(TONES):
            turning = complex(-1.0 / decay, 2.0 * np.pi * hertz)
            begun = share * loudness * np.exp(turning * late)
            blows = np.bincount(own, begun.real, count) + 1j * np.bincount(own, begun.imag, count)
            ringing, self._state[k] = lfilter([1.0], [1.0, -np.exp(turning / SAMPLES)], blows, zi=self._state[k])
            out += ringing.real
        self.sampled += count
        return out


# Those of the run; where the sound is to be longer, its last oscillations over and over. They are cut in the silence before a
# beat, a whole number of oscillations apart, and a whole turn of the escape wheel where there is one, so that nothing jumps.

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
        turn = self.known if self.loop is None else self.loop.end
        found = [self._part(start, min(end, turn), 0.0)]
        if self.loop is not None and end > turn:
            length = self.loop.end - self.loop.start
            first = max(0, math.floor((start - self.loop.end) / length))
            last = math.floor((end - self.loop.end) / length)
            for k in range(first, last + 1):
                shift = (k + 1) * length
                low, high = max(start, self.loop.end + k * length), min(end, self.loop.end + (k + 1) * length)
                found.append(self._part(low - shift, high - shift, shift))
        times, energies = zip(*found, strict=True)
        return np.concatenate(times), np.concatenate(energies)

    def _part(self, start: float, end: float, shift: float) -> tuple[Array, Array]:
        first, last = np.searchsorted(self.times, (start, end), side="left")
        return self.times[first:last] + shift, self.energies[first:last]


def score(run: Trajectory, duration: float | None = None) -> Score:
    """The blows of a run; with a loop where `duration` (s) is longer than it. ValueError where then nothing beats."""
    times, energies = blows(run)
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


BLOCK = SAMPLES
FULL = 0.9 * 32767.0
LONGEST = 12 * 3600.0  # s: the sizes in a WAV file are numbers of 32 bits
Progress = Callable[[float, float], None]


def sound(
    run: Trajectory, path: str | os.PathLike[str], duration: float | None = None, progress: Progress | None = None
) -> Path:
    """Write the ticking of a run as WAV, and return the path; written whole or not at all.

    duration  s, up to twelve hours; default as long as the run. What is longer repeats the last oscillations, see `score`
    progress  called with (seconds done, seconds in all)

    ValueError where nothing sounds, or where what is to go on for longer than the run does not beat.
    """
    target = wav_path(path)
    heard = score(run, duration)
    length = heard.known if duration is None else float(duration)
    check_length(length)
    if not len(heard.times):
        raise ValueError("nothing sounds: this run has no impacts, or kept none")
    write_file(target, lambda place: write_score(place, heard, length, progress), "the sound")
    return target


def wav_path(path: str | os.PathLike[str]) -> Path:
    """The path, if its ending says WAV."""
    target = Path(path)
    if target.suffix.lower() != ".wav":
        raise ValueError(f"{target}: a sound ends in .wav")
    return target


def check_length(length: float) -> None:
    """ValueError for a length (s) that no file can have."""
    if not (math.isfinite(length) and 1.0 / SAMPLES < length <= LONGEST):
        raise ValueError(f"a sound lasts up to {LONGEST / 3600.0:.0f} hours, not {length:.6g} s")


def repeated(heard: Score) -> str | None:
    """What is repeated, in words; None where nothing is."""
    if heard.loop is None:
        return None
    what = "oscillation is" if heard.loop.oscillations == 1 else f"{heard.loop.oscillations} oscillations are"
    return f"the run holds {heard.known:.4g} s; from there on its last {what} repeated"


def write_score(place: Path, heard: Score, length: float, progress: Progress | None = None) -> None:
    """Write `length` seconds of a score, in which something sounds, as WAV."""
    factor = FULL / _peak(heard, length)
    # Given a name that it cannot open, wave prints a traceback besides.
    with place.open("wb") as raw, wave.open(raw, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(SAMPLES)
        for block in _blocks(heard, length):
            file.writeframes(np.rint(factor * block).astype("<i2").tobytes())
            if progress is not None:
                progress(file.tell() / SAMPLES, length)


def _peak(heard: Score, length: float) -> float:
    """The largest sample; of what is repeated, once and what follows it are enough."""
    if heard.loop is not None:
        length = min(length, heard.loop.end + 2.0 * (heard.loop.end - heard.loop.start))
    return max(float(np.abs(block).max()) for block in _blocks(heard, length))


def _blocks(heard: Score, length: float) -> Iterator[Array]:
    ringing, whole = Ringing(), round(length * SAMPLES)
    while ringing.sampled < whole:
        first, count = ringing.sampled, min(BLOCK, whole - ringing.sampled)
        # A blow sounds from the next sample on, so those just after the last sample of a block belong to the next one.
        times, energies = heard.between((first - 1) / SAMPLES, (first + count) / SAMPLES)
        place = np.ceil(times * SAMPLES)
        own = (place >= first) & (place < first + count)
        yield ringing.block(count, times[own], np.sqrt(energies[own]))
