"""Does `watchsim export` write what it says, whole or not at all?"""

import json
from pathlib import Path

import ezdxf
import pytest
import trimesh
from every_time import few
from ezdxf import bbox

import watchsim as ws
from watchsim.cli import main
from watchsim.construction.registry import names
from watchsim.designs import Maker
from watchsim.geometry.solids import section
from watchsim.scene.designed import designed
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.schema import FILE

ROOT = Path(__file__).resolve().parents[2]
SWISS = str(ROOT / "profiles" / "swiss_lever")
BODIES = ("wheel", "lever", "balance", "banking")


def test_everything_of_a_scene(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    assert main(["export", SWISS, "-o", str(folder)]) == 0
    told = capsys.readouterr()
    expected = {f"{body}.{kind}" for body in BODIES for kind in ("dxf", "svg", "glb", "stl")} | {"scene.glb", "export.json"}
    assert {path.name for path in folder.iterdir()} == expected
    assert [Path(line).name for line in told.out.split()] == json.loads((folder / "export.json").read_text("utf-8"))["files"]
    assert "0.2 mm is assumed: wheel.TEETH" in told.err
    scene = ws.load(f"{SWISS}/scene.toml")
    for name in BODIES:
        body, again = scene.body(name), ws.read(folder / f"{name}.dxf")
        assert not again.findings and again.points == (("PIVOT", 0.0, 0.0),)
        drawn_loops = (*body.loops, *body.decoration)  # the balance's rim is drawn, too
        one, other = section(drawn_loops).about((0.0, 0.0)), section(again.loops).about((0.0, 0.0))
        assert (other.area, other.polar) == pytest.approx((one.area, one.polar), rel=1e-12, abs=0.0)
        page = ws.read(folder / f"{name}.svg")  # its origin is a corner of the page; the pivot is marked by a circle
        assert not page.findings and (page.units, page.units_from) == ("mm", "page")
        (mark,) = (loop.edges[0] for loop in page.loops if loop.layer == "PIVOT")
        drawn = section(loop for loop in page.loops if loop.layer != "PIVOT").about((mark.x, mark.y))
        assert (drawn.area, drawn.polar) == pytest.approx((one.area, one.polar), rel=1e-12, abs=0.0)
        solid = trimesh.load(folder / f"{name}.stl")
        assert solid.volume == pytest.approx(1e9 * one.area * 0.2e-3, rel=2e-3)
    whole = trimesh.load(folder / "scene.glb")
    assert len(whole.geometry) == 11  # ten layers and the hairspring
    pivot = whole.graph.get("balance")[0][:3, 3]
    assert pivot == pytest.approx((0.0, 7.131281292110203e-3, 0.0), abs=1e-9)


def test_a_dxf_opens_with_everything_in_view_and_lists_its_layers(tmp_path: Path) -> None:
    assert main(["export", SWISS, "-o", str(tmp_path / "out"), "--format", "dxf", "--bodies", "lever"]) == 0
    document = ezdxf.readfile(tmp_path / "out" / "lever.dxf")
    box = bbox.extents(entity for entity in document.modelspace() if entity.dxftype() != "POINT")
    low, high = (document.header[name] for name in ("$EXTMIN", "$EXTMAX"))
    drawn = (box.extmin.x, box.extmin.y, box.extmax.x, box.extmax.y)  # arcs as chords
    assert (*low[:2], *high[:2]) == pytest.approx(drawn, abs=1e-2)
    (view,) = document.viewports.get("*Active")
    assert view.dxf.height > max(box.size.x, box.size.y)
    assert tuple(view.dxf.center)[:2] == pytest.approx((box.center.x, box.center.y), abs=1e-2)
    assert {entity.dxf.layer for entity in document.modelspace()} <= {layer.dxf.name for layer in document.layers}
    assert "PIVOT" in document.layers


def test_only_some_bodies_and_formats(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    options = ["--bodies", "lever", "--format", "svg,stl", "--thickness", "0.1 mm", "--deviation", "5 µm", "--json"]
    assert main(["export", SWISS, "-o", str(folder), *options]) == 0
    seen = json.loads(capsys.readouterr().out)
    assert seen["files"] == ["lever.svg", "lever.stl", "export.json"]
    assert {path.name for path in folder.iterdir()} == set(seen["files"])
    assert list(seen["solids"]) == ["lever"] and seen["solids"]["lever"][0]["thickness_mm"] == pytest.approx(0.1)


def test_an_open_face_is_drawn_but_is_no_solid(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    assert main(["export", str(ROOT / "profiles/incline"), "-o", str(folder)]) == 0
    assert "No closed outline, so no solid: plane" in capsys.readouterr().err
    assert (folder / "plane.dxf").exists() and not (folder / "plane.stl").exists()


def test_an_export_is_replaced_only_when_told_and_other_files_stay(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    arguments = ["export", SWISS, "-o", str(folder), "--bodies", "banking"]
    assert main([*arguments, "--format", "dxf,svg"]) == 0
    (folder / "notes.txt").write_text("mine")
    assert main([*arguments, "--format", "stl"]) == 2
    assert "--force" in capsys.readouterr().err and (folder / "banking.dxf").exists()
    assert main([*arguments, "--format", "stl", "--force"]) == 0
    assert {path.name for path in folder.iterdir()} == {"banking.stl", "export.json", "notes.txt"}


@pytest.mark.parametrize("marker", [None, "{}", "no json"])
def test_a_folder_of_somebody_else_is_left_alone(tmp_path: Path, marker: str | None) -> None:
    (tmp_path / "banking.stl").write_text("mine")
    if marker is not None:
        (tmp_path / "export.json").write_text(marker)
    assert main(["export", SWISS, "-o", str(tmp_path), "--force"]) == 2
    assert (tmp_path / "banking.stl").read_text() == "mine"


def test_nothing_is_left_where_writing_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written = Path.write_bytes

    def full(path: Path, data: bytes) -> int:
        if path.name == "lever.dxf":
            raise OSError(28, "No space left on device")
        return written(path, data)

    monkeypatch.setattr(Path, "write_bytes", full)
    assert main(["export", SWISS, "-o", str(tmp_path / "out"), "--format", "dxf"]) == 2
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (["--format", "step"], "choose from dxf, svg, glb, stl"),
        (["--format", ","], "choose from"),
        (["--bodies", "leever"], 'Did you mean "lever"?'),
        (["--thickness", "3"], "--thickness"),
        (["--deviation", "0 mm"], "must be positive"),
    ],
)
def test_bad_options_are_exit_2(
    options: list[str], word: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["export", SWISS, *options]) == 2
    assert word in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_names_of_bodies_become_names_of_files(tmp_path: Path) -> None:
    scene = tmp_path / "two.toml"
    head = '[bodies."{}"]\ncircle = "1 mm"\nmotion = "fixed"\nposition = ["{} mm", "0 mm"]\n'
    scene.write_text(head.format("a/b", 0) + head.format("a:b", 5) + head.format("scene", 10), encoding="utf-8")
    assert main(["export", str(scene), "-o", str(tmp_path / "out"), "--format", "stl"]) == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"a_b.stl", "a_b_2.stl", "scene_2.stl", "export.json"}


# Does `watchsim new` list, refuse and write what it says?

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
