"""Which curves are followed together, which halved, and when is one arc enough?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from watchsim.geometry import fitting as fitting
from watchsim.geometry.biarcs import GLANCE, PAUSE, ArcChain, Bundle, Curve, _interval_bounds
from watchsim.geometry.fitting import (
    BRISK,
    THOROUGH,
    Effort,
    Fit,
    _end_to_end,
    _extent,
    _follow,
    _one_arc_each,
    batches,
    fit_all,
)
from watchsim.geometry.primitives import Line

Corners = list[tuple[float, float]]


def curve_of(*spans: Corners, breaks: list[float] | None = None) -> Curve:
    p = np.array(spans, dtype=float)
    control = np.concatenate((p, np.ones((*p.shape[:2], 1))), axis=2)
    return Curve(control, np.arange(len(p) + 1.0) if breaks is None else np.array(breaks))


STRAIGHT = curve_of([(0.0, 0.0), (1.5e-3, 2e-3), (3e-3, 4e-3)])  # 5 mm


def test_curves_of_one_degree_go_together_some_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fitting, "AT_ONCE", 2)
    cubic = curve_of([(0, 0), (1, 0), (2, 1), (3, 1)])
    assert list(batches([STRAIGHT, cubic, STRAIGHT, STRAIGHT, cubic])) == [[0, 2], [3], [1, 4]]
    assert (STRAIGHT.degree, cubic.degree) == (2, 3)


@pytest.mark.parametrize(("many", "effort"), [(3, THOROUGH), (2, BRISK)])
def test_effort_is_spared_where_there_are_many_spans(monkeypatch: pytest.MonkeyPatch, many: int, effort: Effort) -> None:
    """Three spans of two curves."""
    seen = []

    def follow(curves: list[Curve], tolerance: np.ndarray, chosen: Effort, depth: int) -> list[Fit]:
        seen.append((len(curves), tolerance.tolist(), chosen, depth))
        return [Fit((), 1.0 + k) for k in range(len(curves))]

    monkeypatch.setattr(fitting, "MANY_FIT", many)
    monkeypatch.setattr(fitting, "_follow", follow)
    monkeypatch.setattr(fitting, "smooth_parts", lambda curves, _: [curves[1:] * 2, curves[:1]])
    both = [STRAIGHT, curve_of([(0, 0), (1, 0), (2, 1)], [(2, 1), (3, 2), (3, 3)])]
    assert [fit.deviation for fit in fit_all(both, [1e-6, 2e-6])] == [2.0, 3.0]
    assert seen == [(3, [1e-6, 1e-6, 2e-6], effort, 0)]


def test_where_no_chain_is_found_halves_are_followed_with_less_patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lengths of 5, 2.5, 1.25 and 0.625 mm; chords do where they are within the tolerance."""
    asked = []

    def none(curves: list[Curve], tolerance: np.ndarray, rounds: int, effort: Effort) -> list[None]:
        asked.append((len(curves), set(tolerance.tolist()), rounds, effort))
        return [None] * len(curves)

    monkeypatch.setattr(fitting, "_chains", none)
    whole, short = _follow([STRAIGHT, curve_of([(1, 1), (1, 1), (1, 1)])], np.array([1e-3, 2e-3]), BRISK, 0)
    assert short == Fit((), 0.0)
    assert asked == [
        (2, {1e-3, 2e-3}, 20, BRISK), (2, {1e-3}, 6, BRISK), (4, {1e-3}, 6, BRISK), (8, {1e-3}, 6, BRISK)
    ]  # fmt: skip
    assert whole.deviation == pytest.approx(0.625e-3, rel=1e-9, abs=0.0) and len(whole.edges) == 8
    for k, edge in enumerate(whole.edges):
        assert isinstance(edge, Line) and edge.start == pytest.approx((k * 3e-3 / 8, k * 4e-3 / 8), rel=1e-9, abs=1e-15)
    monkeypatch.setattr(fitting, "DEEPEST", 2)
    (given_up,) = _follow([STRAIGHT], np.array([1e-9]), BRISK, 0)
    assert len(given_up.edges) == 4 and given_up.deviation == pytest.approx(1.25e-3, rel=1e-9, abs=0.0)


def test_fits_end_to_end_deviate_by_the_most() -> None:
    one, two, three = Line(0.0, 0.0, 1.0, 0.0), Line(1.0, 0.0, 2.0, 3.0), Line(2.0, 3.0, 5.0, 5.0)
    assert _end_to_end([Fit((one, two), 3.0), Fit((), 7.0), Fit((three,), 5.0)]) == Fit((one, two, three), 7.0)
    alone = Fit((one,), 3.0)
    assert _end_to_end([alone]) is alone


def test_the_extent_of_a_curve_is_the_diagonal_of_its_box() -> None:
    assert _extent(STRAIGHT) == pytest.approx(5e-3, rel=1e-12, abs=0.0)
    back = curve_of([(0, 0), (4, 6), (0, 12)], [(0, 12), (-1, 14), (-2, 7)])  # to x = 2 and y = 12.444…
    assert _extent(back) == pytest.approx(math.hypot(4.0, 12.0 + 4.0 / 9.0), rel=1e-3)


@pytest.mark.parametrize(("kink", "found"), [(0.9e-6, True), (-0.9e-6, True), (1.1e-6, False), (-1.1e-6, False)])
def test_one_line_is_enough_where_the_curve_ends_in_its_direction(kink: float, found: bool) -> None:
    (alone,) = _one_arc_each(Bundle([curve_of([(0, 0), (1, 0), (2, -kink), (3, 0)])]), np.array([1e-3]))
    assert (alone is not None) is found
    if alone is not None:
        assert alone.deviation == pytest.approx(abs(kink) * 4.0 / 9.0, rel=0.02, abs=0.0)


def test_one_line_is_not_enough_where_it_is_too_far_or_ends_backwards() -> None:
    curves = [
        curve_of([(0, 0), (1, 0), (2, -0.9e-6), (3, 0)]),
        curve_of([(0, 0), (1, 0), (4, 0), (3, 0)]),
        curve_of([(0, 0), (1, 0), (2, 0), (3, 0)]),
    ]
    found = _one_arc_each(Bundle(curves), np.array([0.38e-6, 10.0, 1e-9]))
    assert [chain is not None for chain in found] == [False, False, True]
    assert _one_arc_each(Bundle(curves), np.array([0.42e-6, 10.0, 1e-9]))[0] is not None


@pytest.mark.parametrize(("share", "still"), [(0.97, True), (1.03, False)])
def test_a_slow_curve_shows_its_direction_down_to_a_share_of_its_usual_speed(share: float, still: bool) -> None:
    """x = (t - a)², y = v t in the first of two spans, three times as wide as the second; slowest at a."""
    a = 0.3

    def two(v: float) -> Bundle:
        slow: Corners = [(a * a, 0.0), (a * a - a, 0.5 * v), ((1.0 - a) ** 2, v)]
        x = (1.0 - a) ** 2
        return Bundle([curve_of(slow, [(x, v), (x + 1.0, v), (x + 2.0, v)], breaks=[0.0, 3.0, 4.0])])

    usual = float(two(0.0).lengths.sum()) / 4.0
    v = share * PAUSE * usual * 3.0
    (way,) = two(v).tangents(np.array([a]))
    beside = math.hypot(2.0 * GLANCE, v)
    expected = (2.0 * GLANCE / beside, v / beside) if still else (0.0, 1.0)
    assert way == pytest.approx(expected, abs=1e-4)


def test_a_curve_is_open_by_its_gap_over_its_control_polygon_whatever_its_weights() -> None:
    control = np.array(
        [[(0.0, 0.0, 2.0), (9.0, 0.0, 3.0), (2.0, 2.0, 0.5)], [(4.0, 4.0, 1.0), (8.0, 0.0, 2.0), (2.0, 0.0, 1.0)]]
    )
    corners = [(0.0, 0.0), (3.0, 0.0), (4.0, 4.0), (4.0, 4.0), (4.0, 0.0), (2.0, 0.0)]
    length = sum(math.dist(p, q) for p, q in pairwise(corners))
    curve = Curve(control, np.array([0.0, 2.0, 7.0]))
    assert curve.open_by() == pytest.approx(2.0 / length, rel=1e-12) and curve.degree == 2
    one, other = curve.split(1.25)
    assert one.breaks.tolist() == [0.0, 2.0, 3.25] and other.breaks.tolist() == [3.25, 7.0]
    assert np.array_equal(one.control[0], control[0]) and len(one.control) == 2 and len(other.control) == 1
    first, rest = curve.split(0.25)
    assert first.breaks.tolist() == [0.0, 0.5] and rest.breaks.tolist() == [0.5, 2.0, 7.0]
    assert np.array_equal(rest.control[1], control[1]) and len(first.control) == 1


@pytest.mark.parametrize(("weights", "times"), [((1.0, 1.0, 1.0), 1.0), ((1.0, 1.5, 2.0), 4.0)])
def test_a_bound_may_be_too_large_by_what_unequal_weights_add(weights: tuple[float, ...], times: float) -> None:
    """A line 1 µm beside an arc that is straight; weights from 1 to 2 are only known to be so."""
    w = np.array(weights)
    x = np.array([1.0, 2.0, 4.0])
    control = np.column_stack((x * w, 1e-6 * w, w))[None]
    bundle = Bundle([Curve(control, np.array([0.0, 1.0]))])
    way = np.array([(1.0, 0.0)])
    arcs = ArcChain(np.array([(1.0, 0.0)]), way, np.array([(4.0, 0.0)]), way, np.zeros(1))
    bound, slack = _interval_bounds(bundle, np.array([0.0]), np.array([1.0]), np.array([0]), arcs)
    assert bound == pytest.approx([times * 1e-6], rel=1e-6, abs=0.0)
    assert slack == pytest.approx([(times - 1.0) * 1e-6], rel=1e-6, abs=1e-13)
