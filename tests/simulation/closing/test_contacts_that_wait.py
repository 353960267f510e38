"""Which contacts of a cell wait to be looked at, and from when on?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest
from plain_kernels import in_python

from watchsim.candidates.cell_lookup import LISTED, UNKNOWN
from watchsim.contact.index_sets import OPEN, STICK
from watchsim.simulation.first_closing import time_of_impact
from watchsim.simulation.loop_state.state import NO_CONTACT

ALL = 7  # of `how`: no cells
Asked = tuple[float, ...]  # room, approach, closing, bend, distance


def stays(gap: float, rate: float = -0.3, *, body: int = 5, sunk: float = 0.0, safe: float = 9.0) -> tuple[float, Asked | None]:
    """How long a contact certainly stays open of a second, and what `safe_time` was asked, which says `safe`.

    Bounds say 2 m/s, 5 m/s² and 0.4 m between centres. The circle is on `body`.
    """
    asked: list[Any] = []
    questions: list[Asked] = []

    def safe_time(*given: float) -> float:
        questions.append(given)
        return safe

    def bounds_of(model, k, length, one, other, path):
        asked.append((length, one, other))
        return 2.0, 5.0, 99.0

    instead = {
        "normal_gap": lambda model, k, pose: SimpleNamespace(gap=gap, rate=rate),
        "sunk_level": lambda model, options, k, gap, inside, path: sunk if inside == 0.0 else 9.0,
        "gap_bounds": bounds_of,
        "centre_distance": lambda *_: 0.4,
        "safe_time": safe_time,
    }
    state = SimpleNamespace(counts=SimpleNamespace(gap_evaluations=3))
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0)], primitives=[SimpleNamespace(body=body)])
    options = SimpleNamespace(behind=1e-8, gap_zero=1e-13)
    path = SimpleNamespace(pose=None)
    found = in_python(time_of_impact._stays_open_for, **instead)(model, state, options, 0, 1.0, 5, ("first", "other"), path)
    assert state.counts.gap_evaluations == 4
    assert asked in ([], [(1.0, "first", "other") if body == 5 else (1.0, "other", "first")])
    return found, questions[0] if questions else None


@pytest.mark.parametrize("body", [5, 6])
def test_a_contact_stays_open_as_long_as_its_bounds_say(body: int) -> None:
    """Whichever of the two bodies the circle is on; what is behind must come out first."""
    for sign in (1.0, -1.0):
        assert stays(2.01 * sign, body=body) == (math.inf, None)
        assert stays(1e-4 * sign, body=body, safe=0.9)[1] == (1e-4, 0.3 * sign, 2.0, 5.0, 0.4)
        asked = (1.99, 0.3 * sign, 2.0, 5.0, 0.4)
        assert stays(1.99 * sign, body=body, safe=0.9) == (0.9, asked)
        assert stays(1.99 * sign, body=body, safe=1.0) == (math.inf, asked)


@pytest.mark.parametrize(
    ("gap", "sunk", "at_once"),
    [
        (0.9e-13, 0, True),
        (1.1e-13, 0, False),
        (-0.9e-8, 0, True),
        (-1.1e-8, 0, False),
        (-1.1e-8, -1e-6, True),
        (0.3, -1e-6, True),
    ],
)
def test_what_touches_or_has_sunk_in_is_looked_at_at_once(gap: float, sunk: float, at_once: bool) -> None:
    assert stays(gap, sunk=sunk, safe=0.25)[0] == (0.0 if at_once else 0.25)


def listed(how: int = LISTED, end: float = 2.0, **given: Any) -> tuple[bool, int, list[Any], int]:
    """(known, number waiting, what was put there, cells looked up) of a pair that stays 0.7 s in a cell from 0.5 s on."""
    put: list[Any] = []

    def put_in(waiting, count, k, p, times):
        put.append((k, p, times))
        return count + 1

    def bounds(model, b, length, step, path):
        return b, round(length, 12)

    def stays_open(model, state, options, k, length, first, both, path):
        assert first == 3 and both == ((3, round(length, 12)), (4, round(length, 12)))
        return given.get("stays", {}).get(k, 0.1)

    instead = {
        "_place": lambda model, state, bodies, tau, step, path: given.setdefault("placed", (bodies, tau)),
        "time_in_cell": lambda model, p, q, u, bound: 0.7,
        "candidates": lambda model, cells, p, q: (how, 20, 4),
        "candidate": lambda model, cells, how, place: place + 100,
        "body_bounds": bounds,
        "_stays_open_for": stays_open,
        "is_beside_active": lambda model, state, k: k in given.get("beside", ()),
        "put": put_in,
    }
    mode = [STICK if k in given.get("closed", ()) else OPEN for k in range(130)]
    state = SimpleNamespace(mode=mode, counts=SimpleNamespace(cells_looked_up=5))
    model = SimpleNamespace(pairs=[None, SimpleNamespace(a=3, b=4)])
    path = SimpleNamespace(waiting=None, q=None, u=None)
    asked = in_python(time_of_impact._list, **instead)
    known, count = asked(model, None, state, None, 1, (0.5, end), 6, SimpleNamespace(bound=None), path)
    assert given["placed"] == ((3, 4), 0.5)
    return known, count, put, state.counts.cells_looked_up


def test_contacts_of_a_cell_wait_and_with_them_the_next_cell() -> None:
    known, count, put, looked_up = listed()
    until = pytest.approx(1.2)
    contacts = [(k, 1, (0.5, until, pytest.approx(0.6))) for k in (120, 121, 122, 123)]
    assert known and count == 11 and looked_up == 6
    assert put == [*contacts, (NO_CONTACT, 1, (until, until, until))]


@pytest.mark.parametrize(("end", "cells"), [(1.1, 0), (1.3, 1)])
def test_no_cell_beyond_the_end_waits(end: float, cells: int) -> None:
    _, _, put, _ = listed(end=end)
    assert len(put) == 4 + cells and put[0][2][1] == pytest.approx(min(end, 1.2))


def test_what_is_closed_or_beside_what_is_or_stays_open_does_not_wait() -> None:
    _, count, put, looked_up = listed(ALL, closed=(120,), beside=(122,), stays={121: 0.71, 123: 0.69})
    assert [k for k, _, _ in put] == [123, NO_CONTACT] and count == 8 and looked_up == 5


def test_of_an_unknown_cell_nothing_waits() -> None:
    known, count, put, _ = listed(UNKNOWN)
    assert (known, count, put) == (False, 6, [])
