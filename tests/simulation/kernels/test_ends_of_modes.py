"""When within a step is one of many monitors first no longer positive? Against sampling and scipy's roots."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from made_up import named
from plain_kernels import in_python
from scipy.optimize import brentq

from watchsim.contact.index_sets import FORWARD, OPEN, STICK
from watchsim.simulation.loop_state.scratch import MONITORS
from watchsim.simulation.motion import contact_mode_end
from watchsim.simulation.motion.contact_mode_end import NONE_FIRED
from watchsim.simulation.motion.coupled_motion import EXTENT, NORMAL, PARADOX, TANGENTIAL

LENGTH = 0.8
CONTACTS, COORDINATES = 2, 3
CODES = MONITORS * CONTACTS + COORDINATES
OPTIONS = named(speed_zero=1e-2, size=4.0, extent=1e-4)
Monitor = Callable[[float], float]


def first(
    monitors: dict[int, Monitor], smallest: float = -1.0, slack: float = 0.0, contacts: int = 2
) -> tuple[float, int, int]:
    """(time, code, evaluations) of the first leave in a step; what is not named stays at 1."""
    every = [monitors.get(code, lambda t: 1.0) for code in range(CODES)]
    looks = [0]

    def evaluate(model, state, options, tau, scratch) -> float:
        looks[0] += 1
        scratch.smooth.monitors[:] = [monitor(tau) for monitor in every]
        return min(scratch.smooth.monitors)

    smooth = named(
        monitors=np.full(CODES, 77.0), before=np.array([monitor(0.0) for monitor in every]), fired=np.zeros(CODES, int)
    )
    scratch = named(step=named(span=named(length=LENGTH, start=0.0)), smooth=smooth)
    model = named(coordinates=[None] * (CODES - MONITORS * contacts))
    state = named(now=named(awake_contacts=contacts))
    kernel = in_python(contact_mode_end.first_leave, _evaluate=evaluate, _slack=lambda *_: slack)
    time, code = kernel(model, state, OPTIONS, smallest, scratch)
    return float(time), int(code), looks[0]


def test_nothing_is_looked_at_where_all_stages_were_positive() -> None:
    assert first({3: lambda t: 0.1 - t}, smallest=1e-9) == (math.inf, NONE_FIRED, 0)
    assert first({3: lambda t: 0.1 - t}, smallest=0.0)[:2] == (pytest.approx(0.1), 3)


@pytest.mark.parametrize("value", [0.0, -0.2])
def test_what_is_not_positive_at_the_start_ends_the_mode_at_once(value: float) -> None:
    assert first({5: lambda t: value + t, 7: lambda t: -1.0})[:2] == (0.0, 5)
    assert first({CODES - 1: lambda t: value})[:2] == (0.0, CODES - 1)


def test_what_dips_between_samples_and_is_back_is_not_seen() -> None:
    assert first({2: lambda t: 1e-6 + (t - 0.15) ** 2})[:2] == (math.inf, NONE_FIRED)
    assert first({2: lambda t: -1e-6 + (t - 0.15) ** 2})[:2] == (math.inf, NONE_FIRED)
    assert first({2: lambda t: 1e-6 + (t - 0.2) ** 2})[:2] == (math.inf, NONE_FIRED)
    assert first({2: lambda t: -1e-6 + (t - 0.2) ** 2})[:2] == (pytest.approx(0.199), 2)
    assert first({2: lambda t: 1.0 - t})[2] == 8  # samples


@pytest.mark.parametrize("seed", range(12))
def test_the_first_of_all_ends_is_found(seed: int) -> None:
    """Curves that fall through zero at random times, in contacts and bearings; none of them at the end of a primitive."""
    rng = np.random.default_rng(seed)
    codes = [code for code in range(CODES) if code >= MONITORS * CONTACTS or code % MONITORS != EXTENT]
    chosen = rng.choice(codes, 4, replace=False)
    roots = rng.uniform(0.05, 0.75, 4)
    steep = rng.uniform(0.5, 9.0, 4)

    def falling(root: float, k: float) -> Monitor:
        return lambda t: (math.exp(k * (root - t)) - 1.0) * (1.3 + math.sin(5.0 * t))

    found = first({int(code): falling(root, k) for code, root, k in zip(chosen, roots, steep, strict=True)})
    assert found[:2] == (pytest.approx(roots.min(), rel=1e-13, abs=0.0), chosen[roots.argmin()])
    assert found[2] < 80


def test_of_a_slip_the_reversal_is_where_it_vanishes() -> None:
    """A monitor fires below minus its slack: the time is that at which it is as large as that."""
    assert first({1: lambda t: 0.35 - t}, slack=0.02)[:2] == (pytest.approx(0.33), 1)
    assert first({1: lambda t: 0.35 - t}, slack=0.06)[0] == pytest.approx(0.35)  # at the last look it was below that already


def dip(t: float) -> float:
    """Below zero from 0.22 to 0.27: no sample sees it."""
    return (t - 0.22) * (t - 0.27)


def test_monitors_are_read_again_just_before_a_contact_leaves() -> None:
    """What forces do beyond the end of a primitive means nothing; two contacts may change places there."""
    out = {EXTENT: lambda t: 3.0 * (0.25 - t)}
    assert first(out)[:2] == (pytest.approx(0.25), EXTENT)
    assert first({**out, MONITORS + NORMAL: dip})[:2] == (pytest.approx(0.22), MONITORS + NORMAL)
    assert first({**out, NORMAL: dip}, contacts=1)[:2] == (pytest.approx(0.25), EXTENT)
    assert first({MONITORS + EXTENT: out[EXTENT], NORMAL: dip})[:2] == (pytest.approx(0.22), NORMAL)


@pytest.mark.parametrize("code", [NORMAL, TANGENTIAL, PARADOX, 2 * MONITORS + EXTENT])
def test_they_are_not_where_something_else_ends_a_mode(code: int) -> None:
    assert first({code: lambda t: 3.0 * (0.25 - t), MONITORS + NORMAL: dip})[:2] == (pytest.approx(0.25), code)


def test_what_ends_at_the_very_sample_is_told_by_its_own_code() -> None:
    assert first({1: lambda t: 5e-4, 5: lambda t: 0.4 - t})[:2] == (0.4, 5)
    assert first({EXTENT: lambda t: 5e-4, 5: lambda t: 0.35 - t, 7: lambda t: (t - 0.31) * (t - 0.36)})[0] == pytest.approx(
        0.35
    )


@pytest.mark.parametrize(("margin", "share"), [(0.05, 8.0 * 1e-4 / 0.05), (8e-4, 0.5), (3e-4, 0.5)])
def test_just_before_is_eight_extents_and_at_most_half_the_way_back(margin: float, share: float) -> None:
    """By the nearest end among all contacts."""
    before = np.full(CODES, 7.0)
    before[EXTENT], before[MONITORS + EXTENT] = 9.0, margin
    before[NORMAL] = before[2 * MONITORS] = 1e-9
    scratch = named(smooth=named(before=before))
    found = in_python(contact_mode_end._while_within)(named(now=named(awake_contacts=CONTACTS)), OPTIONS, 0.2, 0.3, scratch)
    assert found == pytest.approx(0.3 - share * 0.1)


def root(monitor: Monitor, low: float, high: float, start: float = 0.0, slack: float = 0.0) -> tuple[float, int]:
    """(the time that `_root` gives for one monitor, evaluations)."""
    looks = [0]

    def evaluate(model, state, options, tau, scratch) -> None:
        looks[0] += 1
        scratch.smooth.monitors[2] = monitor(tau)

    smooth = named(before=[9.0, 9.0, monitor(low), 9.0], monitors=[-9.0, -9.0, monitor(high), -9.0])
    scratch = named(smooth=smooth, step=named(span=named(start=start)))
    kernel = in_python(contact_mode_end._root, _evaluate=evaluate, _slack=lambda *_: slack)
    return float(kernel(None, None, None, 2, low, high, scratch)), looks[0]


@pytest.mark.parametrize("slack", [0.0, 0.05])
def test_a_root_is_that_of_scipy_from_above(slack: float) -> None:
    def monitor(t: float) -> float:
        return math.cos(4.0 * t) - 0.3 * t

    exact = brentq(lambda t: monitor(t) - slack, 0.1, 0.6, xtol=1e-16)
    time, looks = root(monitor, 0.1, 0.6, slack=slack)
    assert time == pytest.approx(exact, rel=2e-15, abs=0.0) and monitor(time) - slack <= 1e-15 and looks < 35


def test_a_root_is_found_as_closely_as_time_is_known() -> None:
    """Late in a run by fewer evaluations: to 1e-15 of the time."""
    late = [root(lambda t: 0.3 - t * t, 0.1, 0.9, start)[1] for start in (0.0, 1e9)]
    assert late[0] > late[1]
    assert root(lambda t: 0.3 - t * t, 0.1, 0.9, 1e9)[0] == pytest.approx(math.sqrt(0.3), abs=2e-6)


def test_what_is_still_positive_or_zero_at_the_end() -> None:
    assert root(lambda t: 1.0, 0.1, 0.6) == root(lambda t: 1e-9, 0.1, 0.6) == (0.6, 0)
    assert root(lambda t: 0.6 - t, 0.1, 0.6)[0] == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        (TANGENTIAL, 3.0 * 2.0 * 1e-2),
        (NORMAL, 0.0),
        (PARADOX, 0.0),
        (MONITORS + TANGENTIAL, 0.0),  # it sticks
        (2 * MONITORS, 0.5 * 3.0 * 1e-2 / 4.0 * 0.7),
        (2 * MONITORS + 1, 0.0),  # it is held
        (2 * MONITORS + 2, 0.5 * 3.0 * 1e-2 / 4.0 * 0.2),
    ],
)
def test_by_how_much_slips_and_bearings_may_go_on(code: int, expected: float) -> None:
    state = named(
        now=named(awake_contacts=CONTACTS, lenience=3.0),
        active=[4, 6],
        mode={4: FORWARD, 6: STICK},
        grip=[FORWARD, STICK, OPEN],
    )
    model = named(coordinates=[named(scale=0.7), named(scale=9.0), named(scale=0.2)])
    assert in_python(contact_mode_end._slack)(model, state, OPTIONS, code) == pytest.approx(expected)


def test_a_motion_is_evaluated_at_places_of_the_extension() -> None:
    told: list[tuple[float, list[float]]] = []
    instead = {
        "dense_value": lambda step, i, tau: 10.0 * i + tau,
        "motion": lambda model, state, options, t, work, smooth: told.append((t, smooth.y.tolist())) or 0.5,
    }
    scratch = named(step=named(span=named(start=3.0)), smooth=named(y=np.zeros(3)), work=None)
    assert in_python(contact_mode_end._evaluate, **instead)(None, None, None, 0.25, scratch) == 0.5
    assert told == [(3.25, [0.25, 10.25, 20.25])]


def turn(**changed: object) -> float:
    """Of a flight of three coordinates, the second without dry friction."""
    given = {"awake": [1, 1, 1], "grip": [1, 0, -1], "u": [2.0, -3.0, -4.0], "times": [0.7, 0.1, 0.5], **changed}
    coordinates = [named(coulomb=0.3, number=0), named(coulomb=0.0, number=1), named(coulomb=5e-4, number=2)]
    state = named(awake=given["awake"], grip=given["grip"], u=given["u"], q=[5.0, 6.0, 7.0])

    def turning_time(coordinate: SimpleNamespace, grip: int, q: float, u: float) -> float:
        i = coordinate.number
        assert (grip, q, u) == (given["grip"][i], 5.0 + i, given["u"][i])
        return float(given["times"][i])

    return float(in_python(contact_mode_end.first_turn, turning_time=turning_time)(named(coordinates=coordinates), state))


def test_the_first_bearing_that_comes_to_a_stop_ends_a_flight() -> None:
    assert turn() == 0.5 and turn(times=[0.3, 0.1, 0.5]) == 0.3
    assert turn(awake=[1, 1, 0]) == 0.7 and turn(awake=[0, 1, 0]) == math.inf
    assert turn(u=[2.0, -3.0, 4.0]) == 0.0 and turn(u=[2.0, -3.0, 0.0]) == 0.5
