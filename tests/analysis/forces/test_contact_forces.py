"""Are forces at contacts and pivots those of statics and dynamics on paper, and those that move the run itself?"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import watchsim as ws
from watchsim.mechanism.compile import compile_scene
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.simulate import simulate

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


def test_teeth_are_told_what_contacts_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Along and across, and what presses on body A, the block or the floor."""
    told = []

    def no_teeth(scene: object, compiled: object, motion: object, loads: Any) -> list[Any]:
        told.append(loads)
        return []

    monkeypatch.setattr("watchsim.analysis.contact_forces.mesh_forces", no_teeth)
    found = ws.forces(simulate(scene_of(tmp_path, BLOCK.format(speed=300))), [0.05])
    (loads,) = told
    assert loads.ids.tolist() == found.pairs.tolist() and loads.pressed.shape == loads.force.shape == (1, 2, 2)
    assert loads.force[0].sum(axis=0) == pytest.approx((found.normal.sum(), found.tangential.sum()), rel=1e-12)
    assert np.abs(loads.force[0, :, 1] / loads.force[0, :, 0]) == pytest.approx([0.25, 0.25], rel=1e-9)
    assert np.abs(loads.pressed[0].sum(axis=0)) == pytest.approx([0.25 * 0.2 * G, 0.2 * G], rel=1e-9)


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
    with pytest.raises(ValueError, match="forces need a run by events"):
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
