"""Where did the energy go?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.simulation.record.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class Shares:
    """Energy put in (J) by the drive and by springs and weights that ran down, and what share went where; they sum to 1."""

    supplied: float
    went_to: dict[str, float]


def energy_shares(run: Trajectory) -> Shares:
    """The ledger of a run as shares; empty where nothing was put in."""
    ledger = run.energy
    drive, stored = float(ledger.get("in_J", 0.0)), float(ledger.get("stored_J", 0.0))
    supplied = max(drive, 0.0) + max(-stored, 0.0)
    if not supplied > 0.0:
        return Shares(0.0, {})
    went = {cause: float(value) for cause, value in ledger.get("dissipated", {}).items()}
    went["stored"], went["given back to the drive"] = max(stored, 0.0), max(-drive, 0.0)
    return Shares(supplied, {cause: value / supplied for cause, value in went.items() if value != 0.0})
