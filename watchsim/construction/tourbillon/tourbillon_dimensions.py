"""Which numbers does the designer of a tourbillon choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim
from watchsim.construction.swiss_lever.swiss_lever_dimensions import ESTIMATE, SwissLever


@dataclass(frozen=True)
class Tourbillon(SwissLever):
    """Those of the Swiss lever, of its carriage, and of what gravity acts on."""

    ratio: int = dim(16, "", 4, 60, "teeth of the fixed fourth wheel by those of the escape pinion", "a turn in a minute")
    carriage_inertia: float = dim(20.0, "mg·cm²", 0.1, 1e5, "carriage without what it carries", ESTIMATE)
    carriage_mass: float = dim(150.0, "mg", 10.0, 1e5, "carriage without what it carries", ESTIMATE)
    wheel_mass: float = dim(4.0, "mg", 0.1, 1e4, "escape wheel with its pinion", ESTIMATE)
    lever_mass: float = dim(3.0, "mg", 0.1, 1e4, "lever", ESTIMATE)
    balance_mass: float = dim(50.0, "mg", 1.0, 1e5, "balance with roller and hairspring", ESTIMATE)
    poise_error: float = dim(
        5.0, "µm", 0.0, 1000.0, "of the balance's centre of mass, from its axis", "33 s/d between positions"
    )
    gravity: float = dim(9.81, "m/s²", 0.0, 20.0, "in the plane: the watch stands upright; 0: it lies flat", "mean on earth")
