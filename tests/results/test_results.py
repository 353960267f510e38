"""Is a results folder complete, readable, and never half written?"""

import csv
import dataclasses
import errno
import io
import json
import math
import zipfile
from enum import Enum
from pathlib import Path, PurePath
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from render.fake_runs import watch_run

from watchsim.results import archive
from watchsim.results import folder as results
from watchsim.results import tables as module
from watchsim.results.archive import read_trajectory, write_trajectory
from watchsim.results.folder import check_folder, read_results, write_results
from watchsim.results.tables import HEAD, EventLines, json_text, plain, write_events
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.recording import Pair
from watchsim.simulation.state import EVENT_DTYPE, EventKind

SUMMARY = {"amplitude_deg": np.float64(270.5), "rate_s_per_d": math.nan, "impacts": np.int64(3), "stop": "DURATION"}


@pytest.fixture
def run():
    return watch_run(contacts=(Contact((Side("lever"), Side("banking"))),))


def snapshot(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_everything_is_written(run, tmp_path):
    folder = write_results(run, tmp_path / "out", SUMMARY, 'title = "Größe"\n', extra={"plots/a.txt": "a", "b.bin": b"b"})
    assert sorted(path.name for path in folder.iterdir()) == [
        *("b.bin", "events.csv", "plots", "scene.lock.toml", "summary.json", "trajectory.npz")
    ]
    assert json.loads((folder / "summary.json").read_text()) == {
        **{"amplitude_deg": 270.5, "rate_s_per_d": None},
        **{"impacts": 3, "stop": "DURATION"},
    }
    assert (folder / "scene.lock.toml").read_text(encoding="utf-8") == 'title = "Größe"\n'
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_events_in_words(run, tmp_path):
    folder = write_results(run, tmp_path / "out")
    turn, impact = csv.DictReader((folder / "events.csv").read_text().splitlines())
    assert (turn["event"], turn["pair"], turn["bodies"], float(turn["value"])) == ("turn", "", "balance", -5.0)
    assert float(impact["t_s"]) == 1.0 and impact["event"] == "impact" and impact["pair"] == "0"
    assert impact["bodies"] == "lever/banking" and impact["primitives"] == "ARMS corner 3 / PINS arc 1"
    assert [float(impact[name]) for name in ("impulse_N_s", "tangential_impulse_N_s", "energy_lost_J")] == [2e-9, -3e-10, 4e-12]


@pytest.mark.parametrize("as_it_is", [0.0, 1e3, 1e9])  # bytes: all arrays are packed, the long ones, none
def test_a_trajectory_comes_back_to_the_last_bit(run, tmp_path, monkeypatch, as_it_is):
    monkeypatch.setattr("watchsim.results.archive.AS_IT_IS", as_it_is)
    write_trajectory(run, tmp_path / "t.npz")
    with zipfile.ZipFile(tmp_path / "t.npz") as packed:
        ways = {info.filename: info.compress_type for info in packed.infolist()}
    assert ways["q.npy"] == (zipfile.ZIP_DEFLATED if run.q.nbytes > as_it_is else zipfile.ZIP_STORED)
    assert ways["end_q.npy"] == (zipfile.ZIP_DEFLATED if run.end_q.nbytes > as_it_is else zipfile.ZIP_STORED)
    back = read_trajectory(tmp_path / "t.npz", run.scene)
    for name in ("t", "q", "u", "a", "events"):
        assert np.array_equal(getattr(back, name), getattr(run, name)), name
        assert getattr(back, name).dtype == getattr(run, name).dtype
    for name in ("slices", "pairs", "stop", "stop_message", "simulated", "energy", "counts", "tolerance", "method"):
        assert getattr(back, name) == getattr(run, name), name
    assert np.array_equal(back.at(0.777)[0], run.at(0.777)[0])


def test_a_trajectory_with_pairs_in_words_comes_back(run, tmp_path):
    """As earlier versions wrote it: format 3, every pair in words in the header."""
    write_trajectory(run, tmp_path / "new.npz")
    with np.load(tmp_path / "new.npz") as file:
        arrays = dict(file)
    header = json.loads(arrays.pop("header").tobytes())
    del header["names"], arrays["pairs"]
    header |= {"format": 3, "pairs": [dataclasses.asdict(pair) for pair in run.pairs]}
    np.savez(tmp_path / "old.npz", header=np.frombuffer(json.dumps(header).encode(), np.uint8), **arrays)
    back = read_trajectory(tmp_path / "old.npz", run.scene)
    assert back.pairs == run.pairs and len(run.pairs) > 0
    assert np.array_equal(back.q, run.q) and np.array_equal(back.events, run.events)


def test_an_existing_folder_is_left_alone_without_force(run, tmp_path):
    folder = write_results(run, tmp_path / "out", {"n": 1})
    before = snapshot(folder)
    with pytest.raises(FileExistsError, match="already exists and was not changed"):
        write_results(run, folder, {"n": 2})
    with pytest.raises(FileExistsError):
        check_folder(folder)
    assert check_folder(folder, force=True) == folder
    assert snapshot(folder) == before


def test_force_replaces_results_but_keeps_other_files(run, tmp_path):
    folder = write_results(run, tmp_path / "out", {"n": 1}, extra={"plots/last_beats.png": b"old"})
    (folder / "notes.txt").write_text("mine")
    write_results(run, folder, {"n": 2}, force=True)
    assert json.loads((folder / "summary.json").read_text()) == {"n": 2}
    assert (folder / "notes.txt").read_text() == "mine"
    assert not (folder / "plots").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_what_is_no_results_folder_is_never_replaced(run, tmp_path):
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "thesis.txt").write_text("years of work")
    with pytest.raises(FileExistsError, match="holds no results"):
        write_results(run, tmp_path / "home", force=True)
    (tmp_path / "file").write_text("x")
    with pytest.raises(FileExistsError, match="is a file"):
        write_results(run, tmp_path / "file", force=True)
    (tmp_path / "empty").mkdir()
    assert (write_results(run, tmp_path / "empty") / "summary.json").is_file()


def full_disk(*_):
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("writer", ["write_trajectory", "write_events", "json_text"])
def test_a_full_disk_leaves_everything_as_it_was(run, tmp_path, monkeypatch, writer):
    folder = write_results(run, tmp_path / "out", {"n": 1})
    before = snapshot(folder)
    monkeypatch.setattr(results, writer, full_disk)
    for target, force in ((folder, True), (tmp_path / "new", False)):
        with pytest.raises(OSError, match="No space left on device; nothing was changed") as caught:
            write_results(run, target, {"n": 2}, force=force)
        assert caught.value.errno == errno.ENOSPC
    assert snapshot(folder) == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_an_interrupt_while_writing_leaves_everything_as_it_was(run, tmp_path):
    def interrupt(path):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_results(run, tmp_path / "out", extra={"movie.mp4": interrupt})
    assert list(tmp_path.iterdir()) == []


def test_the_old_folder_comes_back_if_the_exchange_fails(run, tmp_path, monkeypatch):
    folder = write_results(run, tmp_path / "out", {"n": 1})
    before = snapshot(folder)
    rename = results.Path.rename

    def failing(self, target):
        if self.name == "new":
            raise PermissionError(errno.EACCES, "Permission denied")
        return rename(self, target)

    monkeypatch.setattr(results.Path, "rename", failing)
    with pytest.raises(PermissionError, match="nothing was changed"):
        write_results(run, folder, {"n": 2}, force=True)
    assert snapshot(folder) == before


def test_extra_files_stay_inside(run, tmp_path):
    with pytest.raises(ValueError, match="outside the results folder"):
        write_results(run, tmp_path / "out", extra={"../escape.txt": "x"})
    assert list(tmp_path.iterdir()) == []


def test_what_cannot_be_read_says_why(run, tmp_path, monkeypatch):
    with pytest.raises(FileNotFoundError, match="no such results folder"):
        read_results(tmp_path / "none")
    (tmp_path / "empty").mkdir()
    with pytest.raises(FileNotFoundError, match=r"scene.lock.toml and trajectory.npz missing"):
        read_results(tmp_path / "empty")
    write_trajectory(run, tmp_path / "t.npz")
    other = watch_run(bodies=run.scene.bodies[:2]).scene
    with pytest.raises(ValueError, match="do not belong together"):
        read_trajectory(tmp_path / "t.npz", other)
    whole = (tmp_path / "t.npz").read_bytes()
    for damaged in (whole[: len(whole) // 2], b"", b"hello"):
        (tmp_path / "t.npz").write_bytes(damaged)
        with pytest.raises(ValueError, match="damaged"):
            read_trajectory(tmp_path / "t.npz", run.scene)
    monkeypatch.setattr(archive, "FORMAT_ARCHIVE", 9)
    write_trajectory(run, tmp_path / "t.npz")
    monkeypatch.undo()
    with pytest.raises(ValueError, match="has format 9; this version reads format 4"):
        read_trajectory(tmp_path / "t.npz", run.scene)


@pytest.mark.parametrize("name, at", [("pairs", 0), ("pairs", 1), ("events", "contact"), ("events", "body")])
@pytest.mark.parametrize("number", [-2, 10**6])
def test_numbers_that_lead_nowhere_are_found_when_read(run, tmp_path, name, at, number):
    """A pair of primitives that are not there was looked up when a plot asked for its name: an IndexError."""
    write_trajectory(run, tmp_path / "t.npz")
    with np.load(tmp_path / "t.npz") as file:
        arrays = dict(file)
    if name == "pairs":
        arrays[name][-1, at] = number
    else:
        arrays[name][at][-1] = number
    np.savez(tmp_path / "t.npz", **arrays)
    with pytest.raises(ValueError, match=r"t\.npz is damaged .* unknown"):
        read_trajectory(tmp_path / "t.npz", run.scene)


@pytest.mark.parametrize("name", ["overlap", "energy", "counts", "sums"])
def test_sums_that_are_no_table_are_found_when_read(run, name):
    archive._check(run)
    with pytest.raises(ValueError, match="holds no sums"):
        archive._check(dataclasses.replace(run, **{name: [1.0]}))


def test_json_is_strict():
    assert json.loads(json_text({"a": [np.inf, np.array([1.5, np.nan])], "b": (True, None, "µ")})) == {
        **{"a": [None, [1.5, None]]},
        **{"b": [True, None, "µ"]},
    }


def test_results_of_a_scene_file_can_be_read_back(tmp_path):
    lock = pytest.importorskip("watchsim.results.folder")
    load = pytest.importorskip("watchsim.scene.load")
    scene_file = tmp_path / "scene.toml"
    scene_file.write_text(
        '[scene]\ntitle = "T"\nschema = 1\n[bodies.a]\ncircle = "2 mm"\ninertia = "1 mg·cm²"\n'
        '[[springs]]\nbody = "a"\nfrequency = "4 Hz"\n[run]\nduration = "2 s"\n',
        encoding="utf-8",
    )
    scene = load.load(scene_file)
    run = watch_run(**scene.__dict__)
    columns = {name: getattr(run, name)[:, :1] for name in ("q", "u", "a")}
    alone = dataclasses.replace(run, **columns, slices={"a": slice(0, 1)}, events=run.events[:0], pairs=())
    folder = write_results(alone, tmp_path / "out", scene_lock=lock.lock_text(scene, tmp_path / "out"))
    back = read_results(folder)
    assert back.scene == scene
    assert np.array_equal(back.q, alone.q)


# Are events and numbers written as a slow writer, row by row, would write them?

SCENE = Scene("Made", (Body("wheel"), Body('odd, "name"'), Body("lever")))
PAIRS = (
    Pair(0, "wheel", "corner", 3, "TEETH", "lever", "line", 5, "STONES"),
    Pair(1, 'odd, "name"', "arc", 7, "PIN", "lever", "line", 2, "FORK"),
    Pair(1, "lever", "arc", 4, "", "wheel", "corner", 11, "ARMS, left"),
)


def made(count: int, seed: int = 3) -> Any:
    """Some at one instant, some without a contact, a body or an impulse."""
    rng = np.random.default_rng(seed)
    events = np.zeros(count, EVENT_DTYPE)
    events["t"] = np.sort(rng.choice([0.0, 1e-7, 0.1, 1.0 / 3.0, 2.5], count))
    events["kind"], events["contact"] = rng.choice(list(EventKind), count), rng.integers(-1, len(PAIRS), count)
    events["body"] = rng.integers(-1, len(SCENE.bodies), count)
    for name in ("impulse_normal", "impulse_tangential", "energy_lost"):
        events[name] = rng.choice([0.0, 0.0, 0.0, -0.0, 1.5e-9, -2.0], count)
    events["value"] = rng.choice([0.0, -0.0, -1.0, 0.1, np.nan], count)
    return events


def slowly(events: Any) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerow(HEAD.decode().rstrip().split(","))
    names = [body.name for body in SCENE.bodies]
    for event in events:
        contact, body = int(event["contact"]), int(event["body"])
        sides: tuple[object, ...] = ("", names[body] if body >= 0 else "", "")
        if contact >= 0:
            pair = PAIRS[contact]
            first = f"{pair.layer_a} {pair.primitive_a} {pair.index_a}"
            sides = contact, f"{pair.body_a}/{pair.body_b}", f"{first} / {pair.layer_b} {pair.primitive_b} {pair.index_b}"
        sizes = [repr(float(event[name])) for name in ("impulse_normal", "impulse_tangential", "energy_lost", "value")]
        writer.writerow([repr(float(event["t"])), EventKind(int(event["kind"])).name.lower(), *sides, *sizes])
    return out.getvalue()


def written(path: Path) -> str:
    return path.read_bytes().decode()


@pytest.mark.parametrize("at_once", [3, 7, 1000])
@pytest.mark.parametrize("count", [0, 1, 2, 60])
def test_events_are_those_of_a_slow_writer(count: int, at_once: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "ROWS", at_once)
    run: Any = SimpleNamespace(scene=SCENE, pairs=PAIRS, events=made(count))
    write_events(run, tmp_path / "events.csv")
    assert written(tmp_path / "events.csv") == slowly(run.events)


@pytest.mark.parametrize("begun", [(), (0,), (5,), (3, 4), (10,)])
def test_a_table_that_was_begun_while_the_run_went_on(begun: tuple[int, ...], tmp_path: Path) -> None:
    run: Any = SimpleNamespace(scene=SCENE, pairs=PAIRS, events=made(10))
    lines = EventLines(SCENE, PAIRS, tmp_path)
    for count in begun:
        lines.add(run.events[lines.rows : lines.rows + count])
    assert lines.rows == sum(begun)
    lines.settle(run)
    lines.write(run, tmp_path / "events.csv")
    assert written(tmp_path / "events.csv") == slowly(run.events)
    assert [path.name for path in tmp_path.iterdir()] == ["events.csv"]


def test_a_table_that_could_not_be_settled_is_written_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run: Any = SimpleNamespace(scene=SCENE, pairs=PAIRS, events=made(10))
    for settled in (True, False):
        lines = EventLines(SCENE, PAIRS, tmp_path)
        lines.add(made(4, 99))  # something else: it must not be in the file
        if settled:
            monkeypatch.setattr(lines, "rest", lambda run: (_ for _ in ()).throw(OSError("full")))
            lines.settle(run)
        lines.write(run, tmp_path / f"{settled}.csv")
        assert written(tmp_path / f"{settled}.csv") == slowly(run.events)


class Colour(Enum):
    """An enum whose values are something else than its names."""

    RED = 3


def test_everything_becomes_what_json_knows() -> None:
    folder = PurePath("a") / "b"
    given = {
        **{"text": "Größe", "whole": 3, "true": True, "no": None, "number": 2.5, 7: Colour.RED, "path": Path(folder)},
        **{"np": (np.float64(0.1), np.int64(-4), np.bool_(True), np.float32(0.5)), "array": np.array([[1, 2], [3, 5]])},
        "not": [math.nan, -math.inf, np.float64("nan"), np.array([1.5, np.inf])],
    }
    expected = {
        **{"text": "Größe", "whole": 3, "true": True, "no": None, "number": 2.5, "7": "RED", "path": str(folder)},
        **{"np": [0.1, -4, True, 0.5], "array": [[1, 2], [3, 5]], "not": [None, None, None, [1.5, None]]},
    }
    assert plain(given) == expected and list(plain(given)) == list(expected)
    assert [type(one) for one in plain(given)["np"]] == [float, int, bool, float]
    assert json.loads(json_text(given)) == expected and json_text({"a": "Größe"}) == '{\n  "a": "Größe"\n}\n'
