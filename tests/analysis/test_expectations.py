"""Is what a scene promises judged in its own units, and are slips reported before a run?"""

import dataclasses
from collections.abc import Callable
from pathlib import Path

import pytest
from analysis.made_beats import lever_scene

from watchsim.analysis.expectation_faults import USUAL, expectation_faults, impossible, not_begun
from watchsim.analysis.expectations import KNOWN, judged, mistakes, not_judged, unit_of
from watchsim.analysis.summary import summary
from watchsim.cli import main
from watchsim.commands.console import BAD_INPUT
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Expectation, Scene
from watchsim.simulation.simulate import simulate

# Is what a scene promises judged in its own units, and are slips in keys caught?

NUMBERS = {
    "amplitude_deg": 290.7,
    "rate_s_per_d": -22.69,
    "period_s": 0.2500657,
    "beat_error_ms": 0.0126,
    "beat_error_ms_error": 0.001,
    "frequency_hz": 3.99895,
    "worst_penetration_m": 2e-12,
    "missed_beats": 0,
    "lcp_failures": None,
    "simulated_s": float("nan"),
    "scene": "Made",
    "stopped": False,
    "bodies": {"disc": {"x_m": 10.0939616, "angle_rad": -200.18, "angle_rad_per_s": -134.2, "x_m_per_s": 6.71}},
    "energy": {"dissipated": {"friction": 8e-6}, "in_J": 3e-5, "residual_relative": 4e-11},
}


def judge(expectation, numbers):
    return judged([expectation], numbers)[0]


def mistake(expectation, numbers):
    return mistakes([expectation], numbers)[0]


@pytest.mark.parametrize(
    ("key", "value", "tolerance", "unit", "got"),
    [
        ("amplitude", 290.73, 0.05, "°", 290.7),
        ("amplitude", 5.07, 0.01, "rad", 5.07367),
        ("rate", -22.7, 0.1, "s/d", -22.69),
        ("rate", -262.6, 0.1, "ppm", -262.616),
        ("period", 250.0657, 1e-3, "ms", 250.0657),
        ("beat_error", 0.0126, 1e-6, "ms", 0.0126),
        ("beat_error", 12.6, 1e-3, "µs", 12.6),
        ("frequency", 28792.4, 0.1, "vph", 28792.44),
        ("bodies.disc.x_m", 10093.96, 0.01, "mm", 10093.9616),
        ("bodies.disc.x_m", 10.0939616, 1e-8, "m", 10.0939616),
        ("bodies.disc.angle_rad", -200.18, 1e-6, "", -200.18),
        ("bodies.disc.angle_rad_per_s", -7689.1, 0.1, "°/s", -7689.094),
        ("bodies.disc.x_m_per_s", 6.71, 1e-9, "m/s", 6.71),
        ("energy.residual_relative", 0.0, 1e-8, "", 4e-11),
        ("energy.dissipated.friction", 8.0, 1e-9, "µJ", 8.0),
        ("energy.in_J", 30.0, 1e-9, "µJ", 30.0),
        ("worst_penetration_m", 0.0, 1.0, "nm", 0.002),
        ("missed_beats", 0, 0.5, "", 0),
        ("beat_error_ms_error", 1.0, 0.01, "µs", 1.0),
        ("amplitude_deg", 290.7, 0.01, "°", 290.7),
    ],
)
def test_kept(key, value, tolerance, unit, got):
    entry = judge(Expectation(key, value, tolerance, unit), NUMBERS)
    assert entry["ok"] is True and entry["got"] == pytest.approx(got, rel=1e-5) and entry["message"] == ""
    assert (entry["key"], entry["expected"], entry["tolerance"], entry["unit"]) == (key, value, tolerance, unit)


def test_missed_by_more_than_the_tolerance():
    entry = judge(Expectation("amplitude", 290.0, 0.5, "°"), NUMBERS)
    assert entry["ok"] is False and entry["got"] == pytest.approx(290.7)


@pytest.mark.parametrize(
    ("key", "unit", "message"),
    [
        ("amplitud", "°", 'Did you mean "amplitude"?'),
        ("bodies.disk.x_m", "m", 'Did you mean "bodies.disc.x_m"?'),
        ("worst_penetration", "m", 'Did you mean "worst_penetration_m"?'),
        ("zzz", "", "Known names: amplitude, rate, period, beat_error, frequency"),
        ("bodies.disc", "", "is not a number in the results"),
        ("scene", "", "is not a number in the results"),
        ("lcp_failures", "", 'this run gives no "lcp_failures"'),
        ("simulated_s", "s", 'this run gives no "simulated_s"'),
        ("bodies.disc.x_m", "°", "is in m, which cannot be compared with °"),
        ("missed_beats", "m", "is in plain numbers, which cannot be compared with m"),
    ],
)
def test_what_cannot_be_judged_is_not_kept(key, unit, message):
    entry = judge(Expectation(key, 0.0, 1e9, unit), NUMBERS)
    assert entry["ok"] is False and entry["got"] is None and message in entry["message"]


def test_units_at_the_ends_of_names():
    assert [
        unit_of(name) for name in ("rate_s_per_d", "wall_s", "beat_error_ms", "a.x_m_per_s", "impacts", "counts.steps")
    ] == [*("s/d", "s", "ms", "m/s", "", "")]


@pytest.mark.parametrize(("value", "kept"), [(4.5, True), (5.5, True), (4.499, False), (5.501, False)])
def test_the_tolerance_itself_is_still_kept(value: float, kept: bool) -> None:
    assert judge(Expectation("impacts", value, 0.5, ""), {"impacts": 5})["ok"] is kept


@pytest.mark.parametrize(("name", "known"), [("a.b", False), ("a.b.c", False), ("x.b.c", True), ("y.b", True), ("x.c", False)])
def test_below_what_is_null_anything_may_be_promised(name: str, known: bool) -> None:
    """Another run may give it; below a number there is nothing."""
    numbers = {"a": 3.5, "x": {"b": None, "a": 4.5}, "y": None}
    assert (mistake(Expectation(name, 0.0, 1.0, ""), numbers) == "") is known
    said = judge(Expectation(name, 0.0, 1.0, ""), numbers)
    assert said["ok"] is False and said["got"] is None
    assert (said["message"] == f'this run gives no "{name}"') is known


def test_units_are_those_of_the_number_even_where_it_is_not_known_yet() -> None:
    numbers = {"timegrapher": None}
    assert mistake(Expectation("timegrapher.rate_s_per_d", 0.0, 1.0, "ppm"), numbers) == ""
    said = mistake(Expectation("timegrapher.rate_s_per_d", 0.0, 1.0, "mm"), numbers)
    assert said == '"timegrapher.rate_s_per_d" is in s/d, which cannot be compared with mm'


def test_of_many_slips_the_first_twenty_are_advised() -> None:
    """Right keys between them do not count."""
    right, slip = Expectation("missed_beats", 0.0, 1.0, ""), Expectation("missed_beat", 0.0, 1.0, "")
    found = [said for said in mistakes([right, right, *[slip, right] * 22], NUMBERS) if said]
    assert len(found) == 22
    assert ['Did you mean "missed_beats"?' in said for said in found] == [True] * 20 + [False] * 2
    assert found[20].endswith(KNOWN) and found[21] == found[20]
    assert mistakes([right, right], NUMBERS) == ["", ""]


def test_each_of_many_is_judged_as_it_is_alone() -> None:
    promised = [Expectation("amplitude", 290.0, 1.0, "°"), Expectation("rate", 5.0, 1.0, "s/d"), Expectation("x", 0.0, 1.0, "")]
    found = judged(promised, NUMBERS)
    assert found == [judge(one, NUMBERS) for one in promised] and [one["ok"] for one in found] == [True, False, False]


def test_what_was_changed_is_not_judged() -> None:
    entry = judge(Expectation("amplitude", 290.0, 1.0, "°"), NUMBERS)
    told = not_judged(entry, ["--set", "--step"])
    assert told == entry | {"ok": None, "message": "not checked: changed by --set and --step"}


# Are slips in [expect] told before a run, and is no number refused that a run does give?

SCENE = profiles_dir() / "bench_lever" / "scene.toml"


def names(numbers: dict[str, object], above: str = "") -> list[str]:
    """Dotted names of all plain numbers."""
    found = []
    for key, value in numbers.items():
        if isinstance(value, dict):
            found += names(value, f"{above}{key}.")
        elif isinstance(value, (int, float)):
            found.append(f"{above}{key}")
    return found


@pytest.mark.parametrize("method", ["pfeiffer-glocker", "moreau"])
def test_every_number_of_a_run_may_be_promised(method: str) -> None:
    scene = load(SCENE)
    numbers = summary(simulate(scene, 1.0, method=method))
    promised = tuple(Expectation(name, 0.0, 1.0, "") for name in names(numbers))
    assert len(promised) > 80 and {"timegrapher.amplitude_deg", "energy.dissipated.friction"} <= {one.key for one in promised}
    assert expectation_faults(dataclasses.replace(scene, expect=promised)) == []


@pytest.mark.parametrize("name", ["bench_lever", "incline"])
def test_what_is_promised_most_often_is_in_every_summary(name: str) -> None:
    usual, all_of = dict(USUAL), summary(not_begun(load(profiles_dir() / name)))
    energy = usual.pop("energy")
    assert isinstance(energy, dict) and set(energy) <= set(all_of["energy"]) and set(usual) <= set(all_of)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('"amplitud" = { value = "275°", tolerance = "1°" }', 'Did you mean "amplitude"?'),
        ('"bodies.lever.x_m" = { value = "275°", tolerance = "1°" }', "is in m, which cannot be compared with °"),
    ],
)
def test_a_slip_is_told_before_the_run(line: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for drawing in SCENE.parent.glob("*.dxf"):
        (tmp_path / drawing.name).write_bytes(drawing.read_bytes())
    text = f"{SCENE.read_text(encoding='utf-8')}\n{line}\n"
    number = next(i for i, one in enumerate(text.splitlines(), 1) if one == line)
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    for command in (["check", str(tmp_path)], ["run", str(tmp_path), "-o", str(tmp_path / "out")]):
        assert main(command) == BAD_INPUT
        told = capsys.readouterr().err
        assert message in told and f"scene.toml:{number}" in told
    assert not (tmp_path / "out").exists()


def sliding(scene: Scene) -> Scene:
    bodies = tuple(dataclasses.replace(b, motion="slide", mass=1e-6) if b.name == "balance" else b for b in scene.bodies)
    return dataclasses.replace(scene, bodies=bodies)


NO_SPRING, NO_LIFT, ALONE, NO_DRIVE = (
    lambda scene: dataclasses.replace(scene, springs=()),
    lambda scene: dataclasses.replace(scene, lift_angle=None),
    lambda scene: dataclasses.replace(scene, contacts=(), torques=()),
    lambda scene: dataclasses.replace(scene, torques=()),
)


@pytest.mark.parametrize(
    ("key", "change", "why"),
    [
        ("amplitude", NO_SPRING, "nothing in it swings on a spring or by gravity"),
        ("amplitude", sliding, "balance slides, so it has no amplitude in degrees"),
        ("timegrapher.amplitude_deg", sliding, "balance slides, so it has no amplitude in degrees"),
        ("rate", sliding, ""),
        ("amplitude", NO_LIFT, ""),
        ("timegrapher.amplitude_deg", NO_LIFT, "it names no lift_angle under [timegrapher]"),
        ("timegrapher.rate_s_per_d", NO_LIFT, ""),
        ("timegrapher.rate_s_per_d", ALONE, "nothing may touch balance, so no beat is heard"),
        ("efficiency", NO_DRIVE, "no driven wheel keeps the oscillator going"),
        ("missed_beats", NO_DRIVE, "no driven wheel keeps the oscillator going"),
        ("impacts", NO_SPRING, ""),
        *((key, lambda scene: scene, "") for key in ("amplitude", "rate", "efficiency", "timegrapher.amplitude_deg")),
    ],
)
def test_what_no_run_can_give_is_refused(key: str, change: Callable[[Scene], Scene], why: str) -> None:
    said = impossible(Expectation(key, 0.0, 1.0, ""), change(lever_scene()))
    assert said == (f'no run of this scene gives "{key}": {why}. Leave it out' if why else "")


def test_a_run_that_has_not_begun_stands_where_its_bodies_start() -> None:
    """As the scene gives it: carried bodies against their carriers."""
    bodies = (
        Body("arm", angle=0.4, inertia=1e-9),
        Body("planet", angle=-0.7, inertia=1e-9, on="arm", position=(1e-3, 0.0)),
        Body("stone", "free", position=(3e-3, 5e-3), angle=0.9, mass=1e-3, inertia=1e-9),
    )
    run = not_begun(Scene("Carried", bodies))
    at = {name: run.q[0, columns].tolist() for name, columns in run.slices.items()}
    assert at["arm"] == pytest.approx([0.4]) and at["planet"] == pytest.approx([-0.7])
    assert at["stone"] == pytest.approx([3e-3, 5e-3, 0.9])
    assert run.t.tolist() == [0.0] and run.q.shape == run.u.shape == run.a.shape == (1, 5)
    assert not run.u.any() and not run.a.any() and len(run.events) == 0
