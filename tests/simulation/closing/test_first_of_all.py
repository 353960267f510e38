"""Is the first closing of all contacts found, whatever cells the way leads through, and is nothing looked at beyond it?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.first_closing import time_of_impact
from watchsim.simulation.loop_state.state import NO_CONTACT

PAIRS, CONTACTS = 3, 4  # of each pair
CELL = 0.7  # s that a pair stays in a cell
END = 2.0


def first_touch(closing: dict[int, float], **given: Any) -> tuple[tuple[bool, float, int], dict[str, Any]]:
    """((known, time, contact), what was done), where contact k closes at closing[k]; 0.3 s are searched in a turn of looks.

    It is certain to stay open for nine tenths of the time, or for as much as `certain` says.
    """
    done: dict[str, Any] = {"searched": [], "listed": [], "asked": []}
    unknown, at_rest, certain = given.get("unknown", ()), given.get("at_rest", ()), given.get("certain", {})

    def list_pair(model, cells, state, options, p, span, count, step, path):
        done["listed"].append((p, span))
        if (p, len([q for q, _ in done["listed"] if q == p])) in unknown:
            return False, count
        tau, until = span[0], min(span[1], span[0] + CELL)
        for k in range(p * CONTACTS, (p + 1) * CONTACTS):
            stays = max(tau, certain.get(k, 0.9) * closing.get(k, math.inf))
            if stays < until:
                count = put(path.waiting, count, k, p, (tau, until, stays))
        if until < span[1]:
            count = put(path.waiting, count, NO_CONTACT, p, (until, until, until))
        return True, count

    def crossing(model, state, options, k, start, end, step, path):
        done["searched"].append((k, start, end))
        time = min(end, start + 0.3)
        return (closing[k], True) if start <= closing[k] < time else (time, False)

    put = in_python(time_of_impact.put)
    waiting = [SimpleNamespace(contact=-9, pair=-9, start=0.0, until=0.0, stays_open=0.0) for _ in range(60)]
    scratch = SimpleNamespace(step=None, path=SimpleNamespace(waiting=waiting, q="q"), asked="room")
    instead = {
        "_list": list_pair,
        "crossing": crossing,
        "is_at_rest": lambda model, state, b: b in at_rest,
        "ask": lambda asked, p, q: done["asked"].append((asked, p, q)),
    }
    model = SimpleNamespace(pairs=[SimpleNamespace(a=p, b=p + 1) for p in range(PAIRS)])
    found = in_python(time_of_impact.first_touch, **instead)(model, None, None, None, given.get("end", END), scratch)
    return found, done


@pytest.mark.parametrize("seed", range(20))
def test_the_first_of_all_closings_is_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    closing = {int(k): float(t) for k, t in zip(rng.permutation(12)[:5], rng.uniform(0.1, 3.5, 5), strict=True)}
    certain = {k: float(rng.uniform(0.1, 0.95)) for k in closing}
    (known, time, contact), done = first_touch(closing, certain=certain)
    first = min(closing, key=closing.__getitem__)
    if closing[first] < END:
        assert (known, time, contact) == (True, closing[first], first)
    else:
        assert (known, time, contact) == (True, END, NO_CONTACT)
    begun = [certain[k] * closing[k] for k, _, _ in done["searched"]]
    assert all(start < time for start in begun)  # what is sure to stay open longer is not looked at
    assert all(
        start < end <= min(END, CELL * (1 + math.floor(start / CELL + 1e-9)) + 1e-9) for _, start, end in done["searched"]
    )
    for p in range(PAIRS):
        spans = [span for pair, span in done["listed"] if pair == p]
        assert spans[0] == (0.0, END)
        assert [start for start, _ in spans] == pytest.approx([CELL * i for i in range(len(spans))])
        assert len(spans) == math.ceil(time / CELL) and all(start < stop <= END for start, stop in spans)


def test_without_contacts_the_step_is_free() -> None:
    assert first_touch({})[0] == (True, END, NO_CONTACT)


@pytest.mark.parametrize(("at_rest", "listed"), [((), [0, 1, 2]), ((0, 1), [1, 2]), ((1, 2, 3), [0]), ((0, 2), [0, 1, 2])])
def test_pairs_of_which_both_bodies_rest_are_left_out(at_rest: tuple[int, ...], listed: list[int]) -> None:
    assert [p for p, _ in first_touch({}, at_rest=at_rest, end=0.5)[1]["listed"]] == listed


@pytest.mark.parametrize("unknown", [((1, 1),), ((2, 2),)])
def test_an_unknown_cell_ends_the_search_and_is_asked_about(unknown: tuple[tuple[int, int], ...]) -> None:
    found, done = first_touch({3: 1.8}, unknown=unknown)
    assert found == (False, 0.0, NO_CONTACT)
    assert done["asked"] == [("room", unknown[0][0], "q")]


def test_cells_beyond_the_first_closing_are_not_looked_up() -> None:
    found, done = first_touch({3: 0.6}, unknown=((2, 2),))
    assert found == (True, 0.6, 3) and done["asked"] == []


def test_the_last_one_that_waits_is_searched_too() -> None:
    assert first_touch({3: 0.4}, end=0.5)[0] == (True, 0.4, 3)
