"""When is a mode that has ended not begun anew, and when are two contacts one? Each threshold from either side."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.index_sets import FORWARD, STICK
from watchsim.simulation.events import handover, released_contacts

BOTH_SIDES = pytest.mark.parametrize("share", [0.9, 1.1])
EXTENT = 2e-6
Two = tuple[float, float]


def weakest(press: list[float], grip: list[float], modes: list[int], friction: float = 0.3) -> tuple[bool, int, bool]:
    """Of contacts with this much left of their forces; the largest normal force is 5, the lenience 3, `force_zero` 1e-10."""
    half = 0.5 * 3.0 * 1e-10

    def press_left(work: object, i: int, zero: float) -> float:
        assert zero == pytest.approx(half, rel=1e-12, abs=0.0)
        return press[i]

    def grip_left(mu: float, work: object, i: int, zero: float) -> float:
        assert mu == friction and zero == pytest.approx(half, rel=1e-12, abs=0.0)
        return grip[i]

    ids = [4, 1, 6][: len(press)]
    mode = np.zeros(8, int)
    mode[ids] = modes
    model = SimpleNamespace(contacts=[SimpleNamespace(group=0)] * 8, laws=[SimpleNamespace(friction=friction)])
    state = SimpleNamespace(now=SimpleNamespace(lenience=3.0), mode=mode)
    work = SimpleNamespace(force=np.array([2.0, 99.0, 5.0, -99.0, 1.0, 99.0]))
    options, rest = SimpleNamespace(force_zero=1e-10), SimpleNamespace(ids=ids)
    asked = in_python(released_contacts._weakest, press_left=press_left, grip_left=grip_left)
    found, row, pulls = asked(model, state, len(press), options, work, rest)
    return bool(found), int(row), bool(pulls)


@BOTH_SIDES
def test_forces_that_small_of_the_largest_of_the_island_have_no_sign(share: float) -> None:
    """They are let go: less than a hundred trillionth of it is left."""
    left = share * 1e-14 * 5.0
    assert weakest([1.0, 1.0, left], [1.0] * 3, [FORWARD] * 3) == ((True, 2, True) if share < 1.0 else (False, 0, False))


def test_the_contact_furthest_from_holding_is_let_go_or_slides() -> None:
    stuck = [STICK] * 3
    assert weakest([-0.1, -0.3, -0.2], [1.0] * 3, stuck) == (True, 1, True)
    assert weakest([1.0, -0.3, 1.0], [1.0, 1.0, -0.4], stuck) == (True, 2, False)
    assert weakest([1.0, -0.3, 1.0], [1.0, 1.0, -0.2], stuck) == (True, 1, True)
    assert weakest([1.0, 1.0, 1.0], [1.0, -0.4, 1.0], [STICK, FORWARD, STICK]) == (False, 0, False)
    assert weakest([1.0, 1.0, 1.0], [1.0, -0.4, 1.0], stuck, friction=0.0) == (False, 0, False)
    assert weakest([1.0] * 3, [0.2, 0.0, 0.1], stuck) == (True, 1, False)


def room(
    curvature: tuple[float, float], *, swapped: bool = False, radius: tuple[float, float] = (0.0, 0.0)
) -> tuple[float, float]:
    """How much room two contacts have to differ whose points are (3, 4) µm apart and whose normals are 1e-6 apart."""
    primitives = [SimpleNamespace(body=b, radius=r) for b, r in ((0, radius[0]), (1, 9.0), (0, radius[1]), (1, 9.0))]
    contacts = [SimpleNamespace(a=0, b=1, curvature=curvature[0]), SimpleNamespace(a=2, b=3, curvature=curvature[1])]
    if swapped:
        primitives[2].body, primitives[3].body = 1, 0
    turn = -1.0 if swapped else 1.0
    normals = [SimpleNamespace(nx=0.6, ny=0.8), SimpleNamespace(nx=turn * (0.6 - 0.8e-6), ny=turn * (0.8 + 0.6e-6))]
    points = [(0.5, -0.2), (0.5 + 3e-6, -0.2 - 4e-6)]
    instead = {"normal_gap": lambda model, k, pose: normals[k], "contact_point": lambda model, k, pose: points[k]}
    model = SimpleNamespace(contacts=contacts, primitives=primitives)
    found = in_python(handover.room_to_differ, **instead)(model, 0, 1, SimpleNamespace(extent=EXTENT), None)
    return float(found[0]), float(found[1])


@pytest.mark.parametrize("swapped", [False, True])
def test_contact_points_and_normals_are_one_within_these_bounds(swapped: bool) -> None:
    """1e-5 rad and what the sharper curve turns in four extents; a hundred extents and what that turns. Both have limits."""
    assert room((0.0, 0.0), swapped=swapped) == pytest.approx((100 * EXTENT - 5e-6, 1e-5 - 1e-6), rel=1e-6)
    assert room((-30.0, 20.0), swapped=swapped)[1] == pytest.approx(1e-5 + 4 * EXTENT * 30.0 - 1e-6, rel=1e-6)
    assert room((20.0, -30.0), swapped=swapped)[1] == pytest.approx(1e-5 + 4 * EXTENT * 30.0 - 1e-6, rel=1e-6)
    assert room((1e4, 0.0), swapped=swapped)[1] == pytest.approx(1e-2 - 1e-6, rel=1e-6)
    assert room((0.0, 0.0), radius=(0.4, 0.7))[0] == pytest.approx(100 * EXTENT + 0.7e-5 - 5e-6, rel=1e-6)
    assert room((0.0, 0.0), radius=(0.7, 0.4))[0] == pytest.approx(100 * EXTENT + 0.7e-5 - 5e-6, rel=1e-6)
    assert room((1e4, 0.0), radius=(4.0, 0.1))[0] == pytest.approx(1e4 * EXTENT - 5e-6, rel=1e-6)
