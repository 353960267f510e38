"""How many teeth must pass in the last window before a wheel runs through?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.verdicts import running_free as module
from watchsim.analysis.verdicts.running_free import running_free

PERIOD, PITCH, WINDOW = 0.25, 0.4, (10.0, 20.0)
LET_GO = 41.0  # teeth: one in each period of the window, and one at its border


def found(monkeypatch: pytest.MonkeyPatch, teeth: float, **changes: object) -> tuple[float, str] | None:
    monkeypatch.setattr(module, "last_window", lambda _, period: WINDOW if period == PERIOD else None)
    values: dict[str, object] = {
        **{"run": None, "found": SimpleNamespace(nominal_period=PERIOD), "wheel": "wheel", "pitch": PITCH},
        "recorded": lambda ends: np.isin(ends, WINDOW),
        "progress": lambda ends: 3.0 + (ends - WINDOW[0]) / np.ptp(WINDOW) * teeth * PITCH,
    }
    watch: Any = SimpleNamespace(**(values | changes))
    return running_free(watch)


def test_twice_what_the_oscillator_lets_go(monkeypatch: pytest.MonkeyPatch) -> None:
    assert found(monkeypatch, 1.99 * LET_GO) is None
    start, words = found(monkeypatch, 2.01 * LET_GO) or (0.0, "")
    assert start == 10.0
    assert words == f"wheel runs through, {2.01 * LET_GO * PITCH / (2.0 * np.pi):.3g} turns from t = 10.0000 s to t = 20.0000 s"


def test_nothing_is_said_of_what_nobody_knows(monkeypatch: pytest.MonkeyPatch) -> None:
    assert found(monkeypatch, 1000.0, pitch=None) is None
    assert found(monkeypatch, 1000.0, recorded=lambda ends: np.array([False, True])) is None
