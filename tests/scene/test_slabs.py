"""Which layers of which bodies become slabs, how thick, and at which height? Made-up bodies."""

import math
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from watchsim.geometry.hairspring import Spiral
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.geometry.solids import region
from watchsim.scene.errors import Faults
from watchsim.scene.forces import Contact, Side
from watchsim.scene.keys import BODY
from watchsim.scene.layer_heights import Slab, slabs
from watchsim.scene.load import load
from watchsim.scene.outlines import shape_loops
from watchsim.scene.scene import Body, Scene
from watchsim.scene.solids import HAIRSPRING, LYING, PLATE, UPRIGHT, Solid, Weight
from watchsim.scene.values import Table

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


ROOT = Path(__file__).resolve().parents[2]
HEAD = '[bodies.wheel]\ncircle = "3 mm"\ninertia = "1 mg·cm²"\n'
COVER = '[bodies.cover]\ncircle = "1 mm"\nposition = ["1 mm", "0 mm"]\nmotion = "fixed"\n'
BESIDE = '[bodies.beside]\ncircle = "1 mm"\nposition = ["4.5 mm", "0 mm"]\nmotion = "fixed"\n'


def heights(tmp_path: Path, text: str) -> dict[str, Slab]:
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return {slab.body: slab for slab in slabs(load(path), 0.2e-3)}


def test_what_covers_lies_above_and_what_stands_beside_does_not(tmp_path: Path) -> None:
    found = heights(tmp_path, HEAD + COVER + BESIDE)
    assert found["wheel"].middle == pytest.approx(0.1e-3)
    assert found["cover"].middle == pytest.approx(0.32e-3)  # a tenth of the thickness of air
    assert found["beside"].middle == pytest.approx(0.1e-3)


def test_what_touches_lies_at_one_height(tmp_path: Path) -> None:
    contact = '[[contacts]]\nbetween = ["cover", "beside"]\n'
    found = heights(tmp_path, HEAD + COVER.replace('motion = "fixed"', 'inertia = "1 mg·cm²"') + BESIDE + contact)
    assert found["cover"].middle == found["beside"].middle != found["wheel"].middle


def test_thickness_comes_from_the_scene(tmp_path: Path) -> None:
    solid = '[[bodies.wheel.solids]]\nthickness = "0.5 mm"\ndensity = "8 g/cm³"\n'
    found = heights(tmp_path, HEAD + solid + COVER)
    assert (found["wheel"].thickness, found["wheel"].middle) == pytest.approx((0.5e-3, 0.25e-3))
    assert found["wheel"].solid is not None and found["cover"].solid is None
    assert found["cover"].middle == pytest.approx(0.65e-3)


def test_no_two_layers_of_the_swiss_lever_share_a_place() -> None:
    scene = load(ROOT / "profiles/swiss_lever/scene.toml")
    found = slabs(scene, 0.2e-3)
    assert len(found) == 10
    by_name = {(slab.body, slab.layer): slab.middle for slab in found}
    for contact in scene.contacts:
        first, second = (by_name[side.body, side.layer] for side in contact.sides)
        assert first == second
    for a, b in combinations(found, 2):
        if a.middle == b.middle:
            shapes = [
                region((loop.moved(scene.body(s.body).angle, scene.body(s.body).position) for loop in s.loops), 1e-6)
                for s in (a, b)
            ]
            assert shapes[0].intersection(shapes[1]).area < 1e-3 * min(shape.area for shape in shapes), (a.layer, b.layer)


def test_a_plate_without_a_layer_takes_that_of_its_body(tmp_path: Path) -> None:
    plate = '[[bodies.wheel.solids]]\nthickness = "0.5 mm"\ndensity = "8 g/cm³"\n'
    path = tmp_path / "scene.toml"
    path.write_text(HEAD + plate, encoding="utf-8")
    scene = load(path)
    (slab,) = slabs(scene, 0.2e-3)
    assert [slab.layer] == list(scene.body("wheel").layers) and slab.layer != "plate"


@pytest.mark.parametrize(
    ("kind", "layers", "name"), [(PLATE, ("RIM",), "RIM"), (PLATE, ("RIM", "HUB"), PLATE), (UPRIGHT, ("RIM",), UPRIGHT)]
)
def test_a_solid_without_a_layer_is_called_after_the_only_one_if_it_is_a_plate(
    kind: str, layers: tuple[str, ...], name: str
) -> None:
    rings = tuple(Loop((Arc(0.0, 0.0, 1e-3 * k, 0.0, math.tau),), layer) for k, layer in enumerate(layers, 1))
    solid = Solid(kind, "", Weight(1e-6, (0.0, 0.0), 1e-12), 8e3, rings[:1], 0.2e-3)
    body = Body("balance", "pivot", inertia=1e-12, loops=rings, solids=(solid,))
    assert slabs(Scene("one", (body,)), 0.2e-3)[0].layer == name


@pytest.mark.parametrize(("apart", "together"), [(0.0, True), (0.019, True), (0.021, False), (1.0, False)])
def test_layers_of_one_body_that_meet_lie_at_one_height(apart: float, together: bool) -> None:
    """A wide plate covers the one layer, so that it lies higher; the other goes with it where they are side by side."""

    def block(layer: str, x: float, width: float, height: float) -> Loop:
        corners = [(x, 0.0), (x + width, 0.0), (x + width, height), (x, height)]
        ends = corners[1:] + corners[:1]
        return Loop(tuple(Line(*(1e-3 * c for c in (*a, *b))) for a, b in zip(corners, ends, strict=True)), layer)

    wide = Body("wide", "fixed", loops=(block("PLATE", -9.0, 9.5, 5.0),))
    two = Body("two", "pivot", inertia=1e-9, loops=(block("LEFT", 0.0, 1.0, 1.0), block("RIGHT", 1.0 + apart, 1.0, 1.0)))
    found = {slab.layer: slab.middle for slab in slabs(Scene("beside", (wide, two)), 0.2e-3)}
    assert found["LEFT"] > found["PLATE"] == pytest.approx(0.1e-3)
    assert (found["RIGHT"] == found["LEFT"]) == together
    assert together or found["RIGHT"] == found["PLATE"]


@pytest.mark.parametrize(("share", "above"), [(0.9e-3, False), (1.1e-3, True)])
@pytest.mark.parametrize("larger", [1.0, 3.0])
def test_what_covers_no_thousandth_of_the_smaller_stands_beside_it(share: float, above: bool, larger: float) -> None:
    def square(name: str, x: float, size: float) -> Body:
        corners = [(x, 0.0), (x + size, 0.0), (x + size, size), (x, size)]
        ends = corners[1:] + corners[:1]
        lines = tuple(Line(*(1e-3 * c for c in (*a, *b))) for a, b in zip(corners, ends, strict=True))
        return Body(name, "fixed", loops=(Loop(lines, name),))

    scene = Scene("two", (square("first", 0.0, larger), square("second", larger - share, 1.0)))
    first, second = slabs(scene, 0.4e-3)
    assert first.middle == pytest.approx(0.2e-3)
    assert second.middle == pytest.approx(0.2e-3 + (0.44e-3 if above else 0.0))


FIVE = [["0 mm", "0 mm"], ["5 mm", "1 mm"], ["6 mm", "4 mm"], ["3 mm", "7 mm"], ["-1 mm", "3 mm"]]


def shape(key: str, value: Any) -> tuple[tuple[Any, ...], list[str]]:
    table = Table({key: value}, "b", BODY, Faults())
    return shape_loops(table, key), [f"{fault.key}: {fault.message}" for fault in table.faults.found]


@pytest.mark.parametrize("order", [1, -1])
def test_a_polygon_runs_round_its_material(order: int) -> None:
    (loop,), said = shape("polygon", FIVE[::order])
    corners = [(1e-3 * float(x[:-3]), 1e-3 * float(y[:-3])) for x, y in FIVE]
    assert not said and loop.layer == "polygon" and loop.closed and not loop.hole
    found = [edge.start for edge in loop.edges]
    at = next(k for k, place in enumerate(found) if math.dist(place, corners[0]) < 1e-15)
    assert [abs(complex(*a) - complex(*b)) < 1e-15 for a, b in zip(found[at:] + found[:at], corners, strict=True)] == [True] * 5
    assert all(isinstance(edge, Line) and edge.end == loop.edges[(k + 1) % 5].start for k, edge in enumerate(loop.edges))


def test_circles_and_lines() -> None:
    (ring,), said = shape("circle", "2.5 mm")
    assert not said and ring.layer == "circle" and isinstance(ring.edges[0], Arc) and ring.edges[0].is_circle
    assert (ring.edges[0].x, ring.edges[0].y, ring.edges[0].radius, ring.edges[0].start_angle) == (0.0, 0.0, 2.5e-3, 0.0)
    (line,), said = shape("line", FIVE[1:3])
    assert not said and not line.closed and line.layer == "line"
    assert (line.edges[0].start, line.edges[0].end) == (pytest.approx((5e-3, 1e-3)), pytest.approx((6e-3, 4e-3)))


@pytest.mark.parametrize("point", range(5))
@pytest.mark.parametrize("axis", [0, 1])
def test_one_value_that_cannot_be_read_is_one_fault(point: int, axis: int) -> None:
    """Wherever it stands: what sides with such an end cross is not asked."""
    bad = [list(one) for one in FIVE]
    bad[point][axis] = "5"
    found, said = shape("polygon", bad)
    assert found == () and len(said) == 1 and said[0].startswith(f"b.polygon.{point}.{axis}: ")
    double = [list(one) for one in FIVE]
    double[point], double[(point + 1) % 5] = ["3 mm", "3 mm"], ["3 mm", "3 mm"]
    double[(point + 3) % 5][axis] = "5 kg"
    assert len(shape("polygon", double)[1]) == 1


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("circle", "0 mm", "b.circle: must be above zero: it is the radius"),
        ("circle", "x", "b.circle: "),
        (
            "polygon",
            FIVE[:2],
            "b.polygon: a list of at least 3 points is needed here: "
            'polygon = [["0 mm", "0 mm"], ["5 mm", "0 mm"], ["0 mm", "5 mm"]]',
        ),
        ("line", FIVE[:1], 'b.line: a list of at least 2 points is needed here: line = [["0 mm", "0 mm"], ["5 mm", "0 mm"]]'),
        ("line", FIVE[:3], "b.line: a line has two points; more make a polygon"),
        ("line", [FIVE[1], FIVE[1]], "b.line: its two points are the same"),
        ("line", "5 mm", "b.line: a list of at least 2 points"),
        ("polygon", [FIVE[0], FIVE[1], FIVE[0]], "b.polygon: a point occurs twice in it"),
        ("polygon", [FIVE[0], FIVE[1], ["10 mm", "2 mm"]], "b.polygon: it encloses no area"),
        ("polygon", [FIVE[0], FIVE[1], FIVE[4], FIVE[2]], "b.polygon: its sides 1 and 3 (counted from 0) cross each other"),
        ("polygon", [FIVE[0], ["1 mm"], FIVE[1]], "b.polygon.1: two values are needed here"),
    ],
)
def test_a_mistake_is_one_fault_and_no_outline(key: str, value: Any, words: str) -> None:
    found, said = shape(key, value)
    assert found == () and len(said) == 1 and said[0].startswith(words)
    assert said[0].endswith("]]") is ("at least" in words)
