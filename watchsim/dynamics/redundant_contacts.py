"""Which contact forces, where the motion does not decide them?

With more contact forces than they can move coordinates (a jammed wedge, one rotor against the frame) the accelerations are
unique and the forces are not. Taken are the smallest in the sense of the sum of squares; where these would pull or leave the
friction cone, the smallest ones that do not.
"""

from __future__ import annotations

from watchsim.dynamics.lcp.lemke_pivoting import lemke_checked
from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.small_systems import null_vectors
from watchsim.jit import kernel
from watchsim.tolerances import DEPENDENT, LAW_ROUNDING, LAW_SLACK


@kernel
def smallest_forces(m, n, rank, work):
    """Replace the solution `work.x` of a singular mode system (just eliminated in `work.A`) by the smallest one.

    The first m unknowns are normal forces; `work.tangent` says which unknown is a contact's friction force, `work.drag` the
    friction of the others, `work.width` the friction coefficients.
    """
    vectors = work.free
    count = n - rank
    null_vectors(work.A, n, rank, work.scale, work.order, vectors)
    _weigh(m, n, work)
    count = _orthonormalize(vectors, count, n, work.weight)
    for v in range(count):
        share = _product(vectors[v], work.x, n, work.weight)
        for j in range(n):
            work.x[j] -= share * vectors[v, j]
    _keep_laws(m, n, count, work)


@kernel
def _weigh(m, n, work):
    """Weights of the unknowns in the sum of squares of all forces: a sliding contact's friction grows with its normal force."""
    for j in range(n):
        work.weight[j] = 1.0
    for i in range(m):
        if work.tangent[i] < 0:
            work.weight[i] += work.drag[i] * work.drag[i]


@kernel
def _product(a, b, n, weight):
    total = 0.0
    for j in range(n):
        total += weight[j] * a[j] * b[j]
    return total


@kernel
def _orthonormalize(vectors, count, n, weight):
    """Gram and Schmidt, twice; returns how many vectors are left."""
    kept = 0
    for v in range(count):
        before = _product(vectors[v], vectors[v], n, weight)
        for _ in range(2):
            for w in range(kept):
                share = _product(vectors[v], vectors[w], n, weight)
                for j in range(n):
                    vectors[v, j] -= share * vectors[w, j]
        square = _product(vectors[v], vectors[v], n, weight)
        if square > DEPENDENT * before:
            for j in range(n):
                vectors[kept, j] = vectors[v, j] / square**0.5
            kept += 1
    return kept


@kernel
def _law(work, m, line, values):
    """Number `line` of what must not be negative, linear in `values`: normal forces, then both sides of each cone."""
    if line < m:
        return values[line]
    seen = m
    for i in range(m):
        t = work.tangent[i]
        if t >= 0:
            if seen == line:
                return work.width[i] * values[i] - values[t]
            if seen + 1 == line:
                return work.width[i] * values[i] + values[t]
            seen += 2
    return 0.0


@kernel
def _gain(work, m, line, vector):
    """What a free direction does for a law; none where it runs along the law's edge, or forces without bound would be taken."""
    gain = _law(work, m, line, vector)
    return gain if abs(gain) > LAW_ROUNDING else 0.0


@kernel
def _keep_laws(m, n, count, work):
    """The smallest change along the free directions that fulfils all laws: the dual problem, positive semidefinite."""
    vectors, largest, worst = work.free, 0.0, 0.0
    laws = m + 2 * (n - m)
    for j in range(n):
        largest = max(largest, abs(work.x[j]))
    for line in range(laws):
        work.rhs[line] = _law(work, m, line, work.x)
        worst = min(worst, work.rhs[line])
    if worst >= -LAW_SLACK * largest:
        return
    for line in range(laws):
        if work.rhs[line] >= -LAW_SLACK * largest:
            work.rhs[line] = max(work.rhs[line], 0.0)
        for other in range(laws):
            total = 0.0
            for v in range(count):
                total += _gain(work, m, line, vectors[v]) * _gain(work, m, other, vectors[v])
            work.A[line, other] = total
    if lemke_checked(work.A, work.rhs, laws, work.lcp, work.dual) != LcpOutcome.SOLVED:
        return  # no forces obey the laws: the mode has ended, and its monitors say so
    for v in range(count):
        share = 0.0
        for line in range(laws):
            share += _gain(work, m, line, vectors[v]) * work.dual[line]
        for j in range(n):
            work.x[j] += share * vectors[v, j]
