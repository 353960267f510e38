"""Does a file of some milliseconds, made in small blocks, hold the sum of all blows?"""

from __future__ import annotations

import math
import wave
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.sound import wav
from watchsim.analysis.sound.score import Loop, Score
from watchsim.analysis.sound.wav import sound, write_score

RATE = 48000
TONES = [(3400.0, 0.0009, 0.45), (6100.0, 0.0006, 0.35), (11300.0, 0.0003, 0.2)]  # Hz, decay s, share
TIMES = [0.3 / RATE, 31.4 / RATE, 59.5 / RATE, 60.0 / RATE, 60.5 / RATE, 119.9 / RATE, 150.2 / RATE]
ENERGIES = [4.0, 0.5, 2.25, 1.0, 0.7, 3.0, 9.0]
START, END = 40.3 / RATE, 130.6 / RATE  # of the loop


def blows(looped: bool, samples: int) -> list[tuple[float, float]]:
    once = list(zip(TIMES, ENERGIES, strict=True))
    if not looped:
        return once
    inside, length = [one for one in once if START <= one[0] < END], END - START
    out = [one for one in once if one[0] < END]
    for k in range(1, 2 + math.ceil(samples / RATE / length)):
        out += [(t + k * length, energy) for t, energy in inside]
    return out


def heard(path: Path) -> list[int]:
    with wave.open(str(path)) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, RATE)
        return np.frombuffer(file.readframes(file.getnframes()), "<i2").tolist()


def wanted(looped: bool, samples: int) -> list[float]:
    """Every blow on all samples from it on, at nine tenths of the scale where it is loudest."""
    out = np.zeros(samples)
    for n in range(samples):
        for at, energy in blows(looped, samples):
            age = n / RATE - at
            if age >= -1e-15:
                tones = (share * math.exp(-age / decay) * math.cos(math.tau * hertz * age) for hertz, decay, share in TONES)
                out[n] += math.sqrt(energy) * sum(tones)
    return (0.9 * 32767.0 * out / np.abs(out).max()).tolist()


@pytest.mark.parametrize("samples", [170, 181, 420])
@pytest.mark.parametrize("looped", [False, True])
def test_blocks_hold_the_sum_of_blows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, looped: bool, samples: int) -> None:
    """Once only, the last blow is the loudest; it lies behind the loop, and is not heard where that is repeated."""
    monkeypatch.setattr(wav, "BLOCK", 60)
    told: list[tuple[float, float]] = []
    score = Score(np.array(TIMES), np.array(ENERGIES), 0.01, Loop(START, END, 3) if looped else None)
    length = samples / RATE
    write_score(tmp_path / "a.wav", score, length, lambda done, whole: told.append((done, whole)))
    assert heard(tmp_path / "a.wav") == pytest.approx(wanted(looped, samples), abs=0.51)
    ends = [*range(60, samples, 60), samples]
    assert told == [(pytest.approx(end / RATE), length) for end in ends]


@pytest.mark.parametrize(("duration", "samples"), [(None, 170), (200.0 / RATE, 200)])
def test_a_sound_is_as_long_as_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, duration: float | None, samples: int
) -> None:
    """By default as the run."""
    asked = []

    def score(run: Any, duration: float | None) -> Score:
        asked.append((run, duration))
        return Score(np.array(TIMES), np.array(ENERGIES), 170.0 / RATE, None)

    monkeypatch.setattr(wav, "score", score)
    run: Any = "the run"
    assert sound(run, str(tmp_path / "b.wav"), duration) == tmp_path / "b.wav"
    assert len(heard(tmp_path / "b.wav")) == samples and asked == [("the run", duration)]


def test_without_blows_nothing_sounds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wav, "score", lambda run, duration: Score(np.zeros(0), np.zeros(0), 1.0, None))
    run: Any = None
    with pytest.raises(ValueError, match="no impacts"):
        sound(run, tmp_path / "c.wav")
    assert not (tmp_path / "c.wav").exists()
