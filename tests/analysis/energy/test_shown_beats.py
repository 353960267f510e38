"""Which beats are shown, and what do friction and books say of them?"""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timeline import shown_beats as module
from watchsim.analysis.timeline.shown_beats import Beat, shown_beats

PERIOD, END, SIMULATED = 0.7, 20.3, 21.1


def stage(beat: int, name: str, start: float, end: float, rubbed: float) -> Any:
    return SimpleNamespace(
        beat=beat, name=name, phase=SimpleNamespace(start=start, end=end), energy=SimpleNamespace(friction=rubbed)
    )


STAGES = [
    *(stage(4, "unlock", 1.0, 1.5, 0.1), stage(4, "impulse", 1.5, 2.25, 0.2), stage(4, "locked", 2.25, 3.0, 0.3)),
    *(stage(5, "impulse", 3.0, 3.75, 0.7), stage(5, "recoil", 3.75, 4.0, 0.4)),
    *(stage(7, "unlock", 5.0, 5.5, 0.5), stage(7, "impulse", 5.5, 6.0, 0.6)),
    *(stage(8, "impulse", 7.0, 7.5, 0.8), stage(8, "drop", 7.5, 7.625, 0.9), stage(8, "locked", 7.625, 8.0, 1.1)),
    *(stage(9, "unlock", 8.0, 8.25, 1.3), stage(9, "drop", 8.25, 8.5, 1.7)),
]


def shown(monkeypatch: pytest.MonkeyPatch, stages: list[Any], *asked: Any, **changed: Any) -> tuple[list[Beat], list[Any]]:
    """The beats, and the windows for which stages were made."""
    windows: list[Any] = []
    parts = SimpleNamespace(oscillator="balance", wheel="wheel", lever="lever")
    ends = changed.get("ends", [3.0, 19.0, END])

    class Found(SimpleNamespace):
        def __len__(self) -> int:
            return len(self.end)

    monkeypatch.setattr(module, "with_anchor", lambda scene: SimpleNamespace(**(vars(parts) | changed.get("parts", {}))))
    monkeypatch.setattr(module, "can_be_told", lambda run: changed.get("told", True))
    monkeypatch.setattr(module, "beats", lambda run: Found(end=np.array(ends)))
    monkeypatch.setattr(module, "nominal_period", lambda run, name: {"balance": PERIOD}[name])

    def timeline(run: Any, found: Any, window: Any) -> list[Any]:
        windows.append(window)
        return stages

    monkeypatch.setattr(module, "timeline", timeline)
    monkeypatch.setattr(
        module, "friction_by_pair", lambda run, ends: [{"a-b": a, "b-c": 2.0 * (b - a)} for a, b in pairwise(ends)]
    )
    run: Any = SimpleNamespace(scene=None, simulated=SIMULATED)
    return shown_beats(run, *asked), windows


def test_by_default_the_last_two_that_come_to_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of three oscillations and a bit."""
    found, windows = shown(monkeypatch, STAGES)
    assert [beat.stages for beat in found] == [tuple(STAGES[3:5]), tuple(STAGES[7:10])]
    assert windows == [(pytest.approx(END - 3.1 * PERIOD, rel=1e-12), END)]
    _, windows = shown(monkeypatch, STAGES, ends=[])
    assert windows == [(pytest.approx(SIMULATED - 3.1 * PERIOD, rel=1e-12), SIMULATED)]
    (only,), _ = shown(monkeypatch, STAGES[:3])
    assert only.stages == tuple(STAGES[:3])


def test_all_of_a_window(monkeypatch: pytest.MonkeyPatch) -> None:
    found, windows = shown(monkeypatch, STAGES, (0.5, 9.0), False)
    assert [beat.stages for beat in found] == [tuple(STAGES[i:j]) for i, j in pairwise((0, 3, 5, 7, 10, 12))] and windows == [
        (0.5, 9.0)
    ]
    assert all(beat.friction == () for beat in found)


def test_what_is_said_of_a_beat(monkeypatch: pytest.MonkeyPatch) -> None:
    found, _ = shown(monkeypatch, STAGES, (0.5, 9.0))
    first, second = found[:2]
    assert (first.start, first.end, second.start, second.end) == (1.0, 3.0, 3.0, 4.0)
    assert first.first == "beginning of the unlocking" and second.first == "beginning of the impulse"
    assert first.friction == ({"a-b": 1.0, "b-c": 1.0}, {"a-b": 1.5, "b-c": 1.5}, {"a-b": 2.25, "b-c": 1.5})
    assert first.residual == pytest.approx(0.6 - 8.75) and second.residual == pytest.approx(1.1 - 3.0 - 1.5 - 3.75 - 0.5)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"parts": {"oscillator": None}}, "nothing in this scene swings"),
        ({"parts": {"wheel": None}}, "no driven wheel keeps balance swinging"),
        ({"parts": {"lever": None}}, "none stands between wheel and balance"),
        ({"told": False}, "needs a run by events with all of them kept"),
    ],
)
def test_why_there_is_no_timeline(monkeypatch: pytest.MonkeyPatch, changed: Any, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        shown(monkeypatch, STAGES, **changed)


@pytest.mark.parametrize("asked", [(), ((0.5, 9.0),)])
def test_where_no_beat_is_whole(monkeypatch: pytest.MonkeyPatch, asked: Any) -> None:
    with pytest.raises(ValueError, match="no beat of an escapement was recorded whole there"):
        shown(monkeypatch, [], *asked)
    if not asked:
        with pytest.raises(ValueError, match="no beat of an escapement was recorded whole there"):
            shown(monkeypatch, STAGES[5:7])
