"""Which benchmarks with exact solutions are there, by name?"""

from __future__ import annotations

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
