"""Which turning points count as unlocked, and when does a swing that never leaves the fork?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.verdicts import unlocked as module
from watchsim.analysis.verdicts.unlocked import unlocked

TOOTH, OTHER_TOOTH, PIN, DART, BANKING = range(5)  # contacts
START = 5.0  # of the last window, s
ARMS = {PIN: 0.06, DART: 0.04}  # of the distance to the staff


def told(
    monkeypatch: pytest.MonkeyPatch,
    holding: dict[float, list[int]],
    driving: tuple[int, ...] = (TOOTH,),
    arms: dict[int, float] | None = None,
    **changed: Any,
) -> list[tuple[float, str]]:
    """`holding`: by turning point the contacts in force. Teeth press at 3 mm and the staff stands at (1 mm, -4 mm)."""
    lengths = ARMS if arms is None else arms
    ends = np.array(sorted(holding))

    def made(run: Any, compiled: Any, t: float, rows: list[int]) -> Any:
        point = np.array([[4e-3, 0.0]] * len(rows))  # 5 mm from the staff
        of = {row: lengths.get(number, 0.0) * 5e-3 for row, number in enumerate(rows)}
        places = {"balance": (1e-3, -4e-3, 0.3)}
        pairs = tuple(f"contact {number}" for number in rows)
        return SimpleNamespace(pairs=pairs, point=point, places=places, of=lambda row, body: (of[row], 0.0), rows=rows)

    def face(watch: Any, arms: Any, row: int) -> Any:
        return SimpleNamespace(impulse=arms.rows[row] in driving)

    def in_force(run: Any, times: list[float]) -> list[list[int]]:
        return [holding[t] for t in times]

    monkeypatch.setattr(module, "arms", made)
    monkeypatch.setattr(module, "face", face)
    monkeypatch.setattr(module, "in_force", in_force)
    monkeypatch.setattr(module, "last_window", lambda run, period: (START, 99.0))
    contacts = {"wheel": {TOOTH, OTHER_TOOTH}, "balance": {PIN, DART}, "plate": {BANKING}}
    values = {
        **{"lever": "lever", "wheel": "wheel", "oscillator": "balance", "fixed": {"plate"}, "has_banking": True},
        **{"has_shapes": True, "recorded": lambda times: np.ones(len(times), bool), "run": None, "compiled": None},
        "contacts": lambda body, others: contacts[next(iter(others))],
    }
    found = SimpleNamespace(end=ends, nominal_period=0.5)
    found_or_not: Any = type("Found", (SimpleNamespace,), {"__len__": lambda self: len(self.end)})(**vars(found))
    watch: Any = SimpleNamespace(**{**values, "found": found_or_not, **changed})
    return [(t, word) for t, word, _ in unlocked(watch)]


def test_a_tooth_that_drives_the_lever_off_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only those that drive, and only while nothing holds the lever on its banking."""
    holding = {5.5: [TOOTH], 6.0: [OTHER_TOOTH], 6.5: [TOOTH, OTHER_TOOTH], 7.0: [TOOTH, BANKING], 7.5: [], 8.0: [DART]}
    assert told(monkeypatch, holding) == [(5.5, "contact 0"), (6.5, "contact 0")]
    both = told(monkeypatch, holding, (TOOTH, OTHER_TOOTH))
    assert both == [(5.5, "contact 0"), (6.0, "contact 1"), (6.5, "contact 0"), (6.5, "contact 1")]


@pytest.mark.parametrize(("times", "seen"), [([4.9, 5.0, 5.1], [5.0, 5.1]), ([4.8, 4.9], [4.8, 4.9]), ([4.5, 5.5], [5.5])])
def test_the_last_window_is_looked_at(monkeypatch: pytest.MonkeyPatch, times: list[float], seen: list[float]) -> None:
    """Its start counts with it; where no swing turned in it, the last eight."""
    assert [t for t, _ in told(monkeypatch, {t: [TOOTH] for t in times})] == seen


def test_of_earlier_swings_the_last_eight(monkeypatch: pytest.MonkeyPatch) -> None:
    times = [0.1 * k for k in range(20)]
    assert [t for t, _ in told(monkeypatch, {t: [TOOTH] for t in times})] == times[12:]


def test_what_was_not_recorded_is_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    holding = {6.0: [TOOTH], 7.0: [TOOTH], 8.0: [TOOTH]}
    assert [t for t, _ in told(monkeypatch, holding, recorded=lambda times: times != 7.0)] == [6.0, 8.0]
    assert told(monkeypatch, holding, recorded=lambda times: np.zeros(len(times), bool)) == []


@pytest.mark.parametrize("changed", [{"lever": None}, {"has_banking": False}, {"has_shapes": False}])
def test_where_nothing_can_be_said(monkeypatch: pytest.MonkeyPatch, changed: dict[str, Any]) -> None:
    assert told(monkeypatch, {6.0: [TOOTH], 7.0: [TOOTH]}, **changed) == []
    assert told(monkeypatch, {}) == []


@pytest.mark.parametrize(("arm", "engaged"), [(0.045, False), (0.055, True), (-0.045, False), (-0.055, True)])
def test_a_pin_has_an_arm_and_a_dart_has_less(monkeypatch: pytest.MonkeyPatch, arm: float, engaged: bool) -> None:
    """Beside a pin in its fork a tooth may drive: it counts where it is always so, and not once."""
    holding = {5.0 + 0.5 * k: [TOOTH, PIN] for k in range(7)} | {9.0: [OTHER_TOOTH]}
    got = told(monkeypatch, holding, arms={PIN: arm})
    assert got == ([] if engaged else [(5.0 + 0.5 * k, "contact 0") for k in range(7)])


@pytest.mark.parametrize(("count", "counts"), [(7, False), (8, True), (9, True)])
def test_small_swings_count_where_all_of_eight_are_so(monkeypatch: pytest.MonkeyPatch, count: int, counts: bool) -> None:
    holding = {5.0 + 0.5 * k: [TOOTH, PIN] if k % 2 else [TOOTH] for k in range(count)}
    times = [t for t, _ in told(monkeypatch, holding)]
    assert times == (sorted(holding) if counts else sorted(holding)[::2])


def test_one_that_is_locked_among_small_swings_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    holding = {5.0 + 0.5 * k: [TOOTH, PIN] for k in range(9)} | {12.0: [TOOTH, BANKING], 13.0: [TOOTH]}
    assert [t for t, _ in told(monkeypatch, holding)] == [13.0]


def test_a_contact_counts_that_drives_though_another_of_the_same_teeth_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows of teeth come first, then those of pins."""
    got = told(monkeypatch, {6.0: [PIN, OTHER_TOOTH, TOOTH]}, arms={PIN: 0.04})
    assert got == [(6.0, "contact 0")]
    both = told(monkeypatch, {6.0: [DART, OTHER_TOOTH, TOOTH]}, driving=(TOOTH, OTHER_TOOTH))
    assert both == [(6.0, "contact 1"), (6.0, "contact 0")]
