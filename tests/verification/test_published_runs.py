"""Would a woodpecker that moves otherwise than the published ones be noticed? Its events are made up, one of them is off."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.verification.compared import Row
from watchsim.verification.woodpecker import published as module
from watchsim.verification.woodpecker.published import published_rows
from watchsim.verification.woodpecker.toy import BEAK, LOWER, UPPER, Toy
from watchsim.verification.woodpecker.woodpecker_cycle import Cycle

FRAME = 0.43 / 643.0  # s; 644 frames of the animation
SEEN = [  # what happens and in which frame
    *(("reverse", LOWER, 32), ("slip", LOWER, 91), ("open", LOWER, 100), ("impact", UPPER, 116), ("impact", BEAK, 121)),
    *(("impact", UPPER, 122), ("open", UPPER, 124), ("impact", LOWER, 177), ("impact", LOWER, 182)),
]
LATER = [("reverse", LOWER, 250), ("end", -1, 448)]


def moment(cause: str, contact: int, frame: float) -> Any:
    return SimpleNamespace(cause=cause, contact=contact, t=(frame + 0.5) * FRAME, q=np.array([-0.02, 0.3, 0.7]))


def rows(monkeypatch: pytest.MonkeyPatch, first: list[Any], peck: list[Any], end: tuple[float, float]) -> list[Row]:
    asked: list[float] = []

    def moments(model: object, e: np.ndarray, v: np.ndarray, until: float) -> Any:
        asked.append(until)
        last = moment(*LATER[1])
        last.q = np.array([end[0], 55.0, end[1]])
        return iter([moment("start", -1, -0.5), *first, moment(*LATER[0]), last])

    monkeypatch.setattr(module, "moments", moments)
    found = published_rows(Toy(), Cycle(peck, 0.146, 7e-3, 0.0, -0.8))
    assert asked == [0.29998]
    return found


def told(
    monkeypatch: pytest.MonkeyPatch, first: list[Any] | None = None, peck: list[Any] | None = None, end: Any = (-0.0413, -0.34)
) -> list[float]:
    """What the four rows have got, where nothing else is off."""
    own = [moment("slip", LOWER, 0), *(moment(*one) for one in [*SEEN[2:], *SEEN[:2]])]
    found = rows(monkeypatch, first or [moment(*one) for one in SEEN], peck or own, end)
    return [row["got"] for row in found]


def test_what_is_expected_and_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each of the five impacts may come a step of 0.1 ms early or late; at 250 rad/s a step of 20 µs is 5 mrad."""
    found = rows(monkeypatch, [moment(*one) for one in SEEN], [moment("slip", LOWER, 0)] * 10, (-0.04, -0.3))
    assert [row["expected"] for row in found] == [0.0, 0.0, -0.04134818676833654, -0.3409339755504301]
    assert [row["tolerance"] for row in found] == pytest.approx([0.0, 5e-4, 5e-3, 5e-3], rel=1e-12, abs=0.0)
    assert ["height" in row["quantity"] for row in found] == [False, False, True, False]
    assert all("at 0.29998 s" in row["quantity"] for row in found[2:])


def test_all_as_published(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch) == [0.0, 0.0, -0.0413, -0.34]


@pytest.mark.parametrize("place", range(9))
@pytest.mark.parametrize(("cause", "contact"), [("end", None), (None, 7)])
def test_an_event_of_another_kind_or_place(
    monkeypatch: pytest.MonkeyPatch, place: int, cause: str | None, contact: int | None
) -> None:
    """In the first peck, in the cycle, and in both."""
    spoilt = [
        (cause or a, b if contact is None else contact, k) if i == place else (a, b, k) for i, (a, b, k) in enumerate(SEEN)
    ]
    first = [moment(*one) for one in spoilt]
    peck = [moment("slip", LOWER, 0), *(moment(*one) for one in [*spoilt[2:], *spoilt[:2]])]
    assert told(monkeypatch, first)[0] == 1.0
    assert told(monkeypatch, peck=peck)[0] == 1.0
    assert told(monkeypatch, first, peck)[0] == 2.0


@pytest.mark.parametrize("place", [0, 3, 8])
@pytest.mark.parametrize(("off", "outside"), [(-0.7, 0.2), (-0.4, 0.0), (0.4, 0.0), (0.9, 0.4)])
def test_an_event_outside_its_frame(monkeypatch: pytest.MonkeyPatch, place: int, off: float, outside: float) -> None:
    first = [moment(*one) for one in SEEN]
    first[place].t += off * FRAME
    assert told(monkeypatch, first)[1] == pytest.approx(outside * FRAME, rel=1e-9, abs=1e-15)


def test_the_farthest_outside_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    first = [moment(*one) for one in SEEN]
    first[2].t -= 0.8 * FRAME
    first[5].t += 0.6 * FRAME
    assert told(monkeypatch, first)[1] == pytest.approx(0.3 * FRAME, rel=1e-9, abs=0.0)
