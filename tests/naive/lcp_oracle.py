"""Which x solve y = A x + b, y, x >= 0, y.x = 0? All complementary bases, one after the other, with numpy."""

from __future__ import annotations

import itertools

import numpy as np


def solutions(A: np.ndarray, b: np.ndarray, tolerance: float = 1e-9) -> list[np.ndarray]:
    """The x of every regular complementary basis that is feasible; empty when there is none."""
    n = len(b)
    found = []
    for chosen in itertools.product((False, True), repeat=n):
        active = np.array(chosen, dtype=bool)
        x = np.zeros(n)
        if active.any():
            block = A[np.ix_(active, active)]
            if np.linalg.matrix_rank(block) < active.sum():
                continue
            x[active] = np.linalg.solve(block, -b[active])
        if residual(A, b, x) <= tolerance:
            found.append(x)
    return found


def residual(A: np.ndarray, b: np.ndarray, x: np.ndarray) -> float:
    """Largest |min(x, y)|, relative to the largest number that occurs; for problems whose coefficients are of order one."""
    y = A @ x + b
    if not np.all(np.isfinite(x)):
        return float("inf")
    return float(np.max(np.abs(np.minimum(x, y)), initial=0.0) / max(1.0, np.abs(x).max(initial=0.0), np.abs(b).max(initial=0.0)))
