"""What does the timing sheet of a page say? The numbers of summary.json, in a watchmaker's units and order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from watchsim.analysis.energy import energy_shares
from watchsim.analysis.headlines import expected_text, headlines
from watchsim.analysis.timing.phases import each_phase
from watchsim.pages.charts import bars
from watchsim.pages.html import Markup, element, joined, section, table
from watchsim.pages.timing_sheet.function_tables import function_tables
from watchsim.pages.timing_sheet.parameters import parameters
from watchsim.pages.timing_sheet.phase_tables import phase_tables
from watchsim.pages.timing_sheet.timekeeping import timekeeping
from watchsim.render.frame.marks.readouts import signed
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.units import metric

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
    sections = (
        *timekeeping(run, numbers),
        *phase_tables(each_phase(run)),
        *function_tables(run.scene),
        *_energy(run),
        *_judgement(numbers),
        *_parameters(run),
        section("words", "The run in words", element("pre", headlines(run, numbers), tabindex=0)),
    )
    return joined(sections)


def verdict(numbers: Mapping[str, Any]) -> Markup | None:
    """A line in colour: what is to be thought of this watch; None where nothing keeps time."""
    word, message = numbers.get("verdict"), numbers.get("verdict_message")
    if word is None and numbers.get("stopped"):
        word, message = "stops", numbers.get("stopped_message")
    if word is None:
        return None
    look, told = VERDICTS.get(str(word), ("open", str(word).capitalize()))
    more = str(message or "")
    if more.casefold().startswith(told.casefold()):  # said once is enough
        more = more[len(told) :]
    elif more:
        more = f" {more}"
    return element("p", element("strong", told), more or None, class_=f"verdict {look}")


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
    told = "Where the energy went: " + ", ".join(f"{cause} {100.0 * share:.1f} %" for cause, share, _ in entries)
    closes = f"The account closes to {run.energy.get('residual_relative', 0.0):.1g} of it."
    note = f"{metric(shares.supplied, 'J', 4)} went in{power}. {closes}"
    yield section("energy", "Energy", element("p", note, class_="note"), bars(entries, told))


def _judgement(numbers: Mapping[str, Any]) -> Iterator[Markup]:
    """What the scene promises, and what is to be doubted."""
    entries = numbers.get("expect") or []
    rows = [(element("span", JUDGED[one["ok"]], class_=f"ok-{one['ok']}"), expected_text(one)) for one in entries]
    warnings = [element("li", f"Warning: {text}.", class_="warning") for text in numbers.get("warnings") or ()]
    warnings += [element("li", f"Note: {text}.") for text in numbers.get("notes") or ()]
    if rows or warnings:
        told = table(("judged", "promise of the scene"), rows, "What the scene promises", numeric=False) if rows else None
        yield section("judged", "Promises and notes", element("ul", *warnings) if warnings else None, told)


def _parameters(run: Trajectory) -> Iterator[Markup]:
    rows = parameters(run.scene)
    if rows:
        listed = (element("div", element("dt", _breakable(key)), element("dd", value)) for key, value in rows)
        yield section("parameters", "Parameters", element("dl", *listed))


def _breakable(key: str) -> Markup:
    """A dotted key that a narrow column may break after a dot, and nowhere else."""
    head, *tail = key.split(".")
    return joined((head, *((Markup(".<wbr/>"), part) for part in tail)))
