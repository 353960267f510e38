"""Drawings of strangers run the right way, or a doubt says that they do not."""

import json
import math
from pathlib import Path
from typing import Any

import ezdxf
import ezdxf.math
import pytest
from proposal.assemblies import assembly, mirror, scene_of
from proposal.escapements_by_hand import Anchor, star_and_jumper

from watchsim.cli import main
from watchsim.proposal import start, trial
from watchsim.proposal.propose import propose
from watchsim.proposal.trial import tried
from watchsim.proposal.words import shows_pivot


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_dead_beat_anchor_ticks_the_way_its_teeth_lock(
    mirrored: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A wheel too heavy for its torque was once driven on by the swing, and turned the wrong way for it."""
    path = Anchor(mirrored=mirrored).draw(tmp_path / "anchor.dxf")
    assert main(["new", str(path), "-o", str(tmp_path / "out"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["doubts"] == []
    assert [(body["name"], body["teeth"]) for body in said["bodies"]] == [("steigrad", 24), ("anchor", None)]
    torque = next(guess["value"] for guess in said["guesses"] if guess["key"] == "torques.0.value")
    assert torque.startswith('"-') != mirrored
    assert main(["check", str(tmp_path / "out"), "--json"]) == 0
    statics = json.loads(capsys.readouterr().out)["statics"]
    assert statics["direction"] == ("counter-clockwise" if mirrored else "clockwise")
    assert statics["entry"]["lift_deg"] == pytest.approx(1.5, abs=0.05)  # of the drawn 2°, of which 0.5° are for the lock
    assert main(["run", str(tmp_path / "out"), "--duration", "10 s", "-o", str(tmp_path / "run"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["amplitude_deg"] == pytest.approx(4.0, abs=0.3)  # as guessed


def test_the_lean_of_teeth_that_lock_decides_against_what_a_guess_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """With a balance too light for its wheel the trial works the wrong way only."""
    monkeypatch.setattr(start, "KEEPS_UP", 0.03)
    path = Anchor().draw(tmp_path / "anchor.dxf")
    assert main(["new", str(path), "-o", str(tmp_path / "out"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert next(guess["value"] for guess in said["guesses"] if guess["key"] == "torques.0.value").startswith('"-')
    assert any("its teeth lock and drive either way" in words for words in said["doubts"])
    assert_at_the_top(tmp_path / "out" / "scene.toml", said["doubts"])


def assert_at_the_top(scene: Path, doubts: list[str]) -> None:
    head = scene.read_text(encoding="utf-8").split("\n\n")[0].splitlines()
    assert [line for line in head if line.startswith("# Doubtful")] == [f"# Doubtful: {words}." for words in doubts]


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_star_turns_the_way_in_which_its_jumper_lets_it(mirrored: bool, tmp_path: Path) -> None:
    """Its own spring and drive are guesses, so that a doubt says that they decide."""
    found = tried([star_and_jumper(tmp_path / "star.svg", mirrored=mirrored)])
    assert found.way == (-1 if mirrored else 1)
    assert len(found.doubts) == 1 and "it works this way only, with inertias, springs" in found.doubts[0]


@pytest.mark.parametrize("points", [5, 7, 10])
def test_stars_of_few_and_many_points_go_on(points: int, tmp_path: Path) -> None:
    """Some lie over their jumper as they are drawn, and are tried all the same."""
    found = tried([star_and_jumper(tmp_path / "star.svg", points, names=("étoile", "sautoir"), pivot="axe {}")])
    assert found.way == 1 and not any("stands" in words for words in found.doubts)


def test_an_anchor_that_cannot_swing_wide_is_let_go_nearer_to_rest(tmp_path: Path) -> None:
    """At 4° its pallets would be in the backs of the teeth: it once began at rest, and stood."""
    anchor = Anchor(
        20, 6.5, 25.0, lift=3.0, drop=2.26, layers=("ANKERRADZÄHNE", "Achse Rad", "ANKERPALETTEN", "ANKERACHSE", "Arm")
    )
    found = tried([anchor.draw(tmp_path / "anchor.dxf")])
    assert found.doubts == () and found.way == -1
    assert {guess.key: guess.value for guess in found.guesses}["bodies.anchor.angle"] == '"-3°"'


def test_an_anchor_escape_wheel_is_a_wheel(tmp_path: Path) -> None:
    layers = ("anchor escape wheel", "bore wheel", "anchor", "bore anchor", "anchor frame")
    found = propose([Anchor(layers=layers).draw(tmp_path / "anchor.dxf")])
    assert [(role.name, role.task) for role in found.roles] == [("escape_wheel", "wheel"), ("anchor", "oscillator")]


CAM = """<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm" viewBox="0 0 40 40">
<path id="CAM" d="M 14.532 23.530 A 6 6 0 1 0 25.468 23.530 L 22.279 16.471 A 2.5 2.5 0 0 0 17.721 16.471 Z"/>
<circle id="CAM_PIVOT" cx="20" cy="26" r="0.8"/>
<rect id="FOLLOWER" x="14" y="12" width="12" height="1.5"/><rect id="STEM" x="19" y="4" width="2" height="8"/></svg>"""


def test_doubts_do_not_contradict_each_other_and_stand_at_the_top(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A follower that its cam cannot reach was said to fall back each time, and never to move."""
    (tmp_path / "cam.svg").write_text(CAM, encoding="utf-8")
    assert main(["new", str(tmp_path / "cam.svg"), "-o", str(tmp_path / "out"), "--json"]) == 0
    doubts = json.loads(capsys.readouterr().out)["doubts"]
    assert "follower stands 1.5 mm off cam where cam is highest" in doubts[0] and "nothing shows about which" in doubts[1]
    assert "cutting" not in "".join(doubts) and len(doubts) == 2
    assert "falls back" not in "".join(doubts) and "never move" not in "".join(doubts)
    assert_at_the_top(tmp_path / "out" / "scene.toml", doubts)


PIVOTS = [
    ("Welle Rad", "Welle Anker"),
    ("Radbohrung", "Ankerbohrung"),
    ("Bohrung", "Bohrung"),
    ("Pivot Wheel", "Pivot Lever"),
    ("axe de la roue", "axe d'ancre"),
    ("TROU", "PERÇAGE"),
    ("Arbor 1", "Arbor 2"),
    ("foro ruota", "asse ancora"),
]


@pytest.mark.parametrize(("wheel", "anchor"), PIVOTS)
def test_arbors_and_bores_show_pivots_in_any_language_and_order(wheel: str, anchor: str, tmp_path: Path) -> None:
    layers = ("Zähne", wheel, "Klauen", anchor, "Anker")
    found = propose([Anchor(layers=layers).draw(tmp_path / "anchor.dxf")])
    assert found.doubts == ()
    places = [role.part.centre.at for role in found.roles if role.part.centre is not None]
    assert [tuple(round(1e3 * value, 3) for value in place) for place in places] == [(0.0, 0.0), (0.0, 15.167)]


@pytest.mark.parametrize("name", ["CENTER WHEEL", "roue de centre dents", "ANKER", "Speichen", "whole", "pivoted detent"])
def test_other_names_show_none(name: str) -> None:
    assert not shows_pivot(name)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_cylinder_runs_in_a_mirror_too(mirrored: bool, tmp_path: Path) -> None:
    """Its balance was let go on the same side of either one, and a tooth ran past it at first."""
    path = assembly(scene_of("cylinder"), tmp_path / "cylinder.dxf", "body")
    found = tried([mirror(path) if mirrored else path])
    assert (found.way, found.doubts) == (1 if mirrored else -1, ())


def test_a_passing_spring_keeps_its_own_bore(tmp_path: Path) -> None:
    """It lies over the detent, in which there is another one."""
    scene = scene_of("detent")
    path = assembly(scene, tmp_path / "detent.dxf", "body")
    document = ezdxf.readfile(path)
    points = document.modelspace().query("POINT")
    for point, body in zip(points, [body for body in scene.bodies if body.motion != "fixed"], strict=True):
        document.modelspace().add_circle(point.dxf.location, 0.05, dxfattribs={"layer": f"{body.name} foro"})
        document.modelspace().delete_entity(point)
    document.saveas(path)
    found = propose([path])
    assert found.doubts == () and {role.name: role.on.name for role in found.roles if role.on} == {"passing": "detent"}


def test_the_time_for_compiling_kernels_is_no_patience_lost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first trial after an installation was broken off before it began."""
    clock = [0.0]
    real = trial.simulate

    def compiled_first(*args: Any, **named: Any) -> Any:
        clock[0] += 2.0 * trial.PATIENCE
        return real(*args, **named)

    monkeypatch.setattr(trial, "simulate", compiled_first)
    monkeypatch.setattr(trial.time, "process_time", lambda: clock[0])
    assert tried([Anchor().draw(tmp_path / "anchor.dxf")]).doubts == ()


def test_bores_for_screws_and_those_of_a_plate_are_no_pivots(tmp_path: Path) -> None:
    path = Anchor(layers=("Zähne", "Bohrung", "Klauen", "Bohrung", "Anker")).draw(tmp_path / "anchor.dxf")
    document = ezdxf.readfile(path)
    space = document.modelspace()
    space.add_lwpolyline([(-15, -15), (15, -15), (15, 25), (-15, 25)], close=True, dxfattribs={"layer": "Platine"})
    for x, y, layer in ((-3, 14.6, "Bohrung"), (3, 14.6, "Bohrung"), (-14, -14, "Platine Bohrung"), (0, 20, "Platine Bohrung")):
        space.add_circle((x, y), 0.2, dxfattribs={"layer": layer})
    document.saveas(path)
    found = propose([path])
    assert found.doubts == () and [role.task for role in found.roles] == ["wheel", "oscillator", "fixed"]
    anchor = found.roles[1].part.centre
    assert anchor is not None and anchor.at == pytest.approx((0.0, 15.1665e-3), abs=1e-7)


def test_a_rack_is_no_click_that_lacks_a_pivot(tmp_path: Path) -> None:
    """It was said to swing through the teeth, to need a pivot, and to make the direction of its pinion doubtful."""
    pitch, teeth = math.pi, 16
    low, high = (6.8, 9.0), (-9.25, -7.1)
    pinion = [
        (low[k in (1, 2)] * math.cos(a), low[k in (1, 2)] * math.sin(a))
        for tooth in range(teeth)
        for k, a in enumerate(math.tau * (tooth + share) / teeth for share in (-0.32, -0.12, 0.12, 0.32))
    ]
    rack = [((k + 0.5 + share) * pitch, high[abs(share) < 0.2]) for k in range(-5, 6) for share in (-0.32, -0.12, 0.12, 0.32)]
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    space = document.modelspace()
    for layer, points in (("PINION", pinion), ("RACK", [*rack, (19.0, -12.0), (-15.0, -12.0)])):
        space.add_lwpolyline(points, close=True, dxfattribs={"layer": layer})
    space.add_circle((0.0, 0.0), 1.5, dxfattribs={"layer": "PINION_BORE"})
    document.saveas(tmp_path / "rack.dxf")
    (doubt,) = propose([tmp_path / "rack.dxf"]).doubts
    assert doubt.startswith("RACK: teeth in a straight row")


@pytest.mark.parametrize(
    ("cam", "lever", "axis"), [("Nocken", "Hebel", "Achse"), ("came", "levier", "axe"), ("CAM", "LEVER", "BORE")]
)
def test_a_lever_on_a_cam_follows_it(cam: str, lever: str, axis: str, tmp_path: Path) -> None:
    """It lay a tenth of a millimetre off the cam, without a spring, and nothing touched anything."""
    angles = [math.tau * k / 120 for k in range(120)]
    radii = [6.0 + 2.0 * math.cos(a) + 0.5 * math.cos(2.0 * a) for a in angles]
    outlines = {
        cam: [(r * math.cos(a), r * math.sin(a)) for r, a in zip(radii, angles, strict=True)],
        lever: [(-4.0, 8.6), (12.0, 8.6), (13.0, 10.0), (12.0, 11.4), (-4.0, 10.0)],
    }
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    for layer, points in outlines.items():
        document.modelspace().add_lwpolyline(points, close=True, dxfattribs={"layer": layer})
    for layer, place, radius in ((cam, (0.0, 0.0), 1.0), (lever, (12.0, 10.0), 0.5)):
        document.modelspace().add_circle(place, radius, dxfattribs={"layer": f"{layer} {axis}"})
    document.saveas(tmp_path / "cam.dxf")
    found = tried([tmp_path / "cam.dxf"])
    assert ([role.task for role in found.roles], found.doubts) == (["driver", "click"], ())
    assert any(guess.key == "springs.0.stiffness" for guess in found.guesses)
