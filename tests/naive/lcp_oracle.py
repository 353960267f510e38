"""Which x solve y = A x + b, y, x >= 0, y.x = 0? All complementary bases, one after the other, with numpy.

For problems whose coefficients are of order one: the tolerances are absolute there.
"""

import itertools

import numpy as np

SINGULAR = 1e-9  # blocks with a smaller determinant are passed over


def solutions(A: np.ndarray, b: np.ndarray, tolerance: float = 1e-9) -> list[np.ndarray]:
    """The x of every regular complementary basis that is feasible; empty when there is none."""
    n = len(b)
    found = []
    for chosen in itertools.product((False, True), repeat=n):
        active = np.array(chosen, dtype=bool)
        block = A[np.ix_(active, active)]
        if active.any() and abs(np.linalg.det(block)) < SINGULAR:
            continue
        x = np.zeros(n)
        x[active] = np.linalg.solve(block, -b[active])
        if residual(A, b, x) <= tolerance:
            found.append(x)
    return found


def residual(A: np.ndarray, b: np.ndarray, x: np.ndarray) -> float:
    """Largest |min(x, y)| over the largest number of the problem; inf when x is not finite."""
    if not np.all(np.isfinite(x)):
        return float("inf")
    wrong = np.abs(np.minimum(x, A @ x + b)).max(initial=0.0)
    return float(wrong / max(1.0, np.abs(x).max(initial=0.0), np.abs(b).max(initial=0.0)))
