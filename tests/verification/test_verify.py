"""Do all benchmarks come out, and would `verify` notice if one did not?"""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest
from benchmark_names import NAMES, benchmark_of

from watchsim.profiles_path import profiles_dir
from watchsim.verification.all_checks import rows_of, verify_text
from watchsim.verification.benchmarks import Check, swings
from watchsim.verification.compared import compared
from watchsim.verification.hard_cases import wedges
from watchsim.verification.random_problems import random_rows

FIELDS = ["name", "quantity", "expected", "got", "error", "tolerance", "ok", "source"]


@pytest.mark.parametrize("name", NAMES)
def test_benchmark(name: str) -> None:
    benchmark = benchmark_of(name)
    rows = rows_of([benchmark])
    wrong = [row for row in rows if not row["ok"]]
    assert not wrong, verify_text(wrong)
    assert len(rows) == len(benchmark.checks)


def test_the_wedge_lies_on_both_walls_of_its_slot() -> None:
    """Each wall is a line through two corners of the wedge, longer than its side, with the slot's material outside."""
    half_angle = 0.2
    for benchmark in wedges(half_angle):
        wedge, slot = (benchmark.scene.body(name) for name in ("wedge", "slot"))
        corners = [complex(*edge.start) for edge in wedge.loops[0].edges]
        for loop, sign in zip(slot.loops, (1.0, -1.0), strict=True):
            (wall,) = loop.edges
            start, way = complex(*wall.start), complex(*wall.end) - complex(*wall.start)
            off = [((corner - start) / way) for corner in corners]
            touching = [one for one in off if abs(one.imag) * abs(way) < 1e-15]
            assert len(touching) == 2 and all(0.0 < one.real < 1.0 for one in touching)
            assert all(one.imag < 1e-15 for one in off)  # material on the left of a wall
            assert abs(way.real / way.imag) == pytest.approx(math.tan(half_angle)) and way.real * way.imag * sign > 0.0


def test_random_problems() -> None:
    assert all(row["ok"] for row in random_rows(300))


def test_a_wrong_number_is_noticed() -> None:
    """The right run against a shifted expectation."""
    benchmark = swings()[0]
    shifted = replace(
        benchmark, checks=(Check("angle at 2 s [rad]", 1.0 + benchmark.checks[2].expected, benchmark.checks[2].measure),)
    )
    (row,) = rows_of([shifted])
    assert not row["ok"]
    assert "WRONG" in verify_text([row])


def test_a_row_as_promised() -> None:
    row = compared("a", "b", 2.0, 2.0 + 1e-8, 1e-9, "c")
    assert list(row) == FIELDS
    assert row["error"] == pytest.approx(5e-9, rel=1e-6, abs=0.0)
    assert row["ok"] is False
    assert compared("a", "b", 0.0, 1e-10, 1e-9, "c")["ok"] is True
    assert compared("a", "b", 1.0, math.nan, 1e-9, "c")["ok"] is False
    json.dumps(row)
    assert str(compared("a", "b", -0.0, -0.0, 1e-9, "c")["expected"]) == "0.0"


def test_the_table_names_each_benchmark_once_and_counts_the_wrong() -> None:
    rows = [
        compared("first", "x", 1.0, 1.0, 0.0, "s"),
        compared("first", "y", 1.0, 2.0, 0.1, "s"),
        compared("second", "z", 0.0, 0.0, 0.0, "s"),
    ]
    text = verify_text(rows)
    assert text.count("first") == 1
    assert text.startswith("first")
    assert text.endswith("1 of 3 numbers are WRONG.")
    assert verify_text(rows[:1]).endswith("All 1 numbers agree.")


def test_profiles_are_found() -> None:
    assert (profiles_dir() / "incline" / "scene.toml").is_file()
