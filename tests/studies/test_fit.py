"""Does a fit find the numbers that made the data, say how well it knows them, and name what it cannot tell apart?"""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import watchsim as ws
from watchsim.cli import main
from watchsim.studies.measured import Measured

SWISS = ws.profiles_dir() / "swiss_lever"
BENCH = ws.profiles_dir() / "bench_lever"

BALANCE = """
[scene]
schema = 1
[bodies.balance]
circle  = "5 mm"
inertia = "12 mg·cm²"
angle   = "{angle}°"
[[springs]]
body      = "balance"
stiffness = "0.8 µN·m/rad"
[[damping]]
body    = "balance"
viscous = "{viscous} nN·m·s/rad"
[run]
duration  = "2 s"
tolerance = 1e-9
"""
KEYS = ("springs.0.stiffness", "damping.0.viscous", "bodies.balance.angle")
TRUE = (0.77e-6, 0.31e-9, math.radians(212.0))


def swing(t, stiffness, viscous, start, inertia=1.2e-9):
    """Angle (degrees) of a damped oscillator let go at rest: a textbook formula."""
    decay = viscous / (2.0 * inertia)
    w = math.sqrt(stiffness / inertia - decay**2)
    return np.degrees(start * np.exp(-decay * t) * (np.cos(w * t) + decay / w * np.sin(w * t)))


@pytest.fixture(scope="module")
def balance(tmp_path_factory):
    folder = tmp_path_factory.mktemp("balance")
    (folder / "scene.toml").write_text(BALANCE.format(angle=200, viscous=0.2), encoding="utf-8")
    return folder


def decay(noise, seed, count=60):
    times = np.linspace(0.02, 2.0, count)
    values = swing(times, *TRUE) + noise * np.random.default_rng(seed).standard_normal(count)
    return times, values


def written(path, times, values, *more):
    lines = [f"{t!r},{a!r}" for t, a in zip(times.tolist(), values.tolist(), strict=True)]
    path.write_text("\n".join(["t_s,angle_deg", *lines, *more]) + "\n", encoding="utf-8")
    return path


def test_a_decay_without_noise(balance, tmp_path, capsys):
    path = written(tmp_path / "decay.csv", *decay(0.0, 0))
    arguments = [one for key in KEYS for one in ("--vary", key)]
    assert main(["fit", str(balance), str(path), *arguments, "--json", "-o", str(tmp_path / "out")]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {"keys", "residual", "cannot_tell_apart", "wall_s"} <= set(found) and found["cannot_tell_apart"] == []
    for key, value in zip(KEYS, TRUE, strict=True):
        assert found["keys"][key]["value"] == pytest.approx(value, rel=1e-7)
    assert "95 % intervals" in ws.fit(balance, path, KEYS)._repr_html_()
    again = ws.simulate(ws.load(tmp_path / "out"), 2.0)
    assert math.degrees(again.at(1.3)[0][0]) == pytest.approx(float(swing(np.array(1.3), *TRUE)), abs=1e-4)
    assert (tmp_path / "out" / "fit.png").is_file()


def covered(balance, seeds, noise=0.4):
    """In how many fits each interval holds the true value."""
    scene, hits = ws.load(balance), np.zeros(len(KEYS))
    for seed in seeds:
        times, values = decay(noise, seed)
        nothing = np.full(len(times), np.nan)
        found = ws.fit(scene, Measured("decay", {"angle_deg": values}, {"angle_deg": nothing}, ({},) * len(times), times), KEYS)
        hits += [found.keys[key].low <= value <= found.keys[key].high for key, value in zip(KEYS, TRUE, strict=True)]
        assert found.scatter["angle_deg"] == pytest.approx(noise, rel=0.4)
    return hits


def test_intervals_hold_the_true_values(balance):
    assert covered(balance, range(6)).min() >= 4


@pytest.mark.slow
def test_intervals_hold_the_true_values_as_often_as_they_say(balance):
    """Of 400, three standard deviations of a binomial on either side of 95 %."""
    hits = covered(balance, range(400)) / 4.0
    assert ((hits > 95.0 - 3.3) & (hits < 95.0 + 3.3)).all()


def test_a_limit_that_is_reached_leaves_no_interval(balance, tmp_path):
    """The spring is softer than it may become: what was measured lies beyond, and the interval cannot hold it."""
    path = tmp_path / "decay.csv"
    written(path, *decay(0.1, 3))
    stiff = ws.load(balance).springs[0].stiffness
    found = ws.fit(balance, path, {"springs.0.stiffness": (1.001 * TRUE[0], 2.0 * stiff), "damping.0.viscous": None})
    assert "springs.0.stiffness came to its limit" in found.message
    assert found.keys["springs.0.stiffness"].low is None and found.keys["springs.0.stiffness"].high is None
    assert found.keys["damping.0.viscous"].low is not None


def test_what_cannot_be_told_apart_is_named(balance, tmp_path):
    """Inertia, stiffness and damping only matter by their ratios; a mass changes nothing."""
    path = written(tmp_path / "decay.csv", *decay(0.1, 1))
    found = ws.fit(balance, path, [*KEYS, "bodies.balance.inertia"])
    assert found.cannot_tell_apart == (("springs.0.stiffness", "damping.0.viscous", "bodies.balance.inertia"),)
    assert "1 % more springs.0.stiffness with 1 % more damping.0.viscous and 1 % more bodies.balance.inertia" in found.words[0]
    assert found.keys["springs.0.stiffness"].low is None and found.keys["bodies.balance.angle"].low is not None
    ratio = found.keys["springs.0.stiffness"].value / found.keys["bodies.balance.inertia"].value
    assert ratio == pytest.approx(TRUE[0] / 1.2e-9, rel=1e-3)


@pytest.mark.slow
def test_readings_of_a_timing_machine(tmp_path):
    """Friction and inertia from readings at three drives; by the amplitude alone friction and drive are one number."""
    scene = ws.load(BENCH)
    scene = scene.set("springs.0.stiffness", scene.springs[0].stiffness)  # given as a frequency it would follow the inertia
    true = scene.set("contacts.0.friction", 0.13).set("bodies.balance.inertia", "12.2 mg·cm²")
    lines = ["torques.0.value,amplitude_deg,rate_s_per_d,amplitude_deg_error,rate_s_per_d_error"]
    random = np.random.default_rng(5)
    nominal = scene.set("timegrapher.frequency", "4 Hz") if scene.nominal is None else scene
    for torque in (-5e-6, -6e-6, -7e-6):
        cycle = ws.steady(true.set("torques.0.value", torque).set("timegrapher.frequency", nominal.nominal))
        amplitude, rate = cycle.amplitude_deg + 0.2 * random.standard_normal(), cycle.rate_s_per_d + random.standard_normal()
        lines.append(f"{1e6 * torque} µN·m,{amplitude},{rate},0.2,1")
    path = tmp_path / "readings.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    found = ws.fit(nominal, path, ["contacts.0.friction", "bodies.balance.inertia"])
    for key, value, share in (("contacts.0.friction", 0.13, 0.7), ("bodies.balance.inertia", 1.22e-9, 1e-4)):
        assert found.keys[key].low < value < found.keys[key].high
        assert 0.0 < found.keys[key].high - found.keys[key].low < share * value
    alone = tmp_path / "alone.csv"
    alone.write_text("amplitude_deg\n" + "\n".join(f"{290.0 + 0.3 * k}" for k in range(4)) + "\n", encoding="utf-8")
    apart = ws.fit(nominal, alone, {"contacts.0.friction": (0.05, 0.3), "torques.0.value": None})
    assert apart.cannot_tell_apart == (("contacts.0.friction", "torques.0.value"),)


@pytest.mark.slow
def test_readings_in_positions_and_hours_after_winding(tmp_path):
    """Where the balance's centre of mass lies, and what its train leaves of the force, from readings like a certificate's."""
    scene = ws.load(Path(__file__).parents[2] / "docs" / "guide" / "positions" / "swiss_lever.toml")
    centre = "bodies.balance.centre_of_mass"
    truth = {f"{centre}.0": 0.9e-6, f"{centre}.1": 0.3e-6, "torques.0.efficiency": 0.72}
    watches, errors = (("CH", 0), ("3H", 0), ("6H", 0), ("9H", 24), ("CH", 24)), np.array([0.1, 0.2])

    def read(values):
        """Rates and amplitudes of the watches (10), in parts of their errors."""
        true = scene
        for key, value in values.items():
            true = true.set(key, value)
        cycles = [ws.steady(true.set("watch.position", one).set("watch.since_wound", 3600.0 * wound)) for one, wound in watches]
        return np.concatenate([(one.rate_s_per_d, one.amplitude_deg) / errors for one in cycles])

    readings = (read(truth) + np.random.default_rng(11).standard_normal(10)).reshape(-1, 2) * errors
    lines = ["position,wound_h,rate_s_per_d,amplitude_deg,rate_s_per_d_error,amplitude_deg_error"]
    for (position, wound), (rate, amplitude) in zip(watches, readings, strict=True):
        lines.append(f"{position},{wound},{rate},{amplitude},0.1,0.2")
    (tmp_path / "readings.csv").write_text("\n".join(lines), encoding="utf-8")
    found = ws.fit(scene, tmp_path / "readings.csv", list(truth))
    # What such readings can say, by differences about the truth: the height of the centre to no better than ±15 %.
    ends = [[read(truth | {key: (1.0 + step) * value}) for step in (-0.01, 0.01)] for key, value in truth.items()]
    jacobian = np.array([(high - low) / 0.02 for low, high in ends]).T  # by shares of the truth
    widths = 2.0 * 1.959964 * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))
    for (key, value), width in zip(truth.items(), widths, strict=True):
        one = found.keys[key]
        assert one.low < value < one.high
        assert one.high - one.low == pytest.approx(width * value, rel=0.1)


@pytest.mark.slow
def test_a_recording(tmp_path):
    """A louder tick of a stronger watch: its drive from the amplitude that a timing machine hears."""
    true = ws.load(SWISS).set("torques.0.value", "-1.1 µN·m").set("bodies.balance.angle", "-288°")
    path = ws.sound(ws.simulate(true, 20.0), tmp_path / "tape.wav")
    found = ws.fit(SWISS, path, ["torques.0.value"])
    assert found.keys["torques.0.value"].value == pytest.approx(-1.1e-6, rel=0.05)


@pytest.mark.parametrize(
    ("content", "arguments", "all_of"),
    [
        ("", ["--vary", "damping.0.viscous"], ["is empty"]),
        ("time,angle\n0,1\n", ["--vary", "damping.0.viscos"], ["time", "viscos"]),
        (
            "t_s,angle_deg\n0,1\n1,x\n0.5,2,3\n",
            ["--vary", "springs.0.stiffness=2:2 µN·m/rad"],
            ['"x" is no number', "row 4", "limits must differ"],
        ),
        ("t_s,angle_deg\n0,1\n2,1\n1,3\n", ["--vary", "springs.0.stiffness"], ["grow from row to row"]),
        (
            "t_s,angle_deg,angle_deg_error\n0,1,0\n0.1,0.9,-1\n0.2,0.8,\n",
            ["--vary", KEYS[0]],
            ["standard errors must be above zero"],
        ),
        ("t_s,angle_deg\n0,1\n", ["--vary", "springs.0.stiffness", "--vary", "damping.0.viscous"], ["cannot decide 2"]),
        ("position,rate_s_per_d\nXX,1\n", ["--vary", "springs.0.stiffness"], ['"XX" is no position']),
        ("wound_h,rate_s_per_d\n2,1\n", ["--vary", "springs.0.stiffness"], ["needs a mainspring"]),
        ("t_s,angle_deg\n0,1\n", [], ["--vary"]),
        (None, ["--vary", "springs.0.stiffness=1", "--workers", "0"], ["no such file", "KEY=FROM:TO", "--workers"]),
    ],
)
def test_all_faults_at_once(balance, tmp_path, capsys, content, arguments, all_of):
    path = tmp_path / "measured.csv"
    if content is not None:
        path.write_text(content, encoding="utf-8")
    assert main(["fit", str(balance), str(path), *arguments]) == 2
    said = capsys.readouterr().err
    assert all(words in said for words in all_of) and "Traceback" not in said


@pytest.mark.slow
def test_a_scene_that_does_not_work_is_no_start(tmp_path):
    path = tmp_path / "readings.csv"
    path.write_text("amplitude_deg;rate_s_per_d\n270,5;1,5\n", encoding="utf-8")
    found = ws.fit(ws.load(BENCH).set("torques.0.value", "-0.01 µN·m"), path, ["torques.0.value"])
    assert not found.found and "does not work as it is" in found.message


def test_a_fault_names_the_command_that_was_given(tmp_path, capsys):
    readings = tmp_path / "decay.csv"
    readings.write_text("t_s,angle_deg\n0,1\n1,0.5\n")
    assert main(["fit", str(ws.profiles_dir() / "swiss_lever"), str(readings), "--vary", "bodies.nope.inertia"]) == 2
    assert "fit  bodies.nope.inertia" in capsys.readouterr().err
