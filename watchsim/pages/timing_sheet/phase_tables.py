"""What does the sheet say of the phases of a beat?"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from watchsim.analysis.timing.phases import Phase
from watchsim.pages.charts import strip
from watchsim.pages.html import Content, Markup, element, joined, section, table
from watchsim.render.frame.marks.readouts import decimals_for, signed
from watchsim.simulation.record.trajectory import Array

ORDER = ("unlock", "catch-up", "impulse", "drop", "run to banking")
SIDES = ((1, "odd beats"), (0, "even beats"))
HEAD = ("phase", "lasts (ms)", "balance at (°)", "balance turns (°)", "lever turns (°)", "wheel turns (°)")


def phase_tables(phases: list[Phase]) -> Iterator[Markup]:
    """The section, with a strip of time and a table for either direction of the balance; nothing where no phases are known."""
    parts: list[Markup] = []
    for odd, title in SIDES:
        by_name = {name: [one for one in phases if one.name == name and one.beat % 2 == odd] for name in ORDER}
        by_name = {name: own for name, own in by_name.items() if own}
        if not by_name:
            continue
        lengths = [(name, 1e3 * float(np.mean([one.end - one.start for one in own]))) for name, own in by_name.items()]
        told = f"Phases of {title}: {', '.join(f'{name} {length:.3g} ms' for name, length in lengths)}"
        rows = [_phase_row(name, own) for name, own in by_name.items()]
        count = max(len(own) for own in by_name.values())
        parts += [strip(lengths, "ms", told), table(HEAD, rows, f"{title.capitalize()}: means of {count} beats")]
    if parts:
        yield section("phases", "Phases of a beat", *parts)


def _phase_row(name: str, own: list[Phase]) -> list[Content]:
    """Means and scatter of one phase over its beats."""
    mark = element("i", "", class_=f"chip s{ORDER.index(name)}", aria_hidden="true")
    last = np.array([1e3 * (phase.end - phase.start) for phase in own])
    at = np.degrees([phase.angles[2] for phase in own])
    turns = np.degrees([phase.turns for phase in own])
    return [joined((mark, name)), _mean(last), _mean(at), _mean(turns[:, 2]), _mean(turns[:, 1]), _mean(turns[:, 0])]


def _mean(values: Array) -> str:
    """With as many decimals as the scatter justifies, two to four."""
    spread = float(np.std(values))
    decimals = max(2, min(decimals_for(spread), 4)) if spread > 0.0 else 4
    scatter = f" ± {spread:.{decimals}f}" if spread >= 0.5 * 10.0**-decimals else ""
    return f"{signed(float(np.mean(values)), decimals)}{scatter}"
