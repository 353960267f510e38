"""What does the sheet say of amplitude, rate and beat error?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from watchsim.analysis.timing.beats import Beats, beats
from watchsim.pages.charts import Dots, scatter
from watchsim.pages.html import Markup, element, section
from watchsim.render.frame.marks.readouts import decimals_for, signed
from watchsim.scene.roles import swings
from watchsim.simulation.record.trajectory import Array, Trajectory

AVERAGED = (("amplitude_deg", "Amplitude", "°"), ("rate_s_per_d", "Rate", " s/d"), ("beat_error_ms", "Beat error", " ms"))


def timekeeping(run: Trajectory, numbers: Mapping[str, Any]) -> Iterator[Markup]:
    """The section; nothing where nothing swings."""
    cards = list(_cards(numbers))
    if not cards and not swings(run.scene):
        return
    note = None
    if numbers.get("window_s"):
        start, end = numbers["window_s"]
        words = f"Means over {start:.4g} s to {end:.4g} s. ± is how much the beats of that time scatter and drift"
        note = element("p", f"{words}{_computed(numbers)}.", class_="note")
    message = numbers.get("timing_message")
    yield section(
        "timing",
        "Timing",
        element("dl", *cards, class_="cards") if cards else None,
        element("p", message, class_="note") if message else None,
        note,
        *_charts(run, beats(run)),
    )


def _computed(numbers: Mapping[str, Any]) -> str:
    """The error of the computation beside the scatter, where a second run gave it."""
    told = numbers.get("error_bars")
    if not told or not told.get("complete"):
        return ""
    moved = [f"{told['differences'][name]:.1g}{unit}" for name, _, unit in AVERAGED if name in told["differences"]]
    return f"; a more exact run moved them by {', '.join(moved)}" if moved else ""


def _cards(numbers: Mapping[str, Any]) -> Iterator[Markup]:
    """What a watchmaker reads first."""
    for name, label, unit in AVERAGED:
        if numbers.get(name) is not None:
            yield _card(label, *with_error(float(numbers[name]), numbers.get(f"{name}_error"), unit))
    if numbers.get("vph") is not None:
        yield _card("Frequency", f"{numbers['vph']:.2f} vph", f"{numbers['frequency_hz']:.6f} Hz")
    heard = numbers.get("timegrapher")
    if heard and heard.get("amplitude_deg") is not None:
        lift = f"with a lift angle of {heard['lift_angle_deg']:.4g}°"
        yield _card("Timegrapher shows", f"{heard['amplitude_deg']:.0f}°", lift)
    if numbers.get("missed_beats") is not None:
        yield _card("Missed beats", str(numbers["missed_beats"]), f"in {numbers['beats']} beats")
    if numbers.get("efficiency") is not None:
        yield _card("Efficiency", f"{100.0 * numbers['efficiency']:.1f} %", "of the drive's work reaches the oscillator")


def with_error(value: float, error: float | None, unit: str) -> tuple[str, str | None]:
    """The value with as many digits as its scatter leaves it, at least two."""
    if error is None:
        return f"{signed(value, 3)}{unit}", None
    decimals = min(max(decimals_for(error), 0 if abs(value) >= 100.0 else 1), 6) if error > 0.0 else 3
    shown = f"{error:.{decimals}f}" if error >= 0.5 * 10.0**-decimals else f"{error:.0e}"
    return f"{signed(value, decimals)}{unit}", f"± {shown}{unit}"


def _card(label: str, value: str, below: str | None) -> Markup:
    small = element("span", below) if below else None
    return element("div", element("dt", label), element("dd", element("b", value), small))


def _charts(run: Trajectory, found: Beats) -> Iterator[Markup]:
    """Paper tape and amplitude of all beats."""
    if len(found) < 3:
        return
    tape = 1e3 * _tape(found)
    least, most = (float(bound(tape)) for bound in (np.nanmin, np.nanmax))
    told = f"Time gained against {1.0 / found.nominal_period:.6g} Hz, beat by beat: from {least:.3g} ms to {most:.3g} ms."
    yield _half("Paper tape", scatter(both_ways(found, found.mark, tape), "time (s)", "gained (ms)", told))
    unit, scale = ("°", float(np.degrees(1.0))) if found.angular else ("mm", 1e3)
    swing = scale * found.amplitude
    told = f"Amplitude of {len(found)} beats: {swing[0]:.4g} {unit} at first, {swing[-1]:.4g} {unit} at the end."
    yield _half("Amplitude", scatter(both_ways(found, found.t, swing), "time (s)", f"amplitude ({unit})", told))


def _half(title: str, chart: Markup) -> Markup:
    return element("div", element("h3", title), chart, class_="half")


def both_ways(found: Beats, x: Array, y: Array) -> list[Dots]:
    """Beats in which the balance turns one way and the other, numbered as in beats.csv."""
    odd = (found.before + 1 + np.arange(len(found))) % 2 == 1
    return [Dots(name, x[own], y[own], look) for name, own, look in (("odd beats", odd, "d0"), ("even beats", ~odd, "d1"))]


def _tape(found: Beats) -> Array:
    """How many seconds each beat comes earlier than one that keeps the nominal frequency, from the first one heard."""
    known = np.flatnonzero(np.isfinite(found.mark))
    if len(known) == 0:
        return np.zeros(len(found))
    half = 0.5 * found.nominal_period
    # Which beat of an even series it is; one that was missed leaves a gap.
    rank = np.round((found.mark - found.mark[known[0]]) / half)
    return np.asarray(rank * half - (found.mark - found.mark[known[0]]))
