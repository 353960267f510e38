"""Which of the watchmaker's rules does a drawing break, and is each said with its value and source?"""

import json
import math
import re
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from escapement.made import swiss_scene
from every_time import few
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from watchsim.cli import main
from watchsim.commands.console import BAD_INPUT, FINE
from watchsim.escapement.function_report import draw_left, held_by_pivot, judgements
from watchsim.escapement.measure import Function, measure
from watchsim.mechanism.compile import compile_scene
from watchsim.paths import profiles_dir
from watchsim.render.function_sheet import function_sheet
from watchsim.scene.forces import Bearing
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

SWISS = profiles_dir() / "swiss_lever" / "scene.toml"


def codes(scene) -> set[str]:
    return {one.code for one in judgements(scene, measure(scene))}


def test_the_profile_keeps_all_rules():
    assert codes(load(SWISS)) == set()


BROKEN = {
    "draw": {"draw": "6°"},
    "lock": {"lock": "0.5°"},
    "drop": {"drop_outside": "0.7°"},
    "unequal-drops": {"drop_inside": "1.9°"},
    "run": {"run": "0.05°"},
    "pin-shake": {"shake": "0.005 mm"},
}


@pytest.mark.parametrize("code", few(BROKEN, 3))
def test_each_broken_rule_is_found(code):
    scene, _ = swiss_scene(**BROKEN[code])
    found = [one for one in judgements(scene, measure(scene)) if one.code == code]
    assert found and all(one.rule and one.source and one.message for one in found)
    assert all(math.isfinite(one.limit) for one in found)


def test_friction_decides_about_draw():
    """The least draw is 11° at the exit stone's corner: it holds up to a coefficient of tan 11°."""
    scene = load(SWISS)
    limit, function = math.tan(math.radians(11.0)), measure(scene)
    for friction, broken in ((limit - 1e-4, False), (limit + 1e-4, True)):
        found = judgements(scene.set("contacts.0.friction", friction), function)
        assert ("draw" in {one.code for one in found}) is broken


def test_lift_angle_and_beat():
    scene = load(SWISS)
    assert "lift-angle" in codes(scene.set("timegrapher.lift_angle", "44°"))
    assert "out-of-beat" in codes(scene.set("springs.0.rest", "3°"))


def shorter_dart(way: float):
    """The profile with its dart drawn back, m."""
    scene = load(SWISS)
    lever = scene.body("lever")
    shifted = tuple(loop.moved(0.0, (0.0, -way)) if loop.layer == "DART" else loop for loop in lever.loops)
    return replace(scene, bodies=tuple(replace(body, loops=shifted) if body is lever else body for body in scene.bodies))


def test_a_dart_that_is_too_short_leaves_too_much_freedom():
    changed = shorter_dart(0.07e-3)
    found = [one for one in judgements(changed, measure(changed)) if one.code == "freedom"]
    assert found and all(one.limit == pytest.approx(2.0, abs=1e-3) and 2.0 < one.value < 4.0 for one in found)


def test_a_lever_without_a_guard_that_reaches_can_overbank():
    changed = shorter_dart(0.3e-3)
    found = [one for one in judgements(changed, measure(changed)) if one.code == "freedom"]
    assert found and all("overbank" in one.message for one in found)
    assert all(one.as_dict()["value_deg"] is None for one in found)


def test_the_command_prints_numbers_with_errors(capsys):
    assert main(["check", str(SWISS), "--json"]) == FINE
    statics = json.loads(capsys.readouterr().out)["statics"]
    assert statics["roles"] == {"wheel": "wheel", "lever": "lever", "balance": "balance"}
    assert statics["direction"] == "clockwise" and statics["teeth"] == 15 and statics["missing"] == []
    for stone in ("entry", "exit"):
        assert statics[stone]["lock_deg"] == pytest.approx(1.5, abs=1e-5)
        assert statics[stone]["drop_deg"] == pytest.approx(1.2, abs=1e-5)
        assert statics[stone]["lift_angle_deg"] == pytest.approx(51.173, abs=1e-3)
        values = {name for name in statics[stone] if name.endswith("_deg") and name != "worst_freedom_at_deg"}
        assert all(0.0 < statics[stone][f"{name}_error"] < 1e-5 for name in values)


def test_the_command_says_what_does_not_apply(capsys):
    assert main(["check", str(profiles_dir() / "incline" / "scene.toml"), "--json"]) == FINE
    statics = json.loads(capsys.readouterr().out)["statics"]
    assert statics["roles"] is None and statics["entry"] is None
    assert "no escapement" in statics["missing"][0]["why"]
    assert main(["check", str(profiles_dir() / "bench_lever" / "scene.toml")]) == FINE
    assert "freedoms of guard pin and horns: not measured" in capsys.readouterr().out


@pytest.mark.parametrize("ending", few(["pdf", "svg"], 1))
def test_the_sheet(ending, tmp_path, capsys):
    path = tmp_path / f"sheet.{ending}"
    assert main(["check", str(SWISS), "--sheet", str(path), "--width", "85 mm"]) == FINE
    start = path.read_bytes()[:400]
    assert {"pdf": b"%PDF", "svg": b"<svg"}[ending] in start + path.read_bytes()[:2000]
    assert "entry stone" in capsys.readouterr().out
    first = path.read_bytes()
    assert not re.search(rb"<dc:date>|CreationDate", first)
    assert main(["check", str(SWISS), "--sheet", str(path), "--width", "85 mm"]) == FINE
    assert path.read_bytes() == first


@pytest.mark.parametrize("width", [85.0, 170.0])
def test_views_and_words_of_the_sheet_stand_beside_each_other(width):
    """In the order that their numbers say, none over another, all on the page."""
    scene = load(SWISS)
    figure = function_sheet(scene, compile_scene(scene), measure(scene), width)
    boxes = [axes.get_position() for axes in figure.axes]
    lines = [text.get_position()[1] for text in figure.texts if text.get_family() == ["monospace"]]
    assert (
        len(boxes) >= 6
        and lines
        and all(0.0 <= box.x0 < box.x1 <= 1.0 and max(lines) < box.y0 < box.y1 <= 1.0 for box in boxes)
    )
    assert all(min(box.width, box.height) > 0.1 for box in boxes)
    for one, other in combinations(boxes, 2):
        assert one.x1 <= other.x0 or other.x1 <= one.x0 or one.y1 <= other.y0 or other.y1 <= one.y0
        assert one.y1 > other.y0


@pytest.mark.parametrize("profile", few(["swiss_lever", "graham", "coaxial"], 1))
def test_words_of_the_sheet_stand_beside_the_parts(profile):
    """Counted in the finished picture without its words: little is drawn where they stand, and they are clear of each other."""
    scene = load(profiles_dir() / profile / "scene.toml")
    figure = function_sheet(scene, compile_scene(scene), measure(scene))
    figure.set_dpi(200)
    canvas = FigureCanvasAgg(figure)
    words = [one for axes in figure.axes for one in axes.texts if one.get_text() and one.get_visible() and not one.get_gid()]
    for one in words:
        one.update_positions(canvas.get_renderer())
    extents = [Text.get_window_extent(one, canvas.get_renderer()) for one in words]
    for one in words:
        one.set_visible(False)
    canvas.draw()
    drawn = np.asarray(canvas.buffer_rgba())[::-1, :, :3].min(axis=2) < 250
    assert len(words) >= 4
    for one, box in zip(words, extents, strict=True):
        assert drawn[int(box.y0) : int(box.y1), int(box.x0) : int(box.x1)].mean() < 0.2, one.get_text()
    assert not any(one.overlaps(other) for one, other in combinations(extents, 2))


def test_the_picture_has_the_sheet_beside_it(tmp_path, capsys):
    assert main(["check", str(SWISS), "--png", str(tmp_path / "start.png")]) == FINE
    assert sorted(path.name for path in tmp_path.iterdir()) == ["start.png", "start_function.png"]
    assert capsys.readouterr().err.count("start") == 2


@pytest.mark.parametrize("options", [["--sheet", "a.txt"], ["--sheet", "a.png", "--width", "3 mm"], ["--width", "wide"]])
def test_wrong_options_are_refused(options, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["check", str(SWISS), *options]) == BAD_INPUT
    assert capsys.readouterr().out == ""


def test_no_sheet_of_what_is_no_escapement(tmp_path, capsys):
    scene = profiles_dir() / "incline" / "scene.toml"
    assert main(["check", str(scene), "--sheet", str(tmp_path / "a.png")]) == BAD_INPUT
    assert not (tmp_path / "a.png").exists()


# Is the lever drawn to its bank as long as friction in face and pivot leaves draw, and not beyond?

FRICTION = 0.12  # of the faces


@pytest.fixture(scope="module")
def lever() -> tuple[Scene, Function]:
    scene = load(profiles_dir() / "swiss_lever" / "scene.toml").set("bodies.lever.mass", 5e-6)
    return scene, measure(scene)


def pivoted(scene: Scene, grip: float, play: float = 0.0) -> Scene:
    """The lever in a bearing whose circle of friction has that radius, m."""
    return replace(scene, bearings=(Bearing("lever", grip / 0.1, 0.1, play=play),))


@pytest.mark.parametrize(("share", "drawn"), [(0.97, True), (1.03, False)])
def test_the_draw_that_is_left_decides_whether_the_lever_moves(
    lever: tuple[Scene, Function], share: float, drawn: bool
) -> None:
    """A lever a twentieth of a degree off its bank, pressed by the wheel, in a run without the balance."""
    scene, function = lever
    assert function.arms is not None and function.pallets is not None and function.banks is not None
    k = 0 if function.sides[0] > 0.0 else 1  # locks on the upper bank, where the scene begins
    draw, arm = function.pallets[k].draw.value, function.arms[k]
    grip = share * arm * math.sin(draw - math.atan(FRICTION))
    alone = replace(
        scene, contacts=tuple(one for one in scene.contacts if "balance" not in {side.body for side in one.sides})
    ).set("bodies.lever.angle", function.banks[0] - math.radians(0.05))
    alone = alone.set("bodies.wheel.angle", alone.body("wheel").angle + math.radians(0.0066))
    run = simulate(pivoted(alone, grip), duration=0.05)
    assert run.failure is None
    moved = float(run.end_q[run.slices["lever"]][0]) - function.banks[0]
    assert (abs(moved) < 1e-5) == drawn


def test_check_says_what_is_left(lever: tuple[Scene, Function]) -> None:
    scene, function = lever
    assert list(draw_left(scene, function)) == []
    first, second = draw_left(pivoted(scene, 5e-6), function)
    least = min(function.pallets[0].draw_end.value, function.pallets[0].draw.value)
    left = math.degrees(least - math.atan(FRICTION) - math.asin(5e-6 / function.arms[0]))
    assert f"{left:.3f}°" in first and "pivot" in second
    assert held_by_pivot(pivoted(scene, 5e-6, 1e-6), function)[0] < held_by_pivot(pivoted(scene, 5e-6), function)[0]
    sticks = [one for one in judgements(pivoted(scene, 4e-4), function) if one.code == "draw"]
    assert sticks and "with that of the pivot" in sticks[0].message
