"""Is what a blow does found as it is, and does the watch that is not struck stay out of it?"""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import watchsim as ws
from watchsim.cli import main
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Shock
from watchsim.scene.scene import Scene
from watchsim.studies.shock import HEIGHT, LASTS, struck, unstruck

PROFILE = "profiles/swiss_lever"
HEAVY = ("bodies.lever.mass", "8 mg"), ("bodies.lever.centre_of_mass", ["0 mm", "0.3 mm"])


@pytest.fixture(scope="module")
def scene() -> Scene:
    """A Swiss lever whose lever is not poised."""
    made = ws.load(PROFILE)
    for key, value in HEAVY:
        made = made.set(key, value)
    return made


def test_guard_pin_and_safety_roller_keep_the_lever_on_its_side(scene: Scene) -> None:
    beside = unstruck(scene, 1.0)
    away, pressed = (struck(beside, 0.0, 4.43, phase)[0] for phase in (0.25, 0.75))
    assert away.jewel_ok and away.guard_blows > 0 and away.harmless
    assert pressed.jewel_ok and pressed.guard_blows == 0 and pressed.harmless
    # From the other side the same happens half an oscillation later.
    other = struck(beside, math.pi, 4.43, 0.75)[0]
    assert other.guard_blows == away.guard_blows and other.lost_s == pytest.approx(away.lost_s, rel=0.2)


def test_without_a_guard_pin_the_lever_goes_over(scene: Scene) -> None:
    left = tuple(one for one in scene.contacts if all(str(side) != "lever.DART" for side in one.sides))
    assert len(left) == len(scene.contacts) - 1
    found = ws.shock(replace(scene, contacts=left), 0.0, phase=0.25, after=2.0)
    assert found.jewel_ok is False and not found.harmless and found.verdict == "overbanks"
    assert found.lost_s is None and found.recovery_s is None


def test_the_blow_meets_a_watch_that_has_settled(scene: Scene) -> None:
    """The rate without the blow is that of the limit cycle, and so is its amplitude, from the first second on."""
    cycle, beside = ws.steady(scene), unstruck(scene, 2.0)
    late = beside.found.amplitude_deg[beside.found.t > 1.0]
    assert np.abs(late - cycle.amplitude_deg).max() < 0.05
    found = struck(beside, 0.0, 4.43, 0.25)[0]
    assert found.verdict == "ticks"
    assert found.rate_without_s_per_d == pytest.approx(cycle.rate_s_per_d, abs=0.05)
    assert found.rate_s_per_d == pytest.approx(cycle.rate_s_per_d, abs=1.0)


def test_a_blow_too_soft_to_move_the_lever_changes_nothing(scene: Scene) -> None:
    """Draw holds it: the passages are the same to rounding of the tolerance."""
    found = ws.shock(scene, 0.0, 1e-6, 0.25, after=1.0)
    assert found.guard_blows == 0 and found.recovery_s == 0.0
    assert found.lost_s == pytest.approx(0.0, abs=1e-9) and found.amplitude_change_deg == pytest.approx(0.0, abs=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("direction", "phase"), [(0.0, 0.0), (0.0, 0.25), (math.pi / 3.0, 0.125)])
def test_time_stepping_moves_as_far(scene: Scene, direction: float, phase: float) -> None:
    """The balance 30 ms after the blow, against where it would be without it: steps of 0.5 µs miss a share of that."""
    found = ws.beats(ws.simulate(scene, 1.0))
    start = float(found.t[found.end_at > found.start_at][0]) + phase * 0.25
    shock = Shock(start, LASTS, (HEIGHT * math.cos(direction), HEIGHT * math.sin(direction)))
    hit = replace(scene, shocks=(shock,))
    end = start + 0.03
    exact, plain = (ws.simulate(one, end).end_q[2] for one in (hit, scene))
    stepped = [ws.simulate(hit, end, method="moreau", step=h).end_q[2] for h in (2e-6, 5e-7)]
    assert abs(exact - plain) > 1e-4
    assert abs(stepped[1] - exact) < 0.05 * abs(exact - plain)


def test_the_map_has_a_row_for_each_direction(scene: Scene, tmp_path: Path) -> None:
    found = ws.shock_map(scene, directions=2, phases=3, after=0.5)
    assert found.whole and len(found.blows) == 6
    assert [(one.direction_deg, one.phase) for one in found.blows[:4]] == [(0.0, 0.0), (0.0, 1 / 3), (0.0, 2 / 3), (180.0, 0.0)]
    assert found.harmless == 6
    ws.plot_shock_map(found).savefig(tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 5000


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({}, "no body feels a blow"),
        ({"shocks": (Shock(1.0, 1e-3, (1.0, 0.0)),)}, "blows of its own"),
        ({"springs": (), "torques": ()}, "nothing swings"),
    ],
)
def test_what_cannot_be_struck_is_refused(scene: Scene, change: dict[str, object], said: str) -> None:
    asked = replace(scene, **change) if change else ws.load(PROFILE)  # type: ignore[arg-type]
    with pytest.raises(SceneError, match=said):
        unstruck(asked, 0.5)


SET = [text for key, value in HEAVY for text in ("--set", f"{key}={json.dumps(value)}")]


def test_the_command_prints_one_object_or_a_line_for_each_question(capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["shock", PROFILE, *SET, "--direction", "0°", "--phase", "0.25", "--after", "1 s"]
    assert main([*asked, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["jewel_ok"] is True and printed["guard_blows"] > 0 and printed["speed_m_s"] == 4.43
    assert main(asked) == 0
    text = capsys.readouterr().out
    assert all(word in text for word in ("roller jewel", "guard pin", "ticks as before", "ms lost", "verdict"))


def test_faults_of_the_options_are_reported_together(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["shock", PROFILE, "--speed", "0 m/s", "--phase", "1"]) == 2
    said = capsys.readouterr().err
    assert "--speed: must be above zero" in said and "--phase 1" in said
    assert main(["shock", PROFILE, "--direction", "3 mm"]) == 2


def test_lateness_is_that_of_the_passages(scene: Scene) -> None:
    beside = unstruck(scene, 1.0)
    found, run = struck(beside, 0.0, 4.43, 0.25)
    passed = ws.beats(run).t
    same = np.searchsorted(beside.found.t, passed[-1] - 0.05)
    assert found.lost_s == pytest.approx(float(passed[-1] - beside.found.t[same]), abs=1e-12)
