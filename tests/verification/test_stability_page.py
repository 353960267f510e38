"""Does `watchsim verify` still ask what its published page says, case by case, with the errors that the page allows?

The numbers behind the page are docs/reports/stability.csv. Nothing is simulated: the expected numbers stand in the benchmarks.
"""

from __future__ import annotations

import pytest
from benchmark_names import NAMES, PUBLISHED, benchmark_of

from watchsim.verification.benchmarks import Benchmark, Check


@pytest.mark.parametrize("name", NAMES)
def test_the_case_is_the_published_one(name: str) -> None:
    case = benchmark_of(name)
    rows = PUBLISHED[case.name[0].upper() + case.name[1:]]
    assert list(rows) == [check.quantity for check in case.checks]
    for check in case.checks:
        expected, _, allowed = rows[check.quantity]
        digits = 1e-9 if abs(expected) >= 1e-6 else 0.05  # as the page prints numbers
        assert check.expected == pytest.approx(expected, rel=digits, abs=0.0)
        assert allowed_of(check, case) == pytest.approx(allowed, rel=0.06, abs=0.0)


def allowed_of(check: Check, case: Benchmark) -> float:
    """What the page can say: one digit."""
    return float(f"{check.tolerance:.0e}") if case.name.startswith("tooth at a corner") else check.tolerance


def test_every_case_of_the_page_is_still_asked() -> None:
    asked = {name[0].upper() + name[1:] for name in NAMES}
    others = {name for name in PUBLISHED if name not in asked}
    assert all(name.startswith(("Woodpecker", "Impact of one contact", "Complementarity problems")) for name in others)
    assert len(others) == 6
