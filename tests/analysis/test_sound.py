"""Does the WAV file sound as the watch ticks?"""

import math
import wave
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from analysis.made_beats import (
    IMPULSE,
    LOCKING,
    PIN,
    balance_only,
    chipped,
    eccentric,
    knocked,
    steady_swings,
    swiss,
    unguarded,
)
from numpy.typing import NDArray
from scipy.io import wavfile

from watchsim.analysis.sound import SAMPLES, TONES, Ringing, score, sound
from watchsim.analysis.timegrapher import tape, timegrapher
from watchsim.analysis.timing import beats
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

# What does somebody hear who has nothing but the WAV file?

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


# Does the WAV file sound as the watch ticks?

PERIOD, LIFT = 0.25, 51.2


@cache
def ticking(duration: float) -> Trajectory:
    return simulate(swiss(), duration)


def heard(scene: Scene, duration: float, path):
    run = simulate(scene, duration)
    return run, listen(sound(run, path / "tick.wav"))


def by_hand(times, loudness, count):
    """Every blow summed over all samples after it, straight from the formula."""
    t = np.arange(count) / SAMPLES
    out = np.zeros(count)
    for at, loud in zip(times, loudness, strict=True):
        since = t - at
        for hertz, decay, share in TONES:
            out += np.where(
                since >= 0.0, loud * share * np.exp(-np.maximum(since, 0.0) / decay) * np.cos(2 * np.pi * hertz * since), 0.0
            )
    return out


@pytest.mark.parametrize("blocks", [(2000,), (1, 999, 1000), (700, 700, 600)])
def test_blows_ring_as_the_formula_says_however_it_is_cut(blocks):
    rng = np.random.default_rng(1)
    times, loudness = np.sort(rng.uniform(0.0, 1990 / SAMPLES, 40)), rng.uniform(0.1, 1.0, 40)
    times[5] = 700 / SAMPLES  # on a sample, where two blocks meet
    ringing, made = Ringing(), []
    for count in blocks:
        place = np.ceil(times * SAMPLES)
        own = (place >= ringing.sampled) & (place < ringing.sampled + count)
        made.append(ringing.block(count, times[own], loudness[own]))
    assert np.concatenate(made) == pytest.approx(by_hand(times, loudness, 2000), abs=1e-10)


def test_a_blow_begins_as_loud_as_it_is():
    """The shares of its tones sum to one."""
    assert Ringing().block(10, np.zeros(1), np.array([0.7]))[0] == pytest.approx(0.7, rel=1e-12)


def test_a_blow_outside_its_block_is_refused():
    with pytest.raises(ValueError, match="outside"):
        Ringing().block(10, np.array([1.0]), np.ones(1))


def test_the_file_is_what_any_program_reads(tmp_path):
    path = sound(ticking(3.0), tmp_path / "tick.wav")
    with wave.open(str(path)) as file:
        assert (file.getframerate(), file.getnchannels(), file.getsampwidth()) == (48000, 1, 2)
        assert file.getnframes() == 3 * 48000
        samples = np.frombuffer(file.readframes(file.getnframes()), "<i2")
    assert np.abs(samples.astype(int)).max() == pytest.approx(0.9 * 32767, abs=1)


def test_a_minute_is_heard_as_the_timegrapher_reads_it(tmp_path):
    run = ticking(60.0)
    found = listen(sound(run, tmp_path / "tick.wav"))
    own = beats(run)
    read = timegrapher(run, own, (0.0, 60.0))
    # The first and the last beat are no whole half swings, but can be heard.
    assert len(found.onsets) == len(own) + 2
    assert np.abs(found.onsets[1:-1] - own.tick).max() <= 1.0 / SAMPLES
    assert found.rate(PERIOD) == pytest.approx(read["rate_s_per_d"], abs=0.1)
    assert found.beat_error_ms() == pytest.approx(read["beat_error_ms"], abs=0.02)
    assert found.amplitude_deg(LIFT, 1.0 / PERIOD) == pytest.approx(read["amplitude_deg"], abs=2.0)


def test_out_of_beat_is_heard_as_beat_error(tmp_path):
    """The hairspring's rest 1.5° off: (T1 - T2)/2 = 2 asin(β/A)/ω."""
    run, found = heard(swiss(springs_0_rest="1.5°"), 20.0, tmp_path)
    own = beats(run)
    expected = 1e3 * 2.0 * math.asin(1.5 / own.amplitude_deg.mean()) / (math.tau / PERIOD)
    assert found.beat_error_ms() == pytest.approx(expected, abs=0.02)
    assert timegrapher(run, own, (0.0, 20.0))["beat_error_ms"] == pytest.approx(expected, abs=0.01)


@pytest.mark.slow
def test_a_chipped_tooth_is_heard_every_fifteenth_oscillation(tmp_path):
    """Worn back, the tooth locks late: once by the entry pallet and once by the exit pallet, five half swings later."""
    _, found = heard(chipped(swiss(), 7, 0.0, back=0.15), 20.0, tmp_path)
    turns = found.lasting[: 30 * (len(found.lasting) // 30)].reshape(-1, 30, 1)[1:].reshape(-1, 15, 2)
    pattern = np.median(turns - np.median(turns, axis=1, keepdims=True), axis=0).ravel()
    late = np.argsort(pattern)[::-1]
    assert abs(late[0] - late[1]) == 5
    assert pattern[late[1]] > 0.8e-4 and np.abs(pattern[late[2:]]).max() < 3e-5


@pytest.mark.slow
def test_an_eccentric_wheel_is_heard_as_a_sine_of_fifteen_oscillations(tmp_path):
    scene = swiss(bodies_wheel_angle="-0.1°")
    run, found = heard(eccentric(scene, 5e-6), 30.0, tmp_path)
    _, true = heard(scene, 30.0, tmp_path)
    shares = [share_of_period(one.lasting[31:241:2], 15) for one in (found, true)]
    assert shares[0] > 0.8 and shares[1] < 0.2
    # The rate on the paper swings with it, by a whole second a day.
    rate = tape(run).rate_s_per_d[-150::2]
    assert share_of_period(rate, 15) > 0.8 and np.ptp(rate) == pytest.approx(1.1, abs=0.3)


def test_what_is_longer_than_the_run_goes_on_without_a_jump(tmp_path):
    run = ticking(20.0)
    heard_of = score(run, 65.0)
    found = listen(sound(run, tmp_path / "tick.wav", 65.0))
    assert heard_of.loop.oscillations == 75  # five turns of the wheel
    halves = np.diff(found.onsets)
    assert len(found.onsets) == pytest.approx(65.0 * 8.0, abs=1)
    assert np.ptp(halves) < 3.0 / SAMPLES
    assert found.onsets[-1] > 64.8


@pytest.mark.parametrize("record", ["statistics", "events", [(1.0, 1.5)]])
def test_whatever_was_kept_of_the_run_is_heard(record, tmp_path):
    run = simulate(swiss(), 6.0, record=record)
    for duration, count in ((None, 24 if record == "statistics" else 48), (20.0, 160)):
        found = listen(sound(run, tmp_path / "tick.wav", duration))
        assert len(found.onsets) == count and np.ptp(np.diff(found.onsets)) < 3.0 / SAMPLES


def test_the_loop_repeats_to_rounding():
    run = ticking(20.0)
    heard_of = score(run, 1e4)
    loop = heard_of.loop
    length = loop.end - loop.start
    times, energies = heard_of.between(loop.start + 1e-9, loop.end)
    for k in (1, 2, 700):
        later, same = heard_of.between(loop.start + k * length + 1e-9, loop.end + k * length)
        assert later - k * length == pytest.approx(times, abs=1e-9) and np.array_equal(same, energies)
    cut, _ = heard_of.between(0.0, 5000.0)
    parts = np.concatenate([heard_of.between(float(k), k + 1.0)[0] for k in range(5000)])
    assert len(cut) == len(parts) and np.array_equal(cut, parts) and (np.diff(cut) > 0.0).all()


def test_what_cannot_sound_is_refused(tmp_path):
    silent = simulate(load(profiles_dir() / "balance"), 1.0)
    with pytest.raises(ValueError, match="nothing sounds"):
        sound(silent, tmp_path / "a.wav")
    with pytest.raises(ValueError, match="cannot go on"):
        sound(silent, tmp_path / "a.wav", 60.0)
    with pytest.raises(ValueError, match="at its end it is silent"):  # it stands since two seconds
        sound(simulate(knocked(unguarded(swiss()), 2.05, -2e-6), 4.0), tmp_path / "a.wav", 60.0)
    with pytest.raises(ValueError, match="too few beats"):
        sound(simulate(swiss(), 0.4), tmp_path / "a.wav", 60.0)
    with pytest.raises(ValueError, match="nothing in it beats"):
        sound(simulate(load(profiles_dir() / "incline"), 0.5), tmp_path / "a.wav", 60.0)
    with pytest.raises(ValueError, match=r"\.wav"):
        sound(ticking(3.0), tmp_path / "a.mp3")
    for wrong in (0.0, -1.0, math.nan, 1e6):
        with pytest.raises(ValueError, match="lasts up to 12 hours"):
            sound(ticking(3.0), tmp_path / "a.wav", wrong)
    assert not list(tmp_path.iterdir())


def test_a_sound_that_is_broken_off_leaves_nothing(tmp_path):
    (tmp_path / "tick.wav").write_bytes(b"old")

    def give_up(done, whole):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sound(ticking(3.0), tmp_path / "tick.wav", progress=give_up)
    assert [item.name for item in tmp_path.iterdir()] == ["tick.wav"] and (tmp_path / "tick.wav").read_bytes() == b"old"


def test_louder_blows_are_louder(tmp_path):
    """Four times the energy, twice the amplitude."""
    peaks = []
    for lost in (1e-9, 4e-9):
        events = steady_swings(8, 4.7)
        events.touch(0.30, EventKind.IMPACT, LOCKING, 1.6e-8)
        events.touch(0.50, EventKind.IMPACT, PIN, lost)
        events.touch(0.70, EventKind.IMPACT, IMPULSE, 0.0)
        with wave.open(str(sound(balance_only(events, 1.0), tmp_path / "one.wav"))) as file:
            samples = np.abs(np.frombuffer(file.readframes(48000), "<i2").astype(float))
        peaks.append(samples[24000:28800].max())
        assert samples[14400:14500].max() == pytest.approx(0.9 * 32767, abs=1) and samples[33600:].max() == 0.0
    assert peaks[1] / peaks[0] == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize("length", [0.4, 1.0, 1.37])
def test_the_file_is_as_long_as_asked_to_the_sample(length, tmp_path):
    with wave.open(str(sound(ticking(2.0), tmp_path / "tick.wav", duration=length))) as file:
        assert file.getnframes() == round(length * SAMPLES)


# Does a blow ring on three tones that die away, from its instant on, also across the borders of blocks?

RATE = 48000
TONES_RINGING = [(3400.0, 0.0009, 0.45), (6100.0, 0.0006, 0.35), (11300.0, 0.0003, 0.2)]  # Hz, decay s, share
BLOWS = [(3.0 / RATE, 2.0), (3.4 / RATE, 0.7), (17.9 / RATE, 1.3), (60.0 / RATE, 0.4), (60.0 / RATE, 0.9), (98.5 / RATE, 3.0)]


def summed(count: int) -> list[float]:
    """Every blow, over all samples that are not before it."""
    out = []
    for n in range(count):
        ages = [(n / RATE - at, loud) for at, loud in BLOWS if n / RATE >= at - 1e-15]
        tones = [
            (loud * share, age / decay, math.tau * hertz * age) for age, loud in ages for hertz, decay, share in TONES_RINGING
        ]
        out.append(sum(size * math.exp(-gone) * math.cos(turned) for size, gone, turned in tones))
    return out


@pytest.mark.parametrize("blocks", [(150,), (20, 130), (18, 1, 41, 90), (61, 38, 51)])
def test_blows_add_up_block_by_block(blocks: tuple[int, ...]) -> None:
    """Between two samples, too: the next one hears how far it has rung already."""
    ringing, parts, first = Ringing(), [], 0
    for count in blocks:
        own = [(at, loud) for at, loud in BLOWS if first <= math.ceil(at * RATE - 1e-9) < first + count]
        times, loudness = np.array(own).reshape(-1, 2).T
        parts.append(ringing.block(count, times, loudness))
        first += count
        assert ringing.sampled == first
    assert np.concatenate(parts) == pytest.approx(summed(150), abs=1e-12)


@pytest.mark.parametrize(("sample", "fits"), [(8.9, False), (9.1, True), (13.9, True), (14.1, False)])
def test_a_blow_lies_in_its_block(sample: float, fits: bool) -> None:
    """Of samples 10 to 14."""
    ringing = Ringing()
    ringing.block(10, np.zeros(0), np.zeros(0))
    times = np.array([12.0, sample]) / RATE
    if fits:
        assert len(ringing.block(5, times, np.ones(2))) == 5
    else:
        with pytest.raises(ValueError, match="outside the block"):
            ringing.block(5, times, np.ones(2))
