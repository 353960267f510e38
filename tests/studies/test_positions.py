"""Does the table of positions hold what each state gives by itself, and does what follows from it follow?"""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import watchsim as ws
from watchsim.cli import main
from watchsim.scene.load import from_mapping
from watchsim.scene.scene import Scene
from watchsim.scene.toml import parsed
from watchsim.studies.positions import Balance, Positions, positions_of
from watchsim.studies.study_report import positions_text

LEVER = ws.profiles_dir() / "swiss_lever" / "scene.toml"
HEAVY = (1.5e-6, -1e-6)  # m, of the balance's centre of mass
MASS = 60e-6  # kg
ADDED = """
[bodies.balance]
mass = "60 mg"
centre_of_mass = ["1.5 µm", "-1 µm"]
[[torques]]
body = "wheel"
over = "barrel"
table = [["0 rev", "9.1 mN·m"], ["3.5 rev", "7.4 mN·m"], ["7 rev", "3 mN·m"]]
ratio = -6480
efficiency = 0.75
[watch]
thermal = { stiffness = "3 ppm/K", inertia = "-4 ppm/K", damping = "-1 %/K" }
"""


def lever(added: str = ADDED) -> Scene:
    """The profile with an unpoised balance, a mainspring and temperature coefficients."""
    text, more = parsed(LEVER.read_text(encoding="utf-8")), parsed(added)
    text["bodies"]["balance"] |= more.pop("bodies", {}).get("balance", {})
    return from_mapping(text | more, LEVER)


@pytest.fixture(scope="module")
def day() -> Positions:
    return ws.positions(lever(), temperatures=[23.0])


def j1(x: float) -> float:
    """Bessel's integral (DLMF 10.9.2) by the trapezium rule, which is exact to rounding for what is periodic."""
    turn = np.arange(200) * math.tau / 200
    return float(np.mean(np.cos(turn - x * np.sin(turn))))


def test_each_reading_is_the_cycle_of_its_state_made_by_hand(day: Positions) -> None:
    """Gravity, and a constant torque in place of the mainspring, the wheel being 4·86400 teeth on."""
    assert "12H" in day._repr_html_() and "<img" in day._repr_html_()
    assert day.whole and day.states == ((23.0, 0.0), (23.0, 24.0)) and len(day.rows) == 12
    turned = 86400 * 4 / 15 / 6480  # of the barrel
    torque = -0.75 / 6480 * (7.4e-3 + (turned - 3.5) / 3.5 * (3e-3 - 7.4e-3))
    scene = replace(lever().set("torques.0.value", torque), gravity=(9.80665, 0.0))  # the damper stays the same
    alone, row = ws.steady(scene), day.at((23.0, 24.0))["9H"]
    for name in ("amplitude_deg", "rate_s_per_d", "beat_error_ms"):
        assert row[name] == pytest.approx(getattr(alone, name), abs=row[f"{name}_error"])


def test_the_rates_of_upright_positions_obey_the_law_of_the_poise_error(day: Positions) -> None:
    """86400 (m r·g / k) J1(A)/A within 0.5 % of the largest, wound and a day later."""
    k = 12e-10 * (math.tau * 4.0) ** 2
    pull = {"12H": (0.0, -1.0), "6H": (0.0, 1.0), "3H": (-1.0, 0.0), "9H": (1.0, 0.0), "CH": (0.0, 0.0), "CB": (0.0, 0.0)}
    for state in day.states:
        rows = day.at(state)
        seen, law = {}, {}
        for name, (x, y) in pull.items():
            swing = math.radians(rows[name]["amplitude_deg"])
            law[name] = 86400 * MASS * 9.80665 * (HEAVY[0] * x + HEAVY[1] * y) / k * j1(swing) / swing
            seen[name] = rows[name]["rate_s_per_d"] - rows["CH"]["rate_s_per_d"]
        most = max(map(abs, law.values()))
        assert most > 3.0 and seen == pytest.approx(law, abs=5e-3 * most)


def test_the_poise_error_is_found_where_it_is(day: Positions) -> None:
    poise = day.poise
    assert poise is not None and day.balance is not None
    true = MASS * math.hypot(*HEAVY)
    assert poise.amount == pytest.approx(true, rel=5e-3) and abs(poise.amount - true) < 2.0 * poise.error
    assert math.remainder(poise.direction - math.atan2(HEAVY[1], HEAVY[0]), math.tau) == pytest.approx(0.0, abs=5e-3)
    assert day.balance.amount == pytest.approx(true, rel=1e-12)


@pytest.mark.parametrize("twelve, from_back", [(90.0, False), (-30.0, False), (200.0, True)])
@pytest.mark.parametrize("rest", [0.0, 0.3])
def test_a_poise_error_is_recovered_from_the_rates_it_makes(twelve: float, from_back: bool, rest: float) -> None:
    """Made rates: a heavy side at -1 rad of a balance that rests turned by `rest`, in whatever way the movement is drawn."""
    amount, k, heavy = 3e-11, 7e-7, -1.0
    rows = []
    for hour in (12, 2, 5, 9):
        up = math.radians(twelve + (30.0 if from_back else -30.0) * hour)
        swing = 4.5 + 0.02 * hour
        hangs = -amount * math.cos(heavy + rest - up)  # kg·m below the axis
        rows.append(made(f"{hour}H", -2.0 + 86400 * 9.80665 * hangs * j1(swing) / (swing * k), up, math.degrees(swing)))
    found = Positions("", tuple(rows), Balance(k, rest, 0.0, 0.0), False, True, 0.0).poise
    assert found is not None and found.amount == pytest.approx(amount, rel=1e-9)
    assert math.remainder(found.direction - heavy, math.tau) == pytest.approx(0.0, abs=1e-9)


def made(position: str, rate: float | None, up: float | None = None, swing: float = 270.0, at: float = 23.0, h: float = 0.0):
    upright = None if position in ("CH", "CB") else math.degrees(up or 0.0)
    row = {"position": position, "up_deg": upright, "temperature_c": at, "wound_h": h, "verdict": "ticks", "message": ""}
    return row | {"amplitude_deg": swing, "rate_s_per_d": rate, "beat_error_ms": 0.0} | dict.fromkeys(ERRORS, 0.0)


ERRORS = ("amplitude_deg_error", "rate_s_per_d_error", "beat_error_ms_error")
WOUND = {"CH": 4.0, "CB": 5.0, "3H": 1.0, "6H": -1.5, "9H": 3.0, "12H": -2.0}
LATER = {"CH": 2.0, "CB": 3.0, "3H": -3.0, "6H": -5.5, "9H": 1.0, "12H": -4.0}
MADE = [made(name, rate) for name, rate in WOUND.items()] + [made(name, rate, h=24.0) for name, rate in LATER.items()]
MADE += [
    made("CH", 14.0, at=8.0),
    made("CH", 12.0, at=8.0, h=24.0),
    made("CH", -7.0, at=38.0),
    made("CH", -9.0, at=38.0, h=24.0),
]


def test_mean_and_differences_as_a_timing_machine_shows_them() -> None:
    found = Positions("", tuple(MADE), None, True, True, 0.0)
    assert found.home == (23.0, 0.0) and found.poise is None
    wound = {"X": 9.5 / 6, "D": 7.0, "DVH": 0.5 / 4 - 4.5, "DVm": 5.0, "Di": None}
    later = {"X": -6.5 / 6, "D": 8.5, "DVH": -11.5 / 4 - 2.5, "DVm": 6.5, "Di": -16.0 / 6}
    for state, law in (((23.0, 0.0), wound), ((23.0, 24.0), later)):
        shown = found.summary(state)
        assert {name: one for name, one in shown.items() if one is not None} == pytest.approx(
            {name: one for name, one in law.items() if one is not None}
        )
        assert shown.keys() == law.keys()
    stopped = replace(found, rows=(*MADE[:5], MADE[5] | {"rate_s_per_d": None}))
    assert stopped.summary((23.0, 0.0)) == {"X": None, "D": None, "DVH": None, "DVm": None, "Di": None}


def test_the_criteria_of_a_chronometer() -> None:
    """Daily rates 3, 4 (lying), -1, -3.5, 2 (3H, 6H, 9H): their mean 0.9, furthest from it 4.4; -21 s/d in 30 K."""
    found = Positions("", tuple(MADE), None, True, True, 0.0)
    values = {"mean_daily_rate": 0.9, "vertical_less_horizontal": -6.5, "greatest_deviation": 4.4, "thermal_variation": -0.7}
    for category, kept in ((1, [True, False, True, False]), (2, [True, True, True, True])):
        seen = found.iso3159(category)
        assert {name: one.value for name, one in seen.items() if one.value is not None} == pytest.approx(values)
        assert [seen[name].ok for name in values] == kept
        assert all(seen[name].ok is None for name in ("mean_variation", "greatest_variation", "rate_resumption"))
    cold = replace(found, thermal=False).iso3159()["thermal_variation"]
    assert cold.ok is None and "watch.thermal" in cold.why


def test_the_command_prints_the_fixed_names_resumes_and_makes_a_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "out"
    asked = ["positions", str(LEVER), "--positions", "CH,3h,10H30,6H,9H,CB", "--workers", "1", "-o", str(folder), "--json"]
    assert main(asked) == 0
    told = json.loads(capsys.readouterr().out)
    names = {"rows", "mean_rate_s_per_d", "spread_s_per_d", "dvh_s_per_d", "poise", "iso3159"}
    assert names <= told.keys() and {"amount_kg_m", "direction_deg"} <= told["poise"].keys()
    assert [row["position"] for row in told["rows"]] == ["CH", "3H", "10H30", "6H", "9H", "CB"]
    assert all(row["rate_s_per_d"] == told["rows"][0]["rate_s_per_d"] for row in told["rows"])  # a poised balance
    assert told["iso3159"]["mean_daily_rate"]["limit"] == [-4.0, 6.0] and told["iso3159"]["thermal_variation"]["ok"] is None
    text = positions_text(positions_of(told))
    assert "poise error: none (below 0.001 µg·cm); the scene's own is none" in text
    assert "not judged: needs CH at 8 °C and 38 °C" in text
    (folder / "rows.jsonl").write_text("".join((folder / "rows.jsonl").read_text(encoding="utf-8").splitlines(True)[:4]))
    assert main([*asked, "--resume"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["rows"] == told["rows"]
    assert main(["report", str(folder)]) == 0
    page = (folder / "positions.html").read_text(encoding="utf-8")
    assert "10H30" in page and "ISO 3159" in page and "data:image/png" in page
    assert {"positions.csv", "positions.json", "positions.png"} <= {path.name for path in folder.iterdir()}


BAD = [
    (["--positions", "CH,13H"], '"13H" is no position'),
    (["--positions", ","], "name at least one"),
    (["--temperatures", "warm"], "write numbers separated by commas, such as 8,23,38"),
    (["--temperatures", "warm", "--positions", "13H"], '"13H" is no position'),
    (["--temperatures", "23,300"], "must lie between −60 °C and 120 °C"),
    (["--wound", "0,24"], "needs a mainspring"),
    (["--wound", "-1"], "the mainspring was wound before now"),
    (["--workers", "0"], "at least one process is needed"),
    (["--set", "watch.twelve=3H"], "watch.twelve"),
]


@pytest.mark.parametrize("options, words", BAD, ids=lambda one: one if isinstance(one, str) else " ".join(one))
def test_what_cannot_be_asked_is_refused(
    options: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["positions", str(LEVER), "-o", str(tmp_path / "out"), *options]) == 2
    assert words in capsys.readouterr().err and not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.parametrize("position, at, hours", [("3H", 8.0, 24.0), ("9H", 23.0, 0.0), ("12H", 38.0, 24.0)])
def test_a_reading_is_what_a_run_of_five_minutes_comes_to(position: str, at: float, hours: float) -> None:
    """With the torque of that hour kept, and steps a hundred times as exact."""
    from watchsim.analysis.timing import mean_over
    from watchsim.scene.forces import Torque

    (row,) = ws.positions(lever(), [position], temperatures=[at], wound=[hours]).rows
    scene = lever().set("watch.position", position).set("watch.temperature", at).set("watch.since_wound", 3600.0 * hours)
    scene = replace(scene, torques=tuple(Torque(one.body, one.value) for one in scene.torques))
    means = mean_over(ws.simulate(scene, 300.0, 1e-11, record="statistics"))
    for name in ("amplitude_deg", "rate_s_per_d", "beat_error_ms"):
        assert getattr(means, name) == pytest.approx(row[name], abs=row[f"{name}_error"])
