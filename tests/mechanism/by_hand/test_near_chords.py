"""Which chords of two outlines come close to each other, and what lies within them? Against all pairs and dense points."""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.overlap import CLOSE, DEVIATION, _Layer, _meet, _meeting, _near
from watchsim.mechanism.overlap_depth import COARSE
from watchsim.scene.force import Side

POSE = (1e-3, -2e-3, 0.7)


def layer(name: str, *loops: Loop, pose: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> _Layer:
    return _Layer(Side(name, "L"), loops, pose)


def disc(x: float, y: float, radius: float, hole: bool = False) -> Loop:
    return Loop((Arc(x, y, radius, 0.3, -math.tau if hole else math.tau),), hole=hole)


def zigzag(rng: np.random.Generator, count: int) -> Loop:
    places = rng.uniform(-3e-3, 3e-3, (count, 2))
    return Loop(tuple(Line(*a, *b) for a, b in zip(places[:-1].tolist(), places[1:].tolist(), strict=True)), closed=False)


def apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """How far each of the boxes a is from meeting each of b, in the direction in which they are farther."""
    between = np.maximum(a[:, None, :2] - b[None, :, 2:], b[None, :, :2] - a[:, None, 2:])
    return np.asarray(between.max(axis=2))


@pytest.mark.parametrize("seed", range(6))
def test_near_is_what_is_near_to_any(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a = layer("a", zigzag(rng, 9), disc(2e-3, 1e-3, 0.5e-3), pose=POSE)
    b = layer("b", zigzag(rng, 7), disc(-1e-3, 2e-3, 0.8e-3))
    gaps = apart(a.boxes, b.boxes)
    assert np.all(abs(gaps - CLOSE) > 1e-12)
    near = _near(a, b)
    assert near[0].tolist() == (gaps <= CLOSE).any(axis=1).tolist() and near[1].tolist() == (gaps <= CLOSE).any(axis=0).tolist()
    assert near[0].any() and not near[0].all()


@pytest.mark.parametrize(("gap", "close"), [(0.9 * CLOSE, True), (1.1 * CLOSE, False)])
def test_near_is_a_micrometre(gap: float, close: bool) -> None:
    """Between the boxes of chords, which are wider than these by what an arc may bulge."""
    one = layer("a", Loop((Line(0.0, 0.0, 1e-3, 0.0),), closed=False))
    for x, y in ((0.0, 2.0 * COARSE + gap), (1e-3 + 2.0 * COARSE + gap, 0.0), (-1e-3 - 2.0 * COARSE - gap, 0.0)):
        other = layer("b", Loop((Line(x, y, x + 1e-3, y),), closed=False))
        assert [marks.tolist() for marks in (*_near(one, other), *_near(other, one))] == [[close]] * 4


def test_boxes_hold_the_arcs_of_their_chords() -> None:
    arc = Arc(1e-3, 2e-3, 3e-3, 0.4, 2.5)
    made = layer("a", Loop((arc,), closed=False), pose=POSE)
    (moved,) = Loop((arc,), closed=False).moved(POSE[2], POSE[:2]).edges
    for k, low_high in enumerate(made.boxes):
        points = np.array([moved.point((k + share) / len(made.boxes)) for share in np.linspace(0.0, 1.0, 9)])
        assert np.all(points >= low_high[:2]) and np.all(points <= low_high[2:])
        assert np.all(low_high[2:] - low_high[:2] <= np.ptp(points, axis=0) + 2.1 * COARSE)
    assert made.box[:2] == pytest.approx(made.boxes[:, :2].min(axis=0)) and made.box[2:] == pytest.approx(
        made.boxes[:, 2:].max(axis=0)
    )


@pytest.mark.parametrize(
    ("box", "meets"),
    [
        ((1.0, 1.0, 2.0, 3.0), True),
        ((3.0, 4.0, 5.0, 6.0), True),
        ((3.1, 0.0, 5.0, 6.0), False),
        ((0.0, 4.1, 5.0, 6.0), False),
        ((-5.0, -5.0, 0.0, 0.5), True),
        ((-5.0, -5.0, -0.1, 9.0), False),
        ((-5.0, -5.0, 9.0, 0.4), False),
        ((-9.0, -9.0, 9.0, 9.0), True),
    ],
)
def test_boxes_meet_where_they_share_a_point(box: tuple[float, ...], meets: bool) -> None:
    assert _meet(np.array([(0.0, 0.5, 3.0, 4.0)]), np.array([box])).tolist() == [meets]
    assert _meet(np.array([box, box]), np.array([(0.0, 0.5, 3.0, 4.0)])).tolist() == [meets, meets]


def test_only_what_is_near_is_split_finely() -> None:
    made = layer(
        "a",
        disc(0.0, 0.0, 3e-3),
        disc(0.5e-3, 0.0, 1e-3, hole=True),
        Loop((Line(4e-3, 0.0, 4e-3, 1e-3),), closed=False),
        pose=POSE,
    )
    none, some = np.zeros(len(made.boxes), bool), np.zeros(len(made.boxes), bool)
    some[3] = True
    region, faces, worst = made.finely(none)
    assert worst == 0.0 and region.area == pytest.approx(8e-6 * math.pi, rel=1e-3) and len(faces) == 1
    assert (region.centroid.x, region.centroid.y) == pytest.approx(
        (1e-3 - 0.0625e-3 * math.cos(0.7), -2e-3 - 0.0625e-3 * math.sin(0.7)), rel=1e-3
    )
    points, edges = faces[0]
    assert points.tolist() == [pytest.approx(edges[0].start), pytest.approx(edges[0].end)]
    finer, _, error = made.finely(some)
    assert 0.2 * DEVIATION < error <= DEVIATION and len(finer.exterior.coords) > len(region.exterior.coords) + 5
    assert len(finer.interiors[0].coords) == len(region.interiors[0].coords)


def test_of_nothing_nothing_meets() -> None:
    some = layer("a", disc(0.0, 0.0, 3e-3))
    for first, second in ((layer("b"), some), (some, layer("b")), (layer("b"), layer("c"))):
        assert _meeting(0, first, second) is None
    met = _meeting(4, some, layer("b", disc(5e-3, 0.0, 2.1e-3)))
    assert met is not None and met.contact == 4 and met.depth == pytest.approx(0.1e-3, rel=0.05)
    assert _meeting(0, some, layer("b", disc(5e-3, 0.0, 1.9e-3))) is None


def test_faces_count_on_either_side_and_against_each_other() -> None:
    """A disc behind a face, whichever comes first; two faces that cross, by what reaches behind."""
    face = Loop((Line(0.0, -5e-3, 0.0, 5e-3),), closed=False)  # material on the left, where x is negative
    ball = disc(1e-3, 0.0, 1.25e-3)
    for first, second in (((face,), (ball,)), ((ball,), (face,))):
        met = _meeting(0, layer("a", *first), layer("b", *second))
        assert met is not None and met.depth == pytest.approx(0.25e-3, rel=1e-3)
    other = Loop((Line(1e-3, 0.0, -0.5e-3, 0.0),), closed=False)
    met = _meeting(0, layer("a", face), layer("b", other))
    assert met is not None and met.depth == pytest.approx(5e-3, rel=1e-6)
    short = _meeting(0, layer("a", Loop((Line(0.0, -0.2e-3, 0.0, 0.1e-3),), closed=False)), layer("b", other))
    assert short is not None and short.depth == pytest.approx(0.5e-3, rel=1e-6)
