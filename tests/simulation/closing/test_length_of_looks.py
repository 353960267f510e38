"""How long is it until the next look at a gap beside its primitives, or one that hardly moves?"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scripted_gaps import END, OPTIONS, RADIUS, START, Search

from watchsim.model.records import ARC, LINE

BESIDE = {LINE: 1e-2, ARC: 0.1}  # m


def beside_still(kind: int, still: Callable[[float], float]) -> tuple[list[float], list[tuple[float, float]]]:
    """(times of the looks, (room, time left) asked for) at a gap that stands still, beside its primitives."""
    asked: list[tuple[float, float]] = []

    def time_still(model, state, k, room, left, tau, step, path) -> float:
        asked.append((room, left))
        return still(left)

    search = Search(Polynomial([0.0]), (None, lambda t: -BESIDE[kind]), kind=kind, time_still=time_still)
    search.next_stretch = lambda model, options, k, left, step, path: (left, 2.0, 0.0, 50.0)  # type: ignore[method-assign]
    assert search.found() == (END, False)
    return search.looks, asked


@pytest.mark.parametrize("kind", [LINE, ARC])
def test_where_bounds_make_short_looks_beside_a_primitive_its_place_is_asked_how_long_it_stands(kind: int) -> None:
    """With the room that there is to a line's end, or that of a gap's rounding."""
    looks, asked = beside_still(kind, lambda left: 0.7 if left < 1.5 else 0.9)
    assert looks == pytest.approx([0.5, 1.4, 2.1])
    room = BESIDE[kind] - OPTIONS.extent if kind == LINE else OPTIONS.gap_zero
    assert asked == [(pytest.approx(room), pytest.approx(END - t)) for t in looks]
    short, _ = beside_still(kind, lambda left: 0.0)
    wait = (BESIDE[kind] - OPTIONS.extent) / (2.0 if kind == LINE else 50.0 * RADIUS)
    assert np.diff(short) == pytest.approx(wait)


@pytest.mark.parametrize(("share", "asked"), [(0.99, True), (1.01, False)])
def test_a_finer_bound_is_asked_for_where_a_look_is_shorter_than_a_64th_of_what_is_left(share: float, asked: bool) -> None:
    """Unless the gap falls so fast that it would not help."""
    for helps in (True, False):
        rooms: list[Any] = []

        def time_apart(model, state, k, room, left, tau, step, path, rooms=rooms) -> float:
            rooms.append((room, left))
            return 0.75

        room = 0.1
        speed = room / (share * (END - START) / 64.0)
        given = {"may_last": lambda room, rate, safe, helps=helps: helps, "time_apart": time_apart}
        search = Search(Polynomial([room]), **given)
        search.next_stretch = lambda m, o, k, left, s, p, speed=speed: (left, speed, 1e9, 0.0)  # type: ignore[method-assign]
        search.found()
        assert search.looks[1] == pytest.approx(1.25 if asked and helps else START + room / speed)
        assert rooms[:1] == ([(room, END - START)] if asked and helps else [])


def test_a_look_beside_a_primitive_is_no_shorter_than_a_gap_takes_to_pass_through_its_rounding() -> None:
    """However little it lies beside: here by a millionth of what counts as touching."""
    beside = iter([-OPTIONS.extent * (1.0 + 1e-6)])
    search = Search(Polynomial([0.0]), (None, lambda t: next(beside, 1.0)))
    search.next_stretch = lambda model, options, k, left, step, path: (left, 2.0, 0.0, 50.0)  # type: ignore[method-assign]
    assert search.found() == (END, False)
    assert search.looks[1] - START == pytest.approx(OPTIONS.gap_zero / 2.0, rel=0.01, abs=0.0)


@pytest.mark.parametrize("start", [8.0, 0.015625])
def test_no_look_is_shorter_than_the_rounding_of_time(start: float) -> None:
    beside = iter([-OPTIONS.extent * (1.0 + 1e-9)])
    search = Search(Polynomial([0.0]), (None, lambda t: next(beside, 1.0)))
    search.next_stretch = lambda model, options, k, left, step, path: (left, 1e5, 0.0, 50.0)  # type: ignore[method-assign]
    assert search.found(start, start + 1.0) == (start + 1.0, False)
    assert search.looks[1] == start + 4e-16 * start
