"""What was changed between scenes or runs, and what came of it: `watchsim compare`, `run --against`, `ws.compare`."""

import json
import math
import re
import shutil
from dataclasses import replace

import pytest

import watchsim as ws
from watchsim.cli import main

INCLINE = str(ws.profiles_dir() / "incline")
GRAHAM = str(ws.profiles_dir() / "graham")


def printed(capsys, *words):
    assert main([*words, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_a_changed_friction_is_named_and_the_sliding_disc_ends_elsewhere(tmp_path, capsys):
    for name, value in (("a", "0.1"), ("b", "0.2")):
        words = ["run", INCLINE, "-o", str(tmp_path / name), "--no-plots", "--duration", "0.3 s"]
        main([*words, "--set", f"contacts.0.friction={value}"])
    capsys.readouterr()
    found = printed(capsys, "compare", str(tmp_path / "a"), str(tmp_path / "b"))
    assert found["changed"] == {"contacts.0.friction": ["0.1", "0.2"]}
    moving = next(body.name for body in ws.load(INCLINE).bodies if body.motion != "fixed")
    ends = [json.loads((tmp_path / name / "summary.json").read_text())["bodies"][moving]["x_m"] for name in "ab"]
    place = found["outputs"][f"{moving}_x_mm"]
    assert place["values"] == pytest.approx([1e3 * x for x in ends], rel=1e-12)
    assert place["difference"] == pytest.approx(1e3 * (ends[1] - ends[0]), rel=1e-9)


def test_two_scenes_are_answered_by_their_cycles_and_the_error_is_that_of_both():
    scene = ws.load(GRAHAM)
    found = ws.compare(scene, scene.set("torques.0.value", "-0.25 mN·m"))
    first, last = (ws.steady(one) for one in (scene, scene.set("torques.0.value", "-0.25 mN·m")))
    one = found.outputs["amplitude_deg"]
    assert one.values == (first.amplitude_deg, last.amplitude_deg)
    assert one.difference == last.amplitude_deg - first.amplitude_deg > 0.0
    assert one.error == math.hypot(first.amplitude_deg_error, last.amplitude_deg_error)
    assert found.outputs["verdict"].values == ("ticks", "ticks")
    assert list(found.changed) == ["torques.0.value"]


def test_a_value_in_another_unit_is_no_change_and_a_dimension_of_the_design_comes_first():
    scene = ws.load(INCLINE)
    assert ws.compare(scene, scene.set("run.duration", f"{1e3 * scene.duration!r} ms")).changed == {}
    graham = ws.load(GRAHAM)
    changed = ws.compare(graham, graham.set("design.lock", "0.5°")).changed
    assert next(iter(changed.items())) == ("design.lock", ("0.4°", "0.5°"))
    assert "bodies.pendulum.drawing" in changed


def test_a_row_is_in_one_unit_that_which_was_typed(tmp_path, capsys):
    """What a scene does not say is completed in SI units."""
    words = ["run", INCLINE, "-o", str(tmp_path / "a"), "--no-plots", "--duration", "0.1 s"]
    main([*words, "--set", "bodies.disc.position.0=0.00125 m"])
    main([*words[:2], "-o", str(tmp_path / "b"), *words[4:], "--set", "bodies.disc.position.0=2.5 mm"])
    capsys.readouterr()
    assert main(["compare", str(tmp_path / "a"), str(tmp_path / "b")]) == 0
    assert re.search(r"bodies\.disc\.position\.0 +1\.25 mm +2\.5 mm\n", capsys.readouterr().out.replace(" \n", "\n"))


def test_what_changes_no_motion_is_named_only_where_every_scene_says_it():
    """The profile has [expect] and no [tolerances]."""
    scene = ws.load(GRAHAM)
    bare = ws.designs.graham().scene()
    assert not [key for key in ws.compare(scene, bare).changed if key.startswith(("expect", "tolerances"))]
    other = scene.set("expect.amplitude.value", "2.2°")
    assert list(ws.compare(scene, other).changed) == ["expect.amplitude.value"]


def test_the_run_of_a_scene_differs_from_it_in_nothing_and_curves_of_both_are_drawn(tmp_path, capsys):
    first, second = tmp_path / "a", tmp_path / "b"
    main(["run", GRAHAM, "-o", str(first), "--no-plots", "--duration", "4 s"])
    shutil.copytree(first, second)
    capsys.readouterr()
    picture = tmp_path / "both.svg"
    assert main(["compare", str(first), str(second), "-o", str(picture)]) == 0
    assert "Nothing was changed in the scene." in capsys.readouterr().out
    assert [picture.read_text().count(f'<g id="{place}">') for place in (first, second)] == [3, 3]
    assert ws.compare(first, ws.load(GRAHAM)).changed == {}


def test_a_design_and_its_drawings_written_out_are_the_same_scene(tmp_path, capsys):
    words = (("new", "geneva", "-o", str(tmp_path / "a")), ("new", "geneva", "-o", str(tmp_path / "b"), "--drawings"))
    assert [main([*one]) for one in words] == [0, 0]
    capsys.readouterr()
    assert ws.compare(tmp_path / "a", tmp_path / "b").changed == {}


def test_a_page_shows_the_last_in_motion_and_the_outlines_of_the_first_over_it(tmp_path, capsys):
    graham = ws.load(GRAHAM)
    for name, lock in (("a", "0.4°"), ("b", "0.6°")):
        ws.write_results(ws.simulate(graham.set("design.lock", lock), 4.0), tmp_path / name)
    page = tmp_path / "both.html"
    assert main(["compare", str(tmp_path / "a"), str(tmp_path / "b"), "-o", str(page)]) == 0
    text = page.read_text()
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text)[1])
    # Only what is drawn otherwise: of the pallets the faces that lie elsewhere.
    outlines = [{(one["layer"], one["codes"], one["numbers"]) for one in part["parts"]} for part in (data, data["ghost"])]
    assert {layer for layer, *_ in outlines[1]} == {"PALLETS"} and not outlines[0] & outlines[1]
    assert '<th scope="row">lock</th>' in text and "What came of it" in text


def test_run_against_an_earlier_one_prints_the_differences(tmp_path, capsys):
    first, second = str(tmp_path / "a"), str(tmp_path / "b")
    words = ["--no-plots", "--set"]
    main(["run", INCLINE, "-o", first, "--duration", "0.2 s", *words, "contacts.0.friction=0.1"])
    capsys.readouterr()
    main(["run", INCLINE, "-o", second, "--duration", "0.1 s", *words, "contacts.0.friction=0.2", "--against", first])
    out = capsys.readouterr().out
    lines = {line.split()[0]: line.split()[1:] for line in out.splitlines() if line.strip()}
    assert lines["contacts.0.friction"] == ["0.1", "0.2"]
    assert lines["run.duration"] == ["0.2", "s", "0.1", "s"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["compare", INCLINE], "two results folders or scenes"),
        (["compare", INCLINE, "nowhere"], "no such scene file"),
        (["compare", INCLINE, INCLINE, "-o", "plot.doc"], ".png"),
    ],
)
def test_what_cannot_be_compared_is_refused(words, said, capsys):
    assert main(words) == 2
    assert said in capsys.readouterr().err


def test_the_power_put_in_is_that_of_the_drive_and_not_what_gravity_lends():
    runs = [ws.simulate(ws.load(GRAHAM).set("torques.0.value", f"{torque} mN·m"), 3.3) for torque in (-0.3, -0.33)]
    wheel = runs[0].scene.torques[0].body
    for run, power in zip(runs, ws.compare(*runs).outputs["power_in_W"].values, strict=True):
        q = run.q[:, run.slices[wheel].start]
        assert power * run.simulated == pytest.approx(run.scene.torques[0].value * (q[-1] - q[0]), rel=1e-9)


def test_a_clock_whose_scene_names_no_lift_angle_is_answered_by_its_limit_cycle():
    scene = replace(ws.load(GRAHAM), lift_angle=None)
    found = ws.compare(scene, scene)
    assert found.sides[0].cycle and found.outputs["amplitude_deg"].values[0] == ws.steady(scene).amplitude_deg
