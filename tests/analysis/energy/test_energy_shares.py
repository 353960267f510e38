"""Do the shares of what was put in sum to one, whatever ran down and wherever it went?"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

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


@pytest.mark.parametrize("ledger", [{}, {"in_J": 0.0, "stored_J": 1e-6}, {"in_J": -1e-6, "stored_J": 0.0}])
def test_of_nothing_there_are_no_shares(ledger: dict[str, Any]) -> None:
    found = energy_shares(replace(watch_run(), energy=ledger))
    assert found.supplied == 0.0 and found.went_to == {}


@pytest.mark.parametrize("ledger", [{"in_J": 2e-6}, {"stored_J": -2e-6}])
def test_what_the_ledger_does_not_name_is_nothing(ledger: dict[str, Any]) -> None:
    found = energy_shares(replace(watch_run(), energy=ledger))
    assert found.supplied == 2e-6 and found.went_to == {}
