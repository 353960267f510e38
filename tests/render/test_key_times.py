"""Which rows and instants of a run are kept for a movie?"""

from __future__ import annotations

import math
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.render.keyframes import EVENLY, _instants
from watchsim.render.movie import _plan
from watchsim.render.rows import kept_rows


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("count", [0, 1, 2, 3, 50])
def test_between_rows_that_are_kept_everything_fits(seed: int, count: int) -> None:
    """Asked only where rows lie between; the first, the last and those that are asked for stay."""
    rng = np.random.default_rng(seed)
    rough, ends = rng.random(max(count, 1)) < 0.1, tuple(rng.integers(0, max(count, 1), 2).tolist()) if count else ()

    def fits(i: int, j: int) -> bool:
        assert j > i + 1
        return not rough[i + 1 : j].any()

    kept = kept_rows(count, fits, ends).tolist()
    assert kept == sorted(set(kept)) and ({0, count - 1, *ends} <= set(kept) if count else kept == [])
    assert all(j == i + 1 or fits(i, j) for i, j in pairwise(kept))
    assert count < 50 or rough.any() or len(kept) <= 4


@pytest.mark.parametrize("apart", [1e-9, 0.003, 0.02])
def test_of_instants_close_together_the_first_is_kept(apart: float) -> None:
    rows = np.sort(np.random.default_rng(3).uniform(0.0, 2.0, 300))
    run: Any = SimpleNamespace(t=rows)
    found = _instants(run, (0.5, 1.5), apart)
    every = sorted({*np.linspace(0.5, 1.5, EVENLY).tolist(), *(t for t in rows.tolist() if 0.5 < t < 1.5)})
    wanted: list[float] = []
    for t in every:
        if not wanted or math.floor((t - 0.5) / apart) > math.floor((wanted[-1] - 0.5) / apart):
            wanted.append(t)
    assert found.tolist() == [*wanted[:-1], 1.5]


def test_a_window_without_length_is_one_instant() -> None:
    run: Any = SimpleNamespace(t=np.linspace(0.0, 2.0, 5))
    assert _instants(run, (0.7, 0.7), 0.01).tolist() == [0.7]


@pytest.mark.parametrize("fps", [0.9, 240.5, math.nan, math.inf])
def test_rates_of_frames_that_no_movie_has(fps: float) -> None:
    with pytest.raises(ValueError, match="give 1 to 240 frames per second"):
        _plan(None, (0.0, 1.0), 1.0, None, fps, False)  # type: ignore[arg-type]
