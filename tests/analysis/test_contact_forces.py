"""Are forces at contacts and pivots those of statics and dynamics on paper?"""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import polygon
from scipy.optimize import brentq

import watchsim as ws
from watchsim.analysis.balanced_forces import Mechanism
from watchsim.analysis.expectation_faults import not_begun
from watchsim.analysis.forces import forces
from watchsim.analysis.watch import arms
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc
from watchsim.mechanism.compile import compile_scene
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Contact, Damping, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory

# Are forces at contacts and pivots those of statics and dynamics on paper, and those that move the run itself?

G = 9.81


def scene_of(folder: Path, text: str):
    (folder / "scene.toml").write_text(f'[scene]\nschema = 1\ngravity = ["0 m/s²", "-{G} m/s²"]\n{text}', encoding="utf-8")
    return load(folder)


BLOCK = """
[bodies.block]
polygon = [["-10 mm", "-5 mm"], ["10 mm", "-5 mm"], ["10 mm", "5 mm"], ["-10 mm", "5 mm"]]
motion = "free"
mass = "0.2 kg"
position = ["0 mm", "5 mm"]
velocity = ["{speed} mm/s", "0 mm/s"]
[bodies.floor]
line = [["1000 mm", "0 mm"], ["-1000 mm", "0 mm"]]
motion = "fixed"
[[contacts]]
between = ["block", "floor"]
friction = 0.25
[run]
duration = "0.2 s"
"""


def test_a_block_slides_and_stops(tmp_path: Path) -> None:
    """Both corners together carry the weight; the tipping moment of friction loads the front one: N = m g (1/2 ± μ h / w)."""
    run = simulate(scene_of(tmp_path, BLOCK.format(speed=300)))
    found = ws.forces(run, [0.05, 0.1, 0.19])
    weight = 0.2 * G
    assert found.normal.sum(axis=1) == pytest.approx(weight, rel=1e-9)
    assert np.abs(found.tangential[:2]).sum(axis=1) == pytest.approx(0.25 * weight, rel=1e-9)
    assert sorted(found.normal[0]) == pytest.approx([weight * (0.5 - 0.25 * 5 / 20), weight * (0.5 + 0.25 * 5 / 20)], rel=1e-6)
    assert found.tangential[2] == pytest.approx(0.0, abs=1e-9)  # it has stopped after 0.12 s
    assert found.direction[0] == pytest.approx(np.tile([0.0, 1.0], (len(found.pairs), 1)), abs=1e-12)
    assert sorted(found.point[0, :, 0]) == pytest.approx([run.at(0.05)[0][0] + x for x in (-0.01, 0.01)], abs=1e-9)


def test_the_bearing_of_a_pendulum(tmp_path: Path) -> None:
    """Along the rod m (g cos φ + l ω²), across it m g sin φ (1 − m l² / J)."""
    text = """
[bodies.bob]
circle = "30 mm"
pivot = ["0 mm", "200 mm"]
mass = "0.5 kg"
angle = "70°"
[run]
duration = "2 s"
"""
    run = simulate(scene_of(tmp_path, text))
    times = np.linspace(0.0, 2.0, 41)
    (angle,), (spin,) = (values.T for values in run.sample(times))
    length, inertia = 0.2, 0.5 * (0.2**2 + 0.5 * 0.03**2)
    along = 0.5 * (G * np.cos(angle) + length * spin**2)
    across = 0.5 * G * np.sin(angle) * (1.0 - 0.5 * length**2 / inertia)
    out, side = np.stack((np.sin(angle), -np.cos(angle))), np.stack((np.cos(angle), np.sin(angle)))
    found = ws.forces(run, times).pivots["bob"].T
    assert found == pytest.approx(-along * out + across * side, rel=1e-7, abs=1e-8)


def test_a_bearing_that_sticks_carries_the_weight(tmp_path: Path) -> None:
    """Held by dry friction at 5°, a bob of a gram does not accelerate: its bearing carries m g, and nothing across."""
    text = """
[bodies.bob]
circle = "2 mm"
pivot = ["0 mm", "10 mm"]
mass = "1 g"
angle = "5°"
[[damping]]
body = "bob"
coulomb = "20 µN·m"
[run]
duration = "0.2 s"
"""
    run = simulate(scene_of(tmp_path, text))
    assert ws.forces(run, [0.1]).pivots["bob"][0] == pytest.approx((0.0, 1e-3 * G), rel=1e-9, abs=1e-12)


def test_forces_of_a_lever_escapement_are_those_that_moved_it() -> None:
    """M u' = h + W λ at the rows of the run: torques about the pivots, from points, normals and forces alone."""
    run = simulate(profiles_dir() / "swiss_lever", 0.4)
    rows = np.arange(5, len(run.t) - 1, 37)
    rows = rows[(np.diff(run.t)[rows] > 0.0) & ~np.isin(run.t[rows], run.events["t"])]
    found = ws.forces(run, run.t[rows])
    assert len(found.pairs) > 10 and found.normal.min() >= 0.0 and found.normal.max() > 1e-5
    assert repr(found).startswith("<Forces at ") and len(repr(found)) < 200
    assert np.all(np.abs(found.tangential) <= 0.12 * found.normal * (1.0 + 1e-9) + 1e-15)
    scene, total = run.scene, {}
    across = np.stack((-found.direction[..., 1], found.direction[..., 0]), axis=-1)
    force = np.nan_to_num(found.normal[..., None] * found.direction + found.tangential[..., None] * across)
    for name in ("wheel", "lever", "balance"):
        arm = np.nan_to_num(found.point - np.array(scene.body(name).position))
        torque = arm[..., 0] * force[..., 1] - arm[..., 1] * force[..., 0]
        signs = [(run.pairs[k].body_a == name) * 1.0 - (run.pairs[k].body_b == name) for k in found.pairs]
        total[name] = torque @ np.array(signs)
    column = {name: run.slices[name].start for name in total}
    wheel = scene.body("wheel").inertia * run.a[rows, column["wheel"]] - scene.torques[0].value
    assert total["wheel"] == pytest.approx(wheel, abs=1e-12)
    assert total["lever"] == pytest.approx(scene.body("lever").inertia * run.a[rows, column["lever"]], abs=1e-12)
    spring, damping = scene.springs[0].stiffness, scene.damping[0].viscous
    q, u = run.q[rows, column["balance"]], run.u[rows, column["balance"]]
    pushed = scene.body("balance").inertia * run.a[rows, column["balance"]] + spring * q + damping * u
    assert total["balance"] == pytest.approx(pushed, abs=1e-12)
    # Without masses the bearings hold against the contacts alone.
    assert sum(found.pivots.values()).shape == (len(rows), 2)
    assert found.pivots["wheel"] == pytest.approx(
        -np.einsum(
            "k,nkx->nx",
            np.array([(run.pairs[k].body_a == "wheel") * 1.0 - (run.pairs[k].body_b == "wheel") for k in found.pairs]),
            force,
        )
    )


def test_what_cannot_be_had_says_why() -> None:
    scene = load(profiles_dir() / "bench_lever")
    with pytest.raises(ValueError, match="forces need an event-driven run"):
        ws.forces(simulate(scene, 0.01, method="moreau"))
    with pytest.raises(ValueError, match="forces need all events"):
        ws.forces(simulate(scene, 0.01, record="statistics"))


def test_short_representations_and_paths() -> None:
    run = ws.simulate(str(profiles_dir() / "bench_lever"), 0.05)
    assert repr(run).startswith("<Trajectory of 'Bench lever") and len(repr(run)) < 200 and "0.05 s" in repr(run)
    assert repr(run.scene).startswith("<Scene 'Bench lever") and len(repr(run.scene)) < 200
    for one in (0.02, np.float64(0.02), np.array(0.02), np.array([0.02]), iter([0.02]), (0.02,)):
        assert ws.forces(run, one).normal.tolist() == ws.forces(run, [0.02]).normal.tolist()
    assert repr(run.scene.body("lever")).startswith("<Body 'lever', pivot: ")
    assert repr(run.scene.body("lever").profile).startswith("<Profile: ")
    assert ws.load(profiles_dir() / "bench_lever") == run.scene


def test_accelerations_between_rows(tmp_path: Path) -> None:
    text = '[bodies.a]\ncircle = "3 mm"\ninertia = "1 g·cm²"\nangle = "80°"\n[[springs]]\nbody = "a"\nfrequency = "3 Hz"\n'
    run = simulate(scene_of(tmp_path, text), 1.0)
    times = np.linspace(0.013, 0.97, 200)
    expected = -((math.tau * 3.0) ** 2) * math.radians(80.0) * np.cos(math.tau * 3.0 * times)
    assert run.acceleration(times)[:, 0] == pytest.approx(expected, abs=2e-2 * np.abs(expected).max())
    row = run.t[len(run.t) // 2]
    assert run.acceleration(np.array([row]))[0] == pytest.approx(run.a[len(run.t) // 2], rel=1e-12)


def test_plots_show_accelerations_on_request() -> None:
    run = simulate(load(profiles_dir() / "bench_lever"), 0.3)
    figure = ws.plot_kinematics(run, bodies=["lever"], quantities=["velocity", "acceleration"])
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["angular velocity (°/s)", "acceleration (°/s²)"]
    (line,) = figure.axes[1].get_lines()
    assert np.nanmax(np.abs(line.get_ydata())) == pytest.approx(
        math.degrees(np.abs(run.a[:, run.slices["lever"].start]).max()), rel=1e-6
    )


def test_all_modes_are_among_those_told() -> None:
    run = simulate(load(profiles_dir() / "bench_lever"), 0.1)
    assert {int(kind) for kind in run.events["kind"]} >= {EventKind.CLOSE, EventKind.OPEN, EventKind.SLIDE}
    assert len(compile_scene(run.scene).model.contacts) == len(run.pairs)


# Are forces the same whichever instants are asked about together?


def told(run: Trajectory, times: Array) -> Array:
    """Normal and tangential forces of all contacts, then forces on bearings (times, all of these)."""
    found = forces(run, times)
    contacts = np.zeros((len(times), 2, len(run.pairs)))
    contacts[:, 0, found.pairs], contacts[:, 1, found.pairs] = found.normal, found.tangential
    return np.hstack((contacts.reshape(len(times), -1), *found.pivots.values()))


@pytest.mark.parametrize(("name", "duration"), [("swiss_lever", 0.2), ("detent", 0.2)])
def test_one_by_one_all_together_and_shuffled(name: str, duration: float) -> None:
    """Of a lever, and of a detent that rests on its spring, with redundant contacts at most instants."""
    run = simulate(profiles_dir() / name, duration, record="all")
    rng = np.random.default_rng(3)
    times = np.sort(rng.choice(np.unique(run.t), 60, replace=False))
    expected, order = told(run, times), rng.permutation(60)
    for parts in (np.arange(60)[:, None], [order], [order[k::7] for k in range(7)]):
        for part in parts:
            assert np.abs(told(run, times[part]) - expected[part]).max() <= 1e-9 * np.abs(expected).max()


# Are the lever arms of contacts those of forces on paper? A disc off its pivot, a bar that turns about another.

RADIUS, CENTRE = 1.5e-3, 2e-3 - 1e-3j
DISC, BAR = 1e-3 + 5.5e-3j, -2e-3 + 3e-3j  # pivots
TOP, CORNER = 2, 5  # contacts: the bar's upper edge, and its corner above on the right
EDGE, HORN = 0.5e-3, 5e-3 + 0.5e-3j


def scene() -> Scene:
    disc = Loop((Arc(CENTRE.real, CENTRE.imag, RADIUS, 0.0, math.tau),), "RIM", True)
    bar = polygon([1e-3 * complex(x, y) for x, y in ((-6, -1), (5, -1), (5, 0.5), (-6, 0.5))], "BAR")
    bodies = (
        Body("plate", "fixed"),
        Body("disc", position=(DISC.real, DISC.imag), inertia=2e-9, velocity=(0.0,), loops=(disc,)),
        Body("bar", position=(BAR.real, BAR.imag), inertia=3e-9, velocity=(0.0,), loops=(bar,)),
    )
    contacts = (Contact((Side("disc"), Side("plate")), 0.4), Contact((Side("disc"), Side("bar")), 0.13))
    acting: dict[str, Any] = {"springs": (Spring("bar", 2e-6, 0.1),), "torques": (Torque("disc", 3e-6),)}
    return Scene("Disc and bar", bodies, damping=(Damping("bar", 1e-7, 0.0, 5e-8),), contacts=contacts, **acting)


def cross(a: complex, b: complex) -> float:
    return (a.conjugate() * b).imag


def told_arms_of_contacts(bar: float, contacts: list[int], top: bool, u: float = 0.0) -> tuple[Any, float]:
    """With the bar at that angle, and the disc so that it touches its upper edge, or else its corner."""

    def gap(disc: float) -> float:
        middle = (DISC + CENTRE * np.exp(1j * disc) - BAR) * np.exp(-1j * bar)
        return float(middle.imag - EDGE if top else abs(middle - HORN)) - RADIUS

    tried = np.linspace(-math.pi, math.pi, 200)
    k = next(k for k in range(199) if gap(tried[k]) * gap(tried[k + 1]) <= 0.0)
    disc = brentq(gap, tried[k], tried[k + 1], xtol=1e-15)
    made = scene()
    compiled = compile_scene(made)
    contact = compiled.model.contacts
    # Of the model: which primitive is on side A, and to which declared contact all belong.
    pairs: Any = tuple(SimpleNamespace(group=int(group), name=k) for k, group in enumerate(contact.group))
    q, rates = np.array([[disc, bar]]), np.array([[0.0, u]])
    run = replace(not_begun(made), q=q, u=rates, pairs=pairs)
    return arms(run, compiled, 0.0, contacts), disc


def on_paper(disc: float, bar: float) -> tuple[complex, complex, tuple[float, float], tuple[float, float]]:
    """Of the contact on the bar's upper edge: where, its normal, and the arms about both pivots along the normal and across."""
    normal = 1j * np.exp(1j * bar)
    point = DISC + CENTRE * np.exp(1j * disc) - RADIUS * normal
    along, across = ((cross(point - DISC, way), -cross(point - BAR, way)) for way in (normal, 1j * normal))
    return point, normal, along, across


@pytest.mark.parametrize("bar", [0.2, -0.35, 0.5])
@pytest.mark.parametrize("others", [[], [0]])
def test_arms_of_a_contact(bar: float, others: list[int]) -> None:
    """On body A along the normal out of B, and along that turned by +90°; on body B the other way."""
    found, disc = told_arms_of_contacts(bar, [*others, TOP], top=True)
    row = len(others)
    point, normal, along, across = on_paper(disc, bar)
    assert complex(*found.way[row]) == pytest.approx(normal, rel=1e-9) and found.t == 0.0
    assert complex(*found.point[row]) == pytest.approx(point, abs=1e-12)
    assert found.of(row, "disc") == pytest.approx((along[0], across[0]), rel=1e-9, abs=0.0)
    assert found.of(row, "bar") == pytest.approx((along[1], across[1]), rel=1e-9, abs=0.0)
    assert [pair.name for pair in found.pairs] == [*others, TOP] and found.friction[row] == 0.13
    assert found.places["disc"] == pytest.approx((DISC.real, DISC.imag, disc), rel=1e-12)
    assert found.places["bar"] == pytest.approx((BAR.real, BAR.imag, bar), rel=1e-12) and found.columns == {"disc": 0, "bar": 1}


def test_arms_of_a_corner() -> None:
    """Side A is the bar's: the normal points out of the disc."""
    found, disc = told_arms_of_contacts(-0.1, [CORNER], top=False)
    middle, point = DISC + CENTRE * np.exp(1j * disc), BAR + HORN * np.exp(-0.1j)
    normal = (point - middle) / RADIUS
    assert complex(*found.way[0]) == pytest.approx(normal, rel=1e-9)
    assert complex(*found.point[0]) == pytest.approx(point, abs=1e-12)
    assert found.of(0, "bar") == pytest.approx((cross(point - BAR, normal), cross(point - BAR, 1j * normal)), rel=1e-9)
    assert found.of(0, "disc") == pytest.approx((-cross(point - DISC, normal), -cross(point - DISC, 1j * normal)), rel=1e-9)


def test_loads_are_those_of_bodies_at_rest() -> None:
    """Springs and drives, whatever turns: viscous damping is left out, dry friction told apart."""
    found, _ = told_arms_of_contacts(0.2, [TOP], top=True, u=3.0)
    assert found.loads == pytest.approx([3e-6, -2e-6 * (0.2 - 0.1)], rel=1e-9, abs=0.0)
    assert found.dry.tolist() == [0.0, 5e-8]


def test_without_contacts_there_are_still_loads() -> None:
    found, _ = told_arms_of_contacts(0.2, [], top=True)
    assert found.normal.shape == found.across.shape == (0, 2) and found.point.shape == found.way.shape == (0, 2)
    assert found.loads[0] == pytest.approx(3e-6, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("contacts", [[TOP], [0, TOP, CORNER], []])
def test_many_instants_are_seen_one_by_one(contacts: list[int]) -> None:
    """With velocities: how the gap bends as both turn on evenly, and what damping does to them."""
    compiled = compile_scene(scene())
    q = np.array([(told_arms_of_contacts(bar, [TOP], top=True)[1], bar) for bar in (0.2, -0.35, 0.5)])
    u = np.array([(1.5, -2.0), (-0.5, 3.0), (2.5, 0.25)])
    seen = Mechanism(compiled).seen(np.zeros(3), q, u, np.array(contacts, np.int64))
    count = len(contacts)
    assert seen.w_N.shape == seen.w_T.shape == (3, count, 2) == seen.normal.shape == seen.point.shape
    assert seen.bar.shape == (3, 2, count) and seen.h.shape == (3, 2)
    assert seen.h[:, 1] == pytest.approx(-2e-6 * (q[:, 1] - 0.1) - 1e-7 * u[:, 1], rel=1e-9, abs=0.0)
    if not contacts:
        return
    row = contacts.index(TOP)
    for k, (disc, bar) in enumerate(q):
        point, normal, along, across = on_paper(disc, bar)
        assert seen.w_N[k, row] == pytest.approx(along, rel=1e-9, abs=1e-15)
        assert seen.w_T[k, row] == pytest.approx(across, rel=1e-9, abs=1e-15)
        assert complex(*seen.point[k, row]) == pytest.approx(point, abs=1e-12)
        assert complex(*seen.normal[k, row]) == pytest.approx(normal, rel=1e-9)

        def gap(t: float, k: int = k) -> float:
            disc, bar = q[k] + t * u[k]
            return float(((DISC + CENTRE * np.exp(1j * disc) - BAR) * np.exp(-1j * bar)).imag)

        h = 1e-4
        assert seen.w_N[k, row] @ u[k] == pytest.approx((gap(h) - gap(-h)) / (2.0 * h), rel=1e-6, abs=0.0)
        assert seen.bar[k, 0, row] == pytest.approx((gap(h) - 2.0 * gap(0.0) + gap(-h)) / h**2, rel=1e-5, abs=0.0)


def test_what_a_mechanism_knows_of_its_contacts() -> None:
    """Friction by the contact declared, mobilities and dry friction by coordinate."""
    made = Mechanism(compile_scene(scene()))
    assert made.laws.friction.tolist() == [0.13] * 8 and made.mobility == pytest.approx([1 / 2e-9, 1 / 3e-9], rel=1e-12)
    assert made.dry.tolist() == [0.0, 5e-8] and made.prescribed.tolist() == [False, False]
