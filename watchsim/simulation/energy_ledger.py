"""Where did the energy of a run go, and does its ledger close?"""

from __future__ import annotations

from typing import Any

import numpy as np

from watchsim.model.records import Model
from watchsim.tolerances import LEDGER_PER_TOLERANCE, LEDGER_SHARE


def ledger(drive: float, dissipated: dict[str, float], stored: tuple[float, float], model: Model) -> dict[str, Any]:
    """Work in = stored + dissipated + residual, J; `stored` at the start and at the end."""
    at_start, at_end = stored
    more, lost = at_end - at_start, sum(dissipated.values())
    residual = drive - more - lost
    # A swing that loses nothing gets nothing and stores nothing more: what it turns over is the scale of its rounding.
    scale = max(abs(drive), abs(more), lost, at_end, at_start, _turned_over(model))
    return {
        "in_J": drive,
        "dissipated": dissipated,
        "stored_J": float(more),
        "residual_J": float(residual),
        "residual_relative": float(abs(residual) / scale) if scale else 0.0,
    }


def _turned_over(model: Model) -> float:
    """What constant forces give to springs and take back in each swing, J."""
    coordinates = model.coordinates
    sprung = coordinates[(coordinates.stiffness > 0.0) & (coordinates.driven == 0)]
    return float(np.max(2.0 * sprung.force**2 / sprung.stiffness, initial=0.0))


def usual_energy(model: Model) -> float:
    """Kinetic energy (J) below which motion is computed less closely: see the error control of integrator.py."""
    own = model.coordinates[model.coordinates.driven == 0]
    return float(0.5 * np.sum(own.mass * (own.scale * own.rate) ** 2))


def ledger_fails(energy: dict[str, Any], held: float, tolerance: float) -> bool:
    """True if the residual of the ledger is more than rounding; `held` (J): the most energy that was ever in the motion."""
    turned_over = held + abs(energy["in_J"]) + abs(energy["stored_J"]) + sum(energy["dissipated"].values())
    return bool(abs(energy["residual_J"]) > max(LEDGER_SHARE, LEDGER_PER_TOLERANCE * tolerance) * turned_over)
