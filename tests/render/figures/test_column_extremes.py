"""Does a thinned curve look like the whole one, and does every spike survive?"""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from watchsim.render.rows import COLUMNS, bands, distinct, reduced

Areas = Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]]  # x, lower and upper edge

MILLION = 1_000_000
X = np.linspace(0.0, 180.0, MILLION)
QUIET = np.sin(3.0 * X)


@given(st.integers(0, MILLION - 1), st.sampled_from([-50.0, 3.0, 1e6]))
@settings(max_examples=25)
def test_a_spike_of_one_sample_in_a_million_survives(place: int, height: float) -> None:
    y = QUIET.copy()
    y[place] = height
    x, kept = reduced(X, y)
    assert len(x) <= 4 * COLUMNS + 8
    assert (X[place], height) in set(zip(x[kept == height].tolist(), kept[kept == height].tolist(), strict=True))
    assert np.all(np.diff(x) >= 0.0)


@pytest.mark.parametrize("columns", [1, 7, 100])
def test_every_column_keeps_its_first_last_least_and_largest(columns: int) -> None:
    """Columns divide the whole width evenly: by plain counting, one column after the other."""
    x = np.arange(40.0 * columns)
    y = np.random.default_rng(3).standard_normal(len(x))
    kept = set(reduced(x, y, columns)[0].tolist())
    place = np.minimum(np.floor(columns * x / x[-1]), columns - 1)
    expected = set()
    for k in range(columns):
        own = np.flatnonzero(place == k)
        expected |= {float(i) for i in (own[0], own[-1], own[np.argmin(y[own])], own[np.argmax(y[own])])}
    assert kept == expected
    assert [len(low) for _, low, _ in bands(x, y, columns)] == [columns]


def pixels(x: np.ndarray, y: np.ndarray, columns: int, areas: Areas = ()) -> np.ndarray:
    """A curve and areas over the whole width, edges one dot thick and without shades between ink and paper."""
    figure = Figure(figsize=(columns / 100.0, 3.0), dpi=100)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.axis("off")
    (line,) = axes.plot(x, y, color="black", linewidth=0.72, antialiased=False)
    line.get_path().should_simplify = False  # matplotlib's own thinning is not what is tested
    for area in areas:
        axes.fill_between(*area, color="black", linewidth=0.72, antialiased=False)
    axes.set_xlim(0.0, 180.0)
    axes.set_ylim(-5.0, 5.0)
    out = io.BytesIO()
    figure.savefig(out, format="raw")
    return np.frombuffer(out.getvalue(), np.uint8).reshape(300, columns, 4)[..., 0]


def test_the_picture_is_that_of_all_points() -> None:
    rng = np.random.default_rng(7)
    y = QUIET + 0.3 * rng.standard_normal(MILLION) * (rng.random(MILLION) > 0.999)
    dots = 800
    assert len(reduced(X, y)[0]) < MILLION / 50
    whole, thin = pixels(X, y, dots), pixels(*reduced(X, y), dots)
    assert np.mean(whole == 0) > 0.02 and np.mean(whole != thin) < 5e-3  # rounding at the edges of the ink


@pytest.mark.parametrize("swings", [0.5, 20.0, 200.0, 5000.0])
def test_an_area_covers_what_the_curve_covers(swings: float) -> None:
    rng = np.random.default_rng(9)
    y = np.sin(2.0 * np.pi * swings / 180.0 * X) + 3.0 * (rng.random(MILLION) > 0.99999)
    dots = 400
    areas = bands(X, y, 2 * dots)
    whole, filled = pixels(X, y, dots), pixels(X[:0], y[:0], dots, areas)
    assert len(areas) == 1 and len(areas[0][0]) == 2 * dots
    ink, other = whole == 0, whole != filled
    # Only dots at an edge may differ: those with paper and ink around them.
    around = [np.roll(ink, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    at_edge = np.any(around, axis=0) & ~np.all(around, axis=0)
    assert not np.any(other & ~at_edge) and np.mean(other) < 2e-2


def test_areas_end_at_gaps_and_few_points_are_a_curve() -> None:
    y = QUIET.copy()
    y[300_000:600_000] = np.nan
    (first, low, high), (second, *_) = bands(X, y)
    assert (first[0], second[-1]) == (X[0], X[-1])
    assert abs(first[-1] - X[299_999]) < 180.0 / COLUMNS and abs(second[0] - X[600_000]) < 180.0 / COLUMNS
    assert np.nanmin(low) >= -1.0 and np.nanmax(high) <= 1.0 and np.all(low <= high)
    assert bands(X[:1000], QUIET[:1000]) == [] == bands(X[:0], QUIET[:0])


def test_every_column_reaches_as_far_as_with_all_points() -> None:
    y = QUIET + 0.3 * np.random.default_rng(8).standard_normal(MILLION)
    x, kept = reduced(X, y)

    def reaches(t: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        begins = np.searchsorted(t, np.linspace(0.0, 180.0, COLUMNS + 1)[:-1] + 1e-12)
        return np.minimum.reduceat(values, begins), np.maximum.reduceat(values, begins)

    for whole, thin in zip(reaches(X, y), reaches(x, kept), strict=True):
        assert np.array_equal(whole, thin)


def test_gaps_stay_gaps_and_short_curves_stay_whole() -> None:
    y = QUIET.copy()
    y[300_000:300_003] = np.nan
    x, kept = reduced(X, y)
    gap = np.flatnonzero(np.isnan(kept))
    assert len(gap) and X[300_000] in x[gap]
    assert X[299_999] in x and X[300_003] in x
    few = reduced(X[:1000], QUIET[:1000])
    assert few[0] is not None and len(few[0]) == 1000


def test_an_impact_keeps_both_its_velocities() -> None:
    x = np.sort(np.concatenate((X, [90.0, 90.0])))
    y = np.where(x < 90.0, 1.0, 2.0)
    first = int(np.searchsorted(x, 90.0))
    y[first] = 1.0
    kept_x, kept = reduced(x, y)
    assert {1.0, 2.0} <= set(kept[kept_x == 90.0].tolist())


def test_a_closed_curve_keeps_every_dot_it_visits() -> None:
    angle = np.linspace(0.0, 2000.0, MILLION)
    x, y = np.cos(angle), np.sin(angle)
    y[777_777] = 40.0
    kept_x, kept_y = distinct(x, y)
    assert kept_y.max() == 40.0 and len(kept_x) <= MILLION
    still = distinct(np.full(MILLION, 1.0), np.full(MILLION, 2.0))
    assert len(still[0]) <= 2


@pytest.mark.parametrize("count", [0, 1, 2])
def test_nothing_to_thin(count: int) -> None:
    x, y = reduced(X[:count], QUIET[:count])
    assert len(x) == count and len(y) == count
