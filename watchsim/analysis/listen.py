"""What does a recording of a ticking watch or clock say: vph, rate, beat error, amplitude?

Above the hum, the power of the sound is a row of beats. Their distance comes from its autocorrelation, their instants from
shifting the mean sound of a tick, and of a tock, along the recording until it fits. The first noise of a beat (A) and the last
loud one (C) are found in the mean sounds, where noise that does not repeat itself has vanished.
"""

from __future__ import annotations

import io
import math
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timegrapher import LONGEST, LOUD, Tape, amplitude_deg
from watchsim.analysis.timing import DAY

Array = NDArray[np.float64]

LIFT_ANGLE = 52.0  # degrees: what timing machines assume where nothing is set
TRAINS = (3600, 7200, 9000, 10800, 12000, 14400, 16200, 17280, 18000, 19800, 21000, 21600, 25200, 28800, 36000, 43200, 72000)
NEAR = 0.02  # of a train's beat: recordings further off have no rate unless the train is stated
BAND = 1000.0, 7500.0  # Hz: below is hum and speech, above there is more noise than tick
SMOOTH = 0.25e-3  # s over which the power is averaged: noises closer than that are one
BIN = 1e-3  # s, of the coarse envelope in which the beat is found
BEATS = (0.045, 1.3)  # s, shortest and longest beat that is looked for
FEWEST = 8  # beats, below which nothing is said
MOST_SECONDS = 1200.0  # of a recording that are listened to
ALIKE = 0.3  # correlation of a beat with the mean one, below which it was not heard
CLEAR = 0.15  # of the autocorrelation at no lag: below it nothing repeats itself
LAME = 0.3  # of a period, a beat error that no clock goes with
REGULAR = 0.02  # of a beat, how much beats may scatter: what is shifted along noise fits anywhere
HALVES = 0.25  # of the correlation after an oscillation: half as far away stands the other beat
FAINT = 0.08  # of the greatest amplitude in a beat: fainter bursts are rebounds and noise
FIRST = 0.8e-3, 1.6e-3, 0.3e-3  # s: from before noise A, so long a stretch, shifted by so much at most
OVER_NOISE = 5.0  # standard deviations above the noise
STRETCHES, FEW = 6, 4  # of a recording, which are compared, and ticks in each at least
BLOCKS = 8  # of neighbouring beats, whose delays are compared
SURE, LIKELY = 4.0, 2.0  # standard errors, beyond which a change is one, or may be


NO_BEAT = "nothing in it repeats itself like a watch. Hold the microphone to the case, and keep away other noise"


class NothingHeard(ValueError):
    """A recording in which no watch is heard; the text says why, and what to do."""


@dataclass(frozen=True)
class Recording:
    """`signal` between -1 and 1, `samples` per second; `notes` on what was odd about the file."""

    samples: float
    signal: Array
    notes: tuple[str, ...] = ()


def read_wav(path: str | Path) -> Recording:
    """A WAV of any width, of several channels the loudest; one that was cut short is read as far as it goes.

    NothingHeard where the file is none, or holds nothing.
    """
    from scipy.io import wavfile

    raw, notes = bytearray(Path(path).read_bytes()), []
    head, begin = raw.find(b"fmt "), raw.find(b"data") + 8
    if raw[:4] not in (b"RIFF", b"RF64") or head < 0 or begin < 8 or len(raw) < begin:
        raise NothingHeard(f"{path}: is no WAV file, or only the beginning of one. Convert it, such as with ffmpeg")
    frame = max(1, int.from_bytes(raw[head + 20 : head + 22], "little"))
    promised, there = int.from_bytes(raw[begin - 4 : begin], "little"), len(raw) - begin
    if there < promised:
        raw = raw[: begin + there // frame * frame]
        raw[begin - 4 : begin] = struct.pack("<I", len(raw) - begin)
        raw[4:8] = struct.pack("<I", len(raw) - 8)
        share = "" if promised >= 0x7FFFFFFF else f": {there / promised:.0%} of what it promises is there"
        notes.append(f"the file was cut short{share}")
    try:
        samples, values = wavfile.read(io.BytesIO(bytes(raw)))
    except (ValueError, struct.error) as error:
        raise NothingHeard(f"{path}: cannot be read as WAV: {error}") from error
    signal = values.astype(float).reshape(len(values), -1)
    if values.dtype.kind in "iu":
        middle, full = (128.0, 128.0) if values.dtype == np.uint8 else (0.0, -float(np.iinfo(values.dtype).min))
        signal = (signal - middle) / full
    if not len(signal) or not np.isfinite(signal).all():
        raise NothingHeard(f"{path}: holds no sound" if not len(signal) else f"{path}: holds samples that are no numbers")
    loudest = int(np.argmax(signal.std(axis=0)))
    if signal.shape[1] > 1:
        notes.append(f"of {signal.shape[1]} channels the loudest is taken, number {loudest + 1}")
    return Recording(float(samples), signal[:, loudest], tuple(notes))


@dataclass(frozen=True)
class Heard:
    """What a recording says; times in s from its beginning.

    nominal_vph   the train that the rate is against: the nearest usual one, or as stated. None where none is near
    t, forward    first noise of each beat that was heard; ticks are `forward`, tocks are not. Which is which, nobody can hear
    interval_ms   from noise A to noise C, mean of all beats; None where a beat is one noise
    amplitude_deg  by the lift angle, as a timing machine does; None without an interval
    ..._change_..  from the beginning of the recording to its end, 0 where nothing can be seen of one; None where not known
    ..._error     standard error, from the scatter of the beats; of a rate that changes, half of the change is part of it
    """

    title: str
    seconds: float
    vph: float
    nominal_vph: float | None
    rate_s_per_d: float | None
    rate_s_per_d_error: float | None
    rate_change_s_per_d: float | None
    beat_error_ms: float
    beat_error_ms_error: float
    interval_ms: float | None
    amplitude_deg: float | None
    amplitude_change_deg: float | None
    lift_angle_deg: float
    missed: int
    t: Array
    forward: NDArray[np.bool_]
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        swing = "" if self.amplitude_deg is None else f", {self.amplitude_deg:.0f}°"
        rate = "" if self.rate_s_per_d is None else f", {self.rate_s_per_d:+.1f} s/d"
        return f"<Heard {self.title!r}: {self.vph:.1f} vph{rate}{swing}, beat error {self.beat_error_ms:.2f} ms>"

    def numbers(self) -> dict[str, Any]:
        """What `listen --json` prints."""
        names = (
            *("vph", "nominal_vph", "rate_s_per_d", "rate_s_per_d_error", "rate_change_s_per_d", "beat_error_ms"),
            *("beat_error_ms_error", "interval_ms", "amplitude_deg", "amplitude_change_deg", "lift_angle_deg", "seconds"),
            "missed",
        )
        return {**{name: getattr(self, name) for name in names}, "beats": len(self.t), "notes": list(self.notes)}

    @property
    def tape(self) -> Tape:
        """The paper of the timing machine, as of a run; against the mean beat where no train is near."""
        period = 7200.0 / (self.nominal_vph or self.vph)
        half, t = 0.5 * period, self.t
        number = np.concatenate([[0.0], np.cumsum(np.rint(np.diff(t) / half))])
        whole = np.append([False, False], number[2:] == number[:-2] + 2.0)
        two, one = np.append([np.nan] * 2, t[:-2]), np.append(np.nan, t[:-1])
        nothing = np.full(len(t), np.nan)
        return Tape(
            period,
            t,
            1e3 * (number * half - (t - t[0])),
            self.forward,
            np.where(whole, DAY * (period / (t - two) - 1.0), np.nan),
            np.where(whole, 500.0 * np.abs(t - 2.0 * one + two), np.nan),
            nothing,
            nothing,
        )


def listen(path: str | Path, *, lift_angle: float | str | None = None, vph: float | None = None) -> Heard:
    """Listen to a WAV file.

    lift_angle  degrees, or a text such as "51°" (default 52°)
    vph         vibrations per hour of the train (default the nearest usual one)

    NothingHeard, a ValueError, where no watch is heard in it; OSError where it cannot be read.
    """
    lift = LIFT_ANGLE if lift_angle is None else _degrees(lift_angle)
    if not 0.0 < lift < 180.0:
        raise ValueError(f"lift_angle: must lie between 0° and 180°, not {lift:g}°")
    if vph is not None and not (math.isfinite(vph) and vph > 0.0):
        raise ValueError(f"vph: must be a positive number, not {vph}")
    return heard_in(read_wav(path), lift, vph, Path(path).name)


def _degrees(angle: float | str) -> float:
    from watchsim.units import ANGLE, UnitError, parse

    if not isinstance(angle, str):
        return float(angle)
    try:
        return math.degrees(parse(angle, ANGLE))
    except UnitError as error:
        raise ValueError(f"lift_angle: {error}") from error


def heard_in(recording: Recording, lift: float = LIFT_ANGLE, vph: float | None = None, title: str = "recording") -> Heard:
    """The same of samples."""
    fs, notes = recording.samples, list(recording.notes)
    signal = recording.signal[: int(MOST_SECONDS * fs)]
    if len(signal) < len(recording.signal):
        notes.append(f"the first {MOST_SECONDS / 60.0:g} minutes are listened to")
    if fs < 1.0 / SMOOTH:
        raise NothingHeard(f"{title}: {fs:g} samples a second are too few to hear a watch; take 44100")
    if not np.ptp(signal) > 0.0:
        raise NothingHeard(f"{title}: is silent")
    loudness = _loudness(signal, fs)
    beat = _beat(loudness, fs, title)
    marks = _marks(loudness, fs, beat)
    times, forward, number, bursts, late = _instants(loudness, fs, beat, marks)
    if len(times) < FEWEST:
        raise NothingHeard(f"{title}: only {len(times)} beats are heard; {FEWEST} are needed")
    found = _regular(times, forward, number)
    period, split = found.period, found.split
    if found.period_error * math.sqrt(len(times) ** 3 / 3.0) > REGULAR * period or abs(2.0 * split - period) > LAME * period:
        raise NothingHeard(f"{title}: {NO_BEAT}")
    nominal: float | None = vph or min(TRAINS, key=lambda one: abs(math.log(one * period / 7200.0)))
    if vph is None and nominal is not None and abs(nominal * period / 7200.0 - 1.0) > NEAR:
        notes.append(f"{7200.0 / period:.0f} vph is no usual train, so there is no rate. State the train (--vph)")
        nominal = None
    interval = _interval(bursts, 0.5 * period)
    each = [one for both in zip(*late, strict=True) if (one := _interval([*both], 0.5 * period)) is not None]
    known = interval is not None and len(each) == STRETCHES
    swings = [amplitude_deg(math.radians(lift), one, period) or math.nan for one in each]
    slower = found.longer if abs(found.longer) > SURE * found.longer_error else 0.0
    # Where noise A is too faint to be followed by itself, the beats drift with their later noises.
    drift = 0.5 * slower or (period * _change(np.array(each), LIKELY) * fs / len(signal) if known else 0.0)
    uncertain = math.hypot(found.period_error, drift)
    return Heard(
        title=title,
        seconds=len(signal) / fs,
        vph=7200.0 / period,
        nominal_vph=nominal,
        rate_s_per_d=None if nominal is None else DAY * (7200.0 / nominal / period - 1.0),
        rate_s_per_d_error=None if nominal is None else DAY * uncertain / period,
        rate_change_s_per_d=None if nominal is None else -DAY * slower / period,
        beat_error_ms=500.0 * abs(2.0 * split - period),
        beat_error_ms_error=1e3 * found.split_error,
        interval_ms=None if interval is None else 1e3 * interval,
        amplitude_deg=amplitude_deg(math.radians(lift), interval, period),
        amplitude_change_deg=_change(np.array(swings)) if known else None,
        lift_angle_deg=lift,
        missed=int(number[-1] - number[0]) + 1 - len(number),
        t=times,
        forward=forward,
        notes=tuple(notes),
    )


# The root of the power, so that a loud noise does not drown the others; averaged over a quarter of a millisecond.


def _loudness(signal: Array, fs: float) -> Array:
    from scipy.ndimage import gaussian_filter1d
    from scipy.signal import butter, sosfiltfilt

    band = [min(BAND[0], fs / 8.0), min(BAND[1], 0.4 * fs)]
    high = sosfiltfilt(butter(3, band, "bandpass", fs=fs, output="sos"), signal - signal.mean())
    power = gaussian_filter1d(high * high, 0.4 * SMOOTH * fs)
    return np.sqrt(np.maximum(power, 0.0))


def _beat(loudness: Array, fs: float, title: str) -> float:
    """s from beat to beat: half an oscillation, after which tick follows tick."""
    from scipy.signal import find_peaks

    size = max(1, round(BIN * fs))
    coarse = loudness[: len(loudness) // size * size].reshape(-1, size).mean(axis=1)
    width = size / fs
    coarse = np.minimum(coarse, np.quantile(coarse, 0.999)) - np.median(coarse)
    coarse -= coarse.mean()
    count = len(coarse)
    wide = np.fft.rfft(coarse, 2 * count)
    alike = np.fft.irfft(np.abs(wide) ** 2)[:count]
    alike = alike / np.maximum(count - np.arange(count), 1)
    longest = min(int(2.0 * BEATS[1] / width), count // 3)
    if longest * width < 2.0 * BEATS[0] or not alike[0] > 0.0:
        raise NothingHeard(f"{title}: {count * width:.2g} s are too short to hear a watch; record half a minute")
    spread = np.convolve(alike[: longest + 8], np.ones(5) / 5.0, "same")  # a beat error makes peaks of half periods wide
    first = round(BEATS[0] / width)
    peaks = find_peaks(spread[:longest])[0]
    peaks = peaks[peaks >= first]
    highest = float(spread[peaks].max()) if len(peaks) else 0.0
    if highest < CLEAR * spread[0]:
        raise NothingHeard(f"{title}: {NO_BEAT}")
    lag = int(peaks[spread[peaks] >= 0.7 * highest][0])
    half = spread[round(0.35 * lag) : round(0.65 * lag)]
    per = 2 if 0.35 * lag >= first and half.max() >= HALVES * spread[lag] else 1
    if per == 1 and lag * width > 1.5 * BEATS[1]:
        per = 2
    return _finer(alike, lag, 2.0 if per == 1 else 1.0) * width / 2.0


def _finer(alike: Array, lag: int, times: float) -> float:
    """The lag of a whole oscillation in bins, from ever longer stretches."""
    found, k = lag * times, 1
    while True:
        at = round(k * found)
        if at + 4 >= 0.6 * len(alike):
            return found
        low = max(1, at - 3)
        peak = low + int(np.argmax(alike[low : at + 4]))
        left, top, right = alike[peak - 1 : peak + 2]
        bend = left - 2.0 * top + right
        found = (peak + (0.5 * (left - right) / bend if bend < 0.0 else 0.0)) / k
        k *= 2


def _marks(loudness: Array, fs: float, beat: float) -> tuple[float, float]:
    """Where, in an oscillation from its beginning at 0, the middles of the loud parts of tick and tock are (s)."""
    size = round(2.0 * beat / BIN)
    width = 2.0 * beat / size
    edges = np.rint(np.arange(0.0, len(loudness) / fs, width) * fs).astype(int)
    bins = np.add.reduceat(loudness, edges[edges < len(loudness)])
    folded = bins[: len(bins) // size * size].reshape(-1, size).mean(axis=0)
    folded = np.maximum(folded - np.median(folded), 0.0)
    reach = max(1, round(0.3 * beat / width))
    around = np.convolve(np.tile(folded, 3), np.ones(reach), "same")[size : 2 * size]
    one = int(np.argmax(around))
    far = np.abs((np.arange(size) - one + size // 2) % size - size // 2) >= 0.5 * beat / width
    other = int(np.argmax(np.where(far, around, -1.0)))
    return one * width, other * width


@dataclass(frozen=True)
class Burst:
    """A noise within the mean sound of a beat: where it rises through half its height (s), and how loud it is."""

    at: float
    loud: float


def _instants(
    loudness: Array, fs: float, beat: float, marks: tuple[float, float]
) -> tuple[Array, NDArray[np.bool_], NDArray[np.int64], list[list[Burst]], list[list[list[Burst]]]]:
    """First noise of every beat that is heard (s), whether it is a tick, its number; bursts of both mean sounds; of both also
    those of equal stretches of the recording, none where it is short."""
    before, after, room = 0.35 * beat, 0.6 * beat, 0.2 * beat
    found: list[tuple[Array, NDArray[np.int64]]] = []
    bursts, late = [], []
    for mark in marks:
        count = int((len(loudness) / fs - mark) / (2.0 * beat)) + 1
        centres = mark + 2.0 * beat * np.arange(count)
        inside = (centres > before + room + BIN) & (centres + after + room + BIN < len(loudness) / fs)
        numbers = np.flatnonzero(inside)
        begins, template, alike = _aligned(loudness, fs, np.asarray(centres[inside] - before, float), before + after, room)
        own = _bursts(template, fs)
        bursts.append(own)
        heard = alike >= ALIKE
        late.append(_by_stretches(loudness, fs, begins[heard], before + after))
        first = begins[heard] + _first_of(own, late[-1], int(heard.sum()))
        found.append((_by_first_noise(loudness, fs, first), numbers[heard]))
    tick = 0 if marks[0] < marks[1] else 1
    times = np.concatenate([found[0][0], found[1][0]])
    forward = np.repeat([tick == 0, tick == 1], [len(found[0][0]), len(found[1][0])])
    number = 2 * np.concatenate([found[0][1], found[1][1]]) + ~forward
    order = np.argsort(number)
    return times[order], forward[order], number[order], bursts, late


def _by_stretches(loudness: Array, fs: float, begins: Array, length: float) -> list[list[Burst]]:
    """The bursts of the mean sounds of equal stretches, in windows that begin where those of the whole recording fit."""
    if len(begins) < STRETCHES * FEW:
        return []
    places = np.rint(begins * fs).astype(np.int64)[:, None] + np.arange(round(length * fs))
    return [_bursts(loudness[some].mean(axis=0), fs) for some in np.array_split(places, STRETCHES)]


def _first_of(whole: list[Burst], late: list[list[Burst]], count: int) -> Array:
    """Noise A in the window of each beat (s).

    As an amplitude falls, the other noises move away from it, and what fits the whole beat moves with them: then a parabola
    through the stretches says where it is.
    """
    at = np.full(count, whole[0].at if whole else 0.0)
    first = np.array([own[0].at for own in late if own])
    if len(first) == STRETCHES and _change(first):
        middles = [float(np.mean(some)) for some in np.array_split(np.arange(count), STRETCHES)]
        at = np.polyval(np.polyfit(middles, first, 2), np.arange(count))
    return at


def _by_first_noise(loudness: Array, fs: float, first: Array) -> Array:
    """The same instants by noise A alone where that scatters less: drop and lock come later in one beat than in another."""
    before, length, room = FIRST
    inside = (first > before + room + BIN) & (first + length + room + BIN < len(loudness) / fs)
    if len(first) < FEWEST or not inside.all():
        return first
    begins, _, _ = _aligned(loudness, fs, first - before, length, room)
    alone = begins + before
    alone += np.median(first - alone)  # what is alike may be shifted as a whole
    uneven = [float(np.median(np.abs(np.diff(times, 2)))) for times in (alone, first)]
    return alone if uneven[0] < uneven[1] else first


def _aligned(loudness: Array, fs: float, begins: Array, length: float, room: float) -> tuple[Array, Array, Array]:
    """Where windows of that length begin so that they fit their mean; the mean, and how alike each is to it."""
    count, reach = round(length * fs), round(room * fs)
    first = np.rint(begins * fs).astype(np.int64)
    if len(first) < 2:
        return begins, np.zeros(count), np.zeros(len(first))
    wide = np.stack([loudness[one - reach : one + count + reach] for one in first])
    wide = wide - np.median(wide, axis=1, keepdims=True)
    shift = np.zeros(len(first))
    size = 1 << (wide.shape[1] + count).bit_length()
    spectra = np.fft.rfft(wide, size)
    rows = np.arange(len(first))
    for turn in range(4):
        whole = reach + np.rint(shift).astype(np.int64)
        template = np.mean([row[at : at + count] for row, at in zip(wide, whole, strict=True)], axis=0)
        if turn == 3:
            break
        fits = np.fft.irfft(spectra * np.conj(np.fft.rfft(template, size)), size)[:, : 2 * reach + 1]
        best = np.clip(np.argmax(fits, axis=1), 1, 2 * reach - 1)
        left, top, right = (fits[rows, best + k] for k in (-1, 0, 1))
        bend = left - 2.0 * top + right
        between = 0.5 * (left - right) / np.where(bend < 0.0, bend, -np.inf)
        shift = best - reach + np.clip(between, -0.5, 0.5)
    parts = np.stack([row[at : at + count] for row, at in zip(wide, whole, strict=True)])
    norms = np.linalg.norm(parts, axis=1) * np.linalg.norm(template)
    alike = (parts @ template) / np.where(norms > 0.0, norms, np.inf)
    kept: Array = (first + shift) / fs
    return kept, template, alike


def _bursts(template: Array, fs: float) -> list[Burst]:
    """The noises of a mean beat in the order of time."""
    from scipy.signal import find_peaks

    floor = float(np.median(template))  # most of it is silence
    noise = 1.4826 * float(np.median(np.abs(template - floor)))
    top = float(template.max()) - floor
    least = max(FAINT * top, OVER_NOISE * noise)
    peaks = find_peaks(template - floor, height=least, prominence=0.5 * least, distance=max(1, round(2.0 * SMOOTH * fs)))[0]
    found = []
    for k, peak in enumerate(peaks.tolist()):
        begin = peaks[k - 1] if k else 0
        low = begin + int(np.argmin(template[begin:peak])) if peak > begin else peak
        level = 0.5 * (template[peak] + max(float(template[low]), floor))
        at = peak
        while at > low and template[at - 1] >= level:
            at -= 1
        rise = template[at] - template[at - 1] if at > 0 else 0.0
        found.append(Burst((at - ((template[at] - level) / rise if rise > 0.0 else 0.0)) / fs, float(template[peak] - floor)))
    return found


def _interval(bursts: list[list[Burst]], half_period: float) -> float | None:
    """From the first noise to the last loud one, s, mean of tick and tock; as `timegrapher` takes it."""
    found = []
    for own in bursts:
        near = [one for one in own if own and one.at - own[0].at <= LONGEST * half_period]
        loud = [one for one in near if one.loud**2 >= LOUD * max(other.loud for other in near) ** 2]
        if len(near) > 1 and loud and loud[-1].at > own[0].at:
            found.append(loud[-1].at - own[0].at)
    return float(np.mean(found)) if len(found) == len(bursts) else None


class Regular(NamedTuple):
    """Period, time from tick to tock, their standard errors; by how much the period grows to the end, and its error; s."""

    period: float
    split: float
    period_error: float
    split_error: float
    longer: float
    longer_error: float


def _regular(times: Array, forward: NDArray[np.bool_], number: NDArray[np.int64]) -> Regular:
    """By least squares, with a parabola beside the line: a period that drifts bends the row of beats."""
    whole = (number - ~forward) / 2.0
    along = whole - whole.mean()
    design = np.column_stack([forward, ~forward, along, along**2 - np.mean(along**2)]).astype(float)
    line, *_ = np.linalg.lstsq(design[:, :3], times, rcond=None)
    bent, *_ = np.linalg.lstsq(design, times, rcond=None)
    rest = times - design @ bent
    scatter = float(rest @ rest) / max(len(times) - 4, 1)
    # Teeth that differ make neighbouring beats late together: that many fewer beats are independent.
    blocks = np.array_split(rest, BLOCKS)
    if len(rest) >= BLOCKS * FEWEST and scatter > 0.0:
        scatter *= max(1.0, float(np.mean([len(one) * one.mean() ** 2 for one in blocks])) / scatter)
    covariance = scatter * np.linalg.pinv(design.T @ design)
    across = np.array([-1.0, 1.0, -0.5, 0.0])
    period_error, bend_error = np.sqrt(np.diag(covariance)[2:]).tolist()
    split_error = math.sqrt(across @ covariance @ across)
    span = 2.0 * float(np.ptp(whole))
    return Regular(
        float(line[2]), float(line[1] - line[0]), period_error, split_error, span * float(bent[3]), span * bend_error
    )


def _change(values: Array, sure: float = SURE) -> float:
    """By how much the means of equal stretches say that something changes from beginning to end, on a straight line.

    0 where that is not beyond so many standard errors by their scatter.
    """
    place = (np.arange(len(values)) + 0.5) / max(len(values), 1) - 0.5
    slope = float(values @ place / (place @ place))
    rest = values - values.mean() - slope * place
    error = math.sqrt(float(rest @ rest) / max(len(values) - 2, 1) / float(place @ place))
    return slope if abs(slope) > sure * error else 0.0
