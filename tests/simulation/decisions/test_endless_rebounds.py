"""When does a contact count as one that rebounds without end? Against rows of hits whose times are known."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.events.shrinking_play import end_endless

ENDLESS_REBOUNDS = 1000  # within one accumulation time of each other
LONGEST = 1e-6  # s, between hits
CONTACT = 3


class Hits:
    """A contact that is hit again and again, and another one beside it."""

    def __init__(self) -> None:
        self.state = SimpleNamespace(
            returning=SimpleNamespace(contact=-1, last=0.0, hits=0, away=0.0, rate=0.0), clock=SimpleNamespace(time=1.0)
        )
        self.kernel = in_python(end_endless)

    def hit(self, wait: float, rate: float = -1.0, contact: int = CONTACT, restitution: float = 0.5) -> bool:
        """Is the restitution of the one that is hit after that time taken away, and only that?"""
        self.state.clock.time += wait
        kin = [SimpleNamespace(gN_dot=0.0), SimpleNamespace(gN_dot=rate)]
        event = SimpleNamespace(closed=SimpleNamespace(kin=kin, ids=[9, contact]), zero=[1e-9, 1e-9])
        room = SimpleNamespace(restitution=np.array([0.7, restitution]))
        found = self.kernel(self.state, 2, SimpleNamespace(accumulation_time=LONGEST), event, room)
        assert room.restitution.tolist() == [0.7, 0.0 if found else restitution]
        return bool(found)

    def row(self, waits: np.ndarray, **how: float) -> list[bool]:
        return [self.hit(float(wait), **how) for wait in waits]


def closing(share: float, count: int) -> np.ndarray:
    """Waits that shrink evenly from 2^-20 s to that share of it, in binary numbers so that their sums are exact."""
    return 2.0**-20 * np.linspace(1.0, share, count)


def begun() -> Hits:
    hits = Hits()
    assert not hits.hit(1.0)  # nothing is known of it before
    return hits


def test_a_play_that_has_closed_to_half_of_it_ends_after_so_many_hits() -> None:
    found = begun().row(closing(0.4, ENDLESS_REBOUNDS + 5))
    assert found == [False] * ENDLESS_REBOUNDS + [True] * 5


@pytest.mark.parametrize("share", [0.51, 1.0])
def test_a_play_that_stays_goes_on(share: float) -> None:
    assert not any(begun().row(closing(share, ENDLESS_REBOUNDS + 50)))


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("rate", [-1.0, -0.02, -30.0])
def test_hits_that_change_their_rate_by_a_tenth_begin_anew(rate: float, way: float) -> None:
    hits = begun()
    waits = closing(0.4, ENDLESS_REBOUNDS + 50)
    assert not any(hits.row(waits[:500], rate=rate)) and not any(hits.row(waits[500:], rate=rate * (1.0 + 0.11 * way)))
    hits = begun()
    assert not any(hits.row(waits[:500], rate=rate)) and any(hits.row(waits[500:], rate=rate * (1.0 + 0.09 * way)))


def test_a_long_wait_begins_anew() -> None:
    hits, waits = begun(), closing(0.4, ENDLESS_REBOUNDS + 50)
    assert not any(hits.row(waits[:500])) and not hits.hit(1.01 * LONGEST) and not any(hits.row(waits[500:]))


def test_another_contact_between_changes_nothing_unless_it_comes_late() -> None:
    hits, waits = begun(), closing(0.4, ENDLESS_REBOUNDS + 50)
    assert not any(hits.row(waits[:500]))
    assert not hits.hit(2.0**-22, contact=7)
    assert any(hits.row(waits[500:]))
    hits = begun()
    assert not any(hits.row(waits[:500])) and not hits.hit(1.01 * LONGEST, contact=7)
    assert hits.state.returning.contact == 7 and hits.state.returning.hits == 0


def test_what_is_hit_twice_at_once_or_leaves_or_does_not_rebound_does_not_count() -> None:
    hits = begun()
    hits.hit(2.0**-20)
    before = vars(hits.state.returning).copy()
    assert not hits.hit(0.0) and not hits.hit(2.0**-21, rate=-0.9e-9) and not hits.hit(2.0**-21, restitution=0.0)
    assert vars(hits.state.returning) == before
