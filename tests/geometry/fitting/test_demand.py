"""How many arcs is each part of a curve said to need, first and after a trial? Against plain loops and by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.geometry.biarcs import Bundle, Curve, Demand, corrected, first_demand, of_chosen


def cubics(*corners: tuple[float, float]) -> Curve:
    """Spans of degree three (3 n + 1 corners, millimetres), with uneven breaks."""
    p = np.ones((len(corners), 3))
    p[:, :2] = 1e-3 * np.array(corners)
    control = np.stack([p[k : k + 4] for k in range(0, len(p) - 1, 3)])
    return Curve(control, np.arange(len(control) + 1.0) ** 1.5)


BOW = cubics((0, 0), (1, 3), (4, 3), (5, -1))
CORNER = cubics((0, 0), (1, 0), (2, 0.5), (3, 1), (3, 1), (3, 1), (3, 1), (3.2, 2), (2, 3), (4, 4))  # it stands in the second
LONG = cubics(*((0.3 * k, math.sin(0.9 * k)) for k in range(3 * 13 + 1)))  # of so many spans that four steps each are more
TINY = cubics((0, 0), (1e-10, 3e-10), (4e-10, 3e-10), (5e-10, -1e-10))  # shorter than what counts as a length
LINE = cubics((0, 0), (1, 0), (2, 0), (3, 0))


def by_hand(curve: Curve, tolerance: float) -> tuple[list[float], list[float]]:
    """Places and what is needed from each to the next."""
    spans = len(curve.control)
    each = max(4, math.ceil(48 / spans))
    places = [span + k / each for span in range(spans) for k in range(each)] + [float(spans)]
    bundle = Bundle([curve])
    p, way = bundle.points(np.array(places)), bundle.tangents(np.array(places))
    lengths = [math.dist(p[i], p[i + 1]) for i in range(len(places) - 1)]
    total = sum(lengths)
    steps = [max(length, 1e-12 * total + 1e-5 * tolerance) for length in lengths]
    bends = []
    for i, step in enumerate(steps):
        (ax, ay), (bx, by) = way[i], way[i + 1]
        bends.append(math.atan2(ax * by - ay * bx, ax * bx + ay * by) / step)
    needs = []
    for i, step in enumerate(steps):
        beside = [j for j in (i - 1, i + 1) if 0 <= j < len(steps)]
        rate = max(abs(bends[j] - bends[i]) / (0.5 * (steps[j] + step)) for j in beside)
        needs.append((math.sqrt(3.0) / 216.0 * rate / tolerance) ** (1.0 / 3.0) * step)
    floor = [0.05 * sum(needs) * step / max(total, 1e-5 * tolerance) for step in steps]
    return places, [max(need, least) + 1e-12 for need, least in zip(needs, floor, strict=True)]


@pytest.mark.parametrize("order", [(0, 1, 2, 3, 4), (4, 3, 2, 1, 0), (1, 4, 0, 2), (3,), (2,)])
def test_the_first_demand_follows_the_rate_of_curvature(order: tuple[int, ...]) -> None:
    curves = [(BOW, 1e-7), (CORNER, 3e-7), (LONG, 2e-6), (TINY, 1e-7), (LINE, 5e-8)]
    chosen = [curves[k] for k in order]
    demand = first_demand(Bundle([curve for curve, _ in chosen]), np.array([limit for _, limit in chosen]))
    begin, at = 0.0, 0
    for curve, limit in chosen:
        places, needs = by_hand(curve, limit)
        own = slice(at, at + len(places))
        assert demand.places[own] == pytest.approx(begin + np.array(places), abs=1e-12)
        assert np.diff(demand.load[own]) == pytest.approx(needs, rel=2e-6, abs=1e-14)
        begin, at = begin + len(curve.control) + 1.0, at + len(places)
        if at < len(demand.load):
            assert demand.load[at] - demand.load[at - 1] == pytest.approx(1.0, rel=1e-12)
    assert at == len(demand.load) and demand.load[0] == 0.0


def test_a_line_needs_next_to_nothing() -> None:
    load = first_demand(Bundle([LINE]), np.array([1e-7])).load
    assert load == pytest.approx(1e-12 * np.arange(49.0), rel=1e-9, abs=0.0)


def test_each_piece_is_corrected_half_way_to_what_it_should_do() -> None:
    """Two chains, from 0 to 2 and from 3 to 5, on demands of other places; one piece has no demand yet, one no work."""
    demand = Demand(np.array([0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 4.5, 5.0]), np.array([0.0, 1.0, 3.0, 8.0, 9.0, 13.0, 13.0, 16.0]))
    nodes = np.array([0.0, 0.75, 2.0, 3.0, 3.25, 4.0, 4.5, 5.0])
    work = np.array([5.0, 2.0, np.nan, 0.0, 7.0, 3.0, 0.5])
    new = corrected(demand, nodes, work)
    assert new.places.tolist() == [0.0, 0.5, 0.75, 1.0, 2.0, 3.0, 3.25, 4.0, 4.5, 5.0]
    # Steps of 1, 1 | 1, 5 | 1 | 1 | 3 | 0 | 3 before, each piece times the root of its work over its sum.
    a, b, c, d, e = (math.sqrt(x) for x in (5.0 / 2.0, 2.0 / 6.0, 1e-3 / 1.0, 7.0 / 3.0, 0.5 / 3.0))
    steps = [a, a, b, 5.0 * b, 1.0, c, 3.0 * d, 0.0, 3.0 * e]
    assert new.load == pytest.approx(np.append(0.0, np.cumsum(steps)), rel=1e-12)


def test_the_demand_of_some_curves_keeps_their_places_and_one_arc_between_them() -> None:
    bundle = Bundle([BOW, LINE, CORNER, BOW, LINE])  # from 0, 2, 4, 8, 10 on
    places = np.array([0.0, 0.4, 1.0, 2.0, 3.0, 4.0, 5.5, 6.0, 7.0, 8.0, 8.3, 9.0, 10.0, 11.0])
    steps = np.array([0.3, 0.7, 1.0, 2.5, 1.0, 4.0, 5.0, 6.0, 1.0, 7.0, 0.6, 1.0, 9.0])
    demand = Demand(places, np.append(0.0, np.cumsum(steps)))
    some = of_chosen(demand, bundle, np.array([0, 2, 3]))
    assert some.places.tolist() == [0.0, 0.4, 1.0, 4.0, 5.5, 6.0, 7.0, 8.0, 8.3, 9.0]
    assert np.diff(some.load) == pytest.approx([0.3, 0.7, 1.0, 4.0, 5.0, 6.0, 1.0, 7.0, 0.6]) and some.load[0] == 0.0
    last = of_chosen(demand, bundle, np.array([1, 4]))
    assert last.places.tolist() == [2.0, 3.0, 10.0, 11.0] and last.load == pytest.approx([0.0, 2.5, 3.5, 12.5])
