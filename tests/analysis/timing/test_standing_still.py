"""Since when does a watch stand, by how far its wheel has come, and what is said of its oscillator?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing import standstill as module
from watchsim.analysis.timing.standstill import standstill
from watchsim.simulation.event_kinds import EventKind

PERIOD, END = 0.5, 4.0  # s; three half swings begin at 3.25 s
PITCH = math.tau / 15
DEGREE = math.pi / 180.0


def told(monkeypatch: pytest.MonkeyPatch, wheel: Any, balance: Any = None, **changed: Any) -> Any:
    """`wheel`, `balance`: their angles (rad) over time."""
    t = np.arange(0.0, changed.pop("end", END) + 1e-9, 0.01)
    kept = changed.pop("kept", lambda times: np.ones(len(times), bool))
    crossings = changed.pop("crossings", [])
    parts = SimpleNamespace(oscillator="balance", wheel="wheel")
    monkeypatch.setattr(module, "roles", lambda scene: changed.pop("parts", parts))
    monkeypatch.setattr(module, "keeps_time", lambda scene: changed.get("keeps_time", True))
    monkeypatch.setattr(module, "nominal_period", lambda run, body: {"balance": PERIOD}[body])
    monkeypatch.setattr(module, "pitch", lambda scene, name: changed.get("pitch", PITCH))
    monkeypatch.setattr(module, "progress", lambda run, name, times: np.array([wheel(one) for one in times]))
    monkeypatch.setattr(module, "is_recorded", lambda run, times: kept(times))
    monkeypatch.setattr(module, "holding_at_end", lambda run: changed.get("holding", []))
    events = np.zeros(2 * len(crossings), [("kind", np.int8), ("t", float)])
    events["kind"][::2], events["t"][::2] = EventKind.CROSS, crossings
    events["kind"][1::2], events["t"][1::2] = EventKind.TURN, END
    q = np.column_stack([np.zeros(len(t)), [0.0 if balance is None else balance(one) for one in t]])
    slices = {"wheel": slice(0, 1), "balance": slice(1, 2)}
    run: Any = SimpleNamespace(
        scene=None, simulated=changed.get("simulated", float(t[-1])), t=t, q=q, slices=slices, events=events
    )
    beats = type("Found", (SimpleNamespace,), {"__len__": lambda self: len(self.amplitude_deg)})
    found: Any = beats(angular=changed.get("angular", True), nominal_period=PERIOD, amplitude_deg=changed.get("amplitudes", []))
    return standstill(run, found)


def stops(at: float, rate: float = 2.0) -> Any:
    """The wheel goes on at a rate (rad/s), and then no more."""
    return lambda t: 0.3 + rate * min(t, at)


@pytest.mark.parametrize("share", [0.24, 0.26])
@pytest.mark.parametrize("whole", [PITCH, None])
def test_a_quarter_of_a_pitch_in_three_half_swings_is_ticking(
    monkeypatch: pytest.MonkeyPatch, share: float, whole: float | None
) -> None:
    """Half of what a beat takes; a hundredth of a radian where nobody knows the pitch."""
    far = share * PITCH if whole else 0.01 * share / 0.25
    got = told(monkeypatch, lambda t: 1.0 + far * min(max((t - 3.25) / 0.75, 0.0), 1.0), pitch=whole)
    assert (got is None) is (share > 0.25)
    backwards = told(monkeypatch, lambda t: 1.0 - 3.0 * far * max(t - 3.25, 0.0), pitch=whole)
    assert backwards is not None


@pytest.mark.parametrize("at", [1.003, 2.503])
def test_it_stands_since_the_wheel_was_last_elsewhere(monkeypatch: pytest.MonkeyPatch, at: float) -> None:
    """By a tenth of what counts as an advance: less is trembling."""
    rate, least = 0.5, 0.25 * PITCH
    got = told(monkeypatch, stops(at, rate))
    assert got.since == pytest.approx(math.floor(100.0 * (at - 0.1 * least / rate)) / 100.0, abs=1e-12)
    assert got.message.startswith(f"the escape wheel has stood still since t = {got.since:.4g} s")
    trembling = told(monkeypatch, lambda t: 1.0 + 0.09 * least * (t < 3.0))
    assert trembling.since == 0.0
    assert told(monkeypatch, lambda t: 1.0 - 0.11 * least * (t < 2.005)).since == pytest.approx(2.0, abs=1e-12)


@pytest.mark.parametrize(("end", "said"), [(0.74, False), (0.75, False), (0.76, True)])
def test_less_than_three_half_swings_say_nothing(monkeypatch: pytest.MonkeyPatch, end: float, said: bool) -> None:
    assert (told(monkeypatch, lambda t: 0.0, end=end) is not None) is said
    assert told(monkeypatch, lambda t: 0.0, end=end, simulated=0.7501) is not None


@pytest.mark.parametrize("missing", ["oscillator", "wheel"])
def test_without_an_escapement_nothing_is_said(monkeypatch: pytest.MonkeyPatch, missing: str) -> None:
    parts = SimpleNamespace(**({"oscillator": "balance", "wheel": "wheel"} | {missing: None}))
    assert told(monkeypatch, lambda t: 0.0, parts=parts) is None
    assert told(monkeypatch, lambda t: 0.0, keeps_time=False) is None


@pytest.mark.parametrize("lost", [0, 1])
@pytest.mark.parametrize(("last", "stands"), [(3.2, True), (3.25, False), (3.3, False)])
def test_where_the_wheel_was_not_recorded_passages_say_it(
    monkeypatch: pytest.MonkeyPatch, lost: int, last: float, stands: bool
) -> None:
    """Both ends of the three half swings must be there to compare the wheel."""
    got = told(monkeypatch, lambda t: 9.0 * t, crossings=[1.0, last], kept=lambda times: np.arange(len(times)) != lost)
    assert (got.since if got else None) == (last if stands else None)
    never = told(monkeypatch, lambda t: 9.0 * t, kept=lambda times: np.zeros(len(times), bool))
    assert never is not None and never.since == 0.0


def test_an_oscillator_that_is_held_is_told_from_one_that_swings(monkeypatch: pytest.MonkeyPatch) -> None:
    """Held: not moved by a ten thousandth for more than half a period."""
    for at, word in ((3.705, "balance held at −20° since t = 3.7 s"), (3.765, "balance swinging, now at −20°")):
        got = told(monkeypatch, lambda t: 0.0, lambda t, at=at: -20.0 * DEGREE + 1.1e-4 * (t < at))
        assert got.message.endswith(f"; {word}; nothing in contact")
    still = told(monkeypatch, lambda t: 0.0, lambda t: 20.0 * DEGREE - 0.9e-4 * (t < 3.9))
    assert "balance held at 20° since t = 0 s" in still.message
    below = told(monkeypatch, lambda t: 0.0, lambda t: 20.0 * DEGREE - 1.1e-4 * (t < 3.9))
    assert "balance swinging, now at 20°" in below.message
    ends = told(monkeypatch, lambda t: 0.0, lambda t: 20.0 * DEGREE + 0.9e-4 * np.sign(t - 3.985) * (t < 3.995))
    assert "balance held at 20° since t = 0 s" in ends.message  # from where it is at the very end


def test_what_else_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    got = told(monkeypatch, lambda t: 0.0, amplitudes=[200.0, 123.4], holding=["tooth on stone", "pin in fork"])
    assert got.message.endswith("; last amplitude 123°; in contact: tooth on stone; pin in fork")
    slides = told(monkeypatch, lambda t: 0.0, amplitudes=[1.0], angular=False)
    assert slides.message == "the escape wheel has stood still since t = 0 s; nothing in contact"
    unknown = told(monkeypatch, lambda t: 0.0, crossings=[1.0], kept=lambda times: np.zeros(len(times), bool))
    assert unknown.message == "the escape wheel has stood still since t = 1 s; nothing in contact"
