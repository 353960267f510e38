"""When has the lever gone over while the impulse pin was away? With made-up events, angles and arms."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.verdicts import overbanking as module
from watchsim.analysis.verdicts.overbanking import _pressed_on, _went_over, overbanking
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind

BEFORE, PIN, BANK, OTHER_BANK, TOOTH = range(5)  # contacts
T = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
LEVER = np.array([0.0, 0.2, 0.12, 0.12, 0.02, 0.01])  # rad: it leaves the other half of its way between 3 and 4 s


def events(*rows: tuple[float, EventKind, int, int]) -> Any:
    """(t, kind, contact, body)."""
    table = np.zeros(len(rows), EVENT_DTYPE)
    for place, row in enumerate(rows):
        table["t"][place], table["kind"][place], table["contact"][place], table["body"][place] = row
    return table


PASSED = (3.5, EventKind.CROSS, -1, 1)
USUAL = (
    *((1.5, EventKind.CROSS, -1, 1), PASSED, (4.1, EventKind.TURN, -1, 1), (4.4, EventKind.CROSS, -1, 0)),
    *((4.3, EventKind.IMPACT, BEFORE, -1), (4.7, EventKind.IMPACT, PIN, -1)),
)


def told(monkeypatch: pytest.MonkeyPatch, rows: Any = USUAL, arms: dict[int, float] | None = None, **changed: Any) -> Any:
    """The run ends at 5 s, half swings take 0.6 s; `arms` on the lever by contact."""
    given, table = arms or {PIN: 0.5e-3, BANK: -0.2e-3}, events(*rows)

    def seen(run: Any, compiled: Any, t: float, numbers: list[int]) -> Any:
        assert t == 4.7
        return SimpleNamespace(pairs=numbers, of=lambda row, body: (given[numbers[row]], 9.0))

    monkeypatch.setattr(
        module, "in_force", lambda run, times: [changed.get("holding", [TOOTH, BANK])] if times == [4.7] else []
    )
    monkeypatch.setattr(module, "arms", seen)
    bodies = [SimpleNamespace(name=name) for name in ("lever", "balance", "wheel")]
    run = SimpleNamespace(
        **{
            "scene": SimpleNamespace(bodies=bodies),
            "events": table,
            "simulated": 5.0,
            "t": T,
            "q": np.column_stack((T, LEVER)),
        },
        **{"slices": {"lever": slice(1, 2)}, "pairs": [f"contact {k}" for k in range(5)]},
    )
    values: dict[str, Any] = {
        **{"run": run, "found": SimpleNamespace(nominal_period=1.2), "lever": "lever", "oscillator": "balance"},
        **{"wheel": "wheel", "fixed": {"plate"}, "has_banking": True, "has_shapes": True, "rest": 0.25, "compiled": None},
        "contacts": lambda body, others: {BANK, OTHER_BANK} if (body, others) == ("lever", {"plate"}) else set(),
        "events": lambda body, others, *kinds: table[np.isin(table["kind"], kinds) & np.isin(table["contact"], (BEFORE, PIN))],
        **{"recorded": lambda times: times == 4.7, "angle": lambda body, times: np.where(times == 4.7, -0.75, 9.0)},
        "drive": lambda t: 1e-6 * t,
    }
    return overbanking(SimpleNamespace(**(values | changed)))  # type: ignore[arg-type]


def test_what_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the last blow since the oscillator passed its rest; since the lever left the other half of its way."""
    found = told(monkeypatch)
    assert (found.name, found.t, found.body, found.pair) == ("overbanks", 3.0, "lever", "contact 1")
    assert found.torque == pytest.approx(3e-6, rel=1e-12, abs=0.0)
    assert f"from outside at −{math.degrees(1.0):.3g}° (contact 1); wheel, under 3 µN·m, is not unlocked" in found.message
    assert found.message.startswith("t = 3.0000 s  the watch overbanks: lever went over while balance was away")


@pytest.mark.parametrize(("passed", "over"), [(3.81, False), (3.8, True), (3.79, True)])
def test_half_swings_that_are_still_going_on_say_nothing(monkeypatch: pytest.MonkeyPatch, passed: float, over: bool) -> None:
    """A whole period must have gone by since the oscillator passed its rest; of the lever's passages none counts."""
    rows = tuple((passed, *row[1:]) if row is PASSED else row for row in USUAL)
    assert (told(monkeypatch, rows) is not None) is over


def test_without_any_passage_the_start_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch, USUAL[-2:]) is not None
    assert told(monkeypatch, USUAL[-2:], found=SimpleNamespace(nominal_period=5.0005)) is None
    assert told(monkeypatch, USUAL[-2:], found=SimpleNamespace(nominal_period=4.9995)) is not None


@pytest.mark.parametrize("kind", [EventKind.IMPACT, EventKind.CLOSE, EventKind.HANDOVER, EventKind.OPEN])
def test_only_blows_since_then_count(monkeypatch: pytest.MonkeyPatch, kind: EventKind) -> None:
    meets = (4.7, kind, PIN, -1)
    assert (told(monkeypatch, (PASSED, meets)) is not None) is (kind != EventKind.OPEN)
    assert told(monkeypatch, (PASSED, (3.5, EventKind.IMPACT, PIN, -1))) is None
    assert told(monkeypatch, (PASSED,)) is None


@pytest.mark.parametrize(
    "changed",
    [
        {"lever": None},
        {"has_banking": False, "contacts": lambda body, others: set()},
        {"has_shapes": False},
        {"recorded": lambda times: times != 4.7},
        {"holding": [TOOTH]},
        {"arms": {PIN: 0.5e-3, BANK: 0.2e-3}},
        {"holding": [OTHER_BANK, BANK], "arms": {PIN: 0.5e-3, BANK: -0.2e-3, OTHER_BANK: 0.1e-3}},
    ],
)
def test_where_it_cannot_be_said_nothing_is(monkeypatch: pytest.MonkeyPatch, changed: dict[str, Any]) -> None:
    assert told(monkeypatch, **changed) is None


@pytest.mark.parametrize("first", [0.3, -0.3])
@pytest.mark.parametrize(
    ("held", "pressed"), [((-2.0,), True), ((2.0,), False), ((0.0,), False), ((-2.0, -5.0), True), ((-2.0, 5.0), False)]
)
def test_a_blow_must_press_the_lever_on_all_that_hold_it(first: float, held: tuple[float, ...], pressed: bool) -> None:
    arms = [first, *(math.copysign(1.0, first) * arm for arm in held)]
    found: Any = SimpleNamespace(pairs=arms, of=lambda row, body: (arms[row], 7.0) if body == "lever" else (9.0, 9.0))
    assert _pressed_on(found, "lever") is pressed


@pytest.mark.parametrize(
    ("angles", "t"),
    [((0.0, 0.2, 0.12, 0.01), 2.0), ((0.0, 0.2, 0.1, 0.01), 1.0), ((0.5, -0.2, 0.11, 0.2), 1.0), ((0.3, 0.3, 0.3, 0.3), 0.0)],
)
def test_when_the_lever_left_the_other_half_of_its_way(angles: tuple[float, ...], t: float) -> None:
    run = SimpleNamespace(q=np.array([angles]).T, t=np.arange(4.0), slices={"lever": slice(0, 1)})
    watch: Any = SimpleNamespace(run=run, lever="lever")
    assert _went_over(watch) == t
