"""What are the modes and grips after an acceleration problem whose accelerations lie on either side of rounding?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics import acceleration
from watchsim.dynamics.problem_kinds import Level, Rung

ROUNDING = 1e-11  # of its terms
M, ELEMENTS, BEARINGS, ROWS = 3, 4, 2, 8  # contact 2 has element 1
NORMAL_TERMS, SLIP_TERMS = 7.0, 3.0
BOTH_SIDES = pytest.mark.parametrize("share", [0.9, 1.1])


def mode(gap: float = 0.0, slip: float = 0.0, **given: float) -> int:
    """Of contact 2, whose gap and slip accelerate so, with given entries of x, force, hand and tangent."""
    x = np.full(M + 2 * ELEMENTS, 0.5)
    x[2], x[M + 1], x[M + ELEMENTS + 1] = given.get("press", 1.0), given.get("above", 0.3), given.get("left", 0.0)
    force, G, hand = np.full(ROWS, np.nan), np.full((ROWS, ROWS), np.nan), np.ones(ROWS)
    force[4], force[5], G[5, 5], hand[5] = 2.0, -0.7, 1.5, given.get("hand", 1.0)
    tangent = [0, -1, 1 if given.get("may_stick", True) else -1]
    work = SimpleNamespace(x=x, force=force, G=G, hand=hand, tangent=tangent, drag=[9.0, 9.0, 0.4])
    kin = [SimpleNamespace(gT_dot=v) for v in (9.0, -9.0, given.get("rate", 0.0))]
    instead = {
        "_row_acceleration": lambda work, rows, row: {(ROWS, 4): gap, (ROWS, 5): slip}[rows, row],
        "row_terms": lambda work, m, rows, row: {(M, ROWS, 4): NORMAL_TERMS, (M, ROWS, 5): SLIP_TERMS}[m, rows, row],
        "is_paradox": lambda work, m, i: (m, i) == (M, 2) and bool(given.get("paradox", 0)),
    }
    return int(in_python(acceleration._mode_of, **instead)(SimpleNamespace(kin=kin), 2, M, ELEMENTS, BEARINGS, work))


@BOTH_SIDES
def test_it_opens_where_nothing_presses_and_its_gap_accelerates(share: float) -> None:
    """Beyond the rounding of the terms."""
    gap = share * ROUNDING * NORMAL_TERMS
    assert mode(gap, press=0.0) == (OPEN if share > 1.0 else STICK)
    assert mode(-gap, press=0.0) == STICK
    assert mode(gap, press=1e-9) == STICK
    assert mode(gap, press=0.0, may_stick=0, rate=-0.1) == (OPEN if share > 1.0 else BACKWARD)


def test_one_that_slides_goes_on_as_it_does_unless_it_jams_without_a_load() -> None:
    for rate, expected in ((-1e-6, BACKWARD), (1e-6, FORWARD), (0.0, FORWARD)):
        assert mode(rate=rate, may_stick=0) == expected
        assert mode(rate=rate, may_stick=0, press=0.0) == expected
        assert mode(rate=rate, may_stick=0, press=0.0, paradox=1) == OPEN
        assert mode(rate=rate, may_stick=0, press=0.2, paradox=1) == expected
    assert mode(press=0.0, paradox=1) == STICK


@BOTH_SIDES
@pytest.mark.parametrize("hand", [1.0, -1.0])
def test_it_begins_to_slip_the_way_it_accelerates(share: float, hand: float) -> None:
    """Beyond the rounding of its terms and of what its friction force makes; with friction at that end of the cone."""
    slip = share * ROUNDING * (SLIP_TERMS + 1.5 * (0.7 + 0.4 * 2.0))
    forward = STICK if share < 1.0 else FORWARD if hand > 0.0 else BACKWARD
    assert mode(slip=slip, hand=hand, above=0.0) == forward
    assert mode(slip=slip, hand=hand, above=1e-9) == STICK
    backward = STICK if share < 1.0 else BACKWARD if hand > 0.0 else FORWARD
    assert mode(slip=-slip, hand=hand, left=1e-9) == backward
    assert mode(slip=-slip, hand=hand, left=0.0) == STICK


@BOTH_SIDES
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_bearings_that_stood_move_where_they_accelerate(share: float, sign: float) -> None:
    """Beyond the rounding of their terms and of their friction; those that are held get no inverse mass."""
    dry, h, inverse = [4, 1], np.full(5, 10.0), np.full(5, 0.25)
    coordinates = [SimpleNamespace(coulomb=c) for c in (9.0, 3.0, 9.0, 9.0, 0.6)]
    grip = np.array([9, STICK, 9, 9, STICK], np.int8)
    limits = {6: ROUNDING * (2.0 + 0.25 * 0.6), 7: ROUNDING * (5.0 + 0.25 * 3.0)}
    instead = {
        "_row_acceleration": lambda work, rows, row: {6: sign * share, 7: 0.5}[row] * limits[row] if rows == ROWS else np.nan,
        "row_terms": lambda work, m, rows, row: {6: 2.0, 7: 5.0}[row] if (m, rows) == (M, ROWS) else np.nan,
    }
    work = SimpleNamespace(dry=dry, h=h, inverse=inverse)
    in_python(acceleration._decide_grips, **instead)(SimpleNamespace(coordinates=coordinates), M, 2, work, grip)
    way = 0 if share < 1.0 else FORWARD if sign > 0.0 else BACKWARD
    assert grip.tolist() == [9, STICK, 9, 9, way or STICK]
    assert h.tolist() == [10.0, 10.0, 10.0, 10.0, 10.0 - 0.6 * way]
    assert inverse.tolist() == [0.25, 0.0, 0.25, 0.25, 0.25 if way else 0.0]


def decided(rung: Rung, *, pressed: bool = False, paradox: tuple[int, ...] = (), x: tuple[float, ...] = (1.0, 1.0, 1.0)):
    """(is it solved?, what was done, the room) of a decision whose parts are made up; contacts 5, 0, 3 get modes 10, 0, 13."""
    done: list[tuple[object, ...]] = []
    ids = [5, 0, 3]

    def note(name: str):
        return lambda *given: done.append((name, *(one for one in given if isinstance(one, int))))

    work = SimpleNamespace(
        inverse=np.zeros(2), b="b", size="size", loaded="loaded", x=np.array([*x, 9.0, 9.0]), force=np.arange(1.0, 9.0)
    )
    names = ("fill_delassus", "fill_bearings", "gap_accelerations", "_fill_worth", "_free_bearings", "reverse_directions")
    names += (
        "fill_matrix",
        "_load",
        "fill_rhs",
        "note_posed",
        "keep_basis",
        "read_forces",
        "restore_directions",
        "_decide_grips",
    )
    instead = {name: note(name) for name in names} | {
        "inverse_mass": lambda coordinate: coordinate,
        "_elements": lambda *_: ELEMENTS,
        "press_unloaded": lambda *_: pressed,
        "solve_contacts": lambda work, m, elements: rung if (m, elements) == (M, ELEMENTS) else None,
        "is_paradox": lambda work, m, i: i in paradox,
        "_mode_of": lambda closed, i, m, elements, bearings, work: (10, OPEN, 13)[i],
    }
    mode = np.full(6, 77)
    closed, model = SimpleNamespace(ids=ids), SimpleNamespace(coordinates=[0.5, 0.25])
    asked = in_python(acceleration.decide_modes, **instead)
    solved = asked(model, closed, M, BEARINGS, 1e-3, work, None, mode)
    assert work.inverse.tolist() == [0.5, 0.25]
    return bool(solved), done, SimpleNamespace(mode=mode.tolist(), force=work.force.tolist())


def test_open_contacts_have_no_forces_and_the_others_keep_theirs() -> None:
    solved, done, room = decided(Rung.LEMKE)
    assert solved and room.mode == [OPEN, 77, 77, 13, 77, 10]
    assert room.force == [1.0, 2.0, 0.0, 0.0, 5.0, 6.0, 7.0, 8.0]
    assert done == [
        ("fill_delassus", M),
        ("fill_bearings", M, BEARINGS),
        ("gap_accelerations", M),
        ("_fill_worth", M),
        ("_free_bearings", M, BEARINGS),
        ("reverse_directions", M, ROWS, ELEMENTS),
        ("fill_matrix", M, ELEMENTS),
        ("_load", M, ELEMENTS, BEARINGS),
        ("fill_rhs", M, ELEMENTS),
        ("note_posed", M, ELEMENTS, BEARINGS, Level.ACCELERATION),
        ("read_forces", M, ELEMENTS),
        ("restore_directions", ROWS),
        ("_decide_grips", M, BEARINGS),
    ]


def test_what_was_pressed_by_next_to_nothing_is_solved_again_without() -> None:
    _, done, _ = decided(Rung.DETOUR, pressed=True)
    again = [one for one in done if one[0] in ("fill_rhs", "keep_basis")]
    assert again == [("fill_rhs", M, ELEMENTS)] * 2 + [("keep_basis", M, ELEMENTS, Rung.DETOUR)]


def test_without_a_solution_directions_are_restored_and_nothing_is_decided() -> None:
    solved, done, room = decided(Rung.FAILED, pressed=True)
    assert not solved and room.mode == [77] * 6 and done[-1] == ("restore_directions", ROWS)
    assert [one for one in done if one[0] in ("keep_basis", "read_forces", "_decide_grips")] == []


@pytest.mark.parametrize(("x", "solved"), [((1.0, 1.0, 1e-9), False), ((1.0, 1.0, 0.0), True), ((0.0, 0.0, 1.0), False)])
def test_a_pressed_contact_that_pulls_its_bodies_together_is_a_paradox(x: tuple[float, ...], solved: bool) -> None:
    found, done, room = decided(Rung.LEMKE, paradox=(2,), x=x)
    assert found == solved
    assert solved or (room.mode == [77] * 6 and done[-1] == ("restore_directions", ROWS))
