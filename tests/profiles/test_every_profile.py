"""Does every profile keep what it promises, run for five minutes, and close its energy account to 1e-9?"""

from pathlib import Path

import pytest

import watchsim as ws

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
