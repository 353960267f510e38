"""Are the statistics of a whole run those of its half swings, made from sums alone?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing.whole_run import whole_run

NOMINAL = 0.25


def sums(values: np.ndarray) -> dict[str, float]:
    """What is kept of a row of values; `squares` are those of the distances from the mean."""
    squares = float(np.sum((values - values.mean()) ** 2))
    return {
        **{"number": float(len(values)), "mean": float(values.mean()), "squares": squares},
        **{"least": float(values.min()), "largest": float(values.max())},
    }


def told(kept: dict[str, object], angular: bool = True) -> dict[str, Any] | None:
    run: Any = SimpleNamespace(sums=kept)
    found: Any = SimpleNamespace(angular=angular, nominal_period=NOMINAL)
    return whole_run(run, found)


@pytest.mark.parametrize("count", [2, 3, 40])
def test_means_and_standard_deviations(count: int) -> None:
    rng = np.random.default_rng(count)
    amplitude, period = rng.uniform(4.0, 5.0, count), rng.uniform(0.2499, 0.2502, count)
    kept = {"half_swings": count, "ticks": 0, "amplitude": sums(amplitude), "period": sums(period), "uneven_passages": None}
    found = told(kept)
    assert found is not None and found["beats"] == count and found["beat_error_ms"] is None
    for key, values in (("amplitude_deg", np.degrees(amplitude)), ("period_s", period)):
        expected = {"mean": values.mean(), "spread": values.std(ddof=1), "least": values.min(), "largest": values.max()}
        assert found[key] == pytest.approx(expected, rel=1e-12)
    assert found["rate_s_per_d"] == pytest.approx(86400.0 * (NOMINAL / period.mean() - 1.0), rel=1e-9)
    slides = told(kept, angular=False)
    assert slides is not None and slides["amplitude_deg"] is None and slides["period_s"] == found["period_s"]


@pytest.mark.parametrize(("ticks", "expected"), [(80, 3.0), (79, 1.5)])
def test_the_beat_error_is_heard_where_most_beats_tick(ticks: int, expected: float) -> None:
    """Half of the mean difference of the two half periods, whatever its sign; where less than 80 % tick, of the passages."""
    uneven = {"uneven_ticks": {"mean": -6e-3}, "uneven_passages": {"mean": 3e-3}}
    found = told({"half_swings": 100, "ticks": ticks, "amplitude": None, "period": None, **uneven})
    assert found is not None and found["beat_error_ms"] == pytest.approx(expected)
    assert found["amplitude_deg"] is found["period_s"] is found["rate_s_per_d"] is None


def test_a_single_half_swing_has_no_spread_and_none_no_statistics() -> None:
    one = told({"half_swings": 1, "ticks": 0, "amplitude": sums(np.array([math.pi])), "period": None, "uneven_passages": None})
    assert one is not None and one["amplitude_deg"] == pytest.approx({"mean": 180, "spread": 0, "least": 180, "largest": 180})
    assert told({}) is None and told({"half_swings": 0}) is None
