"""Is every save followed, once, and nobody else served?"""

import builtins
import os
import signal
import socket
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from live.follower import Follower, copied, following

from watchsim.cli import main
from watchsim.live.edit import Edits, Refused, knobs, values
from watchsim.scene.load import load

DESIGNED = '[design]\nof = "swiss_lever"\nlock = "1.5°"  # chosen\n\n[run]\nduration = "2 s"\n'


# What can be changed, and taken back.


def test_a_number_is_written_where_it_stands_and_taken_back_to_the_byte(tmp_path: Path) -> None:
    path = copied("swiss_lever", tmp_path) / "scene.toml"
    before, edits = path.read_bytes(), Edits(path)
    edits.set("contacts.0.friction", "0.15")
    edits.set("bodies.lever.position.0", "1 µm")
    lines = zip(before.decode().splitlines(), path.read_text(encoding="utf-8").splitlines(), strict=True)
    assert [new for old, new in lines if new != old] == [
        'position = ["1 µm", "2.771281292110203 mm"]   # 2.4 mm / cos 30°',
        "friction    = 0.15",
    ]
    assert load(path).contacts[0].friction == 0.15
    assert load(path).body("lever").position[0] == pytest.approx(1e-6)
    edits.undo()
    edits.undo()
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("contacts.0.friction", "1 mm", "friction|number|length"),
        ("bodies.lever.drawing", "other.dxf", "no such number"),
        ("bodies.lever.inertia", "heavy", "heavy|number|quantity"),
        ("contacts.9.friction", "0.1", "no such number"),
    ],
)
def test_what_does_not_fit_is_refused_and_the_file_left_alone(tmp_path: Path, key: str, value: str, words: str) -> None:
    path = copied("swiss_lever", tmp_path) / "scene.toml"
    before = path.read_bytes()
    with pytest.raises(Refused, match=words):
        Edits(path).set(key, value)
    assert path.read_bytes() == before


def test_what_was_changed_elsewhere_since_is_not_taken_back(tmp_path: Path) -> None:
    path = copied("swiss_lever", tmp_path) / "scene.toml"
    edits = Edits(path)
    edits.set("contacts.0.friction", "0.15")
    mine = path.read_bytes() + b"# by hand\n"
    path.write_bytes(mine)
    with pytest.raises(Refused, match="changed elsewhere"):
        edits.undo()
    assert path.read_bytes() == mine and edits.count == 0


def test_a_design_has_its_dimensions_as_knobs_and_the_rest_as_values(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(DESIGNED, encoding="utf-8")
    scene = load(path)
    lock = next(one for one in knobs(scene) if one["key"] == "design.lock")
    assert lock["value"] == 1.5 and lock["low"] < 1.5 < lock["high"] and lock["unit"] == "°"
    assert values(scene) == [["run.duration", "2 s"]]
    Edits(path).set("design.lock", "1.8 °")
    assert load(path).source["design"]["lock"] == "1.8°" and "# chosen" in path.read_text(encoding="utf-8")
    teeth = next(one for one in knobs(scene) if one["count"])
    Edits(path).set(teeth["key"], str(int(teeth["value"])))


# What is refused before anything is served.


def test_a_port_that_is_taken_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert main(["live", str(copied("incline", tmp_path)), "--no-browser", "--port", str(port)]) == 2
    assert f"--port {port}: Address already in use. Choose another port" in capsys.readouterr().err


def test_without_the_extra_it_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    imported = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name == "watchsim.live.server":
            raise ModuleNotFoundError("No module named 'uvicorn'", name="uvicorn")
        return imported(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    assert main(["live", str(copied("incline", tmp_path))]) == 2
    assert "pip install 'watchsim[live]'" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["nowhere"], ["profiles", "--port", "99999"]])
def test_bad_input_is_refused(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["live", *words]) == 2
    assert "Traceback" not in capsys.readouterr().err


# What is followed, by the process and its protocol.


def by_writing(path: Path, content: bytes) -> None:
    path.write_bytes(content)


def by_renaming(path: Path, content: bytes) -> None:
    beside = path.with_name(f".{path.name}.part")
    beside.write_bytes(content)
    beside.replace(path)


def in_two_pieces(path: Path, content: bytes) -> None:
    """As a slow editor does: empty first, the content a moment later."""
    with path.open("wb") as file:
        time.sleep(0.2)
        file.write(content)


def anew(path: Path, content: bytes) -> None:
    path.unlink()
    time.sleep(0.2)
    path.write_bytes(content)


@pytest.mark.slow
def test_every_way_to_save_is_followed_once_and_without_a_false_fault(tmp_path: Path) -> None:
    scene = copied("incline", tmp_path) / "scene.toml"
    begun = scene.read_text(encoding="utf-8")
    ways: list[Callable[[Path, bytes], None]] = [by_writing, by_renaming, in_two_pieces, anew]
    with following(scene) as follower:
        follower.until("motion", 1)
        for number, save in enumerate(ways, 2):
            save(scene, f"{begun}\n# {number}\n".encode())
            follower.until("motion", number)
        os.utime(scene)  # touched, not changed
        time.sleep(0.5)
        assert follower.orders == 1 + len(ways)
        assert [kind for kind, _ in follower.heard if kind == "faults"] == []
        assert sorted(value["order"] for kind, value in follower.heard if kind == "motion") == list(range(1, 2 + len(ways)))


@pytest.mark.slow
def test_a_drawing_saved_half_finished_shows_its_faults_and_then_the_result_again(tmp_path: Path) -> None:
    folder = copied("swiss_lever", tmp_path)
    drawing = folder / "lever.dxf"
    whole = drawing.read_text(encoding="utf-8")
    first = whole.index("LINE\n")
    half = whole[:first] + whole[first:].replace("\n 10\n", "\n 10\n0.1", 1)
    with following(folder) as follower:
        follower.until("motion", 1)
        drawing.write_text(half, encoding="utf-8")
        found = follower.until("faults", 2, lambda value: bool(value["drawings"]))
        places = [place for one in found["drawings"] for place, _ in one["faults"]]
        assert "bodies.lever.drawing" in found["faults"][0] and any(place.endswith("mm") for place in places)
        drawing.write_text(whole, encoding="utf-8")
        again = follower.until("numbers", 3)
        assert again["changed"] == [] and not again["first"]
        assert follower.until("motion", 3)["data"]["window"] == follower.until("motion", 1)["data"]["window"]


@pytest.mark.slow
def test_a_change_is_compared_saved_and_taken_back(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(DESIGNED, encoding="utf-8")
    with following(path) as follower:
        follower.until("motion", 1)
        assert follower.ask("POST", "/set", {"key": "design.lock", "value": "1.8 °"})[0] == 200
        found = follower.until("numbers", 2)
        assert ["lock", "1.5°", "1.8°"] in found["changed"]
        label, before, now, *_ = found["results"][0]
        assert label == "amplitude (°)" and float(before) > float(now)  # a deeper lock costs more to unlock
        follower.until("motion", 2)
        status, words = follower.ask("POST", "/set", {"key": "design.lock", "value": "80 °"})
        assert status == 409 and "refused" in words
        assert follower.ask("POST", "/undo")[0] == 200
        follower.until("motion", 3)
        assert path.read_text(encoding="utf-8") == DESIGNED
        assert follower.ask("POST", "/undo")[0] == 409


@pytest.mark.slow
def test_the_next_save_begins_a_new_engine_where_one_was_ended_from_outside(tmp_path: Path) -> None:
    scene = copied("incline", tmp_path) / "scene.toml"
    with following(scene) as follower:
        follower.until("motion", 1)
        for number in descendants(follower):
            os.kill(number, signal.SIGKILL)
        assert "ended from outside" in follower.until("faults", 1)["faults"][0]
        scene.write_text(scene.read_text(encoding="utf-8") + "\n# again\n", encoding="utf-8")
        follower.until("motion", 2)


@pytest.mark.slow
def test_only_who_has_the_token_and_comes_from_here_is_served_and_the_end_leaves_nothing(tmp_path: Path) -> None:
    with following(copied("incline", tmp_path)) as follower:
        token, port = follower.token, follower.address.rpartition(":")[2]
        for path in ("/", "/events", f"/?token={token[:-1]}", "/?token="):
            assert follower.ask("GET", path, headers={"Accept": "*/*"})[0] == 403
        for headers in ({"Host": "evil.example"}, {"Host": f"evil.example:{port}"}):
            assert follower.ask("GET", f"/?token={token}", headers=headers)[0] == 400
        assert follower.ask("POST", "/undo", headers={"X-Token": token, "Origin": "http://evil.example"})[0] == 403
        assert follower.ask("POST", "/undo", headers={"X-Token": token, "Origin": "http://127.0.0.1:1"})[0] == 403
        assert follower.ask("GET", f"/?token={token}", headers={"Host": f"localhost:{port}"})[0] == 200
        follower.until("motion", 1)
        children = descendants(follower)
        assert children
        assert follower.ended() == 130
        gone = time.monotonic() + 5.0
        while any(Path(f"/proc/{number}").is_dir() for number in children) and time.monotonic() < gone:
            time.sleep(0.05)
        assert not [number for number in children if Path(f"/proc/{number}").is_dir()]


def descendants(follower: Follower) -> list[int]:
    """Of the process that serves, as Linux knows them."""
    found, waiting = [], [follower.process.pid]
    while waiting:
        for task in Path(f"/proc/{waiting.pop()}/task").iterdir():
            listed = [int(word) for word in (task / "children").read_text().split()]
            found += listed
            waiting += listed
    return found
