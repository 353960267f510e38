"""Does `watchsim export` write what it says, whole or not at all?"""

import json
from pathlib import Path

import ezdxf
import pytest
import trimesh
from ezdxf import bbox

import watchsim as ws
from watchsim.cli import main
from watchsim.geometry.solids import section

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
