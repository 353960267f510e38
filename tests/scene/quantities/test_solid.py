"""Are weights, places and copies of solids those of the points and outlines that they are made of?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.solids import HAIRSPRING, LYING, PLATE, UPRIGHT, Solid, Weight, more_seen, total

RNG = np.random.default_rng(8)
Cloud = tuple[np.ndarray, np.ndarray]


def cloud(count: int = 4) -> Cloud:
    """Places (complex, m) and masses of points."""
    return RNG.normal(size=count) + 1j * RNG.normal(size=count), RNG.uniform(1.0, 2.0, count)


def weight(places: np.ndarray, masses: np.ndarray) -> Weight:
    centre = complex(places @ masses / masses.sum())
    inertia = float(np.abs(places - centre) ** 2 @ masses)
    return Weight(float(masses.sum()), (centre.real, centre.imag), inertia)


def same(one: Weight, other: Weight) -> bool:
    numbers = [(found.mass, *found.centre, found.inertia) for found in (one, other)]
    return numbers[0] == pytest.approx(numbers[1], rel=1e-12, abs=1e-12)


def test_weights_are_those_of_their_points() -> None:
    (p, m), (q, n) = cloud(), cloud(5)
    one, other = weight(p, m), weight(q, n)
    assert one.about((0.3, -2.0)) == pytest.approx(float(np.abs(p - (0.3 - 2.0j)) ** 2 @ m), rel=1e-12)
    assert same(one.joined(other), weight(np.append(p, q), np.append(m, n)))
    assert same(one.scaled(7.0), weight(p, m * 7.0 / m.sum()))
    assert same(
        total((solid(one), solid(other), solid(one))) or one, weight(np.concatenate((p, q, p)), np.concatenate((m, n, m)))
    )
    assert total(()) is None


@pytest.mark.parametrize("count", [1, 2, 3, 7])
def test_copies_are_spread_about_the_pivot(count: int) -> None:
    places, masses = cloud()
    pivot = 0.4 - 1.1j
    turned = [pivot + (places - pivot) * np.exp(2j * np.pi * k / count) for k in range(count)]
    got = weight(places, masses).repeated(count, (pivot.real, pivot.imag))
    assert same(got, weight(np.concatenate(turned), np.tile(masses, count)))


RING = Loop((Arc(1.0, 2.0, 0.25, 0.0, math.tau),), "RING")
HOLE = Loop((Arc(1.0, 2.0, 0.1, 0.0, -math.tau),), "HOLE", hole=True)
BAR = Loop((Line(0.0, 0.0, 3.0, 0.0), Line(3.0, 0.0, 3.0, 0.5), Line(3.0, 0.5, 0.0, 0.5), Line(0.0, 0.5, 0.0, 0.0)), "BAR")


def solid(heavy: Weight | None = None, kind: str = PLATE, **more: object) -> Solid:
    return Solid(kind, "RING", heavy or weight(*cloud()), 8e3, **more)  # type: ignore[arg-type]


def middle(loop: Loop) -> complex:
    return complex(*loop.edges[0].point(0.5))


@pytest.mark.parametrize("kind", [PLATE, LYING, HAIRSPRING, UPRIGHT])
def test_in_other_coordinates(kind: str) -> None:
    """All but the half profile of what stands on the pivot: it has coordinates of its own."""
    here = solid(kind=kind, loops=(RING, BAR), pivot=(0.5, -0.5), axis=((1.0, 2.0), (0.6, 0.8)), count=3, thickness=0.1)
    there = here.shifted((10.0, -20.0))
    assert same(
        there.weight,
        Weight(here.weight.mass, (here.weight.centre[0] + 10.0, here.weight.centre[1] - 20.0), here.weight.inertia),
    )
    assert there.pivot == (10.5, -20.5) and (there.count, there.thickness, there.kind) == (3, 0.1, kind)
    if kind == UPRIGHT:
        assert there.loops == here.loops and there.axis == here.axis
    else:
        assert there.axis == ((11.0, -18.0), (0.6, 0.8))
        moved = [middle(b) - middle(a) for a, b in zip(here.loops, there.loops, strict=True)]
        assert moved == [pytest.approx(10.0 - 20.0j)] * 2


@pytest.mark.parametrize("way", [(1.0, 0.0), (0.6, 0.8), (0.0, -1.0)])
def test_a_half_profile_stands_on_its_axis(way: tuple[float, float]) -> None:
    """A bar on an axis through (1, 2): along x and above it, with its foot at the origin. What stands stays."""
    turn, foot = math.atan2(way[1], way[0]), (1.0, 2.0)
    drawn = BAR.moved(turn, foot)
    (profile,) = solid(kind=LYING, loops=(drawn,), axis=(foot, way)).upright_profile()
    assert [edge.start for edge in profile.edges] == [pytest.approx(edge.start, abs=1e-12) for edge in BAR.edges]
    assert solid(kind=UPRIGHT, loops=(drawn,), axis=(foot, way)).upright_profile() == (drawn,)


@pytest.mark.parametrize("first", [0, 1, 2])
def test_places_of_copies(first: int) -> None:
    pivot = 0.5 - 0.5j
    found = solid(pivot=(0.5, -0.5), count=4).copies([RING, BAR], first)
    wanted = [pivot + (middle(loop) - pivot) * 1j**k for k in range(first, 4) for loop in (RING, BAR)]
    assert [middle(loop) for loop in found] == [pytest.approx(place, abs=1e-12) for place in wanted]


def test_what_pictures_show_besides_outlines() -> None:
    """Bores that nothing fills, copies but the first, both halves of what lies; each once, and nothing of what stands."""
    bored = solid(loops=(RING, HOLE), bores=("HOLE",))
    assert bored.drilled == (HOLE,) and more_seen((bored,)) == (HOLE,)
    assert more_seen((bored,), ("HOLE",)) == () and more_seen((bored, solid(loops=(BAR,)))) == (HOLE,)
    filling = Solid(PLATE, "HOLE", weight(*cloud()), 8e3, (BAR,))
    assert more_seen((bored, filling)) == ()
    twice = solid(loops=(RING, HOLE), bores=("HOLE",), count=2)
    assert [middle(loop) for loop in more_seen((twice,))] == [
        pytest.approx(one) for one in (middle(HOLE), -middle(RING), -middle(HOLE))
    ]
    assert [middle(loop) for loop in more_seen((twice, filling))] == [pytest.approx(-middle(RING))]
    lying = solid(kind=LYING, loops=(BAR,), axis=((0.0, 0.0), (1.0, 0.0)))
    assert len(more_seen((lying, lying))) == 2
    assert {round(edge.start[1], 9) for loop in more_seen((lying,)) for edge in loop.edges} == {0.0, 0.5, -0.5}
    assert more_seen((solid(kind=UPRIGHT, loops=(BAR,)), solid(kind=HAIRSPRING, loops=(BAR,)))) == ()


def test_names() -> None:
    assert solid().name == "RING" and Solid(PLATE, "", weight(*cloud()), 1.0).name == "plate"
