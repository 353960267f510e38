"""Does the detector hear what a clock does: against the run that made the sound, sounds made here, and a detector made here?"""

import json
import math
import re
import struct
import wave
from pathlib import Path

import numpy as np
import pytest
from naive.level_trigger import beat_error_ms
from render.fake_runs import watch_run

import watchsim as ws
from watchsim.analysis.listen import NothingHeard, Recording, heard_in
from watchsim.analysis.sound import another_beat_error
from watchsim.analysis.timegrapher import tape, timegrapher
from watchsim.analysis.timing import beats
from watchsim.cli import main
from watchsim.simulation.state import EVENT_DTYPE, EventKind
from watchsim.simulation.trajectory import Trajectory

FS = 48000


def ticking(vph, seconds=20.0, beat_error=0.0, interval=7e-3, rate=0.0, noise=0.0, jitter=0.0, seed=1, hum=0.0):
    """A clock with three noises a beat, of tones that die away, each at its own instant; hum and white noise. Rate and interval
    may be pairs, from what to what they go."""
    random = np.random.default_rng(seed)
    t = np.arange(round(seconds * FS)) / FS
    signal = hum * np.sin(2.0 * np.pi * 50.0 * t) + noise * random.standard_normal(len(t))
    count = int(seconds * vph / 3600.0)
    rates, intervals = (np.linspace(*(one if isinstance(one, tuple) else (one, one)), count) for one in (rate, interval))
    halves = 3600.0 / vph / (1.0 + rates / 86400.0)
    starts = 0.3 * halves[0] + np.cumsum(halves) - halves[0]
    for k, last in enumerate(intervals.tolist()):
        begin = starts[k] + (beat_error if k % 2 else 0.0) + jitter * random.standard_normal()
        for at, loud, hertz in ((0.0, 0.6, 4100.0), (0.45 * last, 0.3, 5200.0), (last, 1.0, 3600.0)):
            first = int(np.ceil((begin + at) * FS))
            tail = t[first : first + 400] - (begin + at)
            signal[first : first + 400] += loud * np.exp(-tail / 0.7e-3) * np.sin(2.0 * np.pi * hertz * tail)
    return Recording(FS, signal)


def naive(recording, vph):
    """Rate and beat error by first crossings of a tenth of the loudest, deaf for the rest of the beat; shares no code."""
    loud = np.flatnonzero(np.abs(recording.signal) > 0.1 * np.abs(recording.signal).max()) / recording.samples
    half = 3600.0 / vph
    found = [loud[0]]
    for one in loud:
        if one - found[-1] > 0.6 * half:
            found.append(one)
    steps = np.diff(found)
    period = (found[2 * ((len(found) - 1) // 2)] - found[0]) / ((len(found) - 1) // 2)
    return 86400.0 * (2.0 * half / period - 1.0), 500.0 * abs(steps[0::2].mean() - steps[1::2].mean())


@pytest.mark.parametrize(
    ("vph", "beat_error", "interval", "rate"),
    [
        (36000, 0.0, 5e-3, 3.0),
        (28800, 0.4e-3, 7e-3, -12.0),
        (25200, 0.3e-3, 8e-3, 4.0),
        (21600, 2.5e-3, 9e-3, 40.0),
        (18000, 0.0, 11e-3, 0.0),
        (18000, 6e-3, 11e-3, -300.0),
        (7200, 20e-3, 14e-3, 25.0),
        (3600, 60e-3, 20e-3, -15.0),
    ],
)
def test_watches_and_slow_clocks(vph, beat_error, interval, rate):
    recording = ticking(vph, 60.0 if vph < 10000 else 20.0, beat_error, interval, rate)
    heard = heard_in(recording)
    assert heard.nominal_vph == vph and heard.missed == 0
    assert heard.rate_s_per_d == pytest.approx(rate, abs=0.1)
    assert heard.beat_error_ms == pytest.approx(1e3 * beat_error, abs=0.02)
    assert heard.interval_ms == pytest.approx(1e3 * interval, abs=0.15)
    other_rate, other_error = naive(recording, vph)
    assert heard.rate_s_per_d == pytest.approx(other_rate, abs=0.5)
    assert heard.beat_error_ms == pytest.approx(other_error, abs=0.05)


@pytest.mark.parametrize("noise", [0.02, 0.3, 0.5])
def test_in_noise_and_hum(noise):
    """The statement of its own error holds; the noise is such that no threshold would find the clock."""
    recording = ticking(28800, 20.0, 0.8e-3, 7e-3, 6.0, noise=noise, jitter=20e-6, hum=0.5)
    heard = heard_in(recording)
    assert abs(heard.rate_s_per_d - 6.0) < 4.0 * heard.rate_s_per_d_error < 0.8
    assert heard.beat_error_ms == pytest.approx(0.8, abs=0.02 + 4.0 * heard.beat_error_ms_error)
    assert heard.interval_ms == pytest.approx(7.0, abs=0.35)


@pytest.fixture(scope="module")
def swiss(tmp_path_factory):
    run = ws.simulate(ws.load(ws.profiles_dir() / "swiss_lever").set("bodies.balance.angle", "-279.27°"), duration=20.0)
    return run, ws.sound(run, tmp_path_factory.mktemp("sound") / "tick.wav")


def test_our_own_sound_says_what_its_run_did(swiss):
    run, path = swiss
    heard, shown = ws.listen(path, lift_angle="51.2°"), timegrapher(run, beats(run), (0.0, 20.0))
    assert heard.rate_s_per_d == pytest.approx(shown["rate_s_per_d"], abs=0.1)
    assert heard.beat_error_ms == pytest.approx(shown["beat_error_ms"], abs=0.01)
    assert heard.amplitude_deg == pytest.approx(shown["amplitude_deg"], abs=2.0)
    paper = heard.tape
    assert np.nanmean(paper.rate_s_per_d) == pytest.approx(heard.rate_s_per_d, abs=0.5)
    assert len(paper.t) == len(heard.t) and abs(paper.gain_ms).max() < 5.0


RUNNING_DOWN = {"rate": (-1.0, -7.0), "interval": (7.6e-3, 8.9e-3)}


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.3])
def test_a_watch_that_runs_down_is_said_to(noise):
    """From 270° to 233°, as the amplitude follows from the interval; the rate that is stated holds all of its way."""
    heard = heard_in(ticking(28800, 20.0, 0.4e-3, noise=noise, jitter=20e-6, **RUNNING_DOWN))
    assert heard.rate_s_per_d == pytest.approx(-4.0, abs=0.5) and heard.rate_change_s_per_d == pytest.approx(-6.0, abs=1.0)
    assert 2.4 < heard.rate_s_per_d_error < 3.6
    first, last = (52.0 / (2.0 * math.sin(math.pi * interval / 0.25)) for interval in RUNNING_DOWN["interval"])
    assert heard.amplitude_change_deg == pytest.approx(last - first, abs=5.0)


@pytest.mark.parametrize(
    ("rate", "interval", "noise"),
    [((-6.0, -6.0), (7e-3, 7e-3), 0.1), ((-6.0, -6.0), (7e-3, 7e-3), 0.3), ((-4.0, -5.0), (7e-3, 7.1e-3), 0.3)],
)
def test_the_interval_of_the_rate_is_honest(rate, interval, noise):
    """Of a settled watch it is the standard error, and no drift is seen; a drift too small to be seen still widens it."""
    heard = [heard_in(ticking(28800, 20.0, 0.4e-3, interval, rate, noise, 20e-6, seed)) for seed in range(12)]
    off = np.array([(one.rate_s_per_d - 0.5 * sum(rate)) / one.rate_s_per_d_error for one in heard])
    assert np.sqrt(np.mean(off**2)) < 1.4 and abs(off).max() < 3.0
    if rate[0] == rate[1]:
        assert not any(one.rate_change_s_per_d or one.amplitude_change_deg for one in heard)
        assert np.mean([one.rate_s_per_d_error for one in heard]) < 0.08


def test_our_own_sound_of_a_watch_that_runs_down(tmp_path, capsys):
    """Against the instants of its run: of the first third, and of the last."""
    scene = ws.load(ws.profiles_dir() / "swiss_lever").set("bodies.balance.angle", "-279.27°")
    run = ws.simulate(scene.set("torques.0.value", "-0.7 µN·m"), duration=20.0)
    path = ws.sound(run, tmp_path / "tick.wav")
    heard, found = ws.listen(path, lift_angle="51.2°"), beats(run)
    thirds = np.array_split(found.tick[np.isfinite(found.tick)], 3)
    first, whole, last = (
        86400.0 * (0.125 / np.polyfit(np.arange(len(one)), one, 1)[0] - 1.0)
        for one in (thirds[0], np.concatenate(thirds), thirds[2])
    )
    assert last - first < -2.0 and heard.rate_s_per_d == pytest.approx(whole, abs=0.3)
    assert heard.rate_change_s_per_d == pytest.approx(1.5 * (last - first), abs=1.0)
    assert abs(heard.rate_s_per_d - first) < heard.rate_s_per_d_error + 0.3
    assert heard.amplitude_change_deg == pytest.approx(found.amplitude_deg[-1] - found.amplitude_deg[0], abs=8.0)
    assert main(["listen", str(path)]) == 0
    said = capsys.readouterr().out
    assert said.count("within the recording: not settled") == 2 and "it falls from" in said


def written(path: Path, signal: np.ndarray, width: int, channels: int = 1) -> Path:
    """A WAV of that many bytes a sample; the clock is on the last channel."""
    silent = np.zeros_like(signal)
    frames = np.column_stack([*[silent] * (channels - 1), 0.5 * signal / np.abs(signal).max()])
    whole = np.rint(frames * (2 ** (8 * width - 1) - 1)).astype("<i4").ravel()
    raw = (whole + 128).astype(np.uint8).tobytes() if width == 1 else whole.view(np.uint8).reshape(-1, 4)[:, :width].tobytes()
    with wave.open(str(path), "wb") as file:
        file.setnchannels(channels)
        file.setsampwidth(width)
        file.setframerate(FS)
        file.writeframes(raw)
    return path


@pytest.mark.parametrize(("width", "channels", "cut"), [(1, 1, 0), (2, 2, 0), (3, 1, 0), (3, 2, 100_001), (4, 1, 3)])
def test_every_kind_of_wav(tmp_path, width, channels, cut):
    path = written(tmp_path / "clock.wav", ticking(21600, 8.0, 1e-3).signal, width, channels)
    if cut:
        path.write_bytes(path.read_bytes()[:-cut])
    heard = ws.listen(path)
    assert heard.rate_s_per_d == pytest.approx(0.0, abs=0.5) and heard.beat_error_ms == pytest.approx(1.0, abs=0.02)
    assert any("cut short" in note for note in heard.notes) == bool(cut)
    assert any("channels" in note for note in heard.notes) == (channels > 1)


def test_the_command(tmp_path, capsys):
    path = written(tmp_path / "clock.wav", ticking(28800, 8.0, 0.5e-3).signal, 2)
    assert main(["listen", str(path), "--lift-angle", "50°", "--json", "-o", str(tmp_path / "tape.png")]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {"vph", "rate_s_per_d", "beat_error_ms", "amplitude_deg", "seconds"} <= set(found)
    expected = 50.0 / (2.0 * math.sin(math.pi * found["interval_ms"] / 250.0))
    assert found["amplitude_deg"] == pytest.approx(expected, rel=1e-6) and found["vph"] == pytest.approx(28800.0, abs=0.1)
    assert (tmp_path / "tape.png").read_bytes().startswith(b"\x89PNG")
    assert main(["listen", str(path), "-o", str(tmp_path / "tape.csv")]) == 0
    assert (tmp_path / "tape.csv").read_text(encoding="utf-8").startswith("t_s,gain_ms,direction,rate_s_per_d,beat_error_ms\n")
    assert "28800" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (b"", "no WAV"),
        (b"RIFF....WAVEfmt ", "no WAV"),
        (b"ID3 an mp3", "no WAV"),
        ("silent", "is silent"),
        ("noise", "nothing in it repeats"),
        ("short", "too short"),
        (None, "no such file"),
    ],
)
def test_what_is_no_clock_is_refused(tmp_path, capsys, content, why):
    path = tmp_path / "x.wav"
    if isinstance(content, bytes):
        path.write_bytes(content)
    elif content:
        noise = np.random.default_rng(3).standard_normal(FS * 5)
        written(path, {"silent": np.ones(FS), "noise": noise, "short": noise[:3000]}[content] * 1.0, 2)
        if content == "silent":
            path.write_bytes(path.read_bytes()[:44] + struct.pack("<h", 7) * FS)
    assert main(["listen", str(path), "--lift-angle", "200°", "-o", str(tmp_path / "tape.pdf.gz")]) == 2
    said = capsys.readouterr().err
    assert "lift-angle" in said and "tape.pdf.gz" in said and "Traceback" not in said
    assert main(["listen", str(path)]) == 2
    assert why in capsys.readouterr().err


def test_an_unusual_train_has_no_rate_until_it_is_stated():
    recording = ticking(23000, 10.0)
    assert heard_in(recording).rate_s_per_d is None
    assert heard_in(recording, vph=23000).rate_s_per_d == pytest.approx(0.0, abs=0.2)
    with pytest.raises(NothingHeard, match="is silent"):
        heard_in(Recording(FS, np.zeros(FS)))


# What do timing machines make of our sound: one that finds the first noise of a beat, and one that waits for a loud one?


def sounding(blows: list[tuple[float, float]], path: Path) -> bytes:
    """The WAV of a run with impacts at those times (s) that lose those energies (J)."""
    run = watch_run(duration=1.0)
    rows = [(t, EventKind.IMPACT, 0, -1, 2e-9, 0.0, energy, 0.0) for t, energy in blows]
    return ws.sound(Trajectory(**{**run.__dict__, "events": np.array(rows, dtype=EVENT_DTYPE)}), path).read_bytes()


def test_a_blow_in_many_impacts_is_as_loud_as_one_of_their_energy(tmp_path: Path) -> None:
    quiet, loud = (0.2, 1e-12), 4e-12
    parts = [(0.5 + k * 1e-6, loud / 8.0) for k in range(8)]
    assert sounding([quiet, *parts], tmp_path / "parts.wav") == sounding([quiet, (0.5, loud)], tmp_path / "one.wav")
    apart = [(0.5 + k * 1e-4, loud / 8.0) for k in range(8)]
    assert sounding([quiet, *apart], tmp_path / "apart.wav") != sounding([quiet, (0.5, loud)], tmp_path / "whole.wav")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("profile", "duration", "beat", "late"),
    [
        ("coaxial", 12.0, 1.0 / 7.0, (0.5, 0.8)),
        ("tourbillon", 10.0, 0.125, (0.3, 0.7)),
        ("swiss_lever", 12.0, 0.125, (0.05, 0.2)),
    ],
)
def test_the_first_noise_gives_the_true_beat_error_and_a_loud_one_another(
    profile: str, duration: float, beat: float, late: tuple[float, float], tmp_path: Path
) -> None:
    """docs/guide/coaxial.md says so, with figures: louder noises come at different times after the first in tick and tock."""
    run = ws.simulate(ws.load(ws.profiles_dir() / profile), duration=duration, record="all")
    file = ws.sound(run, tmp_path / "tick.wav")
    true = float(np.nanmean(tape(run).beat_error_ms))
    heard = ws.listen(file)
    assert heard.beat_error_ms == pytest.approx(true, abs=0.05)
    assert heard.amplitude_deg is not None
    assert beat_error_ms(file, 0.05, beat) == pytest.approx(true, abs=0.05)
    loud = beat_error_ms(file, 0.3, beat)
    assert late[0] < loud < late[1]
    note = another_beat_error(run, (duration - 8.0 * beat, duration))  # beside the sound of a page
    assert (note == "") == (profile == "swiss_lever")
    if note:
        shown = [float(text) for text in re.findall(r"(\d+\.\d+) ms", note)]
        assert shown[2:] == [pytest.approx(loud, abs=0.1), pytest.approx(true, abs=0.06)]
