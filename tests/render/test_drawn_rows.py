"""Is what is left of a long curve all that can be seen of it?"""

from __future__ import annotations

import numpy as np

from watchsim.render.drawn_rows import DOTS, STRETCHES, drawn


def test_a_short_curve_is_drawn_as_it_is() -> None:
    x = np.linspace(0.0, 1.0, DOTS)
    assert np.array_equal(drawn(x, np.sin(9.0 * x)), np.arange(DOTS))


def test_ends_and_extremes_of_every_stretch_stay() -> None:
    rng = np.random.default_rng(1)
    x = np.sort(rng.uniform(3.0, 8.0, 7 * DOTS))
    y = rng.normal(size=len(x))
    seen = drawn(x, y)
    assert len(seen) < 0.8 * len(x) and seen[0] == 0 and seen[-1] == len(x) - 1
    kept = np.zeros(len(x), bool)
    kept[seen] = True
    number = np.minimum(((x - x[0]) * (STRETCHES / (x[-1] - x[0]))).astype(int), STRETCHES - 1)
    for one in rng.integers(0, STRETCHES, 200):
        own = np.flatnonzero(number == one)
        if len(own):
            assert kept[own[[0, -1, np.argmin(y[own]), np.argmax(y[own])]]].all()


def test_gaps_stay_gaps() -> None:
    x = np.linspace(0.0, 1.0, 3 * DOTS)
    y = np.where((x > 0.3) & (x < 0.4), np.nan, x)
    assert np.isnan(y[drawn(x, y)]).sum() == np.isnan(y).sum()
