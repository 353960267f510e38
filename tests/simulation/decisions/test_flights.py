"""How long may a flight be, which work and losses has it, and which rows does it or a coupled step need?"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python
from scipy.integrate import quad
from scipy.interpolate import BPoly

from watchsim.simulation.loop_state.scratch import COUPLED, FLIGHT
from watchsim.simulation.motion import free_flight, row_times

OPTIONS = SimpleNamespace(max_step=100.0, row_phase=0.1, tolerance=1e-9)
SPRUNG = {"mass": 0.7, "stiffness": 30.0, "viscous": 1.9, "rest": 0.3, "force": 0.9, "coulomb": 0.0, "scale": 2.0}


def coordinate(**changed: float) -> SimpleNamespace:
    return SimpleNamespace(**{**SPRUNG, "linear": 1, "driven": 0, **changed})


def a_state(n: int, **changed: object) -> SimpleNamespace:
    given: dict[str, object] = {"sums": SimpleNamespace(drive=0.5, damping=0.25), "now": SimpleNamespace(awake_contacts=0)}
    given |= {"q": np.full(n, 0.2), "u": np.full(n, -1.5), "a": np.zeros(n), "awake": [1] * n, "grip": [0.0] * n}
    return SimpleNamespace(clock=SimpleNamespace(time=2.0), **{**given, **changed})


def ask(name: str, *arguments: object, **instead: object) -> object:
    return in_python(getattr(free_flight, name), **instead)(*arguments)


@pytest.mark.parametrize(
    ("contacts", "awake", "linear", "expected"),
    [(0, (1, 1), (1, 1), True), (1, (1, 1), (1, 1), False), (0, (1, 1), (1, 0), False), (0, (1, 0), (1, 0), True)],
)
def test_what_moves_freely_and_linearly_flies(contacts: int, awake: tuple, linear: tuple, expected: bool) -> None:
    model = SimpleNamespace(coordinates=[coordinate(linear=one) for one in linear])
    state = a_state(2, awake=awake, now=SimpleNamespace(awake_contacts=contacts))
    assert ask("can_fly", model, state) == expected


def length(*coordinates: SimpleNamespace, **changed: object) -> tuple[float, float]:
    state = a_state(len(coordinates), **changed)
    found: tuple[float, float] = ask("flight_length", SimpleNamespace(coordinates=coordinates), state, OPTIONS)
    return found


def test_a_flight_and_its_rows_are_as_long_as_its_fastest_coordinate_allows() -> None:
    """A tenth of a radian between rows, of the swing or of what damping takes away; 1.6 rad in all."""
    swing = math.sqrt(0.7 / 30.0)
    assert length(coordinate(viscous=0.0)) == pytest.approx((0.5 * math.pi * swing, 0.1 * swing))
    assert length(coordinate(viscous=20.0)) == pytest.approx((1.6 * 0.7 / 20.0, 0.1 * 0.7 / 20.0))
    assert length(coordinate(stiffness=0.0)) == pytest.approx((1.6 * 0.7 / 1.9, 0.1 * 0.7 / 1.9))
    assert length(coordinate(stiffness=0.0, viscous=0.0, force=0.0), coordinate(viscous=0.0))[1] == pytest.approx(0.1 * swing)
    asleep = length(coordinate(viscous=20.0), coordinate(viscous=0.0), awake=[0, 1])
    assert asleep == pytest.approx((0.5 * math.pi * swing, 0.1 * swing))
    assert length(coordinate(stiffness=0.0, viscous=0.0, force=0.0)) == (OPTIONS.max_step, math.inf)


@pytest.mark.parametrize("speed", [0.0, 1e6, -1e6])
@pytest.mark.parametrize("push", [0.0, 1e9, -1e9])
def test_a_flight_goes_no_further_than_ten_thousand_sizes(speed: float, push: float) -> None:
    """With that speed and acceleration the same way, at the worst."""
    found, spacing = length(coordinate(stiffness=0.0, viscous=0.0, force=0.7 * push), u=[speed])
    assert spacing == math.inf
    if speed == push == 0.0:
        assert found == OPTIONS.max_step
    else:
        assert abs(speed) * found + 0.5 * abs(push) * found**2 == pytest.approx(1e4 * 2.0, rel=1e-12)


def test_a_flight_begins_with_the_state_and_with_bounds_of_what_is_awake() -> None:
    model = SimpleNamespace(coordinates=[coordinate(), coordinate(stiffness=0.0, viscous=0.0)])
    step = SimpleNamespace(span=SimpleNamespace(), q=np.zeros(2), u=np.zeros(2), bound=np.full(2, 9.0))
    ask("begin_flight", model, a_state(2, awake=[0, 1]), 0.125, step)
    assert vars(step.span) == {"kind": FLIGHT, "start": 2.0, "length": 0.125}
    assert (step.q.tolist(), step.u.tolist()) == ([0.2, 0.2], [-1.5, -1.5])
    assert step.bound == pytest.approx([0.0, 0.9 / 0.7])


def flown(**changed: float) -> tuple[SimpleNamespace, SimpleNamespace, SimpleNamespace]:
    model, state = SimpleNamespace(coordinates=[coordinate(**changed)]), a_state(1)
    step = SimpleNamespace(span=SimpleNamespace(kind=FLIGHT, start=2.0), q=state.q.copy(), u=state.u.copy())
    return model, state, step


def within(model: SimpleNamespace, state: SimpleNamespace, t: float) -> tuple[float, float]:
    q, u = in_python(free_flight.coordinate_within)(model, state, flown()[2], 0, t)
    return float(q), float(u)


@pytest.mark.parametrize("end", [0.01, 0.1, 0.24])
@pytest.mark.parametrize("stiffness", [30.0, 0.0])
@pytest.mark.parametrize("coulomb", [0.0, 0.4])
def test_work_and_losses_of_a_flight_are_their_integrals(end: float, stiffness: float, coulomb: float) -> None:
    """Up to a quarter period all digits; dry friction takes its moment times the way."""
    model, state, step = flown(stiffness=stiffness, coulomb=coulomb, viscous=1.9)
    ask("add_flight_sums", model, state, step, end)
    way = within(model, state, end)[0] - 0.2
    lost = quad(lambda t: 1.9 * within(model, state, t)[1] ** 2, 0.0, end, epsabs=1e-14, epsrel=1e-13)[0]
    assert state.sums.drive == pytest.approx(0.5 + 0.9 * way, rel=1e-13)
    assert state.sums.damping == pytest.approx(0.25 + lost + coulomb * abs(way), rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("awake", "driven"), [(0, 0), (1, 1)])
def test_what_sleeps_or_is_driven_has_no_work_of_its_own(awake: int, driven: int) -> None:
    model, state, step = flown(driven=driven)
    state.awake = [awake]
    ask("add_flight_sums", model, state, step, 0.1)
    assert (state.sums.drive, state.sums.damping) == (0.5, 0.25)


@pytest.mark.parametrize(("spacing", "rows"), [(math.inf, 1), (0.1, 1), (0.05, 2), (0.0499, 3), (0.2, 1)])
@pytest.mark.parametrize("kept", [True, False])
def test_rows_of_a_flight_are_evenly_spaced_up_to_its_end(spacing: float, rows: int, kept: bool) -> None:
    model, state, step = flown()
    windows = np.array([[0.0, 9.0]]) if kept else np.zeros((0, 2))
    record = SimpleNamespace(rows=np.zeros((9, 4)), used=SimpleNamespace(rows=0), windows=windows)
    ask("keep_flight_rows", model, state, 0.1, spacing, step, record)
    assert record.used.rows == (rows if kept else 0)
    for i, row in enumerate(record.rows[: record.used.rows], 1):
        tau = 0.1 * i / rows
        q, u = within(model, state, tau)
        push = (0.9 - 1.9 * u - 30.0 * (q - 0.3)) / 0.7
        assert row == pytest.approx([2.0 + tau, q, u, push], rel=1e-14)
    assert (state.q[0], state.u[0]) == within(model, state, 0.1)


def polynomial(rng: np.random.Generator, size: float) -> tuple[np.ndarray, np.polynomial.Polynomial]:
    """Start value and coefficients of a continuous extension, and the same multiplied out, in the share of the step."""
    d = size * rng.normal(size=8)
    x = np.polynomial.Polynomial([0.0, 1.0])
    w = 1.0 - x
    inner = d[5] + w * (d[6] + x * d[7])
    return d, d[0] + x * (d[1] + w * (d[2] + x * (d[3] + w * (d[4] + x * inner))))


@pytest.mark.parametrize("seed", range(12))
def test_coupled_steps_have_as_many_rows_as_their_interpolation_needs(seed: int) -> None:
    """So many that the quintic strays by less than the tolerance in the middle, and the velocity of the cubic."""
    rng = np.random.default_rng(seed)
    h, end = 10.0 ** rng.uniform(-3.0, 1.0), rng.uniform(0.2, 1.0)
    extent, speed = (10.0 ** rng.uniform(-8.0, -5.0) for _ in range(2))
    if seed % 3 == 2:
        extent, speed = 1e-12, 1e-12
    parts = [polynomial(rng, extent) for _ in range(2)] + [polynomial(rng, speed / h) for _ in range(2)]
    q, u = [p for _, p in parts[:2]], [p for _, p in parts[2:]]
    stages = np.array([[0.0, 0.0, *(float(p.deriv()(0.0)) / h for p in u)]])
    step = SimpleNamespace(
        span=SimpleNamespace(kind=COUPLED, start=4.0, length=h),
        **{"y0": [d[0] for d, _ in parts], "dense": np.array([d[1:] for d, _ in parts]).T, "stages": stages},
        **{"q": [float(p(0.0)) for p in q], "u": [float(p(0.0)) for p in u]},
    )
    model = SimpleNamespace(coordinates=[coordinate(scale=0.5 + i, rate=3.0 / h) for i in range(2)])
    record = SimpleNamespace(rows=np.zeros((99, 7)), used=SimpleNamespace(rows=1), windows=np.array([[0.0, 99.0]]))
    in_python(row_times.keep_inner_rows)(model, OPTIONS, end * h, step, record)
    most = 1.0
    for i in range(2):
        # (q, u, a) and (u, a) at both ends, in the time of the step, as polynomials of their own.
        ends = [[float(q[i](s)), h * float(u[i](s)), h * float(u[i].deriv()(s))] for s in (0.0, end)]
        quintic, cubic = BPoly.from_derivatives([0.0, end], ends), BPoly.from_derivatives([0.0, end], [e[1:] for e in ends])
        fast = float(u[i](0.5 * end))
        strays = abs(float(quintic(0.5 * end)) - float(q[i](0.5 * end))) / (1e-9 * (0.5 + i))
        off = abs(float(cubic(0.5 * end)) / h - fast) / (1e-9 * max((0.5 + i) * 3.0 / h, abs(fast)))
        most = max(most, strays ** (1 / 6), off**0.25)
    assert record.used.rows == min(math.ceil(most), 64)
    for k in range(1, record.used.rows):
        share = end * k / record.used.rows
        wanted = [4.0 + share * h, *(float(p(share)) for p in (*q, *u)), *(float(p.deriv()(share)) / h for p in u)]
        assert record.rows[k] == pytest.approx(wanted, rel=1e-9, abs=1e-12 * speed / h)
    assert (most == 1.0) == (seed % 3 == 2)


def test_of_a_coupled_step_only_rows_within_windows_are_kept() -> None:
    """Cut into four parts: rows lie at a quarter, a half and three quarters."""
    step = SimpleNamespace(span=SimpleNamespace(kind=COUPLED, start=4.0, length=1.0), y0=np.zeros(2), dense=np.zeros((7, 2)))
    model = SimpleNamespace(coordinates=[coordinate()])
    for window, expected in (((4.4, 4.6), [4.5]), ((4.5, 9.0), [4.5, 4.75]), ((5.01, 9.0), []), ((4.9, 9.0), [])):
        record = SimpleNamespace(rows=np.zeros((9, 4)), used=SimpleNamespace(rows=0), windows=np.array([window]))
        in_python(row_times.keep_inner_rows, _pieces=lambda *_: 4)(model, OPTIONS, 1.0, step, record)
        assert record.rows[: record.used.rows, 0].tolist() == expected
        in_python(row_times.keep_inner_rows, _pieces=lambda *_: 4)(model, OPTIONS, 0.0, step, record)
        assert record.used.rows == len(expected)
