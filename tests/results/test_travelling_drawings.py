"""Do drawings travel with results, each under a name of its own, so that the scene loads again anywhere?"""

import dataclasses
import shutil
from pathlib import Path

import dxf_text as d
import pytest
from render.fake_runs import watch_run

import watchsim as ws

PLACES = ("a/wheel.dxf", "b/wheel.dxf", "c/Wheel.dxf", "d/wheel.dxf", "e/lever.dxf")  # drawings of one name, in other folders
RADII = (1.0, 1.25, 1.5, 1.25, 1.25)  # mm: the second, fourth and fifth are the same drawing


def stands_still(scene: ws.Scene) -> ws.Trajectory:
    """A run in which nothing can move."""
    run = watch_run(**scene.__dict__)
    columns = {name: getattr(run, name)[:, :0] for name in ("q", "u", "a")}
    return dataclasses.replace(run, **columns, slices={}, events=run.events[:0], pairs=())


@pytest.mark.parametrize("backslash", [False, True])
def test_different_drawings_get_different_names(backslash: bool, tmp_path: Path) -> None:
    """Whatever the case of their letters; the same drawing is kept once for each name it had."""
    text = '[run]\nduration = "2 s"\n'
    for k, (place, radius) in enumerate(zip(PLACES, RADII, strict=True)):
        name = place.replace("/", "\\") if backslash else place
        path = tmp_path / "desk" / name
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_bytes(d.dxf(d.circle(0, 0, radius)))
        text += f'[bodies.b{k}]\ndrawing = \'{name}\'\nmotion = "fixed"\nposition = ["{10 * k} mm", "0 mm"]\n'
    file = tmp_path / "desk" / "scene.toml"
    file.write_text(text, encoding="utf-8")
    scene = ws.load(file)
    before = {name: (tmp_path / "desk" / name).read_bytes() for name in scene.drawings}
    folder = ws.write_results(stands_still(scene), tmp_path / "out")
    shutil.rmtree(tmp_path / "desk")
    assert sorted(path.name for path in (folder / "drawings").iterdir()) == [
        *("Wheel_3.dxf", "lever.dxf", "wheel.dxf", "wheel_2.dxf")
    ]
    kept = ("wheel.dxf", "wheel_2.dxf", "Wheel_3.dxf", "wheel_2.dxf", "lever.dxf")
    for name, there in zip(before, kept, strict=True):
        assert (folder / "drawings" / there).read_bytes() == before[name]
    again = ws.read_results(folder).scene
    assert [body.loops for body in again.bodies] == [body.loops for body in scene.bodies]


def test_of_bodies_made_by_hand_nothing_travels(tmp_path: Path) -> None:
    folder = ws.write_results(watch_run(), tmp_path / "out")
    assert (folder / "scene.lock.toml").read_bytes() == b"" and not (folder / "drawings").exists()
