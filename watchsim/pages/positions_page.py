"""How does a table of positions become one page that can be sent?"""

from __future__ import annotations

import json
from pathlib import Path

from watchsim.pages.html import Content, element, section, table
from watchsim.pages.tolerance_page import drawn, written
from watchsim.render.positions_plot import plot_positions
from watchsim.studies.positions import Positions, positions_of
from watchsim.studies.study_report import POSITION_HEAD, SUMMARY, criteria_rows, poise_words, positions_rows, winding

FILE = "positions.json"
SIZES = ("", "s/d", "over 20 mm", "", "up to 20 mm", "")  # of the movement: the two categories


def positions_page(folder: str | Path, path: str | Path) -> Path:
    """Write the study in a folder as one self-contained HTML file; ValueError for a path with another ending."""
    found = positions_of(json.loads((Path(folder) / FILE).read_text(encoding="utf-8")))
    parts = [
        section(
            "readings", "What a timing machine shows", *_readings(found), element("p", f"{poise_words(found)}.", class_="note")
        ),
        section("dial", "Over the hour that is up", drawn(plot_positions(found), "rate and amplitude on dials")),
        section("iso3159", "ISO 3159", table(SIZES, criteria_rows(found), "criteria of a chronometer", numeric=False)),
    ]
    return written(found.title, parts, path)


def _readings(found: Positions) -> list[Content]:
    words = "; ".join(f"{name}: {what}" for name, what in SUMMARY.items())
    return [
        table(
            (f"{state[0]:g} °C, {winding(state)}", *POSITION_HEAD),
            positions_rows(found, [state]),
            words if state == found.states[0] else "",
        )
        for state in found.states
    ]
