"""How did a method for linear complementarity problems end?"""

from __future__ import annotations

from enum import IntEnum


class LcpOutcome(IntEnum):
    """Only SOLVED comes with a solution."""

    SOLVED = 0  # checked against the problem, to rounding
    RAY = 1  # Lemke's path runs to infinity, or no set of active unknowns solves the problem
    TOO_MANY_PIVOTS = 2
    INEXACT = 3  # what it ended with misses the conditions by more than rounding
