"""How far must a wheel run ahead before it has tripped?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing.escape_wheel import Advance
from watchsim.analysis.verdicts import tripping as module
from watchsim.analysis.verdicts.tripping import _mislocked, _run_past, _running_free, _slip, tripping
from watchsim.simulation.event_kinds import EVENT_DTYPE


@pytest.mark.parametrize(
    ("angles", "times", "start"),
    [
        ((0, 1, 2, 3, 4), 0, None),
        ((0, 2, 3, 4, 5), 0, None),  # the wheel may start on either side of a half swing
        ((0, 3, 4, 5, 6), 1, 0.0),  # two half pitches too many in the first
        ((0, 1, 2, 4, 5), 1, 0.25),
        ((0, 0, 2, 3, 4), 0, None),  # a step caught up
        ((0, 1, 3, 5, 6), 2, 0.125),
    ],
)
@pytest.mark.parametrize("before", [0, 7])
def test_half_pitches_that_no_half_swing_let_go(
    monkeypatch: pytest.MonkeyPatch, angles: tuple[int, ...], times: int, start: float | None, before: int
) -> None:
    """`before`: half swings of the run of which nothing was kept. `start` of the first half swing that was too many, s."""
    half_swings = before + np.arange(len(angles), dtype=float)
    # The wheel may stand anywhere at the start, and less than half a half pitch off its place at the turning points.
    off = np.array([0.0, 0.4, -0.4, 0.3, -0.3])
    monkeypatch.setattr(module, "advance", lambda *_: Advance(0.2, half_swings, 0.37 + 0.2 * (angles + off)))
    ends = 0.125 * np.arange(1.0, len(angles))
    found = SimpleNamespace(end=ends, start=ends - 0.125, before=before)
    watch: Any = SimpleNamespace(
        **{"run": None, "wheel": "wheel", "lever": "lever", "oscillator": "balance", "found": found, "pitch": 0.4},
        events=lambda *_: np.zeros(0, EVENT_DTYPE),
        drive=lambda _: 1e-6,
    )
    verdict = _run_past(watch)
    assert (verdict.count if verdict else 0) == times
    assert (verdict.t if verdict else None) == start


OPENED = [(0.1, 3), (0.25, 0), (0.3, 1), (0.34, 2), (0.5, 1), (0.51, 0)]  # s, contact
PROGRESS = {0.1: -0.4, 0.25: 0.0, 0.3: 0.15, 0.34: 0.31, 0.5: 0.35, 0.51: 0.9}  # rad; 0.7 at the start of the half swing


@pytest.mark.parametrize(
    ("start", "end", "pitch", "slipped"),
    [
        (0.25, 0.5, 0.4, (0.3, "contact 1")),  # 0.3 rad is three quarters of 0.4 rad
        (0.25, 0.5, 0.42, (0.34, "contact 2")),
        (0.25, 0.5, 0.5, (0.5, "contact 1")),
        (0.25, 0.499, 0.5, (0.34, "contact 2")),
        (0.26, 0.5, 0.18, (0.3, "contact 1")),  # all are too far: the first
        (0.24, 0.27, 0.4, (0.25, "contact 0")),
        (0.35, 0.49, 0.4, (0.35, None)),
        (0.25, 0.5, None, (0.25, None)),
    ],
)
def test_the_contact_that_slipped_is_the_last_before_the_wheel_had_gone_too_far(
    start: float, end: float, pitch: float | None, slipped: tuple[float, str | None]
) -> None:
    """Both ends of the half swing belong to it. The wheel may have started anywhere."""
    held = np.array(OPENED, [("t", float), ("contact", int)])

    def progress(times: np.ndarray) -> np.ndarray:
        return 0.7 + np.array([PROGRESS.get(t, 0.0) for t in times.tolist()])

    for lever, meets in (("lever", "lever"), (None, "balance")):
        watch: Any = SimpleNamespace(
            **{"wheel": "wheel", "lever": lever, "oscillator": "balance", "pitch": pitch, "progress": progress},
            run=SimpleNamespace(pairs=[f"contact {k}" for k in range(4)]),
            events=lambda first, others, *kinds, meets=meets: held if (first, others) == ("wheel", {meets}) else held[:0],
        )
        assert _slip(watch, start, end) == slipped


def test_what_is_said_of_a_wheel_that_ran_past(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "advance", lambda *_: Advance(0.2, np.arange(4.0), 0.2 * np.array([0.0, 1.0, 4.0, 6.0])))
    asked: list[tuple[float, float]] = []

    def slip(watch: Any, start: float, end: float) -> tuple[float, str]:
        asked.append((start, end))
        return 3.5, "tooth on stone"

    monkeypatch.setattr(module, "_slip", slip)
    found = SimpleNamespace(start=np.array([1.0, 3.0, 7.0]), end=np.array([2.9, 6.9, 9.9]), before=0)
    watch: Any = SimpleNamespace(
        run=None, wheel="wheel", lever=None, oscillator="balance", found=found, drive=lambda t: 1e-6 * t
    )
    verdict = _run_past(watch)
    assert verdict is not None and asked == [(3.0, 6.9)]
    assert (verdict.name, verdict.t, verdict.body, verdict.pair, verdict.count) == ("trips", 3.5, "wheel", "tooth on stone", 2)
    assert verdict.torque == pytest.approx(3.5e-6, rel=1e-12, abs=0.0)
    words = "wheel ran past balance twice, first from tooth on stone, under 3.5 µN·m"
    assert verdict.message == f"t = 3.5000 s  the watch trips: {words}"


@pytest.mark.parametrize("rows", [None, 0, 1])
def test_what_was_not_recorded_has_not_run_past(monkeypatch: pytest.MonkeyPatch, rows: int | None) -> None:
    known = None if rows is None else Advance(0.2, np.arange(float(rows)), np.zeros(rows))
    monkeypatch.setattr(module, "advance", lambda *_: known)
    watch: Any = SimpleNamespace(run=None, wheel="wheel", found=None)
    assert _run_past(watch) is None


def test_two_rows_can_tell_of_one_half_swing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "advance", lambda *_: Advance(0.2, np.arange(2.0), np.array([0.0, 0.6])))
    monkeypatch.setattr(module, "_slip", lambda *_: (1.5, None))
    found = SimpleNamespace(start=np.array([1.0]), end=np.array([2.0]), before=0)
    watch: Any = SimpleNamespace(run=None, wheel="w", lever="lever", oscillator="b", found=found, drive=lambda t: 2e-6)
    verdict = _run_past(watch)
    assert verdict is not None and verdict.message == "t = 1.5000 s  the watch trips: w ran past lever once, under 2 µN·m"


def test_what_is_said_of_teeth_that_do_not_lock(monkeypatch: pytest.MonkeyPatch) -> None:
    watch: Any = SimpleNamespace(wheel="wheel", lever="lever", oscillator="balance", drive=lambda t: -1e-6 * t)
    monkeypatch.setattr(module, "unlocked", lambda _: [])
    assert _mislocked(watch) is None
    monkeypatch.setattr(module, "unlocked", lambda _: [(2.5, "tooth on stone", "tooth 3 rests"), (3.5, "", ""), (4.5, "", "")])
    found = _mislocked(watch)
    assert found is not None and (found.name, found.t, found.body, found.count) == ("trips", 2.5, "wheel", 3)
    assert found.message is not None and found.torque == pytest.approx(-2.5e-6, rel=1e-12, abs=0.0)
    told = "the watch trips, 3 times since: tooth 3 rests (tooth on stone) while balance is away, and drives lever off its "
    assert found.message.startswith(f"t = 2.5000 s  {told}banking with 2.5 µN·m at wheel.") and found.pair == "tooth on stone"


def test_what_runs_through_is_told_first(monkeypatch: pytest.MonkeyPatch) -> None:
    watch: Any = SimpleNamespace(wheel="wheel", drive=lambda t: 1e-6 * t)
    for name in ("_running_free", "_run_past", "_mislocked"):
        monkeypatch.setattr(module, name, lambda _, name=name: name)
    assert tripping(watch) == "_running_free"
    monkeypatch.setattr(module, "_running_free", lambda _: None)
    assert tripping(watch) == "_run_past"
    monkeypatch.setattr(module, "_run_past", lambda _: None)
    assert tripping(watch) == "_mislocked"
    monkeypatch.undo()
    monkeypatch.setattr(module, "running_free", lambda _: (1.5, "wheel runs through"))
    found = _running_free(watch)
    assert found is not None and (found.name, found.t, found.body, found.pair) == ("trips", 1.5, "wheel", None)
    assert found.message == "t = 1.5000 s  the watch trips: wheel runs through, and nothing locks it, under 1.5 µN·m"
    monkeypatch.setattr(module, "running_free", lambda _: None)
    assert _running_free(watch) is None
