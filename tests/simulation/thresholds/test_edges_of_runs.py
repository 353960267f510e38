"""Which tolerances may be asked for, how far may bodies go, and when has a contact left its primitives?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact import kinematics
from watchsim.contact.gaps import Shape
from watchsim.contact.index_sets import OPEN, STICK
from watchsim.simulation import advance
from watchsim.simulation.events import after_event, handover
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.motion import free_flight
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.simulate import _check
from watchsim.simulation.stops import Stop

EXTENT = 2e-9


@pytest.mark.parametrize(("tolerance", "may_be"), [(0.99e-13, False), (1e-13, True), (1e-2, True), (1.01e-2, False)])
def test_tolerances_lie_between_rounding_and_a_hundredth(tolerance: float, may_be: bool) -> None:
    if may_be:
        _check(1.0, tolerance, EVENT_DRIVEN, None)
        return
    with pytest.raises(ValueError, match=r"between 1e-13 and 0\.01"):
        _check(1.0, tolerance, EVENT_DRIVEN, None)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "stop"), [(0.99, Stop.RUNNING), (1.01, Stop.FAR_AWAY)])
def test_a_run_ends_ten_thousand_million_sizes_away(share: float, stop: Stop, sign: float) -> None:
    model = SimpleNamespace(coordinates=[SimpleNamespace(scale=9.0), SimpleNamespace(scale=0.25)])
    asked = in_python(advance.where_it_is)
    assert asked(model, np.array([0.0, sign * share * 0.25e10]), np.zeros(2)) == stop


def test_a_flight_goes_no_further_than_ten_thousand_sizes() -> None:
    """The way is v t + a t² / 2."""
    model = SimpleNamespace(coordinates=[SimpleNamespace(scale=0.25)])
    state = SimpleNamespace(u=[-3.0], q=[0.0], grip=[0])
    for bound in (5.0, 0.0):
        time = in_python(free_flight._time_far, acceleration_bound=lambda *_, bound=bound: bound)(model, state, 0)
        assert 3.0 * time + 0.5 * bound * time**2 == pytest.approx(2500.0)
    state.u[0] = 0.0
    assert in_python(free_flight._time_far, acceleration_bound=lambda *_: 0.0)(model, state, 0) == np.inf


def test_contacts_one_and_a_half_extents_beyond_their_primitives_have_left_them() -> None:
    margins = {4: -1.49 * EXTENT, 2: -1.51 * EXTENT, 7: 1.0}
    opened: list[int] = []
    mode = np.full(9, STICK)
    state = SimpleNamespace(
        active=np.array([4, 2, 7, 99]), mode=mode, now=SimpleNamespace(awake_contacts=2, sleeping_contacts=1)
    )
    instead = {
        "extent_margin": lambda model, k, pose: margins[k],
        "keep_event": lambda state, record, kind, k, body, value: opened.append(k),
    }
    options = SimpleNamespace(extent=EXTENT)
    asked = in_python(after_event._release, **instead)
    asked(None, state, options, None, None)
    assert opened == [2] and np.flatnonzero(mode == OPEN).tolist() == [2]
    assert state.active[:2].tolist() == [4, 7]
    left: list[int] = []

    def successor(model: object, cells: object, state: object, options: object, k: int, scratch: object) -> tuple[bool, int]:
        left.append(k)
        return False, 0

    state.active[:3], state.now.awake_contacts = [4, 7, 2], 2
    state.now.sleeping_contacts = 1
    scratch = SimpleNamespace(event=SimpleNamespace(pose=None))
    given: Any = in_python(handover.hand_over, extent_margin=instead["extent_margin"], _successor=successor)
    assert not given(None, None, state, options, scratch, None) and left == [2]


def test_spins_are_rounded_by_what_speeds_are() -> None:
    """A billionth of them over the arms, squared: nothing else is left where bodies travel flush."""
    a = SimpleNamespace(body=0, radius=0.0)
    contact = SimpleNamespace(a=0, b=1, curvature=0.0, reduced=0.0)
    names = ("x", "y", "vx", "vy", "w")
    poses = [
        SimpleNamespace(**dict(zip(names, row, strict=True)))
        for row in ((1.0, 2.0, 3.0, -4.0, 0.0), (0.5, 0.25, 3.0, -4.0, 0.0))
    ]
    out = SimpleNamespace(kin=[SimpleNamespace()], ids=[0], slots=[9])
    shape = Shape(0.0, 0.6, 0.8, 1.0, 0.0, -0.3, 0.2)
    instead = {
        "shape_of_contact": lambda *_: shape,
        "margins_of": lambda *_: (0.7, 0.4),
        "_directions": lambda *_: None,
    }
    bodies = [SimpleNamespace(carrier=-1)] * 2
    model = SimpleNamespace(contacts=[None, None, contact], primitives=[a, SimpleNamespace(body=1, radius=0.0)], bodies=bodies)
    in_python(kinematics.contact_kinematics, **instead)(model, 2, poses, 0, out)
    reach = 0.3 + 0.2 + abs(-0.3 + 0.5) + abs(0.2 + 1.75)
    assert out.kin[0].bar_size == pytest.approx((1e-9 * 14.0) ** 2 / reach, rel=1e-9, abs=0.0)
    assert out.kin[0].margin == 0.4


def test_rows_are_as_exact_as_half_the_tolerance_of_the_largest_place() -> None:
    run: Any = object.__new__(Trajectory)
    object.__setattr__(run, "q", np.array([[0.5, -3.0], [-2.0, 1.0]]))
    object.__setattr__(run, "tolerance", 1e-6)
    assert run._noise.tolist() == pytest.approx([1e-6, 1.5e-6], rel=1e-12)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("off", "left"), [(0.9e-13, False), (1.1e-13, True)])
def test_of_a_direction_across_an_axis_rounding_is_left(off: float, left: bool, sign: float) -> None:
    """By which no force may hold or move a body: as much as normals of outlines turn by it."""
    share = in_python(kinematics._share)((0.6, 0.8), (-0.8 + sign * 0.6 * off, 0.6 + sign * 0.8 * off))
    assert share == (pytest.approx(sign * off, rel=2e-3, abs=0.0) if left else 0.0)
