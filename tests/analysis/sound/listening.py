"""What does somebody hear who has nothing but the WAV file?

A detector of onsets that shares no code with the package: the first sample after a silence that stands out. Numbers follow
from the times of onsets alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.io import wavfile

Array = NDArray[np.float64]
QUIET = 0.02  # s of silence before a beat
THRESHOLD = 0.01  # of full scale


@dataclass(frozen=True)
class Heard:
    """First onsets (s) of the beats, and from each to the loudest sample of its beat (s)."""

    onsets: Array
    lasting: Array

    def rate(self, nominal_period: float) -> float:
        """s/d, from the mean of all differences of onsets two apart."""
        return 86400.0 * (nominal_period / float(np.mean(self.onsets[2:] - self.onsets[:-2])) - 1.0)

    def beat_error_ms(self) -> float:
        """Half of what the halves differ by, with the sign of their order."""
        halves = np.diff(self.onsets)
        signs = (-1.0) ** np.arange(len(halves) - 1)
        return abs(500.0 * float(np.mean(signs * np.diff(halves))))

    def amplitude_deg(self, lift_deg: float, hertz: float) -> float:
        return lift_deg / (2.0 * math.sin(math.pi * hertz * float(np.mean(self.lasting))))


def listen(path: Path) -> Heard:
    rate, samples = wavfile.read(path)
    assert samples.dtype == np.int16 and samples.ndim == 1
    loud = np.flatnonzero(np.abs(samples.astype(float)) > THRESHOLD * 32768.0)
    first = loud[np.diff(loud, prepend=-rate) > QUIET * rate]
    first = first[first > 0.001 * rate]  # what sounds as the file begins has begun before
    window = int(0.02 * rate)
    peaks = [int(np.argmax(np.abs(samples[k : k + window].astype(float)))) for k in first]
    return Heard(first / rate, np.array(peaks) / rate)


def share_of_period(values: Array, beats: int) -> float:
    """How much of the variance of a series lies in the frequency of one turn in so many beats, from 0 to 1."""
    values = values[: len(values) - len(values) % beats]
    spectrum = np.abs(np.fft.rfft(values - values.mean())) ** 2
    return float(spectrum[len(values) // beats] / spectrum.sum())
