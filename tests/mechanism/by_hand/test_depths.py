"""How deep do regions and faces overlap, judged by hand and by sampling?"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.material_polygons import chord_points
from watchsim.mechanism.overlap import DEVIATION, meetings, overlap_faults, overlaps
from watchsim.mechanism.overlap_depth import COARSE, _behind_arc, common_parts, face_depth, regions_depth
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.tolerances import DRAWING_ROUNDING

CORNER = (Line(0.0, 0.0, 10e-3, 0.0), Line(10e-3, 0.0, 10e-3, 7e-3))  # material above the first and left of the second
FACE = chord_points(Loop(CORNER, closed=False), COARSE)


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
    found, at = face_depth(FACE, CORNER, shapely.box(*box), 2e-9)
    assert found == pytest.approx(depth, rel=1e-9, abs=1e-15)
    if place:
        assert at[1] == pytest.approx(place[1], abs=1e-15)
    elif depth > 0.0:
        assert shapely.box(*box).buffer(1e-12).contains(shapely.Point(at))
    assert face_depth(FACE, CORNER, shapely.Polygon(), 2e-9)[0] == -1.0


@pytest.mark.parametrize("sweep", [1.3, -1.3, 2.9, -4.0])
@pytest.mark.parametrize("start", [0.4, -2.0, 3.0])
def test_behind_an_arc(start: float, sweep: float) -> None:
    """Inside of the circle where it runs counter-clockwise, else outside; beside it between its two ends."""
    arc = Arc(3e-3, -2e-3, 5e-3, start, sweep)
    rng = np.random.default_rng(3)
    share, radius = rng.uniform(-0.3, 1.3, 60), rng.uniform(1e-3, 9e-3, 60)
    share[abs(share) < 0.01] = 0.5
    angle = start + share * sweep
    points = np.column_stack((arc.x + radius * np.cos(angle), arc.y + radius * np.sin(angle)))
    beside, behind = _behind_arc(arc, points)
    wraps = abs(sweep) * 1.3 > math.tau or abs(sweep) * 1.6 > math.tau
    if not wraps:
        assert beside.tolist() == ((share >= 0.0) & (share <= 1.0)).tolist()
    assert behind == pytest.approx((5e-3 - radius) * (1.0 if sweep > 0.0 else -1.0), abs=1e-15)


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
    assert 0.2 * DEVIATION < one.allowed - 2e-9 <= DEVIATION and other.allowed == pytest.approx(one.allowed, rel=1e-12)
    assert one.allowed < both.allowed <= 2e-9 + 2.0 * DEVIATION
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
