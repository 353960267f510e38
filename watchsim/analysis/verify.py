"""Do the benchmarks with exact solutions come out?"""

from __future__ import annotations

import math

import numpy as np

from watchsim.analysis.benchmarks import Benchmark, Check, inclines, swings
from watchsim.analysis.compared import Row, compared
from watchsim.analysis.hard_cases import hard_cases
from watchsim.analysis.repeated_impacts import repeated_impacts
from watchsim.analysis.woodpecker.rows import woodpecker_rows
from watchsim.dynamics.lcp import OK, lcp_work, solve_lcp
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop
from watchsim.simulation.trajectory import Trajectory

LCP_PROBLEMS, LCP_SIZE = 1000, 9


def verify() -> list[Row]:
    """All benchmarks: rows {name, quantity, expected, got, error, tolerance, ok, source}.

    `error` and `tolerance` are relative to the expected value, absolute where that is zero.
    """
    return [*incline_rows(), *rows_of([*swings(), *hard_cases(), *repeated_impacts()]), *woodpecker_rows(), *lcp_rows()]


def incline_rows() -> list[Row]:
    """The disc that bounces, slides and rolls down an incline, with three frictions."""
    return rows_of(inclines())


def rows_of(benchmarks: list[Benchmark]) -> list[Row]:
    """Simulate each benchmark once and compare all its numbers."""
    rows = []
    for benchmark in benchmarks:
        run = simulate(benchmark.scene)
        rows += [_row(benchmark.name, benchmark.source, check, run) for check in benchmark.checks]
    return rows


def _row(name: str, source: str, check: Check, run: Trajectory) -> Row:
    """A run that gave up before the end proves nothing: nan."""
    got = check.measure(run) if run.stop == Stop.DURATION else math.nan
    return compared(name, check.quantity, check.expected, got, check.tolerance, source)


def lcp_rows() -> list[Row]:
    """The complementarity solver on badly scaled problems that have exactly one solution: does it satisfy the conditions?"""
    rng = np.random.default_rng(1996)
    work = lcp_work(LCP_SIZE)
    worst, unsolved = 0.0, 0
    for _ in range(LCP_PROBLEMS):
        n = int(rng.integers(1, LCP_SIZE + 1))
        M, K = rng.normal(size=(n, n)), rng.normal(size=(n, n))
        A, b = M @ M.T + 0.1 * np.eye(n) + K - K.T, rng.normal(size=n)
        unit, x = 10.0 ** rng.uniform(-6.0, 6.0, n), np.zeros(n)  # as between a wheel and a balance
        unsolved += solve_lcp(A * np.outer(unit, unit), b * unit, n, work, x) != OK
        natural = x * unit
        worst = max(worst, float(np.max(np.abs(np.minimum(natural, A @ natural + b))) / max(1.0, np.max(natural))))
    name, source = "complementarity solver", "0 <= x, 0 <= A x + b, one of each pair zero, evaluated with numpy"
    return [
        compared(name, f"problems of {LCP_PROBLEMS} left unsolved", 0.0, float(unsolved), 0.0, source),
        compared(name, "worst violation of a condition", 0.0, worst, 1e-12, source),
    ]


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
