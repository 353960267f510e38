"""What does the timing sheet of a page say? The numbers of summary.json, in a watchmaker's units and order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from watchsim.analysis.beats import Beats, beats
from watchsim.analysis.energy import energy_shares
from watchsim.analysis.headlines import expected_text, headlines
from watchsim.analysis.phases import Phase
from watchsim.mechanism.roles import swings
from watchsim.render.readouts import decimals_for, signed
from watchsim.report.charts import Dots, bars, scatter, strip
from watchsim.report.html import Content, Markup, element, joined, table
from watchsim.report.parameters import parameters
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.units import metric

DAY = 86400.0
GOOD = ("ticks",)
VERDICTS = {
    "ticks": "The watch ticks",
    "stops": "The watch stops",
    "knocks": "The watch knocks",
    "trips": "The escapement trips",
    "overbanks": "The lever overbanks",
    "backwards": "The wheel runs backwards",
    "unsettled": "Not settled yet",
}
ORDER = ("unlock", "catch-up", "impulse", "drop", "run to banking")
SIDES = ("even beats", "odd beats")


def sheet(run: Trajectory, numbers: Mapping[str, Any], phases: list[Phase]) -> Markup:
    """All sections of the sheet that this run has something to say to."""
    sections = (
        *_timekeeping(run, numbers),
        *_phases(phases),
        *_energy(run),
        *_function(numbers),
        *_judgement(numbers),
        *_parameters(run),
        _section("words", "The run in words", element("pre", headlines(run, numbers), tabindex=0)),
    )
    return joined(sections)


def verdict(numbers: Mapping[str, Any]) -> Markup | None:
    """A line in colour: what is to be thought of this watch; None where nothing keeps time."""
    word, message = numbers.get("verdict"), numbers.get("verdict_message")
    if word is None and numbers.get("stopped"):
        word, message = "stops", numbers.get("stopped_message")
    if word is None:
        return None
    told = VERDICTS.get(str(word), str(word).capitalize())
    look = "verdict good" if word in GOOD else "verdict bad" if word != "unsettled" else "verdict open"
    return element("p", element("strong", told), f" {message}" if message else None, class_=look)


def _section(name: str, title: str, *content: Content) -> Markup:
    return element("section", element("h2", title, id=f"h-{name}"), *content, aria_labelledby=f"h-{name}", class_=name)


def _timekeeping(run: Trajectory, numbers: Mapping[str, Any]) -> Iterator[Markup]:
    cards = list(_cards(numbers))
    if not cards and not swings(run.scene):
        return
    note = None
    if numbers.get("window_s"):
        start, end = numbers["window_s"]
        words = f"Means over {start:.4g} s to {end:.4g} s. ± is how much the beats of that time scatter and drift"
        note = element("p", f"{words}{_computed(numbers)}.", class_="note")
    message = numbers.get("timing_message")
    yield _section(
        "timing",
        "Timing",
        element("dl", *cards, class_="cards") if cards else None,
        element("p", message, class_="note") if message else None,
        note,
        *_charts(run, beats(run)),
    )


def _computed(numbers: Mapping[str, Any]) -> str:
    """The error of the computation beside the scatter, where a second run told it."""
    bars_told = numbers.get("error_bars")
    if not bars_told or not bars_told.get("complete"):
        return ""
    units = {"amplitude_deg": "°", "rate_s_per_d": " s/d", "beat_error_ms": " ms"}
    moved = [f"{bars_told['differences'][name]:.1g}{unit}" for name, unit in units.items() if name in bars_told["differences"]]
    return f"; a more exact run moved them by {', '.join(moved)}" if moved else ""


def _cards(numbers: Mapping[str, Any]) -> Iterator[Markup]:
    for name, label, unit in (
        ("amplitude_deg", "Amplitude", "°"),
        ("rate_s_per_d", "Rate", " s/d"),
        ("beat_error_ms", "Beat error", " ms"),
    ):
        if numbers.get(name) is not None:
            yield _card(label, *_with_error(float(numbers[name]), numbers.get(f"{name}_error"), unit))
    if numbers.get("vph") is not None:
        yield _card("Frequency", f"{numbers['vph']:.2f} vph", f"{numbers['frequency_hz']:.6f} Hz")
    heard = numbers.get("timegrapher")
    if heard and heard.get("amplitude_deg") is not None:
        yield _card(
            "Timegrapher shows", f"{heard['amplitude_deg']:.0f}°", f"with a lift angle of {heard['lift_angle_deg']:.4g}°"
        )
    if numbers.get("missed_beats") is not None:
        yield _card("Missed beats", str(numbers["missed_beats"]), f"in {numbers['beats']} beats")
    if numbers.get("efficiency") is not None:
        yield _card("Efficiency", f"{100.0 * numbers['efficiency']:.1f} %", "of the drive's work reaches the oscillator")


def _with_error(value: float, error: float | None, unit: str) -> tuple[str, str | None]:
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
    if len(found) < 3:
        return
    number = found.before + np.arange(len(found))
    sides = [number % 2 == k for k in (0, 1)]
    tape = _tape(found)
    yield element(
        "div",
        element("h3", "Paper tape"),
        scatter(
            [
                Dots(name, found.mark[own], 1e3 * tape[own], f"d{k}")
                for k, (name, own) in enumerate(zip(SIDES, sides, strict=True))
            ],
            "time (s)",
            "gained (ms)",
            f"Paper tape: time gained against {1.0 / found.nominal_period:.6g} Hz, beat by beat, "
            f"from {1e3 * np.nanmin(tape):.3g} ms to {1e3 * np.nanmax(tape):.3g} ms.",
        ),
        class_="half",
    )
    unit, scale = ("°", float(np.degrees(1.0))) if found.angular else ("mm", 1e3)
    swing = scale * found.amplitude
    yield element(
        "div",
        element("h3", "Amplitude"),
        scatter(
            [Dots(name, found.t[own], swing[own], f"d{k}") for k, (name, own) in enumerate(zip(SIDES, sides, strict=True))],
            "time (s)",
            f"amplitude ({unit})",
            f"Amplitude of {len(found)} beats, from {swing[0]:.4g} {unit} at first to {swing[-1]:.4g} {unit} at the end.",
        ),
        class_="half",
    )


def _tape(found: Beats) -> Array:
    """How many seconds each beat comes earlier than one that keeps the nominal frequency, from the first one heard."""
    known = np.flatnonzero(np.isfinite(found.mark))
    if len(known) == 0:
        return np.zeros(len(found))
    half = 0.5 * found.nominal_period
    # Which beat of an even series it is; one that was missed leaves a gap.
    rank = np.round((found.mark - found.mark[known[0]]) / half)
    return np.asarray(rank * half - (found.mark - found.mark[known[0]]))


def _phases(phases: list[Phase]) -> Iterator[Markup]:
    lively = [phase for phase in phases if phase.name in ORDER]
    if not lively:
        return
    parts = []
    for side, title in ((0, SIDES[1]), (1, SIDES[0])):  # beat 1 is the first odd one
        own = [phase for phase in lively if phase.beat % 2 != side]
        rows = [_phase_row(name, [phase for phase in own if phase.name == name]) for name in ORDER]
        rows = [row for row in rows if row]
        if rows:
            lengths = [
                (name, 1e3 * float(np.mean([p.end - p.start for p in own if p.name == name])))
                for name in ORDER
                if any(p.name == name for p in own)
            ]
            told = f"Phases of {title}: " + ", ".join(f"{name} {length:.3g} ms" for name, length in lengths)
            head = ("phase", "lasts (ms)", "balance at (°)", "balance turns (°)", "lever turns (°)", "wheel turns (°)")
            parts += [strip(lengths, "ms", told), table(head, rows, f"{title.capitalize()}: means of {_count(own)} beats")]
    yield _section("phases", "Phases of a beat", *parts)


def _count(own: list[Phase]) -> int:
    return len({phase.beat for phase in own})


def _phase_row(name: str, own: list[Phase]) -> list[Content]:
    if not own:
        return []
    mark = element("i", "", class_=f"chip s{ORDER.index(name)}", aria_hidden="true")
    last = np.array([1e3 * (phase.end - phase.start) for phase in own])
    at = np.degrees([phase.angles[2] for phase in own])
    turns = np.degrees([phase.turns for phase in own])
    return [joined((mark, name)), _mean(last), _mean(at), _mean(turns[:, 2]), _mean(turns[:, 1]), _mean(turns[:, 0])]


def _mean(values: Array) -> str:
    spread = float(np.std(values))
    decimals = min(decimals_for(spread), 4) if spread > 0.0 else 4
    decimals = max(decimals, 2)
    return f"{signed(float(np.mean(values)), decimals)}" + (
        f" ± {spread:.{decimals}f}" if spread >= 0.5 * 10.0**-decimals else ""
    )


def _energy(run: Trajectory) -> Iterator[Markup]:
    shares = energy_shares(run)
    if not shares.went_to:
        return
    entries = [
        (cause, share, f"{signed(100.0 * share, 1)} % · {metric(share * shares.supplied, 'J', 3)}")
        for cause, share in sorted(shares.went_to.items(), key=lambda item: -item[1])
        if abs(share) >= 5e-4
    ]
    power = f", {metric(shares.supplied / run.simulated, 'W', 4)} on average" if run.simulated > 0.0 else ""
    told = "Where the energy went: " + ", ".join(f"{cause} {100.0 * share:.1f} %" for cause, share, _ in entries)
    note = f"{metric(shares.supplied, 'J', 4)} went in{power}. The account closes to {run.energy.get('residual_relative', 0.0):.1g} of it."
    yield _section("energy", "Energy", element("p", note, class_="note"), bars(entries, told))


def _function(numbers: Mapping[str, Any]) -> Iterator[Markup]:
    """The geometry of function, where the results hold it."""
    found = numbers.get("function")
    rows = list(_flat("", found)) if isinstance(found, Mapping) else []
    if rows:
        yield _section("function", "Geometry of function", table(("quantity", "value"), rows, "Measured from the drawing"))


def _flat(path: str, value: Any) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _flat(f"{path}{'.' if path else ''}{key}", item)
    elif isinstance(value, (list, tuple)) and any(isinstance(item, (Mapping, list, tuple)) for item in value):
        for k, item in enumerate(value):
            yield from _flat(f"{path}.{k}", item)
    elif value is not None:
        yield path, f"{value:.6g}" if isinstance(value, float) else str(value)


def _judgement(numbers: Mapping[str, Any]) -> Iterator[Markup]:
    entries = numbers.get("expect") or []
    rows = [
        (
            element("span", {True: "✓ kept", False: "✗ missed", None: "not judged"}[entry["ok"]], class_=f"ok-{entry['ok']}"),
            expected_text(entry),
        )
        for entry in entries
    ]
    warnings = [element("li", f"Warning: {text}.", class_="warning") for text in numbers.get("warnings") or ()]
    warnings += [element("li", f"Note: {text}.") for text in numbers.get("notes") or ()]
    if rows or warnings:
        told = table(("judged", "promise of the scene"), rows, "What the scene promises", numeric=False) if rows else None
        yield _section("judged", "Promises and notes", element("ul", *warnings) if warnings else None, told)


def _parameters(run: Trajectory) -> Iterator[Markup]:
    rows = parameters(run.scene)
    if rows:
        listed = (element("div", element("dt", key), element("dd", value)) for key, value in rows)
        yield _section("parameters", "Parameters", element("dl", *listed))
