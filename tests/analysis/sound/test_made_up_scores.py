"""Is a score played as it is written, and what is repeated of a run that is too short?"""

from __future__ import annotations

import math
import wave
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.sound import score as module
from watchsim.analysis.sound.bursts import SAMPLES, TONES
from watchsim.analysis.sound.score import Loop, Score, score
from watchsim.analysis.sound.wav import LONGEST, check_length, told, wav_path, write_score
from watchsim.scene.recording import STATISTICS

TIMES = np.array([0.0, 0.11, 0.2, 0.3, 0.34, 0.5, 0.57, 0.6]) + 7e-6  # between two samples
LOUD = np.arange(1.0, 9.0)
ONCE, LOOPED = Score(TIMES, LOUD, 0.65, None), Score(TIMES, LOUD, 0.65, Loop(0.15, 0.45, 2))


def played(heard: Score, until: float) -> list[tuple[float, float]]:
    """All blows of the first seconds, written out: where the loop ends it begins again."""
    blows = list(zip(heard.times.tolist(), heard.energies.tolist(), strict=True))
    if heard.loop is None:
        return [one for one in blows if one[0] < heard.known]
    start, end = heard.loop.start, heard.loop.end
    out = [one for one in blows if one[0] < end]
    repeated, k = [one for one in out if one[0] >= start], 1
    while end + (k - 1) * (end - start) < until:
        out += [(t + k * (end - start), loud) for t, loud in repeated]
        k += 1
    return out


@pytest.mark.parametrize("heard", [ONCE, LOOPED], ids=["once", "looped"])
@pytest.mark.parametrize(
    ("start", "end"),
    [(0.0, 0.4), (0.1, 0.2), (0.15, 0.55), (0.45, 0.75), (0.55, 0.62), (0.61, 0.63), (0.0, 2.0), (0.95, 1.05), (1.93, 3.3)],
)
def test_between_two_times(heard: Score, start: float, end: float) -> None:
    """The first time counts, the last one does not."""
    times, energies = heard.between(start, end)
    wanted = [one for one in played(heard, end) if start - 1e-12 <= one[0] < end - 1e-12]
    assert times == pytest.approx([t for t, _ in wanted], abs=1e-12) and energies.tolist() == [loud for _, loud in wanted]


def test_piece_by_piece_every_blow_is_heard_once() -> None:
    cuts = np.arange(0.0, 4.0, 0.0371)
    pieces = [LOOPED.between(low, high)[0] for low, high in pairwise(cuts)]
    assert np.concatenate(pieces) == pytest.approx(LOOPED.between(0.0, cuts[-1])[0], abs=1e-12)


def ringing(blows: list[tuple[float, float]], length: float) -> np.ndarray:
    """Every blow summed over all samples after it."""
    t = np.arange(round(length * SAMPLES)) / SAMPLES
    out = np.zeros(len(t))
    for at, energy in blows:
        first = np.searchsorted(t, at)
        since = t[first : first + 2000] - at
        for hertz, decay, share in TONES:
            out[first : first + 2000] += share * math.sqrt(energy) * np.exp(-since / decay) * np.cos(math.tau * hertz * since)
    return out


EDGES = [0.3, 1.0 - 0.5 / SAMPLES, 1.0, 1.0 + 0.5 / SAMPLES, 1.5, 2.0 - 1.0 / SAMPLES, 2.0 - 1e-9, 2.0 + 1.0 / SAMPLES]
DOWN = [0.01 / SAMPLES, 1.01 / SAMPLES]  # a blow and another one a sample later: what is loudest is downwards


def samples(path: Path) -> np.ndarray:
    with wave.open(str(path)) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, SAMPLES)
        return np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)


@pytest.mark.parametrize(("times", "length"), [(EDGES, 2.25), (DOWN, 0.7), (TIMES.tolist(), 0.65), (EDGES, 2.0)])
def test_the_file_holds_the_sum_of_all_blows(tmp_path: Path, times: list[float], length: float) -> None:
    """Also of those at the border of two seconds; its loudest moment, up or down, is at nine tenths of the scale."""
    energies = np.linspace(1.0, 0.5, len(times))
    write_score(tmp_path / "a.wav", Score(np.array(times), energies, 3.0, None), length)
    got, wanted = samples(tmp_path / "a.wav"), ringing(list(zip(times, energies.tolist(), strict=True)), length)
    assert np.abs(got).max() == round(0.9 * 32767.0)
    assert np.abs(got - wanted * 0.9 * 32767.0 / np.abs(wanted).max()).max() < 0.51


def test_a_second_blow_may_be_loudest_downwards() -> None:
    wanted = ringing([(t, 1.0) for t in DOWN], 0.7)
    assert -wanted.min() > 1.005 * wanted.max()


@pytest.mark.parametrize("loudest", [3, 6])
def test_what_is_repeated_may_be_loudest(tmp_path: Path, loudest: int) -> None:
    """Within the loop, or after it, where it is never heard: the scale is that of what is played."""
    energies = np.ones(len(TIMES))
    energies[loudest] = 9.0
    heard = Score(TIMES, energies, 0.65, Loop(0.15, 0.45, 2))
    seen: list[tuple[float, float]] = []
    write_score(tmp_path / "a.wav", heard, 3.1, lambda done, whole: seen.append((done, whole)))
    got, wanted = samples(tmp_path / "a.wav"), ringing(played(heard, 3.1), 3.1)
    assert np.abs(got - wanted * 0.9 * 32767.0 / np.abs(wanted).max()).max() < 0.51
    assert seen == [(1.0, 3.1), (2.0, 3.1), (3.0, 3.1), (pytest.approx(3.1), 3.1)]


@pytest.mark.parametrize(
    ("length", "fits"), [(1.01 / SAMPLES, True), (1.0 / SAMPLES, False), (LONGEST, True), (43201.0, False)]
)
def test_how_long_a_sound_may_be(length: float, fits: bool) -> None:
    assert LONGEST == 12 * 60 * 60
    if fits:
        check_length(length)
    else:
        with pytest.raises(ValueError, match="a sound lasts up to 12 hours"):
            check_length(length)


@pytest.mark.parametrize("length", [0.0, -1.0, math.nan, math.inf])
def test_no_such_length(length: float) -> None:
    with pytest.raises(ValueError, match="a sound lasts up to 12 hours"):
        check_length(length)


def test_words_and_endings() -> None:
    assert told(ONCE) is None
    assert told(LOOPED) == "the run holds 0.65 s; from there on its last 2 oscillations are repeated"
    assert (
        told(Score(TIMES, LOUD, 1.5, Loop(0.0, 1.0, 1)))
        == "the run holds 1.5 s; from there on its last oscillation is repeated"
    )
    assert wav_path("a.WAV") == Path("a.WAV")
    with pytest.raises(ValueError, match=r"ends in \.wav"):
        wav_path("a.mp3")


PERIOD = 0.4
Case = dict[str, Any]


def made(monkeypatch: pytest.MonkeyPatch, ticks: list[float], **changed: Any) -> Any:
    """A run of 4 s with blows every tenth of a second, every fifth of them without energy, and beats at these times."""
    case: Case = {
        "pitch": None,
        "wheel": "wheel",
        "keep": "",
        "spans": (),
        "simulated": 4.0,
        "swings": True,
        "keeps_time": True,
    }
    case |= changed
    times = np.arange(40) * 0.1
    energies = np.where(np.arange(40) % 5 == 0, 0.0, 1e-12)  # J
    found = type("Found", (SimpleNamespace,), {"__len__": lambda self: len(self.tick)})
    beats: Any = found(tick=np.array(ticks), nominal_period=PERIOD)
    monkeypatch.setattr(module, "noises", lambda run: (times, energies))
    monkeypatch.setattr(module, "beats", lambda run: beats)
    monkeypatch.setattr(module, "swings", lambda scene: case["swings"])
    monkeypatch.setattr(module, "keeps_time", lambda scene: case["keeps_time"])
    monkeypatch.setattr(module, "roles", lambda scene: SimpleNamespace(wheel=case["wheel"]))
    monkeypatch.setattr(module, "pitch", lambda scene, wheel: case["pitch"])
    return SimpleNamespace(scene=None, keep=case["keep"], spans=case["spans"], simulated=case["simulated"])


BEATS = [0.1 + 0.2 * k for k in range(20)]  # the last at 3.9 s


def test_only_what_is_longer_than_the_run_is_repeated(monkeypatch: pytest.MonkeyPatch) -> None:
    run = made(monkeypatch, BEATS)
    assert score(run).loop is None and score(run, 4.0).loop is None and score(run, 4.01).loop is not None
    assert score(run).times == pytest.approx([0.1 * k for k in range(40) if k % 5]) and score(run).known == 4.0


def test_of_statistics_only_the_last_stretch_is_heard(monkeypatch: pytest.MonkeyPatch) -> None:
    spans = ((0.0, 1.0), (1.5, 2.25), (3.0, 4.0))
    heard = score(made(monkeypatch, BEATS, keep=STATISTICS, spans=spans))
    assert heard.times == pytest.approx([0.1 * k for k in (1, 2, 3, 4, 6, 7, 8, 9)], abs=1e-9) and heard.known == 1.0
    loop = score(made(monkeypatch, BEATS[-4:], keep=STATISTICS, spans=spans), 60.0).loop
    assert loop == Loop(pytest.approx(0.496, abs=1e-12), pytest.approx(0.896, abs=1e-12), 1)
    with pytest.raises(ValueError, match="the run holds 1 s of sound, too few beats"):
        score(made(monkeypatch, BEATS[-2:], keep=STATISTICS, spans=spans), 60.0)
    assert score(made(monkeypatch, BEATS, spans=spans)).known == 4.0
    assert score(made(monkeypatch, BEATS, keep=STATISTICS)).known == 4.0


@pytest.mark.parametrize(("teeth", "count"), [(None, 9), (1, 9), (2, 8), (4, 8), (5, 5), (9, 9), (10, 9), (15, 9)])
def test_whole_turns_of_the_wheel_are_repeated(monkeypatch: pytest.MonkeyPatch, teeth: int | None, count: int) -> None:
    """From a fiftieth of half a period before a beat to the same before the last; fewer where the run holds no whole turn."""
    run = made(monkeypatch, BEATS, pitch=None if teeth is None else math.tau / teeth)
    loop = score(run, 60.0).loop
    assert loop is not None and loop.oscillations == count
    assert loop.end == pytest.approx(3.9 - 0.004, abs=1e-12)
    assert loop.end - loop.start == pytest.approx(count * 0.4, abs=1e-12)
    assert score(made(monkeypatch, BEATS, pitch=math.tau / 2, wheel=None), 60.0).loop.oscillations == 9  # type: ignore[union-attr]


def test_beats_before_a_silent_one_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the direction that is repeated: what the other one lacks does not matter."""
    for silent, count in ((9, 4), (8, 9), (1, 8)):
        ticks = [math.nan if k == silent else t for k, t in enumerate(BEATS)]
        loop = score(made(monkeypatch, ticks), 60.0).loop
        assert loop is not None and loop.oscillations == count


@pytest.mark.parametrize("silent", [17, 18, 19])
def test_with_one_of_the_last_three_beats_silent_it_cannot_go_on(monkeypatch: pytest.MonkeyPatch, silent: int) -> None:
    ticks = [math.nan if k == silent else t for k, t in enumerate(BEATS)]
    with pytest.raises(ValueError, match="at its end it is silent"):
        score(made(monkeypatch, ticks), 60.0)


@pytest.mark.parametrize(("simulated", "silent"), [(4.49, False), (4.51, True)])
def test_a_period_and_a_half_without_a_tick_is_silence(monkeypatch: pytest.MonkeyPatch, simulated: float, silent: bool) -> None:
    run = made(monkeypatch, BEATS, simulated=simulated)
    if silent:
        with pytest.raises(ValueError, match=r"the run holds 4\.51 s of sound; at its end it is silent"):
            score(run, 60.0)
    else:
        assert score(run, 60.0).loop is not None


@pytest.mark.parametrize("changed", [{"swings": False}, {"keeps_time": False}])
def test_what_does_not_beat_cannot_go_on(monkeypatch: pytest.MonkeyPatch, changed: Case) -> None:
    with pytest.raises(ValueError, match=r"the run holds 4 s of sound; nothing in it beats"):
        score(made(monkeypatch, BEATS, **changed), 60.0)


def test_three_beats_are_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    loop = score(made(monkeypatch, BEATS[-3:]), 60.0).loop
    assert loop is not None and loop.oscillations == 1
    with pytest.raises(ValueError, match="too few beats"):
        score(made(monkeypatch, BEATS[-2:]), 60.0)
