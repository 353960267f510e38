"""Does a film at adaptive speed give its frames to what happens, without a leap, and tell the true speed?"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.render.movie import MOST_FRAMES, adaptive, even

BEAT = ((0.1, 0.106), (0.225, 0.231), (0.35, 0.356))


def test_what_happens_gets_most_of_the_frames():
    plan = adaptive((0.0, 0.5), BEAT, 10.0, 60.0)
    shown = sum(np.count_nonzero((plan.times >= start) & (plan.times <= end)) for start, end in BEAT)
    assert len(plan.times) == 601 and 0.65 < shown / 601 < 0.85
    assert plan.times[0] == 0.0 and plan.times[-1] == pytest.approx(0.5, abs=1e-12)


def test_the_speed_told_is_that_of_the_film():
    """Against central differences of the instants, which know nothing of speeds: off by the square of the step."""
    off = []
    for fps in (1200.0, 2400.0):
        plan = adaptive((0.0, 0.5), BEAT, 10.0, fps)
        measured = (plan.times[2:] - plan.times[:-2]) * fps / 2.0
        off.append(np.quantile(np.abs(measured / plan.speeds[1:-1] - 1.0), 0.99))
    assert off[0] < 1e-3 and off[1] == pytest.approx(off[0] / 4.0, rel=0.2)


@given(
    cuts=st.lists(st.integers(0, 10**9).map(lambda n: n / 10**9), min_size=2, max_size=12, unique=True).filter(
        lambda cuts: len(cuts) % 2 == 0
    ),
    length=st.floats(0.2, 60.0),
)
def test_any_stretches_give_a_film_of_the_asked_length_that_never_turns_back(cuts, length):
    edges = sorted(cuts)
    plan = adaptive((0.0, 1.0), list(zip(edges[::2], edges[1::2], strict=True)), length, 30.0)
    assert len(plan.times) == max(2, int(np.floor(length * 30.0 + 1e-6)) + 1)
    assert plan.times[0] == pytest.approx(0.0, abs=1e-9) and plan.times[-1] == pytest.approx(1.0, abs=1e-9)
    assert np.all(np.diff(plan.times) >= 0.0) and np.all(plan.speeds > 0.0) and np.all(np.isfinite(plan.speeds))


def test_without_anything_to_tell_apart_the_speed_is_even():
    for busy in ((), ((0.0, 1.0),)):
        plan = adaptive((0.0, 1.0), busy, 5.0, 20.0)
        assert np.allclose(plan.times, np.linspace(0.0, 1.0, 101)) and np.allclose(plan.speeds, 0.2)


@pytest.mark.parametrize("length", [0.0, -1.0, np.nan, np.inf, 1e9])
def test_a_length_without_sense_is_refused(length):
    with pytest.raises(ValueError, match="length"):
        adaptive((0.0, 1.0), (), length, 60.0)


def test_even_frames_lie_evenly_and_are_limited():
    plan = even((1.0, 2.0), 0.5, 10.0)
    assert np.allclose(np.diff(plan.times), 0.05) and np.all(plan.speeds == 0.5)
    with pytest.raises(ValueError, match="frames"):
        even((0.0, 2.0 * MOST_FRAMES), 1.0, 60.0)
