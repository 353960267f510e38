"""How is a small, possibly singular system solved without touching the heap?"""

from __future__ import annotations

from watchsim.jit import kernel

RANK = 1e-11  # pivots below this share of the first one count as zero: the contact forces are then not unique


@kernel
def _largest(A, k, n):
    """Row and column of the largest entry of A[k:n, k:n]."""
    row, column, best = k, k, -1.0
    for i in range(k, n):
        for j in range(k, n):
            if abs(A[i, j]) > best:
                row, column, best = i, j, abs(A[i, j])
    return row, column, best


@kernel
def solve_small(A, b, n, order, out_x):
    """Solve A x = b (leading n × n block, both overwritten) by complete pivoting; returns the rank.

    Beyond the rank the unknowns are 0: one solution of a consistent singular system. `order` is scratch for n integers.
    """
    for j in range(n):
        order[j] = j
    rank, first = n, 0.0
    for k in range(n):
        row, column, best = _largest(A, k, n)
        if k == 0:
            first = best
        if best <= RANK * first:
            rank = k
            break
        if row != k:
            for j in range(n):
                A[k, j], A[row, j] = A[row, j], A[k, j]
            b[k], b[row] = b[row], b[k]
        if column != k:
            for i in range(n):
                A[i, k], A[i, column] = A[i, column], A[i, k]
            order[k], order[column] = order[column], order[k]
        for i in range(k + 1, n):
            factor = A[i, k] / A[k, k]
            if factor != 0.0:
                for j in range(k + 1, n):
                    A[i, j] -= factor * A[k, j]
                b[i] -= factor * b[k]
    for k in range(n):
        out_x[k] = 0.0
    for k in range(rank - 1, -1, -1):
        total = b[k]
        for j in range(k + 1, rank):
            total -= A[k, j] * out_x[order[j]]
        out_x[order[k]] = total / A[k, k]
    return rank
