"""Which contact forces, where the motion does not decide them?

With more contact forces than they can move coordinates (a jammed wedge, one rotor against the frame) the accelerations are
unique and the forces are not. Taken are the smallest in the sense of the sum of squares; where these would pull, leave the
friction cone or turn a bearing that dry friction holds, the smallest ones that do not. Small systems, singular or not, are
solved here without touching the heap.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.dynamics.lcp import LcpOutcome, LcpWork, lemke_checked
from watchsim.jit import by_reference, hot_kernel, kernel
from watchsim.tolerances import DEPENDENT, FORCE_ZERO, LAW_ROUNDING, LAW_SHARE, LAW_SLACK

Array = NDArray[np.float64]


class FreeForces(NamedTuple):
    """Forces that no motion decides, and the laws they must obey."""

    lcp: LcpWork
    free: Array  # sets of forces without effect, one a row
    weight: Array  # of each unknown in the sum of squares of the forces
    laws: Array  # what must not be negative, one a row: its factors by unknown
    constant: Array  # the constant part of each
    slack: Array  # what each may miss without a mode ending
    value: Array  # of each with the forces as they are
    gain: Array  # what each free direction does for each, one law a row
    gains: Array  # what the multiplier of one does for another
    multiplier: Array


FreeForcesRef = by_reference(FreeForces, __name__)


class ModeSystem(NamedTuple):
    """The equality system of one island's contacts in their decided modes; see `solve_mode`. SI."""

    redundant: FreeForces
    friction: Array  # (room,) friction coefficient of each contact
    drag: Array  # (room,) friction force per normal force of a sliding contact, against its slip; 0 of one that sticks
    unknown: NDArray[np.int64]  # (room,) place of a contact's friction force in x; -1 where it follows from the normal force
    A: Array  # what the unknown forces do to the accelerations of the gaps
    rhs: Array  # accelerations that they are to end
    x: Array  # the normal forces, then the friction forces of the contacts that stick
    scale: Array  # see `solve_small`
    order: NDArray[np.int64]


ModeSystemRef = by_reference(ModeSystem, __name__)


def mode_system(room: int, coordinates: int, lcp: LcpWork) -> ModeSystem:
    """For `room` closed contacts; `lcp` is room for its laws."""
    unknowns, laws = 2 * room, 3 * room + 2 * coordinates
    vectors = {"weight": unknowns, "constant": laws, "slack": laws, "value": laws, "multiplier": laws}
    tables = {"free": (unknowns, unknowns), "laws": (laws, unknowns), "gain": (laws, unknowns), "gains": (laws, laws)}
    own = {"friction": room, "drag": room, "A": (unknowns, unknowns), "rhs": unknowns, "x": unknowns, "scale": unknowns}
    return ModeSystem(
        FreeForces(lcp=lcp, **{name: np.zeros(shape) for name, shape in (tables | vectors).items()}),
        unknown=np.zeros(room, np.int64),
        order=np.zeros(unknowns, np.int64),
        **{name: np.zeros(shape) for name, shape in own.items()},
    )


@kernel
def unit_scale(own):
    """The scale that makes the diagonal entry `own` one; 1 for zero."""
    return 1.0 / math.sqrt(own) if own > 0.0 else 1.0


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


@kernel
def smallest_forces(model, closed, m, n, rank, lenience, system, modes):
    """Replace the solution `modes.x` of n unknowns, of a singular system just eliminated, by the smallest lawful one.

    `lenience`: see `_law_slack`.
    """
    redundant, x = modes.redundant, modes.x
    vectors, weight = redundant.free, redundant.weight
    null_vectors(modes.A, n, rank, modes.scale, modes.order, vectors)
    for j in range(n):
        weight[j] = 1.0
    for i in range(m):  # a sliding contact's friction grows with its normal force
        if modes.unknown[i] < 0:
            weight[i] += modes.drag[i] * modes.drag[i]
    count = _orthonormalize(vectors, n - rank, n, weight)
    for v in range(count):
        share = _product(vectors[v], x, n, weight)
        for j in range(n):
            x[j] -= share * vectors[v, j]
    laws = _fill_laws(model, closed, m, n, lenience, system, modes)
    _keep_laws(laws, n, count, redundant, x)


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
def _fill_laws(model, closed, m, n, lenience, system, modes):
    """What must not be negative, linear in the n unknowns, into `modes.redundant`; returns the number of laws.

    Normal forces, both sides of each cone, what is left of each held bearing on both sides (over its largest lever arm, a
    force, too).
    """
    laws, redundant = 0, modes.redundant
    for i in range(m):
        laws = _begin_law(redundant, n, laws, 0.0, _law_slack(system, i, lenience))
        redundant.laws[laws - 1, i] = 1.0
    for i in range(m):
        t = modes.unknown[i]
        for side in (-1.0, 1.0):
            if t >= 0:
                laws = _begin_law(redundant, n, laws, 0.0, _law_slack(system, i, lenience))
                redundant.laws[laws - 1, i], redundant.laws[laws - 1, t] = modes.friction[i], side
    for j in range(len(model.coordinates)):
        if system.inverse[j] == 0.0 and system.dry[j] > 0.0 and not model.coordinates[j].driven:
            laws = _hold_bearing(system.dry[j], closed, m, n, j, laws, lenience, system.h[j], modes)
    return laws


@kernel
def _law_slack(system, i, lenience):
    """Part of what the forces of contact i may miss before they end its mode: see `normal_margin` (simulation).

    Where laws leave less and less choice, there is an instant behind which they leave none. The mode ends there; without this
    slack it would end as abruptly again, if at that instant it can still be decided, and time could not go on.
    """
    normal = system.G[2 * i, 2 * i]
    return LAW_SHARE * lenience * FORCE_ZERO * system.size[2 * i] / normal if normal > 0.0 else 0.0


@kernel
def _begin_law(redundant, n, laws, constant, slack):
    """An empty law more; returns their number."""
    for column in range(n):
        redundant.laws[laws, column] = 0.0
    redundant.constant[laws], redundant.slack[laws] = constant, slack
    return laws + 1


@kernel
def _hold_bearing(dry, closed, m, n, j, laws, lenience, load, modes):
    """Laws for dry friction up to `dry` that holds coordinate j under `load`, if a contact acts on it; see `_fill_laws`."""
    redundant = modes.redundant
    _begin_law(redundant, n, laws, dry + load, 0.0)
    row, largest = redundant.laws[laws], 0.0
    for i in range(m):
        for k in range(closed.slots[i]):
            if closed.coord[i, k] == j:
                row[i] = closed.w_N[i, k]
                if modes.unknown[i] >= 0:
                    row[modes.unknown[i]] = closed.w_T[i, k]
                else:
                    row[i] -= modes.drag[i] * closed.w_T[i, k]
    for column in range(n):
        largest = max(largest, abs(row[column]))
    if largest == 0.0:
        return laws
    slack = LAW_SHARE * lenience * FORCE_ZERO * abs(load) / largest
    _begin_law(redundant, n, laws + 1, (dry - load) / largest, slack)
    redundant.constant[laws], redundant.slack[laws] = (dry + load) / largest, slack
    for column in range(n):
        row[column] /= largest
        redundant.laws[laws + 1, column] = -row[column]
    return laws + 2


@kernel
def _law(law, n, values):
    """What must not be negative, but for its constant part."""
    total = 0.0
    for j in range(n):
        total += law[j] * values[j]
    return total


@kernel
def _gain(law, n, vector):
    """What a free direction does for a law; none where it runs along the law's edge, or forces without bound would be taken."""
    gain = _law(law, n, vector)
    return gain if abs(gain) > LAW_ROUNDING else 0.0


@kernel
def _keep_laws(laws, n, count, redundant, out_x):
    """The smallest change along the free directions that fulfils all laws: the dual problem, positive semidefinite."""
    vectors, value, multiplier, law = redundant.free, redundant.value, redundant.multiplier, redundant.laws
    gain, gains = redundant.gain, redundant.gains
    largest, worst = 0.0, 0.0
    for j in range(n):
        largest = max(largest, abs(out_x[j]))
    for line in range(laws):
        value[line] = redundant.constant[line] + _law(law[line], n, out_x)
        worst = min(worst, value[line])
    if worst >= -LAW_SLACK * largest:
        return
    for line in range(laws):
        if value[line] >= -LAW_SLACK * largest:
            value[line] = max(value[line], 0.0)
        for v in range(count):
            gain[line, v] = _gain(law[line], n, vectors[v])
    for line in range(laws):
        for other in range(line + 1):
            total = 0.0
            for v in range(count):
                total += gain[line, v] * gain[other, v]
            gains[line, other], gains[other, line] = total, total
    if lemke_checked(gains, value, laws, redundant.lcp, multiplier) != LcpOutcome.SOLVED:
        for line in range(laws):
            value[line] += redundant.slack[line]
        if lemke_checked(gains, value, laws, redundant.lcp, multiplier) != LcpOutcome.SOLVED:
            return  # no forces obey the laws: the mode has ended, and its monitors say so
    for v in range(count):
        share = 0.0
        for line in range(laws):
            share += gain[line, v] * multiplier[line]
        for j in range(n):
            out_x[j] += share * vectors[v, j]
