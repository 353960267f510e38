"""Does a driven body move exactly as prescribed, and does a run-down mainspring find its way?"""

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from every_time import few

import watchsim as ws
from watchsim.paths import profiles_dir
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Damping
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop

# Does a driven body move exactly as prescribed, and does what it meets answer as closed forms say, with the work booked?

BOX = '[["-10 mm", "0 mm"], ["10 mm", "0 mm"], ["10 mm", "10 mm"], ["-10 mm", "10 mm"]]'
FLOOR = '[["-2000 mm", "-10 mm"], ["2000 mm", "-10 mm"], ["2000 mm", "0 mm"], ["-2000 mm", "0 mm"]]'


def scene(folder: Path, text: str) -> Scene:
    path = folder / "scene.toml"
    path.write_text("[scene]\ntitle = 'driven'\nschema = 1\n" + text, encoding="utf-8")
    return ws.load(path)


def pusher(law: str) -> str:
    """A driven slider, and a block 5 mm before it on the same axis."""
    return f"""
[bodies.pusher]
polygon = {BOX}
motion = "driven"
axis = [1.0, 0.0]
{law}
[bodies.block]
polygon = {BOX}
motion = "slide"
axis = [1.0, 0.0]
position = ["25 mm", "0 mm"]
mass = "3 g"
[[contacts]]
between = ["pusher", "block"]
restitution = 0.5
"""


def test_swing_and_path_are_followed(tmp_path: Path) -> None:
    text = """
[bodies.a]
motion = "driven"
circle = "1 mm"
angle = "20°"
swing = { amplitude = "30°", frequency = "3 Hz", phase = "40°" }
[bodies.b]
motion = "driven"
circle = "1 mm"
position = ["9 mm", "0 mm"]
path = [["0.1 s", "36°"], ["0.2 s", "36°"], ["0.45 s", "-10°"]]
[run]
duration = "1 s"
"""
    run = ws.simulate(scene(tmp_path, text))
    times = np.linspace(0.0, 1.0, 201)
    a, b = run.sample(times)[0].T
    phase, way = math.radians(40.0), math.radians(30.0)
    exact = math.radians(20.0) + way * (np.sin(6.0 * math.pi * times + phase) - math.sin(phase))
    assert np.abs(a - exact).max() < 5e-9  # between steps: their error, which does not add up
    assert a[-1] == pytest.approx(exact[-1], abs=1e-13)
    u = run.sample(times)[1][:, 1]
    for t, angle in ((0.1, 36.0), (0.2, 36.0), (0.45, -10.0), (1.0, -10.0)):
        assert b[round(t * 200)] == pytest.approx(math.radians(angle), abs=1e-9)
    assert np.abs(u[times >= 0.45]).max() < 1e-8  # at rest from its end on
    # Its acceleration is continuous: the velocity has no corner anywhere.
    fine = np.linspace(0.0, 0.5, 50001)
    bend = np.diff(run.sample(fine)[1][:, 1], 2)
    assert np.abs(bend).max() < 1e-3 * np.abs(np.diff(run.sample(fine)[1][:, 1])).max()


@pytest.mark.parametrize("method", ["pfeiffer-glocker", "moreau"])
def test_impact_with_a_driven_body(tmp_path: Path, method: str) -> None:
    """A pusher at 0.1 m/s meets a block at rest, which leaves with 1 + 0.5 times that."""
    run = ws.simulate(scene(tmp_path, pusher('velocity = "0.1 m/s"') + '[run]\nduration = "0.1 s"\n'), method=method)
    assert run.u[-1].tolist() == pytest.approx([0.1, 0.15], abs=1e-12)
    if method == "pfeiffer-glocker":
        (hit,) = run.events[run.events["kind"] == EventKind.IMPACT]
        assert hit["t"] == pytest.approx(0.05, abs=1e-12)
    # Impulse m·1.5·V at V: work m·1.5·V²; kept ½ m (1.5 V)².
    assert run.energy["in_J"] == pytest.approx(3e-3 * 1.5 * 0.01, rel=1e-9, abs=0.0)
    assert run.energy["dissipated"]["impacts"] == pytest.approx(3e-3 * 0.01 * (1.5 - 0.5 * 1.5**2), rel=1e-9, abs=0.0)
    assert run.energy["residual_relative"] < 1e-9


def test_pushing_against_damping_takes_its_power(tmp_path: Path) -> None:
    """Once rebounds have died out the block moves with the pusher, and damping takes c V² from the drive."""
    damped = pusher('velocity = "0.1 m/s"') + '[[damping]]\nbody = "block"\nviscous = "2 N·s/m"\n[run]\nduration = "1 s"\n'
    run = ws.simulate(scene(tmp_path, damped))
    late = ws.simulate(scene(tmp_path, damped.replace('"1 s"', '"2 s"')))
    assert run.u[-1][1] == pytest.approx(0.1, abs=1e-12)
    assert late.energy["in_J"] - run.energy["in_J"] == pytest.approx(2.0 * 0.01, rel=1e-9)
    assert late.energy["residual_relative"] < 1e-9
    assert ws.forces(late, [1.5]).drives["pusher"].tolist() == pytest.approx([0.2])  # c V


def test_block_on_a_belt(tmp_path: Path) -> None:
    """Speeds up by friction until it travels with the belt: lag v²/(2 μ g), half of the drive's work is kept."""
    text = f"""
gravity = ["0 m/s²", "-9.81 m/s²"]
[bodies.belt]
polygon = {FLOOR}
motion = "driven"
axis = [1.0, 0.0]
velocity = "0.1 m/s"
[bodies.block]
polygon = {BOX}
motion = "free"
position = ["0 mm", "5 mm"]
mass = "10 g"
[[contacts]]
between = ["block", "belt"]
friction = 0.3
[run]
duration = "1 s"
"""
    run = ws.simulate(scene(tmp_path, text))
    assert run.q[-1][1] == pytest.approx(0.1 - 0.01 / (2.0 * 0.3 * 9.81), abs=1e-12)
    assert run.energy["in_J"] == pytest.approx(1e-4, rel=1e-9, abs=0.0)
    assert run.energy["stored_J"] == pytest.approx(5e-5, rel=1e-9)
    assert run.energy["residual_relative"] < 1e-9


def test_belt_uphill(tmp_path: Path) -> None:
    """Friction 0.3·10 against a pull of 1 m/s² along the belt: it speeds up with 2 m/s², then rides."""
    text = f"""
gravity = ["-1 m/s²", "-10 m/s²"]
[bodies.belt]
polygon = {FLOOR}
motion = "driven"
axis = [1.0, 0.0]
velocity = "0.05 m/s"
[bodies.block]
polygon = {BOX}
motion = "free"
position = ["0 mm", "5 mm"]
mass = "100 g"
[[contacts]]
between = ["block", "belt"]
friction = 0.3
[run]
duration = "0.6 s"
"""
    run = ws.simulate(scene(tmp_path, text))
    assert run.q[-1][1] == pytest.approx(0.6 * 0.05 - 0.05**2 / 4.0, abs=1e-10)
    longer = ws.simulate(scene(tmp_path, text.replace('"0.6 s"', '"1.6 s"')))
    # One more second uphill: the drive works 0.1 kg · 1 m/s² · 0.05 m/s, all of it against gravity.
    assert longer.energy["residual_relative"] < 1e-9
    assert longer.u[-1][1] == pytest.approx(0.05, abs=1e-12)


@pytest.mark.parametrize(
    ("law", "said"),
    [
        ("", "needs one law"),
        ('velocity = "1 mm/s"\nswing = { amplitude = "1 mm", frequency = "1 Hz" }', "needs one law"),
        ('swing = { amplitude = "1 mm" }', "missing: frequency"),
        ('path = [["0.2 s", "1 mm"], ["0.1 s", "2 mm"]]', "increase"),
        ('path = [["0.2 s"]]', "a time and how far"),
        ("path = []", "a list of 1 to"),
        ('on = "block"\nvelocity = "1 mm/s"', "cannot be carried"),
    ],
)
def test_what_is_refused(tmp_path: Path, law: str, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        scene(tmp_path, pusher(law))


def test_nothing_acts_on_a_driven_body(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="moves as prescribed"):
        scene(tmp_path, pusher('velocity = "1 mm/s"') + '[[damping]]\nbody = "pusher"\nviscous = "2 N·s/m"\n')
    with pytest.raises(SceneError, match="neither can give way"):
        scene(tmp_path, pusher('velocity = "1 mm/s"').replace('motion = "slide"\naxis = [1.0, 0.0]', 'motion = "fixed"'))


def test_a_body_without_a_way_out_ends_the_run_and_is_named(tmp_path: Path) -> None:
    """A pusher squeezes a block between itself and a wall."""
    wall = f'[bodies.wall]\nmotion = "fixed"\npolygon = {BOX}\nposition = ["50 mm", "0 mm"]\n'
    wall += '[[contacts]]\nbetween = ["block", "wall"]\n[run]\nduration = "1 s"\n'
    run = ws.simulate(scene(tmp_path, pusher('velocity = "20 mm/s"') + wall))
    # 5 mm to the block, 5 mm to the wall with it.
    assert run.simulated == pytest.approx(0.5, abs=1e-9)
    assert run.stop.name not in ("DURATION", "RUNNING")
    assert "pusher, which is driven, leaves block no way out at block" in run.stop_message
    assert "complementarity" not in run.stop_message
    assert "This is a jam: a driven body goes on whatever is in its way" in run.stop_message


def test_a_driven_finger_may_strike_what_has_not_moved_yet() -> None:
    """All energy comes in at that instant; its rounding was once taken for a change that no impulse explains."""
    run = ws.simulate(ws.designs.jumper(teeth=5, crank="5 mm").scene(), 0.46, tolerance=1e-11)
    assert run.stop == Stop.DURATION, run.stop_message
    assert run.energy["residual_relative"] < 1e-9


# A mainspring runs down: at every torque, and at none, a lever runs or stands, and the solver finds its way.

TORQUES = [0.0, *np.geomspace(1e-3, 10.0, 20).tolist(), -0.5]


@pytest.mark.parametrize("name", few(["bench_lever", "swiss_lever"], 1))
def test_every_torque_runs_to_the_end(name: str) -> None:
    scene = load(profiles_dir() / name / "scene.toml")
    given_up = []
    for torque in TORQUES:
        run = simulate(scene.set("torques.0.value", f"{-torque:.6g} µN·m"), 2.0)
        if run.stop != Stop.DURATION:
            given_up.append((torque, run.stop))
    assert given_up == []


@pytest.mark.parametrize(
    "dry, torque, tolerance",
    [
        pytest.param(0.0, 1.65848e-4, 1e-9, id="two slips turn back at once"),
        pytest.param(0.0, 1.97815e-4, 1e-9, id="two slips turn back at once, again"),
        pytest.param(2e-9, 1.59062e-2, 1e-6, id="a slip too slow to count, against the mode"),
        pytest.param(2e-9, 1.33655e-4, 1e-6, id="a jam whose gaps open slowly"),
        pytest.param(2e-9, 1.41825e-4, 1e-6, id="a jam whose gaps open slowly, again"),
    ],
)
def test_a_lever_without_torque_comes_to_stand(dry: float, torque: float, tolerance: float) -> None:
    """The last moments of a watch run down: everything slides, sticks and jams at once, at speeds next to none."""
    scene = load(profiles_dir() / "bench_lever" / "scene.toml").set("torques.0.value", f"{-torque:.6g} µN·m")
    if dry:
        bearings = tuple(Damping(body.name, coulomb=dry) for body in scene.bodies if body.motion == "pivot")
        scene = dataclasses.replace(scene, damping=(*scene.damping, *bearings))
    run = simulate(scene, 5.0, tolerance=tolerance)
    assert run.stop == Stop.DURATION
    assert run.energy["residual_relative"] < 1e3 * tolerance
