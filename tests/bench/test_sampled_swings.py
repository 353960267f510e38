"""Are amplitude and period told right from samples alone?"""

import numpy as np
import pytest

from watchsim.bench.sampled_swings import swing


@pytest.mark.parametrize("hertz", [3.7, 4.0])
def test_a_dying_swing(hertz: float) -> None:
    """x = A e^(-d t) cos(w t): known extremes and passages, sampled at times that hit neither."""
    amplitude, decay, w = 4.7, 0.3, 2.0 * np.pi * hertz
    times = 2e-4 * np.arange(1.0, 15000.0)
    told = swing(times, amplitude * np.exp(-decay * times) * np.cos(w * times + 0.123), (1.0, 2.9))
    passages = (np.arange(200) * np.pi + 0.5 * np.pi - 0.123) / w
    turns = (np.arange(-1, 200) * np.pi - 0.123 - np.arctan(decay / w)) / w
    high = amplitude * np.exp(-decay * turns) * np.cos(np.arctan(decay / w))
    inside = (passages >= 1.0) & (passages <= 2.9)
    means = 0.5 * (high[1:] + high[:-1])
    before = np.searchsorted(turns, passages) - 1
    assert told[2] == inside.sum()
    assert told[0] == pytest.approx(means[before[inside]].mean(), rel=1e-7)
    assert told[1] == pytest.approx(1.0 / hertz, rel=1e-9)


def test_what_does_not_swing_has_no_period() -> None:
    times = 1e-3 * np.arange(1.0, 1000.0)
    assert swing(times, np.full(len(times), 0.3), (0.0, 1.0)) == (None, None, 0)
