"""How does the sound of a run become a WAV file?

48 kHz, 16 bits, one channel, made and written second by second. The loudest moment is nearly full scale.
"""

from __future__ import annotations

import math
import os
import wave
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from watchsim.analysis.sound.bursts import SAMPLES, Array, Ringing
from watchsim.analysis.sound.score import Score, score
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.write import write_file

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


def told(heard: Score) -> str | None:
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
