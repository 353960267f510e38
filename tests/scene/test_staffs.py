"""Where does a staff end, and how high is a part that lies?"""

from __future__ import annotations

import pytest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.layer_heights import slabs
from watchsim.scene.scene import Body, Scene
from watchsim.scene.solids import LYING, PLATE, UPRIGHT, Solid, Weight


def rectangle(x0: float, y0: float, x1: float, y1: float, layer: str) -> Loop:
    corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), layer)


def solid(kind: str, loop: Loop, thickness: float = 0.0) -> Solid:
    return Solid(kind, loop.layer, Weight(1.0, (0.0, 0.0), 1.0), 1.0, (loop,), thickness)


STAFF = solid(UPRIGHT, rectangle(-2.0, 0.0, 2.0, 0.1, "STAFF"))
LOW, HIGH = (solid(PLATE, rectangle(-2.0, -2.0, 2.0, 2.0, name), thick) for name, thick in (("LOW", 1.0), ("HIGH", 0.5)))


@pytest.mark.parametrize("order", [(STAFF, LOW, HIGH), (LOW, HIGH, STAFF), (LOW, STAFF, HIGH)])
def test_a_staff_goes_through_the_middle_of_its_own_body(order: tuple[Solid, ...]) -> None:
    """LOW from 0 to 1, HIGH above a tenth of that from 1.1 to 1.6; another body's plates are not its business."""
    other = Body("other", "fixed", solids=(solid(PLATE, rectangle(-1.0, -1.0, 1.0, 1.0, "ELSEWHERE"), 7.0),))
    found = {slab.layer: slab for slab in slabs(Scene("", (Body("a", "pivot", solids=order), other)), 0.2)}
    assert [found[name].middle for name in ("LOW", "HIGH")] == pytest.approx([0.5, 1.35])
    assert found["STAFF"].middle == pytest.approx(0.5 * (0.5 + 1.35))


def test_a_staff_alone_stands_on_the_ground() -> None:
    (only,) = slabs(Scene("", (Body("a", "pivot", solids=(STAFF,)),)), 0.2)
    assert only.middle == 0.0


def test_a_lying_part_is_as_high_as_it_is_wide() -> None:
    """A rod of radius 0.3 about the x axis: 0.6 high, and seen from above on both sides of its axis."""
    rod = solid(LYING, rectangle(1.0, 0.0, 3.0, 0.3, "ROD"))
    (lying,) = slabs(Scene("", (Body("a", "pivot", solids=(rod,)),)), 0.2)
    assert lying.thickness == pytest.approx(0.6) and lying.middle == pytest.approx(0.3)
    assert {round(y, 12) for loop in lying.loops for edge in loop.edges for _, y in (edge.start,)} == {-0.3, 0.0, 0.3}
