"""Where did the energy go?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.analysis.weights_fallen import work_of_gravity
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.tolerances import LEDGER_SHARE


@dataclass(frozen=True, slots=True)
class Shares:
    """Energy supplied (J) by the drive and by what ran down, springs, weights and motion, and what share went where; they
    sum to 1. What `ran_down` gave is part of `supplied`."""

    supplied: float
    went_to: dict[str, float]
    ran_down: float = 0.0


def energy_shares(run: Trajectory) -> Shares:
    """The ledger of a run as shares; empty where nothing was put in.

    The ledger has the work of gravity among what is put in; here a weight stores what it can give by falling.
    """
    ledger, fallen = run.energy, work_of_gravity(run)
    drive, stored = float(ledger.get("in_J", 0.0)) - fallen, float(ledger.get("stored_J", 0.0)) - fallen
    if abs(drive) < LEDGER_SHARE * abs(fallen):
        drive = 0.0  # but for the rounding of a fall
    supplied = max(drive, 0.0) + max(-stored, 0.0)
    if not supplied > 0.0:
        return Shares(0.0, {})
    went = {cause: float(value) for cause, value in ledger.get("dissipated", {}).items()}
    went["stored"], went["given back to the drive"] = max(stored, 0.0), max(-drive, 0.0)
    return Shares(supplied, {cause: value / supplied for cause, value in went.items() if value != 0.0}, max(-stored, 0.0))
