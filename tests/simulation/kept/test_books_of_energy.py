"""Does the ledger of a run close, and by how much may it miss? Worked by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.simulation.energy_ledger import ledger, ledger_fails, usual_energy

FIELDS = ("force", "stiffness", "mass", "scale", "rate", "driven")


def model(*rows: tuple[float, ...]) -> Any:
    """Coordinates with these fields."""
    table = np.array(rows).reshape(-1, len(FIELDS))
    return SimpleNamespace(coordinates=np.rec.fromarrays(table.T, names=",".join(FIELDS)))


NOTHING = model((0.0, 0.0, 1.0, 1.0, 1.0, 0.0))


def test_what_comes_in_is_stored_or_lost_but_for_the_residual() -> None:
    made = ledger(10.0, {"friction": 1.5, "damping": 2.5}, (3.0, 8.5), NOTHING)
    assert (made["in_J"], made["stored_J"], made["dissipated"]) == (10.0, 5.5, {"friction": 1.5, "damping": 2.5})
    assert made["residual_J"] == pytest.approx(0.5)
    assert made["residual_relative"] == pytest.approx(0.5 / 10.0)


@pytest.mark.parametrize(("drive", "lost", "stored", "scale"), [
    (-20.0, 3.0, (3.0, 8.5), 20.0),  # what comes in
    (2.0, 13.0, (3.0, 8.5), 13.0),  # what is lost
    (2.0, 3.0, (-30.0, 8.5), 38.5),  # what more is stored
    (2.0, 3.0, (8.0, -12.0), 20.0),  # or less
    (2.0, 3.0, (7.0, 8.5), 8.5),  # what is held at the end
    (2.0, 3.0, (9.5, 8.5), 9.5),  # or at the start
])  # fmt: skip
def test_the_residual_is_seen_against_the_largest_of_all(
    drive: float, lost: float, stored: tuple[float, float], scale: float
) -> None:
    made = ledger(drive, {"friction": lost}, stored, NOTHING)
    residual = drive - (stored[1] - stored[0]) - lost
    assert made["residual_J"] == pytest.approx(residual) and made["residual_relative"] == pytest.approx(abs(residual) / scale)


def test_a_swing_under_a_constant_force_turns_over_its_energy() -> None:
    """From rest at rest of the spring it goes to 2 f/k and back: 2 f²/k; without a spring or driven it counts nothing."""
    swinging = model(
        (0.6, 4.0, 1.0, 1.0, 1.0, 0.0), (0.3, 0.2, 1.0, 1.0, 1.0, 0.0),
        (90.0, 0.0, 1.0, 1.0, 1.0, 0.0), (90.0, 2.0, 1.0, 1.0, 1.0, 1.0),
    )  # fmt: skip
    made = ledger(1e-3, {"friction": 0.0}, (0.0, 0.0), swinging)
    assert made["residual_relative"] == pytest.approx(1e-3 / (2.0 * 0.09 / 0.2))
    assert ledger(0.0, {"friction": 0.0}, (0.0, 0.0), NOTHING)["residual_relative"] == 0.0
    assert ledger(1e-12, {}, (0.0, 0.0), model())["residual_relative"] == 1.0


def test_the_usual_energy_is_that_of_usual_speeds() -> None:
    """Of what is not driven."""
    moving = model((0.0, 0.0, 3.0, 0.5, 4.0, 0.0), (0.0, 0.0, 0.25, 2.0, 5.0, 0.0), (0.0, 0.0, 9.0, 9.0, 9.0, 1.0))
    assert usual_energy(moving) == pytest.approx(0.5 * (3.0 * 4.0 + 0.25 * 100.0))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("share", [0.9, 1.1])
@pytest.mark.parametrize(("tolerance", "allowed"), [(1e-9, 1e-6), (1e-10, 1e-6), (1e-8, 1e-5)])
def test_a_ledger_fails_by_more_than_a_millionth_of_what_is_turned_over(
    tolerance: float, allowed: float, share: float, sign: float
) -> None:
    """Or a thousand tolerances: of what was ever in motion, came in, is stored and lost."""
    turned = 5.0 + 7.0 + 3.0 + 1.5 + 2.5
    energy = {
        "in_J": sign * 7.0, "stored_J": -sign * 3.0, "dissipated": {"friction": 1.5, "damping": 2.5},
        "residual_J": sign * share * allowed * turned,
    }  # fmt: skip
    assert ledger_fails(energy, 5.0, tolerance) == (share > 1.0)
