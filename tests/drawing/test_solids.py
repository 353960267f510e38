"""Solids as drawings: what was exported is cut, read and compared with the outlines that it was made of."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
import shapely
import trimesh
from drawing.step_text import step_text
from every_time import few
from shapely.geometry.base import BaseGeometry

import watchsim as ws
from watchsim.cli import main
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read
from watchsim.geometry.loops import Loop
from watchsim.geometry.solids import region
from watchsim.scene.layer_heights import slabs

PROFILES = ws.profiles_dir()
SCENES = sorted(path.parent.name for path in PROFILES.glob("*/scene.toml"))
CHORD = 0.2e-6  # m, of the export
MICROMETRE, FINE = 1e6, 1e-9


def apart(one: BaseGeometry, other: BaseGeometry) -> float:
    """Metres."""
    return 1e-6 * float(shapely.hausdorff_distance(one.boundary, other.boundary))


def errors(drawing: Drawing) -> list[str]:
    return [finding.code for finding in drawing.findings if finding.severity == "error"]


@pytest.mark.parametrize("name", few(SCENES, lambda name: name in ("cam", "remontoir", "swiss_lever")))
def test_exported_solids_come_back_within_a_micrometre(name: str, tmp_path: Path) -> None:
    scene = ws.load(PROFILES / name / "scene.toml")
    assert main(["export", str(PROFILES / name), "--format", "stl", "-o", str(tmp_path / "out")]) == 0
    plates = slabs(scene, 0.2e-3)
    for path in (tmp_path / "out").glob("*.stl"):
        own = [plate for plate in plates if plate.body == path.stem]
        if any(plate.solid and plate.solid.kind != "plate" for plate in own):
            continue
        for slab in read(path, units="mm").slabs:
            drawing = read(path, units="mm", section=slab.middle)
            here = [plate for plate in own if abs(plate.middle - slab.middle) < 0.5 * plate.thickness]
            drawn = shapely.union_all([region(plate.loops, FINE, MICROMETRE) for plate in here])
            assert errors(drawing) == [] and here
            assert apart(region(drawing.loops, FINE, MICROMETRE), drawn) <= 1e-6
            assert drawing.fitted_deviation <= 2.0 * CHORD  # the chord error, and what corners may lie off a circle


@pytest.fixture(scope="module")
def wheel() -> list[Loop]:
    """The wheel of the Swiss lever without its bore: lines and arcs."""
    drawing = read(PROFILES / "swiss_lever" / "escape_wheel.dxf")
    return [loop for loop in drawing.loops if loop.layer == "TEETH" and len(loop.edges) > 1]


def written(wheel: list[Loop], folder: Path, ending: str) -> Path:
    """A plate from 0.1 mm to 0.3 mm, in the unit of the format."""
    path = folder / f"wheel.{ending}"
    if ending == "step":
        path.write_text(step_text(wheel, 1e-4, 3e-4))
        return path
    mesh = trimesh.creation.extrude_polygon(region(wheel, CHORD, 1e3), 0.2, engine="earcut")
    mesh.apply_translation((0.0, 0.0, 0.1))
    if ending == "glb":
        mesh.apply_scale(1e-3)
    mesh.units = "mm"
    mesh.export(path)
    return path


@pytest.mark.parametrize(
    ("ending", "packages", "unit"),
    [
        ("stl", (), None),
        ("obj", (), None),
        ("glb", (), "m"),
        ("3mf", ("lxml", "networkx"), "mm"),
        ("step", ("cascadio",), "mm"),
    ],
)
def test_every_format_gives_the_lines_and_arcs_that_it_was_made_of(
    wheel: list[Loop], tmp_path: Path, ending: str, packages: tuple[str, ...], unit: str | None
) -> None:
    for package in packages:
        pytest.importorskip(package)
    path = written(wheel, tmp_path, ending)
    found = read(path)
    assert (found.units, found.section) == (unit, pytest.approx(2e-4, abs=1e-9))
    assert errors(found) == ([] if unit else ["units-missing"])
    drawing = read(path, units=unit or "mm")
    assert apart(region(drawing.loops, FINE, MICROMETRE), region(wheel, FINE, MICROMETRE)) <= 1e-6
    assert sorted(len(loop.edges) for loop in drawing.loops) == sorted(len(loop.edges) for loop in wheel)


def test_a_swiss_lever_of_solids_ticks_as_its_drawings_do(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(PROFILES / "swiss_lever"), "--format", "stl,glb", "-o", str(tmp_path / "out")]) == 0
    text = (PROFILES / "swiss_lever" / "scene.toml").read_text()
    files = {
        "escape_wheel.dxf": "wheel.stl",
        "lever.dxf": "lever.glb",
        "roller.dxf": "balance.glb",
        "banking.dxf": "banking.stl",
    }
    for drawing, solid in files.items():
        more = '\nsection = "0.32 mm"' if solid.endswith("glb") else '\nunits = "mm"'
        text = text.replace(f'"{drawing}"', f'"{solid}"{more}')
    text = re.sub(r"(?m)^(layers|draw) +=.*\n", "", text)  # what is cut holds all that can touch
    text = re.sub(r"(?m)^pivot .*$", 'pivot = ["0 mm", "0 mm"]', text)
    text = re.sub(r"\[\[contacts]] +# safety[^[]*\[[^]]*]\n[^[]*", "", text)  # guard pin and roller are cut away
    text = text.replace("wheel.TEETH", "wheel").replace("banking.PINS", "banking")
    (tmp_path / "out" / "scene.toml").write_text(text)
    capsys.readouterr()
    amplitudes = []
    for scene in (PROFILES / "swiss_lever", tmp_path / "out"):
        assert main(["steady", str(scene), "--json"]) == 0
        amplitudes.append(json.loads(capsys.readouterr().out)["amplitude_deg"])
    assert amplitudes[1] == pytest.approx(amplitudes[0], abs=0.5)


def stepped(folder: Path) -> Path:
    """A disc of 64 corners from 0 to 0.2 mm, a smaller one on it up to 0.5 mm, a cone from there to 0.8 mm."""
    discs = [trimesh.creation.cylinder(radius, height, sections=64) for radius, height in ((2.0, 0.2), (1.0, 0.3))]
    for disc, middle in zip(discs, (0.1, 0.35), strict=True):
        disc.apply_translation((0.0, 0.0, middle))
    cone = trimesh.creation.cone(1.0, 0.3, sections=64).apply_translation((0.0, 0.0, 0.5))
    path = folder / "stepped.stl"
    trimesh.util.concatenate([*discs, cone]).export(path)
    return path


def test_a_staff_and_its_wheel_in_one_mesh_are_cut_as_one(tmp_path: Path) -> None:
    """They share a wall, with other chords, and a collar runs into the wheel: what is cut has no hole and no second outline."""
    staff = trimesh.creation.cylinder(0.3, 3.0, sections=66)
    wheel = trimesh.creation.annulus(0.3, 1.0, 0.4, sections=200)
    collar = trimesh.creation.cylinder(0.7, 0.4, sections=140).apply_translation((0.0, 0.0, 0.3))
    path = tmp_path / "mounted.stl"
    trimesh.util.concatenate([staff, wheel, collar]).export(path)
    for height, radius in ((-1e-3, 0.3), (-1e-4, 1.0), (1.5e-4, 1.0), (4e-4, 0.7)):
        drawing = read(path, units="mm", section=height)
        (loop,) = drawing.loops
        assert errors(drawing) == [] and not loop.hole
        assert [edge.radius for edge in loop.edges] == pytest.approx([1e-3 * radius], rel=1e-6)


def inspected(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, dict[str, Any]]:
    capsys.readouterr()
    status = main(["inspect", *words, "--json"])
    return status, json.loads(capsys.readouterr().out)


def test_inspect_lists_the_heights_at_which_the_section_changes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, report = inspected(capsys, str(stepped(tmp_path)), "--units", "mm", "--section", "0.35 mm")
    heights = [(slab["from_mm"], slab["to_mm"], slab["same"]) for slab in report["slabs"]]
    assert [pytest.approx(row, abs=1e-6) for row in heights] == [(0.0, 0.2, True), (0.2, 0.5, True), (0.5, 0.8, False)]
    assert (status, report["section_mm"]) == (0, pytest.approx(0.35))
    assert report["circles"][0]["radius_mm"] == pytest.approx(1.0, abs=1e-6)
    sagitta = 1e3 * (1.0 - 0.998795456205172)  # of 64 chords, cos(π/64), in µm
    assert report["fitted"] == {"curves": 1, "arcs": 1, "worst_deviation_um": pytest.approx(sagitta, rel=1e-3)}
    assert main(["inspect", str(stepped(tmp_path)), "--units", "mm", "--section", "0.35 mm"]) == 0
    assert "0.5 to 0.8 mm, changes" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("section", "code", "words"),
    [
        (None, "section-missing", "0, 0.2, 0.5, 0.8 mm"),
        ("0.2 mm", "section-missing", "cut above or below"),
        ("1 mm", "section-outside", "does not reach there"),
        ("-1 µm", "section-outside", "does not reach there"),
    ],
)
def test_a_height_that_does_not_do_is_refused_with_one_that_does(
    section: str | None, code: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    more = () if section is None else (f"--section={section}",)
    _, report = inspected(capsys, str(stepped(tmp_path)), "--units", "mm", *more)
    (finding,) = report["findings"]
    assert (finding["code"], finding["fix"]) == (code, 'Set section = "0.35 mm".')
    assert words in finding["message"]


def with_a_hole(path: Path) -> None:
    mesh = trimesh.creation.box((4.0, 4.0, 0.2))
    mesh.update_faces([k != int(abs(mesh.face_normals[:, 0]).argmax()) for k in range(len(mesh.faces))])
    mesh.export(path)


def flat(path: Path) -> None:
    trimesh.Trimesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]).export(path)


def cut_short(path: Path) -> None:
    trimesh.creation.box().export(path)
    path.write_bytes(path.read_bytes()[:300])


def huge(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(75_000_001)


@pytest.mark.parametrize(
    ("name", "make", "codes"),
    [
        ("hole.stl", with_a_hole, ["mesh", "open-outline"]),
        ("flat.stl", flat, ["empty"]),
        ("short.stl", cut_short, ["empty"]),
        ("short.glb", cut_short, ["damaged"]),
        ("empty.obj", Path.touch, ["empty"]),
        ("empty.stl", Path.touch, ["empty"]),
        ("empty.glb", Path.touch, ["damaged"]),
        ("huge.stl", huge, ["too-large"]),
        ("missing.stl", str, ["unreadable"]),
        ("solid.iges", Path.touch, ["format"]),
    ],
)
def test_what_cannot_be_read_is_a_finding(
    name: str, make: Any, codes: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    make(tmp_path / name)
    status, report = inspected(capsys, str(tmp_path / name), "--units", "mm")
    assert status == (0 if name == "hole.stl" else 2)  # a part of it is there
    assert {finding["code"] for finding in report["findings"]} == set(codes)
    assert all(finding["fix"] for finding in report["findings"] if finding["code"] not in ("unreadable", "open-outline"))


@pytest.mark.parametrize(("ending", "package"), [("3mf", "lxml"), ("step", "cascadio")])
def test_damaged_files_of_the_extra_are_findings_and_stdout_stays_clean(
    ending: str, package: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip(package)
    (tmp_path / f"odd.{ending}").write_text("not a solid\n")
    assert main(["inspect", str(tmp_path / f"odd.{ending}"), "--json"]) == 2
    assert [finding["code"] for finding in json.loads(capfd.readouterr().out)["findings"]] == ["damaged"]


def test_without_the_extra_it_is_said_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    (tmp_path / "plate.step").write_text("ISO-10303-21;\n")
    (finding,) = read(tmp_path / "plate.step").findings
    assert "cascadio" in finding.message and "watchsim[solids]" in finding.fix


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('units = "mm"\nsection = "0.35 mm"', ""),
        ('units = "mm"', "say where it is cut"),
        ('units = "furlong"\nsection = "0.1 mm"', "is not a unit known here"),
        ('units = "mm"\nsection = "0.1 s"', "section"),
        ('units = "mm"\nsection = "9 mm"', "does not reach there"),
        ('section = "0.35 mm"', "does not say its units"),
    ],
)
def test_a_scene_says_where_a_solid_is_cut(line: str, words: str, tmp_path: Path) -> None:
    stepped(tmp_path)
    scene = tmp_path / "scene.toml"
    scene.write_text(
        f'[bodies.disc]\ndrawing = "stepped.stl"\n{line}\npivot = ["0 mm", "0 mm"]\ninertia = "1 mg·cm²"\n', encoding="utf-8"
    )
    if words:
        with pytest.raises(ws.SceneError, match=words):
            ws.load(scene)
        return
    (arc,) = ws.load(scene).bodies[0].loops[0].edges
    assert arc.length == pytest.approx(6.283185307e-3, rel=1e-6)


def test_a_flat_drawing_has_no_section(capsys: pytest.CaptureFixture[str]) -> None:
    status, report = inspected(capsys, str(PROFILES / "swiss_lever" / "lever.dxf"), "--section", "0.1 mm")
    assert status == 2 and "is flat" in report["findings"][0]["message"]


def test_new_cuts_a_solid_where_it_is_the_same_and_says_so(tmp_path: Path) -> None:
    assert main(["new", str(stepped(tmp_path)), "-o", str(tmp_path / "scene")]) == 0
    text = (tmp_path / "scene" / "scene.toml").read_text(encoding="utf-8")
    assert 'section = "0.35 mm"  # guess:' in text and 'units = "mm"  # guess:' in text
    (body,) = ws.load(tmp_path / "scene").bodies
    assert [edge.length for loop in body.loops for edge in loop.edges] == [pytest.approx(6.283185307e-3, rel=1e-6)]
