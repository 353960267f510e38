"""Do the shares of what was put in sum to one, whatever ran down and wherever it went?"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from render.fake_runs import watch_run

from watchsim.analysis.energy import energy_shares

LOST = {"friction": 3e-6, "impacts": 1e-6, "damping": 0.0}


@pytest.mark.parametrize(
    ("drive", "stored", "lost", "supplied", "others"),
    [
        (6e-6, 2e-6, LOST, 6e-6, {"stored": 2e-6}),
        (1e-6, -3e-6, LOST, 4e-6, {}),
        (-2e-6, -6e-6, LOST, 6e-6, {"given back to the drive": 2e-6}),
        (4e-6, 0.0, LOST, 4e-6, {}),
    ],
)
def test_what_is_put_in_goes_somewhere(
    drive: float, stored: float, lost: dict[str, float], supplied: float, others: dict[str, float]
) -> None:
    ledger = {"in_J": drive, "stored_J": stored, "dissipated": lost}
    found = energy_shares(replace(watch_run(), energy=ledger))
    assert found.supplied == pytest.approx(supplied, rel=1e-15)
    expected = {name: joules / supplied for name, joules in (lost | others).items() if joules}
    assert found.went_to == pytest.approx(expected, rel=1e-14)
    assert sum(found.went_to.values()) == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize(("drive", "ran_down"), [(0.0, 7e-6), (3e-6, 4e-6)])
def test_a_weight_stores_what_it_can_give_by_falling(drive: float, ran_down: float) -> None:
    """A wheel of 10 g with its centre 4 mm beside its pivot falls from the level: 0.4 mJ. The ledger has that in both sums."""
    run, fallen = watch_run(), 0.01 * 10.0 * 4e-3
    wheel = replace(run.scene.bodies[0], mass=0.01, centre_of_mass=(4e-3, 0.0))
    run = replace(run, scene=replace(run.scene, bodies=(wheel, *run.scene.bodies[1:]), gravity=(0.0, -10.0)))
    run = replace(run, end_q=np.array([-0.5 * np.pi, 0.0, 0.0]), end_u=np.zeros(3))
    lost = {"damping": drive + ran_down}
    ledger = {"in_J": fallen + drive, "stored_J": fallen - ran_down, "dissipated": lost}
    found = energy_shares(replace(run, energy=ledger))
    assert found.supplied == pytest.approx(drive + ran_down, rel=1e-9) and found.ran_down == pytest.approx(ran_down, rel=1e-9)
    assert found.went_to == {"damping": pytest.approx(1.0, rel=1e-9)}


@pytest.mark.parametrize("ledger", [{}, {"in_J": 0.0, "stored_J": 1e-6}, {"in_J": -1e-6, "stored_J": 0.0}])
def test_of_nothing_there_are_no_shares(ledger: dict[str, Any]) -> None:
    found = energy_shares(replace(watch_run(), energy=ledger))
    assert found.supplied == 0.0 and found.went_to == {}


@pytest.mark.parametrize("ledger", [{"in_J": 2e-6}, {"stored_J": -2e-6}])
def test_what_the_ledger_does_not_name_is_nothing(ledger: dict[str, Any]) -> None:
    found = energy_shares(replace(watch_run(), energy=ledger))
    assert found.supplied == 2e-6 and found.went_to == {}
