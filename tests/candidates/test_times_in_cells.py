"""For how long does what was looked up stay complete, and when are bodies so far apart that nothing need be?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python
from scipy.optimize import brentq

from watchsim.candidates import cell_lookup
from watchsim.candidates.cell_lookup import ALL, LISTED, UNKNOWN, candidate, candidates, cell_key, find_slot
from watchsim.model.records import FIXED, FREE, NO_KEY, PIVOT, SLIDE

SIZES = (0.3, 0.07, 0.011)
Q = np.array([0.4, -1.3, 0.77, 2.2, -0.6])
U = np.array([3.0, -0.5, 0.04, -1.7, 0.9])
BOUND = np.array([0.8, 20.0, 0.3, 5.0, 2.5])
_to_leave, _room, _index, _in_cell, _through, _apart, _time_apart = (
    in_python(getattr(cell_lookup, name))
    for name in (*("_time_to_leave", "_room", "cell_index", "time_in_cell", "time_through_cells", "_is_apart", "_time_apart"),)
)


def pair(axes: int = 0, frame: int = -1, on: tuple[int, ...] = (-1, -1, -1), **more: Any) -> SimpleNamespace:
    """Cell coordinates are the second, first and fourth; lengths."""
    own = {f"{name}{i}": value for i in range(3) for name, value in (("c", (1, 0, 3)[i]), ("size", SIZES[i]), ("on", on[i]))}
    turns = dict.fromkeys(("wrap0", "wrap1", "wrap2"), 0)
    return SimpleNamespace(**({**own, **turns, "axes": axes, "frame": frame, "reach": 0.0, "a": 0, "b": 1} | more))


def model(one: SimpleNamespace, *bodies: SimpleNamespace) -> Any:
    return SimpleNamespace(pairs=[one], bodies=bodies)


def leaves(room: float, speed: float, bound: float) -> float:
    """When a motion that begins so fast and gains so much covers the room."""
    return float(brentq(lambda t: speed * t + 0.5 * bound * t * t - room, 0.0, 1e6, xtol=1e-15, rtol=1e-14))


@pytest.mark.parametrize(("room", "speed", "bound"), [(0.3, 2.0, 5.0), (1e-4, 0.0, 7.0), (2.5, 0.3, 0.0), (0.7, 4.0, 0.1)])
def test_the_soonest_that_a_room_is_left(room: float, speed: float, bound: float) -> None:
    assert _to_leave(room, speed, bound) == pytest.approx(leaves(room, speed, bound), rel=1e-9)


def test_what_stands_stays() -> None:
    assert _to_leave(0.3, 0.0, 0.0) == math.inf


@pytest.mark.parametrize("q", [0.31, 0.59, 0.449, -0.02, -2.05])
def test_a_cell_reaches_half_its_size_beyond_its_nearest_face(q: float) -> None:
    faces = 0.3 * np.arange(-20, 20)
    assert _room(q, 0.3) == pytest.approx(np.abs(faces - q).min() + 0.15, rel=1e-12)


@pytest.mark.parametrize(
    ("q", "wrap", "index"), [(0.29, 0, 0), (0.31, 0, 1), (-0.01, 0, -1), (-0.31, 7, 5), (2.11, 7, 0), (2.0, 7, 6), (2.0, 1, 0)]
)
def test_cells_are_counted_from_zero_and_within_a_turn(q: float, wrap: int, index: int) -> None:
    assert _index(q, 0.3, wrap) == index


COORDINATES = (1, 0, 3)


@pytest.mark.parametrize("axes", [1, 2, 3])
def test_the_first_coordinate_that_leaves_its_cell_ends_it(axes: int) -> None:
    """Each in turn is the fastest."""
    for fastest in range(axes):
        u = U.copy()
        u[COORDINATES[fastest]] *= 1e3
        times = [leaves(_room(Q[i], SIZES[k]), abs(u[i]), BOUND[i]) for k, i in enumerate(COORDINATES[:axes])]
        assert np.argmin(times) == fastest
        assert _in_cell(model(pair(axes)), 0, Q, u, BOUND) == pytest.approx(times[fastest], rel=1e-9, abs=0.0)


def test_without_cells_nothing_ends() -> None:
    assert _in_cell(model(pair(0)), 0, Q, U, BOUND) == _through(model(pair(0)), 0, Q, U, BOUND, 3.0) == math.inf


@pytest.mark.parametrize("on", [(4, -1), (-1, 4), (2, 4), (0, -1)])
@pytest.mark.parametrize("fastest", [0, 1])
def test_seen_from_a_carrier_differences_count(on: tuple[int, int], fastest: int) -> None:
    u = U.copy()
    u[COORDINATES[fastest]] *= 1e3
    times = []
    for k in range(2):
        i, other = COORDINATES[k], on[k]
        place, rate, bound = Q[i], u[i], BOUND[i]
        if other >= 0:
            place, rate, bound = place - Q[other], rate - u[other], bound + BOUND[other]
        times.append(leaves(_room(place, SIZES[k]), abs(rate), bound))
    assert np.argmin(times) == fastest
    assert _in_cell(model(pair(2, 0, (*on, -1))), 0, Q, u, BOUND) == pytest.approx(times[fastest], rel=1e-9, abs=0.0)
    assert _in_cell(model(pair(1, 0, (*on, -1))), 0, Q, u, BOUND) == pytest.approx(times[0], rel=1e-9, abs=0.0)


@pytest.mark.parametrize("axes", [1, 2, 3])
@pytest.mark.parametrize("frame", [-1, 0])
@pytest.mark.parametrize("on", [(4, 2, 4), (0, 4, 2)])
def test_the_time_through_some_cells(axes: int, frame: int, on: tuple[int, int, int]) -> None:
    """Along each coordinate as many; what is taken away counts only as seen from a carrier."""
    for fastest in range(axes):
        u, times = U.copy(), []
        u[COORDINATES[fastest]] *= 1e3
        for k, i in enumerate(COORDINATES[:axes]):
            rate, bound = (u[i], BOUND[i]) if frame < 0 else (u[i] - u[on[k]], BOUND[i] + BOUND[on[k]])
            times.append(leaves(2.5 * SIZES[k], abs(rate), bound))
        assert np.argmin(times) == fastest
        assert _through(model(pair(axes, frame, on)), 0, Q, u, BOUND, 2.5) == pytest.approx(times[fastest], rel=1e-9, abs=0.0)


def body(motion: int, first: int, ratio: float = 1.0, phase: float = 0.0) -> SimpleNamespace:
    return SimpleNamespace(motion=motion, first=first, x=0.2, y=-0.1, axis_x=0.6, axis_y=0.8, ratio=ratio, phase=phase)


BODIES = {  # where its origin is at Q, how fast it moves at U, and how fast it may gain speed
    "free": (body(FREE, 0), (0.4, -1.3), math.hypot(3.0, 0.5), math.hypot(0.8, 20.0)),
    "slide": (body(SLIDE, 3), (0.2 + 0.6 * 2.2, -0.1 + 0.8 * 2.2), 1.7, 5.0),
    "rack": (body(SLIDE, 3, -0.5, 0.3), (0.2 - 0.6 * 0.8, -0.1 - 0.8 * 0.8), 0.85, 2.5),
    "pivot": (body(PIVOT, 4), (0.2, -0.1), 0.0, 0.0),
    "fixed": (body(FIXED, -1), (0.2, -0.1), 0.0, 0.0),
}
MOVING = [("free", "slide"), ("slide", "free"), ("free", "fixed"), ("pivot", "rack"), ("rack", "free"), ("slide", "pivot")]


@pytest.mark.parametrize(("one", "other"), MOVING)
def test_bodies_are_apart_beyond_a_quarter_more_than_their_reach(one: str, other: str) -> None:
    """Then only the room between them counts, and how fast both their origins move."""
    (a, at, speed_a, bound_a), (b, there, speed_b, bound_b) = BODIES[one], BODIES[other]
    away = math.dist(at, there)
    near, far = pair(2, reach=away / 1.249), pair(2, reach=away / 1.251)
    assert not _apart(model(near, a, b), near, Q) and _apart(model(far, a, b), far, Q)
    assert not _apart(model(pair(2), a, b), pair(2), Q)  # of what has no reach nothing is known
    wanted = leaves(away - far.reach, speed_a + speed_b, bound_a + bound_b)
    assert _time_apart(model(far, a, b), far, Q, U, BOUND) == pytest.approx(wanted, rel=1e-9)
    assert _in_cell(model(far, a, b), 0, Q, U, BOUND) == pytest.approx(wanted, rel=1e-9)
    assert _through(model(far, a, b), 0, Q, U, BOUND, 1.0) == pytest.approx(wanted, rel=1e-9)
    assert _in_cell(model(near, a, b), 0, Q, U, BOUND) == _in_cell(model(pair(2)), 0, Q, U, BOUND)


def looked_up(one: SimpleNamespace, cells: Any, entries: tuple[str, str] = ("free", "slide")) -> tuple[int, int, int]:
    found: tuple[int, int, int] = in_python(candidates)(model(one, *(BODIES[name][0] for name in entries)), cells, 0, Q)
    return found


def test_what_is_looked_up() -> None:
    """All where no cells are listed or the indices go too far, nothing where bodies are apart, else what the cell holds."""
    assert UNKNOWN < 0 and LISTED != ALL and min(LISTED, ALL) >= 0
    range_of: dict[str, Any] = {"near_start": 5, "near_stop": 17}
    listed = pair(2, listed=1, **range_of)
    key = in_python(cell_key)(model(listed), 0, Q)
    cells = SimpleNamespace(keys=np.full(8, NO_KEY), start=np.zeros(8, int), count=np.zeros(8, int))
    assert looked_up(listed, cells) == (UNKNOWN, 0, 0)
    slot = in_python(find_slot)(cells.keys, key)
    cells.keys[slot], cells.start[slot], cells.count[slot] = key, 33, 4
    assert looked_up(listed, cells) == (LISTED, 33, 4)
    assert looked_up(pair(2, listed=0, **range_of), cells) == (ALL, 5, 12)
    assert looked_up(pair(2, listed=1, reach=1e-3, **range_of), cells) == (ALL, 0, 0)
    assert looked_up(pair(2, listed=1, size1=1e-6, **range_of), cells) == (ALL, 5, 12)


def test_a_place_of_a_list_is_a_contact() -> None:
    known: Any = SimpleNamespace(near=[40, 41, 42, 43])
    cells = SimpleNamespace(entries=[7, 8, 9, 10])
    assert [in_python(candidate)(known, cells, how, 2) for how in (LISTED, ALL)] == [9, 42]
