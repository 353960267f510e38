"""Does hostile or hopeless input end in a message, and what is received from others harm nothing?"""

import csv
import io
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from interpreter import ROOT

from watchsim.cli import main
from watchsim.paths import profiles_dir
from watchsim.results.tables import cell
from watchsim.storage.destination import secure_file
from watchsim.storage.write import write_file
from watchsim.studies.journal import Journal
from watchsim.studies.study_report import csv_text

LEVER = profiles_dir() / "bench_lever"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
@pytest.mark.parametrize("arguments", [["new", "--list"], ["--help"], ["inspect", str(LEVER / "lever.dxf"), "--json"]])
def test_a_full_disk_under_the_output_is_one_line_and_status_2(arguments: list[str]) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "watchsim", *arguments],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2 and "could not all be written: No space left on device" in done.stderr
    assert "Traceback" not in done.stderr


def test_characters_of_others_that_are_not_seen_are_printed_by_their_numbers(tmp_path: Path) -> None:
    """Controls, and marks that turn a line round; in JSON the name is the same as before. Joined emoji stay as they are."""
    name = "ab\u202egnp\u2066\u0085\u00ad\u200dx"
    layer = f'<g inkscape:groupmode="layer" inkscape:label="{name}"><circle r="2"/></g>'
    spaces = 'xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
    (tmp_path / "a.svg").write_text(f'<svg {spaces} viewBox="0 0 9 9">{layer}</svg>', encoding="utf-8")
    (tmp_path / "scene.toml").write_text('[bodies."w\\u202E\\u001b[2Jx"]\nmotion = "fixed"\nmass = "1 s"\n', encoding="utf-8")

    def printed(*arguments: str) -> str:
        command = [sys.executable, "-m", "watchsim", *arguments]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        done = subprocess.run(command, env=environment, capture_output=True, check=False, cwd=tmp_path)
        return (done.stdout + done.stderr).decode("utf-8")

    seen = r"ab\u202egnp\u2066\u0085\u00ad" + "\u200dx"
    texts = printed("inspect", "a.svg"), printed("inspect", "a.svg", "--json"), printed("check", "scene.toml")
    assert all(seen in text for text in texts[:2]) and name in json.loads(texts[1])["layers"]
    assert r"bodies.w\u202e\u001b[2Jx.mass" in texts[2]
    assert not set("\u202e\u2066\u0085\u00ad\x1b\r").intersection("".join(texts))


@pytest.mark.parametrize("value", ["12 " + "(" * 5000 + "mg" + ")" * 5000, "0x" + "f" * 5000, "[0x" + "f" * 5000 + "]"])
def test_endless_values_are_refused(value: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(LEVER), "--set", f"bodies.balance.inertia={value}"]) == 2
    assert "bodies.balance.inertia" in capsys.readouterr().err


def test_whole_numbers_without_end_in_a_scene_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(f"[scene]\ntitle = 'x'\nschema = 0x{'f' * 5000}\n")
    assert main(["check", str(scene)]) == 2
    assert "a whole number of 20000 bits" in capsys.readouterr().err


def test_a_plate_too_thin_for_a_solid_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    thin = ["export", str(LEVER), "--thickness", "2.5e-13 mm", "-o"]
    assert main([*thin, str(tmp_path / "solids")]) == 2
    assert "2.5e-13 mm thick" in capsys.readouterr().err
    assert main([*thin, str(tmp_path / "flat"), "--format", "dxf,svg"]) == 0


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@a", "\t=1", "\r=1"])
def test_texts_in_tables_are_no_formulas_and_numbers_stay(text: str) -> None:
    safe = "'" + text.replace("\r", " ")
    assert cell(text) == safe and cell("lever") == "lever"
    rows = list(csv.reader(io.StringIO(csv_text({"key": [text], "value": [-1.5]}), newline="")))
    assert rows == [["key", "value"], [safe, "-1.5"]]


@pytest.mark.skipif(sys.platform == "win32", reason="links of Unix")
@pytest.mark.parametrize("name", ["report.html", "movie.mp4", "tick.wav", "plots/kinematics.png", "rows.jsonl"])
def test_nothing_is_written_through_a_link_out_of_a_received_folder(name: str, tmp_path: Path) -> None:
    run, mine = tmp_path / "run", tmp_path / "mine"
    for folder in (run, mine):
        folder.mkdir()
    (run / "summary.json").write_text("{}")
    target = mine / Path(name).name
    target.write_text("mine")
    if "/" in name:
        (run / "plots").symlink_to(mine)
    else:
        (run / name).symlink_to(target)
    for write in (secure_file, lambda path, what: write_file(path, lambda place: place.write_text("theirs"), what)):
        with pytest.raises(PermissionError, match="is a link out of the results folder"):
            write(run / name, "the file")
    if name == "rows.jsonl":
        with pytest.raises(PermissionError, match="is a link out of"):
            Journal(run, {}, resume=True)
    assert target.read_text() == "mine" and [one.name for one in mine.iterdir()] == [target.name]


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = tmp_path_factory.mktemp("received") / "run"
    assert main(["run", str(LEVER), "--duration", "0.05 s", "--no-plots", "-o", str(run)]) == 0
    return run


WRITING = {  # what writes to the links of a received folder: "away", to a folder, and "a.<ending>", to files
    "run": f"run {LEVER} --duration 1e-3s --force -o away",
    "run beside": f"run {LEVER} --duration 1e-3s -o away/new",
    "sweep": f"sweep {LEVER} bodies.lever.angle=0,1deg --force -o away",
    "new": "new swiss_lever --force -o away",
    "new of a drawing": f"new {LEVER}/lever.dxf --force -o away",
    "export": f"export {LEVER} --force -o away",
    "bench": "bench --quick --scene incline -o .",
    "bench away": "bench --quick --scene incline -o away",
    "demo": "demo --force -o away",
    "check": f"check {LEVER} --png a.png",
    "inspect": f"inspect {LEVER}/lever.dxf --png a.png",
    "plot": "plot . -o a.png",
    "plots": "plot . --kind kinematics,energy -o away",
    "own plots": "plot .",
    "report": "report . -o a.html",
    "movie": "movie . -o a.mp4",
    "sound": "sound . -o a.wav",
}


@pytest.mark.skipif(sys.platform == "win32", reason="links of Unix")
@pytest.mark.parametrize("command", WRITING.values(), ids=list(WRITING))
def test_no_command_follows_a_link_out_of_a_received_folder(
    command: str, finished: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    mine, received = tmp_path / "mine", shutil.copytree(finished, tmp_path / "received")
    shutil.copytree(finished, mine)
    for name in ("bench.md", *(f"a.{ending}" for ending in ("png", "html", "mp4", "wav"))):
        (mine / name).write_text("mine")
        (received / name).symlink_to(mine / name)
    for name in ("away", "plots"):
        (received / name).symlink_to(mine)
    before = {path: path.read_bytes() for path in mine.rglob("*") if path.is_file()}
    monkeypatch.chdir(received)
    assert main(command.split()) == 2
    assert " is a link out of the " in capsys.readouterr().err
    assert {path: path.read_bytes() for path in mine.rglob("*") if path.is_file()} == before
    assert sum(path.is_symlink() for path in received.iterdir()) == 7


def test_a_link_among_solids_is_replaced_and_not_written_through(tmp_path: Path) -> None:
    """A folder that is written whole changes places with the new one: links of its own files are gone with the old."""
    solids, mine = tmp_path / "solids", tmp_path / "mine"
    mine.write_text("mine")
    solids.mkdir()
    (solids / "export.json").write_text('{"files": ["lever.svg", "export.json"]}')
    (solids / "lever.svg").symlink_to(mine)
    assert main(["export", str(LEVER), "--format", "svg", "--bodies", "lever", "--force", "-o", str(solids)]) == 0
    assert mine.read_text() == "mine" and not (solids / "lever.svg").is_symlink()
