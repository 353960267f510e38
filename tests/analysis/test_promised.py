"""Are slips in [expect] told before a run, and is no number refused that a run does give?"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import pytest
from analysis.made_beats import lever_scene

from watchsim.analysis.promised import USUAL, expectation_faults, impossible, not_begun
from watchsim.analysis.summary import summary
from watchsim.cli import main
from watchsim.commands.common.console import BAD_INPUT
from watchsim.profiles_path import profiles_dir
from watchsim.scene.body import Body
from watchsim.scene.file.load import load
from watchsim.scene.scene import Expectation, Scene
from watchsim.simulation.simulate import simulate

SCENE = profiles_dir() / "bench_lever" / "scene.toml"


def names(numbers: dict[str, object], above: str = "") -> list[str]:
    """Dotted names of all plain numbers."""
    found = []
    for key, value in numbers.items():
        if isinstance(value, dict):
            found += names(value, f"{above}{key}.")
        elif isinstance(value, (int, float)):
            found.append(f"{above}{key}")
    return found


@pytest.mark.parametrize("method", ["pfeiffer-glocker", "moreau"])
def test_every_number_of_a_run_may_be_promised(method: str) -> None:
    scene = load(SCENE)
    numbers = summary(simulate(scene, 1.0, method=method))
    promised = tuple(Expectation(name, 0.0, 1.0, "") for name in names(numbers))
    assert len(promised) > 80 and {"timegrapher.amplitude_deg", "energy.dissipated.friction"} <= {one.key for one in promised}
    assert expectation_faults(dataclasses.replace(scene, expect=promised)) == []


@pytest.mark.parametrize("name", ["bench_lever", "incline"])
def test_what_is_promised_most_often_is_in_every_summary(name: str) -> None:
    usual, all_of = dict(USUAL), summary(not_begun(load(profiles_dir() / name)))
    energy = usual.pop("energy")
    assert isinstance(energy, dict) and set(energy) <= set(all_of["energy"]) and set(usual) <= set(all_of)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('"amplitud" = { value = "275°", tolerance = "1°" }', 'Did you mean "amplitude"?'),
        ('"bodies.lever.x_m" = { value = "275°", tolerance = "1°" }', "is in m, which cannot be compared with °"),
    ],
)
def test_a_slip_is_told_before_the_run(line: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for drawing in SCENE.parent.glob("*.dxf"):
        (tmp_path / drawing.name).write_bytes(drawing.read_bytes())
    text = f"{SCENE.read_text(encoding='utf-8')}\n{line}\n"
    number = next(i for i, one in enumerate(text.splitlines(), 1) if one == line)
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    for command in (["check", str(tmp_path)], ["run", str(tmp_path), "-o", str(tmp_path / "out")]):
        assert main(command) == BAD_INPUT
        told = capsys.readouterr().err
        assert message in told and f"scene.toml:{number}" in told
    assert not (tmp_path / "out").exists()


def sliding(scene: Scene) -> Scene:
    bodies = tuple(dataclasses.replace(b, motion="slide", mass=1e-6) if b.name == "balance" else b for b in scene.bodies)
    return dataclasses.replace(scene, bodies=bodies)


NO_SPRING, NO_LIFT, ALONE, NO_DRIVE = (
    lambda scene: dataclasses.replace(scene, springs=()),
    lambda scene: dataclasses.replace(scene, lift_angle=None),
    lambda scene: dataclasses.replace(scene, contacts=(), torques=()),
    lambda scene: dataclasses.replace(scene, torques=()),
)


@pytest.mark.parametrize(
    ("key", "change", "why"),
    [
        ("amplitude", NO_SPRING, "nothing in it swings on a spring or by gravity"),
        ("amplitude", sliding, "balance slides, so it has no amplitude in degrees"),
        ("timegrapher.amplitude_deg", sliding, "balance slides, so it has no amplitude in degrees"),
        ("rate", sliding, ""),
        ("amplitude", NO_LIFT, ""),
        ("timegrapher.amplitude_deg", NO_LIFT, "it names no lift_angle under [timegrapher]"),
        ("timegrapher.rate_s_per_d", NO_LIFT, ""),
        ("timegrapher.rate_s_per_d", ALONE, "nothing may touch balance, so no beat is heard"),
        ("efficiency", NO_DRIVE, "no driven wheel keeps the oscillator going"),
        ("missed_beats", NO_DRIVE, "no driven wheel keeps the oscillator going"),
        ("impacts", NO_SPRING, ""),
        *((key, lambda scene: scene, "") for key in ("amplitude", "rate", "efficiency", "timegrapher.amplitude_deg")),
    ],
)
def test_what_no_run_can_give_is_refused(key: str, change: Callable[[Scene], Scene], why: str) -> None:
    said = impossible(Expectation(key, 0.0, 1.0, ""), change(lever_scene()))
    assert said == (f'no run of this scene gives "{key}": {why}. Leave it out' if why else "")


def test_a_run_that_has_not_begun_stands_where_its_bodies_start() -> None:
    """As the scene gives it: carried bodies against their carriers."""
    bodies = (
        Body("arm", angle=0.4, inertia=1e-9),
        Body("planet", angle=-0.7, inertia=1e-9, on="arm", position=(1e-3, 0.0)),
        Body("stone", "free", position=(3e-3, 5e-3), angle=0.9, mass=1e-3, inertia=1e-9),
    )
    run = not_begun(Scene("Carried", bodies))
    at = {name: run.q[0, columns].tolist() for name, columns in run.slices.items()}
    assert at["arm"] == pytest.approx([0.4]) and at["planet"] == pytest.approx([-0.7])
    assert at["stone"] == pytest.approx([3e-3, 5e-3, 0.9])
    assert run.t.tolist() == [0.0] and run.q.shape == run.u.shape == run.a.shape == (1, 5)
    assert not run.u.any() and not run.a.any() and len(run.events) == 0
