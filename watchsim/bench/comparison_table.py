"""How is the comparison put into words?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from watchsim.bench.engines.world import MODULES

COLUMNS = ("setting", "time, s per simulated s", "spread", "error of amplitude", "of rate", "of place")


def table(rows: Sequence[Mapping[str, Any]], references: Sequence[Mapping[str, Any]]) -> str:
    """In Markdown: for each scene what counts as true, then a line for each setting of each engine."""
    parts = []
    for reference in references:
        own = [row for row in rows if row["scene"] == reference["scene"]]
        parts += [f"### {reference['scene']}", "", truth_text(reference), "", *_lines(own), ""]
    return "\n".join(parts)


def truth_text(reference: Mapping[str, Any]) -> str:
    """The reference, and what confirms it."""
    truth = reference["truth"]
    values = []
    if truth["amplitude"] is not None:
        values = [f"amplitude {truth['amplitude']:.6f}°", f"rate {truth['rate']:.6f} s/d"]
    if truth["x"] is not None:
        values = [f"x = {truth['x']:.12f} m"]
    off = [
        f"{reference[name]:.1g}{unit}"
        for name, unit in (("amplitude_off_deg", "°"), ("rate_off_s_per_d", " s/d"), ("state_off_m", " m"))
        if reference[name] is not None
    ]
    return f"Reference: {', '.join(values)} ({reference['source']}). {reference['confirmed_by']}: differs by {', '.join(off)}."


def _lines(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    head = "| engine | " + " | ".join(COLUMNS) + " |"
    return [head, "|---" * (len(COLUMNS) + 1) + "|", *(_line(row) for row in rows)]


def _line(row: Mapping[str, Any]) -> str:
    step = row["method"] in MODULES or row["method"] == "moreau"
    setting = f"step {1e6 * row['setting']:g} µs" if step else f"tolerance {row['setting']:.0e}"
    time, least, most = row["wall_s_per_simulated_s"], row["wall_least"], row["wall_largest"]
    errors = [
        f"{row[name]:.1e}{unit}" if row[name] is not None else ""
        for name, unit in (("error_amplitude_deg", "°"), ("error_rate_s_per_d", " s/d"), ("error_state", " m"))
    ]
    if row["note"]:
        errors = [row["note"], "", ""]
    engine = f"{row['method']} {row['version']}".strip()
    spread = f"{least:.3g} to {most:.3g} ({row['repeats']} {'run' if row['repeats'] == 1 else 'runs'})"
    cells = (engine, setting, f"{time:.3g}", spread, *errors)
    return "| " + " | ".join(cells) + " |"
