"""Which layers of which bodies become slabs, how thick, and at which height? Made-up bodies."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from watchsim.geometry.hairspring import Spiral
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.forces import Contact, Side
from watchsim.scene.layer_heights import Slab, slabs
from watchsim.scene.scene import Body, Scene
from watchsim.scene.solids import HAIRSPRING, LYING, PLATE, UPRIGHT, Solid, Weight

THICK = 0.3e-3
WEIGHT = Weight(1e-6, (0.0, 0.0), 1e-12)


def ring(layer: str, radius: float, x: float = 0.0, hole: bool = False) -> Loop:
    return Loop((Arc(x, 0.0, radius, 0.0, -math.tau if hole else math.tau),), layer, hole=hole)


def box(layer: str, x: float, y: float, width: float, height: float) -> Loop:
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), layer)


def solid(kind: str, layer: str, *loops: Loop, thick: float = 0.5e-3, **more: object) -> Solid:
    return replace(Solid(kind, layer, WEIGHT, 8e3, loops, thick), **more)  # type: ignore[arg-type]


def found(*bodies: Body, contacts: tuple[Contact, ...] = ()) -> list[Slab]:
    return list(slabs(Scene("t", bodies, contacts=contacts), THICK))


def names(made: list[Slab]) -> list[tuple[str, float]]:
    return [(slab.layer, round(1e3 * slab.thickness, 6)) for slab in made]


@pytest.mark.parametrize(
    ("solids", "expected"),
    [
        ((), [("A", 0.3), ("B", 0.3), ("D", 0.3)]),
        ((solid(PLATE, "B", ring("B", 1e-3)),), [("B", 0.5), ("A", 0.3), ("D", 0.3)]),
        ((solid(PLATE, "", ring("A", 1e-3), ring("B", 1e-3)),), [("plate", 0.5), ("D", 0.3)]),
        ((solid(PLATE, "D", ring("D", 1e-3)),), [("D", 0.5), ("A", 0.3), ("B", 0.3)]),
        ((solid(UPRIGHT, "", ring("S", 1e-3)),), [("upright", 0.5), ("A", 0.3), ("B", 0.3), ("D", 0.3)]),
        ((solid(HAIRSPRING, "S", ring("S", 1e-3)),), [("S", 0.5), ("A", 0.3), ("B", 0.3), ("D", 0.3)]),
    ],
)
def test_what_no_solid_describes_has_the_usual_thickness(solids: tuple[Solid, ...], expected: list[tuple[str, float]]) -> None:
    """Layers that touch, and of the others those of closed outlines that are material: neither bores nor holes alone."""
    chain = Loop((Line(0.0, 0.0, 1e-3, 0.0),), "OPEN", closed=False)
    loops = (ring("A", 3e-3), ring("A", 1e-3, hole=True), ring("B", 1e-3, 9e-3), chain)
    drawn = (box("D", 20e-3, 0.0, 1e-3, 1e-3), ring("BORE", 0.2e-3), ring("H", 0.2e-3, hole=True), ring("A", 9e-3), chain)
    made = found(Body("b", inertia=1.0, loops=loops, decoration=drawn, solids=solids))
    assert names(made) == expected
    if not solids:
        assert made[0].loops == loops[:2] and made[2].loops == drawn[:1] and made[0].solid is None


def test_a_solid_is_seen_from_above() -> None:
    """Copies about the pivot, both halves of what lies, the coil of a hairspring that is not drawn."""
    two = solid(PLATE, "P", ring("P", 1e-3, 5e-3), count=2, pivot=(2e-3, 1e-3))
    (slab,) = found(Body("b", inertia=1.0, solids=(two,)))
    middles = sorted((loop.edges[0].x, loop.edges[0].y) for loop in slab.loops if isinstance(loop.edges[0], Arc))
    assert middles == [pytest.approx((-1e-3, 2e-3)), pytest.approx((5e-3, 0.0), abs=1e-15)]
    half = box("S", 4e-3, 1e-3, 2e-3, 0.5e-3)
    (screw,) = found(Body("b", inertia=1.0, solids=(solid(LYING, "S", half, axis=((0.0, 1e-3), (1.0, 0.0))),)))
    assert len(screw.loops) == 2 and screw.thickness == pytest.approx(1e-3)
    assert sorted({round(1e3 * edge.start[1], 9) for loop in screw.loops for edge in loop.edges}) == [0.5, 1.0, 1.5]
    coil = solid(HAIRSPRING, "", spiral=Spiral(1e-3, 3e-3, 5.0), width=0.1e-3, pivot=(7e-3, 2e-3), thick=0.2e-3)
    (spring,) = found(Body("b", inertia=1.0, solids=(coil,)))
    far = [math.dist(edge.start, (7e-3, 2e-3)) for loop in spring.loops for edge in loop.edges]
    assert spring.loops[0].edges[0].start == pytest.approx((7e-3 + 1.05e-3, 2e-3), rel=1e-9)
    assert min(far) == pytest.approx(0.95e-3) and max(far) == pytest.approx(3.05e-3) and spring.thickness == 0.2e-3
    staff = solid(UPRIGHT, "", half)
    assert found(Body("b", inertia=1.0, solids=(staff,)))[0].loops == (half,)


def test_the_largest_lie_lowest_with_air_between() -> None:
    """Three that cover one another: 0.3, 0.5 and 0.3 mm thick, a tenth of each more."""
    small, large = Body("s", inertia=1.0, loops=(ring("S", 1e-3),)), Body("l", "fixed", loops=(ring("L", 4e-3),))
    middle = Body("m", inertia=1.0, solids=(solid(PLATE, "M", ring("M", 2e-3)),))
    made = {slab.body: slab.middle for slab in found(small, middle, large)}
    assert made == {"l": pytest.approx(0.15e-3), "m": pytest.approx(0.33e-3 + 0.25e-3), "s": pytest.approx(0.88e-3 + 0.15e-3)}


def test_a_level_is_as_high_as_its_thickest() -> None:
    """Two side by side, of 0.3 and 0.5 mm; what lies above both is clear of the thicker."""
    thin, thick = (
        Body("a", "fixed", loops=(ring("A", 4e-3),)),
        Body("b", "fixed", (9e-3, 0.0), solids=(solid(PLATE, "B", ring("B", 3e-3)),)),
    )
    above = Body("c", "fixed", (1e-3, 0.0), loops=(ring("C", 1e-3),))
    made = {slab.body: slab.middle for slab in found(thin, thick, above)}
    assert made == {"a": pytest.approx(0.25e-3), "b": pytest.approx(0.25e-3), "c": pytest.approx(0.55e-3 + 0.15e-3)}


def test_a_staff_goes_through_the_middle_of_its_body() -> None:
    staff = solid(UPRIGHT, "", box("S", 0.0, 0.0, 1e-3, 1e-3))
    loops = (ring("A", 3e-3), ring("B", 2e-3))
    made = {
        slab.layer: slab.middle
        for slab in found(Body("b", inertia=1.0, loops=loops, solids=(staff,)), Body("c", "fixed", loops=(ring("C", 5e-3),)))
    }
    assert made["upright"] == pytest.approx(0.5 * (made["A"] + made["B"])) and made["A"] != made["B"]
    assert found(Body("b", inertia=1.0, solids=(staff,)))[0].middle == 0.0


@pytest.mark.parametrize("kind", [PLATE, HAIRSPRING, LYING])
def test_only_plates_and_outlines_can_touch(kind: str) -> None:
    """A hairspring on the layer of a contact does not go with it, and lies above the cover."""
    cover = Body("cover", "fixed", loops=(ring("COVER", 9e-3),))
    part = solid(kind, "R", box("R", 0.0, 0.0, 1e-3, 1e-3), thick=0.3e-3, axis=((0.0, 0.0), (1.0, 0.0)))
    first = Body("first", inertia=1.0, loops=(box("R", 0.0, 0.0, 1e-3, 1e-3),), solids=(part,))
    second = Body("second", "fixed", (30e-3, 0.0), loops=(ring("Q", 1e-3),))
    made = {
        slab.body: slab.middle for slab in found(cover, first, second, contacts=(Contact((Side("first"), Side("second"))),))
    }
    assert (made["second"] == made["first"]) is (kind == PLATE)
    assert made["first"] > made["cover"]


@pytest.mark.parametrize(("layer", "along"), [(None, {"A", "B"}), ("A", {"A"}), ("B", {"B"})])
def test_a_contact_of_one_layer_lifts_that_layer_only(layer: str | None, along: set[str]) -> None:
    """Two layers far from each other on one body, another body above a cover."""
    cover = Body("cover", "fixed", loops=(ring("COVER", 9e-3),))
    lifted = Body("lifted", inertia=1.0, loops=(ring("X", 2e-3),))
    body = Body("body", "fixed", (40e-3, 0.0), loops=(ring("A", 1e-3), ring("B", 1e-3, 20e-3)))
    made = {
        slab.layer: slab.middle
        for slab in found(cover, lifted, body, contacts=(Contact((Side("lifted"), Side("body", layer))),))
    }
    assert {name for name in ("A", "B") if made[name] == made["X"]} == along and made["X"] > made["COVER"]


def test_bodies_lie_where_they_stand_at_the_start() -> None:
    """One that is carried there as well: turned by a quarter, it is over the other."""
    arm = Body("arm", inertia=1.0, position=(10e-3, 0.0), angle=math.pi / 2)
    disc = Body("disc", inertia=1.0, position=(5e-3, 0.0), on="arm", loops=(ring("D", 1e-3),))
    under, beside = (Body("plate", "fixed", (10e-3, y), loops=(ring("P", 2e-3),)) for y in (5e-3, -5e-3))
    heights = [[slab.middle for slab in found(arm, disc, plate)] for plate in (under, beside)]
    assert heights[0][0] > heights[0][1] and heights[1][0] == heights[1][1]
