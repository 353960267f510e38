"""Is each rung of the ladder right by itself, and do the problems say the law of each friction force?"""

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from naive.lcp_oracle import residual, solutions
from plain_kernels import in_python
from random_contacts import random_case

from watchsim.dynamics import friction
from watchsim.dynamics.friction import (
    _detour,
    _solve_copositive,
    add_element,
    enumerate_modes,
    fill_matrix,
    fill_rhs,
    solve_contacts,
)
from watchsim.dynamics.lcp import Level, Solver
from watchsim.jit import entry
from watchsim.simulation.scratch import ContactWork, contact_work, contact_work_by_reference
from watchsim.tolerances import LCP_ROUGH

# Is each rung of the ladder right by itself, and together do they find a solution exactly when there is one?

ADD, FILL, LOAD, SOLVE, COPOSITIVE, OTHER_PATHS, ENUMERATE = range(7)
NONE = np.zeros(0)


@entry
def _asked(what, work, m, size, coefficient, b):
    """One entry for the whole ladder: what its solvers share is compiled once."""
    room = contact_work_by_reference(work)
    problem, answer = room.problem, 0
    if what == ADD:
        add_element(problem, m, size, (coefficient, 0.0, 0.0))
    elif what == FILL:
        answer = int(fill_matrix(room.system.G, m, size, problem))
    elif what == LOAD:
        fill_rhs(b, m, size, problem)
    elif what == SOLVE:
        answer = solve_contacts(m, size, 0, Level.COMPRESSION, problem) + 0  # a number, not a Solver
    elif what == COPOSITIVE:
        answer = int(_solve_copositive(m, size, problem))
    elif what == OTHER_PATHS:
        answer = int(_detour(size, LCP_ROUGH if m > 0 else 0.0, problem))
    else:
        answer = int(enumerate_modes(m, size, problem))
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
    work.system.G[: 2 * m, : 2 * m], work.problem.drag[:m] = G, mu
    for i in range(m):
        asked(ADD, work, i, i, 2.0 * mu[i])
    size = asked(FILL, work, m, m)
    asked(LOAD, work, m, m, b=b)
    return work, size, work.problem.A[:size, :size].copy(), work.problem.rhs[:size].copy()


def check_against_the_oracle(count: int, seed: int) -> tuple[int, int]:
    """Solved when and only when all complementary bases say there is a solution; returns (unsolvable, not by Lemke)."""
    rng = np.random.default_rng(seed)
    unsolvable = lower = 0
    for trial in range(count):
        m = 1 + trial % 2
        work, size, A, b = compression(rng, m, 1 + trial % 4, 3.0)
        solver = asked(SOLVE, work, m, m)
        truth = solutions(A, b)
        if solver != Solver.FAILED:
            assert residual(A, b, work.problem.x[:size]) < 1e-9
            lower += solver != Solver.LEMKE
        else:
            assert not truth
            unsolvable += 1
    return unsolvable, lower


def test_a_solution_is_found_exactly_when_there_is_one() -> None:
    unsolvable, lower = check_against_the_oracle(300, 71)
    assert unsolvable == 0  # an impact always has a solution
    assert lower > 0


def test_a_problem_posed_again_is_not_solved_again_and_one_that_differs_by_a_bit_is() -> None:
    work, size, A, b = compression(np.random.default_rng(73), 3, 4, 1.0)
    problem = work.problem
    asked(SOLVE, work, 3, 3)
    x, problem.known.x[Level.COMPRESSION, :size] = problem.x[:size].copy(), 7.0
    asked(SOLVE, work, 3, 3)
    assert np.all(problem.x[:size] == 7.0)
    for values, place in ((problem.A, (1, 2)), (problem.rhs, 1)):
        values[place] = np.nextafter(values[place], 9.0)
        asked(SOLVE, work, 3, 3)
        assert problem.x[:size] == pytest.approx(x, rel=1e-9, abs=1e-12)
        assert residual(A, b, problem.x[:size]) < 1e-9


@pytest.mark.slow
def test_a_solution_is_found_exactly_when_there_is_one_many_times() -> None:
    check_against_the_oracle(100_000, 72)


ALONE = {  # one rung: problems given to it, how many of them it solves at least
    "copositive form": (lambda work, m, size: asked(COPOSITIVE, work, m, m), 300, 285),
    "other paths": (lambda work, m, size: asked(OTHER_PATHS, work, 0, size), 300, 270),
    "enumeration": (lambda work, m, size: asked(ENUMERATE, work, m, m), 60, 60),
}


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("method", ALONE)
def test_each_other_method_alone_solves_impacts(method: str, m: int) -> None:
    solve, given, least = ALONE[method]
    rng = np.random.default_rng(80 + m)
    solved = 0
    for _ in range(given):
        work, size, A, b = compression(rng, m, 3, 1.5)
        if solve(work, m, size):
            solved += 1
            assert residual(A, b, work.problem.x[:size]) < 1e-9
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
    work.problem.A[:size, :size], work.problem.rhs[:size] = A, rhs
    assert asked(OTHER_PATHS, work, 1, size)
    assert residual(A, rhs, work.problem.x[:size]) < 1e-9 * -rhs.min()


def test_a_jammed_rotor_needs_the_second_rung() -> None:
    """One rotor on a stop, friction above |a/b|: the first form can end on a ray, the copositive one does not."""
    rng = np.random.default_rng(95)
    solvers = np.zeros(len(Solver), int)
    for _ in range(3000):
        a, b = rng.normal(size=2)
        mu = rng.uniform(0.0, 3.0)
        arms = np.array([a, b])
        work, size, A, rhs = filled(np.outer(arms, arms), arms * -np.sign(a) * rng.uniform(0.1, 1.0), np.array([mu]))
        solver = asked(SOLVE, work, 1, 1)
        assert solver != Solver.FAILED
        assert residual(A, rhs, work.problem.x[:size]) < 1e-9
        solvers[solver] += 1
        if solver != Solver.LEMKE:
            assert mu * abs(b) > abs(a)
    assert solvers[Solver.COPOSITIVE] > 0
    assert solvers[Solver.FAILED] == 0


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
        assert Solver.FAILED not in (asked(SOLVE, plain[0], 2, 2), asked(SOLVE, scaled[0], 2, 2))
        np.testing.assert_allclose(scaled[0].problem.x[:2], plain[0].problem.x[:2], rtol=1e-9, atol=1e-11)


def test_more_contacts_than_coordinates_are_solved_quickly() -> None:
    """Twelve contacts on three coordinates, as between parts that touch all along: no hang, and the laws hold."""
    rng = np.random.default_rng(101)
    for _ in range(20):
        work, size, A, b = compression(rng, 12, 3, 0.5)
        if asked(SOLVE, work, 12, 12) != Solver.FAILED:
            assert residual(A, b, work.problem.x[:size]) < 1e-8


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
    work.problem.A[:], work.problem.rhs[:] = np.nan, np.nan
    work.system.G[:] = rng.normal(size=(ROWS, ROWS))
    work.system.G[np.arange(ROWS), np.arange(ROWS)] = 10.0 ** rng.uniform(-3.0, 3.0, ROWS)
    work.problem.drag[:] = rng.normal(size=M)
    for e, block in enumerate(BLOCKS):
        assert in_python(friction.add_element)(work.problem, block, e, tuple(rng.uniform(0.1, 1.0, 3))) == e + 1
    return work, rng.normal(size=ROWS), rng


@pytest.mark.parametrize("seed", range(6))
def test_lines_are_rates_of_gaps_and_slips_and_what_is_left_of_intervals(seed: int) -> None:
    """For any forces above the lower ends, whatever their units: those give G a diagonal of one."""
    work, b, rng = posed(seed)
    G, problem = work.system.G, work.problem
    sign = problem.friction_sign
    sign[list(ROW_OF)] = rng.choice([-1.0, 1.0], ELEMENTS)
    assert in_python(friction.fill_matrix)(G, M, ELEMENTS, problem) == SIZE
    in_python(friction.fill_rhs)(b, M, ELEMENTS, problem)
    above, slip, pressed = rng.normal(size=ELEMENTS), rng.normal(size=ELEMENTS), rng.normal(size=M)
    own = np.diag(G)
    unit = np.append(np.maximum(own[:6:2], own[1:6:2]), own[6:]) ** -0.5
    assert problem.unit == pytest.approx(unit)
    force = np.zeros(ROWS)  # less the constant parts of the lower ends, which are in b
    force[:6:2], force[1:6:2] = pressed, -problem.drag * pressed
    for e, row in enumerate(ROW_OF):
        force[row] += above[e]
    force *= sign
    rates, units = sign * (b + G @ force), unit[list(BLOCKS)]
    width = [pressed[block] * problem.width[e] if block < M else 0.0 for e, block in enumerate(BLOCKS)]
    unknowns = np.concatenate([pressed / unit[:M], above / units, slip])
    found = work.problem.A[:SIZE, :SIZE] @ unknowns + work.problem.rhs[:SIZE]
    assert found[:M] == pytest.approx(unit[:M] * rates[:6:2])
    assert found[M : M + ELEMENTS] == pytest.approx(units * rates[list(ROW_OF)] + slip)
    assert found[M + ELEMENTS :] == pytest.approx((width + problem.span[:ELEMENTS] - above) / units)
    for unused in (problem.A[SIZE:], problem.A[:, SIZE:], problem.rhs[SIZE:]):
        assert np.isnan(unused).all()
    work.problem.x[:SIZE] = unknowns
    forces = np.zeros(ROWS)
    in_python(friction.read_forces)(M, ELEMENTS, problem, forces)
    for e, row in enumerate(ROW_OF):
        force[row] += sign[row] * problem.shift[e]
    assert forces == pytest.approx(force)


def reversed_rows(slip: list[float], across: float = 0.5, own: tuple[float, float] = (2.0, 3.0), block: int = 1) -> list[float]:
    """Which rows are reversed, of a contact and of a second contact or (block 2) a bearing."""
    rng = np.random.default_rng(7)
    half = rng.normal(size=(5, 5))
    G = half + half.T
    G[1, 1], G[2 * block + (block < 2), 2 * block + (block < 2)] = own
    G[1, 0] = G[0, 1] = across
    G[3, 2] = G[2, 3] = across
    problem = SimpleNamespace(friction_sign=np.full(5, 9.0), block=np.array([0, block]))
    in_python(friction.choose_signs)(G, np.array(slip), 2, 5, 2, problem)
    return list(problem.friction_sign)


def test_directions_are_taken_such_that_slips_are_positive() -> None:
    """In the rows of elements alone."""
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
