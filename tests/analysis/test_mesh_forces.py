"""Are the loads of bearings between gears those of statics on paper, and the active sets those of scipy?"""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scene.made_gears import read

import watchsim as ws
from watchsim.analysis.forces import Loads, mesh_forces
from watchsim.analysis.wear import Wear
from watchsim.scene.errors import SceneError

# Are the loads of bearings between gears those that statics and dynamics give on paper?

LEAN = math.tan(math.radians(20.0))
M = 1e-3  # N·m
Gears = list[tuple[str, str, object, str]]  # between, ratio, further keys


def scene_of(folder: Path, bodies: dict[str, str], gears: Gears, torques: dict[str, str]) -> ws.Scene:
    text = '[scene]\ntitle = "gears"\n'
    text += "".join(f'[bodies.{name}]\ninertia = "1 g·cm²"\n{keys}\n' for name, keys in bodies.items())
    text += "".join(f'[[gears]]\nbetween = ["{a}", "{b}"]\nratio = {ratio}\n{keys}\n' for a, b, ratio, keys in gears)
    text += "".join(f'[[torques]]\nbody = "{name}"\nvalue = "{value}"\n' for name, value in torques.items())
    return read(folder, text + '[run]\nduration = "0.2 s"\n')


def at(x: float, y: float = 0.0) -> str:
    return f'position = ["{x} mm", "{y} mm"]'


def loads_at(scene: ws.Scene, t: float = 0.1) -> dict[str, np.ndarray]:
    return {name: force[0] for name, force in ws.forces(ws.simulate(scene), [t]).pivots.items()}


@pytest.mark.parametrize("play", ["", 'backlash = "0.2°"'])
def test_an_idler_carries_twice_the_tangential_force(tmp_path: Path, play: str) -> None:
    """In line the radial forces cancel; the outer bearings carry one tangential and one radial force each."""
    bodies = {"first": at(0), "idler": at(10), "last": at(20)}
    gears: Gears = [("first", "idler", -1, play), ("idler", "last", -1, play)]
    scene = scene_of(tmp_path, bodies, gears, {"first": "1 mN·m", "last": "-1 mN·m"})
    found = loads_at(scene)
    push = M / 5e-3
    assert found["idler"] == pytest.approx([0.0, -2.0 * push], abs=1e-9)
    assert found["first"] == pytest.approx([push * LEAN, push], abs=1e-9)
    assert found["last"] == pytest.approx([-push * LEAN, push], abs=1e-9)


def test_an_idler_round_a_corner(tmp_path: Path) -> None:
    """The second mesh at a right angle: tangential and radial forces add as vectors."""
    bodies = {"first": at(0), "idler": at(10), "last": at(10, 10)}
    gears: Gears = [("first", "idler", -1, 'pressure_angle = "15°"')]
    gears.append(("idler", "last", -1, 'pressure_angle = "15°"'))
    found = loads_at(scene_of(tmp_path, bodies, gears, {"first": "1 mN·m", "last": "-1 mN·m"}))
    push, lean = M / 5e-3, math.tan(math.radians(15.0))
    # The first turns counter-clockwise: it pushes the idler up, and away to the right; the last, above, to the left, and down.
    on_idler = np.array([push * lean, push]) + np.array([-push, -push * lean])
    assert found["idler"] == pytest.approx(-on_idler, abs=1e-9)


@pytest.mark.parametrize("noted_on", ["rack of the first", "rack of the second"])
def test_what_the_racks_press_is_what_the_teeth_press(tmp_path: Path, noted_on: str) -> None:
    """Pitch radii 6 and 4 mm, so P is at (6 mm, 0). The first's rack goes by -6 mm per radian: f along it is the torque -6 mm f
    on the first. The second's goes by 4 mm and feels -f: -4 mm f. Both are moments of f upwards on the second's teeth at P and
    of -f on the first's; the radial force parts them. On which of the racks the force is noted does not matter."""
    scene = scene_of(tmp_path, {"a": at(0), "b": at(10)}, [("a", "b", -1.5, 'backlash = "0.2°"')], {})
    f = np.array([0.3, -0.3, 0.7])
    first = noted_on == "rack of the first"
    contacts = SimpleNamespace(group=np.array([0]), a=np.array([0 if first else 1]))
    racks = SimpleNamespace(body=np.array([2, 3]))  # numbers 2 and 3, after the scene's two bodies
    compiled = SimpleNamespace(
        model=SimpleNamespace(contacts=contacts, primitives=racks, bodies=[None] * 4), size=1.0, loose=()
    )
    pressed = np.stack((f if first else -f, np.zeros(3)), axis=1)[:, None]
    loads = Loads(np.array([0]), np.zeros((3, 1, 2)), pressed)
    found = {one.body: one.force for one in mesh_forces(scene, compiled, None, loads)}
    on_second = np.stack((LEAN * np.abs(f), f), axis=1)
    assert sorted(found) == [0, 1]
    assert found[1] == pytest.approx(on_second, rel=1e-12)
    assert found[0] == pytest.approx(-on_second, rel=1e-12)


@pytest.mark.parametrize("ratio", [-0.5, -3.0, 3.0, 0.25])
def test_a_pair_that_speeds_up(tmp_path: Path, ratio: float) -> None:
    """F at the pitch point turns the second: J₂ α₂ = F ρ₂, outside (ratio < 0) and within a ring."""
    scene = scene_of(tmp_path, {"a": at(0), "b": at(6, 8)}, [("a", "b", ratio, "")], {"a": "1 mN·m"})
    found, J = loads_at(scene), 1e-7
    alpha = M / (J * (1.0 + ratio**2)) * ratio
    reach = 10e-3 / abs(1.0 - ratio)  # pitch radius of the second
    push = abs(J * alpha / reach)
    assert np.hypot(*found["b"]) == pytest.approx(push * math.hypot(1.0, LEAN), rel=1e-9)
    assert found["a"] == pytest.approx(-found["b"], abs=1e-12)
    line = np.array([0.6, 0.8])
    apart = 1.0 if ratio < 0.0 else -1.0
    assert -found["b"] @ line == pytest.approx(apart * push * LEAN, rel=1e-9)
    # Moments about both axes by the pitch point P = A + s e.
    P = line * ratio / (ratio - 1.0) * 10e-3
    on_b = -found["b"]
    arm = P - line * 10e-3
    assert arm[0] * on_b[1] - arm[1] * on_b[0] == pytest.approx(J * alpha, rel=1e-9, abs=0.0)
    assert -(P[0] * on_b[1] - P[1] * on_b[0]) == pytest.approx(J * alpha / ratio - M, rel=1e-9, abs=0.0)


def test_a_rack_presses_its_pinion_away(tmp_path: Path) -> None:
    rack = 'motion = "slide"\naxis = [1, 0]\nmass = "10 g"\nposition = ["0 mm", "-5 mm"]'
    scene = scene_of(tmp_path, {"pinion": at(0), "rack": rack}, [("pinion", "rack", '"5 mm/rad"', "")], {"rack": "-0.2 N"})
    found = loads_at(scene)
    speeding = -0.2 / (10e-3 + 1e-7 / 5e-3**2)  # m/s², of the rack
    push = 1e-7 * speeding / 5e-3 / 5e-3  # N on the pinion's teeth
    # Turning counter-clockwise the pinion takes the rack below it to the right; the rack pushes it to the left, and up.
    assert found["pinion"] == pytest.approx([-push, -abs(push) * LEAN], rel=1e-9)


@pytest.mark.parametrize("ratio", [2.0, -3.0])
def test_a_planet_loads_the_bearing_of_its_carrier(tmp_path: Path, ratio: float) -> None:
    """Round a fixed wheel, or within a fixed ring: the carrier's bearing takes what the fixed teeth press, and what turns."""
    planet = at(10) + '\non = "carrier"\nmass = "1 g"'
    bodies = {"carrier": 'mass = "2 g"', "planet": planet}
    scene = scene_of(tmp_path, bodies, [("carrier", "planet", ratio, "")], {"carrier": "1 mN·m"})
    found = loads_at(scene, 1e-6)["carrier"]
    J, m, d = 1e-7, 1e-3, 10e-3
    alpha = M / (J + m * d * d + J * (1.0 + ratio) ** 2)
    radius = d / (1.0 + ratio)
    along = -J * (1.0 + ratio) * alpha / radius  # on the planet, across the arm
    assert (J + m * d * d) * alpha == pytest.approx(M + along * d, rel=1e-12, abs=0.0)
    # Bearing: momentum of the planet less the tooth. The carrier turns by next to nothing in a microsecond.
    away = math.copysign(LEAN, radius) * abs(along)
    assert found == pytest.approx([-away, m * d * alpha - along], rel=1e-6, abs=1e-6)


def test_dry_friction_of_a_bearing_that_stands_hides_nothing(tmp_path: Path) -> None:
    """The wheel at the end is held by its bearing's friction: its own equation says nothing, the others do."""
    scene = scene_of(tmp_path, {"a": at(0), "b": at(10)}, [("a", "b", -1, "")], {"a": "1 mN·m"})
    text = (tmp_path / "scene.toml").read_text(encoding="utf-8")
    scene = read(tmp_path, text + '[[damping]]\nbody = "b"\ncoulomb = "2 mN·m"\n')
    found = loads_at(scene)
    push = M / 5e-3
    assert found["b"] == pytest.approx([-push * LEAN, -push], abs=1e-9)


def test_an_angle_of_pressure_that_cannot_be_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="must lie between 0° and 45°"):
        scene_of(tmp_path, {"a": at(0), "b": at(10)}, [("a", "b", -1, 'pressure_angle = "60°"')], {})


# Are distance, work of friction and N s of what slides those of closed forms, and do they add up to the ledger of a run?

G = 9.81
FLOOR = '[bodies.floor]\nline = [["2000 mm", "0 mm"], ["-2000 mm", "0 mm"]]\nmotion = "fixed"\n'
BLOCK = """
[bodies.block]
polygon = [["-10 mm", "-5 mm"], ["10 mm", "-5 mm"], ["10 mm", "5 mm"], ["-10 mm", "5 mm"]]
motion = "free"
mass = "0.2 kg"
position = ["0 mm", "5 mm"]
velocity = ["{speed} mm/s", "0 mm/s"]
"""
DISC = """
[bodies.disc]
circle = "10 mm"
motion = "free"
mass = "0.3 kg"
position = ["0 mm", "{high} mm"]
velocity = ["{along} m/s", "{down} m/s"]
spin = "{spin} rad/s"
"""


def worn(
    folder: Path, bodies: str, gravity: tuple[float, float], friction: float, seconds: float
) -> tuple[ws.Trajectory, Wear]:
    name = "disc" if "circle" in bodies else "block"
    head = f'[scene]\nschema = 1\ngravity = ["{gravity[0]!r} m/s²", "{gravity[1]!r} m/s²"]\n'
    contact = f'[[contacts]]\nbetween = ["{name}", "floor"]\nfriction = {friction}\nrestitution = 0.0\n'
    (folder / "scene.toml").write_text(f'{head}{bodies}{FLOOR}{contact}[run]\nduration = "{seconds} s"\n', encoding="utf-8")
    run = ws.simulate(ws.load(folder))
    return run, ws.wear(run)


def test_a_block_on_an_incline(tmp_path: Path) -> None:
    """Both corners slide s = a t² / 2; N = m g cos α does the work μ N s."""
    slope, mu, t = math.radians(20.0), 0.25, 0.3
    run, found = worn(tmp_path, BLOCK.format(speed=0), (G * math.sin(slope), -G * math.cos(slope)), mu, t)
    press = 0.2 * G * math.cos(slope)
    way = 0.5 * G * (math.sin(slope) - mu * math.cos(slope)) * t**2
    assert found.friction == pytest.approx(mu * press * way, rel=1e-9)
    assert found.friction == pytest.approx(run.energy["dissipated"]["friction"], rel=1e-9)
    block, floor = found.places
    assert (block.body, floor.body) == ("block", "floor")
    for one in (block, floor):
        assert one.distance == pytest.approx(2.0 * way, rel=1e-9)  # of two corners
        assert one.index == pytest.approx(press * way, rel=1e-9)
        assert one.volume(1e-4, 7e9) == pytest.approx(1e-4 * press * way / 7e9, rel=1e-9)
    assert sum(cells.sum() for cells in found.along.values()) == pytest.approx(2.0 * press * way, rel=1e-9)
    assert found.in_a_year(found.friction) == pytest.approx(found.friction * 365.25 * 86400.0 / t)


def test_a_block_that_stops_gives_all_its_energy_to_friction(tmp_path: Path) -> None:
    _, found = worn(tmp_path, BLOCK.format(speed=300), (0.0, -G), 0.25, 0.2)
    assert found.friction == pytest.approx(0.5 * 0.2 * 0.3**2, rel=1e-9)
    assert found.places[0].distance == pytest.approx(2.0 * 0.3**2 / (2.0 * 0.25 * G), rel=1e-9)


@pytest.mark.parametrize("spin", [0.0, -100.0])
def test_a_disc_wears_until_it_rolls(tmp_path: Path, spin: float) -> None:
    """A disc slides v² / (6 μ g), which takes m v² / 6; one that rolls wears nothing."""
    text = DISC.format(high=10, along=1, down=0, spin=spin)
    _, found = worn(tmp_path, text, (0.0, -G), 0.2, 0.5)
    if spin:
        assert all(one.distance < 1e-12 and one.index < 1e-11 for one in found.places)
    else:
        assert found.friction == pytest.approx(0.3 / 6.0, rel=1e-9)
        assert found.places[0].distance == pytest.approx(1.0 / (6.0 * 0.2 * G), rel=1e-9)


@pytest.mark.parametrize("mu", [0.05, 2.0])
def test_a_percussion_works_on_the_mean_slip(tmp_path: Path, mu: float) -> None:
    """A disc that strikes with v across: Λ_N = m w, Λ_T = μ Λ_N on v − 3 μ w / 2 while it slides on, m v / 3 on v / 2 else."""
    v, w, m = 1.0, 0.5, 0.3
    run, found = worn(tmp_path, DISC.format(high=12, along=v, down=-w, spin=0), (0.0, 0.0), mu, 0.02)
    mean = v - 1.5 * mu * w if 3.0 * mu * w < v else 0.5 * v
    pushed = min(mu * m * w, m * v / 3.0)
    assert found.percussions == pytest.approx(pushed * mean, rel=1e-9)
    assert found.percussions + 0.5 * m * w**2 == pytest.approx(run.energy["dissipated"]["impacts"], rel=1e-9)
    assert found.places[0].index == pytest.approx(m * w * mean, rel=1e-9)
    after = (0.02 - 2e-3 / w) * max(v - 3.0 * mu * w, 0.0)  # without load
    assert found.friction == pytest.approx(0.0, abs=1e-15) and found.places[0].distance == pytest.approx(after, abs=1e-12)


@pytest.mark.slow
def test_a_lever_escapement_wears_all_teeth_alike() -> None:
    """What places lose is the ledger's friction; over a turn of the wheel every tooth comes to each stone once."""
    run = ws.simulate(ws.profiles_dir() / "swiss_lever", 6.0)
    whole = ws.wear(run)
    assert whole.friction == pytest.approx(run.energy["dissipated"]["friction"], rel=1e-9)
    assert sum(one.friction for one in whole.places) == pytest.approx(2.0 * whole.friction, rel=1e-12)
    assert 0.0 < whole.percussions < run.energy["dissipated"]["impacts"]
    found = ws.wear(run, (2.2, 2.2 + 3.75))
    teeth = [one.index for one in found.places if one.name.startswith("tooth ")]
    assert len(teeth) == 15 and max(teeth) == pytest.approx(min(teeth), rel=0.01)
    names = {one.name for one in found.places if one.body == "lever"}
    assert {f"{side} stone {face}" for side in ("entry", "exit") for face in ("locking face", "impulse face")} < names
    assert found.typical[0].index == pytest.approx(sum(teeth) / 15) and "tooth mean of 15" in found.typical[0].name
    assert str(found).count("\n") == len(found.places)


def test_nothing_is_known_outside_of_what_was_recorded(tmp_path: Path) -> None:
    run, _ = worn(tmp_path, BLOCK.format(speed=0), (0.0, -G), 0.2, 0.01)
    with pytest.raises(ValueError, match="no step of the run was recorded there"):
        ws.wear(run, (1.0, 2.0))
