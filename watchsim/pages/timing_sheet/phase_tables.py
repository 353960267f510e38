"""What does the sheet say of the phases of a beat?"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from watchsim.analysis.timing.phases import Phase
from watchsim.pages.charts import strip
from watchsim.pages.html import Content, Markup, element, joined, section, table
from watchsim.render.frame.marks.readouts import decimals_for, signed
from watchsim.simulation.record.trajectory import Array

ORDER = ("unlock", "catch-up", "impulse", "drop", "run to banking", "recoil")
COLOURS = (0, 1, 2, 3, 4, 0)
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


def phase_tables(phases: list[Phase]) -> Iterator[Markup]:
    """The section, with a strip of time and a table for either direction of the balance; nothing where no phases are known."""
    parts: list[Markup] = []
    for odd, title in SIDES:
        kinds = _kinds([one for one in phases if one.beat % 2 == odd])
        if not kinds:
            continue
        lengths = [(kind.name, float(np.mean(kind.lasts)), kind.number) for kind in kinds]
        told = f"Phases of {title}: {', '.join(f'{name} {length:.3g} ms' for name, length, _ in lengths)}"
        count = max(len(kind.lasts) for kind in kinds)
        anchor = all(np.array_equal(kind.turns[:, 1], kind.turns[:, 2]) for kind in kinds)  # the oscillator is its own lever
        shown = [k for k, head in enumerate(HEAD) if not (anchor and head.startswith("lever"))]
        rows = [[kind.row()[k] for k in shown] for kind in kinds]
        heads = [HEAD[k] for k in shown]
        parts += [strip(lengths, "ms", told), table(heads, rows, f"{title.capitalize()}: means of {count} beats")]
    if parts:
        yield section("phases", "Phases of a beat", *parts)


def _kinds(phases: list[Phase]) -> list[_Kind]:
    """In the order of a beat; an impulse apart for what it acts on. What comes several times in a beat is added up."""
    first: dict[tuple[str, str], dict[int, list[Phase]]] = {}
    for one in phases:
        if one.name in ORDER:
            first.setdefault((one.name, one.on), {}).setdefault(one.beat, []).append(one)
    found = []
    for (name, on), beats in sorted(first.items(), key=lambda item: ORDER.index(item[0][0])):
        own = list(beats.values())
        lasts = np.array([1e3 * sum(one.end - one.start for one in beat) for beat in own])
        turns = np.degrees([np.sum([one.turns for one in beat], axis=0) for beat in own])
        at = np.degrees([beat[0].angles[2] for beat in own])
        found.append(_Kind(f"{name} on {on}" if on else name, COLOURS[ORDER.index(name)], lasts, at, turns))
    return found


def _mean(values: Array) -> str:
    """With as many decimals as the scatter justifies, two to four."""
    spread = float(np.std(values))
    decimals = max(2, min(decimals_for(spread), 4)) if spread > 0.0 else 4
    scatter = f" ± {spread:.{decimals}f}" if spread >= 0.5 * 10.0**-decimals else ""
    return f"{signed(float(np.mean(values)), decimals)}{scatter}"
