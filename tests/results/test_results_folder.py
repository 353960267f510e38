"""Which folders may be written to, which files in them are ours, and what goes into them?"""

import dataclasses
import errno
import json
import shutil
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import dxf_text as d
import numpy as np
import pytest
from analysis.made_beats import lever_run
from render.fake_runs import watch_run

import watchsim as ws
from watchsim.results import archive
from watchsim.results import folder as module
from watchsim.results.archive import read_state, read_trajectory, whole, write_array, write_state, write_trajectory
from watchsim.results.folder import Packed, check_folder, filler, is_ours, locked_drawings, ours_in, read_results
from watchsim.simulation.saved_state import TALLIED, SavedState
from watchsim.storage.write import PREFIX

RUN = lever_run(2)
LOCKED = "[lock.drawings]\n'drawings/wheel.dxf' = 'a'\n'drawings/lever.svg' = 'b'\n'../own.dxf' = 'c'\n"


@pytest.mark.parametrize(
    ("inside", "free", "forced"),
    [
        ((), True, True),
        ((PREFIX + "x",), True, True),
        (("notes.txt",), False, False),
        (("notes.txt", PREFIX + "x"), False, False),
        (("summary.json", "notes.txt"), False, True),
        (("trajectory.npz",), False, True),
        (("events.csv",), False, False),
    ],
)
def test_only_empty_folders_and_with_force_those_of_results(
    inside: tuple[str, ...], free: bool, forced: bool, tmp_path: Path
) -> None:
    for name in inside:
        (tmp_path / name).write_text("x")
    for force, fits in ((False, free), (True, forced)):
        if fits:
            assert check_folder(tmp_path, force) == tmp_path
        else:
            with pytest.raises(FileExistsError):
                check_folder(tmp_path, force)
    assert check_folder(tmp_path / "new") == tmp_path / "new" and not (tmp_path / "new").exists()


def test_which_files_are_ours(tmp_path: Path) -> None:
    """Drawings only that the locked scene names, and that lie in their folder."""
    ours = ("summary.json", "events.csv", "state.npz", "report.html", "plots", "plots/tape.svg", "plots/last_beats.png")
    others = ("notes.txt", "plots/mine.png", "plots/tape.gif", "tape.svg", "drawings/wheel.dxf", "x/summary.json", "../own.dxf")
    assert all(map(is_ours, ours)) and not any(map(is_ours, others))
    assert not ours_in(tmp_path)("drawings/wheel.dxf") and locked_drawings(tmp_path) == frozenset()
    (tmp_path / "scene.lock.toml").write_text(LOCKED, encoding="utf-8")
    assert locked_drawings(tmp_path) == {"drawings/wheel.dxf", "drawings/lever.svg"}
    here = ours_in(tmp_path)
    assert all(map(here, (*ours, "drawings/wheel.dxf"))) and not any(map(here, ("drawings/own.dxf", *set(others[:4]))))
    for text in ("[lock]\n", "lock = 3\n", "not toml", ""):
        (tmp_path / "scene.lock.toml").write_text(text, encoding="utf-8")
        assert locked_drawings(tmp_path) == frozenset()


def state() -> SavedState:
    tally: Any = {name: np.arange(3.0) for name in TALLIED}
    arrays = {"clock": np.array([0.5, 1.5, 2.5]), "state_q": np.array([7.25])}
    about: dict[str, Any] = {"digest": "abc", "settings": {"method": "x"}, "stored_at_start": 0.25, "rows": 3, "events": 4}
    return SavedState(**about, arrays=arrays, tally=tally, recorded={})


@pytest.mark.parametrize(("begun", "told", "failed", "ended"), list(product((True, False), repeat=4)))
def test_what_a_folder_holds(begun: bool, told: bool, failed: bool, ended: bool, tmp_path: Path) -> None:
    """A trajectory and a table of events that were begun before are not made once more."""
    run = replace(RUN, failure={"t": 1.5} if failed else None, end_state=state() if ended else None)
    files: Any = {"a/notes.txt": "Größe", "b.bin": b"\xff", "c.txt": lambda path: path.write_text("made")}
    files |= {"trajectory.npz": b"begun"} if begun else {}
    files |= {"events.csv": b"told"} if told else {}
    filler(run, {"n": np.int64(3)}, files)(tmp_path)
    names = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    usual = {"summary.json", "trajectory.npz", "events.csv", "a/notes.txt", "b.bin", "c.txt"}
    assert names == usual | ({"lcp_failure.json"} if failed else set()) | ({"state.npz"} if ended else set())
    assert ((tmp_path / "trajectory.npz").read_bytes() == b"begun") is begun
    assert ((tmp_path / "events.csv").read_bytes() == b"told") is told
    assert json.loads((tmp_path / "summary.json").read_text(encoding="utf-8")) == {"n": 3}
    assert not failed or json.loads((tmp_path / "lcp_failure.json").read_text(encoding="utf-8")) == {"t": 1.5}
    assert (tmp_path / "a/notes.txt").read_text(encoding="utf-8") == "Größe" and (tmp_path / "b.bin").read_bytes() == b"\xff"
    assert (tmp_path / "c.txt").read_text(encoding="utf-8") == "made"
    if not begun:
        assert np.array_equal(read_trajectory(tmp_path / "trajectory.npz", run.scene).q, run.q)


def test_with_little_only_motion_and_state(tmp_path: Path) -> None:
    filler(replace(RUN, end_state=state()), None, {"scene.lock.toml": ""})(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"trajectory.npz", "state.npz", "scene.lock.toml"}


def test_what_a_thread_could_not_pack_is_packed_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    good = Packed(RUN, tmp_path)
    good.write(tmp_path / "a.npz")
    monkeypatch.setattr(module, "nameless", lambda folder: (_ for _ in ()).throw(OSError(errno.ENOSPC, "full")))
    Packed(RUN, tmp_path).write(tmp_path / "b.npz")
    for name in ("a.npz", "b.npz"):
        assert np.array_equal(read_trajectory(tmp_path / name, RUN.scene).q, RUN.q)


def test_a_state_comes_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_state(state(), tmp_path / "state.npz")
    back = read_state(tmp_path / "state.npz")
    assert (back.digest, back.settings, back.stored_at_start, back.rows, back.events) == ("abc", {"method": "x"}, 0.25, 3, 4)
    for kept, name in ((back.arrays, "clock"), (back.arrays, "state_q"), (back.tally, next(iter(TALLIED)))):
        assert np.array_equal(kept[name], (state().tally | state().arrays)[name])
    with np.load(tmp_path / "state.npz") as file:
        assert json.loads(file["header"].tobytes())["format"] == 2
    monkeypatch.setattr("watchsim.results.archive.FORMAT", 9)
    with pytest.raises(ValueError, match="written by another version of watchsim"):
        read_state(tmp_path / "state.npz")
    monkeypatch.undo()
    write_state(replace(state(), rows=-1), tmp_path / "state.npz")
    with pytest.raises(ValueError, match="its parts do not fit together"):
        read_state(tmp_path / "state.npz")


def test_a_folder_gives_its_state_back_where_it_has_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("watchsim.results.folder.load", lambda path: RUN.scene)
    (tmp_path / "scene.lock.toml").write_text("")
    write_trajectory(RUN, tmp_path / "trajectory.npz")
    assert read_results(tmp_path).end_state is None
    write_state(state(), tmp_path / "state.npz")
    found = read_results(tmp_path).end_state
    assert found is not None and found.digest == "abc"


@pytest.mark.parametrize("number", [2, 3, 4, 5])
def test_formats_that_can_be_read(number: int, tmp_path: Path) -> None:
    """Of this version and the one before. An overlap was not always looked for."""
    write_trajectory(replace(RUN, overlap={"looks": 3}), tmp_path / "t.npz")
    with np.load(tmp_path / "t.npz") as file:
        arrays = dict(file)
    header = json.loads(arrays.pop("header").tobytes())
    assert header["format"] == archive.FORMAT_ARCHIVE == 4
    del header["overlap"]
    header["format"] = number
    np.savez(tmp_path / "t.npz", header=np.frombuffer(json.dumps(header).encode(), np.uint8), **arrays)
    if number in (3, 4):
        assert read_trajectory(tmp_path / "t.npz", RUN.scene).overlap == {}
    else:
        with pytest.raises(ValueError, match=f"has format {number}; this version reads format 4"):
            read_trajectory(tmp_path / "t.npz", RUN.scene)


def test_what_is_wrong_with_a_file_is_told_in_two_hundred_letters(tmp_path: Path) -> None:
    """What the system says of the disk is passed on as it is."""
    damaged = r"^a\.npz is damaged or is not a state of watchsim \(x{200}\)$"
    with pytest.raises(ValueError, match=damaged), whole(Path("a.npz"), "state"):
        raise RuntimeError("x" * 300)
    with pytest.raises(OSError, match="disk"), whole(Path("a.npz"), "state"):
        raise OSError(errno.EIO, "disk")
    with pytest.raises(ValueError, match=r"\(MemoryError\)"), whole(Path("a.npz"), "state"):
        raise MemoryError
    with pytest.raises(ValueError, match="no number"), whole(Path("a.npz"), "state"):
        raise OSError("no number")


@pytest.mark.parametrize("shape", [(0,), (3,), (70_000, 3), (5, 0)])
def test_arrays_are_written_as_numpy_does(shape: tuple[int, ...], tmp_path: Path) -> None:
    array = np.random.default_rng(1).normal(size=shape)
    for given in (array, array.T):
        with (tmp_path / "a.npy").open("wb") as file:
            write_array(file, given)
        back = np.load(tmp_path / "a.npy", allow_pickle=False)
        assert back.dtype == given.dtype and np.array_equal(back, given)


# Do drawings travel with results, each under a name of its own, so that the scene loads again anywhere?

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
