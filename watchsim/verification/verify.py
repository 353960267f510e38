"""Do the benchmarks with exact solutions come out?"""

from __future__ import annotations

import math

from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop
from watchsim.simulation.trajectory import Trajectory
from watchsim.verification.benchmarks import Benchmark, Check, inclines, swings
from watchsim.verification.checks import Row, compared
from watchsim.verification.hard_cases import edge_cases, hard_cases
from watchsim.verification.random_problems import FEW, MANY, random_rows
from watchsim.verification.repeated_impacts import repeated_impacts
from watchsim.verification.woodpecker import SLOW_STEPS, STEPS, woodpecker_rows


def verify(slow: bool = False) -> list[Row]:
    """All benchmarks: rows {name, quantity, expected, got, error, tolerance, ok, source}; `slow`: with the long ones.

    `error` and `tolerance` are relative to the expected value, absolute where that is zero.
    """
    rows = incline_rows()
    for scenes in (swings, hard_cases, repeated_impacts, edge_cases):
        rows += rows_of([*scenes()])
    return [*rows, *woodpecker_rows(SLOW_STEPS if slow else STEPS), *random_rows(MANY if slow else FEW)]


def incline_rows() -> list[Row]:
    """The disc that bounces, slides and rolls down an incline, with four frictions."""
    return rows_of(inclines())


def rows_of(benchmarks: list[Benchmark]) -> list[Row]:
    """Simulate each benchmark once and compare all its numbers."""
    rows = []
    for benchmark in benchmarks:
        run = simulate(benchmark.scene)
        if run.stop == Stop.INTERRUPTED:
            raise KeyboardInterrupt
        rows += [_row(benchmark.name, benchmark.source, check, run) for check in benchmark.checks]
    return rows


def _row(name: str, source: str, check: Check, run: Trajectory) -> Row:
    """A run that gave up before the end proves nothing: nan."""
    got = check.measure(run) if run.stop == Stop.DURATION else math.nan
    return compared(name, check.quantity, check.expected, got, check.tolerance, source)


def verify_text(rows: list[Row]) -> str:
    """The rows as a table for people, grouped by name, and a last line with the verdict."""
    width = max((len(row["quantity"]) for row in rows), default=0)
    lines: list[str] = []
    name = None
    for row in rows:
        if row["name"] != name:
            name = row["name"]
            lines += ["", f"{name}  ({row['source']})", _header(width)]
        verdict = "ok" if row["ok"] else "WRONG"
        lines.append(
            f"  {row['quantity']:<{width}}  {row['expected']:>22.15g}  {row['got']:>22.15g}  "
            f"{row['error']:>8.1e}  {row['tolerance']:>8.1e}  {verdict}"
        )
    wrong = sum(not row["ok"] for row in rows)
    lines += ["", f"All {len(rows)} numbers agree." if not wrong else f"{wrong} of {len(rows)} numbers are WRONG."]
    return "\n".join(lines[1:])


def _header(width: int) -> str:
    return f"  {'':<{width}}  {'expected':>22}  {'got':>22}  {'error':>8}  {'allowed':>8}"
