"""Do masses hold for what is flat, short, far away or just across its axis?"""

from __future__ import annotations

import math

import pytest

from watchsim.geometry.hairspring import CHORDS, SHARE, Spiral, drawn_strip, ribbon, spiral_of_length
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.geometry.solids import Section, area, mass_properties, reach, section, turned, upright


def polygon(*corners: tuple[float, float], closed: bool = True) -> Loop:
    ends = corners[1:] + corners[:1]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, ends, strict=True)), closed=closed)


def test_what_encloses_nothing_has_no_moments() -> None:
    triangle = (0.0, 0.0), (3.0, 0.0), (3.0, 4.0)
    nothing = section([polygon(*triangle, closed=False), Loop(())])
    assert nothing == Section((0.0, 0.0), 0.0, 0.0, 0.0, 0.0)
    whole = section([polygon(*triangle, closed=False), polygon(*triangle), Loop(())])
    assert whole.area == pytest.approx(6.0) and whole.centroid == pytest.approx((2.0, 4.0 / 3.0))
    with pytest.raises(ValueError, match="no area"):
        mass_properties([Loop(())], 1e-3, 7800.0)


@pytest.mark.parametrize("turns", [8.0, 8.3, 0.4])
def test_the_picture_of_a_spiral_has_48_chords_a_turn_on_either_side(turns: float) -> None:
    spiral, width = Spiral(1e-3, 3e-3, turns), 5e-5
    edges, steps = spiral.outline(width).edges, math.ceil(48 * turns)
    assert CHORDS == 48 and len(edges) == 2 * (steps + 1)
    for k in (0, 1, steps - 1, steps):
        angle, r = math.tau * turns * k / steps, 1e-3 + 2e-3 * k / steps
        outside, inside = edges[k].start, edges[2 * steps + 1 - k].start
        for point, radius in ((outside, r + 0.5 * width), (inside, r - 0.5 * width)):
            assert point == pytest.approx((radius * math.cos(angle), radius * math.sin(angle)), rel=1e-9, abs=1e-15)


def test_a_spring_counts_as_poised_about_its_axis() -> None:
    strip = Spiral(1e-3, 3e-3, 5.0).strip(1e-4)
    assert strip.origin == (0.0, 0.0) and strip.centroid == (0.0, 0.0)


def test_a_spring_held_at_one_end_counts_by_the_square_of_how_far_it_follows() -> None:
    n = 1000
    assert sum(((k + 0.5) / n) ** 2 for k in range(n)) / n == pytest.approx(SHARE, rel=1e-6)


@pytest.mark.parametrize("length", [1.0000001e-3, 1.01e-3, 5e-3, 0.2])
def test_a_spiral_is_found_for_short_and_long_strips(length: float) -> None:
    assert spiral_of_length(1e-3, 2e-3, length).length == pytest.approx(length, rel=1e-10, abs=0.0)


@pytest.mark.parametrize("sweep", [5e-4, -5e-4, 1.3, -1.3])
def test_a_strip_along_an_arc_is_a_part_of_a_ring_however_short(sweep: float) -> None:
    arc, width = Arc(1e-3, -2e-3, 3e-3, 0.4, sweep), 2e-4
    loop = ribbon(arc, width)
    assert area(loop) == pytest.approx(width * 3e-3 * abs(sweep), rel=1e-9, abs=0.0)
    polar = abs(sweep) / 4.0 * ((3e-3 + 1e-4) ** 4 - (3e-3 - 1e-4) ** 4)
    assert drawn_strip(Loop((arc,), closed=False), width).about((1e-3, -2e-3)).polar == pytest.approx(polar, rel=1e-9, abs=0.0)


@pytest.mark.parametrize(("width", "refused"), [(5.99e-3, False), (6.01e-3, True)])
def test_a_strip_is_at_most_twice_as_wide_as_its_radius(width: float, refused: bool) -> None:
    if refused:
        with pytest.raises(ValueError, match=r"6\.01 mm wide cannot follow an arc of radius 3 mm"):
            ribbon(Arc(0.0, 0.0, 3e-3, 0.0, 1.0), width)
    else:
        assert area(ribbon(Arc(0.0, 0.0, 3e-3, 0.0, 1.0), width)) > 0.0


def test_a_turned_part_far_along_its_axis_is_the_same_as_near() -> None:
    """Of lengths that binary numbers hold exactly, 17 m away; a cone frustum by Gauss's rule in place of closed forms."""
    u = 1.0 / 1024.0
    near, far = (polygon((x, 0.0), (x + 3 * u, 0.0), (x + 3 * u, 2 * u), (x, 5 * u)) for x in (0.0, 17.0))
    one, other = (turned([loop], (0.0, 0.0), (1.0, 0.0)) for loop in (near, far))
    assert (other.volume, other.axial, other.transverse) == pytest.approx(
        (one.volume, one.axial, one.transverse), rel=2e-12, abs=0.0
    )
    assert other.centre - 17.0 == pytest.approx(one.centre, rel=1e-9)
    n, h = 4000, 3 * u / 4000
    slices = [(5 * u - 3 * u * (k + 0.5) / n, (k + 0.5) * h) for k in range(n)]
    volume = sum(math.pi * r * r * h for r, _ in slices)
    centre = sum(math.pi * r * r * h * x for r, x in slices) / volume
    axial = sum(0.5 * math.pi * r**4 * h for r, _ in slices)
    transverse = sum(math.pi * r * r * h * (0.25 * r * r + (x - centre) ** 2) for r, x in slices)
    assert (one.volume, one.centre, one.axial, one.transverse) == pytest.approx(
        (volume, centre, axial, transverse), rel=1e-6, abs=0.0
    )


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("across", [0.9e-6, 1.1e-6])
def test_a_profile_may_cross_its_axis_by_a_millionth(side: float, across: float) -> None:
    """Along a slanted axis through a foot; on whichever side it lies it is put above."""
    foot, (c, s) = (3e-3, -1e-3), (0.6, 0.8)
    corners = [(1e-3, -across * 2e-3), (4e-3, -across * 2e-3), (4e-3, 2e-3), (1e-3, 1e-3)]
    placed = [(foot[0] + c * x - s * side * y, foot[1] + s * x + c * side * y) for x, y in corners]
    if across > 1e-6:
        with pytest.raises(ValueError, match="both sides of its axis"):
            upright([polygon(*placed)], foot, (c, s))
        return
    (loop,) = upright([polygon(*placed)], foot, (c, s))
    found = sorted(edge.start for edge in loop.edges)
    for point, expected in zip(found, sorted(corners), strict=True):
        assert point == pytest.approx(expected, abs=1e-12)
    assert reach([polygon(*placed)], foot, (c, s)) == pytest.approx(2e-3, rel=1e-9)
