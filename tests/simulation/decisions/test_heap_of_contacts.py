"""Is the first of the waiting contacts always the one that may close first? Against sorting."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.first_closing.waiting_contacts import drop_first, put


@pytest.mark.parametrize("seed", range(20))
def test_entries_come_out_in_order_however_they_are_put_in(seed: int) -> None:
    rng = np.random.default_rng(seed)
    add, drop = in_python(put), in_python(drop_first)
    heap = [SimpleNamespace(contact=-1, pair=-1, start=0.0, until=0.0, stays_open=0.0) for _ in range(40)]
    count, inside = 0, []
    for number in range(150):
        if count < len(heap) and (not inside or rng.random() < 0.6):
            entry = (float(rng.integers(0, 12)), number, 1000 - number, float(rng.random()), float(rng.random()))
            count = add(heap, count, entry[1], entry[2], (entry[3], entry[4], entry[0]))
            inside.append(entry)
        else:
            first = heap[0]
            found = (first.stays_open, first.contact, first.pair, first.start, first.until)
            assert found[0] == min(inside)[0] and found in inside
            inside.remove(found)
            count = drop(heap, count)
        assert count == len(inside)
