"""What does the timing sheet of a page say? The numbers of summary.json, in a watchmaker's units and order."""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from watchsim.analysis.flows import energy_shares
from watchsim.analysis.headlines import AVERAGED, expected_text, headlines, readings
from watchsim.analysis.phases import Phase, each_phase
from watchsim.analysis.timing import Beats, beats
from watchsim.escapement.function_report import Table, measured, pallet_names, tables
from watchsim.escapement.measure import measure
from watchsim.pages.charts import Dots, bars, scatter, strip
from watchsim.pages.html import Content, Markup, element, joined, section, table
from watchsim.render.marks import spaced
from watchsim.render.palette import ENERGIES
from watchsim.scene.keys import in_words
from watchsim.scene.roles import roles, swings
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.units import decimals_for, metric, signed, true_minus


def function_tables(scene: Scene) -> Iterator[Markup]:
    """The section, measured by turning the parts of the scene by hand as `check` does; nothing of a scene without stones."""
    found = measure(scene)
    if found.pallets is None or found.parts is None:
        return
    note = f"Measured on the drawing: {measured(found)}."
    missing = [element("p", f"Not measured: {what}, {why}.", class_="note") for what, why in found.missing]
    measures = element("div", *(_table(one, pallet_names(found.parts)) for one in tables(found)), class_="columns")
    yield section("function", "Geometry of function", element("p", note, class_="note"), measures, *missing)


def _table(one: Table, pallets: tuple[str, ...]) -> Markup:
    worst = any(row.worst for row in one.rows)
    rows: list[list[Content]] = []
    for row in one.rows:
        words = row.words.strip()
        name = element("span", words, class_="of") if row.words != words else words
        values = ["–" if value == "-" else value.replace("-", "−") for value in (*row.values, "", "")[:2]]
        rows.append([name, *values, *([row.worst] if worst else [])])
    head = ("quantity", *pallets, *(["worst tooth"] if worst else []))
    return table(head, rows, (one.title or f"{pallets[0].split()[1]}s and wheel").capitalize())


LONG = 6  # entries of a list that are written out
LEFT_OUT = ("lock", "expect")  # shown elsewhere
ROWS = 400


def parameters(scene: Scene) -> list[tuple[str, str]]:
    """(dotted path, value) of everything the scene file says, in its order; as in `--set`."""
    rows = [row for key, value in scene.source.items() if key not in LEFT_OUT for row in _rows(key, value)]
    if len(rows) > ROWS:
        return [*rows[:ROWS], ("…", f"{len(rows) - ROWS} more, in the scene file")]
    return rows


def _rows(path: str, value: Any) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _rows(f"{path}.{key}", item)
    elif _is_list(value) and any(isinstance(item, Mapping) for item in value):
        for number, item in enumerate(value):
            yield from _rows(f"{path}.{number}", item)
    else:
        yield path, _as_text(value)


def _short(value: str) -> str:
    """Numbers worked out by a program have sixteen digits, of which a reader needs seven."""
    return re.sub(r"\d+\.\d{7,}", lambda found: f"{float(found[0]):.7g}", value)


def _as_text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if not _is_list(value):
        return str(value)
    shown = ", ".join(_as_text(item) for item in value[:LONG])
    return shown if len(value) <= LONG else f"{shown}, … ({len(value)} in all)"


def _is_list(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


ORDER = ("unlock", "catch-up", "impulse", "drop", "run to banking", "recoil")
COLOURS = (0, 1, 2, 3, 4, 0)
SIDES = ((1, "odd beats"), (0, "even beats"))
AGAIN = 8  # the colour of an impulse that follows another


@dataclass(frozen=True)
class _Kind:
    """A phase over its beats, one element a beat: how long it lasts (ms), where it finds the balance and how far balance, lever
    and wheel turn in it (degrees)."""

    name: str
    number: int
    lasts: Array
    at: Array
    turns: Array

    def row(self) -> list[Content]:
        """Means and scatter."""
        mark = element("i", "", class_=f"chip s{self.number}", aria_hidden="true")
        wheel, lever, balance = self.turns.T
        return [joined((mark, self.name)), _mean(self.lasts), _mean(self.at), _mean(balance), _mean(lever), _mean(wheel)]


@dataclass
class _Sums:
    """A phase beat by beat, as it comes: what comes several times in a beat is added up. A long run has a great many."""

    beat: int = 0
    lasts: array[float] = field(default_factory=lambda: array("d"))
    at: array[float] = field(default_factory=lambda: array("d"))
    turns: array[float] = field(default_factory=lambda: array("d"))  # three a beat

    def add(self, one: Phase) -> None:
        if one.beat != self.beat:
            self.beat = one.beat
            self.lasts.append(0.0)
            self.at.append(one.angles[2])
            self.turns.extend((0.0, 0.0, 0.0))
        self.lasts[-1] += 1e3 * (one.end - one.start)
        for place, turn in zip((-3, -2, -1), one.turns, strict=True):
            self.turns[place] += turn


def phase_tables(phases: Iterable[Phase], oscillator: str = "balance") -> Iterator[Markup]:
    """The section, with a strip of time and a table for either direction of the swing; nothing where no phases are known."""
    columns = ("phase", "lasts (ms)", f"{oscillator} at (°)", f"{oscillator} turns (°)", "lever turns (°)", "wheel turns (°)")
    sums: dict[int, dict[tuple[str, str], _Sums]] = {odd: {} for odd, _ in SIDES}
    for one in phases:
        if one.name in ORDER:
            sums[one.beat % 2].setdefault((one.name, one.on), _Sums()).add(one)
    parts: list[Markup] = []
    for odd, title in SIDES:
        kinds = _kinds(sums[odd])
        if not kinds:
            continue
        lengths = [(kind.name, float(np.mean(kind.lasts)), kind.number) for kind in kinds]
        words = f"Phases of {title}: {', '.join(f'{name} {length:.3g} ms' for name, length, _ in lengths)}"
        count = max(len(kind.lasts) for kind in kinds)
        anchor = all(np.array_equal(kind.turns[:, 1], kind.turns[:, 2]) for kind in kinds)  # the oscillator is its own lever
        shown = [k for k, head in enumerate(columns) if not (anchor and head.startswith("lever"))]
        rows = [[kind.row()[k] for k in shown] for kind in kinds]
        heads = [columns[k] for k in shown]
        what = f"means of {count} beats, in brackets their scatter" if count > 1 else "one"
        parts += [strip(lengths, "ms", words), table(heads, rows, f"{title.capitalize()}: {what}")]
    if parts:
        yield section("phases", "Phases of a beat", *parts)


def _kinds(sums: dict[tuple[str, str], _Sums]) -> list[_Kind]:
    """In the order of a beat; an impulse apart for what it acts on."""
    found: list[_Kind] = []
    for (name, on), own in sorted(sums.items(), key=lambda item: ORDER.index(item[0][0])):
        turns = np.degrees(np.array(own.turns).reshape(-1, 3))
        title, colour = f"{name} on {on}" if on else name, COLOURS[ORDER.index(name)]
        if name == "impulse" and any(kind.number == colour for kind in found):
            colour = AGAIN
        found.append(_Kind(title, colour, np.array(own.lasts), np.degrees(np.array(own.at)), turns))
    return found


def _mean(values: Array) -> str:
    """With as many decimals as the scatter justifies, two to four."""
    spread = float(np.std(values))
    decimals = max(2, min(decimals_for(spread), 4)) if spread > 0.0 else 4
    scatter = f" ({spread:.{decimals}f})" if spread >= 0.5 * 10.0**-decimals else ""
    return f"{signed(float(np.mean(values)), decimals)}{scatter}"


def timekeeping(run: Trajectory, numbers: Mapping[str, Any]) -> Iterator[Markup]:
    """The section; nothing where nothing swings, or there is nothing to say of it."""
    cards = [_card(*reading) for reading in readings(numbers)]
    if not cards and not swings(run.scene):
        return
    note = None
    if cards and numbers.get("window_s"):
        start, end = numbers["window_s"]
        words = f"Means over {start:.4g} s to {end:.4g} s. Scatter: how much the beats of that time scatter and drift"
        note = element("p", f"{words}{_computed(numbers)}.", class_="note")
    message = numbers.get("timing_message")
    parts = (
        element("dl", *cards, class_="cards") if cards else None,
        element("p", message, class_="note") if message else None,
        note,
        *_charts(run, beats(run)),
    )
    if any(parts):
        yield section("timing", "Timing", *parts)


def _computed(numbers: Mapping[str, Any]) -> str:
    """The error of the computation beside the scatter, where a second run gave it."""
    found = numbers.get("error_bars")
    if not found or not found.get("complete"):
        return ""
    moved = [f"{found['differences'][name]:.1g}{unit}" for name, _, unit in AVERAGED if name in found["differences"]]
    return f"; a more exact run moved them by {', '.join(moved)}" if moved else ""


def _card(label: str, value: str, below: str | None) -> Markup:
    small = element("span", below) if below else None
    return element("div", element("dt", label), element("dd", element("b", value), small))


def _charts(run: Trajectory, found: Beats) -> Iterator[Markup]:
    """Paper tape and amplitude of all beats."""
    if len(found) < 3:
        return
    tape = 1e3 * _tape(found)
    least, most = (float(bound(tape)) for bound in (np.nanmin, np.nanmax))
    words = f"Time gained against {1.0 / found.nominal_period:.6g} Hz, beat by beat: from {least:.3g} ms to {most:.3g} ms."
    yield _half("Paper tape", scatter(both_ways(found, found.mark, tape), "time (s)", "gained (ms)", words))
    unit, scale = ("°", float(np.degrees(1.0))) if found.angular else ("mm", 1e3)
    swing = scale * found.amplitude
    words = f"Amplitude of {len(found)} beats: {swing[0]:.4g} {unit} at first, {swing[-1]:.4g} {unit} at the end."
    yield _half("Amplitude", scatter(both_ways(found, found.t, swing), "time (s)", f"amplitude ({unit})", words))


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


VERDICTS = {
    "ticks": ("good", "The watch ticks"),
    "stops": ("bad", "The watch stops"),
    "knocks": ("bad", "The watch knocks"),
    "trips": ("bad", "The escapement trips"),
    "overbanks": ("bad", "The lever overbanks"),
    "backwards": ("bad", "The wheel runs backwards"),
    "unsettled": ("open", "Not settled yet"),
}
JUDGED = {True: "✓ kept", False: "✗ missed", None: "not judged"}


def sheet(run: Trajectory, numbers: Mapping[str, Any]) -> Markup:
    """All sections of the sheet that this run has something to say to."""
    parts = (
        timekeeping(run, numbers),
        phase_tables(each_phase(run), spaced(roles(run.scene).oscillator or "balance")),
        function_tables(run.scene),
        _energy(run),
    )
    lines = (element("span", line) for line in headlines(run, numbers).splitlines())
    words = section("words", "The run in words", element("pre", *lines))
    return joined((*parts, _judgement(numbers), _parameters(run), words))


def verdict(numbers: Mapping[str, Any]) -> Markup | None:
    """A line in colour: what is to be thought of this watch; None where nothing keeps time."""
    word, message = numbers.get("verdict"), numbers.get("verdict_message")
    if word is None and numbers.get("stopped"):
        word, message = "stops", numbers.get("stopped_message")
    if word is None:
        return None
    look, words = VERDICTS.get(str(word), ("open", str(word).capitalize()))
    more = str(message or "")
    if "the clock" in more:
        words = words.replace("watch", "clock")
    if more.casefold().startswith(words.casefold()):  # said once is enough
        more = more[len(words) :]
    elif more:
        more = f" {more}"
    return element("p", element("strong", words), more or None, class_=f"verdict {look}")


def _energy(run: Trajectory) -> Iterator[Markup]:
    """The ledger as bars."""
    shares = energy_shares(run)
    if not shares.went_to:
        return
    entries = [
        (cause, share, f"{signed(100.0 * share, 1)} % · {metric(share * shares.supplied, 'J', 3)}")
        for cause, share in sorted(shares.went_to.items(), key=lambda item: -item[1])
        if abs(share) >= 5e-4
    ]
    power = f", {metric(shares.supplied / run.simulated, 'W', 4)} on average" if run.simulated > 0.0 else ""
    words = "Where the energy went: " + ", ".join(f"{cause} {100.0 * share:.1f} %" for cause, share, _ in entries)
    closes = f"The account closes to {run.energy.get('residual_relative', 0.0):.1g} of it."
    note = f"{metric(shares.supplied, 'J', 4)} went in{power}. {closes}"
    yield section("energy", "Energy", element("p", note, class_="note"), bars(entries, words, ENERGIES))


def _judgement(numbers: Mapping[str, Any]) -> Iterator[Markup]:
    """What the scene promises, and what is to be doubted."""
    entries = numbers.get("expect") or []
    rows = [(element("span", JUDGED[one["ok"]], class_=f"ok-{one['ok']}"), expected_text(one)) for one in entries]
    warnings = [element("li", f"Warning: {text}.", class_="warning") for text in numbers.get("warnings") or ()]
    warnings += [element("li", f"Note: {text}.") for text in numbers.get("notes") or ()]
    if rows or warnings:
        judged = table(("judged", "promise of the scene"), rows, "What the scene promises", numeric=False) if rows else None
        yield section("judged", "Promises and notes", element("ul", *warnings) if warnings else None, judged)


def _parameters(run: Trajectory) -> Iterator[Markup]:
    rows = parameters(run.scene)
    if abs(run.simulated - run.scene.duration) > 1e-9 * run.scene.duration:
        rows = [(key, value) for key, value in rows if key != "run.duration"]
        rows.append(("run.duration", f"{run.simulated:.9g} s simulated; {run.scene.duration:.9g} s in the scene"))
    if rows:
        listed = (
            element("div", element("dt", in_words(key), title=key), element("dd", true_minus(_short(value)), title=value))
            for key, value in rows
        )
        yield section("parameters", "Parameters", element("dl", *listed))
