"""Which contact forces, where the motion does not decide them?

With more contact forces than they can move coordinates (a jammed wedge, one rotor against the frame) the accelerations are
unique and the forces are not. Taken are the smallest in the sense of the sum of squares; where these would pull, leave the
friction cone or turn a bearing that dry friction holds, the smallest ones that do not.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import STICK
from watchsim.dynamics.lcp import LcpOutcome, LcpWork, Solver, lcp_work, lemke_checked
from watchsim.jit import by_reference, hot_kernel, kernel
from watchsim.model import blank
from watchsim.tolerances import DEPENDENT, FORCE_ZERO, LAW_ROUNDING, LAW_SHARE, LAW_SLACK

# How are arrays copied, and small, possibly singular systems solved, without touching the heap?


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


# How do contact forces and impulses act on the gaps?
#
# G = Wᵀ M⁻¹ W over the closed contacts, rows and columns ordered N, T of contact 0, N, T of contact 1, ...

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class LastProblem:
    """The last problem: what it was about, and how Lemke's method ended."""

    contacts: int
    elements: int
    bearings: int
    level: int  # a Level
    lemke: int  # an LcpOutcome


class ContactWork(NamedTuple):
    """Scratch of the contact problems, allocated once for `room` contacts and n coordinates.

    Rows of G: N, T of each of the m contacts, then one for each bearing that dry friction might hold. A block is such a contact
    or bearing. An element is a bounded force: the friction of one block.
    """

    lcp: LcpWork
    G: Array  # (rows, rows)
    b: Array  # (rows,) accelerations or velocities of the gaps without contact forces
    size: Array  # (rows,) the same with all terms taken positive: the scale of rounding
    worth: Array  # (room,) normal force that a contact's own terms make without those of others: the scale of its rounding
    force: Array  # (rows,) lambda or Lambda
    more: Array  # (rows,) impulses of the expansion
    rates: Array  # (rows,) velocities of the gaps at the start of the expansion, its least impulses included
    offset: Array  # (room,) tangential impulse whose slip moves the corner of the law pg1996
    loaded: Array  # (rows,) accelerations of the gaps without contact forces, bearings at the lower end of their friction
    correction: Array  # (rows,) impulses that take back drift (simulation/motion/drift_projection.py)
    inverse: Array  # (n,) 1/mass, 0 where dry friction holds the coordinate
    unit: Array  # (blocks,) scale that gives G a unit diagonal
    drag: Array  # (room,) friction per normal force at the lower end of the interval
    tangent: Integers  # (room,) element of the contact, -1: none
    block: Integers  # (blocks,) by element
    dry: Integers  # (n,) coordinate of each bearing that might hold
    width: Array  # (blocks,) length of an element's interval per normal force
    span: Array  # (blocks,) constant part of its length
    shift: Array  # (blocks,) constant part of its lower end
    hand: Array  # (rows,) -1 where a direction of friction is reversed, else 1
    A: Array  # the complementarity problem or the linear system in hand
    rhs: Array
    x: Array
    B: Array  # the same problem in its copositive form
    other_rhs: Array
    other_x: Array
    free: Array  # forces that no motion decides, one set a row (redundant_contacts.py)
    weight: Array  # of each unknown in the sum of squares of the forces
    dual: Array  # multipliers of the laws that such forces must obey
    scale: Array  # of a linear system, see `solve_small`
    order: Integers
    row: Integers  # (side,) of G, by row of a correction (simulation/motion/drift_projection.py)
    h: Array  # (n,)
    rungs: Integers  # problems solved since last asked, by Rung; the last one counts those without a solution
    sizes: Integers  # the same problems by their number of unknowns, see `LARGEST`
    posed: LastProblem


ContactWorkRef = by_reference(ContactWork, __name__)

LARGEST = (1, 2, 4, 8, 16)  # unknowns of the problems counted together; one more place for larger ones


def contact_work(room: int, coordinates: int) -> ContactWork:
    """Room for that many closed contacts."""
    rows, blocks = 2 * room + coordinates, room + coordinates
    side = room + 3 * blocks
    return ContactWork(
        G=np.zeros((rows, rows)),
        b=np.zeros(rows),
        size=np.zeros(rows),
        worth=np.zeros(room),
        force=np.zeros(rows),
        more=np.zeros(rows),
        rates=np.zeros(rows),
        offset=np.zeros(room),
        loaded=np.zeros(rows),
        correction=np.zeros(rows),
        inverse=np.zeros(coordinates),
        unit=np.zeros(blocks),
        drag=np.zeros(room),
        tangent=np.zeros(room, np.int64),
        block=np.zeros(blocks, np.int64),
        dry=np.zeros(coordinates, np.int64),
        width=np.zeros(blocks),
        span=np.zeros(blocks),
        shift=np.zeros(blocks),
        hand=np.ones(rows),
        A=np.zeros((side, side)),
        rhs=np.zeros(side),
        x=np.zeros(side),
        B=np.zeros((side, side)),
        other_rhs=np.zeros(side),
        other_x=np.zeros(side),
        free=np.zeros((side, side)),
        weight=np.zeros(side),
        dual=np.zeros(side),
        scale=np.zeros(side),
        order=np.zeros(side, np.int64),
        row=np.zeros(side, np.int64),
        lcp=lcp_work(side),
        h=np.zeros(coordinates),
        rungs=np.zeros(len(Solver), np.int64),
        sizes=np.zeros(len(LARGEST) + 1, np.int64),
        posed=blank(LastProblem),
    )


@kernel
def note_posed(work, m, elements, bearings, level):
    """Say what the problem now in `work` is about."""
    posed = work.posed
    posed.contacts, posed.elements, posed.bearings, posed.level = m, elements, bearings, level


@kernel
def size_class(n):
    """The place in `sizes` for a problem of n unknowns."""
    place = 0
    while place < len(LARGEST) and n > LARGEST[place]:
        place += 1
    return place


@kernel
def inverse_mass(coordinate):
    """1/mass towards contacts; 0 where the motion is prescribed, so that no force changes it."""
    return 0.0 if coordinate.driven else 1.0 / coordinate.mass


@kernel
def own_acceleration(model, work, j):
    """What the forces `work.h` alone give coordinate j; `h` of a prescribed motion is its acceleration."""
    return work.h[j] if model.coordinates[j].driven else work.h[j] * work.inverse[j]


@kernel
def fill_inverse(model, grip, out_inverse):
    """1/mass of each coordinate; 0 for those that `grip` says dry friction holds."""
    for i in range(len(model.coordinates)):
        out_inverse[i] = 0.0 if grip[i] == STICK else inverse_mass(model.coordinates[i])


@hot_kernel
def fill_delassus(closed, m, work):
    """G of the first m closed contacts."""
    for i in range(m):
        for j in range(i, m):
            nn, nt, tn, tt = 0.0, 0.0, 0.0, 0.0
            for k in range(closed.slots[i]):
                for q in range(closed.slots[j]):
                    if closed.coord[i, k] == closed.coord[j, q]:
                        inverse = work.inverse[closed.coord[i, k]]
                        nn += closed.w_N[i, k] * closed.w_N[j, q] * inverse
                        nt += closed.w_N[i, k] * closed.w_T[j, q] * inverse
                        tn += closed.w_T[i, k] * closed.w_N[j, q] * inverse
                        tt += closed.w_T[i, k] * closed.w_T[j, q] * inverse
            work.G[2 * i, 2 * j], work.G[2 * j, 2 * i] = nn, nn
            work.G[2 * i, 2 * j + 1], work.G[2 * j + 1, 2 * i] = nt, nt
            work.G[2 * i + 1, 2 * j], work.G[2 * j, 2 * i + 1] = tn, tn
            work.G[2 * i + 1, 2 * j + 1], work.G[2 * j + 1, 2 * i + 1] = tt, tt


@kernel
def fill_bearings(closed, m, bearings, work):
    """The rows and columns of G, after those of the contacts, for the bearings listed in `dry`."""
    for p in range(bearings):
        row, i = 2 * m + p, work.dry[p]
        for column in range(2 * m + bearings):
            work.G[row, column], work.G[column, row] = 0.0, 0.0
        work.G[row, row] = work.inverse[i]
        for j in range(m):
            for k in range(closed.slots[j]):
                if closed.coord[j, k] == i:
                    N, T = closed.w_N[j, k] * work.inverse[i], closed.w_T[j, k] * work.inverse[i]
                    work.G[row, 2 * j], work.G[2 * j, row] = N, N
                    work.G[row, 2 * j + 1], work.G[2 * j + 1, row] = T, T


@kernel
def apply(closed, m, force, inverse, out_change):
    """Add M⁻¹ W force to `out_change`: accelerations from forces, velocity jumps from impulses."""
    for i in range(m):
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            push = closed.w_N[i, k] * force[2 * i] + closed.w_T[i, k] * force[2 * i + 1]
            out_change[j] += push * inverse[j]


@kernel
def drive_through_contacts(model, closed, m, force, u):
    """Power (of impulses: work) that keeps prescribed motions up against the forces of m contacts."""
    total = 0.0
    for i in range(m):
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            if model.coordinates[j].driven:
                total -= (closed.w_N[i, k] * force[2 * i] + closed.w_T[i, k] * force[2 * i + 1]) * u[j]
    return total


@kernel
def contact_velocities(closed, m, u, out_rates):
    """Rates w_N·u and w_T·u of the closed contacts."""
    for i in range(m):
        normal, tangential = 0.0, 0.0
        for k in range(closed.slots[i]):
            normal += closed.w_N[i, k] * u[closed.coord[i, k]]
            tangential += closed.w_T[i, k] * u[closed.coord[i, k]]
        out_rates[2 * i], out_rates[2 * i + 1] = normal, tangential


# Which contact forces, where the motion does not decide them?


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
