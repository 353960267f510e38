"""From which residual and which overlap on is a run doubted, and which step is proposed?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

import watchsim as ws
from watchsim.analysis.doubts import doubts
from watchsim.mechanism.compile import scene_size
from watchsim.simulation.methods import MOREAU

SCENE = ws.load(ws.profiles_dir() / "incline")
DEEP = 0.005 * scene_size(SCENE)


def said(residual: float = 0.0, overlap: float = 0.0, step: float | None = 20e-6, method: str = MOREAU) -> list[str]:
    values = {"worst_residual": residual, "worst_penetration": overlap, "step": step, "method": method}
    run: Any = SimpleNamespace(scene=SCENE, **values)
    return list(doubts(run))


@pytest.mark.parametrize("overlap", [0.0, 0.99 * DEEP])
def test_small_ones_are_passed_over(overlap: float) -> None:
    assert said(0.99e-6, overlap) == []


def test_each_is_said_with_its_number() -> None:
    (unsolved,) = said(residual=1.01e-6)
    assert unsolved.startswith("a contact problem was left with a residual of 1e-06 of its largest term")
    (coarse,) = said(overlap=1.01 * DEEP)
    assert coarse.startswith(f"the step of 20 µs is too coarse: bodies overlapped by {1.01e6 * DEEP:.2g} µm.")
    assert '--step "4 µs"' in coarse
    assert len(said(1.0, 1.0)) == 2


def test_only_fixed_steps_are_too_coarse() -> None:
    assert said(overlap=1.0, method="pfeiffer-glocker") == said(overlap=1.0, step=None) == []
