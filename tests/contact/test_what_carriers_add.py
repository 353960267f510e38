"""What do the carriers of two bodies add to a contact? Accelerations of both origins, entries of both coordinates, by hand."""

from __future__ import annotations

import cmath
from types import SimpleNamespace

import pytest
from plain_kernels import in_python

from watchsim.contact import kinematics
from watchsim.model.records import PIVOT

_add_carriers = in_python(kinematics._add_carriers)
ARMS, PULLS = (0.4 - 0.9j, -1.1 + 0.3j), (2.3 + 0.7j, -0.6 + 1.9j)  # from the carriers' origins; accelerations of the bodies'


@pytest.mark.parametrize("carried", [(True, True), (True, False), (False, True)])
def test_each_side_adds_its_own(carried: tuple[bool, bool]) -> None:
    """The first carrier is the first body of all; the second side counts against the first."""
    n, closed = cmath.rect(1.0, 0.7), kinematics.closed_contacts(2)
    carriers = [SimpleNamespace(motion=PIVOT, first=5 + k, carrier=-1, ratio=1.0) for k in range(2)]
    bodies = [SimpleNamespace(motion=PIVOT, first=k, carrier=k if on else -1, ratio=1.0) for k, on in enumerate(carried)]
    still = SimpleNamespace(rx=9.0, ry=8.0, ax=7.0, ay=6.0)
    own = [SimpleNamespace(rx=r.real, ry=r.imag, ax=a.real, ay=a.imag) for r, a in zip(ARMS, PULLS, strict=True)]
    closed.kin[1].bar_N, closed.kin[1].bar_T = 0.31, -0.27
    model = SimpleNamespace(bodies=[*carriers, *bodies])
    _add_carriers(model, 2, 3, 1, (n.real, n.imag), [still, still, *own], closed)
    bar, entries = 0.31 - 0.27j, []
    for k, sign in ((0, 1.0), (1, -1.0)):
        if carried[k]:
            bar += sign * PULLS[k] / n
            entries.append((5 + k, sign * 1j * ARMS[k] / n))
    assert complex(closed.kin[1].bar_N, closed.kin[1].bar_T) == pytest.approx(bar, rel=1e-13, abs=0.0)
    assert closed.slots.tolist() == [0, len(entries)]
    for j, (coordinate, felt) in enumerate(entries):
        assert closed.coord[1, j] == coordinate
        assert complex(closed.w_N[1, j], closed.w_T[1, j]) == pytest.approx(felt, rel=1e-13, abs=0.0)
