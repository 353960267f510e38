"""Which percussions keep the contacts apart and the friction within its bounds? Found by relaxation, one after another.

Each percussion is the projection of its own improvement onto what it may be. This is the prox form of the laws of Signorini
and Coulomb, Gauss-Seidel fashion. It shares no code with the complementarity solver of `dynamics`, so that the two can be
held against each other.
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.simulation.moreau.percussion_laws import improved, size
from watchsim.simulation.moreau.projected_newton import finish
from watchsim.tolerances import SETTLED

SWEEPS = 20000  # at each pace
FIRST = 32  # sweeps before Newton's method is tried; again after twice as many
PACES = 4


# Largest change of a percussion in a sweep, as a share of the largest one or of what would stop the fastest contact.
@kernel
def _sweep(laws, m, rows, pace):
    """Each percussion once; returns the largest change that a full pace would make."""
    change = 0.0
    for row in range(rows):
        own = laws.G[row, row]
        if own > 0.0:
            step = improved(laws, m, rows, row, laws.P) - laws.P[row]
            change = max(change, abs(step) * own**0.5)
            laws.P[row] += pace * step
    return change


@kernel
def relax(laws, m, bearings):
    """Percussions that obey the laws of m contacts and of the bearings, from the first guess in `laws.P`.

    Returns (number of sweeps, have they settled?). Where friction couples contacts strongly, full improvements can go round
    in circles; smaller ones then settle.
    """
    rows, total, pace = 2 * m + bearings, 0, 1.0
    for _ in range(PACES):
        patience = FIRST
        for sweep in range(1, SWEEPS + 1):
            total += 1
            if _sweep(laws, m, rows, pace) <= SETTLED * size(laws, rows, laws.P):
                return total, True
            if sweep == patience:
                if finish(laws, m, rows, SETTLED):
                    return total, True
                patience *= 2
        pace *= 0.4
    return total, False
