"""Which ends of strokes that meet at one place go on into each other?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.drawing.nodes import _linked


@pytest.mark.parametrize("seed", range(20))
def test_strokes_of_one_run_follow_each_other(seed: int) -> None:
    """End 2k is the start of stroke k, 2k + 1 its end: that goes on into 2k + 2 where both are here and of one run."""
    rng = np.random.default_rng(seed)
    strokes: list[Any] = [SimpleNamespace(run=run) for run in np.sort(rng.integers(0, 4, 10)).tolist()]
    members = rng.permutation(20)[: rng.integers(3, 19)].tolist()
    pairs = [
        (2 * k + 1, 2 * k + 2)
        for k in range(9)
        if {2 * k + 1, 2 * k + 2} <= set(members) and strokes[k].run == strokes[k + 1].run
    ]
    partner: dict[int, int] = {}
    left = _linked(members, strokes, partner)
    assert partner == {**dict(pairs), **{b: a for a, b in pairs}}
    assert left == sorted(set(members).difference(*pairs))
