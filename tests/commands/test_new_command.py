"""Does `watchsim new` list, refuse and write what it says?"""

from __future__ import annotations

import json

import pytest
from every_time import few

from watchsim.cli import main
from watchsim.construction.registry import names
from watchsim.scene.load import load


def test_writes_a_scene_that_loads(tmp_path, capsys):
    folder = tmp_path / "my_lever"
    options = ["--lock", "2°", "--draw", "13.5°", "--teeth", "20", "-o", str(folder)]
    assert main(["new", "swiss_lever", *options]) == 0
    names = ["banking.dxf", "escape_wheel.dxf", "lever.dxf", "roller.dxf", "scene.toml"]
    assert sorted(path.name for path in folder.iterdir()) == names
    assert load(folder).title == "Swiss lever, 28800 vph, 20 teeth"
    assert "lock = 2° (default 1.5°)" in (folder / "scene.toml").read_text(encoding="utf-8")
    assert main(["check", str(folder)]) == 0
    capsys.readouterr()
    assert main(["new", "swiss_lever", "-o", str(folder)]) == 2
    assert "was not changed" in capsys.readouterr().err
    assert main(["new", "swiss_lever", "-o", str(folder), "--force", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["dimensions"]["lock"] == "1.5°"
    assert sorted(told["files"]) == names


def test_lists(capsys):
    assert main(["new", "--list"]) == 0
    assert "swiss_lever" in capsys.readouterr().out
    assert main(["new", "swiss_lever", "--list"]) == 0
    told = capsys.readouterr().out
    assert "--lock" in told
    assert "Playtner 1910" in told
    assert main(["new", "--list", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["designs"][0]["name"] == "swiss_lever"
    assert main(["new", "swiss_lever", "--list", "--json"]) == 0
    rows = {row["name"]: row for row in json.loads(capsys.readouterr().out)["dimensions"]}
    assert {key: rows["lock"][key] for key in ("unit", "default", "low", "high")} == {
        "unit": "°",
        "default": 1.5,
        "low": 0.1,
        "high": 4.0,
    }


REFUSED = [
    (["new"], "name a design"),
    (["new", "swis_lever"], 'Did you mean "swiss_lever"?'),
    (["new", "swiss_lever", "--lok", "2°"], 'Did you mean "--lock"?'),
    (["new", "swiss_lever", "extra"], "belongs to no option"),
    (["new", "swiss_lever", "--lock", "2"], "a bare number needs a unit here"),
    (["new", "swiss_lever", "--lock", "9°", "--draw", "1°"], "design.draw"),
    (["new", "swiss_lever", "--teeth", "30"], "leave 0.3° for the stone"),
]


@pytest.mark.parametrize(("words", "told"), REFUSED)
def test_refused(words, told, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2
    said = capsys.readouterr()
    assert told in said.err
    assert not said.out
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", few(names(), lambda name: name not in ("involute_pair", "cycloidal_pair")))
def test_every_design_can_be_drawn_from_the_command_line(name, tmp_path, capsys):
    """No dimension is called like an option of the command."""
    assert main(["new", name, "-o", str(tmp_path / "made")]) == 0
    assert (tmp_path / "made" / "scene.toml").exists()
