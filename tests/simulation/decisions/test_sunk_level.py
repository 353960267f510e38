"""From which gap on does a contact close that flat faces have let sink in?"""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from plain_kernels import in_python

from watchsim.model.records import ARC, LINE
from watchsim.simulation.first_closing import sunk_level as module

NEAR_POINTS = 100.0  # extents
OPTIONS = SimpleNamespace(behind=1e-8, sunk=1e-6, extent=1e-9)
CONVEX, CONCAVE = 0, -1  # joints: the number of a corner, the first one, or none


def level(gap: float, inside: float = 0.0, *, one_way: bool = True, joints=(CONCAVE, CONCAVE), kind=LINE, at: float = 0.9):
    """Of a point near one end of a line of length 1 (`at` along it), or of an arc, whose joints before and after these are."""
    before, after = joints
    point = SimpleNamespace(x=at, y=0.0, body=0)
    edge = SimpleNamespace(x=0.0, y=0.0, tx=1.0, ty=0.0, length=1.0, kind=kind, before=before, after=after, body=1)
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0, b=1)], primitives=[point, edge])
    pose = [SimpleNamespace(x=3.0, y=-2.0)] * 2
    kernel = in_python(
        module.sunk_level,
        contact_kinematics=lambda *_: None,
        has_one_way=lambda model, probe, i, depth: one_way and depth == OPTIONS.sunk,
        point_of=lambda pose, x, y: (x, y),
    )
    return kernel(model, OPTIONS, 0, gap, inside, SimpleNamespace(pose=pose, probe=None))


@pytest.mark.parametrize("gap", [-1.01e-8, -5e-7, -1e-6])
def test_it_closes_at_the_gap_it_has_sunk_to(gap: float) -> None:
    assert level(gap) == gap


@pytest.mark.parametrize("gap", [1e-9, 0.0, -1e-8, -1.01e-6])
def test_what_is_not_behind_or_deeper_than_faces_let_it_sink_closes_at_zero(gap: float) -> None:
    assert level(gap) == 0.0


def test_only_near_the_end_of_the_next_face_and_where_bodies_move_one_way() -> None:
    reach = NEAR_POINTS * OPTIONS.extent
    assert level(-5e-7, reach) == -5e-7
    assert level(-5e-7, 1.01 * reach) == 0.0
    assert level(-5e-7, one_way=False) == 0.0


@pytest.mark.parametrize("at", [0.1, 0.49, 0.51, 0.9])
def test_past_a_convex_joint_a_line_falls_away(at: float) -> None:
    nearer = (CONVEX, CONCAVE) if at < 0.5 else (CONCAVE, CONVEX)
    assert level(-5e-7, joints=nearer, at=at) == 0.0
    assert level(-5e-7, joints=nearer[::-1], at=at) == -5e-7


def test_of_an_arc_either_end_may_be_the_joint() -> None:
    assert level(-5e-7, kind=ARC, joints=(CONVEX, CONCAVE)) == level(-5e-7, kind=ARC, joints=(CONCAVE, CONVEX)) == -5e-7
    assert level(-5e-7, kind=ARC, joints=(CONVEX, CONVEX)) == 0.0
