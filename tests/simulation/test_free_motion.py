"""Is motion without contacts that of its equations: closed forms, scipy, forty digits?"""

import dataclasses
import json
import math
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from moving_scenes import PROFILES, circle, of_kind, tip, touching
from mpmath import mp, mpf
from plain_kernels import in_python
from reference import block, duffing, oscillator, pendulum, rolling
from reference.oscillator import Oscillator
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

from watchsim.cli import main
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.results.folder import read_results
from watchsim.scene.forces import Contact, Damping, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene
from watchsim.simulation import step_path
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.step_path import acceleration_bound, flow
from watchsim.simulation.trajectory import Trajectory

# Is the flight of one coordinate the exact solution of its equation, and when does it turn back?

GRIPS = (0.0, 1.0, -1.0)
CASES = {  # mass, stiffness, viscous
    "free": (0.7, 0.0, 0.0),
    "damped without a spring": (0.7, 0.0, 0.4),
    "hardly damped without a spring": (0.7, 0.0, 1e-4),
    "spring": (0.7, 30.0, 0.0),
    "spring and damping": (0.7, 30.0, 1.9),
    "critical damping": (0.5, 8.0, 4.0),
    "strong damping": (0.7, 3.0, 9.0),
}


def coordinate(case: str) -> SimpleNamespace:
    mass, stiffness, viscous = CASES[case]
    return SimpleNamespace(mass=mass, stiffness=stiffness, viscous=viscous, rest=0.3, force=0.9, coulomb=0.25)


def ask(name: str, *arguments):
    return in_python(getattr(step_path, name))(*arguments)


def matrix(one: SimpleNamespace, grip: float) -> np.ndarray:
    """Of the rates of (q, q', 1): friction acts against the direction of the grip."""
    constant = one.force - grip * one.coulomb + one.stiffness * one.rest
    return np.array(
        [[0.0, 1.0, 0.0], [-one.stiffness / one.mass, -one.viscous / one.mass, constant / one.mass], [0.0, 0.0, 0.0]]
    )


def state(one: SimpleNamespace, grip: float, q: float, u: float, t: float) -> np.ndarray:
    return np.asarray(expm(matrix(one, grip) * t) @ (q, u, 1.0))


def starts(seed: int) -> tuple[float, float]:
    q, u = np.random.default_rng(seed).normal(size=2)
    return float(q), float(u)


@pytest.mark.parametrize("grip", GRIPS)
@pytest.mark.parametrize("case", CASES)
def test_flights_are_exact(case: str, grip: float) -> None:
    one = coordinate(case)
    for seed, t in enumerate((0.0, 1e-5, 0.003, 0.08, 0.9, 4.0)):
        q, u = starts(seed)
        assert ask("flow", one, grip, q, u, t) == pytest.approx(state(one, grip, q, u, t)[:2], rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("grip", GRIPS)
@pytest.mark.parametrize("case", CASES)
def test_accelerations_stay_below_their_bound_which_is_met_without_damping(case: str, grip: float) -> None:
    """The bound is the norm that a spring's swing keeps, of second and third derivative at the start; it never grows."""
    one, A = coordinate(case), matrix(coordinate(case), grip)
    for seed in range(5):
        q, u = starts(seed)
        y = np.array([q, u, 1.0])
        a, jerk = (A @ y)[1], (A @ A @ y)[1]
        assert ask("acceleration", one, grip, q, u) == pytest.approx(a, rel=1e-12, abs=0.0)
        bound = ask("acceleration_bound", one, grip, q, u)
        met = [abs((A @ state(one, grip, q, u, t))[1]) for t in np.linspace(0.0, 1.2, 60)]
        assert max(met) <= bound * (1.0 + 1e-12)
        wanted = abs(a) if one.stiffness == 0.0 else math.hypot(a, jerk * math.sqrt(one.mass / one.stiffness))
        assert bound == pytest.approx(wanted, rel=1e-12, abs=0.0)
        if one.viscous == 0.0:
            assert max(met) > 0.99 * bound


@pytest.mark.parametrize("case", CASES)
def test_how_fast_accelerations_change(case: str) -> None:
    """No faster than this share of their bound: in a swing its frequency, without a spring the rate at which damping slows."""
    one = coordinate(case)
    A, rate = matrix(one, 0.0), ask("fastest_change", one)
    worst = 0.0
    for seed in range(6):
        y = np.array([*starts(seed), 1.0])
        bound = ask("acceleration_bound", one, 0.0, *y[:2])
        jerks = [abs((A @ A @ expm(A * t) @ y)[1]) for t in np.linspace(0.0, 1.2, 30)]
        if one.viscous == 0.0 or one.stiffness == 0.0:
            assert max(jerks) <= rate * bound * (1.0 + 1e-9) + 1e-15
            worst = max(worst, max(jerks) / (rate * bound) if rate * bound else 1.0)
    assert worst == pytest.approx(1.0, rel=0.1) or (one.viscous > 0.0 and one.stiffness > 0.0)
    assert rate == pytest.approx(math.sqrt(one.stiffness / one.mass) or one.viscous / one.mass, rel=1e-14)


@pytest.mark.parametrize("case", CASES)
def test_a_quarter_of_a_period_takes_a_spring_from_its_end_to_rest(case: str) -> None:
    one = coordinate(case)
    time = ask("quarter_period", one)
    if one.stiffness == 0.0:
        assert time == math.inf
        return
    alone = SimpleNamespace(**{**vars(one), "viscous": 0.0, "force": 0.0})
    assert state(alone, 0.0, one.rest + 2.0, 0.0, time)[0] == pytest.approx(one.rest, abs=1e-12)
    assert state(alone, 0.0, one.rest + 2.0, 0.0, 0.5 * time)[0] > one.rest


STRIDE, LONGEST = 0.01, 8.0  # s


def first_standstill(one: SimpleNamespace, grip: float, q: float, u: float) -> float:
    """By sampling: the first time after the start at which the velocity changes its sign; infinity for none before long."""
    move, y = expm(matrix(one, grip) * STRIDE), state(one, grip, q, u, 1e-6)
    for k in range(int(LONGEST / STRIDE)):
        after = move @ y
        if abs(after[1]) < 1e-7 * (abs(u) + 1e-3):
            return math.inf  # it creeps to its rest
        if after[1] * y[1] < 0.0:
            begin = 1e-6 + k * STRIDE
            return float(brentq(lambda t: state(one, grip, q, u, t)[1], begin, begin + STRIDE, xtol=1e-14))
        y = after
    return math.inf


@pytest.mark.parametrize("speed", [0.0, 0.8, -0.8, 3.0, -3.0])
@pytest.mark.parametrize("case", CASES)
def test_a_coordinate_turns_when_its_velocity_first_vanishes(case: str, speed: float) -> None:
    for grip in GRIPS:
        for q in (0.37, -0.9, 1.4):
            one = coordinate(case)
            wanted = first_standstill(one, grip, q, speed)
            if wanted == math.inf and speed != 0.0:
                assert ask("turning_time", one, grip, q, speed) > 3.0
            elif speed != 0.0 or (one.stiffness > 0.0 and one.viscous < 3.0):
                assert ask("turning_time", one, grip, q, speed) == pytest.approx(wanted, rel=1e-9)
            else:
                assert ask("turning_time", one, grip, q, speed) == math.inf


@pytest.mark.parametrize("case", ["free", "damped without a spring"])
def test_what_is_pushed_the_way_it_goes_never_turns(case: str) -> None:
    one = coordinate(case)
    assert ask("turning_time", one, 0.0, 0.0, 2.0) == math.inf
    assert ask("turning_time", one, 0.0, 0.0, 0.0) == math.inf
    one.force = 0.0
    assert ask("turning_time", one, 0.0, 0.0, 2.0) == math.inf  # damping alone never stops it


@pytest.mark.parametrize("q", [0.9, -0.4])
@pytest.mark.parametrize("case", ["spring", "spring and damping"])
def test_what_is_let_go_at_rest_turns_after_half_a_period(case: str, q: float) -> None:
    """Of the damped swing."""
    one = coordinate(case)
    rate = math.sqrt(one.stiffness / one.mass - (0.5 * one.viscous / one.mass) ** 2)
    assert ask("turning_time", one, 0.0, q, 0.0) == pytest.approx(math.pi / rate, rel=1e-14)
    assert ask("turning_time", one, 0.0, q, 1e-300) in (pytest.approx(0.0, abs=1e-200), pytest.approx(math.pi / rate))


# Is the motion between contacts exact: with and without springs, from no damping to strong damping?

_flow, _bound = callable_kernel(flow), callable_kernel(acceleration_bound)


def exact(o: Oscillator, q0: float, u0: float, t: float) -> tuple[float, float]:
    """The linear equation solved with 60 digits by the matrix exponential."""
    with mp.workdps(60):
        k, c, m = mpf(o.stiffness), mpf(o.viscous), mpf(o.inertia)
        push = (mpf(o.torque) + k * mpf(o.rest)) / m
        system = mp.matrix([[0, 1, 0], [-k / m, -c / m, push], [0, 0, 0]])
        q, u, _ = mp.expm(system * mpf(t), method="taylor") * mp.matrix([mpf(q0), mpf(u0), 1])
        return float(q), float(u)


def scene_of(o: Oscillator, q0: float, u0: float) -> Scene:
    return Scene(
        "free",
        (Body("rotor", "pivot", angle=q0, velocity=(u0,), inertia=o.inertia),),
        springs=(Spring("rotor", o.stiffness, o.rest),) if o.stiffness else (),
        torques=(Torque("rotor", o.torque),),
        damping=(Damping("rotor", o.viscous),),
    )


CASES_FREE = {
    "undamped": Oscillator(2.0, 50.0, 0.0, 3.0, 0.2),
    "underdamped": Oscillator(2.0, 50.0, 1.5, 3.0, 0.2),
    "hardly damped": Oscillator(2.0, 50.0, 1e-9),
    "nearly critical": Oscillator(2.0, 50.0, 20.0 * (1.0 - 1e-9), -4.0),
    "critical": Oscillator(2.0, 50.0, 20.0, -4.0),
    "just beyond critical": Oscillator(2.0, 50.0, 20.0 * (1.0 + 1e-9), -4.0),
    "overdamped": Oscillator(2.0, 50.0, 31.0, 3.0, 0.2),
    "strongly overdamped": Oscillator(2.0, 50.0, 900.0, 3.0, 0.2),
    "no spring": Oscillator(2.0, 0.0, 1.5, 3.0),
    "no spring, tiny damping": Oscillator(2.0, 0.0, 1e-10, 3.0),
    "no spring, strong damping": Oscillator(2.0, 0.0, 500.0, 3.0),
    "nothing": Oscillator(2.0, 0.0),
    "watch balance": Oscillator(1.2e-9, 1.2e-9 * (8.0 * math.pi) ** 2, 1.2e-9 * 8.0 * math.pi / 250.0),
}


@pytest.mark.parametrize("name", CASES_FREE)
def test_one_flight(name: str) -> None:
    o = CASES_FREE[name]
    coordinate = compile_scene(scene_of(o, 0.7, -1.1)).model.coordinates[0]
    natural = math.sqrt(o.inertia / o.stiffness) if o.stiffness else 1.0
    for t in (1e-9, 1e-4, 0.03, 0.3, 1.5):
        assert _flow(coordinate, 0, 0.7, -1.1, t * natural) == pytest.approx(
            exact(o, 0.7, -1.1, t * natural), rel=1e-13, abs=3e-14
        )


@pytest.mark.parametrize("name", CASES_FREE)
def test_acceleration_never_exceeds_its_bound(name: str) -> None:
    """What the search for contacts relies on."""
    o = CASES_FREE[name]
    coordinate = compile_scene(scene_of(o, 0.7, -1.1)).model.coordinates[0]
    for q0, u0 in ((0.7, -1.1), (0.0, 9.0), (-3.0, 0.0), (0.26, 0.001)):
        bound = _bound(coordinate, 0, q0, u0)
        for t in np.linspace(0.0, 3.0, 60):
            q, u = _flow(coordinate, 0, q0, u0, t)
            a = (o.torque - o.viscous * u - o.stiffness * (q - o.rest)) / o.inertia
            assert abs(a) <= bound * (1.0 + 1e-12) + 1e-12


@pytest.mark.parametrize("name", CASES_FREE)
def test_a_whole_run(name: str) -> None:
    """Many flights in a row, sampled between the rows as well."""
    o = CASES_FREE[name]
    done = simulate(scene_of(o, 0.7, -1.1), 2.0)
    for t in (0.0137, 0.5, 1.234, 2.0):
        truth = exact(o, 0.7, -1.1, t) if o.stiffness < 1e-3 else oscillator.motion(o, 0.7, -1.1, t)
        if name.startswith("strongly"):
            truth = exact(o, 0.7, -1.1, t)
        q, u = done.at(t)
        speed = 1.0 + math.sqrt(o.stiffness / o.inertia)
        row = float(np.min(np.abs(done.t - t))) == 0.0
        # Where the way between two rows says no more than the positions' own error, the cubic is off by as much: that error,
        # half a tolerance, times 30/16 over the distance of rows, 0.1 of the coordinate's own time.
        between = 10.0 * done.tolerance
        assert (q[0], u[0]) == pytest.approx(truth, abs=(1e-12 if row else between) * speed)
    at_start = 0.5 * (o.inertia * 1.1**2 + o.stiffness * (0.7 - o.rest) ** 2)
    assert abs(done.energy["residual_J"]) <= 1e-12 * (at_start + abs(done.energy["in_J"]))


def test_turning_points_and_passages() -> None:
    """A balance: every turn and every passage of the rest position, at the times and places of the closed form."""
    o = CASES_FREE["watch balance"]
    done = simulate(scene_of(o, 4.7, 0.0), 1.0)
    decay = 0.5 * o.viscous / o.inertia
    w = math.sqrt(o.stiffness / o.inertia - decay**2)
    turns = [event for event in done.events if event["kind"] == EventKind.TURN]
    crossings = [event for event in done.events if event["kind"] == EventKind.CROSS]
    assert [event["t"] for event in turns] == pytest.approx([k * math.pi / w for k in range(1, 8)], abs=1e-13)
    swings = [4.7 * (-1.0) ** k * math.exp(-decay * k * math.pi / w) for k in range(1, 8)]
    assert [event["value"] for event in turns] == pytest.approx(swings, rel=1e-12)
    first = (math.pi - math.atan2(w, decay)) / w
    assert [event["t"] for event in crossings] == pytest.approx([first + k * math.pi / w for k in range(8)], abs=1e-13)


# Do simple mechanisms move as their closed forms say?

SLOPE = math.radians(20.0)
GROUND = Body("ground", "fixed", loops=(Loop((Line(9.0, 0.0, -9.0, 0.0),), closed=False),))


def turned_gravity(slope: float, gravity: float = 9.81) -> tuple[float, float]:
    """The plane lies along x, downhill towards +x."""
    return gravity * math.sin(slope), -gravity * math.cos(slope)


def run(scene: Scene) -> Trajectory:
    done = simulate(scene)
    assert done.stop == Stop.DURATION
    assert done.worst_penetration < 1e-9
    assert abs(done.energy["residual_relative"]) < 1e-8
    return done


@pytest.mark.parametrize("viscous", [1.5, 20.0, 31.0], ids=["underdamped", "critical", "overdamped"])
@pytest.mark.parametrize("tolerance", [1e-8, 1e-11])
def test_damped_oscillator(viscous: float, tolerance: float) -> None:
    truth = oscillator.Oscillator(2.0, 50.0, viscous, 3.0, 0.2)
    scene = Scene(
        "oscillator",
        (Body("rotor", angle=0.7, velocity=(-1.1,), inertia=truth.inertia),),
        springs=(Spring("rotor", truth.stiffness, truth.rest),),
        torques=(Torque("rotor", truth.torque),),
        damping=(Damping("rotor", truth.viscous),),
        duration=1.7,
        tolerance=tolerance,
    )
    q, u = run(scene).at(1.7)
    assert (q[0], u[0]) == pytest.approx(oscillator.motion(truth, 0.7, -1.1, 1.7), abs=10.0 * tolerance)


@pytest.mark.parametrize("cubic", [4.0, 0.3, -0.8])
@pytest.mark.parametrize("amplitude", [0.4, 4.7])
def test_spring_whose_stiffness_changes_with_the_angle(cubic: float, amplitude: float) -> None:
    """Place, period and energy of Duffing's oscillator; between its rows, too. The twin comes to it in second order."""
    inertia, stiffness, rest = 0.7, 30.0, 0.2
    scene = Scene(
        "rotor",
        (Body("rotor", angle=rest + amplitude, inertia=inertia),),
        springs=(Spring("rotor", stiffness, rest, cubic=cubic),),
        duration=10.0,
        tolerance=1e-12,
    )
    done = run(scene)
    for t in (0.1234, 3.21, 10.0):
        q, u = done.at(t)
        angle, rate = duffing.swing(t, amplitude, inertia, stiffness, cubic)
        assert (q[0] - rest, u[0]) == pytest.approx((angle, rate), abs=1e-8)
    turns = done.events[done.events["kind"] == EventKind.TURN]["t"]
    truth = duffing.period(amplitude, inertia, stiffness, cubic)
    assert np.diff(turns)[:8] == pytest.approx(np.full(8, 0.5 * truth), rel=1e-9)
    end = duffing.swing(1.0, amplitude, inertia, stiffness, cubic)[0]
    steps = (2e-3, 1e-3)
    twins = [simulate(scene, 1.0, method="moreau", step=step) for step in steps]
    off = [abs(twin.q[-1][0] - rest - end) for twin in twins]
    stored = 0.5 * stiffness * amplitude**2 + 0.25 * cubic * amplitude**4
    for one in (done, *twins):
        assert one.energy["in_J"] == 0.0 and abs(one.energy["residual_J"]) < 1e-9 * stored
    assert off[1] < 1e-3 * amplitude and 3.5 < off[0] / off[1] < 4.5


@pytest.mark.parametrize("amplitude", [0.3, 2.5])
def test_pendulum(amplitude: float) -> None:
    length = 0.02
    bob = Body("bob", angle=amplitude, mass=1e-3, inertia=1e-3 * length**2, centre_of_mass=(0.0, -length))
    done = run(Scene("pendulum", (bob,), gravity=(0.0, -9.81), duration=1.3, tolerance=1e-11))
    q, u = done.at(1.3)
    angle, rate = pendulum.swing(1.3, amplitude, math.sqrt(9.81 / length))
    assert q[0] == pytest.approx(angle, abs=1e-8)
    assert u[0] == pytest.approx(rate, abs=1e-7)


def brick(mass: float = 0.3, half_width: float = 0.05, half_height: float = 0.02, speed: float = 2.0) -> Body:
    """A block on its flat side, pushed uphill."""
    w, h = half_width, half_height
    corners = [(w, h), (-w, h), (-w, -h), (w, -h)]
    sides = tuple(Line(*corners[i], *corners[(i + 1) % 4]) for i in range(4))
    inertia = mass * (4.0 * w * w + 4.0 * h * h) / 12.0
    return Body("brick", "free", (0.0, h), velocity=(-speed, 0.0, 0.0), mass=mass, inertia=inertia, loops=(Loop(sides),))


@pytest.mark.parametrize(("mu", "stays"), [(0.5, True), (0.3, False), (0.0, False)])
def test_block_pushed_uphill(mu: float, stays: bool) -> None:
    """Two corners on one line: the forces are not unique, the motion is."""
    scene = Scene(
        "block",
        (brick(), GROUND),
        contacts=(Contact((Side("brick"), Side("ground")), friction=mu),),
        gravity=turned_gravity(SLOPE),
        duration=1.5,
    )
    done = run(scene)
    for t in (0.1, block.stops_at(2.0, mu, SLOPE), 0.6, 1.5):
        way, rate = block.block(t, 2.0, mu, SLOPE)
        q, u = done.at(t)
        assert -q[0] == pytest.approx(way, rel=1e-9, abs=1e-10)
        assert -u[0] == pytest.approx(rate, rel=1e-9, abs=1e-9)
        assert q[1] == pytest.approx(0.02, abs=1e-12)
        assert q[2] == pytest.approx(0.0, abs=1e-10)
    sticks = done.events[done.events["kind"] == EventKind.STICK]["t"]
    assert bool(len(sticks)) is stays
    if stays:
        assert sticks[0] == pytest.approx(block.stops_at(2.0, mu, SLOPE), rel=1e-9)


@pytest.mark.parametrize(("v0", "spin0"), [(2.0, 0.0), (0.0, 60.0), (0.5, -60.0)], ids=["pushed", "spun", "backspin"])
@pytest.mark.parametrize("slope", [0.0, SLOPE], ids=["level", "incline"])
def test_disc_slides_until_it_rolls(v0: float, spin0: float, slope: float) -> None:
    truth = rolling.Disc(0.05, 0.3, slope)
    disc = Body(
        "disc",
        "free",
        (0.0, truth.radius),
        velocity=(v0, 0.0, -spin0),
        mass=1.0,
        inertia=truth.kappa * truth.radius**2,
        loops=(Loop((Arc(0.0, 0.0, truth.radius, 0.0, TURN),)),),
    )
    scene = Scene(
        "disc",
        (disc, GROUND),
        contacts=(Contact((Side("disc"), Side("ground")), friction=truth.mu),),
        gravity=turned_gravity(slope),
        duration=1.5,
    )
    done = run(scene)
    for t in (0.1, 0.5, 1.5):
        q, u = done.at(t)
        state = rolling.motion(truth, v0, spin0, t)
        assert (q[0], -q[2], u[0], -u[2]) == pytest.approx(state, rel=1e-9, abs=1e-8)
    end = rolling.slip_ends(truth, v0, spin0)
    sticks = done.events[done.events["kind"] == EventKind.STICK]["t"]
    assert len(sticks) == 1
    assert sticks[0] == pytest.approx(end, rel=1e-8)


# Do torque tables, quadratic damping, and gravity on an excentric rotor move a body as scipy says?

J = 0.4
ANGLES = ((-1.0, 0.5), (0.0, -1.0), (0.7, 2.0), (3.0, -2.5))
TIMES = ((0.2, 1.0), (0.9, -2.0), (1.6, 0.5))


def truth(force: Callable[[float, float, float], float], start: tuple[float, float], t: float) -> np.ndarray:
    """Integrated in many pieces, so that no kink of a table is stepped over."""
    y = np.array(start)
    for a, b in zip(np.linspace(0.0, t, 401)[:-1], np.linspace(0.0, t, 401)[1:], strict=True):
        y = solve_ivp(lambda s, z: (z[1], force(s, *z) / J), (a, b), y, method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    return y


def run_forces_in_motion(start: tuple[float, float], t: float, **forces):
    body = Body("rotor", "pivot", (0.0, 0.0), start[0], (start[1],), inertia=J)
    return simulate(Scene("rotor", (body,), **forces), t, 1e-11)


def table(points: tuple[tuple[float, float], ...], x: float) -> float:
    return float(np.interp(x, *zip(*points, strict=True)))


def test_table_over_angle() -> None:
    done = run_forces_in_motion((-1.4, 2.0), 2.0, torques=(Torque("rotor", over="angle", table=ANGLES),))
    expected = truth(lambda t, q, u: table(ANGLES, q), (-1.4, 2.0), 2.0)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(tuple(expected), abs=1e-8)
    assert done.energy["residual_relative"] < 1e-8


def test_table_over_time() -> None:
    done = run_forces_in_motion(
        (0.3, 0.0), 2.0, torques=(Torque("rotor", over="time", table=TIMES),), springs=(Spring("rotor", 3.0, 0.1),)
    )
    expected = truth(lambda t, q, u: table(TIMES, t) - 3.0 * (q - 0.1), (0.3, 0.0), 2.0)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(tuple(expected), abs=1e-8)
    assert done.energy["residual_relative"] < 1e-8


def test_a_short_pulse_is_not_stepped_over() -> None:
    """A rotor at rest gets one pulse of a millisecond in the middle of a long run."""
    pulse = ((0.0, 0.0), (7.3, 0.0), (7.3005, 100.0), (7.301, 0.0), (20.0, 0.0))
    done = run_forces_in_motion((0.0, 0.0), 10.0, torques=(Torque("rotor", over="time", table=pulse),))
    assert done.u[-1][0] == pytest.approx(0.05 / J, rel=1e-6)


def test_quadratic_damping() -> None:
    """Without anything else u = u0 / (1 + c u0 t / J), q its integral; both ways."""
    for u0 in (5.0, -5.0):
        done = run_forces_in_motion((0.0, u0), 3.0, damping=(Damping("rotor", 0.0, 0.7),))
        k = 0.7 * abs(u0) / J
        assert done.u[-1][0] == pytest.approx(u0 / (1.0 + 3.0 * k), rel=1e-9)
        assert done.q[-1][0] == pytest.approx(math.copysign(J / 0.7, u0) * math.log1p(3.0 * k), rel=1e-9)
        assert done.energy["dissipated"]["damping"] == pytest.approx(0.5 * J * (25.0 - done.u[-1][0] ** 2), rel=1e-9)


def test_all_kinds_of_damping_on_a_spring() -> None:
    done = run_forces_in_motion((1.0, 0.0), 3.0, damping=(Damping("rotor", 0.05, 0.1),), springs=(Spring("rotor", 9.0),))
    expected = truth(lambda t, q, u: -9.0 * q - 0.05 * u - 0.1 * u * abs(u), (1.0, 0.0), 3.0)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(tuple(expected), abs=1e-8)


def hanging(**more) -> Body:
    """A pendulum along -y at angle 0: its centre of mass lies 0.3 m below the pivot. w² = m g l / J = 9."""
    return Body("rotor", "pivot", (0.2, 0.1), mass=2.0, inertia=2.0 * 9.81 * 0.3 / 9.0, centre_of_mass=(0.0, -0.3), **more)


@pytest.mark.parametrize("amplitude", [0.1, 1.5, 3.0])
def test_gravity_pendulum(amplitude: float) -> None:
    done = simulate(Scene("pendulum", (hanging(angle=amplitude),), gravity=(0.0, -9.81)), 5.0, 1e-12)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(pendulum.swing(5.0, amplitude, 3.0), abs=1e-8)
    assert abs(done.energy["residual_J"]) < 1e-10


def test_gravity_from_another_side() -> None:
    """Gravity along +x: the pendulum swings about +90 degrees."""
    done = simulate(Scene("pendulum", (hanging(angle=0.5 * math.pi + 1.0),), gravity=(9.81, 0.0)), 3.0, 1e-12)
    angle, rate = pendulum.swing(3.0, 1.0, 3.0)
    assert (done.q[-1][0] - 0.5 * math.pi, done.u[-1][0]) == pytest.approx((angle, rate), abs=1e-8)


def test_pendulum_against_a_stop() -> None:
    """Elliptic functions between impacts at the lowest point."""
    loop = tip(0.5)
    # The thorn points along +x at angle 0; a thin post stands where its flank is when the pendulum hangs down.
    flank = math.atan2(0.1, 0.7)
    radius, arm = 0.01, 0.5 * math.hypot(0.7, 0.1)
    body = hanging(angle=1.2, loops=(loop,))
    x, y = arm * math.cos(-flank), arm * math.sin(-flank)
    # Corner (0.7, -0.1) of the thorn meets the post from above at angle 0, where the corner moves along the tangent.
    post = Body("post", "fixed", (0.2 + x + radius * y / arm, 0.1 + y - radius * x / arm), loops=(circle(radius),))
    scene = Scene("pendulum", (body, post), contacts=touching("rotor", "post", restitution=0.6), gravity=(0.0, -9.81))
    done = simulate(scene, 2.5, 1e-12)
    times = [t for t in pendulum.touches(6, 1.2, 3.0, 0.6) if t < 2.5]
    assert [event["t"] for event in of_kind(done, EventKind.IMPACT)] == pytest.approx(times, abs=1e-8)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(pendulum.against_stop(2.5, 1.2, 3.0, 0.6), abs=1e-8)


# How much work is a run in which little happens?


def thrown(name: str, x: float, speed: float) -> Body:
    return Body(name, "free", position=(x, 0.0), velocity=(speed, 0.0, 1.0), mass=1e-3, inertia=1e-9, loops=(circle(5e-3),))


def test_a_run_far_beyond_its_scene_s_duration_takes_few_steps(tmp_path) -> None:
    """The steps grow with the time that has passed, from 0.2 ps to where the disc is."""
    line = ["run", str(PROFILES / "incline"), "--set", "run.duration=2e-13 s", "--no-plots"]
    for duration, name in (("20 ms", "long"), ("10 ms", "short")):
        assert main([*line, "--duration", duration, "--out", str(tmp_path / name)]) == 0
    counts = json.loads((tmp_path / "long" / "summary.json").read_text())["counts"]
    assert counts["flights"] + counts["steps"] < 60
    long, short = (read_results(tmp_path / name) for name in ("long", "short"))
    assert len(long.t) < 60
    assert np.array_equal(long.q[: len(short.t) - 1], short.q[:-1])
    assert long.q[-1, 1] == pytest.approx(0.15 - 0.5 * 9.21838460990976 * 0.02**2, rel=1e-13)


def test_bodies_far_apart_are_not_looked_at_contact_by_contact() -> None:
    """Discs that fall side by side for 5 s, and teeth that never come within reach of other teeth."""
    discs = tuple(thrown(f"d{k}", 0.1 * k, 0.01 * k) for k in range(4))
    wheel = Body(
        "wheel", position=(-0.1, 0.0), velocity=(50.0,), inertia=1e-9, loops=(tip(5e-3), tip(5e-3).moved(3.0, (0.0, 0.0)))
    )
    contacts = touching("d0", "d1") + touching("d1", "d2") + touching("d2", "d3") + touching("d0", "wheel")
    run = simulate(Scene("apart", (*discs, wheel), contacts=contacts, gravity=(0.0, -9.81), duration=5.0))
    assert run.stop == Stop.DURATION
    assert run.counts["gap_evaluations"] == 0 and run.counts["flights"] < 20


@pytest.mark.parametrize("teeth", [1, 12])
def test_bodies_that_come_from_afar_still_meet(teeth: int) -> None:
    """At the place and time of the closed form; with twelve tips each, many contacts but no cells either."""
    loops = (circle(5e-3),) if teeth == 1 else tuple(tip(5e-3).moved(k * TURN / teeth, (0.0, 0.0)) for k in range(teeth))
    bodies = tuple(
        dataclasses.replace(thrown(name, x, u), loops=loops, velocity=(u, 0.0, 0.0))
        for name, x, u in (("a", 0.0, 1.0), ("b", 2.0, -0.5))
    )
    run = simulate(Scene("met", bodies, contacts=touching("a", "b", restitution=1.0), gravity=(0.0, -9.81), duration=2.0))
    impacts = of_kind(run, EventKind.IMPACT)
    assert impacts[0]["t"] == pytest.approx((2.0 - 0.01) / 1.5, rel=1e-9)
    assert run.counts["gap_evaluations"] < 20000
