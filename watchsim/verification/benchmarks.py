"""Which scenes have exact solutions, and what are they?"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Contact, Damping, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory
from watchsim.verification.checks import (
    Damped,
    Incline,
    Stopped,
    damped_state,
    incline_state,
    stopped_state,
    touch_times,
    turning_time,
)

TOLERANCE = 1e-9
BETWEEN_ROWS = 1e-7  # where a curved motion is interpolated between two accepted steps
INCLINES = (("scene.toml", 0.3), ("scene_mu013.toml", 0.13), ("scene_mu010.toml", 0.10))
INCLINE_TIMES = (0.5, 1.0, 2.0, 3.0)
INCLINE_EXACT = 1e-10
Measure = Callable[[Trajectory], float]


@dataclass(frozen=True)
class Check:
    """One number of a run. The tolerance is relative to `expected`, absolute where that is zero."""

    quantity: str
    expected: float
    measure: Measure
    tolerance: float = TOLERANCE


@dataclass(frozen=True)
class Benchmark:
    """A scene, the numbers it must give, and where they come from."""

    name: str
    scene: Scene
    checks: tuple[Check, ...]
    source: str


def inclines() -> list[Benchmark]:
    """The disc on the incline: its three frictions read from the profiles, and none."""
    folder = profiles_dir() / "incline"
    source = "closed form (geometric series), watchsim/verification/checks.py"
    scenes = [(mu, load(folder / file)) for file, mu in INCLINES]
    rough = scenes[0][1]
    scenes.append((0.0, replace(rough, contacts=tuple(replace(contact, friction=0.0) for contact in rough.contacts))))
    return [Benchmark(f"incline, friction {mu:g}", scene, _incline_checks(Incline(mu)), source) for mu, scene in scenes]


def swings() -> list[Benchmark]:
    """A damped balance under a constant torque, and a pendulum against a stop."""
    return [_damped_balance(), _pendulum_against_stop()]


def _incline_checks(case: Incline) -> tuple[Check, ...]:
    checks = [Check("accumulation of the bounces [s]", case.accumulation, value_of(EventKind.ACCUMULATION, 1), INCLINE_EXACT)]
    if case.accumulation < case.rolling_begins < math.inf:
        checks.append(Check("rolling begins [s]", case.rolling_begins, time_of(EventKind.STICK, -1), INCLINE_EXACT))
    for t in INCLINE_TIMES:
        state = incline_state(case, t)
        checks += [
            Check(f"x at {t:g} s [m]", state.x, coordinate(0, t), INCLINE_EXACT),
            Check(f"angle at {t:g} s [rad]", state.angle, coordinate(2, t), INCLINE_EXACT),
            Check(f"spin at {t:g} s [rad/s]", state.spin, rate(2, t), INCLINE_EXACT),
        ]
    return (*checks, Check("energy lost [J]", _energy_lost(case, INCLINE_TIMES[-1]), _dissipated), *soundness())


def _energy_lost(case: Incline, t: float) -> float:
    """What gravity gave a disc of 1 kg and motion does not have."""
    state = incline_state(case, t)
    given = case.pull * state.x + case.press * (case.drop + case.radius - state.y)
    return given - 0.5 * (state.v_x**2 + state.v_y**2) - 0.5 * case.kappa * (case.radius * state.spin) ** 2


def _damped_balance() -> Benchmark:
    case = Damped(inertia=1.2e-9, stiffness=7.58e-7, viscous=6e-10, torque=2e-8, angle=4.7, rate=10.0)
    balance = Body("balance", angle=case.angle, velocity=(case.rate,), inertia=case.inertia)
    scene = Scene(
        "damped balance",
        (balance,),
        springs=(Spring("balance", case.stiffness),),
        torques=(Torque("balance", case.torque),),
        damping=(Damping("balance", case.viscous),),
        duration=2.0,
    )
    turn = turning_time(case, 12)
    checks = [
        Check("twelfth turning point [s]", turn, time_of(EventKind.TURN, 12)),
        Check("angle there [rad]", damped_state(case, turn)[0], value_of(EventKind.TURN, 12)),
        *_state_checks(damped_state(case, scene.duration), scene.duration),
        *_state_checks(damped_state(case, 0.77), 0.77, BETWEEN_ROWS),
    ]
    source = "textbook solution, watchsim/verification/checks.py"
    return Benchmark("damped balance under a constant torque", scene, (*checks, *soundness()), source)


def _pendulum_against_stop(length: float = 0.02, bob: float = 0.002, gravity: float = 9.81) -> Benchmark:
    """A round bob on a massless rod, hanging against an upright wall when at rest."""
    case = Stopped(w=math.sqrt(gravity / length), angle=1.3, restitution=0.7)
    mass = 1e-3
    disc = Loop((Arc(0.0, -length, bob, 0.0, TURN),), "BOB")
    wall = Loop((Line(-bob, -2.0 * length, -bob, 0.0),), "WALL", closed=False)
    pendulum = Body(
        "pendulum", angle=case.angle, mass=mass, inertia=mass * length**2, centre_of_mass=(0.0, -length), loops=(disc,)
    )
    scene = Scene(
        "pendulum against a stop",
        (pendulum, Body("stop", "fixed", loops=(wall,))),
        contacts=(Contact((Side("pendulum"), Side("stop")), restitution=case.restitution),),
        gravity=(0.0, -gravity),
        duration=1.0,
        tolerance=1e-11,
    )
    checks = [
        *(Check(f"touch {k} [s]", touch_times(case, k)[-1], time_of(EventKind.IMPACT, k)) for k in (1, 3, 6)),
        *_state_checks(stopped_state(case, scene.duration), scene.duration),
        *_state_checks(stopped_state(case, 0.05), 0.05, BETWEEN_ROWS),
    ]
    source = "elliptic functions, watchsim/verification/checks.py"
    return Benchmark("pendulum against a stop", scene, (*checks, *soundness()), source)


def _state_checks(state: tuple[float, float], t: float, tolerance: float = TOLERANCE) -> tuple[Check, ...]:
    """Angle and rate of the only moving body at time t."""
    return (
        Check(f"angle at {t:g} s [rad]", state[0], coordinate(0, t), tolerance),
        Check(f"rate at {t:g} s [rad/s]", state[1], rate(0, t), tolerance),
    )


def soundness(ledger: float = 1e-8) -> tuple[Check, ...]:
    """What every run must keep: its energy ledger, and bodies that stay out of each other."""
    return (
        Check(
            "energy ledger, residual over its largest entry", 0.0, lambda run: float(run.energy["residual_relative"]), ledger
        ),
        Check("worst penetration [m]", 0.0, lambda run: run.worst_penetration, 1e-9),
    )


def coordinate(column: int, t: float) -> Measure:
    return lambda run: float(run.at(t)[0][column])


def rate(column: int, t: float) -> Measure:
    return lambda run: float(run.at(t)[1][column])


def _dissipated(run: Trajectory) -> float:
    return float(sum(run.energy["dissipated"].values()))


def time_of(kind: EventKind, number: int) -> Measure:
    """Time of the `number`-th event of a kind, counted from 1; -1 is the last."""
    return lambda run: picked(run, kind, "t", number)


def value_of(kind: EventKind, number: int) -> Measure:
    return lambda run: picked(run, kind, "value", number)


def count_of(kind: EventKind, until: float = math.inf) -> Measure:
    """Number of events of a kind up to the time `until` (s)."""
    return lambda run: float(((run.events["kind"] == kind) & (run.events["t"] <= until)).sum())


def picked(run: Trajectory, kind: EventKind, column: str, number: int) -> float:
    """A column of the `number`-th event of a kind, counted from 1, -1 the last; nan where there are fewer."""
    values = run.events[run.events["kind"] == kind][column]
    if abs(number) > len(values):
        return math.nan
    return float(values[number - 1 if number > 0 else number])
