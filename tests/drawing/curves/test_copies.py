"""Are copies of a spline followed as closely as the first one, and nothing else taken for a copy?"""

from __future__ import annotations

import math
from collections.abc import Callable

import dxf_text as d
import numpy as np
import pytest
from shapely import LineString, distance
from shapely import points as shapely_points

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.projection import Affine, Spline
from watchsim.drawing.splines import Follower, motion_between
from watchsim.geometry.loops import Loop, polyline

Reader = Callable[..., Drawing]
CONTROL = np.array([0.3 + 0.1j, 1.0 + 2.0j, 2.5 - 1.5j, 4.0 + 0.7j])  # mm
KNOTS = [0.0] * 4 + [1.0] * 4
MOTIONS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "shifted": lambda z: z + (7 - 3j),
    "turned": lambda z: np.exp(0.7j) * z + (1 + 9j),
    "turned by half": lambda z: -z,
    "mirrored": lambda z: z.conjugate(),
    "mirrored and turned": lambda z: np.exp(2.1j) * z.conjugate() - 5,
}


def spline(control: np.ndarray) -> Spline:
    return Spline(3, KNOTS, [(z.real, z.imag, 0.0) for z in control])


def furthest(control: np.ndarray, loop: Loop) -> float:
    """The largest distance (m) of a cubic, by its Bernstein polynomials, from a chain."""
    t = np.linspace(0.0, 1.0, 2001)
    z = 1e-3 * sum(math.comb(3, k) * t**k * (1 - t) ** (3 - k) * control[k] for k in range(4))
    return float(np.max(distance(LineString(polyline(loop, 1e-10)), shapely_points(z.real, z.imag))))


@pytest.mark.parametrize("name", MOTIONS)
def test_a_copy_has_the_arcs_of_the_first_and_lies_on_its_own_curve(name: str) -> None:
    image = MOTIONS[name](CONTROL)
    follower = Follower(1e-3)
    (one, _), (other, fitted) = follower.edges([spline(CONTROL), spline(image)], [1e-7, 1e-7])
    assert len(follower.places) == 1 and fitted
    assert [edge.radius for edge in one.edges] == [edge.radius for edge in other.edges]
    assert furthest(image, Loop(other.edges, closed=False)) <= other.deviation * 1.001 <= 1.002e-7
    assert math.dist(other.edges[0].start, (1e-3 * image[0].real, 1e-3 * image[0].imag)) < 1e-15
    assert math.dist(other.edges[-1].end, (1e-3 * image[-1].real, 1e-3 * image[-1].imag)) < 1e-15


def test_copies_in_the_decimals_of_a_drawing_are_copies_and_what_they_miss_by_is_told() -> None:
    image = np.round(MOTIONS["turned"](CONTROL), 8)
    follower = Follower(1e-3)
    (one, _), (other, _) = follower.edges([spline(CONTROL), spline(image)], [1e-7, 1e-7])
    assert len(follower.places) == 1
    assert one.deviation < other.deviation < one.deviation + 1e-11


@pytest.mark.parametrize("change", [1e-6j, 1.001, 0.5])
def test_other_curves_are_followed_by_themselves(change: complex) -> None:
    image = CONTROL.copy()
    image[2] = image[2] + change if isinstance(change, complex) else image[2] * change
    follower = Follower(1e-3)
    _, (other, _) = follower.edges([spline(CONTROL), spline(image)], [1e-7, 1e-7])
    assert len(follower.places) == 2
    assert furthest(image, Loop(other.edges, closed=False)) <= 1.002e-7


def test_another_tolerance_or_size_is_no_copy() -> None:
    follower = Follower(1e-3)
    results = follower.edges([spline(CONTROL), spline(CONTROL + 1), spline(2.0 * CONTROL)], [1e-7, 1e-8, 1e-7])
    assert len(follower.places) == 3
    few, many, larger = (len(fit.edges) for fit, _ in results)
    assert many > 1.6 * few and larger > few


def test_blocks_turned_and_mirrored_lie_where_they_are_inserted(read_bytes: Reader) -> None:
    tags: list[d.Tag] = [(70, 8), (71, 3), (72, 8), (73, 4), *((40, knot) for knot in KNOTS)]
    body = d.record("SPLINE", *tags, *(tag for z in CONTROL for tag in d.point(10, (z.real, z.imag))))
    inserts = d.insert("B", (0, 0)) + d.insert("B", (10, 0), (50, 30.0)) + d.insert("B", (0, 10), (41, -1.0))
    drawing = read_bytes(d.dxf(inserts + d.insert("B", (10, 10), (42, 2.0)), blocks=d.block("B", body)))
    images = [
        CONTROL,
        10 + np.exp(1j * math.pi / 6) * CONTROL,
        10j - CONTROL.conjugate(),
        10 + 10j + CONTROL.real + 2j * CONTROL.imag,
    ]
    assert len(drawing.open_chains) == len(images)
    for image, loop in zip(images, drawing.open_chains, strict=True):
        assert furthest(image, loop) <= 1.002e-7
    assert drawing.fitted_curves == 4 and drawing.fitted_deviation <= 1e-7 * (1 + 1e-6)


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("turn", [1.0, 1j, -1.0])
def test_the_motion_between_points_is_found(name: str, turn: complex) -> None:
    """Whichever of them lies furthest out."""
    z = turn * CONTROL
    motion, away = motion_between(z, MOTIONS[name](z), "mirrored" in name)
    assert away < 1e-14 * 10.0 and abs(motion.turn) == pytest.approx(1.0)
    assert motion_between(z, 1.01 * MOTIONS[name](z), "mirrored" in name)[1] > 5e-3


def test_a_map_that_is_not_told_leaves_everything_where_it_is() -> None:
    assert Affine().direction((1.0, 2.0, 3.0)) == (1.0, 2.0, 3.0)
    assert Affine().origin == (0.0, 0.0, 0.0)
