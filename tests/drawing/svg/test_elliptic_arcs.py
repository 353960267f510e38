"""Does an arc of a path start, end and run as SVG 1.1 says (F.6), for every pair of flags and all radii?"""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest

from watchsim.drawing.projection import Conic, Straight
from watchsim.drawing.svg_elements import SvgError
from watchsim.drawing.svg_shapes import elliptic_arc

Point = tuple[float, float]
FLAGS = list(product((False, True), repeat=2))
P, Q = (0.3, -0.7), (2.5, 1.1)
CHORD = math.dist(P, Q)


def at(conic: Conic, share: float) -> np.ndarray:
    t = conic.start + share * conic.sweep
    return np.array(conic.centre[:2]) + math.cos(t) * np.array(conic.u[:2]) + math.sin(t) * np.array(conic.v[:2])


def arc(p: Point, q: Point, rx: float, ry: float, turn: float, large: bool, positive: bool) -> Conic:
    found = elliptic_arc(p, q, rx, ry, turn, large, positive)
    assert isinstance(found, Conic)
    return found


@pytest.mark.parametrize(("large", "positive"), FLAGS)
@pytest.mark.parametrize(("rx", "ry"), [(3.0, 3.0), (4.0, 2.0), (1.6, 5.0), (2.0, 1.9), (70.0, 30.0)])
@pytest.mark.parametrize("turn", [0.0, 0.4, -1.3, 2.9])
def test_it_runs_from_end_to_end_on_an_ellipse_of_those_radii(
    large: bool, positive: bool, rx: float, ry: float, turn: float
) -> None:
    for p, q in ((P, Q), (Q, P), ((0.0, 0.0), (0.0, 2.0)), ((5.0, 1.0), (3.0, 1.0))):
        found = arc(p, q, rx, ry, turn, large, positive)
        assert at(found, 0.0) == pytest.approx(np.array(p), abs=1e-12) and at(found, 1.0) == pytest.approx(
            np.array(q), abs=1e-12
        )
        assert (math.hypot(*found.u), math.hypot(*found.v)) == pytest.approx((rx, ry), rel=1e-14, abs=0.0)
        axis = turn if rx != ry else 0.0
        assert abs(found.u[0] * math.sin(axis) - found.u[1] * math.cos(axis)) < 1e-13 * rx
        assert abs(found.u[0] * found.v[0] + found.u[1] * found.v[1]) < 1e-12 * rx * ry
        assert found.sweep > 0.0 and (found.sweep > math.pi) is large
        assert (found.u[0] * found.v[1] - found.u[1] * found.v[0] > 0.0) is positive
        assert found.centre[2] == found.u[2] == found.v[2] == 0.0


@pytest.mark.parametrize(("large", "positive"), FLAGS)
@pytest.mark.parametrize("small", [1e-3, 1e-8, 1e-11, 1e-200])
def test_radii_that_are_too_small_grow_in_proportion_until_the_ends_are_opposite(
    large: bool, positive: bool, small: float
) -> None:
    for ratio, turn in ((1.0, 0.0), (2.0, 0.6), (0.3, -1.0)):
        found = arc(P, Q, small, small * ratio, turn, large, positive)
        assert math.hypot(*found.v) / math.hypot(*found.u) == pytest.approx(ratio, rel=1e-9)
        assert found.centre[:2] == pytest.approx(((P[0] + Q[0]) / 2, (P[1] + Q[1]) / 2), rel=1e-12)
        assert found.sweep == pytest.approx(math.pi, abs=1e-12)
        assert at(found, 0.0) == pytest.approx(np.array(P), abs=1e-11) and at(found, 1.0) == pytest.approx(
            np.array(Q), abs=1e-11
        )
        along = np.subtract(Q, P)
        side = at(found, 0.5) - np.array(found.centre[:2])
        # y points down: positive turns clockwise on the screen
        assert bool(along[0] * side[1] - along[1] * side[0] < 0.0) is positive


def test_arcs_without_a_radius_or_a_length_are_lines() -> None:
    for rx, ry in ((0.0, 3.0), (3.0, 0.0), (0.0, 0.0)):
        assert elliptic_arc(P, Q, rx, ry, 0.3, True, True) == Straight((*P, 0.0), (*Q, 0.0))
    assert isinstance(elliptic_arc(P, Q, 5e-4, 5e-4, 0.3, True, True), Conic)
    tiny = (0.0, 1e-320)
    assert elliptic_arc((0.0, 0.0), tiny, 1e10, 1e10, 0.0, False, True) == Straight((0.0, 0.0, 0.0), (*tiny, 0.0))


@pytest.mark.parametrize(("narrow", "drawn"), [(0.9e-9, False), (1.1e-9, True)])
def test_radii_of_too_unlike_size_are_refused(narrow: float, drawn: bool) -> None:
    for rx, ry in ((5.0, 5.0 * narrow), (5.0 * narrow, 5.0)):
        if drawn:
            arc((0.0, 0.0), (rx, ry), rx, ry, 0.0, False, True)
        else:
            with pytest.raises(SvgError, match="radii as different as"):
                elliptic_arc((0.0, 0.0), (1.0, 1.0), rx, ry, 0.0, False, True)


@pytest.mark.parametrize("far", [0.0, 1.0, 1e3, 1e6, -1e6])
def test_a_semicircle_keeps_its_centre_on_the_chord_wherever_it_lies(far: float) -> None:
    """Half a chord, rounded, is a little too long or too short for a radius; by its root the centre would be off."""
    for k in range(20):
        p, q = (far + 0.1 * k, 0.3), (far + 2.0 - 0.05 * k, 0.7 + 0.1 * k)
        half = 0.5 * math.dist(p, q)
        noise = math.ulp(1.0) * (1.0 + max(map(abs, (*p, *q))) / half)
        for radius in (half, math.nextafter(half, 9.0), half * (1.0 + 0.5 * noise)):
            found = arc(p, q, radius, radius, 0.0, False, True)
            middle = (0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]))
            assert math.dist(found.centre[:2], middle) <= 2.0 * math.ulp(abs(far) + 4.0)
        wider = half * (1.0 + 20.0 * noise)
        off = math.sqrt((wider - half) * (wider + half))
        found = arc(p, q, wider, wider, 0.0, False, True)
        assert math.dist(found.centre[:2], middle) == pytest.approx(off, rel=0.2)
