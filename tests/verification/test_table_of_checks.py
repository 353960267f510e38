"""Does `watchsim verify` ask what it should, and say it as a table? Runs and numbers are made up."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from watchsim.simulation.stops import Stop
from watchsim.verification import all_checks
from watchsim.verification.all_checks import incline_rows, rows_of, verify, verify_text
from watchsim.verification.benchmarks import Benchmark, Check
from watchsim.verification.compared import Row, compared

SCENE: Any = SimpleNamespace()


def measure(k: int) -> Any:
    return lambda run: run.numbers[k]


def benchmark(name: str, *numbers: float) -> Benchmark:
    checks = tuple(Check(f"{name} {k}", value, measure(k), 0.01) for k, value in enumerate(numbers))
    return Benchmark(name, SCENE, checks, f"source of {name}")


def simulated(monkeypatch: pytest.MonkeyPatch, stop: Stop, *numbers: float) -> None:
    run = SimpleNamespace(stop=stop, numbers=numbers)
    monkeypatch.setattr(all_checks, "simulate", lambda scene: run)


def test_each_number_is_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    simulated(monkeypatch, Stop.DURATION, 3.0, 7.2)
    rows = rows_of([benchmark("first", 3.0, 7.0), benchmark("second", 3.5)])
    assert [(row["name"], row["quantity"], row["expected"], row["got"], row["ok"]) for row in rows] == [
        ("first", "first 0", 3.0, 3.0, True),
        ("first", "first 1", 7.0, 7.2, False),
        ("second", "second 0", 3.5, 3.0, False),
    ]
    assert {row["source"] for row in rows} == {"source of first", "source of second"}


@pytest.mark.parametrize("stop", [stop for stop in Stop if stop not in (Stop.DURATION, Stop.INTERRUPTED)])
def test_a_run_that_gave_up_proves_nothing(monkeypatch: pytest.MonkeyPatch, stop: Stop) -> None:
    simulated(monkeypatch, stop, 3.0)
    (row,) = rows_of([benchmark("first", 3.0)])
    assert math.isnan(row["got"]) and not row["ok"]


def test_an_interruption_ends_all(monkeypatch: pytest.MonkeyPatch) -> None:
    simulated(monkeypatch, Stop.INTERRUPTED, 3.0)
    with pytest.raises(KeyboardInterrupt):
        rows_of([benchmark("first", 3.0)])


@pytest.mark.parametrize(("slow", "steps", "count"), [(False, (5e-5, 5e-6), 2000), (True, (5e-5, 5e-6, 5e-7), 100_000)])
def test_what_is_asked(monkeypatch: pytest.MonkeyPatch, slow: bool, steps: tuple[float, ...], count: int) -> None:
    """All benchmarks, the woodpecker by steps ten times finer each, and so many random problems."""
    monkeypatch.setattr(all_checks, "rows_of", lambda cases: [one.name for one in cases])
    monkeypatch.setattr(all_checks, "woodpecker_rows", lambda steps: [steps])
    monkeypatch.setattr(all_checks, "random_rows", lambda count: [count])
    asked: list[Any] = verify(slow)
    makers = (all_checks.inclines, all_checks.swings, all_checks.hard_cases, all_checks.repeated_impacts, all_checks.edge_cases)
    assert asked == [*(one.name for maker in makers for one in maker()), steps, count]
    names: list[Any] = incline_rows()
    assert names == asked[:4] and all(name.startswith("incline") for name in names)
    assert verify() == verify(False)


ROWS: list[Row] = [
    compared("first", "way [m]", 2.0, 2.5, 0.125, "by hand"),
    compared("first", "speed there [m/s]", -0.75, -0.75, 1e-9, "by hand"),
    compared("second", "turns", 0.0, 3e-4, 1e-3, "counted"),
]


def test_the_table_to_the_letter() -> None:
    """Columns as wide as the longest quantity, a gap between benchmarks, the verdict at the end."""
    assert verify_text(ROWS).splitlines() == [
        "first  (by hand)",
        "                                   expected                     got     error   allowed",
        "  way [m]                                 2                     2.5   2.5e-01   1.2e-01  WRONG",
        "  speed there [m/s]                   -0.75                   -0.75   0.0e+00   1.0e-09  ok",
        "",
        "second  (counted)",
        "                                   expected                     got     error   allowed",
        "  turns                                   0                  0.0003   3.0e-04   1.0e-03  ok",
        "",
        "1 of 3 numbers are WRONG.",
    ]
    assert verify_text(ROWS[1:]).endswith("\n\nAll 2 numbers agree.") and verify_text([]) == "All 0 numbers agree."


@pytest.mark.parametrize(
    ("expected", "got", "error"), [(4.0, 3.0, 0.25), (-4.0, -5.0, 0.25), (0.0, -0.3, 0.3), (-0.5, 0.5, 2.0), (1e-9, 3e-9, 2.0)]
)
def test_errors_are_relative_but_where_nothing_is_expected(expected: float, got: float, error: float) -> None:
    for tolerance, ok in ((0.999 * error, False), (1.001 * error, True)):
        row = compared("a", "b", expected, got, tolerance, "c")
        assert row["error"] == pytest.approx(error, rel=1e-12) and row["ok"] is ok
        assert (row["expected"], row["got"], row["tolerance"]) == (expected, got, tolerance)
