"""Are work, losses and efficiency the integrals of their powers, whatever forces act?"""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import Events, balance_only, lever_scene
from numpy.polynomial import Polynomial
from scipy.integrate import quad

from watchsim.analysis.flows import Flows, efficiency, flows, work_of_gravity
from watchsim.analysis.summary import summary
from watchsim.analysis.timing import beats
from watchsim.mechanism.compile import compile_scene
from watchsim.model import (
    BEARING,
    BODY,
    BODY_PAIR,
    COIL,
    CONTACT,
    COORDINATE,
    JOINT,
    LAW,
    LINE_SPRING,
    OVER_ANGLE,
    OVER_TIME,
    PRIMITIVE,
    REPEATED,
    SHOCK,
    TABLE,
    WEIGHED,
    Model,
    records,
)
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Damping, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate

# What is a model made up of a few coordinates, joints and tables?


def model_of(**parts: Any) -> Any:
    """`coordinates`: {field: values by coordinate}; `joints`, `tables`: lists of {field: value}; tables bring their knots."""
    none = {"bodies": BODY, "lines": LINE_SPRING, "bearings": BEARING, "primitives": PRIMITIVE, "contacts": CONTACT}
    none |= {"laws": LAW, "pairs": BODY_PAIR, "shocks": SHOCK, "weighed": WEIGHED, "coils": COIL}
    made: dict[str, Any] = {name: records(dtype, 0) for name, dtype in none.items()} | {"near": np.zeros(0, np.int64)}
    made["jolts"], made["windings"] = np.zeros((0, 6)), np.zeros((0, 4))
    made["coordinates"] = records(COORDINATE, len(parts["coordinates"]["mass"]))
    for name, values in parts["coordinates"].items():
        made["coordinates"][name] = values
    joints, tables = parts.get("joints", []), parts.get("tables", [])
    made["joints"], made["tables"] = records(JOINT, len(joints)), records(TABLE, len(tables))
    for i, joint in enumerate(joints):
        for name, value in joint.items():
            made["joints"][name][i] = value
    knots = [knot for table in tables for knot in table["knots"]]
    for i, table in enumerate(tables):
        start = sum(len(one["knots"]) for one in tables[:i])
        row = {"on": -1, **{name: value for name, value in table.items() if name != "knots"}}
        for name, value in (row | {"start": start, "count": len(table["knots"])}).items():
            made["tables"][name][i] = value
    return Model(**made, knots=np.array(knots, float).reshape(-1, 2))


# Is the share of the drive's work that reaches the oscillator what the account says, and when is there none?


@pytest.mark.parametrize(
    ("profile", "duration"), [("swiss_lever", 4.0), ("swiss_lever", 30.0), ("recoil_anchor", 20.0), ("detent", 8.0)]
)
def test_the_share_is_of_the_window_of_amplitude_and_rate(profile: str, duration: float) -> None:
    """Against the accounts of two runs that end at its first and last turning point: what was damped, and what was gained."""
    scene = replace(load(profiles_dir() / profile), expect=())
    run = simulate(scene, duration, record="all")
    found, (start, end) = beats(run), summary(run)["window_s"]
    ends = found.end[(found.end >= start) & (found.end <= end)]
    first, last = (simulate(scene, float(ends[k]), record="statistics") for k in ((len(ends) + 1) % 2, -1))

    def between(name: str) -> float:
        one, other = ({**one.energy, **one.energy["dissipated"], "fallen": work_of_gravity(one)} for one in (first, last))
        return float(other[name] - one[name])

    reached = between("damping") + between("stored_J") - between("fallen")
    assert efficiency(run) == pytest.approx(reached / (between("in_J") - between("fallen")), rel=1e-6)
    assert summary(run)["efficiency"] == efficiency(run)


def test_it_is_the_same_whatever_was_kept() -> None:
    """All, or the end only; nothing is said where the rows of that time are not there."""
    scene = load(profiles_dir() / "swiss_lever")
    whole, late, early = (simulate(scene, 6.0, record=kept) for kept in ("all", "statistics", [(1.0, 2.0)]))
    assert efficiency(late) == pytest.approx(efficiency(whole), rel=1e-12)
    assert efficiency(early) is None


def damped(*names: str) -> Scene:
    return replace(lever_scene(), damping=tuple(Damping(name, 1e-9) for name in names))


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param(
            replace(damped("balance"), torques=(*lever_scene().torques, Torque("balance", 1e-9))), id="drives the balance, too"
        ),
        pytest.param(replace(damped("balance"), torques=()), id="no drive"),
        pytest.param(replace(damped("balance"), springs=()), id="no oscillator"),
        pytest.param(replace(damped("balance"), contacts=(), lift_angle=None), id="no lever"),
        pytest.param(damped("balance"), id="no whole oscillation"),
    ],
)
def test_where_it_cannot_be_told(scene: Scene) -> None:
    assert efficiency(balance_only(Events(), 1.0, scene)) is None


def test_what_a_body_that_slides_falls_is_only_lent() -> None:
    """A weight on a cord beside the escapement falls by itself: neither work of the drive, nor does it reach the balance."""
    scene = replace(load(profiles_dir() / "recoil_anchor"), expect=())
    both = replace(scene, bodies=(*scene.bodies, Body("weight", "slide", mass=0.1, axis=(0.0, -1.0), velocity=(0.0,))))
    alone, beside = (efficiency(simulate(one, 6.0, record="all")) for one in (scene, both))
    assert beside == pytest.approx(alone, rel=1e-9)


# Are work and losses between rows the integrals of their powers, whatever forces act?

SCENE = """
[scene]
title = "A plate on its corner, with everything that acts on it"
schema = 1
gravity = ["1.5 m/s²", "-9.81 m/s²"]
[bodies.plate]
polygon = [["0 mm", "0 mm"], ["30 mm", "0 mm"], ["30 mm", "20 mm"], ["0 mm", "20 mm"]]
position = ["0 mm", "0 mm"]
mass = "10 g"
inertia = "50 g·cm²"
angle = "-20°"
velocity = "300 °/s"
[[springs]]
body = "plate"
stiffness = "5 mN·m/rad"
rest = "-60°"
"""
MORE = """
[[torques]]
body = "plate"
over = "angle"
table = [["-200°", "0.3 mN·m"], ["0°", "-0.2 mN·m"], ["200°", "0.4 mN·m"]]
[[damping]]
body = "plate"
viscous = "20 nN·m·s/rad"
quadratic = "3 nN·m·s²/rad²"
coulomb = "40 µN·m"
"""


def test_work_and_losses_are_those_of_the_ledger(tmp_path: Path) -> None:
    """The solver sums powers as it steps, with its own steps and rules, those of weights among what is put in."""
    place = tmp_path / "scene.toml"
    place.write_text(SCENE + MORE, encoding="utf-8")
    scene = load(place)
    run = simulate(scene, 1.0)
    found = flows(run, compile_scene(scene))
    assert run.energy["in_J"] != 0.0 and run.energy["dissipated"]["damping"] > 1e-6
    fallen = work_of_gravity(run)
    assert abs(fallen) > 1e-4
    assert found.drive[-1] + fallen == pytest.approx(run.energy["in_J"], rel=1e-7)
    assert found.damped[-1].sum() == pytest.approx(run.energy["dissipated"]["damping"], rel=1e-7)
    assert found.stored[-1] - found.stored[0] + fallen == pytest.approx(run.energy["stored_J"], rel=1e-7)


def test_gravity_lends_what_the_centre_of_mass_has_fallen(tmp_path: Path) -> None:
    place = tmp_path / "scene.toml"
    place.write_text(SCENE, encoding="utf-8")
    run = simulate(load(place), 0.3)
    turned = run.end_q[0] if run.end_q[0] != run.q[0, 0] else None
    assert turned is not None
    centre = np.array([15e-3 + 10e-3j]) * np.exp(1j * np.array([run.q[0, 0], turned]))
    fallen = 10e-3 * (1.5 * np.diff(centre.real)[0] - 9.81 * np.diff(centre.imag)[0])
    assert work_of_gravity(run) == pytest.approx(fallen, rel=1e-12)
    assert run.energy["in_J"] == pytest.approx(fallen, rel=1e-7)


LINE = """
[scene]
title = "a slide between two springs"
[bodies.slide]
motion = "slide"
axis = [1.0, 0.0]
mass = "3 g"
[bodies.shaker]
motion = "{shaker}"
axis = [1.0, 0.0]
{moves}
[[line_springs]]
between = ["slide"]
points = [["-1 mm", "0 mm"], ["-11 mm", "0 mm"]]
stiffness = "20 N/m"
length = "7 mm"
viscous = "0.05 N·s/m"
[[line_springs]]
between = ["slide", "shaker"]
points = [["1 mm", "0 mm"], ["15 mm", "0 mm"]]
stiffness = "8 N/m"
length = "14 mm"
viscous = "0.02 N·s/m"
[run]
duration = "0.3 s"
"""


def test_damping_of_springs_between_points_is_no_friction(tmp_path: Path) -> None:
    """What a damped swing in a line has lost, by its closed form; the shaker stands still."""
    path = tmp_path / "scene.toml"
    path.write_text(LINE.format(shaker="fixed", moves="").replace("axis = [1.0, 0.0]\n\n", "\n"), encoding="utf-8")
    scene = load(path)
    found = flows(simulate(scene), compile_scene(scene))
    m, k, c, off = 3e-3, 28.0, 0.07, 3e-3 * 20.0 / 28.0  # the left one begins 3 mm too long, the right one without force
    decay, w = 0.5 * c / m, np.sqrt(k / m - (0.5 * c / m) ** 2)
    t = found.t
    x = off * np.exp(-decay * t) * (np.cos(w * t) + decay / w * np.sin(w * t))
    v = -off * np.exp(-decay * t) * (k / m) / w * np.sin(w * t)
    lost = 0.5 * k * off**2 - 0.5 * (k * x**2 + m * v**2)
    assert found.damped.sum(axis=1) == pytest.approx(lost, abs=1e-7 * lost[-1])
    assert np.abs(found.drive).max() == 0.0


def test_what_shakes_a_spring_between_points_drives_it(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    moves = 'swing = { amplitude = "2 mm", frequency = "15 Hz" }\n'
    path.write_text(LINE.format(shaker="driven", moves=moves), encoding="utf-8")
    scene = load(path)
    run = simulate(scene)
    found = flows(run, compile_scene(scene))
    gained = found.stored - found.stored[0] + found.damped.sum(axis=1)
    assert found.drive == pytest.approx(gained, abs=1e-7 * found.damped.sum(axis=1)[-1])
    assert found.damped[-1].sum() == pytest.approx(run.energy["dissipated"]["damping"], rel=1e-6)


# Are stored energy, work and losses those of a made-up model whose motion is known at every instant?

T = np.array([0.0, 0.5, 1.0, 1.75, 2.25, 2.5])  # where tables over time bend, too
# All turn one way: 0, 1 on, 2 and 3 back, 4 is still, so that powers of speeds are smooth; 2 is prescribed.
MOTIONS = [
    Polynomial([0.3, 1.0, 0.2, 0.1, 0.05]),
    Polynomial([-1.0, 2.0, -0.1, 0.02, 0.03]),
    Polynomial([0.5, -0.7, -0.1, 0.0, -0.02]),
    Polynomial([2.0, -3.0, 0.3, -0.1, 0.01]),
    Polynomial([0.4]),
]
N = len(MOTIONS)


def q(k: int, t: float) -> float:
    return float(MOTIONS[k](t))


def u(k: int, t: float) -> float:
    return float(MOTIONS[k].deriv()(t))


def found(model: Any, motions: list[Polynomial], t: np.ndarray = T, rows: slice = slice(None)) -> Flows:
    columns = [np.column_stack([motion.deriv(k)(t) for motion in motions]) for k in (1, 2)]
    run: Any = SimpleNamespace(t=t, q=np.column_stack([motion(t) for motion in motions]), u=columns[0], a=columns[1])
    compiled: Any = SimpleNamespace(model=model, q=np.zeros(len(motions)), against=[])
    return flows(run, compiled, rows)


def integrals(power: Any) -> np.ndarray:
    steps = [quad(power, *span, epsabs=1e-13, epsrel=1e-12)[0] for span in pairwise(T)]
    return np.concatenate(([0.0], np.cumsum(steps)))


MASS = [2.0, 3.0, 1.0, 0.5, 4.0]
PLAIN = {"mass": MASS}


def test_energies_of_coordinates() -> None:
    stiffness, rest = np.array([1.5, 0.0, 2.0, 4.0, 7.0]), np.array([0.1, 0.2, 0.3, -0.4, 0.5])
    wx, wy, prescribed = np.array([0.7, 0.0, 0.3, 0.0, 0.5]), np.array([0.2, -0.9, 0.4, 0.0, 0.0]), np.array([0, 0, 1, 0, 0])
    fields = {"stiffness": stiffness, "rest": rest, "weight_x": wx, "weight_y": wy, "driven": prescribed}
    wound = {"coordinate": 3, "on": 0, "stiffness": 1.25, "rest": 0.6}
    got = found(model_of(coordinates=PLAIN | fields, joints=[wound]), MOTIONS)
    for i, t in enumerate(T):
        for k in range(N):
            kept = 0.5 * MASS[k] * u(k, t) ** 2 + 0.5 * stiffness[k] * (q(k, t) - rest[k]) ** 2
            hung = wy[k] * np.sin(q(k, t)) + wx[k] * np.cos(q(k, t))
            assert got.own[i, k] == pytest.approx(0.0 if k == 2 else kept - hung, rel=1e-12)
        between = 0.5 * 1.25 * (q(3, t) - q(0, t) - 0.6) ** 2
        assert got.stored[i] == pytest.approx(got.own[i].sum() + between, rel=1e-12)
    assert got.q == pytest.approx(np.column_stack([motion(T) for motion in MOTIONS]))


def test_what_is_swept() -> None:
    got = found(model_of(coordinates=PLAIN), MOTIONS)
    for k in range(N):
        assert got.swept[:, k] == pytest.approx(integrals(lambda t, k=k: q(k, t)), rel=1e-11, abs=0.0)
    assert not got.damped.any() and not got.driven.any() and not got.drive.any()


def test_constant_forces() -> None:
    """Nothing that is prescribed counts as driven by them."""
    force = np.array([1.0, -2.0, 5.0, 3.0, 1.0])
    joints = [{"coordinate": 1, "on": 3, "force": 0.75}, {"coordinate": 0, "on": 2, "force": -0.5}]
    got = found(model_of(coordinates=PLAIN | {"force": force, "driven": [0, 0, 1, 0, 0]}, joints=joints), MOTIONS)
    on = {0: 1.0 - 0.5, 1: -2.0 + 0.75, 2: 0.0, 3: 3.0 - 0.75, 4: 1.0}
    for k in range(N):
        wanted = on[k] * integrals(lambda t, k=k: u(k, t))
        wanted = wanted if k != 2 else integrals(lambda t: 0.0)
        assert got.driven[:, k] == pytest.approx(wanted, rel=1e-11, abs=1e-12)
    assert got.drive == pytest.approx(got.driven.sum(axis=1), rel=1e-12)


@pytest.mark.parametrize("field", ["viscous", "coulomb", "quadratic"])
@pytest.mark.parametrize("k", [0, 2, 3])
def test_each_damping_of_a_coordinate_alone(field: str, k: int) -> None:
    values = np.zeros(N)
    values[k] = 0.7
    power = {"viscous": 2, "coulomb": 1, "quadratic": 3}[field]
    got = found(model_of(coordinates=PLAIN | {field: values}), MOTIONS)
    assert got.damped[:, k] == pytest.approx(0.7 * integrals(lambda t: abs(u(k, t)) ** power), rel=1e-10)
    assert np.abs(np.delete(got.damped, k, axis=1)).max() == 0.0 and not got.driven.any()


@pytest.mark.parametrize("field", ["viscous", "quadratic"])
@pytest.mark.parametrize("on", [2, 3])
def test_each_damping_between_coordinates_alone(field: str, on: int) -> None:
    """It counts with the carried one."""
    got = found(model_of(coordinates=PLAIN, joints=[{"coordinate": 0, "on": on, field: 0.4}]), MOTIONS)
    power = {"viscous": 2, "quadratic": 3}[field]
    sum_of = integrals(lambda t: abs(u(0, t) - u(on, t)) ** power)
    assert got.damped[:, 0] == pytest.approx(0.4 * sum_of, rel=1e-9)
    assert not got.damped[:, 1:].any() and not got.driven.any()


def test_dampings_add_up() -> None:
    fields = {
        "viscous": [0.1, 0.2, 0.3, 0.4, 0.5],
        "coulomb": [0.5, 0.0, 0.1, 0.2, 0.3],
        "quadratic": [0.0, 0.3, 0.2, 0.1, 0.6],
    }
    joints = [{"coordinate": 3, "on": 0, "viscous": 0.4, "quadratic": 0.3}, {"coordinate": 1, "on": 4, "viscous": 0.2}]
    got = found(model_of(coordinates=PLAIN | fields, joints=joints), MOTIONS)

    def own(k: int, t: float) -> float:
        s = abs(u(k, t))
        return fields["coulomb"][k] * s + fields["viscous"][k] * s**2 + fields["quadratic"][k] * s**3

    more = {3: lambda t: 0.4 * (u(3, t) - u(0, t)) ** 2 + 0.3 * abs(u(3, t) - u(0, t)) ** 3, 1: lambda t: 0.2 * u(1, t) ** 2}
    for k in range(N):
        wanted = integrals(lambda t, k=k: own(k, t) + (more[k](t) if k in more else 0.0))
        assert got.damped[:, k] == pytest.approx(wanted, rel=1e-10)


def over_angle(k: int, on: int = -1) -> list[tuple[float, float]]:
    """A table that bends where a coordinate (or its difference to another) is at rows; it stays what it is beyond its ends."""
    places = sorted(q(k, t) - (q(on, t) if on >= 0 else 0.0) for t in T)[1:-1]
    return list(zip(places, [0.5, -1.0, 2.0, 0.25], strict=True))


@pytest.mark.parametrize(("k", "on"), [(0, -1), (3, -1), (3, 0), (1, 4), (0, 3)])
def test_tables_over_an_angle(k: int, on: int) -> None:
    knots = over_angle(k, on)
    other = [(0.0, 9.0), (1.0, 9.0)]  # of another table before it, on what stands still
    tables = [{"coordinate": 4, "over": OVER_ANGLE, "knots": other}]
    tables.append({"coordinate": k, "over": OVER_ANGLE, "on": on, "knots": knots})
    got = found(model_of(coordinates=PLAIN, tables=tables), MOTIONS)

    def value(t: float) -> float:
        return float(np.interp(q(k, t) - (q(on, t) if on >= 0 else 0.0), *np.array(knots).T))

    assert got.driven[:, k] == pytest.approx(integrals(lambda t: value(t) * u(k, t)), rel=1e-10)
    for j in range(N):
        if j == on:
            assert got.driven[:, j] == pytest.approx(integrals(lambda t, j=j: -value(t) * u(j, t)), rel=1e-10, abs=1e-15)
        elif j != k:
            assert not got.driven[:, j].any()
    assert not got.damped.any()


@pytest.mark.parametrize("over", [OVER_TIME, REPEATED])
@pytest.mark.parametrize("on", [-1, 1])
def test_tables_over_time(over: int, on: int) -> None:
    """From 0.5 s to 1.75 s; what is repeated goes on so before and after, else the ends stay."""
    knots = np.array([(0.5, 1.0), (1.0, -2.0), (1.75, 0.5)])

    def value(t: float) -> float:
        while over == REPEATED and t < 0.5:
            t += 1.25
        while over == REPEATED and t >= 1.75:
            t -= 1.25
        return float(np.interp(t, *knots.T))

    got = found(model_of(coordinates=PLAIN, tables=[{"coordinate": 3, "over": over, "on": on, "knots": knots}]), MOTIONS)
    assert got.driven[:, 3] == pytest.approx(integrals(lambda t: value(t) * u(3, t)), rel=1e-10)
    if on >= 0:
        assert got.driven[:, 1] == pytest.approx(integrals(lambda t: -value(t) * u(1, t)), rel=1e-10)


@pytest.mark.parametrize("k", [1, 3])
def test_what_holds_a_prescribed_motion_up(k: int) -> None:
    """Against the spring and the damping that it carries: the work of both is what its drive has done."""
    joint = {"coordinate": k, "on": 2, "stiffness": 0.8, "rest": 0.3, "viscous": 0.2, "quadratic": 0.1}
    beside = {"coordinate": 4, "on": 0, "stiffness": 0.8, "viscous": 0.2}  # on what is not prescribed: nothing drives it
    model = model_of(coordinates=PLAIN | {"driven": [0, 0, 1, 0, 0]}, joints=[joint, beside])
    got = found(model, MOTIONS)

    def held(t: float) -> float:
        w = u(k, t) - u(2, t)
        return 0.8 * (q(k, t) - q(2, t) - 0.3) + 0.2 * w + 0.1 * w * abs(w)

    assert got.driven[:, 2] == pytest.approx(integrals(lambda t: -held(t) * u(2, t)), rel=1e-10)
    assert not np.delete(got.driven, 2, axis=1).any()


def test_some_rows_count_from_their_first_on() -> None:
    model = model_of(coordinates=PLAIN | {"force": [1.0, 2.0, 3.0, 4.0, 5.0], "viscous": [0.1] * N})
    whole, part = found(model, MOTIONS), found(model, MOTIONS, rows=slice(2, 5))
    for name in ("drive", "driven", "damped", "swept"):
        there = getattr(whole, name)
        assert getattr(part, name) == pytest.approx(there[2:5] - there[2], rel=1e-11, abs=1e-14)
    assert part.stored == pytest.approx(whole.stored[2:5]) and list(part.t) == list(T[2:5])
