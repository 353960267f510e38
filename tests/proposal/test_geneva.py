"""Is a Geneva drive known as one, whatever its layers are called, and does its crank carry the wheel on?"""

import math
import random
from dataclasses import replace
from pathlib import Path

import pytest
from assemblies import assembly, scene_of

import watchsim as ws
from watchsim.drawing.write import dxf_text
from watchsim.proposal.propose import propose
from watchsim.proposal.trial import tried
from watchsim.scene.load import load
from watchsim.scene.trains import start_poses
from watchsim.simulation.simulate import simulate

NAMES = {
    "Italian": ("CROCE DI MALTA", "MOTORE PERNO DI TRASCINAMENTO", "MOTORE DISCO", "MOTORE PIASTRA"),
    "French": ("CROIX", "CHEVILLE", "PLATEAU", "BRAS"),
    "German": ("MALTESERKREUZ", "KURBEL_STIFT", "KURBEL_SCHEIBE", "KURBEL_ARM"),
    "English": ("GENEVA WHEEL", "CRANK PIN", "CRANK LOCK", "CRANK WEB"),
    "letters": ("A", "B", "C", "D"),
    "one layer": ("0", "0", "0", "0"),
}
PER_LANGUAGE = 6


def drawn(path: Path, slots: int, names: str, rng: random.Random) -> Path:
    """Somewhere between a locked wheel and the pin deepest in a slot, with or without plate, bores and marked pivots."""
    scene = ws.designs.geneva(slots=slots).scene()
    layers = dict(zip(("WHEEL", "PIN", "DISC", "PLATE"), NAMES[names], strict=True))
    deepest, plate, bores, marks = (rng.random() < 0.5 for _ in range(4))
    plate &= names != "one layer"  # where the pin would be a hole of it
    turned = {"driver": math.pi / 2, "wheel": math.pi / slots} if deepest else {"driver": rng.uniform(-1.5, 0.3), "wheel": 0.0}
    loops, points = [], []
    for body in scene.bodies:
        x, y, angle = start_poses(scene)[body.name]
        for loop in (*body.loops, *body.decoration):
            if (plate or loop.layer != "PLATE") and (bores or not loop.hole):
                loops.append(replace(loop.moved(angle + turned[body.name], (x, y)), layer=layers[loop.layer]))
        points += [("PIVOT", (x, y))] if marks else []
    path.write_text(dxf_text(loops, points), encoding="utf-8")
    return path


@pytest.mark.parametrize("names", NAMES)
def test_a_geneva_drive_is_known_by_pin_and_slots(names: str, tmp_path: Path) -> None:
    """The crank turns evenly with its pin and its locking disc; the wheel follows by one slot a turn, held back a little."""
    rng = random.Random(names)
    for number in range(PER_LANGUAGE):
        slots = 4 + number % 5
        path = drawn(tmp_path / f"{number}.dxf", slots, names, rng)
        found = tried([path])
        assert (sorted(role.task for role in found.roles), found.doubts, len(found.contacts)) == (["driver", "wheel"], (), 2)
        folder = tmp_path / str(number)
        folder.mkdir()
        for name, data in found.files.items():
            (folder / name).write_bytes(data)
        scene = load(folder)
        wheel = next(role.name for role in found.roles if role.task == "wheel")
        assert [body.prescribed is not None for body in scene.bodies] == [True, False]
        assert [damping.body for damping in scene.damping] == [wheel]
        run = simulate(scene, 2.0)
        way = run.q[-1, run.slices[wheel].start] - run.q[0, run.slices[wheel].start]
        assert abs(way) == pytest.approx(2.0 * math.tau / slots, abs=math.radians(0.5))


@pytest.mark.parametrize(
    "name", ["swiss_lever", "set_a", "pin_pallet", "jumper", "geneva_stop", "winding_click", "ratchet", "pin_wheel", "coaxial"]
)
def test_no_other_mechanism_is_a_geneva_drive(name: str, tmp_path: Path) -> None:
    """Their pins, discs and teeth do not fit each other as these do."""
    for layers in ("own", "body", "whole"):
        found = propose([assembly(scene_of(name), tmp_path / f"{layers}.dxf", layers)])
        assert "Geneva" not in found.files["scene.toml"].decode()
