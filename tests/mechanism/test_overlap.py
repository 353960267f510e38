"""Are bodies that stand in each other found, how deep are they, and are bodies that only touch left alone?"""

import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely
from simulation.moving_scenes import profile

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.overlap import (
    chord_points,
    common_parts,
    cure_of,
    face_depth,
    meetings,
    overlap_faults,
    overlaps,
    placed,
    refined_points,
    regions_depth,
)
from watchsim.scene.forces import Contact, Side
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.tolerances import CHORDS_APART, CHORDS_NEAR, DRAWING_ROUNDING

# Are bodies that stand in each other found, and bodies that only touch left alone?


def circle(radius, x=0.0, y=0.0, hole=False):
    return Loop((Arc(x, y, radius, 0.0, -2 * math.pi if hole else 2 * math.pi),), "C", hole=hole)


def box(x0, y0, x1, y1, hole=False):
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    loop = Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), "C", hole=hole)
    return loop.reversed() if hole else loop


def depth(first, second, position=(0.0, 0.0), angle=0.0):
    """Of `second` at `position` in `first` at the origin; 0 where nothing is reported."""
    bodies = (Body("a", "fixed", loops=first), Body("b", "free", position, angle, loops=second))
    found = overlaps(Scene("", bodies, contacts=(Contact((Side("a"), Side("b"))),)))
    return found[0].depth if found else 0.0


MM = 1e-3
DISC = (circle(1 * MM),)
BLOCK = (box(-5 * MM, -5 * MM, 5 * MM, 5 * MM),)


@pytest.mark.parametrize("gap", [1e-6, 1e-9, 0.0, -1e-10])
def test_resting_contacts_pass(gap):
    assert depth(BLOCK, DISC, (0.0, 6 * MM + gap)) == 0.0, "disc on a block"
    assert depth(DISC, DISC, (0.0, 2 * MM + gap)) == 0.0, "disc on a disc"
    assert depth(BLOCK, BLOCK, (0.0, 10 * MM + gap)) == 0.0, "block on a block"
    assert depth((circle(3 * MM), circle(2 * MM, hole=True)), DISC, (0.0, 1 * MM - gap)) == 0.0, "disc inside a ring"


def test_a_disc_in_its_own_seat_passes():
    """Convex in concave with the same radius: every point touches."""
    assert depth((box(-5 * MM, -5 * MM, 5 * MM, 5 * MM), circle(1 * MM, hole=True)), DISC, angle=0.3) == 0.0


@pytest.mark.parametrize("deep", [5e-9, 1e-6, 0.1e-3])
def test_depths(deep):
    assert depth(BLOCK, DISC, (0.0, 6 * MM - deep)) == pytest.approx(deep, rel=0.02, abs=1e-9)
    assert depth(DISC, DISC, (2 * MM - deep, 0.0)) == pytest.approx(deep, rel=0.02, abs=1e-9)
    corner = (0.0, 5 * MM + math.sqrt(2) * MM - deep)
    assert depth(BLOCK, (box(-1 * MM, -1 * MM, 1 * MM, 1 * MM),), corner, math.pi / 4) == pytest.approx(
        deep, rel=1e-6, abs=1e-9
    )
    ring = (circle(3 * MM), circle(2 * MM, hole=True))
    assert depth(ring, DISC, (1 * MM + deep, 0.0)) == pytest.approx(deep, rel=0.02, abs=1e-9)


def test_a_body_swallowed_whole_is_found_and_one_in_a_hole_is_not():
    assert depth(BLOCK, (circle(0.1 * MM),)) > 1 * MM
    assert depth((*BLOCK, box(-2 * MM, -2 * MM, 2 * MM, 2 * MM, hole=True)), DISC) == 0.0
    island = (*BLOCK, box(-2 * MM, -2 * MM, 2 * MM, 2 * MM, hole=True), circle(0.5 * MM))
    assert depth(island, DISC) > 0.1 * MM


FACE = (Loop((Line(20.0, 0.0, -1.0, 0.0),), "line", closed=False),)  # material below


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_open_faces(angle):
    assert depth(FACE, DISC, (0.0, 1 * MM), angle) == 0.0
    assert depth(FACE, DISC, (0.0, 150 * MM), angle) == 0.0
    assert depth(FACE, DISC, (0.0, 0.9 * MM), angle) == pytest.approx(0.1 * MM, rel=1e-3)
    assert depth(FACE, DISC, (-1.01, 0.0), angle) == 0.0, "beside the face"
    assert depth(DISC, FACE, (0.0, -0.9 * MM)) == pytest.approx(0.1 * MM, rel=1e-3), "in either order"


ROOF = (Loop((Line(2 * MM, 0.0, 0.0, 0.5 * MM), Line(0.0, 0.5 * MM, -2 * MM, 0.0)), "roof", closed=False),)  # material below
HIGH = (Loop((Arc(0.0, 0.0, MM, 0.2, math.pi - 0.4),), "arch", closed=False),)
SQUARE = (box(-1 * MM, -1 * MM, 1 * MM, 1 * MM),)


@pytest.mark.parametrize("angle", [0.0, 0.7])
@pytest.mark.parametrize(("face", "top"), [(ROOF, 0.5), (HIGH, 1.0)])
def test_a_corner_of_an_open_face_that_a_body_covers(face: tuple[Loop, ...], top: float, angle: float) -> None:
    """No corner of the body is behind the face: how deep the ridge stands in the body counts."""
    c, s = math.cos(angle), math.sin(angle)
    turned = (face[0].moved(angle, (0.0, 0.0)),)

    def at(x: float, y: float) -> float:
        return depth(turned, SQUARE, (MM * (x * c - y * s), MM * (x * s + y * c)), angle)

    assert at(0.0, top + 1.0) == 0.0
    assert at(0.0, top + 0.9) == pytest.approx(0.1 * MM, rel=1e-3)


OVERLAPPING = 'position = ["0 mm", "9 mm"]\nangle = "10°"'


def test_faults_name_bodies_layers_depth_and_place(desk, good):
    assert overlap_faults(load(desk.scene())) == []
    text = good.replace(OVERLAPPING, 'position = ["0 mm", "4.9 mm"]\nangle = "0°"')
    (fault,) = overlap_faults(load(desk.scene(text)))
    line = 1 + text.split("\n").index('inertia = "0.05 mg·cm²"')
    heading = f"{desk.folder}/scene.toml:{line - 4}  bodies.wheel.position\n"
    assert str(fault).startswith(heading + "  wheel and lever overlap by 0.1 mm at the start, at (")
    assert "4.9) mm (layers TEETH and polygon). Move or turn one of them" in str(fault)
    assert f"watchsim check {desk.folder}/scene.toml --png" in str(fault)


@pytest.mark.parametrize("overlapping", ["12°", "16°", "22°"])
def test_an_angle_at_which_a_body_is_free_is_named_and_does_free_it(overlapping):
    swiss = profile("swiss_lever")
    turned = swiss.set("bodies.wheel.angle", overlapping)
    (overlap,) = overlaps(turned)
    angle = re.search(r'wheel is free at angle = "(.*)"$', cure_of(turned, overlap))
    assert angle and not overlap_faults(swiss.set("bodies.wheel.angle", angle[1]))


def test_only_declared_pairs_are_looked_at(desk, good):
    text = good.replace('position = ["0 mm", "20 mm"]', 'position = ["0 mm", "4 mm"]')
    assert overlap_faults(load(desk.scene(text))) == [], "the balance stands in the wheel, but they lie on different levels"


# How deep do regions and faces overlap, judged by hand and by sampling?

CORNER = (Line(0.0, 0.0, 10e-3, 0.0), Line(10e-3, 0.0, 10e-3, 7e-3))  # material above the first and left of the second
FACE_DEPTHS = chord_points(Loop(CORNER, closed=False), CHORDS_APART)


@pytest.mark.parametrize(
    ("box", "depth", "place"),
    [
        ((1e-3, -0.5e-3, 3e-3, 0.4e-3), 0.4e-3, None),  # across the first edge, 7 mm in front of the second
        ((9.2e-3, 5e-3, 11e-3, 6e-3), 0.8e-3, None),
        ((9.2e-3, -1e-3, 11e-3, 0.3e-3), 0.8e-3, None),
        ((1e-3, -0.5e-3, 3e-3, 0.0), 0.0, None),
        ((1e-3, -0.5e-3, 3e-3, -1e-9), 0.0, (1e-3, 0.0)),
        ((1e-3, -0.5e-3, 3e-3, -3e-9), -1.0, (0.0, 0.0)),
        ((-2e-3, 1e-3, -1e-3, 2e-3), -1.0, (0.0, 0.0)),
    ],
)
def test_behind_a_face_counts_what_lies_beside_the_edge_that_is_crossed(
    box: tuple[float, ...], depth: float, place: tuple[float, float] | None
) -> None:
    found, at = face_depth(FACE_DEPTHS, CORNER, shapely.box(*box), 2e-9)
    assert found == pytest.approx(depth, rel=1e-9, abs=1e-15)
    if place:
        assert at[1] == pytest.approx(place[1], abs=1e-15)
    elif depth > 0.0:
        assert shapely.box(*box).buffer(1e-12).contains(shapely.Point(at))
    assert face_depth(FACE_DEPTHS, CORNER, shapely.Polygon(), 2e-9)[0] == -1.0


@pytest.mark.parametrize(("apart", "depth"), [(-1e-3, 1e-3), (0.0, 0.0), (1.9e-9, 0.0), (2.1e-9, -1.0), (1e-3, -1.0)])
def test_regions_touch_up_to_what_is_allowed(apart: float, depth: float) -> None:
    one, other = shapely.box(0.0, 0.0, 5e-3, 4e-3), shapely.box(5e-3 + apart, 1e-3, 9e-3, 3e-3)
    for first, second in ((one, other), (other, one)):
        found, (x, y) = regions_depth(first, second, 2e-9)
        assert found == pytest.approx(depth, rel=1e-9, abs=1e-15)
        if found >= 0.0:
            assert 1e-3 <= y <= 3e-3 and 5e-3 - 1e-3 - 1e-12 <= x <= 5e-3 + 2e-9


def test_of_bars_that_cross_the_width_counts() -> None:
    """A slot of 0.2 mm by 6 mm through a plate: no corner lies in the other, and the disc that fits is 0.2 mm wide, nearly."""
    plate, bar = shapely.box(0.0, 0.0, 5e-3, 4e-3), shapely.box(1e-3, -1e-3, 1.2e-3, 5e-3)
    depth, (x, y) = regions_depth(plate, bar, 2e-9)
    assert depth == pytest.approx(2.0 * (0.2e-3 * 4e-3) / (8.4e-3), rel=1e-9, abs=0.0)
    assert 1e-3 < x < 1.2e-3 and 0.0 < y < 4e-3


def test_a_corner_counts_by_how_deep_it_lies() -> None:
    """3 mm by 0.5 mm of a corner lie in the other: half a millimetre deep, at the corner."""
    depth, place = regions_depth(shapely.box(0.0, 0.0, 5e-3, 4e-3), shapely.box(2e-3, 3.5e-3, 9e-3, 9e-3), 2e-9)
    assert depth == pytest.approx(0.5e-3) and place in (
        (2e-3, 3.5e-3),
        pytest.approx((5e-3, 4e-3)),
        pytest.approx((5e-3, 3.5e-3)),
    )


def test_common_parts_lie_in_both() -> None:
    comb = shapely.union_all([shapely.box(k, 0.0, k + 0.5, 2.0) for k in range(3)] + [shapely.box(0.0, 2.0, 3.0, 3.0)])
    parts = common_parts(comb, shapely.box(-1.0, 0.5, 2.25, 1.0), 1e-9)
    assert sorted(part.area for part in parts) == pytest.approx([0.125, 0.25, 0.25])


def disc(name: str, x: float, radius: float) -> Body:
    return Body(name, "fixed", (x, 0.0), loops=(Loop((Arc(0.0, 0.0, radius, 0.0, math.tau),), "L"),))


def block(name: str, x: float) -> Body:
    corners = [(0.0, -1e-3), (2e-3, -1e-3), (2e-3, 3e-3), (0.0, 3e-3)]
    lines = tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))
    return Body(name, "pivot", (x, 0.0), loops=(Loop(lines, "L"),), inertia=1.0)


def touching(*bodies: Body) -> Scene:
    return Scene("two", bodies, contacts=(Contact((Side(bodies[0].name), Side(bodies[1].name))),))


def test_what_is_allowed_grows_with_the_error_of_the_chords_of_either() -> None:
    """Flat sides have none; of each arc no more than what its chords near the other may deviate."""
    (flat,) = meetings(touching(block("a", 0.0), block("b", 2e-3)))
    (one,) = meetings(touching(disc("a", -3e-3, 3e-3), block("b", 0.0)))
    (other,) = meetings(touching(block("a", 0.0), disc("b", -3e-3, 3e-3)))
    (both,) = meetings(touching(disc("a", -3e-3, 3e-3), disc("b", 4e-3, 4e-3)))
    assert flat.allowed == DRAWING_ROUNDING == 2e-9
    assert 0.2 * CHORDS_NEAR < one.allowed - 2e-9 <= CHORDS_NEAR and other.allowed == pytest.approx(one.allowed, rel=1e-12)
    assert one.allowed < both.allowed <= 2e-9 + 2.0 * CHORDS_NEAR
    assert [met.depth for met in (flat, one, other, both)] == pytest.approx([0.0] * 4, abs=2e-10)


@pytest.mark.parametrize(("deep", "told"), [(1.8e-9, False), (2.3e-9, True), (1e-4, True)])
def test_an_overlap_is_one_beyond_what_is_allowed(deep: float, told: bool) -> None:
    found = overlaps(touching(disc("a", -3e-3 + deep, 3e-3), block("b", 0.0)))
    assert bool(found) is told
    if told:
        assert found[0].depth == pytest.approx(deep, abs=2e-10) and found[0].contact == 0
        assert found[0].place[0] == pytest.approx(deep, abs=1e-6)


def test_the_deepest_of_several_layers_is_told() -> None:
    """Three discs on layers of one body; of each contact the deepest."""
    rings = tuple(Loop((Arc(0.0, 9e-3 * k, 1e-3 + k * 1e-4, 0.0, math.tau),), f"R{k}") for k in (1, 3, 2))
    wall = Body("wall", "fixed", (0.9e-3, 0.0), loops=(Loop((Line(0.0, 40e-3, 0.0, -40e-3),), "W", closed=False),))
    ringed = Body("rings", "pivot", loops=rings, inertia=1.0)
    (found,) = overlaps(touching(ringed, wall))
    assert found.sides == (Side("rings", "R3"), Side("wall", "W")) and found.depth == pytest.approx(0.4e-3, rel=1e-3)
    assert found.place == pytest.approx((1.3e-3, 27e-3), abs=2e-5)
    words = "rings and wall overlap by 0.4 mm at the start, at (1.3, 27) mm (layers R3 and W)"
    assert str(found) == words


@pytest.mark.parametrize(
    ("motions", "named"),
    [(("fixed", "pivot"), "b"), (("pivot", "fixed"), "a"), (("pivot", "slide"), "a"), (("fixed", "fixed"), "a")],
)
def test_an_overlap_is_a_fault_of_the_body_that_can_be_moved(tmp_path: Path, motions: tuple[str, str], named: str) -> None:
    """At its position, else at its table, else of the scene."""
    ring = (Loop((Arc(0.0, 0.0, 1e-3, 0.0, math.tau),), "R"),)
    bodies = tuple(
        Body(name, motion, (k * 1.5e-3, 0.0), inertia=1.0, mass=1.0, loops=ring)
        for k, (name, motion) in enumerate(zip("ab", motions, strict=True))
    )
    path = tmp_path / "scene.toml"
    path.write_text('[bodies.a]\nposition = ["0 mm", "0 mm"]\n[bodies.b]\ncircle = "1 mm"\n', encoding="utf-8")
    scene = Scene("t", bodies, contacts=(Contact((Side("a"), Side("b"))),), path=path)
    (fault,) = overlap_faults(scene)
    assert fault.key == f"bodies.{named}.position" and fault.place == f"{path}:{2 if named == 'a' else 3}"
    assert f"`watchsim check {path} --png FILE` shows where" in fault.message
    (bare,) = overlap_faults(replace(scene, path=None))
    assert bare.place == "scene" and "`watchsim check` shows where" in bare.message


# Are chords split where they are asked to be, and there alone, and is it said how far they are from their arcs?

HALF = Loop((Line(-1.0, 0.0, 0.0, -3.0), Line(0.0, -3.0, 1.0, 0.0), Arc(0.0, 0.0, 1.0, 0.0, math.pi)))
ENDS = Arc(3.0, 0.0, 0.5, -0.5 * math.pi, math.pi), Arc(0.0, 0.0, 0.5, 0.5 * math.pi, math.pi)
SLOT = Loop((Line(0.0, -0.5, 3.0, -0.5), ENDS[0], Line(3.0, 0.5, 0.0, 0.5), ENDS[1]))
ROUND = Loop((Arc(0.5, -0.5, 2.0, 0.3, -math.tau),), hole=True)
BOW = Loop((Arc(0.0, 0.0, 1.0, 0.2, 1.5), Line(*Arc(0.0, 0.0, 1.0, 0.2, 1.5).end, 3.0, 3.0)), closed=False)


def sagitta(loop: Loop, start: np.ndarray, end: np.ndarray) -> float:
    """How far a chord is from the arc that it belongs to, m; 0 of a line."""
    for edge in loop.edges:
        if isinstance(edge, Arc):
            away = [abs(math.dist(p, (edge.x, edge.y)) - edge.radius) for p in (start, end)]
            if max(away) < 1e-9:
                return edge.radius - math.dist(0.5 * (start + end), (edge.x, edge.y))
    return 0.0


@pytest.mark.parametrize("loop", [HALF, SLOT, ROUND, BOW], ids=["half", "slot", "round", "open"])
@pytest.mark.parametrize("seed", range(4))
def test_marked_chords_are_split(loop: Loop, seed: int) -> None:
    """None, one, some or all of them."""
    coarse, fine = 2e-2, 3e-4
    before = chord_points(loop, coarse)
    count = len(before) - 1
    near = np.random.default_rng(seed).random(count) < 0.5
    near = [np.zeros(count, bool), np.arange(count) == count - 1, near, np.ones(count, bool)][seed]
    points, worst = refined_points(loop, coarse, near, fine)
    at, deviations = 0, [0.0]
    for marked, (start, end) in zip(near, pairwise(before), strict=True):
        assert points[at] == pytest.approx(start, abs=1e-12)
        stretch = [points[at]]
        while not np.allclose(points[at], end, atol=1e-9):
            at += 1
            stretch.append(points[at])
        split = marked and sagitta(loop, start, end) > fine
        assert (len(stretch) > 2) is bool(split)
        if marked:
            deviations += [sagitta(loop, a, b) for a, b in pairwise(stretch)]
    assert at == len(points) - 1
    assert worst == pytest.approx(max(deviations), rel=1e-3) and worst <= fine


def test_points_that_others_keep_are_not_written_into() -> None:
    with pytest.raises(ValueError, match="read-only"):
        chord_points(HALF, 1e-2)[0, 0] = 9.0


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_points_of_a_body_that_stands_somewhere(angle: float) -> None:
    points = np.array([[1.0, 0.0], [0.0, 2.0], [-3.0, 0.5]])
    turned = (points[:, 0] + 1j * points[:, 1]) * np.exp(1j * angle) + 4.0 - 5.0j
    assert placed(points, (4.0, -5.0, angle)) == pytest.approx(np.column_stack((turned.real, turned.imag)), abs=1e-14)
