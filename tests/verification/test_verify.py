"""Do all benchmarks come out, and would `verify` notice if one did not?"""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from benchmark_names import NAMES, PUBLISHED, benchmark_of
from mpmath import mpf
from reference import oscillator, pendulum
from reference.incline_closed_form import accumulation, first_impact, reference, rolling_begins, settled
from reference.single_impact import single_impact as truth
from scipy.optimize import linprog

from watchsim.paths import profiles_dir
from watchsim.verification import random_problems as problems
from watchsim.verification.benchmarks import Benchmark, Check, swings
from watchsim.verification.checks import (
    Damped,
    Incline,
    Stopped,
    compared,
    damped_state,
    incline_state,
    stopped_state,
    touch_times,
    turning_time,
)
from watchsim.verification.hard_cases import wedges
from watchsim.verification.random_problems import random_rows
from watchsim.verification.verify import rows_of, verify_text

# Do all benchmarks come out, and would `verify` notice if one did not?

FIELDS = ["name", "quantity", "expected", "got", "error", "tolerance", "ok", "source"]


@pytest.mark.parametrize("name", NAMES)
def test_benchmark(name: str) -> None:
    benchmark = benchmark_of(name)
    rows = rows_of([benchmark])
    wrong = [row for row in rows if not row["ok"]]
    assert not wrong, verify_text(wrong)
    assert len(rows) == len(benchmark.checks)


def test_the_wedge_lies_on_both_walls_of_its_slot() -> None:
    """Each wall is a line through two corners of the wedge, longer than its side, with the slot's material outside."""
    half_angle = 0.2
    for benchmark in wedges(half_angle):
        wedge, slot = (benchmark.scene.body(name) for name in ("wedge", "slot"))
        corners = [complex(*edge.start) for edge in wedge.loops[0].edges]
        for loop, sign in zip(slot.loops, (1.0, -1.0), strict=True):
            (wall,) = loop.edges
            start, way = complex(*wall.start), complex(*wall.end) - complex(*wall.start)
            off = [((corner - start) / way) for corner in corners]
            touching = [one for one in off if abs(one.imag) * abs(way) < 1e-15]
            assert len(touching) == 2 and all(0.0 < one.real < 1.0 for one in touching)
            assert all(one.imag < 1e-15 for one in off)  # material on the left of a wall
            assert abs(way.real / way.imag) == pytest.approx(math.tan(half_angle)) and way.real * way.imag * sign > 0.0


def test_random_problems() -> None:
    assert all(row["ok"] for row in random_rows(300))


def test_a_wrong_number_is_noticed() -> None:
    """The right run against a shifted expectation."""
    benchmark = swings()[0]
    shifted = replace(
        benchmark, checks=(Check("angle at 2 s [rad]", 1.0 + benchmark.checks[2].expected, benchmark.checks[2].measure),)
    )
    (row,) = rows_of([shifted])
    assert not row["ok"]
    assert "WRONG" in verify_text([row])


def test_a_row_as_promised() -> None:
    row = compared("a", "b", 2.0, 2.0 + 1e-8, 1e-9, "c")
    assert list(row) == FIELDS
    assert row["error"] == pytest.approx(5e-9, rel=1e-6, abs=0.0)
    assert row["ok"] is False
    assert compared("a", "b", 0.0, 1e-10, 1e-9, "c")["ok"] is True
    assert compared("a", "b", 1.0, math.nan, 1e-9, "c")["ok"] is False
    json.dumps(row)
    assert str(compared("a", "b", -0.0, -0.0, 1e-9, "c")["expected"]) == "0.0"


def test_the_table_names_each_benchmark_once_and_counts_the_wrong() -> None:
    rows = [
        compared("first", "x", 1.0, 1.0, 0.0, "s"),
        compared("first", "y", 1.0, 2.0, 0.1, "s"),
        compared("second", "z", 0.0, 0.0, 0.0, "s"),
    ]
    text = verify_text(rows)
    assert text.count("first") == 1
    assert text.startswith("first")
    assert text.endswith("1 of 3 numbers are WRONG.")
    assert verify_text(rows[:1]).endswith("All 1 numbers agree.")


def test_profiles_are_found() -> None:
    assert (profiles_dir() / "incline" / "scene.toml").is_file()


# Does the incline in doubles agree with sixty digits?

FRICTIONS = ("0.3", "0.13", "0.10", "0.02", "0")
TIMES = (
    *("0", "0.05", "0.14", "0.15", "0.2", "0.29", "0.3", "0.4", "0.43", "0.44", "0.4418", "0.4418845"),
    *("0.5", "1", "1.25", "1.3", "2", "3"),
)


def near(got: float, expected: mpf, size: float = 1.0) -> bool:
    """Equal to 1e-14, relative, or absolute in units of `size` where the value is small."""
    return abs(got - expected) <= 1e-14 * max(abs(float(expected)), size)


@pytest.mark.parametrize("mu", FRICTIONS)
@pytest.mark.parametrize("t", TIMES)
def test_state(t: str, mu: str) -> None:
    truth, got = reference(t, mu), incline_state(Incline(float(mu)), float(t))
    assert near(got.x, truth.x, 0.1)
    assert near(-got.angle, truth.theta)
    assert near(got.v_x, truth.v)
    assert near(-got.spin, truth.spin, 20.0)


@pytest.mark.parametrize("mu", FRICTIONS)
def test_times(mu: str) -> None:
    case = Incline(float(mu))
    assert near(case.first_impact, first_impact())
    assert near(case.accumulation, accumulation())
    begins = rolling_begins(settled(mpf(mu)), mpf(mu))
    if begins == mpf("inf"):
        assert case.rolling_begins == math.inf
    else:
        assert near(case.rolling_begins, begins)


@pytest.mark.parametrize(("mu", "rolls"), [("0.12132", False), ("0.12133", True)])
def test_it_rolls_in_the_end_where_friction_is_a_third_of_the_slope(mu: str, rolls: bool) -> None:
    """tan(20°)/3 is 0.1213234: from either side of it."""
    begins = rolling_begins(settled(mpf(mu)), mpf(mu))
    assert (Incline(float(mu)).rolling_begins < math.inf) is rolls is (begins < math.inf)
    assert not rolls or Incline(float(mu)).rolling_begins == pytest.approx(float(begins), rel=1e-9)


def test_published_digits() -> None:
    state = incline_state(Incline(0.3), 3.0)
    assert state.x == pytest.approx(10.0939616140729, rel=1e-14, abs=0.0)
    assert state.angle == pytest.approx(-200.180704521549, rel=1e-14)
    assert state.spin == pytest.approx(-134.208704240992, rel=1e-14)
    assert Incline(0.13).rolling_begins == pytest.approx(1.250743025464493, rel=1e-15, abs=0.0)


def test_height_bounces_between_impacts() -> None:
    case = Incline(0.3)
    for k in range(1, 12):
        ground = case.first_impact * (1.0 + 2.0 * 0.5 * (1.0 - 0.5 ** (k - 1)) / 0.5)
        below, above = incline_state(case, ground - 1e-13), incline_state(case, ground + 1e-13)
        assert below.y == pytest.approx(case.radius, abs=1e-12)
        assert above.v_y == pytest.approx(-0.5 * below.v_y, abs=1e-11)
        top = incline_state(case, ground + above.v_y / case.press)
        assert top.v_y == pytest.approx(0.0, abs=1e-11)
        assert top.y - case.radius == pytest.approx(case.drop * 0.25**k, rel=1e-9, abs=0.0)
    assert incline_state(case, 0.6).y == case.radius
    assert incline_state(case, 0.0).y == case.radius + case.drop


@pytest.mark.parametrize("restitution", [0.1, 0.3, 0.77, 0.97])
def test_impacts_are_counted_up_to_their_end(restitution: float) -> None:
    """The height after each of the first ones, and a rounding before they accumulate."""
    case = Incline(0.3, restitution)
    t, speed = case.first_impact, case.press * case.first_impact
    for _ in range(6):
        speed *= restitution
        rise = speed / case.press
        height = incline_state(case, t + rise).y - case.radius
        assert height == pytest.approx(0.5 * speed * rise, rel=1e-8, abs=math.ulp(case.radius))
        assert incline_state(case, t + 0.7 * rise).v_y == pytest.approx(0.3 * speed, rel=1e-8, abs=0.0)
        t += 2.0 * rise
    assert case.accumulation == pytest.approx(case.first_impact * (1.0 + restitution) / (1.0 - restitution), rel=1e-14, abs=0.0)
    last = incline_state(case, math.nextafter(case.accumulation, 0.0))
    assert last.y == pytest.approx(case.radius, abs=1e-14)


def test_without_restitution_one_impact_is_all() -> None:
    case = Incline(0.3, restitution=0.0)
    assert case.accumulation == case.first_impact
    state = incline_state(case, 1.0)
    assert state.v_x == pytest.approx(case.pull * case.first_impact / 1.5 + case.pull / 1.5 * (1.0 - case.first_impact))
    assert state.v_x == pytest.approx(-case.radius * state.spin)


# Do the exact swings agree with their independent twins?

BALANCE = Damped(inertia=1.2e-9, stiffness=7.58e-7, viscous=6e-10, torque=2e-8, angle=4.7, rate=10.0)
PENDULUM = Stopped(w=22.1, angle=1.3, restitution=0.7)


@pytest.mark.parametrize("t", [0.0, 0.01, 0.13, 0.7, 2.0])
def test_damped_balance(t: float) -> None:
    twin = oscillator.Oscillator(BALANCE.inertia, BALANCE.stiffness, BALANCE.viscous, BALANCE.torque)
    assert damped_state(BALANCE, t) == pytest.approx(oscillator.motion(twin, BALANCE.angle, BALANCE.rate, t), rel=1e-12)


@pytest.mark.parametrize("rate", [10.0, 0.0, -10.0])
def test_turning_points(rate: float) -> None:
    case = Damped(1.2e-9, 7.58e-7, 6e-10, 2e-8, 4.7, rate)
    swings = [damped_state(case, turning_time(case, k)) for k in (1, 2, 3, 8)]
    assert [u for _, u in swings] == pytest.approx([0.0] * 4, abs=1e-11)
    assert swings[0][0] * swings[1][0] < 0.0
    assert 0.0 < turning_time(case, 1) < turning_time(case, 2) - turning_time(case, 1) + 1e-9


def test_what_is_let_go_has_no_rate() -> None:
    case = Damped(inertia=2.0, stiffness=9.0, viscous=0.3, torque=0.7, angle=1.5)
    assert damped_state(case, 0.0) == (pytest.approx(1.5, rel=1e-15), 0.0)


@pytest.mark.parametrize("t", [0.0, 0.05, 0.08, 0.2, 0.31, 0.5, 1.0, 3.0])
def test_pendulum_against_a_stop(t: float) -> None:
    truth = pendulum.against_stop(t, PENDULUM.angle, PENDULUM.w, PENDULUM.restitution)
    assert stopped_state(PENDULUM, t) == pytest.approx(truth, rel=1e-10, abs=1e-12)


def test_touches() -> None:
    truth = pendulum.touches(6, PENDULUM.angle, PENDULUM.w, PENDULUM.restitution)
    assert touch_times(PENDULUM, 6) == pytest.approx(truth, rel=1e-14, abs=0.0)


# Does `watchsim verify` still ask what its published page says, case by case, with the errors that the page allows?


@pytest.mark.parametrize("name", NAMES)
def test_the_case_is_the_published_one(name: str) -> None:
    case = benchmark_of(name)
    rows = PUBLISHED[case.name[0].upper() + case.name[1:]]
    assert list(rows) == [check.quantity for check in case.checks]
    for check in case.checks:
        expected, _, allowed = rows[check.quantity]
        digits = 1e-9 if abs(expected) >= 1e-6 else 0.05  # as the page prints numbers
        assert check.expected == pytest.approx(expected, rel=digits, abs=0.0)
        assert allowed_of(check, case) == pytest.approx(allowed, rel=0.06, abs=0.0)


def allowed_of(check: Check, case: Benchmark) -> float:
    """What the page can say: one digit."""
    return float(f"{check.tolerance:.0e}") if case.name.startswith("tooth at a corner") else check.tolerance


def test_every_case_of_the_page_is_still_asked() -> None:
    asked = {name[0].upper() + name[1:] for name in NAMES}
    others = {name for name in PUBLISHED if name not in asked}
    assert all(name.startswith(("Woodpecker", "Impact of one contact", "Complementarity problems")) for name in others)
    assert len(others) == 6


# Would the checks of random impacts and complementarity problems notice a wrong answer, and what do they ask?

RNG = np.random.default_rng(4711)


def test_the_impact_of_one_contact_is_that_of_the_reference() -> None:
    """In all its cases: it sticks, or slips either way, in the compression, and again in the expansion."""
    regimes = set()
    for _ in range(400):
        W, mu, eps = RNG.normal(size=(2, 3)), RNG.uniform(0.0, 1.5), RNG.uniform()
        G, rates = W @ W.T, np.array([-RNG.uniform(0.1, 2.0), RNG.normal()])
        if mu * abs(G[0, 1]) >= 0.95 * G[0, 0]:
            continue
        found = truth((G[0, 0], G[0, 1], G[1, 1]), tuple(rates), mu, eps)
        regimes.add((found.regime, math.copysign(1.0, found.tangential), abs(found.v_t) < 1e-12))
        got = problems.single_impact(G, rates, mu, eps)
        scale = np.abs((found.normal, found.tangential)).max()
        assert got == pytest.approx([found.normal, found.tangential], abs=1e-11 * scale)
    assert len(regimes) == 8


@pytest.mark.parametrize("n", range(1, 6))
def test_solutions_are_told_from_what_is_none(n: int) -> None:
    """Conditions broken by 0.9 and 1.1 billionths of the largest term, in every row."""
    for k in range(n):
        x, slack = np.zeros(n), RNG.uniform(1.0, 2.0, n)
        x[::2], slack[::2] = RNG.uniform(1.0, 2.0, len(x[::2])), 0.0
        A = RNG.uniform(-0.5, 0.5, (n, n)) + np.eye(n)
        b = slack - A @ x
        largest = (np.abs(A) @ x + np.abs(b)).max()
        assert problems.is_solution(A, b, x)
        for shift in (1e-9 * largest * np.eye(n)[k], -1e-9 * largest * np.eye(n)[k]):
            assert problems.is_solution(A, b + 0.9 * shift, x)
            assert problems.is_solution(A, b + 1.1 * shift, x) is bool(slack[k] > 0.0)  # where x is zero slack may change
    assert not problems.is_solution(np.eye(n), np.ones(n), np.full(n, np.nan))


@pytest.mark.parametrize(
    ("x", "b", "ok"), [(-0.9e-9, 0.5, True), (-1.1e-9, 0.5, False), (1e-3, 0.5, False), (0.0, -0.5, False)]
)
def test_of_small_terms_a_billionth_is_allowed(x: float, b: float, ok: bool) -> None:
    """Below zero, or both members of the pair above it."""
    assert problems.is_solution(np.eye(1), np.array([b]), np.array([x])) is ok


def test_large_terms_of_either_sign_widen_what_counts_as_zero() -> None:
    """Where terms of 700 cancel, a millionth is rounding: 7e-7 below zero, or of slack."""
    assert problems.is_solution(np.array([[1e9]]), np.array([700.0]), np.array([-7e-7]))
    for slack, ok in ((1.3e-6, True), (-1.3e-6, True), (1.5e-6, False), (-1.5e-6, False)):
        assert problems.is_solution(np.array([[7.0]]), np.array([slack - 700.0]), np.array([100.0])) is ok
        assert problems.is_solution(np.array([[-7.0]]), np.array([slack + 700.0]), np.array([100.0])) is ok


@pytest.mark.parametrize("n", range(1, 6))
def test_what_has_a_solution_is_found(n: int) -> None:
    """Matrices with a positive definite symmetric part always have one; where no x >= 0 makes A x + b >= 0, there is none."""
    for _ in range(8):
        M, K = RNG.normal(size=(2, n, n))
        assert problems.has_solution(M @ M.T + 0.1 * np.eye(n) + K - K.T, RNG.normal(size=n))
        A, b = RNG.normal(size=(n, n)), RNG.normal(size=n)
        feasible = linprog(np.zeros(n), A_ub=-A, b_ub=b, bounds=[(0.0, None)] * n).status == 0
        assert feasible or not problems.has_solution(A, b)
    assert not problems.has_solution(-np.eye(n), np.full(n, -1.0))
    assert problems.has_solution(-np.eye(n), np.full(n, 1.0))
    assert not problems.has_solution(np.zeros((n, n)), np.full(n, -1.0))  # no regular basis but the empty one


@pytest.mark.parametrize(("entry", "there"), [(0.9e-9, False), (1.1e-9, True), (-1.1e-9, False)])
def test_bases_whose_determinant_is_no_billionth_are_singular(entry: float, there: bool) -> None:
    assert problems.has_solution(np.array([[entry]]), np.array([-1.0])) is there


def test_a_regular_basis_with_a_negative_determinant_counts() -> None:
    """x = (1, 1) solves it; no basis with one of them alone does."""
    A, b = np.array([[0.0, 1.0], [1.0, 0.0]]), np.array([-1.0, -1.0])
    assert np.linalg.det(A) < 0.0 and problems.has_solution(A, b)


def test_badly_scaled_matrices_come_to_order_one() -> None:
    """By powers of two, which round nothing; others are left as they are."""
    A = np.diag([1e12, -3.0, 1e-12])
    s = problems.scales(A)
    assert np.all(np.log2(s) == np.round(np.log2(s)))
    assert np.all((np.abs(np.diag(A)) * s * s >= 0.5) & (np.abs(np.diag(A)) * s * s <= 2.0))
    assert list(problems.scales(np.diag([1.0, 1.1e3]))) == [1.0, 2.0**-5]
    for well in (np.diag([2.0, 0.9 * 2e3]), np.diag([1e9, 0.0]), np.diag([1e9, 1e9])):
        assert list(problems.scales(well)) == [1.0, 1.0]


def test_a_solution_in_other_units_is_one_still() -> None:
    unit = np.array([1e6, 1e-6])
    A, x, slack = np.array([[2.0, 0.5], [-0.5, 2.0]]), np.array([0.5, 0.0]), np.array([0.0, 3.0])
    for units in (np.ones(2), unit):
        scaled, b = A * np.outer(units, units), (slack - A @ x) * units
        assert problems.is_solution(scaled, b, x / units)
        for k in (0, 1):
            off = 2.0 * 4e-9 * np.eye(2)[k]
            assert not problems.is_solution(scaled, b, (x - off) / units)
