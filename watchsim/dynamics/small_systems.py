"""How are arrays copied, and small, possibly singular systems solved, without touching the heap?"""

from __future__ import annotations

from watchsim.jit import hot_kernel, kernel


@kernel
def copy(values, out):
    """Copy an array into another one: an assignment of slices would allocate, lest they overlap."""
    for i in range(len(out)):
        out[i] = values[i]


@kernel
def unit_scale(own):
    """The scale that makes the diagonal entry `own` one; 1 for zero."""
    return 1.0 / own**0.5 if own > 0.0 else 1.0


@kernel
def _largest(A, k, n):
    """Row and column of the largest entry of A[k:n, k:n]."""
    row, column, best = k, k, -1.0
    for i in range(k, n):
        for j in range(k, n):
            if abs(A[i, j]) > best:
                row, column, best = i, j, abs(A[i, j])
    return row, column, best


@hot_kernel
def solve_small(A, b, n, scale, order, out_x, smallest):
    """Solve A x = b (leading n × n block, both overwritten) by complete pivoting; returns the rank.

    `scale` (n,) makes the diagonal of scale_i A_ij scale_j one where it can; pivots below `smallest` of the first one count
    as zero. Beyond the rank the unknowns are 0: one solution of a consistent singular system. `order` gets the unknown of
    each column of the triangle left in A.
    """
    for i in range(n):
        order[i] = i
        b[i] *= scale[i]
        for j in range(n):
            A[i, j] *= scale[i] * scale[j]
    rank, first = n, 0.0
    for k in range(n):
        row, column, best = _largest(A, k, n)
        if k == 0:
            first = best
        if best <= smallest * first:
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
    for k in range(n):
        out_x[k] *= scale[k]
    return rank


@kernel
def null_vectors(A, n, rank, scale, order, out_rows):
    """After `solve_small`: what may be added to x, one vector in each of the first n - rank rows of `out_rows`."""
    for v in range(n - rank):
        row = out_rows[v]
        for j in range(n):
            row[j] = 0.0
        row[order[rank + v]] = 1.0
        for k in range(rank - 1, -1, -1):
            total = -A[k, rank + v]
            for j in range(k + 1, rank):
                total -= A[k, j] * row[order[j]]
            row[order[k]] = total / A[k, k]
        for j in range(n):
            row[j] *= scale[j]


@kernel
def keep_independent(A, n, smallest, out_list):
    """Of the first n entries of a list keep those that do not depend on earlier ones; returns how many.

    A (leading n × n block, overwritten) holds the products of what they stand for, each with each, ones on its diagonal; what
    is left of one without the earlier ones counts as zero up to `smallest`.
    """
    kept = 0
    for k in range(n):
        if A[k, k] <= smallest:
            continue
        for i in range(k + 1, n):
            factor = A[i, k] / A[k, k]
            for j in range(k + 1, n):
                A[i, j] -= factor * A[k, j]
        out_list[kept] = out_list[k]
        kept += 1
    return kept
