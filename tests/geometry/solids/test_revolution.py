"""Are solids of revolution those of the textbooks, and what trimesh makes of the same profile?"""

from __future__ import annotations

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line, Point
from watchsim.geometry.solids import Turned, reach, turned, upright

X_AXIS = ((0.0, 0.0), (1.0, 0.0))
TINY = 1e-12


def polygon(*corners: Point) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)))


def numbers(found: Turned) -> tuple[float, float, float, float]:
    return found.volume, found.centre, found.axial, found.transverse


def test_cylinder_away_from_the_foot_of_the_axis() -> None:
    r, length, start = 0.25e-3, 0.4e-3, 4.8e-3
    box = polygon((start, 0.0), (start + length, 0.0), (start + length, r), (start, r))
    volume = math.pi * r * r * length
    expected = (volume, start + length / 2, volume * r * r / 2, volume * (3 * r * r + length * length) / 12)
    assert numbers(turned([box], *X_AXIS)) == pytest.approx(expected, rel=TINY, abs=0.0)


def test_cone() -> None:
    r, h = 0.6e-3, 2e-3
    volume = math.pi * r * r * h / 3
    expected = (volume, h / 4, 0.3 * volume * r * r, volume * 3 / 80 * (4 * r * r + h * h))
    assert numbers(turned([polygon((0.0, 0.0), (h, 0.0), (0.0, r))], *X_AXIS)) == pytest.approx(expected, rel=TINY, abs=0.0)


def test_ball_of_a_half_circle() -> None:
    r, x = 1.5e-3, 0.7e-3
    half = Loop((Line(x - r, 0.0, x + r, 0.0), Arc(x, 0.0, r, 0.0, math.pi)))
    volume = 4.0 / 3.0 * math.pi * r**3
    expected = (volume, x, 0.4 * volume * r * r, 0.4 * volume * r * r)
    assert numbers(turned([half], *X_AXIS)) == pytest.approx(expected, rel=TINY, abs=0.0)


def test_torus() -> None:
    a, b = 5e-3, 1e-3
    volume = 2 * math.pi**2 * a * b * b
    expected = (volume, 3e-3, volume * (a * a + 0.75 * b * b), volume * (a * a / 2 + 5 / 8 * b * b))
    ring = Loop((Arc(3e-3, a, b, 0.3, TURN),))
    assert numbers(turned([ring], *X_AXIS)) == pytest.approx(expected, rel=TINY, abs=0.0)


def test_open_lines_are_no_part_of_the_profile() -> None:
    """Not even where they cross the axis."""
    box = Loop(tuple(Line(*a, *b) for a, b in pairwise([(1.0, 0.0), (2.0, 0.0), (2.0, 3.0), (1.0, 3.0), (1.0, 0.0)])))
    stray = Loop((Line(0.0, -9.0, 0.0, 9.0),), closed=False)
    assert upright([stray, box], (0.0, 0.0), (1.0, 0.0)) == upright([box], (0.0, 0.0), (1.0, 0.0))
    assert reach([stray, box], (0.0, 0.0), (1.0, 0.0)) == 3.0


def test_a_bore_is_taken_out() -> None:
    """A tube: the half profile and a rectangular hole of it that reaches the axis are as good as the wall alone."""
    outer = polygon((0.0, 0.0), (3e-3, 0.0), (3e-3, 2e-3), (0.0, 2e-3))
    groove = polygon((1e-3, 0.5e-3), (1e-3, 1e-3), (2e-3, 1e-3), (2e-3, 0.5e-3))
    found = turned([outer, groove], *X_AXIS)
    full, gone = math.pi * 4e-6 * 3e-3, math.pi * (1e-6 - 0.25e-6) * 1e-3
    assert found.volume == pytest.approx(full - gone, rel=TINY, abs=0.0)
    assert found.axial == pytest.approx(full * 4e-6 / 2 - gone * (1e-6 + 0.25e-6) / 2, rel=TINY, abs=0.0)


@pytest.mark.parametrize("sweep", [1e-4, 0.02, 1.3, -0.02, -1.3, 3.0])
def test_a_bulging_side_against_quadrature_of_high_precision(sweep: float) -> None:
    """A drum with a side bent outward or inward, against ∫ π y² dx and its like of the formula of the side."""
    half, y0 = 1e-3, 3e-3
    h = 0.5 * abs(sweep)
    radius = half / math.sin(h)
    side = math.copysign(1.0, sweep)
    centre = y0 - side * radius * math.cos(h)
    arc = Arc(0.0, centre, radius, side * (math.pi / 2 - h), side * 2 * h)
    loop = Loop((Line(-half, 0.0, half, 0.0), Line(half, 0.0, *arc.start), arc, Line(*arc.end, -half, 0.0)))
    with mpmath.workdps(40):
        b, r, c = mpmath.mpf(half), mpmath.mpf(half) / mpmath.sin(mpmath.mpf(h)), 0
        c = mpmath.mpf(y0) - side * r * mpmath.cos(mpmath.mpf(h))

        def y(x: mpmath.mpf) -> mpmath.mpf:
            return c + side * mpmath.sqrt(r * r - x * x)

        ends = mpmath.linspace(-b, b, 9)
        volume = mpmath.quad(lambda x: mpmath.pi * y(x) ** 2, ends)
        axial = mpmath.quad(lambda x: mpmath.pi / 2 * y(x) ** 4, ends)
        along = mpmath.quad(lambda x: mpmath.pi * y(x) ** 2 * x * x, ends)
        expected = [float(value) for value in (volume, axial, axial / 2 + along)]
    found = turned([loop], *X_AXIS)
    assert [found.volume, found.axial, found.transverse] == pytest.approx(expected, rel=1e-11, abs=0.0)
    assert abs(found.centre) < 1e-15 * (1.0 + radius)


STAFF = (
    *((-2.0, 0.0), (2.1, 0.0), (2.1, 0.06), (1.9, 0.06), (1.5, 0.3), (0.8, 0.3), (0.8, 0.7)),
    *((0.1, 0.7), (0.1, 0.5), (-1.4, 0.35), (-1.6, 0.05), (-2.0, 0.05)),
)


def test_trimesh_solid_converges_to_it_with_the_square_of_the_step() -> None:
    profile = polygon(*((1e-3 * x, 1e-3 * y) for x, y in STAFF))
    exact = turned([profile], *X_AXIS)
    errors = []
    for sections in (64, 128, 256):
        solid = trimesh.creation.revolve(np.array([(y, x) for x, y in (*STAFF[::-1], STAFF[-1])]), sections=sections)
        found = np.array([solid.volume, solid.moment_inertia[2, 2], solid.moment_inertia[0, 0]])
        whole = np.array([exact.volume * 1e9, exact.axial * 1e15, exact.transverse * 1e15])
        errors.append(found / whole - 1.0)
        assert solid.is_watertight
        assert solid.center_mass[2] == pytest.approx(exact.centre * 1e3, rel=1e-9, abs=0.0)
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx(2.0, abs=0.01)


@given(st.floats(-3.0, 3.0), st.floats(-0.05, 0.05), st.floats(-0.05, 0.05), st.booleans())
def test_the_solid_does_not_depend_on_where_it_is_drawn(angle: float, dx: float, dy: float, below: bool) -> None:
    drum = Loop((Line(-1e-3, 1e-3, 1e-3, 1e-3), Arc(0.0, 1e-3, 1e-3, 0.0, math.pi)))
    drum = drum.reflected((0.0, 0.0), (1.0, 0.0)) if below else drum
    there = turned([drum.moved(angle, (dx, dy))], (dx, dy), (math.cos(angle), math.sin(angle)))
    here = turned([drum], *X_AXIS)
    assert [there.volume, there.axial, there.transverse] == pytest.approx(
        [here.volume, here.axial, here.transverse], rel=1e-10, abs=0.0
    )
    assert abs(there.centre) < 1e-14


def test_what_cannot_be_turned_is_refused() -> None:
    with pytest.raises(ValueError, match="both sides of its axis"):
        turned([polygon((0.0, -1e-3), (1e-3, -1e-3), (0.0, 1e-3))], *X_AXIS)
    with pytest.raises(ValueError, match="encloses no area"):
        turned([polygon((0.0, 0.0), (1e-3, 0.0), (0.0, 1e-3)).reversed()], *X_AXIS)
    with pytest.raises(ValueError, match="encloses no area"):
        turned([], *X_AXIS)
