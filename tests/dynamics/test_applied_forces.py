"""Do springs between points and repeated torques push every coordinate as their length and table say?"""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from pair_scenes import body_pose
from plain_kernels import in_python

from watchsim.dynamics.forces import (
    add_line_springs,
    damping_power,
    drive_power,
    forces,
    line_spring_damping,
    line_spring_energies,
    line_spring_powers,
    next_knot,
    stored_energy,
)
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.model import COORDINATE, DAMPING_LAWS, JOINT, OVER_ANGLE, OVER_TIME, REPEATED, TABLE, records, resistance
from watchsim.scene.forces import Damping, LineSpring, Torque
from watchsim.scene.keys import DAMPING as DAMPING_KEYS
from watchsim.scene.scene import Body, Geared, Scene, swing

# Do a spring and a damper between two points push every coordinate as their length says?

_forces = callable_kernel(forces)
BODIES = (
    Body("wheel", "pivot", (0.3, 0.1), inertia=1.0),
    Body("slide", "slide", (-1.0, 0.4), 0.6, axis=(0.6, 0.8), mass=1.0),
    Body("free", "free", (1.0, -1.0), mass=1.0, inertia=1.0),
)
ENDS = {"wheel": (0.7, 0.2), "slide": (-0.1, 0.3), "free": (0.2, 0.5), None: (2.0, 2.0)}
STIFFNESS, LENGTH, VISCOUS = 3.0, 0.8, 0.4
LINE = LineSpring(("wheel", "slide"), (ENDS["wheel"], ENDS["slide"]), STIFFNESS, LENGTH, VISCOUS)


def length(scene: Scene, pair: tuple[str, str | None], q: np.ndarray) -> float:
    """Between the two points at q, by plane geometry."""
    places = []
    for name in pair:
        (px, py), (x, y, turn) = ENDS[name], (0.0, 0.0, 0.0) if name is None else body_pose(scene, name, q)
        places.append((x + math.cos(turn) * px - math.sin(turn) * py, y + math.sin(turn) * px + math.cos(turn) * py))
    return math.dist(*places)


@pytest.mark.parametrize("pair", [("wheel", "slide"), ("free", "wheel"), ("slide", "free"), ("free", None)])
def test_the_force_is_the_slope_of_the_length_times_pull_and_drag(pair: tuple[str, str | None]) -> None:
    """-(k (L - L0) + c L') dL/dq, with quotients of the length."""
    spring = LineSpring(pair, (ENDS[pair[0]], ENDS[pair[1]]), STIFFNESS, LENGTH, VISCOUS)
    scene = Scene("springs", BODIES, line_springs=(spring,))
    model, rng, h = compile_scene(scene).model, np.random.default_rng(6), 1e-5
    for _ in range(5):
        q, u, out = rng.uniform(-1.0, 1.0, 5), rng.uniform(-2.0, 2.0, 5), np.zeros(5)
        steps = h * np.eye(5)
        slope = np.array([length(scene, pair, q + step) - length(scene, pair, q - step) for step in steps]) / (2.0 * h)
        _forces(model, 0.0, q, u, out)
        pull = STIFFNESS * (length(scene, pair, q) - LENGTH) + VISCOUS * float(slope @ u)
        assert out == pytest.approx(-pull * slope, abs=1e-8)


@pytest.mark.parametrize("body", [0, 1])
@pytest.mark.parametrize("ratio", [1.0, -2.5, 0.4])
def test_a_geared_body_feels_the_spring_by_its_ratio(body: int, ratio: float) -> None:
    model = compile_scene(Scene("springs", BODIES, line_springs=(LINE,))).model
    bodies = model.bodies.copy()
    bodies["ratio"][body] = ratio
    model = model._replace(bodies=bodies)
    q, u, out, h = np.array([0.4, -0.3, 0.1, 0.2, 0.5]), np.zeros(5), np.zeros(5), 1e-5
    in_python(add_line_springs)(model, q, u, out)
    energies = np.zeros(10)
    in_python(line_spring_energies)(model, q + h * np.concatenate((np.eye(5), -np.eye(5))), energies)
    slope = (energies[:5] - energies[5:]) / (2.0 * h)
    assert out == pytest.approx(-slope, abs=1e-8) and np.all(np.abs(out[:2]) > 0.01)


def test_power_taken_held_and_given_to_bodies_is_what_the_energy_of_all_springs_loses() -> None:
    """dE/dt by quotients; the slide is driven, so what its spring does is held against, not felt."""
    driven = replace(BODIES[1], prescribed=swing(0.0, 1.0, 1.0, 0.0)[0])
    springs = tuple(
        LineSpring(pair, (ENDS[pair[0]], ENDS[pair[1]]), STIFFNESS * (1 + k), LENGTH, VISCOUS / (1 + k))
        for k, pair in enumerate([("wheel", "slide"), ("free", "wheel"), ("slide", None), ("free", "slide")])
    )
    scene = Scene("springs", (BODIES[0], driven, BODIES[2]), line_springs=springs)
    model, rng, h = compile_scene(scene).model, np.random.default_rng(7), 1e-6
    free = np.flatnonzero(model.coordinates.driven == 0)
    q, u = rng.uniform(-1.0, 1.0, (6, 5)), rng.uniform(-2.0, 2.0, (6, 5))
    energies = np.zeros((3, 6))
    for row, shift in enumerate((-h, 0.0, h)):
        in_python(line_spring_energies)(model, q + shift * u, energies[row])
    taken, held, felt = np.zeros((6, 4)), np.zeros(6), np.zeros((6, 5))
    in_python(line_spring_powers)(model, q, u, taken, held)
    for row in range(6):
        in_python(add_line_springs)(model, q[row], u[row], felt[row])
        rates = [
            (length(scene, one.between, q[row] + h * u[row]) - length(scene, one.between, q[row] - h * u[row])) / (2.0 * h)
            for one in springs
        ]
        assert taken[row] == pytest.approx([one.viscous * rate**2 for one, rate in zip(springs, rates, strict=True)], abs=1e-7)
        assert in_python(line_spring_damping)(model, q[row], u[row]) == pytest.approx(taken[row].sum())
        stretched = [0.5 * one.stiffness * (length(scene, one.between, q[row]) - one.length) ** 2 for one in springs]
        assert energies[1, row] == pytest.approx(sum(stretched))
    given = (felt[:, free] * u[:, free]).sum(axis=1)
    assert (energies[2] - energies[0]) / (2.0 * h) == pytest.approx(held - given - taken.sum(axis=1), abs=1e-6)
    assert np.abs(held).min() > 0.01 and len(free) == 4 and np.all(felt[:, np.setdiff1d(range(5), free)] == 0.0)


# Does a torque over time that repeats act, at any time, as the table says, and when is its next knot?


@pytest.mark.parametrize("begins", [0.0, 0.4, -1.3])
def test_the_value_is_that_of_the_first_period(begins: float) -> None:
    """Against numpy's interpolation of the table written out nine times over; knots and times before it, too."""
    rng = np.random.default_rng(4)
    at = begins + np.append(np.cumsum(rng.uniform(0.1, 0.5, 6)) - 0.1, [])
    values = rng.uniform(-1.0, 1.0, 6)
    values[-1] = values[0]
    period = float(at[-1] - at[0])
    table = tuple(zip(at.tolist(), values.tolist(), strict=True))
    torque = Torque("wheel", over="time", table=table, period=period)
    model = compile_scene(Scene("repeated", (Body("wheel", inertia=1.0),), torques=(torque,))).model
    long = np.concatenate([at[:-1] + k * period for k in range(-4, 5)])
    told = np.tile(values[:-1], 9)
    for t in (*rng.uniform(at[0] - 2.0 * period, at[0] + 4.0 * period, 40), *(at[2] + period * np.arange(-1, 3))):
        h = np.zeros(1)
        _forces(model, float(t), np.zeros(1), np.zeros(1), h)
        assert h[0] == pytest.approx(np.interp(t, long, told), abs=1e-12)


TIMES = {"over time": (0.5, 1.25, 2.0, 4.0), "repeated": (-0.25, 0.75, 1.0, 2.75), "over an angle": (0.1, 0.2, 0.3)}


def following(t: float, *names: str) -> float:
    """The first knot of these tables after t, by looking through three hundred periods of each."""
    knots = [TIMES[name] for name in names if name == "over time"]
    knots += [tuple(one + 3.0 * k for one in TIMES["repeated"]) for k in range(-3, 300) if "repeated" in names]
    return min((knot for some in knots for knot in some if knot > t * (1.0 + 2e-15)), default=math.inf)


@pytest.mark.parametrize("names", [("over time",), ("repeated",), ("over an angle", "repeated"), ("repeated", "over time")])
def test_the_next_knot_is_the_first_one_after_now(names: tuple[str, ...]) -> None:
    """Also at knots, which have been passed, to rounding; of a repeated table in any of its periods."""
    over = {"over time": "time", "repeated": "time", "over an angle": "angle"}
    torques = tuple(
        Torque("wheel", over=over[name], table=tuple((t, 0.0) for t in TIMES[name]), period=3.0 if name == "repeated" else None)
        for name in names
    )
    model = compile_scene(Scene("knots", (Body("wheel", inertia=1.0),), torques=torques)).model
    after = in_python(next_knot)
    times = [
        *np.linspace(0.0, 9.0, 37),
        *(1e2 + np.linspace(0.0, 3.0, 25)),
        *(TIMES["repeated"][1] + 3.0 * np.arange(0, 200, 7)),
    ]
    for t in times:
        for now in (t, float(np.nextafter(t, 0.0)), float(np.nextafter(t, 1e9))):
            assert after(model, now) == pytest.approx(following(now, *names), rel=1e-14)


@pytest.mark.parametrize(("law", "power"), DAMPING_LAWS.items())
def test_a_law_of_damping_has_a_key_and_a_field_and_goes_with_its_power_of_the_speed(law: str, power: int) -> None:
    row, key, speed, ratio = records(COORDINATE, 1)[0], DAMPING_KEYS[law], 1.7, 3.0
    row[law] = 0.2
    assert resistance(row, speed) * speed == pytest.approx(0.2 * speed**power, rel=1e-14)
    assert (
        key.dimension is not None and key.linear is not None and key.linear.powers[0][2] == power - 2
    )  # a force by speed^power
    wheel, fly = (Body(name, "pivot", inertia=1.0) for name in ("wheel", "fly"))
    made = compile_scene(
        Scene("geared", (wheel, replace(fly, geared=Geared("wheel", ratio))), damping=(Damping("fly", **{law: 0.2}),))
    )
    assert made.model.coordinates[0][law] == pytest.approx(0.2 * ratio ** (power + 1), rel=1e-14)  # the same power is taken


# Are forces, powers and energies those of the words of the model, with everything in it at once?

N, DRIVEN, T = 5, 3, 1.7
KNOTS = np.array([[0.5, 0.3], [1.1, -0.4], [2.3, 0.9], [3.4, 0.3]])
FORCES, DRIVE, DAMPING, STORED = (in_python(one) for one in (forces, drive_power, damping_power, stored_energy))


def everything(rng: np.random.Generator) -> SimpleNamespace:
    """Sprung, damped and weighted coordinates, one of them driven; joints and tables that act back on others, driven or not."""
    c, joints, tables = records(COORDINATE, N), records(JOINT, 2), records(TABLE, 4)
    for name in ("mass", "force", "viscous", "quadratic", "stiffness", "rest", "weight_x", "weight_y"):
        c[name][:] = rng.uniform(0.2, 2.0, N)
    c.driven[DRIVEN], c.mass[DRIVEN] = 1, 1.0
    for name in ("viscous", "quadratic", "stiffness", "weight_x", "weight_y"):
        c[name][DRIVEN] = 0.0
    c.weight_x[0], c.weight_y[1] = 0.0, 0.0
    joints.coordinate, joints.on = [0, 2], [1, DRIVEN]
    for name in ("force", "viscous", "quadratic", "stiffness", "rest"):
        joints[name][:] = rng.uniform(0.2, 2.0, 2)
    tables.coordinate, tables.on = [4, 1, 2, 0], [-1, 0, DRIVEN, -1]
    tables.over, tables.start, tables.count = [OVER_TIME, OVER_ANGLE, REPEATED, OVER_ANGLE], 1, 4
    return SimpleNamespace(
        coordinates=c, joints=joints, tables=tables, lines=(), shocks=(), knots=np.vstack([[9.0, 9.0], KNOTS, [7.0, 7.0]])
    )


def told(made: SimpleNamespace, j: int, q: np.ndarray) -> float:
    table = made.tables[j]
    at = {OVER_TIME: T, REPEATED: 0.5 + (T - 0.5) % 2.9}.get(int(table.over))
    if at is None:
        at = q[table.coordinate] - (q[table.on] if table.on >= 0 else 0.0)
    return float(np.interp(at, KNOTS[:, 0], KNOTS[:, 1]))


@pytest.mark.parametrize("seed", range(8))
def test_every_coordinate_feels_what_acts_on_it_and_back_on_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    made, q, u = everything(rng), 2.0 * rng.normal(size=N), rng.normal(size=N)
    c, j, out = made.coordinates, made.joints, np.full(N, np.nan)
    FORCES(made, T, q, u, out)
    expected = c.force + np.cos(q) * c.weight_y - np.sin(q) * c.weight_x - c.stiffness * (q - c.rest)
    expected -= c.viscous * u + c.quadratic * u * np.abs(u)
    speed = u[j.coordinate] - u[j.on]
    torque = (
        j.force - j.stiffness * (q[j.coordinate] - q[j.on] - j.rest) - j.viscous * speed - j.quadratic * speed * np.abs(speed)
    )
    acts = [*zip(j.coordinate, j.on, torque, strict=True)]
    acts += [(table.coordinate, table.on, told(made, k, q)) for k, table in enumerate(made.tables)]
    for on_one, on_other, force in acts:
        expected[on_one] += force
        if on_other not in (-1, DRIVEN):
            expected[on_other] -= force
    assert out == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(8))
def test_power_put_in_less_what_damping_takes_is_what_the_stored_energy_gains(seed: int) -> None:
    """Where free coordinates move as forces make them; by central quotients."""
    rng = np.random.default_rng(seed)
    made, q, u, out, h = everything(rng), rng.normal(size=N), rng.normal(size=N), np.zeros(N), 1e-5
    FORCES(made, T, q, u, out)
    a = out / made.coordinates.mass
    after, before = (STORED(made, q + s * u + 0.5 * s * s * a, u + s * a) for s in (h, -h))
    assert DRIVE(made, T, q, u) - DAMPING(made, q, u) == pytest.approx((after - before) / (2.0 * h), rel=1e-7)
    assert DAMPING(made, q, u) > 0.0


def test_stored_is_kinetic_energy_and_that_of_springs() -> None:
    rng = np.random.default_rng(3)
    made, q, u = everything(rng), rng.normal(size=N), rng.normal(size=N)
    c, j, free = made.coordinates, made.joints, np.arange(N) != DRIVEN
    expected = 0.5 * (c.mass * u**2 + c.stiffness * (q - c.rest) ** 2)[free].sum()
    expected += 0.5 * (j.stiffness * (q[j.coordinate] - q[j.on] - j.rest) ** 2).sum()
    assert STORED(made, q, u) == pytest.approx(expected)
