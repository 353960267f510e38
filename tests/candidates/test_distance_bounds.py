"""Do chords lie as near to their primitives as they say, with no more pieces than that takes?

And do bounds of the distance from an axis hold for the true curves, of which only coarse chords are looked at?
"""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest
import shapely
from pair_scenes import two_bodies

from watchsim.candidates.asymmetric_contacts import _range
from watchsim.candidates.broad_phase import _circles, _largest, _shapes
from watchsim.candidates.chords import chords
from watchsim.candidates.reachable_pairs import _across, _away, _centre, _parallel, _ring, _Span, _world
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.contact_features import features
from watchsim.model.records import ARC, CORNER, FULL, LINE, Records


def made_up(seed: int) -> Records:
    """Arcs of either sense and lines, here and there about the origin."""
    rng = np.random.default_rng(seed)
    edges = [
        Arc(*rng.uniform(-1.0, 1.0, 2), rng.uniform(0.2, 1.0), rng.uniform(-3.0, 3.0), rng.uniform(-6.0, 6.0)) for _ in range(9)
    ]
    edges += [Line(*rng.uniform(-1.0, 1.0, 4)) for _ in range(4)]
    return np.concatenate([features(Loop((edge,), closed=False), 0, 1.0) for edge in edges]).view(np.recarray)


def dense(points: np.ndarray) -> np.ndarray:
    """Of a line, which has but two points, many between them."""
    return np.linspace(points[0], points[1], 4001) if len(points) == 2 else points


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("sag", [0.2, 0.02])
def test_the_true_distances_lie_between_the_bounds(seed: int, sag: float) -> None:
    rows = made_up(seed)
    fine, coarse = chords(rows, 1e-9, 4000), chords(rows, sag)
    true = [np.hypot(*dense(points).T) for points in np.split(fine.points, fine.first[1:-1])]
    low, high = np.array([one.min() for one in true]), np.array([one.max() for one in true])
    span = _away(coarse, coarse.points, 0.0)
    bounds = _range(np.hypot(*coarse.points.T), coarse.points, coarse.first, coarse.sag)
    for lower, upper in (tuple(span), bounds):
        assert np.all(lower <= low + 1e-12) and np.all(high <= upper + 1e-12) and np.all(lower >= 0.0)
    assert np.all(span[1] - high <= 2.0 * coarse.sag + 1e-12) and np.all(low - span[0] <= 2.0 * coarse.sag + 1e-6)
    wider = _away(coarse, coarse.points, 0.05)
    assert wider[1] - span[1] == pytest.approx(0.05) and wider[0] == pytest.approx(np.maximum(0.0, span[0] - 0.05), abs=0.05)


@pytest.mark.parametrize("room", [0.0, 1e-5])
def test_what_passes_through_the_axis_comes_as_near_as_nothing(room: float) -> None:
    """Lines a metre long and a micrometre short through or past the origin, up to what they are widened by."""
    lines = [Line(-0.3, -0.4, 0.6, 0.8), Line(-3e-7, 0.0, 7e-7, 0.0), Line(-1.0, 1e-5, 1.0, 1e-5), Line(-1.0, 2e-5, 1.0, 2e-5)]
    rows = np.concatenate([features(Loop((line,), closed=False), 0, 1.0) for line in lines]).view(np.recarray)
    drawn = chords(rows, 1e-6)
    low = _away(drawn, drawn.points, room).low[rows.length > 0.0]
    assert low == pytest.approx([0.0, 0.0, 1e-5 - room, 2e-5 - room], abs=1e-16) and np.all(low >= 0.0)
    least = _range(np.hypot(*drawn.points.T), drawn.points, drawn.first, drawn.sag)[0][rows.length > 0.0]
    assert np.all(least >= 0.0) and least[:2] == pytest.approx([0.0, 0.0], abs=1e-15)


@pytest.mark.parametrize(("arm", "low", "high"), [(0.5, 0.0, 1.4), (0.02, 0.18, 0.92), (1.3, 0.4, 2.2)])
def test_what_is_carried_covers_a_ring_about_its_carrier(arm: float, low: float, high: float) -> None:
    """A line from 0.2 to 0.9 m from its pivot, which runs round; nothing is added, then 0.03 m to either side."""
    drawn = chords(features(Loop((Line(0.12, -0.16, 0.54, -0.72),), closed=False), 0, 1.0), 1e-6)
    for room in (0.0, 0.03):
        body = SimpleNamespace(carrier=0, x=0.6 * arm, y=-0.8 * arm)
        found = _ring(body, drawn, room)
        assert (found.low[0], found.high[0]) == pytest.approx((max(0.0, low - room), high + room), rel=1e-12, abs=0.0)
        alone = _ring(SimpleNamespace(carrier=-1, x=0.6, y=-0.8), drawn, room)
        assert (alone.low[0], alone.high[0]) == pytest.approx((0.2 - room, 0.9 + room), rel=1e-12)


@pytest.mark.parametrize("carrier", [-1, 0, 1])
def test_about_which_point_a_body_turns(carrier: int) -> None:
    bodies = np.rec.fromrecords([(0.3, -0.4), (1.1, 2.3)], names="x,y")
    centre = {-1: (0.7, 0.9), 0: (0.3, -0.4), 1: (1.1, 2.3)}[carrier]
    assert _centre(bodies, SimpleNamespace(carrier=carrier, x=0.7, y=0.9)) == centre


@pytest.mark.parametrize("room", [0.0, 0.07])
@pytest.mark.parametrize("sag", [0.3, 1e-3])
def test_offsets_across_the_way_of_a_slide(sag: float, room: float) -> None:
    """To the left of its axis they count positive; chords allow for what arcs may be off, and no more."""
    rows, turn = made_up(4), np.exp(-0.9j)
    fine, coarse = chords(rows, 1e-9, 4000), chords(rows, sag)
    slider = SimpleNamespace(axis_x=math.cos(0.9), axis_y=math.sin(0.9))
    true = [(dense(points) @ (1.0, 1.0j) * turn).imag for points in np.split(fine.points, fine.first[1:-1])]
    low, high = np.array([one.min() for one in true]), np.array([one.max() for one in true])
    span = _across(coarse, coarse.points, slider, room)
    for beyond in (low - room - span.low, span.high - high - room):
        assert np.all(beyond >= -1e-12) and np.all(beyond <= coarse.sag + 1e-6) and np.all(beyond[coarse.sag == 0.0] < 1e-8)
    assert coarse.sag.max() > 0.3 * sag


def test_points_of_a_body_in_the_world() -> None:
    body = SimpleNamespace(x=0.3, y=-1.7, angle=0.6)
    points = np.array([[0.4, 0.9], [-1.1, 0.2]])
    world = (points @ (1.0, 1.0j)) * np.exp(0.6j) + complex(0.3, -1.7)
    assert _world(body, points) @ (1.0, 1.0j) == pytest.approx(world, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(
    ("other", "wanted"), [((0.6, 0.8), True), ((-0.6, -0.8), True), ((0.8, 0.6), False), ((0.6, -0.8), False)]
)
def test_parallel_axes(other: tuple[float, float], wanted: bool) -> None:
    one, two = (SimpleNamespace(axis_x=x, axis_y=y) for x, y in ((0.6, 0.8), other))
    assert _parallel(one, two) is wanted


def test_spans_that_meet() -> None:
    """Also where they end where the other begins."""
    low, high = np.array([0.1, 0.3, 0.5, 0.7, 0.2]), np.array([0.3, 0.4, 0.5, 0.9, 0.9])
    span = _Span(np.full(5, 0.3), np.full(5, 0.6))
    for one, other in ((span, _Span(low, high)), (_Span(low, high), span)):
        assert one.meets(other).tolist() == [True, True, True, False, True]
    assert not _Span(low, high).meets(_Span(low - 0.9, np.minimum(low - 0.01, 0.09))).any()


ROWS = two_bodies("fixed", "free")[1].model.primitives
MOST = 30


@pytest.mark.parametrize("sag", [1.0, 1e-2, 1e-3, 1e-4, 1e-7])
def test_points_lie_on_the_primitives_and_chords_near_them(sag: float) -> None:
    """Each rise against Pythagoras: R - √(R² - (c / 2)²); one piece fewer would rise by more than was asked."""
    made = chords(ROWS, sag, MOST)
    assert made.owner.tolist() == sorted(made.owner.tolist()) and set(made.owner.tolist()) == set(range(len(ROWS)))
    for i, row in enumerate(ROWS):
        points = made.points[made.owner == i]
        if row.kind != ARC:
            ends = (
                [(row.x, row.y)] if row.kind == CORNER else [(row.x + s * row.tx, row.y + s * row.ty) for s in (0, row.length)]
            )
            assert points == pytest.approx(np.array(ends), abs=1e-15) and made.sag[i] == 0.0
            continue
        pieces, half = len(points) - 1, math.pi if row.extent == FULL else math.atan2(row.half_sin, row.half_cos)
        assert np.hypot(*(points - (row.x, row.y)).T) == pytest.approx(row.radius, rel=1e-14, abs=0.0)
        middle = math.atan2(row.side * row.ny, row.side * row.nx)
        angles = np.arctan2(*(points - (row.x, row.y)).T[::-1]) - middle
        assert np.cos(angles) == pytest.approx(np.cos(half * np.linspace(-1.0, 1.0, pieces + 1)), abs=1e-13)
        width = math.dist(*points[:2])
        rise = row.radius - math.sqrt(row.radius**2 - 0.25 * width**2) if half < pieces * math.pi / 2 else None
        assert rise is None or made.sag[i] == pytest.approx(rise, rel=1e-6, abs=1e-14)
        assert made.sag[i] <= sag * (1.0 + 1e-12) or pieces == MOST
        assert pieces == 1 or 2.0 * row.radius * math.sin(0.5 * half / (pieces - 1)) ** 2 > sag
    assert {CORNER, LINE, ARC} <= set(np.asarray(ROWS.kind).tolist())


def test_circles_hold_their_points() -> None:
    """About the middle of the least and largest coordinates, as far as the corner of their frame."""
    points = np.array([[[0.3, 0.1], [0.9, -0.7], [0.5, 0.4], [-2.0, 3.0]], [[1.3, 0.2], [1.1, 0.5], [0.6, 0.9], [4.0, -5.0]]])
    centre, radius = _circles(points, np.array([0, 3, 4]))
    assert centre == pytest.approx(np.array([[0.6 - 0.15j, -2.0 + 3.0j], [0.95 + 0.55j, 4.0 - 5.0j]]), rel=1e-14, abs=0.0)
    assert radius == pytest.approx(np.array([[math.hypot(0.3, 0.55), 0.0], [0.35 * math.sqrt(2.0), 0.0]]), rel=1e-14)


@pytest.mark.parametrize("first", [[0, 3, 4, 6], [0, 6]])
def test_the_largest_of_each_primitive(first: list[int]) -> None:
    values = np.array([[0.3, 0.9, 0.1, 0.4, 0.2, 0.7], [0.8, 0.1, 0.2, 0.6, 0.5, 0.3]])
    wanted = [[max(row[a:b]) for a, b in itertools.pairwise(first)] for row in values.tolist()]
    assert _largest(values, np.array(first)).tolist() == wanted


def test_points_and_lines_through_several() -> None:
    points = np.array([[0.3, 0.1], [0.9, -0.7], [0.5, 0.4], [-2.0, 3.0], [1.5, 2.5], [1.0, 7.0]])
    made = _shapes(points, np.array([0, 1, 4, 6]))
    assert [shapely.get_coordinates(one).tolist() for one in made] == [p.tolist() for p in np.split(points, [1, 4])]
    assert [one.geom_type for one in made] == ["Point", "LineString", "LineString"]
    assert [one.geom_type for one in _shapes(points[:2], np.array([0, 1, 2]))] == ["Point", "Point"]
