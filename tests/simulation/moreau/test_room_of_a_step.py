"""Is there room for all that a fixed step needs?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from plain_kernels import in_python

from watchsim.model.records import COORDINATE, records
from watchsim.simulation.moreau import step_work, steps


def test_there_is_room_for_all_contacts_and_for_the_bearings_with_dry_friction() -> None:
    coordinates = records(COORDINATE, 5)
    coordinates.coulomb[:] = [0.0, 0.3, 0.0, 1e-9, 0.0]
    model: Any = SimpleNamespace(coordinates=coordinates, contacts=[None] * 9, bodies=[None] * 4, joints=[None] * 3)
    work = in_python(step_work.moreau_work, room_for=lambda model: 7)(model)
    assert work.dry.tolist() == [1, 3]
    rows = 2 * 7 + 2
    for name in ("q", "u", "free", "force", "damping", "line", "mass", "inverse", "change", "foreseen", "start", "wound"):
        assert getattr(work, name).shape == (5,)
    assert work.rates.shape == work.more.shape == work.laws.P.shape == work.laws.order.shape == (rows,)
    assert work.laws.G.shape == work.laws.J.shape == (rows, rows)
    assert work.laws.low.shape == work.restitution.shape == work.closed.ids.shape == (7,) and work.laws.ends.shape == (9, 4)
    assert work.memory.shape == (9, 2) and work.joint.shape == (3,) and len(work.pose) == 4


def test_no_part_of_the_room_is_forgotten_when_it_is_passed_by_reference() -> None:
    work = step_work.MoreauWork(*[(name,) for name in step_work.MoreauWork._fields])
    instead = {name: lambda *parts: parts for name in ("ClosedRef", "LawsRef", "AskedRef", "MoreauWorkRef")}
    assert in_python(steps._by_reference, **instead)(work) == tuple(work)
