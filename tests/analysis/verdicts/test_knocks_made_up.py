"""Which blows count as knocks, by where the oscillator is, what it strikes and when, and what is said of them?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.verdicts import knocking as module
from watchsim.analysis.verdicts.knocking import knocking, knocks
from watchsim.analysis.verdicts.verdict_kinds import KNOCKS

DEGREE = math.pi / 180.0
PERIOD, REST = 0.4, 0.1  # s, rad
HORN, STOP, DART, CARRIER = range(4)  # contacts: of the lever (square, and on the roller), and of a stop
PAIRS = [("lever", "balance"), ("balance", "banking"), ("lever", "balance"), ("wheel", "balance")]


class Pair:
    def __init__(self, a: str, b: str) -> None:
        self.body_a, self.body_b = a, b

    def __str__(self) -> str:
        return f"{self.body_a} on {self.body_b}"


def watch(
    blows: list[tuple[float, int]], reach: float = 300.0, arms: tuple[float, ...] = (0.051, 0.051, 0.049), **changed: Any
) -> Any:
    """Twenty half swings of `reach` degrees about the rest position, from 1 s on, passing it at 1.1, 1.3, ... s."""
    ends = 1.0 + 0.5 * PERIOD * np.arange(21)
    places = REST + reach * DEGREE * np.where(np.arange(21) % 2, 1.0, -1.0)
    found = SimpleNamespace(t=ends[:-1] + 0.1, start=ends[:-1], end=ends[1:], start_at=places[:-1], end_at=places[1:])
    found.nominal_period = PERIOD
    sized: Any = type("Found", (SimpleNamespace,), {"__len__": lambda self: len(self.t)})(**vars(found))
    events = np.array(sorted(blows), [("t", float), ("contact", int)])
    values: dict[str, Any] = {
        **{"oscillator": "balance", "lever": "lever", "wheel": "wheel", "fixed": {"banking"}, "rest": REST, "found": sized},
        **{"has_shapes": True, "compiled": None, "recorded": lambda times: np.ones(len(times), bool), "drive": lambda t: -2e-6},
        "run": SimpleNamespace(events=events, pairs=[Pair(*pair) for pair in PAIRS], simulated=5.0),
    } | changed

    def concerned(first: str, others: set[str], *kinds: object) -> Any:
        own = [bool(others & (set(PAIRS[int(k)]) - {first})) for k in events["contact"]]
        return events[np.array(own, bool)]

    def told(run: Any, compiled: Any, t: float, numbers: list[int]) -> Any:
        """5 mm from the staff, which stands at (7 mm, -1 mm). Asked when this contact was struck first."""
        assert t == min(at for at, number in blows if number == numbers[0])
        arm = arms[numbers[0]] * 5e-3
        return SimpleNamespace(
            places={"balance": (7e-3, -1e-3, 0.0)}, point=np.array([[10e-3, 3e-3]]), of=lambda row, body: (arm, 0.0)
        )

    module.arms = told  # type: ignore[assignment]
    return SimpleNamespace(**values, events=concerned)


@pytest.fixture(autouse=True)
def surroundings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "arms", None)
    monkeypatch.setattr(module, "last_window", lambda run, period: (4.0, 5.0))
    monkeypatch.setattr(module, "averages", lambda found, window: SimpleNamespace(rate_s_per_d=None))


def when(angle: float, swing: int = 9, reach: float = 300.0, back: bool = False) -> float:
    """The time in a half swing at which the oscillator is so far from rest (degrees), before or after it has passed it."""
    since = math.asin(angle / reach) / (0.5 * math.pi) * 0.1
    return 1.1 + 0.2 * swing + (-since if back else since)


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize(("angle", "counts"), [(179.0, False), (181.0, True), (10.0, False), (299.0, True)])
def test_beyond_half_a_turn_the_pin_cannot_be_in_the_slot(angle: float, counts: bool, back: bool) -> None:
    for swing in (4, 9):
        t = when(angle, swing, back=back)
        assert list(knocks(watch([(t, HORN)]))["t"]) == ([t] if counts else [])


def test_a_stop_is_struck_at_any_angle_and_a_dart_on_its_roller_knocks_nobody() -> None:
    blows = [(when(10.0), STOP), (when(250.0), DART), (when(251.0), HORN), (when(252.0), CARRIER)]
    assert list(knocks(watch(blows))["contact"]) == [STOP, HORN]
    assert list(knocks(watch(blows, arms=(0.049, 0.051, 0.049)))["contact"]) == [STOP]
    assert list(knocks(watch(blows, arms=(-0.051, -0.049, -0.051)))["contact"]) == [DART, HORN]
    unseen: Any = {"recorded": lambda times: np.zeros(len(times), bool)}
    assert list(knocks(watch(blows, **unseen))["contact"]) == [STOP, DART, HORN]
    assert list(knocks(watch(blows, has_shapes=False))["contact"]) == [STOP, DART, HORN]
    assert list(knocks(watch(blows, lever=None))["contact"]) == [STOP]


@pytest.mark.parametrize(("t", "counts"), [(0.99, False), (1.0, True), (5.0, True), (5.01, False)])
def test_blows_before_the_first_half_swing_and_after_the_last_are_not_judged(t: float, counts: bool) -> None:
    assert len(knocks(watch([(t, STOP)]))) == counts


@pytest.mark.parametrize(("t", "start", "counts"), [(2.4, 4.0, False), (2.6, 4.0, True), (2.2, 2.1, True), (2.0, 2.1, False)])
def test_knocks_of_the_second_half_or_the_last_window_are_judged(
    monkeypatch: pytest.MonkeyPatch, t: float, start: float, counts: bool
) -> None:
    """Whichever begins earlier; the last knock counts."""
    monkeypatch.setattr(module, "last_window", lambda run, period: (start, 5.0))
    assert (knocking(watch([(1.2, STOP), (t, STOP)])) is not None) is counts
    assert knocking(watch([])) is None


def test_what_is_said_of_knocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Since the first, by half swings, at the angle of the last."""
    first, last = when(200.0, 10), when(240.0, 14)
    blows = [(first, HORN), (first + 1e-4, HORN), (when(220.0, 12), HORN), (last, HORN)]
    told: Any = knocking(watch(blows))
    assert (told.name, told.t, told.body, told.torque, told.count) == (KNOCKS, first, "balance", -2e-6, 3)
    assert "balance strikes lever from outside at 240°, 3 times (lever on balance), under " in told.message
    assert "2 µN·m at wheel" in told.message and "gallops" not in told.message
    assert told.message.startswith(module.when(first))
    for rate, words in ((12.3, "; the watch gallops, +12.3 s/d"), (8e-4, "gallops, +0.0008 s/d"), (-12.3, None), (0.0, None)):
        monkeypatch.setattr(module, "averages", lambda found, window, rate=rate: SimpleNamespace(rate_s_per_d=rate))
        said: Any = knocking(watch(blows))
        assert said.message.endswith(words) if words else "gallops" not in said.message
    stop: Any = knocking(watch([(last, STOP)]))
    assert "balance strikes banking" in stop.message
