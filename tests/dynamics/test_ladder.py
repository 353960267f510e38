"""Is each rung of the ladder right by itself, and do the problems say the law of each friction force?"""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from naive.lcp_oracle import residual, solutions
from plain_kernels import in_python
from random_contacts import random_case

from watchsim.dynamics import friction as coulomb
from watchsim.dynamics import friction as handedness
from watchsim.dynamics.delassus import ContactWork, ContactWorkRef, contact_work
from watchsim.dynamics.friction import (
    _detour,
    _solve_copositive,
    add_element,
    enumerate_modes,
    fill_matrix,
    fill_rhs,
    solve_contacts,
)
from watchsim.dynamics.lcp import LcpWorkRef
from watchsim.dynamics.lcp import Solver as Rung
from watchsim.jit import entry

# Is each rung of the ladder right by itself, and together do they find a solution exactly when there is one?

ADD, FILL, LOAD, SOLVE, COPOSITIVE, OTHER_PATHS, ENUMERATE = range(7)
NONE = np.zeros(0)


@entry
def _asked(what, work, m, size, coefficient, b):
    """One entry for the whole ladder: what its rungs share is compiled once."""
    room = ContactWorkRef(LcpWorkRef(*work.lcp), *work[1:])
    answer = 0
    if what == ADD:
        add_element(room, m, size, (coefficient, 0.0, 0.0))
    elif what == FILL:
        answer = int(fill_matrix(room, m, size))
    elif what == LOAD:
        fill_rhs(room, m, size, b)
    elif what == SOLVE:
        answer = solve_contacts(room, m, size) + 0  # a number, not a Rung
    elif what == COPOSITIVE:
        answer = int(_solve_copositive(room, m, size))
    elif what == OTHER_PATHS:
        answer = int(_detour(room, size, m > 0))
    else:
        answer = int(enumerate_modes(room, m, size))
    return answer


def asked(what: int, work: ContactWork, m: int, size: int, coefficient: float = 0.0, b: np.ndarray = NONE) -> int:
    return int(_asked(what, work, m, size, coefficient, b))


def compression(rng: np.random.Generator, m: int, n: int, friction: float) -> tuple[ContactWork, int, np.ndarray, np.ndarray]:
    """Room with the compression of m frictional contacts on n coordinates in it; its size, matrix and right-hand side."""
    case = random_case(rng, m, n, mu=rng.uniform(0.0, friction, m))
    return filled(case.G, case.W @ rng.normal(size=n), case.friction)


def filled(G: np.ndarray, b: np.ndarray, mu: np.ndarray) -> tuple[ContactWork, int, np.ndarray, np.ndarray]:
    m = len(mu)
    work = contact_work(m, 1)
    work.G[: 2 * m, : 2 * m], work.drag[:m] = G, mu
    for i in range(m):
        asked(ADD, work, i, i, 2.0 * mu[i])
    size = asked(FILL, work, m, m)
    asked(LOAD, work, m, m, b=b)
    return work, size, work.A[:size, :size].copy(), work.rhs[:size].copy()


def check_against_the_oracle(count: int, seed: int) -> tuple[int, int]:
    """Solved when and only when all complementary bases say there is a solution; returns (unsolvable, not by Lemke)."""
    rng = np.random.default_rng(seed)
    unsolvable = lower = 0
    for trial in range(count):
        m = 1 + trial % 2
        work, size, A, b = compression(rng, m, 1 + trial % 4, 3.0)
        rung = asked(SOLVE, work, m, m)
        truth = solutions(A, b)
        if rung != Rung.FAILED:
            assert residual(A, b, work.x[:size]) < 1e-9
            lower += rung != Rung.LEMKE
        else:
            assert not truth
            unsolvable += 1
    return unsolvable, lower


def test_a_solution_is_found_exactly_when_there_is_one() -> None:
    unsolvable, lower = check_against_the_oracle(300, 71)
    assert unsolvable == 0  # an impact always has a solution
    assert lower > 0


@pytest.mark.slow
def test_a_solution_is_found_exactly_when_there_is_one_many_times() -> None:
    check_against_the_oracle(100_000, 72)


ALONE = {  # one rung: problems given to it, how many of them it solves at least
    "copositive form": (lambda work, m, size: asked(COPOSITIVE, work, m, m), 300, 285),
    "other paths": (lambda work, m, size: asked(OTHER_PATHS, work, 0, size), 300, 270),
    "enumeration": (lambda work, m, size: asked(ENUMERATE, work, m, m), 60, 60),
}


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("rung", ALONE)
def test_each_lower_rung_alone_solves_impacts(rung: str, m: int) -> None:
    solve, given, least = ALONE[rung]
    rng = np.random.default_rng(80 + m)
    solved = 0
    for _ in range(given):
        work, size, A, b = compression(rng, m, 3, 1.5)
        if solve(work, m, size):
            solved += 1
            assert residual(A, b, work.x[:size]) < 1e-9
    assert solved >= least


HEAPS = Path(__file__).resolve().parents[1] / "data" / "problems_of_two_scales.json"


@pytest.mark.parametrize("number", range(3))
def test_small_approaches_beside_fast_slips_are_seen(number: int) -> None:
    """Impacts in heaps of discs: what approaches does so at a hundred millionth of the slips.

    Ratios were compared at the scale of the largest load, where all of these tie: each ended on a ray.
    """
    problem = json.loads(HEAPS.read_text())[number]
    rhs = np.array(problem["rhs"])
    A = np.zeros((len(rhs), len(rhs)))
    for row, column, value in problem["A"]:
        A[row, column] = value
    work, size = contact_work(problem["contacts"], 1), len(rhs)
    work.A[:size, :size], work.rhs[:size] = A, rhs
    assert asked(OTHER_PATHS, work, 1, size)
    assert residual(A, rhs, work.x[:size]) < 1e-9 * -rhs.min()


def test_a_jammed_rotor_needs_the_second_rung() -> None:
    """One rotor on a stop, friction above |a/b|: the first form can end on a ray, the copositive one does not."""
    rng = np.random.default_rng(95)
    rungs = np.zeros(len(Rung), int)
    for _ in range(3000):
        a, b = rng.normal(size=2)
        mu = rng.uniform(0.0, 3.0)
        arms = np.array([a, b])
        work, size, A, rhs = filled(np.outer(arms, arms), arms * -np.sign(a) * rng.uniform(0.1, 1.0), np.array([mu]))
        rung = asked(SOLVE, work, 1, 1)
        assert rung != Rung.FAILED
        assert residual(A, rhs, work.x[:size]) < 1e-9
        rungs[rung] += 1
        if rung != Rung.LEMKE:
            assert mu * abs(b) > abs(a)
    assert rungs[Rung.COPOSITIVE] > 0
    assert rungs[Rung.FAILED] == 0


@pytest.mark.parametrize("decades", [1e-12, 1e12])
def test_badly_scaled_contacts(decades: float) -> None:
    """One body a million million times lighter: the same problem in other units, and still the right answer."""
    rng = np.random.default_rng(99)
    for _ in range(200):
        case = random_case(rng, 2, 3)
        unit = np.repeat([1.0, decades**0.5], 2)
        rates = case.W @ rng.normal(size=3)
        plain = filled(case.G, rates, case.friction)
        scaled = filled(case.G * np.outer(unit, unit), rates * unit, case.friction)
        assert Rung.FAILED not in (asked(SOLVE, plain[0], 2, 2), asked(SOLVE, scaled[0], 2, 2))
        np.testing.assert_allclose(scaled[0].x[:2], plain[0].x[:2], rtol=1e-9, atol=1e-11)


def test_more_contacts_than_coordinates_are_solved_quickly() -> None:
    """Twelve contacts on three coordinates, as between parts that touch all along: no hang, and the laws hold."""
    rng = np.random.default_rng(101)
    for _ in range(20):
        work, size, A, b = compression(rng, 12, 3, 0.5)
        if asked(SOLVE, work, 12, 12) != Rung.FAILED:
            assert residual(A, b, work.x[:size]) < 1e-8


# Do the complementarity problems say the law of each friction force, in unscaled forces and rates?

M, BEARINGS, ROWS = 3, 2, 8
BLOCKS = (4, 0, 2, 3)  # of each element: a bearing, two contacts, the other bearing; contact 1 has none
ROW_OF = (7, 1, 5, 6)  # of G
ELEMENTS = len(BLOCKS)
SIZE = M + 2 * ELEMENTS


def posed(seed: int) -> tuple[ContactWork, np.ndarray, np.random.Generator]:
    """Any G, any intervals of friction; and rates of the rows."""
    rng = np.random.default_rng(seed)
    work = contact_work(M, BEARINGS)
    work.A[:], work.rhs[:] = np.nan, np.nan
    work.G[:] = rng.normal(size=(ROWS, ROWS))
    work.G[np.arange(ROWS), np.arange(ROWS)] = 10.0 ** rng.uniform(-3.0, 3.0, ROWS)
    work.drag[:] = rng.normal(size=M)
    for e, block in enumerate(BLOCKS):
        assert in_python(coulomb.add_element)(work, block, e, tuple(rng.uniform(0.1, 1.0, 3))) == e + 1
    return work, rng.normal(size=ROWS), rng


@pytest.mark.parametrize("seed", range(6))
def test_lines_are_rates_of_gaps_and_slips_and_what_is_left_of_intervals(seed: int) -> None:
    """For any forces above the lower ends, whatever their units: those give G a diagonal of one."""
    work, b, rng = posed(seed)
    assert in_python(coulomb.fill_matrix)(work, M, ELEMENTS) == SIZE
    in_python(coulomb.fill_rhs)(work, M, ELEMENTS, b)
    above, slip, pressed = rng.normal(size=ELEMENTS), rng.normal(size=ELEMENTS), rng.normal(size=M)
    own = np.diag(work.G)
    unit = np.append(np.maximum(own[:6:2], own[1:6:2]), own[6:]) ** -0.5
    assert work.unit == pytest.approx(unit)
    force = np.zeros(ROWS)  # less the constant parts of the lower ends, which are in b
    force[:6:2], force[1:6:2] = pressed, -work.drag * pressed
    for e, row in enumerate(ROW_OF):
        force[row] += above[e]
    rates, units = b + work.G @ force, unit[list(BLOCKS)]
    width = [pressed[block] * work.width[e] if block < M else 0.0 for e, block in enumerate(BLOCKS)]
    unknowns = np.concatenate([pressed / unit[:M], above / units, slip])
    found = work.A[:SIZE, :SIZE] @ unknowns + work.rhs[:SIZE]
    assert found[:M] == pytest.approx(unit[:M] * rates[:6:2])
    assert found[M : M + ELEMENTS] == pytest.approx(units * rates[list(ROW_OF)] + slip)
    assert found[M + ELEMENTS :] == pytest.approx((width + work.span[:ELEMENTS] - above) / units)
    assert np.isnan(work.A[SIZE:]).all() and np.isnan(work.A[:, SIZE:]).all() and np.isnan(work.rhs[SIZE:]).all()
    work.x[:SIZE] = unknowns
    forces = np.zeros(ROWS)
    in_python(coulomb.read_forces)(work, M, ELEMENTS, forces)
    for e, row in enumerate(ROW_OF):
        force[row] += work.shift[e]
    assert forces == pytest.approx(force)


def reversed_rows(slip: list[float], across: float = 0.5, own: tuple[float, float] = (2.0, 3.0), block: int = 1) -> list[float]:
    """Which rows are reversed, of a contact and of a second contact or (block 2) a bearing."""
    rng = np.random.default_rng(7)
    half = rng.normal(size=(5, 5))
    G = half + half.T
    G[1, 1], G[2 * block + (block < 2), 2 * block + (block < 2)] = own
    G[1, 0] = G[0, 1] = across
    G[3, 2] = G[2, 3] = across
    rates = np.array(slip)
    work = SimpleNamespace(G=G.copy(), hand=np.full(5, 9.0), block=np.array([0, block]), force=rng.normal(size=5))
    force = work.force.copy()
    in_python(handedness.reverse_directions)(work, 2, 5, 2, rates)
    hand = work.hand.copy()
    assert np.array_equal(work.G, G * np.outer(hand, hand)) and np.array_equal(rates, hand * slip)
    in_python(handedness.restore_directions)(work, 5, rates)
    assert np.array_equal(work.G, G) and rates.tolist() == slip and work.force == pytest.approx(hand * force)
    return list(hand)


def test_directions_are_taken_such_that_slips_are_positive() -> None:
    """In the rows of elements alone; G, slips and forces change with them, and back."""
    assert reversed_rows([-1.0, -0.3, -1.0, 0.4, -2.0]) == [1, -1, 1, 1, 1]
    assert reversed_rows([1.0, 0.3, 1.0, -0.4, 2.0]) == [1, 1, 1, -1, 1]
    assert reversed_rows([-1.0, -0.3, -1.0, -0.4, -2.0], block=2) == [1, -1, 1, 1, -1]


@pytest.mark.parametrize("across", [0.5, -0.5])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "by_slip"), [(0.9e-9, False), (1.1e-9, True)])
def test_what_hardly_slips_has_the_direction_that_a_normal_force_gives_it(
    share: float, by_slip: bool, sign: float, across: float
) -> None:
    """Below a billionth of the fastest, each by what would stop it; a bearing has the sign of its slip in any case."""
    slow = sign * share * 0.7 * (3.0 / 2.0) ** 0.5
    expected = -1 if (sign if by_slip else across) < 0.0 else 1
    assert reversed_rows([1.0, 0.7, 1.0, slow, 1.0], across)[3] == expected
    assert reversed_rows([1.0, 0.7, 1.0, 1.0, slow], across, block=2)[4] == (-1 if sign < 0.0 else 1)


def test_what_nothing_can_stop_does_not_count_as_the_fastest() -> None:
    assert reversed_rows([1.0, 5e9, 1.0, -0.2, 1.0], own=(0.0, 3.0)) == [1, 1, 1, -1, 1]
    for own in (1.0, 1e-6):
        assert reversed_rows([1.0, 5e9, 1.0, -0.2, 1.0], own=(own, 3.0)) == [1, 1, 1, 1, 1]
