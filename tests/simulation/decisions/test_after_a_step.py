"""Where does a step end that a contact ends, and when does taking back drift change rates? By made-up gaps and turns."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation import accepted_step

OPTIONS = SimpleNamespace(gap_zero=1e-13, speed_zero=1e-8)
END = 0.5


def followed(gap: Callable[[float], tuple[float, float]]) -> tuple[tuple[float, float], list[float]]:
    """(time, kinetic energy) that is returned, and the times to which the step was followed, of such a gap and rate."""
    times = [END]

    def follow(model, state, options, end, scratch) -> float:
        times.append(end)
        return 100.0 * end

    instead = {
        "place": lambda *_: None,
        "normal_gap": lambda *_: SimpleNamespace(**dict(zip(("gap", "rate"), gap(times[-1]), strict=True))),
        "_follow_step": follow,
    }
    scratch = SimpleNamespace(smooth=SimpleNamespace(pose=None))
    found = in_python(accepted_step._follow_to_touch, **instead)(
        None, SimpleNamespace(q=None, u=None), OPTIONS, (END, 7.0), 3, scratch
    )
    return found, times[1:]


def test_a_contact_that_closes_on_the_way_ends_the_step_there() -> None:
    """A parabola is followed to within rounding of the gap; the energy is that before drift was taken back there."""

    def gap(t: float) -> tuple[float, float]:
        return 0.2 - t - 0.5 * t * t, -1.0 - t

    (time, kinetic), times = followed(gap)
    assert time == pytest.approx(math.sqrt(1.4) - 1.0, abs=2.0 * 20.0 * 1e-13)
    assert kinetic == 100.0 * time and times[-1] == time and len(times) <= 6


@pytest.mark.parametrize("share", [-0.9, 0.9, 1.1])
def test_a_gap_that_is_zero_but_for_rounding_at_the_end_ends_it_there(share: float) -> None:
    """Twenty times the gap that counts as zero, to either side; what is still open does not close before."""
    found, times = followed(lambda t: (share * 20.0 * 1e-13, -1.0))
    assert found == (END, 7.0) and times == []


def test_what_has_sunk_in_by_more_is_sought_earlier() -> None:
    found, times = followed(lambda t: (-1.1 * 20.0 * 1e-13 - 2.0 * (t - END), -2.0))
    assert times[0] == pytest.approx(END - 1.1e-12, abs=1e-15)
    assert found[0] == times[-1] < END


@pytest.mark.parametrize("rate", [0.0, 1.0])
def test_a_gap_that_does_not_fall_does_not_close_on_the_way(rate: float) -> None:
    assert followed(lambda t: (-1e-6, rate)) == ((END, 7.0), [])


def test_what_would_have_closed_before_the_step_does_not_end_it() -> None:
    assert followed(lambda t: (-0.5, -1.0)) == ((END, 7.0), [])
    assert followed(lambda t: (-0.4, -1.0 if t == END else 0.0)) == ((END, 7.0), [pytest.approx(0.1), END])


def test_on_its_way_back_it_goes_no_further_than_the_end() -> None:
    """A gap that is open at the time sought is met later."""
    path = iter([(-0.1, -1.0), (0.3, -0.5), (-1e-14, -1.0)])
    found, times = followed(lambda t: next(path))
    assert found == (END, 100.0 * END) and times == [pytest.approx(0.4), END]


def test_what_cannot_be_found_in_six_looks_leaves_the_step_as_it_was() -> None:
    found, times = followed(lambda t: (-1e-3, -1.0))
    assert found == (END, 7.0)
    assert times == pytest.approx([END - 1e-3 * k for k in range(1, 7)] + [END])


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("place", [0, 1])
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_rates_are_turned_by_the_largest_gap_times_the_fastest_turn(share: float, place: int, sign: float) -> None:
    """A tenth of the speed that is zero; a turn is a speed over its scale."""
    gaps, speeds = [1e-12, -2e-12], [0.3, -0.2]
    gaps[place], speeds[1 - place] = sign * 4e-7, -sign * share * 2.5e-3 * (2.0 if place == 0 else 0.5)
    speeds[place] = 1e-6
    closed = SimpleNamespace(kin=[SimpleNamespace(g=gap) for gap in gaps])
    model = SimpleNamespace(coordinates=[SimpleNamespace(scale=scale) for scale in (0.5, 2.0)])
    state = SimpleNamespace(u=np.array(speeds))
    assert in_python(accepted_step._turns_rates)(model, state, OPTIONS, 2, closed) == (share > 1.0)
