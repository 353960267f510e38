"""Which benchmarks with exact solutions are there, by name, and what does the published page say of them?"""

from __future__ import annotations

import re
from pathlib import Path

from watchsim.verification.benchmarks import Benchmark, inclines, swings
from watchsim.verification.edge_cases import edge_cases
from watchsim.verification.hard_cases import hard_cases
from watchsim.verification.repeated_impacts import repeated_impacts

MAKERS = (inclines, swings, hard_cases, repeated_impacts, edge_cases)
PLACES = {case.name: (maker, k) for maker in MAKERS for k, case in enumerate(maker())}
NAMES = list(PLACES)


def benchmark_of(name: str) -> Benchmark:
    """Made anew by whoever asks: then it counts as reached by that test."""
    maker, k = PLACES[name]
    return maker()[k]


PAGE = Path(__file__).resolve().parents[2] / "docs" / "reports" / "stability.md"
Published = dict[str, tuple[float, float, float]]  # quantity -> (expected, got, allowed)


def published() -> dict[str, Published]:
    """By case, as the page names it."""
    found: dict[str, Published] = {}
    for part in re.split(r"^### ", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        rows = [line.strip("| ").split(" | ") for line in part.splitlines() if line.startswith("| ")][1:]
        found[part.splitlines()[0]] = {row[0]: (float(row[1]), float(row[2]), float(row[4])) for row in rows}
    return found


PUBLISHED = published()
