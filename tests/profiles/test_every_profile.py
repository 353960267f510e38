"""Does every profile keep what it promises, run for five minutes, and close its energy account to 1e-9?"""

import math
from pathlib import Path

import pytest
from profiles.running import stepping_errors

import watchsim as ws
from watchsim import designs

PROFILES = sorted(path.parent.name for path in Path(str(ws.profiles_dir())).glob("*/scene.toml"))
LONG, WORST = 300.0, 1e-9  # s; residual of the energy account, as a share of what goes in


@pytest.mark.parametrize("name", PROFILES)
def test_it_keeps_what_it_promises(name: str) -> None:
    """For as long as its scene says."""
    run = ws.simulate(ws.load(ws.profiles_dir() / name), record="statistics")
    found = ws.summary(run)
    assert run.stop.name == "DURATION"
    assert found["expect"], "a profile is a test: it promises something"
    assert [one for one in found["expect"] if not one["ok"]] == []
    assert run.worst_penetration < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("name", PROFILES)
def test_it_runs_for_five_minutes(name: str) -> None:
    run = ws.simulate(ws.load(ws.profiles_dir() / name), duration=LONG, record="statistics")
    assert run.stop.name == "DURATION"
    assert run.simulated == pytest.approx(LONG)
    assert ws.summary(run)["missed_beats"] in (0, None)
    assert run.worst_penetration < 1e-9
    assert abs(run.energy["residual_relative"]) < WORST
    assert run.counts["lcp_failures"] == 0
    assert name not in PITCHES or abs(gone(run, PITCHES[name])) < 1.5


PITCHES = {  # degrees, of the escape wheel: it goes on by half a pitch in each beat
    **dict.fromkeys(("detent", "cylinder", "duplex", "pin_pallet"), 24.0),
    **dict.fromkeys(("pin_wheel", "graham", "recoil_anchor"), 12.0),
    "grasshopper": 6.0,
}


def gone(run: ws.Trajectory, pitch: float) -> float:
    """Half pitches by which the wheel has gone on, less the beats in that time."""
    angle = run.scene.body("wheel").angle - float(run.end_q[run.slices["wheel"].start])
    return math.degrees(angle) / (0.5 * pitch) - 2.0 * run.simulated * ws.summary(run)["frequency_hz"]


@pytest.mark.parametrize(("name", "pitch"), PITCHES.items())
def test_its_wheel_goes_on_by_half_a_pitch_in_each_beat(name: str, pitch: float) -> None:
    run = ws.simulate(ws.load(ws.profiles_dir() / name), duration=20.0 if pitch == 24.0 else 60.0)
    assert run.stop.name == "DURATION"
    assert ws.summary(run)["missed_beats"] == 0
    assert abs(gone(run, pitch)) < 1.5
    assert run.worst_penetration < 1e-9
    assert abs(run.energy["residual_relative"]) < WORST


# Duration and two steps, s; most of the error of half swings at the finer one, degrees, and as a share of that at the other.
STEPPED = {
    "detent": (2.0, (1.6e-5, 4e-6), 2e-3, 1.0),
    "cylinder": (2.0, (1.6e-5, 4e-6), 3e-3, 0.5),
    "duplex": (2.0, (1.6e-5, 4e-6), 8e-3, 0.5),
    "pin_pallet": (2.0, (1.6e-5, 4e-6), 0.01, 0.5),
    "pin_wheel": (8.0, (1e-4, 2.5e-5), 2e-5, 1.0),
}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "how"), STEPPED.items())
def test_time_stepping_comes_to_the_same(name: str, how: tuple[float, tuple[float, float], float, float]) -> None:
    duration, steps, largest, share = how
    coarse, fine = stepping_errors(getattr(designs, name)().scene(), duration, steps)
    assert fine < largest and fine < share * coarse
