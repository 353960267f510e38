"""Are distance, work of friction and N s of what slides those of closed forms, and do they add up to the ledger of a run?"""

import math
from pathlib import Path

import pytest

import watchsim as ws
from watchsim.analysis.wear import Wear

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
