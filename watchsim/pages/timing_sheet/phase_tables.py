"""What does the sheet say of the phases of a beat?"""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from watchsim.analysis.timing.phases import Phase
from watchsim.pages.charts import strip
from watchsim.pages.html import Content, Markup, element, joined, section, table
from watchsim.render.frame.marks.readouts import decimals_for, signed
from watchsim.simulation.record.trajectory import Array

ORDER = ("unlock", "catch-up", "impulse", "drop", "run to banking")
SIDES = ((1, "odd beats"), (0, "even beats"))
HEAD = ("phase", "lasts (ms)", "balance at (°)", "balance turns (°)", "lever turns (°)", "wheel turns (°)")


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


def phase_tables(phases: Iterable[Phase]) -> Iterator[Markup]:
    """The section, with a strip of time and a table for either direction of the balance; nothing where no phases are known."""
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
        told = f"Phases of {title}: {', '.join(f'{name} {length:.3g} ms' for name, length, _ in lengths)}"
        count = max(len(kind.lasts) for kind in kinds)
        rows = [kind.row() for kind in kinds]
        parts += [strip(lengths, "ms", told), table(HEAD, rows, f"{title.capitalize()}: means of {count} beats")]
    if parts:
        yield section("phases", "Phases of a beat", *parts)


def _kinds(sums: dict[tuple[str, str], _Sums]) -> list[_Kind]:
    """In the order of a beat; an impulse apart for what it acts on."""
    found = []
    for (name, on), own in sorted(sums.items(), key=lambda item: ORDER.index(item[0][0])):
        turns = np.degrees(np.array(own.turns).reshape(-1, 3))
        title = f"{name} on {on}" if on else name
        found.append(_Kind(title, ORDER.index(name), np.array(own.lasts), np.degrees(np.array(own.at)), turns))
    return found


def _mean(values: Array) -> str:
    """With as many decimals as the scatter justifies, two to four."""
    spread = float(np.std(values))
    decimals = max(2, min(decimals_for(spread), 4)) if spread > 0.0 else 4
    scatter = f" ± {spread:.{decimals}f}" if spread >= 0.5 * 10.0**-decimals else ""
    return f"{signed(float(np.mean(values)), decimals)}{scatter}"
