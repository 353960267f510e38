"""Which contacts and bearings have a bounded force of their own in the acceleration problem?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import acceleration, jamming

SLOWEST = 1e-5  # m/s


def test_contacts_that_may_stick_come_first_then_the_bearings() -> None:
    """However small their friction; the others have theirs against their slip."""
    friction = [1e-4, 0.3, 0.3, 0.0, 0.2]
    slips = [-0.9 * SLOWEST, 1.1 * SLOWEST, -1.1 * SLOWEST, 0.0, SLOWEST]
    laws = [SimpleNamespace(friction=mu) for mu in friction]
    coordinates = [SimpleNamespace(coulomb=c) for c in (9.0, 0.4, 9.0, 1e-6)]
    model = SimpleNamespace(laws=laws, contacts=[SimpleNamespace(group=4 - k) for k in range(5)], coordinates=coordinates)
    closed = SimpleNamespace(ids=[4, 3, 2, 1, 0], kin=[SimpleNamespace(gT_dot=slip) for slip in slips])
    work = SimpleNamespace(tangent=np.full(5, 77), drag=np.full(5, np.nan), dry=[3, 1], block=[9] * 5)
    work.width, work.span, work.shift = ([9.0] * 5 for _ in range(3))
    assert in_python(acceleration._elements)(model, closed, 5, 2, SLOWEST, work) == 4
    assert work.tangent.tolist() == [0, -1, -1, -1, 1] and work.drag.tolist() == [1e-4, 0.3, -0.3, 0.0, 0.2]
    assert work.block == [0, 4, 5, 6, 9]
    assert work.width == [2e-4, 0.4, 0.0, 0.0, 9.0]
    assert work.span == [0.0, 0.0, 2e-6, 0.8, 9.0] and work.shift == [0.0, 0.0, -1e-6, -0.4, 9.0]


@pytest.mark.parametrize("bearings", [0, 2])
def test_loads_are_accelerations_with_bearings_at_the_lower_ends_of_their_friction(bearings: int) -> None:
    """The elements of the bearings are the last ones."""
    rng = np.random.default_rng(bearings)
    m, elements, rows = 2, 1 + bearings, 4 + bearings
    G, b, shift = rng.normal(size=(7, 7)), rng.normal(size=7), rng.normal(size=4)
    work = SimpleNamespace(G=G, b=b, shift=shift, loaded=np.full(7, np.nan), size=np.full(7, np.nan))
    work.dry, work.h, work.inverse = [3, 1], np.array([9.0, -2.0, 9.0, 0.5]), np.array([9.0, 0.25, 9.0, 4.0])
    in_python(acceleration._free_bearings)(work, m, bearings)
    assert work.b[4:rows].tolist() == [2.0, -0.5][:bearings] and work.size[4:rows].tolist() == [2.0, 0.5][:bearings]
    in_python(acceleration._load)(work, m, elements, bearings)
    expected = b[:rows] + G[:rows, 4:rows] @ shift[1 : 1 + bearings]
    assert work.loaded[:rows] == pytest.approx(expected) and np.isnan(work.loaded[rows:]).all()


@pytest.mark.parametrize("i", [0, 1, 2])
@pytest.mark.parametrize(("drag", "jams"), [(0.74, False), (0.76, True)])
def test_any_contact_may_jam_by_itself(i: int, drag: float, jams: bool) -> None:
    """G_N = 3, G_NT = 4; another contact that has a say on it prevents that."""
    G = np.diag([3.0, 5.0] * 3)
    G[2 * i, 2 * i + 1] = G[2 * i + 1, 2 * i] = 4.0
    work = SimpleNamespace(G=G, drag=np.array([0.1, 0.2, 0.3]), tangent=[-1] * 3)
    work.drag[i] = drag
    asked = in_python(jamming.is_paradox)
    assert bool(asked(work, 3, i)) == jams
    other = 2 * ((i + 1) % 3)
    for place in ((2 * i, other), (2 * i, other + 1), (2 * i + 1, other)):
        G[place] = 1e-6
        assert not asked(work, 3, i)
        G[place] = 0.0
