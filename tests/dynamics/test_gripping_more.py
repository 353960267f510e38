"""Which jammed contacts grip a little more in an impact, and by how much?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import impact
from watchsim.tolerances import PAINLEVE

OWN, BOTH = 3.0, 4.0  # G_N and G_NT: the bound of friction is 0.75
BOUND = OWN / BOTH


def gripped(share: float, jam: float = 1e-9, tangent: int = 1) -> tuple[float, float]:
    """Friction and width of its interval of the second of two contacts whose friction is `share` of the bound."""
    G = np.zeros((4, 4))
    G[0, 0], G[2, 2], G[2, 3] = 1.0, OWN, BOTH
    drag = np.array([0.5, share * BOUND])
    work = SimpleNamespace(G=G, drag=drag, tangent=[0, tangent], width=2.0 * drag)
    in_python(impact._grip_more)(2, jam, work)
    assert (work.drag[0], work.width[0]) == (0.5, 1.0)  # the first is far from jamming
    return float(work.drag[1]), float(work.width[1])


@pytest.mark.parametrize("off", [-0.9, -0.3, 0.0, 0.3, 0.9])
def test_near_the_bound_friction_is_taken_past_it(off: float) -> None:
    """By `PAINLEVE` of it, from either side: a normal force then pulls the bodies together."""
    drag, width = gripped(1.0 + off * PAINLEVE)
    assert OWN - drag * BOTH == pytest.approx(-PAINLEVE * OWN, rel=1e-6)
    assert width == 2.0 * drag


@pytest.mark.parametrize("share", [0.5, 1.0 - 1.1 * PAINLEVE, 1.0 + 1.1 * PAINLEVE, 1.5, 4.0])
def test_friction_short_of_the_bound_or_past_it_stays_what_it_is(share: float) -> None:
    assert gripped(share) == (share * BOUND, 2.0 * share * BOUND)


def test_where_something_approaches_or_without_friction_nothing_grips_more() -> None:
    assert gripped(1.0, jam=0.0) == gripped(1.0, tangent=-1) == (BOUND, 2.0 * BOUND)
