"""When are pivots zero, ratios equal and forces not unique? Each threshold from either side, as tolerances.py gives it."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import acceleration, impact, solver_fallbacks
from watchsim.dynamics.lcp import basis, lemke_pivoting, scaling
from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Spring
from watchsim.scene.scene import Scene

BOTH_SIDES = pytest.mark.parametrize("share", [0.9, 1.1])


@BOTH_SIDES
@pytest.mark.parametrize("lenience", [1.0, 1e3])
def test_forces_are_unique_where_a_second_pivot_is_a_hundred_billionth_of_the_first(share: float, lenience: float) -> None:
    """Two contacts without friction whose directions differ by so little; in any unit of mass."""
    for unit in (1.0, 1e-9):
        c = math.sqrt(1.0 - share * 1e-11 * lenience)
        G = np.zeros((4, 4))
        G[::2, ::2] = unit * np.array([[1.0, c], [c, 1.0]])
        room = {name: np.zeros(4) for name in ("b", "size", "worth", "width", "drag", "scale", "rhs", "x", "force")}
        work = SimpleNamespace(G=G, A=np.zeros((4, 4)), tangent=np.zeros(2, int), order=np.zeros(4, int), **room)
        model = SimpleNamespace(contacts=[SimpleNamespace(group=0)] * 2, laws=[SimpleNamespace(friction=0.0)])
        instead = {"fill_delassus": lambda *_: None, "gap_accelerations": lambda *_: None, "smallest_forces": lambda *_: None}
        asked = in_python(acceleration.solve_mode, **instead)
        unique = asked(model, SimpleNamespace(ids=[0, 1]), 2, np.zeros(2, int), lenience, work)
        assert unique == (share > 1.0)


@BOTH_SIDES
def test_a_last_pivot_of_a_hundred_billionth_is_rounding(share: float) -> None:
    square = np.array([[1.0, 1.0, 0.0], [1.0, 1.0 + share * 1e-11, 0.0]])
    work = SimpleNamespace(square=square, order=np.arange(2))
    eliminate = in_python(basis._eliminate)
    assert eliminate(2, 0, work)
    left = abs(float(work.square[1, 1]))
    assert eliminate(2, 1, work) == (left > 1e-11) == (share > 1.0)


def tableau(rows: list[list[float]], driver: float = 0.5) -> SimpleNamespace:
    """Rows of two unknowns: two columns of the inverse basis, two of the problem, z0, loads."""
    return SimpleNamespace(tableau=np.array(rows), basis=np.array([0, 1]), worst=SimpleNamespace(driver=driver))


@BOTH_SIDES
@pytest.mark.parametrize("largest", [0.5, 30.0])
def test_a_column_has_pivots_above_a_hundred_billionth_of_its_largest_or_of_one(share: float, largest: float) -> None:
    work = tableau([[0.0, 0.0, largest, 0.0, 0.0, 1.0], [0.0, 0.0, share * 1e-11 * max(1.0, largest), 0.0, 0.0, 0.0]])
    assert in_python(lemke_pivoting._leaving_row)(2, 2, work) == (True, 1 if share > 1.0 else 0)
    work.tableau[0, 2] = -largest
    work.tableau[1, 2] = share * 1e-11
    assert in_python(lemke_pivoting._leaving_row)(2, 2, work)[0] == (share > 1.0)


@BOTH_SIDES
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("driver", "ratio"), [(0.5, 0.1), (1e-9, 1e-12), (1e-9, 0.3)])
def test_ratios_are_equal_within_a_ten_billionth_of_the_load_that_drives_or_of_themselves(
    share: float, sign: float, driver: float, ratio: float
) -> None:
    """And within rounding of the largest load. Equal ones are parted by the inverse basis."""
    apart = share * (1e-10 * max(driver, ratio) + 1e-15)
    row, other = [1.0, 0.0, 2.0, 0.0, 0.0, 2.0 * ratio], [2.0, 0.0, 2.0, 0.0, 0.0, 2.0 * (ratio - sign * apart)]
    less = in_python(lemke_pivoting._is_smaller)(2, 0, 1, 2, tableau([row, other], driver))
    assert less == (True if share < 1.0 else sign < 0.0)


@BOTH_SIDES
@pytest.mark.parametrize("size", [0.2, 40.0])
def test_columns_of_the_inverse_basis_are_equal_within_a_ten_billionth_too(share: float, size: float) -> None:
    apart = share * 1e-10 * max(1.0, size)
    rows = [[2.0 * size, 0.0, 2.0, 0.0, 0.0, 1.0], [2.0 * (size - apart), 4.0, 2.0, 0.0, 0.0, 1.0]]
    assert in_python(lemke_pivoting._is_smaller)(2, 0, 1, 2, tableau(rows)) == (share < 1.0)
    work = tableau(rows)
    work.basis[1] = 4  # z0 leaves before all others
    assert not in_python(lemke_pivoting._is_smaller)(2, 0, 1, 2, work)
    work.basis[:] = 4, 1
    assert in_python(lemke_pivoting._is_smaller)(2, 0, 1, 2, work)


def test_other_paths_have_loads_changed_by_ever_less() -> None:
    """By up to a ten thousandth of the load that drives the problem, then a tenth of that; all unlike."""
    n, driver = 60, 0.25
    load = np.linspace(-0.25, 1.0, n)
    for path in range(9):
        room = {"tableau": np.zeros((n, 2 * n + 2)), "basis": np.zeros(n, int), "matrix": np.zeros((n, n))}
        work = SimpleNamespace(load=load, worst=SimpleNamespace(driver=driver), **room)
        in_python(lemke_pivoting._start)(n, path, work)
        more = work.tableau[:, -1] - load
        most = driver * 1e-4 * 0.1 ** ((path - 1) % 4) if path else 0.0
        assert np.all(more >= 0.0) and np.all(more <= most)
        if path:
            assert more.max() > 0.95 * most and more.min() < 0.1 * most and len(np.unique(np.round(more / most, 6))) == n


@BOTH_SIDES
def test_as_a_last_resort_a_billionth_of_what_drives_the_problem_may_be_missed(share: float) -> None:
    lcp = SimpleNamespace(
        worst=SimpleNamespace(driver=0.5, violation=0.0), trial=np.array([1e-3, 0.0]), matrix=np.eye(2),
        load=np.array([-1e-3, -share * 1e-9 * 0.5]),
    )  # fmt: skip
    work = SimpleNamespace(A=None, rhs=None, lcp=lcp, x=None)
    instead = {"lemke_on_path": lambda *_: LcpOutcome.INEXACT}
    detour = in_python(solver_fallbacks._detour, **instead)
    assert detour(work, 2, True) == (share < 1.0)
    assert not detour(work, 2, False)


@BOTH_SIDES
def test_mutual_coefficients_that_rounding_leaves_say_nothing_about_units(share: float) -> None:
    """Of unit diagonals a hundred trillionth, each way the root of it squared; zeros on one side say something."""
    tiny = share * 1e-14
    A = np.array([[1.0, 64.0 * tiny], [tiny / 64.0, 1.0]])
    work = SimpleNamespace(row_scale=np.ones(2), column_scale=np.ones(2), trial=np.ones(2))
    found = in_python(scaling._unbalance)(A, 2, 0, work)
    assert (found == 1.0) == (share < 1.0)


def test_a_spring_has_the_rounding_of_a_place_a_thousandth_of_the_size_from_rest() -> None:
    """Beside the constant force: so much of its stiffness times the size, or times a radian."""
    bodies = Body("wheel", "pivot", inertia=1.0), Body("slide", "slide", mass=1.0)
    scene = Scene("springs", bodies, springs=(Spring("wheel", 5.0), Spring("slide", 7.0)))
    compiled = compile_scene(scene)
    loads = compiled.model.coordinates.load
    assert loads[0] == pytest.approx(5.0 * 1e-3)
    assert loads[1] == pytest.approx(7.0 * 1e-3 * compiled.size)


@BOTH_SIDES
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_directions_are_parallel_to_a_trillionth_of_the_square_of_their_sine(share: float, sign: float) -> None:
    """In any units of both; what does not move at all has no directions."""
    parallel, both = in_python(impact.is_parallel), sign * math.sqrt((1.0 - share * 1e-12) * 6.0)
    G = np.array([[9.0, 0.0, 0.0, 0.0], [0.0, 9.0, 0.0, 0.0], [0.0, 0.0, 2.0, both], [0.0, 0.0, both, 3.0]])
    assert parallel(SimpleNamespace(G=G), 1) == (share < 1.0)
    assert not parallel(SimpleNamespace(G=np.zeros((4, 4))), 1)


def test_where_slip_and_approach_stop_together_a_millionth_of_the_slip_is_left() -> None:
    """Of contacts that may stick and whose directions are parallel; in the row of their element."""
    for is_parallel, rows in (([True, True, True], [0, 2]), ([False, True, True], [2]), ([False, True, False], [])):
        work = SimpleNamespace(tangent=[1, -1, 0], b=np.arange(1.0, 7.0), unit=[0.5, 9.0, 4.0], rhs=np.zeros(5))
        slides = in_python(impact._keep_sliding, is_parallel=lambda work, i, which=tuple(is_parallel): which[i])
        assert slides(3, work) == bool(rows)
        expected = np.zeros(5)
        for i in rows:
            expected[3 + work.tangent[i]] = 1e-6 * work.b[2 * i + 1] * work.unit[i]
        assert work.rhs == pytest.approx(expected)


@pytest.mark.parametrize(("jam", "nudged"), [(0.0, []), (0.25, [0]), (3.0, []), (0.05, [])])
def test_contacts_that_slide_at_a_standstill_approach_a_millionth_of_their_slip(jam: float, nudged: list[int]) -> None:
    """Where the gap stands still and the slip does not, of contacts that may stick."""
    b = np.array([-0.2, -2.0, 0.1, 3.0, 0.1, 0.1, -0.5, 2.0])
    work = SimpleNamespace(tangent=[0, -1, 1, 2], b=b, unit=[0.5, 1.0, 1.0, 2.0], rhs=np.zeros(4))
    assert in_python(impact._nudge)(4, jam, work) == bool(nudged)
    assert work.rhs == pytest.approx([-1e-6 * 2.0 * 0.5 if 0 in nudged else 0.0, 0.0, 0.0, 0.0])


def scaled(A: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Matrix and loads as the solver sees them, and x in units of its own for one in each of its unknowns."""
    n = len(b)
    rows = {name: np.zeros(n) for name in ("row_scale", "column_scale", "load")}
    work = SimpleNamespace(matrix=np.zeros((n, n)), trial=np.ones(n), worst=SimpleNamespace(driver=0.0), **rows)
    magnitude, x = in_python(scaling.scale)(A, b, n, work), np.zeros(n)
    work.trial[:] = 1.0
    in_python(scaling.unscale)(n, magnitude, work, x)
    return work.matrix, work.load, x


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("unit", [2.0**-40, 2.0**-12, 2.0**24])
def test_problems_look_alike_in_any_units_of_forces_and_masses(seed: int, unit: float) -> None:
    """To the bit where units are powers of two; unknowns without a diagonal are scaled by what couples them to others."""
    rng = np.random.default_rng(seed)
    n, base = 5, rng.normal(size=(5, 5))
    A = base @ base.T + np.diag(rng.uniform(0.1, 1.0, n))
    A[3:, 3:] = 0.0  # as in the rows of friction's intervals
    A[3:, :3] *= -1.0
    b = rng.normal(size=n)
    matrix, load, x = scaled(A, b)
    assert 0.1 < np.abs(matrix).max() < 10.0 and 0.5 <= np.abs(load).max() <= 2.0
    own = np.array([unit, 1.0, unit**0.5, unit, 2.0])  # of each unknown, and the inverse of each row's
    again, loads, units = scaled(A * own[:, None] * own, b * own * unit)
    assert np.array_equal(again, matrix) and np.array_equal(loads, load)
    assert units == pytest.approx(x * unit / own, rel=1e-14)
