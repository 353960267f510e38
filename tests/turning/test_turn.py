"""Does a mechanism turned by hand do what its construction says? Angles against the circles it was drawn from."""

import dataclasses
import json
import math
import time
from pathlib import Path

import numpy as np
import pytest
import shapely
from every_time import few

import watchsim as ws
from watchsim.cli import main
from watchsim.construction.coaxial import Coaxial, Points
from watchsim.escapement.turn import happenings, stretches, turn, turn_report, verdict
from watchsim.escapement.turned_cycle import assembly
from watchsim.geometry.loops import polyline
from watchsim.scene.errors import SceneError

PROFILES = Path(__file__).resolve().parents[2] / "profiles"
SWING = math.radians(40.0)
FINE = 2e-3  # degrees: the finest step of the led body is a quarter of it

POST = """\
[scene]
title = "A post in the way"
schema = 1

[bodies.wheel]
polygon = [["0 mm", "-0.1 mm"], ["2 mm", "-0.1 mm"], ["2 mm", "0.1 mm"], ["0 mm", "0.1 mm"]]
position = ["0 mm", "0 mm"]
angle = "20°"
inertia = "0.1 mg·cm²"

[bodies.balance]
polygon = [["0 mm", "-0.1 mm"], ["2 mm", "-0.1 mm"], ["2 mm", "0.1 mm"], ["0 mm", "0.1 mm"]]
position = ["3.8 mm", "0 mm"]
angle = "120°"
inertia = "10 mg·cm²"

[bodies.post]
polygon = [["1.8 mm", "-0.4 mm"], ["2 mm", "-0.4 mm"], ["2 mm", "-0.2 mm"], ["1.8 mm", "-0.2 mm"]]
motion = "fixed"

[[springs]]
body = "balance"
frequency = "3 Hz"
rest = "120°"

[[torques]]
body = "wheel"
value = "-1 µN·m"

[[contacts]]
between = ["wheel", "post"]

[[contacts]]
between = ["balance", "post"]
"""

RATCHET = """\
[scene]
title = "Ratchet and click"
schema = 1

[bodies.wheel]
polygon = [["1 mm", "0 mm"], ["0.5 mm", "0.5 mm"], ["0 mm", "0.55 mm"], ["0 mm", "1 mm"], ["-0.5 mm", "0.5 mm"],
           ["-0.55 mm", "0 mm"], ["-1 mm", "0 mm"], ["-0.5 mm", "-0.5 mm"], ["0 mm", "-0.55 mm"], ["0 mm", "-1 mm"],
           ["0.5 mm", "-0.5 mm"], ["0.55 mm", "0 mm"]]
inertia = "0.1 mg·cm²"
angle = "30°"

[bodies.click]
polygon = [["0 mm", "-0.05 mm"], ["0.9 mm", "-0.25 mm"], ["0.9 mm", "-0.15 mm"], ["0 mm", "0.05 mm"]]
position = ["-0.95 mm", "1.05 mm"]
angle = "20°"
inertia = "0.05 mg·cm²"

[[springs]]
body = "click"
stiffness = "1 µN·m/rad"
rest = "-40°"

[[torques]]
body = "wheel"
value = "-1 µN·m"

[[contacts]]
between = ["wheel", "click"]
"""


@pytest.fixture(scope="module")
def coaxial():
    return turn(ws.load(PROFILES / "coaxial"), SWING)


@pytest.fixture(scope="module")
def swiss():
    return turn(ws.load(PROFILES / "swiss_lever"), SWING)


def degrees(found, row):
    return {name: math.degrees(q) for name, q in zip(found.names, found.cycle.rows[row], strict=True)}


def of_layers(found, first, second):
    """The touches of two layers in the last cycle."""
    return [one for one in stretches(found) if found.cycle.assembly.couples[one.couple].layers == (first, second)]


@pytest.mark.parametrize(("name", "teeth"), few([("swiss", 15), ("coaxial", 8)], 1, several=True))
def test_an_escapement_passes_one_tooth(request, name, teeth):
    found = request.getfixturevalue(name)
    assert verdict(found)[0] == "passes"
    assert found.teeth == teeth
    assert found.advanced == pytest.approx(1.0, abs=1e-4)


@pytest.mark.slow
def test_direct_impulse_ends_where_the_circles_part(coaxial):
    points = Points(Coaxial())
    (impulse,) = of_layers(coaxial, "TEETH", "IMPULSE_STONE")
    end = degrees(coaxial, impulse.last)
    assert end["balance"] == pytest.approx(points.direct_balance + Coaxial().stone_lag, abs=FINE)
    # A tip stands so far beyond the line from O to B; its flat of 20 µm may already be going over the stone's edge.
    beyond = (end["wheel"] - points.balance_bearing + Coaxial().direct_reach) % 45.0
    assert min(beyond, 45.0 - beyond) < math.degrees(0.02 / 2.25)


@pytest.mark.slow
def test_indirect_impulse_ends_where_its_circles_part(coaxial):
    points = Points(Coaxial())
    (impulse,) = of_layers(coaxial, "SMALL_TEETH", "IMPULSE_STONE")
    end = degrees(coaxial, impulse.last)
    assert end["lever"] == pytest.approx(Coaxial().indirect_offset + Coaxial().indirect_lever, abs=FINE)
    small = (end["wheel"] + points.small_turn - 90.0 + Coaxial().indirect_reach) % 45.0
    assert min(small, 45.0 - small) < math.degrees(0.015 / points.small_radius)


@pytest.mark.slow
def test_lockings_part_at_the_unlocking_angle(coaxial):
    points = Points(Coaxial())
    parted = sorted(degrees(coaxial, one.last)["lever"] for one in of_layers(coaxial, "TEETH", "LOCKING_STONES"))[:2]
    released = sorted(abs(degrees(coaxial, one.last)["lever"]) for one in of_layers(coaxial, "TEETH", "LOCKING_STONES"))[:2]
    assert released == pytest.approx([points.unlocked, points.unlocked], abs=FINE)
    assert parted[0] < 0.0


@pytest.mark.slow
def test_the_pin_is_in_the_fork_over_the_lift_angle(coaxial):
    met = [degrees(coaxial, one.row)["balance"] for one in happenings(coaxial) if one.kind == "meets" and one.couple is not None
           and coaxial.cycle.assembly.couples[one.couple].layers == ("FORK", "PIN")]  # fmt: skip
    assert min(met) == pytest.approx(-Coaxial().lift_angle / 2.0, abs=0.2), "the pin's rounded edge reaches a little less far"


def test_swiss_drop_is_the_designed_one(swiss):
    drops = [math.degrees(leap.way) for leap in swiss.cycle.leaps if leap.row >= swiss.first]
    assert drops == pytest.approx([1.2, 1.2], abs=5e-3)


@pytest.mark.slow
def test_nothing_ever_overlaps_and_distances_are_true(coaxial):
    """Distances of some rows against polygons of chords."""
    parts = assembly(coaxial.scene)
    rows = range(coaxial.first, len(coaxial.cycle.rows), 97)
    for row in rows:
        for k, couple in enumerate(parts.couples):
            shapes = []
            for number, layer in zip((couple.a, couple.b), couple.layers, strict=True):
                body = coaxial.scene.bodies[number]
                angle = coaxial.cycle.rows[row][number] if body.motion == "pivot" else body.angle
                loops = [loop.moved(angle, body.position) for loop in body.loops if loop.layer == layer]
                shapes.append(shapely.union_all([shapely.LinearRing(1e3 * polyline(loop, 2e-9)) for loop in loops]))
            apart = 1e-3 * float(shapely.distance(*shapes))
            assert apart == pytest.approx(coaxial.cycle.distances[row][k], abs=1e-8), couple.layers


def test_a_wheel_that_nothing_holds_runs_away():
    scene = ws.load(PROFILES / "swiss_lever")
    found = turn(dataclasses.replace(scene, contacts=scene.contacts[1:]), SWING)
    assert verdict(found)[0] == "runs away"


def test_a_post_in_the_way_jams_and_is_named(tmp_path):
    (tmp_path / "scene.toml").write_text(POST, encoding="utf-8")
    found = turn(ws.load(tmp_path / "scene.toml"), math.radians(100.0))
    word, sentence = verdict(found)
    assert word == "jams"
    assert "balance" in sentence and "post" in sentence


def test_a_ratchet_passes_its_click(tmp_path):
    """No oscillator: the wheel is led by a pitch, and the spring presses the click on."""
    (tmp_path / "scene.toml").write_text(RATCHET, encoding="utf-8")
    found = turn(ws.load(tmp_path / "scene.toml"))
    assert found.oscillator is None
    assert verdict(found) == ("passes", "wheel passes: 1 of 4 teeth in a whole pitch")
    click = [math.degrees(row[1]) for row in found.cycle.rows]
    assert click[-1] == pytest.approx(click[0], abs=1e-3)
    assert max(click) - min(click) > 10.0


@pytest.mark.parametrize(
    ("name", "sentence", "sweep"),
    [
        ("ratchet", "wheel passes: 1 of 24 teeth in a whole pitch", None),
        ("winding_click", "wheel passes: 1 of 18 teeth in a whole pitch", None),
        ("verge", "crown_wheel passes: 1 of 27 teeth in a whole pitch", 40.0),
    ],
)
def test_a_wheel_without_oscillator_passes_a_tooth_a_pitch(
    name: str, sentence: str, sweep: float | None, capsys: pytest.CaptureFixture[str]
) -> None:
    """Outlines that touch exactly at the start, a click on its stop, and a large crown wheel: in seconds, not minutes."""
    start = time.process_time()
    assert main(["check", str(PROFILES / name), "--turn"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == sentence
    assert time.process_time() - start < 20.0
    found = turn(ws.load(PROFILES / name))
    rows = np.degrees(found.cycle.q[found.first :])
    if sweep is None:  # the click comes back, and never goes beyond the stop on which its spring presses it
        (spring,) = found.scene.springs
        assert rows[-1, 1] == pytest.approx(rows[0, 1], abs=1e-3)
        assert spring.stop is None or rows[:, 1].max() <= math.degrees(spring.stop) + 1e-3
    else:  # the verge turns to and fro by what the flags give way
        assert np.ptp(rows[:, 0]) == pytest.approx(sweep, abs=0.01)
    assert all(distance > 0.0 for row in found.cycle.distances[1:] for distance in row)


def test_what_cannot_be_turned_is_refused_in_one_go(tmp_path):
    scene = ws.load(PROFILES / "swiss_lever")
    free = dataclasses.replace(scene.body("lever"), motion="free", mass=1e-6)
    bodies = tuple(free if body.name == "lever" else body for body in scene.bodies)
    with pytest.raises(SceneError) as refused:
        turn(dataclasses.replace(scene, bodies=bodies, torques=()))
    assert "nothing is driven" in str(refused.value)
    assert "bodies.lever.motion" in str(refused.value)


def test_report_is_json_and_tells_every_happening(swiss):
    report = json.loads(json.dumps(turn_report(swiss)))
    kinds = {one["kind"] for one in report["happenings"]}
    assert {"meets", "leaves", "free", "back"} <= kinds
    assert report["teeth_per_cycle"] == pytest.approx(1.0, abs=1e-4)
    assert all(one["distance_um"] > 0.0 for one in report["passings"])


@pytest.mark.parametrize(
    "asked", [["--movie", "a.mp4"], ["--swing", "30°"], ["--turn", "--swing", "30 mm"], ["--turn", "--movie", "a.avi"]]
)
def test_what_does_not_belong_is_refused(asked, capsys):
    assert main(["check", str(PROFILES / "bench_lever"), *asked]) == 2
    told = capsys.readouterr().err
    assert "--" in told or ".mp4 or .gif" in told


TRAIN = """
[design]
of = "swiss_lever"
[bodies.third]
position = ["20 mm", "0 mm"]
inertia = "10 mg·cm²"
[[gears]]
between = ["third", "wheel"]
ratio = {ratio}
{play}
[[torques]]
body = "third"
value = "{torque} µN·m"
[[torques]]
body = "wheel"
value = "0 µN·m"
"""


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "torque", "play"), [(-8.0, 8.0, ""), (6.5, -8.0, ""), (-8.0, 8.0, 'backlash = "0.5°"')])
def test_a_train_turns_with_its_wheel(tmp_path: Path, ratio: float, torque: float, play: str) -> None:
    """As the lever by itself, whichever body is driven, and the third wheel by what the ratio says."""
    (tmp_path / "scene.toml").write_text(TRAIN.format(ratio=ratio, torque=torque, play=play), encoding="utf-8")
    geared, plain = turn(ws.load(tmp_path), SWING), turn(ws.designs.swiss_lever().scene(), SWING)
    assert geared.wheel == "wheel" and geared.advanced == pytest.approx(1.0, abs=1e-3)
    assert geared.cycle.q[-1][0] == pytest.approx(plain.cycle.q[-1][0], abs=1e-6)
    wheel, third = (geared.cycle.q[:, geared.names.index(name)] for name in ("wheel", "third"))
    assert wheel - wheel[0] == pytest.approx(ratio * (third - third[0]), abs=1e-9)


@pytest.mark.parametrize("ratio", few([-3.0, 0.5], 1))
def test_a_driven_arbor_turns_the_ratchet_that_is_geared_to_it(tmp_path: Path, ratio: float) -> None:
    """The click is lifted as without the gears, by the wheel, which is what the teeth are counted on."""
    arbor = f"""
[bodies.arbor]
position = ["9 mm", "0 mm"]
inertia = "1 mg·cm²"
[[gears]]
between = ["arbor", "wheel"]
ratio = {ratio}
"""
    driven = f'[[torques]]\nbody = "arbor"\nvalue = "{math.copysign(1.0, -ratio)} µN·m"'
    text = RATCHET.replace('[[torques]]\nbody = "wheel"\nvalue = "-1 µN·m"', driven) + arbor
    found = []
    for name, content in (("plain", RATCHET), ("geared", text)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "scene.toml").write_text(content, encoding="utf-8")
        found.append(turn(ws.load(tmp_path / name)))
    plain, geared = found
    assert geared.wheel == "wheel" and geared.teeth == plain.teeth == 4
    assert geared.cycle.q[-1][:2] == pytest.approx(plain.cycle.q[-1], abs=1e-9)
    assert geared.advanced == pytest.approx(1.0)
    wheel, arbor_angle = geared.cycle.q[:, 0], geared.cycle.q[:, 2]
    assert wheel - wheel[0] == pytest.approx(ratio * (arbor_angle - arbor_angle[0]), abs=1e-9)
