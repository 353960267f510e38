"""Does `watchsim new` list, refuse and write what it says?"""

import json

import pytest
from every_time import few

from watchsim.cli import main
from watchsim.construction.registry import names
from watchsim.designs import Maker
from watchsim.scene.designed import designed
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.schema import FILE

DRAWINGS = ["banking.dxf", "escape_wheel.dxf", "lever.dxf", "roller.dxf"]


def _files(folder):
    return sorted(path.name for path in folder.iterdir())


def test_writes_a_scene_whose_dimensions_can_be_changed(tmp_path, capsys):
    folder = tmp_path / "my_lever"
    assert main(["new", "swiss_lever", "--lock", "2°", "--draw", "13.5°", "--teeth", "20", "-o", str(folder)]) == 0
    assert _files(folder) == [FILE, "scene.toml"]
    scene = load(folder)
    assert scene.title == "Swiss lever, 28800 vph, 20 teeth"
    assert set(scene.source["design"]) == {"of", *(one.name for one in Maker(designed("swiss_lever")).dimensions)}
    assert scene.set("design.teeth", "18").title == "Swiss lever, 28800 vph, 18 teeth"
    assert scene.tolerances
    assert main(["check", str(folder)]) == 0
    capsys.readouterr()


def test_drawings_are_written_where_they_are_requested(tmp_path, capsys):
    folder = tmp_path / "my_lever"
    assert main(["new", "swiss_lever", "--lock", "2°", "--drawings", "-o", str(folder)]) == 0
    assert _files(folder) == [*DRAWINGS, FILE, "scene.toml"]
    assert "lock = 2° (default 1.5°)" in (folder / "scene.toml").read_text(encoding="utf-8")
    with pytest.raises(SceneError, match="watchsim new swiss_lever"):
        load(folder).set("design.lock", "1.5°")
    capsys.readouterr()


@pytest.mark.parametrize("name", few(names(), lambda name: name not in ("graham", "cam")))
def test_a_scene_of_dimensions_is_the_scene_of_the_drawings(name, tmp_path):
    drawn = Maker(designed(name))()
    one, other = (load(drawn.write(tmp_path / str(drawings), drawings=drawings)) for drawings in (False, True))
    assert [body.loops for body in one.bodies] == [body.loops for body in other.bodies]
    kinds = [
        *("title", "springs", "torques", "damping", "contacts", "gears", "line_springs", "duration", "tolerances"),
        "lift_angle",
    ]
    assert all(getattr(one, kind) == getattr(other, kind) for kind in kinds)


def test_changing_one_dimension_keeps_all_else(tmp_path, capsys):
    folder, path = tmp_path / "my_lever", tmp_path / "my_lever" / "scene.toml"
    assert main(["new", "swiss_lever", "--teeth", "20", "-o", str(folder)]) == 0
    path.write_text(path.read_text(encoding="utf-8") + '\n[run]\nduration = "3 s" # mine\n', encoding="utf-8")
    capsys.readouterr()
    assert main(["new", "swiss_lever", "--lock", "2°", "-o", str(folder)]) == 2
    assert "was not changed" in capsys.readouterr().err
    assert main(["new", "swiss_lever", "--lock", "2°", "-o", str(folder), "--force", "--json"]) == 0
    said = capsys.readouterr()
    dimensions = json.loads(said.out)["dimensions"]
    assert (dimensions["teeth"], dimensions["lock"], dimensions["draw"]) == ("20", "2°", "13°")
    scene = load(folder)
    assert (scene.source["design"]["lock"], scene.source["design"]["teeth"], scene.duration) == ("2°", "20", 3.0)
    assert path.read_text(encoding="utf-8").endswith("# mine\n")
    assert main(["new", "swiss_lever", "--drawings", "-o", str(folder), "--force"]) == 0
    said = capsys.readouterr()
    assert "teeth = 20, lock = 2°" in said.err and "was replaced" in said.err
    assert load(folder).title == "Swiss lever, 28800 vph, 20 teeth"
    before = path.read_bytes()
    for words in (["swiss_lever", "--teeth", "18"], ["graham"]):
        assert main(["new", *words, "-o", str(folder), "--force"]) == 2
        assert "Choose another folder" in capsys.readouterr().err
    assert path.read_bytes() == before


def test_the_scene_of_another_design_is_not_replaced(tmp_path, capsys):
    assert main(["new", "swiss_lever", "-o", str(tmp_path / "a")]) == 0
    assert main(["new", "graham", "-o", str(tmp_path / "a"), "--force"]) == 2
    assert "another design, swiss_lever" in capsys.readouterr().err


def test_dimensions_kept_are_judged_with_those_given(tmp_path, capsys):
    assert main(["new", "swiss_lever", "--teeth", "20", "-o", str(tmp_path / "a")]) == 0
    before = (tmp_path / "a" / "scene.toml").read_bytes()
    assert main(["new", "swiss_lever", "--lock", "9°", "-o", str(tmp_path / "a"), "--force"]) == 2
    assert "design.lock" in capsys.readouterr().err
    assert (tmp_path / "a" / "scene.toml").read_bytes() == before


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
    (
        ["new", "swiss_lever", "extra"],
        '"extra" belongs to no option. Write --DIMENSION VALUE, such as --teeth 15. For a folder',
    ),
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
