"""Which contact forces, where the motion does not decide them?

With more contact forces than they can move coordinates (a jammed wedge, one rotor against the frame) the accelerations are
unique and the forces are not. Taken are the smallest in the sense of the sum of squares; where these would pull, leave the
friction cone or turn a bearing that dry friction holds, the smallest ones that do not.
"""

from __future__ import annotations

from watchsim.dynamics.lcp.lemke_pivoting import lemke_checked
from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.small_systems import null_vectors
from watchsim.jit import kernel
from watchsim.tolerances import DEPENDENT, FORCE_ZERO, LAW_ROUNDING, LAW_SHARE, LAW_SLACK


@kernel
def smallest_forces(model, closed, m, n, rank, lenience, work):
    """Replace the solution `work.x` of a singular mode system (just eliminated in `work.A`) by the smallest one.

    The first m unknowns are normal forces; `work.tangent` says which unknown is a contact's friction force, `work.drag` the
    friction of the others, `work.width` the friction coefficients. `lenience`: see `_slack`.
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
    _keep_laws(_fill_laws(model, closed, m, n, lenience, work), n, count, work)


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
def _fill_laws(model, closed, m, n, lenience, work):
    """What must not be negative, linear in the unknowns: one row of `work.B` each; returns the number of rows.

    Constant parts are in `work.other_rhs`, what may be missed without a mode ending in `work.other_x`. Rows: normal forces,
    both sides of each cone, what is left of each held bearing on both sides (over its largest lever arm, a force, too).
    """
    laws = 0
    for i in range(m):
        laws = _begin_law(work, n, laws, 0.0, _slack(work, i, lenience))
        work.B[laws - 1, i] = 1.0
    for i in range(m):
        t = work.tangent[i]
        for side in (-1.0, 1.0):
            if t >= 0:
                laws = _begin_law(work, n, laws, 0.0, _slack(work, i, lenience))
                work.B[laws - 1, i], work.B[laws - 1, t] = work.width[i], side
    for j in range(len(model.coordinates)):
        if work.inverse[j] == 0.0 and model.coordinates[j].coulomb > 0.0 and not model.coordinates[j].driven:
            laws = _hold_bearing(model, closed, m, n, j, laws, lenience, work)
    return laws


@kernel
def _slack(work, i, lenience):
    """Part of what the forces of contact i may miss before they end its mode: see `press_left` in motion/coupled_motion.py.

    Where laws leave less and less choice, there is an instant behind which they leave none. The mode ends there; without this
    slack it would end as abruptly again, if at that instant it can still be decided, and time could not go on.
    """
    normal = work.G[2 * i, 2 * i]
    return LAW_SHARE * lenience * FORCE_ZERO * work.size[2 * i] / normal if normal > 0.0 else 0.0


@kernel
def _begin_law(work, n, laws, constant, slack):
    """An empty row more; returns their number."""
    for column in range(n):
        work.B[laws, column] = 0.0
    work.other_rhs[laws], work.other_x[laws] = constant, slack
    return laws + 1


@kernel
def _hold_bearing(model, closed, m, n, j, laws, lenience, work):
    """Rows for the dry friction that holds coordinate j, if a contact acts on it; returns the number of rows."""
    dry, load = model.coordinates[j].coulomb, work.h[j]
    _begin_law(work, n, laws, dry + load, 0.0)
    row, largest = work.B[laws], 0.0
    for i in range(m):
        for k in range(closed.slots[i]):
            if closed.coord[i, k] == j:
                row[i] = closed.w_N[i, k]
                if work.tangent[i] >= 0:
                    row[work.tangent[i]] = closed.w_T[i, k]
                else:
                    row[i] -= work.drag[i] * closed.w_T[i, k]
    for column in range(n):
        largest = max(largest, abs(row[column]))
    if largest == 0.0:
        return laws
    slack = LAW_SHARE * lenience * FORCE_ZERO * abs(load) / largest
    _begin_law(work, n, laws + 1, (dry - load) / largest, slack)
    work.other_rhs[laws], work.other_x[laws] = (dry + load) / largest, slack
    for column in range(n):
        row[column] /= largest
        work.B[laws + 1, column] = -row[column]
    return laws + 2


@kernel
def _law(work, n, line, values):
    """Number `line` of what must not be negative, but for its constant part."""
    total = 0.0
    for j in range(n):
        total += work.B[line, j] * values[j]
    return total


@kernel
def _gain(work, n, line, vector):
    """What a free direction does for a law; none where it runs along the law's edge, or forces without bound would be taken."""
    gain = _law(work, n, line, vector)
    return gain if abs(gain) > LAW_ROUNDING else 0.0


@kernel
def _keep_laws(laws, n, count, work):
    """The smallest change along the free directions that fulfils all laws: the dual problem, positive semidefinite."""
    vectors, largest, worst = work.free, 0.0, 0.0
    for j in range(n):
        largest = max(largest, abs(work.x[j]))
    for line in range(laws):
        work.rhs[line] = work.other_rhs[line] + _law(work, n, line, work.x)
        worst = min(worst, work.rhs[line])
    if worst >= -LAW_SLACK * largest:
        return
    for line in range(laws):
        if work.rhs[line] >= -LAW_SLACK * largest:
            work.rhs[line] = max(work.rhs[line], 0.0)
        for other in range(laws):
            total = 0.0
            for v in range(count):
                total += _gain(work, n, line, vectors[v]) * _gain(work, n, other, vectors[v])
            work.A[line, other] = total
    if lemke_checked(work.A, work.rhs, laws, work.lcp, work.dual) != LcpOutcome.SOLVED:
        for line in range(laws):
            work.rhs[line] += work.other_x[line]
        if lemke_checked(work.A, work.rhs, laws, work.lcp, work.dual) != LcpOutcome.SOLVED:
            return  # no forces obey the laws: the mode has ended, and its monitors say so
    for v in range(count):
        share = 0.0
        for line in range(laws):
            share += _gain(work, n, line, vectors[v]) * work.dual[line]
        for j in range(n):
            work.x[j] += share * vectors[v, j]
