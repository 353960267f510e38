"""What does a second, more exact run say of the numbers of the first?"""

from __future__ import annotations

from typing import Any

from watchsim.analysis.error_bars import NUMBERS, with_error_bars
from watchsim.analysis.headlines import _compared


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
