"""What does a second, more exact run say of the numbers of the first?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from watchsim.analysis import error_bars
from watchsim.analysis.error_bars import NUMBERS, more_exact, with_error_bars
from watchsim.analysis.headlines import _compared
from watchsim.simulation.methods import EVENT_DRIVEN, MOREAU


def numbers(rate: float, scatter: float | None, stop: str = "DURATION") -> dict[str, Any]:
    empty = dict.fromkeys((*NUMBERS, *(f"{name}_error" for name in NUMBERS)))
    said = {"method": "pfeiffer-glocker", "tolerance": 1e-9, "step_s": None, "stop": stop, "wall_s": 1.0}
    return {**empty, **said, "rate_s_per_d": rate, "rate_s_per_d_error": scatter, "bodies": {"balance": {"angle_rad": rate}}}


def test_the_larger_of_scatter_and_difference_is_given() -> None:
    assert with_error_bars(numbers(5.0, 0.5), numbers(5.25, 0.0))["rate_s_per_d_error"] == 0.5
    assert with_error_bars(numbers(5.0, 0.125), numbers(5.25, 0.0))["rate_s_per_d_error"] == 0.25


def test_a_scatter_that_nobody_knows_is_not_called_small() -> None:
    out = with_error_bars(numbers(5.0, None), numbers(5.25, None))
    assert out["rate_s_per_d_error"] is None and out["error_bars"]["differences"] == {"rate_s_per_d": 0.25}
    assert out["bodies"]["balance"]["angle_rad_error"] == 0.25


def test_a_second_run_that_gave_up_says_nothing() -> None:
    out = with_error_bars(numbers(5.0, 0.5), numbers(6.0, 0.5, stop="LCP_FAILED"))
    assert out["rate_s_per_d_error"] == 0.5 and out["error_bars"]["complete"] is False


def test_the_words_follow() -> None:
    state = dict.fromkeys(("x_m", "y_m", "angle_rad", "x_m_error", "y_m_error", "angle_rad_error"), 0.0)
    finer, broken = (with_error_bars(numbers(5.0, 0.5), numbers(5.25, 0.5, stop)) for stop in ("DURATION", "LCP_FAILED"))
    told, failed = (dict(_compared({**one, "bodies": {"balance": state}})) for one in (finer, broken))
    assert told["error bars"].startswith("of the computation, from a second run") and told[""] == "rate ± 0.2 s/d"
    assert failed == {"error bars": "none: the more exact run did not finish"}
    assert not list(_compared(numbers(5.0, 0.5)))


@pytest.mark.parametrize(("tolerance", "tighter"), [(1e-6, 1e-8), (1e-12, 1e-13)])
def test_the_second_run_is_a_hundred_times_as_exact(monkeypatch: pytest.MonkeyPatch, tolerance: float, tighter: float) -> None:
    """But no more so than numbers of 16 digits allow; it is as long as the first one was."""
    (asked, how) = second_run(monkeypatch, method=EVENT_DRIVEN, tolerance=tolerance, step=None)
    assert asked == ("the scene", 7.0, pytest.approx(tighter, rel=1e-12, abs=0.0)) and "step" not in how


def test_the_second_run_takes_half_the_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, how = second_run(monkeypatch, method=MOREAU, tolerance=1e-6, step=4e-6)
    assert asked == ("the scene", 7.0, 1e-6) and (how["method"], how["step"]) == (MOREAU, 2e-6)


def second_run(monkeypatch: pytest.MonkeyPatch, **run: Any) -> tuple[tuple[Any, ...], dict[str, Any]]:
    monkeypatch.setattr(error_bars, "simulate", lambda *asked, **how: (asked, how))
    first: Any = SimpleNamespace(scene="the scene", simulated=7.0, **run)
    found: Any = more_exact(first)
    return found


def test_half_the_step_leaves_half_the_error_of_the_first_order() -> None:
    """What is still to come after halving is as much again."""
    first, second = ({**numbers(rate, 0.0), "method": MOREAU} for rate in (5.0, 5.25))
    assert with_error_bars(first, second)["rate_s_per_d_error"] == 0.5


def test_what_only_one_of_the_runs_gives_has_no_error() -> None:
    known, unknown = numbers(5.0, 0.5), {**numbers(5.0, 0.5), "rate_s_per_d": None}
    for first, second in ((known, unknown), (unknown, known)):
        out = with_error_bars(first, second)
        assert out["error_bars"]["differences"] == {} and out["rate_s_per_d_error"] == 0.5


def test_only_moreaus_run_goes_by_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run by events that was asked for a step all the same, and one by steps that does not say which."""
    for method, step in ((EVENT_DRIVEN, 1e-5), (MOREAU, None)):
        asked, how = second_run(monkeypatch, method=method, tolerance=1e-6, step=step)
        assert asked[2] == pytest.approx(1e-8, abs=0.0, rel=1e-12) and "step" not in how
