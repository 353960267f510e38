"""In which unit are energies of that size told: those of a watch in nJ, those of a clock in µJ or mJ?"""

from __future__ import annotations

UNITS = ((1e9, "nJ"), (1e6, "µJ"), (1e3, "mJ"), (1.0, "J"))
MOST = 1e4  # in that unit


def energy_unit(largest: float) -> tuple[float, str]:
    """How many to the joule, and the unit's name, such that `largest` (J) has at most four digits before its point."""
    return next((one for one in UNITS if abs(largest) * one[0] < MOST), UNITS[-1])
