"""Are bodies that stand in each other found, and bodies that only touch left alone?"""

import math

import pytest

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.overlap import overlap_faults, overlaps
from watchsim.scene.body import Body
from watchsim.scene.file.load import load
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene


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


def test_only_declared_pairs_are_looked_at(desk, good):
    text = good.replace('position = ["0 mm", "20 mm"]', 'position = ["0 mm", "4 mm"]')
    assert overlap_faults(load(desk.scene(text))) == [], "the balance stands in the wheel, but they lie on different levels"
