"""The simplest timing machine: a beat begins where the sound rises above a share of its loudest moment, after silence."""

import wave
from pathlib import Path

import numpy as np


def beat_error_ms(path: Path, share: float, beat: float) -> float:
    """Half the difference of the two halves of an oscillation; `beat` (s) is how long one lasts."""
    with wave.open(str(path)) as file:
        rate, raw = file.getframerate(), file.readframes(file.getnframes())
    sound = np.abs(np.frombuffer(raw, "<i2").astype(float))
    triggers: list[float] = []
    for k in np.flatnonzero(sound > share * sound.max()).tolist():
        if not triggers or k / rate - triggers[-1] > 0.5 * beat:
            triggers.append(k / rate)
    halves = np.diff(triggers[1:])
    both = halves[: len(halves) // 2 * 2].reshape(-1, 2)
    return 1e3 * abs(float(np.mean(both[:, 0] - both[:, 1]))) / 2.0
