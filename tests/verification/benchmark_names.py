"""Which benchmarks with exact solutions are there, by name, and what does the published page say of them?"""

import csv
from pathlib import Path

from watchsim.verification.benchmarks import Benchmark, inclines, swings
from watchsim.verification.hard_cases import edge_cases, hard_cases
from watchsim.verification.repeated_impacts import repeated_impacts

MAKERS = (inclines, swings, hard_cases, repeated_impacts, edge_cases)
PLACES = {case.name: (maker, k) for maker in MAKERS for k, case in enumerate(maker())}
NAMES = list(PLACES)


def benchmark_of(name: str) -> Benchmark:
    """Made anew by whoever asks: then it counts as reached by that test."""
    maker, k = PLACES[name]
    return maker()[k]


TABLE = Path(__file__).resolve().parents[2] / "docs" / "reports" / "stability.csv"
Published = dict[str, tuple[float, float, float]]  # quantity -> (expected, got, allowed)


def published() -> dict[str, Published]:
    """By case, with a capital."""
    found: dict[str, Published] = {}
    with TABLE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            case = found.setdefault(row["name"][0].upper() + row["name"][1:], {})
            case[row["quantity"]] = (float(row["expected"]), float(row["got"]), float(row["tolerance"]))
    return found


PUBLISHED = published()
