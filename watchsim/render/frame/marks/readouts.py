"""What do the numbers in a picture say: time, speed, angles, scale?"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from watchsim.render.frame.pose_history import Window
from watchsim.scene.body import Body

Array = NDArray[np.float64]

ROUND = 1  # decimals of a window's length to which the time before it is given
SHORT = 1.0  # s; a shorter window is given in milliseconds from its start


@dataclass(frozen=True)
class Clock:
    """Time as `value` times a unit after `base` seconds: "19.4 s + 12.5 ms"."""

    base: float
    factor: float
    unit: str

    def text(self, t: float, step: float) -> str:
        """The time, with as many digits as distinguish two instants `step` seconds apart."""
        value = (t - self.base) * self.factor
        number = signed(value, decimals_for(step * self.factor))
        return f"{number} {self.unit}" if self.base == 0.0 else f"{self.base:.9g} s + {number} {self.unit}"

    @property
    def label(self) -> str:
        """What to write at a time axis."""
        return f"time ({self.unit})" if self.base == 0.0 else f"time after {self.base:.9g} s ({self.unit})"


def clock(window: Window) -> Clock:
    """Seconds for long windows, milli- or microseconds after the start for short ones."""
    start, stop = window
    duration = stop - start
    if duration >= SHORT:
        return Clock(0.0, 1.0, "s")
    if start != 0.0 and stop < SHORT:
        return Clock(0.0, 1e3, "ms")
    # A round number just before the start: "3.4 s", not "3.40000046 s".
    decimals = ROUND - math.floor(math.log10(duration))
    base = math.floor(start * 10.0**decimals + 1e-6) / 10.0**decimals
    return Clock(base, 1e6, "µs") if duration < 1e-3 else Clock(base, 1e3, "ms")


def signed(value: float, decimals: int) -> str:
    """Fixed decimals, a true minus sign, and no negative zero."""
    text = f"{value:.{decimals}f}"
    return f"−{text[1:]}" if text.startswith("-") and float(text) != 0.0 else text.lstrip("-")


def decimals_for(step: float) -> int:
    """Decimals that make a change of `step` visible."""
    return min(max(0, -math.floor(math.log10(step) + 1e-9)), 9) if step > 0.0 else 3


def speed_text(speed: float) -> str:
    """ "1/20 of true speed", "true speed", "2 × true speed"."""
    if math.isclose(speed, 1.0, rel_tol=1e-9):
        return "true speed"
    ratio = Fraction(speed).limit_denominator(100_000)
    if speed > 1.0:
        return f"{speed:.4g} × true speed"
    if ratio > 0 and ratio.numerator <= 9 and math.isclose(float(ratio), speed, rel_tol=1e-6):
        return f"{ratio.numerator}/{ratio.denominator} of true speed"
    return f"{speed:.4g} of true speed"


def changing_speed_text(speed: float) -> str:
    """The same with two digits, for a speed that changes: "1/43 of true speed"."""
    if speed >= 0.67:
        return "true speed" if abs(speed - 1.0) < 0.005 else f"{_two_digits(speed)} × true speed"
    return f"1/{_two_digits(1.0 / speed)} of true speed"


def _two_digits(value: float) -> str:
    if value < 10.0:
        return f"{value:.1f}".removesuffix(".0")
    power = 10 ** (math.floor(math.log10(value)) - 1)
    return f"{round(value / power) * power:d}"


def turn_text(turn: float) -> str:
    """ "picture turned by 90° clockwise"; nothing where the scene's axes stand as drawn."""
    degrees = round(math.degrees(math.remainder(turn, math.tau)), 2)
    if degrees == 0.0:
        return ""
    way = "" if abs(degrees) == 180.0 else " clockwise" if degrees < 0.0 else " counter-clockwise"
    return f"picture turned by {abs(degrees):g}°{way}"


def goes_round(angles: Array) -> bool:
    """True where turns have gone by (rad), so that an angle is better read within its turn."""
    return len(angles) > 0 and float(np.abs(angles).max()) >= math.tau


def reading(body: Body, frames: Array, within_turn: bool = False) -> tuple[Callable[[Array], str], tuple[str, str]]:
    """How to show a body's pose (its angle; a slide's travel), and the texts at the two ends of the range in `frames`.

    `within_turn`: the angle from 0° to 360°, whole turns left away.
    """
    if body.motion == "slide":
        start, axis = np.array(body.position), np.array(body.axis)
        values = 1e3 * ((frames[:, :2] - start) @ axis)
        decimals = min(decimals_for(max(float(np.ptp(values)), 1e-6)) + 2, 6)

        def travel(frame: Array) -> str:
            return f"{signed(1e3 * float((frame[:2] - start) @ axis), decimals)} mm"

        return travel, (f"{signed(float(values.min()), decimals)} mm", f"{signed(float(values.max()), decimals)} mm")
    values = np.degrees(frames[:, 2])
    decimals = 2 if float(np.ptp(values)) < 30.0 else 1
    if within_turn:

        def rest(frame: Array) -> str:
            text = f"{math.degrees(frame[2]) % 360.0:.{decimals}f}"
            return f"{0.0:.{decimals}f}°" if text.startswith("360") else f"{text}°"

        return rest, (f"{0.0:.{decimals}f}°", f"{300.0:.{decimals}f}°")

    def angle(frame: Array) -> str:
        return f"{signed(math.degrees(frame[2]), decimals)}°"

    return angle, (f"{signed(float(values.min()), decimals)}°", f"{signed(float(values.max()), decimals)}°")


def scale_bar(width: float) -> tuple[float, str]:
    """A round length (m) of at most `width` metres, and its name."""
    power = 10.0 ** math.floor(math.log10(width))
    length = next(step * power for step in (5.0, 2.0, 1.0) if step * power <= width * (1.0 + 1e-9))
    return (length, f"{length * 1e3:g} mm") if length < 0.9999 else (length, f"{length:g} m")
