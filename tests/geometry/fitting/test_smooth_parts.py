"""Are curves cut where they pause and where their curvature jumps, and nowhere else?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import BPoly

from watchsim.geometry import fitting as smooth
from watchsim.geometry.biarcs import PAUSE, Bundle, Curve
from watchsim.geometry.fitting import bend, cut_at, jumps, pauses, slowest, smooth_parts

Corners = list[list[tuple[float, float]]]


def curve_of(spans: Corners, breaks: list[float] | None = None) -> Curve:
    """Béziers with such control points, metres."""
    p = np.array(spans, dtype=float)
    control = np.concatenate((p, np.ones((*p.shape[:2], 1))), axis=2)
    return Curve(control, np.arange(len(p) + 1.0) if breaks is None else np.array(breaks))


# Quadratic and cubic spans with the same tangents where they meet, of uneven lengths and bends.
FIRST: Corners = [
    [(0, 0), (1, 0.2), (2, 0.6), (3, 1.2)],
    [(3, 1.2), (3.5, 1.5), (3.8, 1.9), (3.9, 2.6)],
    [(3.9, 2.6), (4.0, 3.3), (4.4, 5.0), (6.0, 6.0)],
]
SECOND: Corners = [
    [(0, 0), (0, 1), (-0.5, 2), (-1.5, 2.4)],
    [(-1.5, 2.4), (-2.0, 2.6), (-2.6, 2.7), (-4.0, 2.4)],
]


def measured(span: list[tuple[float, float]]) -> tuple[float, float, float]:
    """Mean curvature from a thousandth to two of the span, the same before its end, and its length by eight chords."""
    p = BPoly(np.array(span)[:, None, :], [0.0, 1.0])
    slope = p.derivative()

    def mean(a: float, b: float) -> float:
        one, other = slope(a), slope(b)
        turn = math.atan2(one[0] * other[1] - one[1] * other[0], one @ other)
        return turn / math.dist(p(a), p(b))

    chords = np.diff(p(np.linspace(0.0, 1.0, 9)), axis=0)
    return mean(1e-3, 2e-3), mean(1.0 - 2e-3, 1.0 - 1e-3), float(np.hypot(*chords.T).sum())


def worth(spans: Corners, tolerance: float) -> list[float]:
    """For each inner break how often the jump is worth an end there."""
    rows = [measured(span) for span in spans]
    reach = []
    for one, other, length in rows:
        arc = (216.0 / math.sqrt(3.0) * tolerance * length / abs(other - one)) ** (1.0 / 3.0)
        reach.append(min(length, arc))
    return [
        abs(rows[k + 1][0] - rows[k][1]) * min(reach[k], reach[k + 1]) ** 2 / (4.0 * tolerance) for k in range(len(rows) - 1)
    ]


@pytest.mark.parametrize(("number", "which"), [(0, 0), (0, 1), (1, 0)])
def test_a_jump_of_curvature_counts_from_four_tolerances_on(number: int, which: int) -> None:
    """The tolerance at which the jump just counts is looked for by halving; a little beside it the answer changes."""
    spans = (FIRST, SECOND)[number]
    low, high = 1e-9, 10.0
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if worth(spans, middle)[which] > 1.0 else (low, middle)
    place = [[1.0, 2.0], [5.0]][number][which]
    for factor in (1.0 - 1e-6, 1.0 + 1e-6):
        tolerance = np.array([1e-4, 1e-4])
        tolerance[number] = low * factor
        expected = [place + k - which for k, times in enumerate(worth(spans, float(tolerance[number]))) if times > 1.0]
        found = [
            t for t in jumps(Bundle([curve_of(FIRST), curve_of(SECOND)]), tolerance).tolist() if (t > 3.5) == (number == 1)
        ]
        assert found == expected and (place in found) == (factor < 1.0)


def test_where_there_are_no_inner_breaks_nothing_jumps() -> None:
    found = jumps(Bundle([curve_of(FIRST[:1]), curve_of(SECOND[:1])]), np.array([1e-9, 1e-9]))
    assert found.shape == (0,)


def test_the_mean_curvature_is_the_turn_over_the_chord() -> None:
    curve = curve_of([[(0, 0), (0.5, 0), (1, 1)], [(1, 1), (1, 1), (1, 1)]])  # the second span stands still
    found = bend(Bundle([curve]), np.array([0.2, 0.9, 1.3]), np.array([0.5, 0.6, 1.4]))
    # x = t, y = t²: slopes (1, 2t).
    turn = math.atan(1.0) - math.atan(0.4), math.atan(1.2) - math.atan(1.8)
    chords = math.hypot(0.3, 0.21), math.hypot(0.3, 0.45)
    assert found == pytest.approx([turn[0] / chords[0], turn[1] / chords[1], 0.0], rel=1e-12, abs=0.0)


def cusp(at: float, slowest_speed: float = 0.0) -> Curve:
    """x = (t - a)², y = v t, so that its speed is v at a, the least; from 0 to 1."""
    a, v = at, slowest_speed
    return curve_of([[(a * a, 0.0), (a * a - a, 0.5 * v), ((1.0 - a) ** 2, v)]])


def test_a_pause_is_found_where_it_is() -> None:
    bundle = Bundle([cusp(0.37), cusp(0.25), cusp(0.9), cusp(0.04), cusp(0.96)])
    assert pauses(bundle) == pytest.approx([0.37, 2.25, 4.9, 6.04, 8.96], abs=1e-8)
    assert pauses(Bundle([cusp(0.25)])).tolist() == [0.25]


@pytest.mark.parametrize(("share", "count"), [(0.97, 1), (1.03, 0)])
def test_what_is_faster_than_a_share_of_the_usual_speed_does_not_pause(share: float, count: int) -> None:
    usual = Bundle([cusp(0.37)]).usual_speed[0]
    assert len(pauses(Bundle([cusp(0.37, share * PAUSE * usual)]))) == count


def test_speed_is_measured_by_the_curves_own_parameter() -> None:
    """A span ten times as wide as its neighbours is slow all along but pauses nowhere."""
    line = curve_of([[(0, 0), (1, 0), (2, 0)], [(2, 0), (3, 0), (4, 0)], [(4, 0), (5, 0), (6, 0)]], [0.0, 1.0, 2e6, 2e6 + 1.0])
    assert len(pauses(Bundle([line]))) == 0


def test_ends_that_pause_are_no_pauses_inside() -> None:
    assert len(pauses(Bundle([cusp(1.0), cusp(0.0), cusp(1.0)]))) == 0


def test_a_corner_at_points_that_coincide_is_a_pause() -> None:
    corner = curve_of([[(0, 0), (1, 0), (1, 0)], [(1, 0), (1, 0), (1, 3)]])
    assert pauses(Bundle([curve_of([[(0, 0), (1, 1), (2, 0)]]), corner])).tolist() == [3.0]


def test_the_slowest_place_between_two_others() -> None:
    bundle = Bundle([cusp(0.37, 0.1), cusp(0.8, 0.2)])
    found = slowest(bundle, np.array([0.3, 2.1]), np.array([0.6, 2.9]))
    assert found == pytest.approx([0.37, 2.8], abs=2e-7)
    assert slowest(bundle, np.array([0.5]), np.array([0.6])) == pytest.approx([0.5], abs=1e-9)
    assert len(slowest(bundle, np.empty(0), np.empty(0))) == 0


def test_a_curve_is_cut_at_ascending_places_several_of_them_in_one_span() -> None:
    curve = curve_of(FIRST, [0.0, 2.0, 3.0, 7.0])
    parts = cut_at(curve, [0.25, 1.0, 2.3, 2.4, 2.9])
    breaks = [0.0, 0.5], [0.5, 2.0], [2.0, 3.0, 4.2], [4.2, 4.6], [4.6, 6.6], [6.6, 7.0]
    for part, expected in zip(parts, breaks, strict=True):
        assert part.breaks == pytest.approx(expected, rel=1e-12)
    whole = Bundle([curve])
    at = whole.points(np.array([0.0, 0.25, 1.0, 2.3, 2.4, 2.9, 3.0]))
    for part, start, end in zip(parts, at[:-1], at[1:], strict=True):
        assert part.ends == pytest.approx(np.array([start, end]), rel=1e-12)
    assert cut_at(curve, []) == [curve]


def test_each_curve_is_cut_at_its_own_places_but_not_into_slivers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three spans from 0 on, two from 4 on, two from 7 on."""
    places = [
        1.1e-4,
        1.3,
        1.3 + 0.9e-4,
        1.3 + 1.1e-4,
        2.0 - 0.9e-4,
        2.0 + 0.9e-4,
        3.0 - 0.9e-4,
        7.0 + 0.9e-4,
        8.5,
        9.0 - 1.1e-4,
    ]
    monkeypatch.setattr(smooth, "jumps", lambda *_: np.array([8.5, *places[:6]]))
    monkeypatch.setattr(smooth, "pauses", lambda *_: np.array([*places[6:], 1.3, 2.0]))
    curves = [curve_of(FIRST), curve_of(SECOND), curve_of(SECOND)]
    one, two, three = smooth_parts(curves, np.array([1e-7, 1e-7, 1e-7]))
    assert [part.breaks[-1] for part in one] == pytest.approx([1.1e-4, 1.3, 1.3 + 1.1e-4, 2.0, 3.0], abs=1e-12)
    assert two == [curves[1]]
    assert [part.breaks[-1] for part in three] == pytest.approx([1.5, 2.0 - 1.1e-4, 2.0], abs=1e-12)
