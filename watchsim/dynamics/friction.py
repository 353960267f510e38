"""Which forces do contacts with Coulomb friction bear, and how is the problem for them solved?

Every friction force lies in an interval from c - L x_N to c - L x_N + l x_N + l_0, where x_N is the normal force of its
contact: L = mu, l = 2 mu, c = l_0 = 0 for a contact at the acceleration level and in the compression; c = -T, l_0 = 2 T for a
bearing with dry friction T; the laws of the expansion are in impact.py. With x_+ the distance from the lower end, the law turns
into complementarity with a slip measure (docs/theory/method.md 2.5, 2.6):

    [ y_N ]   [ G_NN - G_NT L   G_NT   0 ] [ x_N  ]
    [ y_+ ] = [ G_TN - G_TT L   G_TT   1 ] [ x_+  ] + b
    [ x_- ]   [ l                -1    0 ] [ y_-  ]

For contacts known to slide L is mu times the direction of slip, and they have no element. `fill_matrix` and `fill_rhs` pose it,
`solve_contacts` solves it, `read_forces` gives the forces.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.dynamics.bearings import Pivots, pivots
from watchsim.dynamics.lcp import (
    LcpOutcome,
    LcpWork,
    Level,
    Solver,
    is_solution,
    lemke_checked,
    lemke_on_path,
    scale,
    solve_active,
    solves,
    unscale,
)
from watchsim.dynamics.redundant import unit_scale
from watchsim.jit import by_reference, kernel
from watchsim.model import blank
from watchsim.tolerances import (
    ACCELERATION_ROUNDING,
    LCP_PATHS,
    LCP_ROUGH,
    LCP_ROUGHEST,
    LCP_ROUNDING,
    MODE_SETS,
    NO_DIRECTION,
    NUDGE,
    PAINLEVE,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

LARGEST = (1, 2, 4, 8, 16)  # unknowns of the problems counted together; one more place for larger ones


@kernel
def law_of(model, k):
    """Friction, restitution and their kin of contact k."""
    return model.laws[model.contacts[k].group]


@kernel
def friction_at(law, speed):
    """Coefficient of friction of a contact that slides at `speed`, m/s, in the direction of its mode (Stribeck's law).

    Smooth also a little beyond a reversal, where `speed` is negative and the step will end.
    """
    if law.drop == 0.0 and law.rise == 0.0:
        return law.friction
    left = math.exp(min(-speed / law.decay, 1.0)) if law.decay > 0.0 else 0.0
    return law.friction - law.drop * (1.0 - left) + law.rise * speed


@kernel
def friction_bound(law, slip):
    """Coefficient of friction at a slip in either direction, m/s; that of rest without slip."""
    return law.friction if slip == 0.0 else friction_at(law, abs(slip))


@kernel
def drops_at_once(law):
    """True if friction is less as soon as the contact slides: then what may stick and what slides are not one law."""
    return law.drop > 0.0 and law.decay == 0.0


class LastProblem:
    """The last problem: what it was about, and how Lemke's method ended."""

    contacts: int
    elements: int
    bearings: int
    level: int  # a Level
    lemke: int  # an LcpOutcome
    jammed: int  # 1: of the bearings no friction goes with the load that it makes
    coupled: int  # 1: loads of bearings are solved with it, see coupled_loads.py
    sliders: int  # bearings that move, in a coupled problem: behind those that may hold
    keeps: int  # 1: what has begun to slide with less friction in the round before goes on; for one decision
    together: int  # 1: contacts that hand forces on to each other slide into a jam
    seized: int  # 1: a bearing has jammed, and the impulses that stop it are to be found
    near: float  # share of a contact's force up to which what is left of it by friction counts as nothing


class KnownProblem(NamedTuple):
    """The last problem of each `Level` that was solved, and its solution."""

    size: Integers  # (levels,) its number of unknowns, 0: none yet
    solver: Integers  # (levels,) a Solver
    lemke: Integers  # (levels,) an LcpOutcome
    A: Array  # (levels, side, side)
    rhs: Array  # (levels, side)
    x: Array  # (levels, side)
    is_active: Integers  # (levels, side) see `LcpWork`


KnownProblemRef = by_reference(KnownProblem, __name__)


class FrictionProblem(NamedTuple):
    """The complementarity problem of the closed contacts, and of the bearings that dry friction might hold.

    A block is a contact or, after the contacts, a bearing; an element is a bounded force: the friction of one block. A force is
    one of N at the level of accelerations, an impulse of N·s at an impact.
    """

    lcp: LcpWork
    known: KnownProblem
    pivots: Pivots
    last: LastProblem
    solvers: Integers  # problems solved since last counted, by `Solver`; the last one counts those without a solution
    sizes: Integers  # the same problems by their number of unknowns, see `LARGEST`
    bearing: Integers  # (n,) coordinate of each bearing that might hold
    pressed: Integers  # (rows of G,) those with a force within the law: the unknowns of the decided modes
    along: Array  # (room,) friction per normal force of each contact that slides, against its slip; 0 where it sticks
    drag: Array  # (room,) friction per normal force at the lower end of the interval
    element: Integers  # (room,) of each contact, -1: none
    begun: Integers  # (room,) mode of a contact that begins to slide with less friction than it had, STICK: none
    block: Integers  # (blocks,) by element
    width: Array  # (blocks,) length of an element's interval per normal force
    span: Array  # (blocks,) constant part of its length
    shift: Array  # (blocks,) constant part of its lower end
    friction_sign: Array  # (rows of G,) -1 where the problem has a direction of friction the other way round, else 1
    unit: Array  # (blocks,) scale that gives G a unit diagonal
    loaded: Array  # (rows of G,) m/s² or m/s: of the gaps without contact forces, bearings at the lower end of their friction
    A: Array  # the problem y = A x + rhs, in units that give G a unit diagonal
    rhs: Array
    x: Array
    B: Array  # the same problem in its copositive form
    other_rhs: Array
    other_x: Array


FrictionProblemRef = by_reference(FrictionProblem, __name__)


def friction_problem(room: int, coordinates: int, lcp: LcpWork) -> FrictionProblem:
    """For `room` closed contacts and as many bearings as coordinates; `lcp` is room for `problem_size` unknowns."""
    rows, blocks, side = 2 * room + coordinates, room + coordinates, problem_size(room, coordinates)
    lengths = {"drag": room, "width": blocks, "span": blocks, "shift": blocks, "unit": blocks, "loaded": rows, "along": room}
    lengths |= dict.fromkeys(("rhs", "x", "other_rhs", "other_x"), side)
    counts = {"solvers": len(Solver), "sizes": len(LARGEST) + 1, "bearing": coordinates}
    counts |= {"element": room, "begun": room, "block": blocks, "pressed": rows}
    parts: dict[str, Any] = {name: np.zeros(length) for name, length in lengths.items()}
    parts |= {name: np.zeros(length, np.int64) for name, length in counts.items()}
    parts |= {name: np.zeros((side, side)) for name in ("A", "B")}
    parts |= {"known": _known(side), "pivots": pivots(room, coordinates), "last": blank(LastProblem)}
    return FrictionProblem(lcp=lcp, friction_sign=np.ones(rows), **parts)


def _known(side: int) -> KnownProblem:
    """None yet, with room for `side` unknowns."""
    levels = len(Level)
    size, solver, lemke = np.zeros((3, levels), np.int64)
    rhs, x = np.zeros((2, levels, side))
    return KnownProblem(size, solver, lemke, np.zeros((levels, side, side)), rhs, x, np.zeros((levels, side), np.int64))


def problem_size(room: int, coordinates: int) -> int:
    """The most unknowns of a problem, in its copositive form."""
    return 4 * room + 3 * coordinates


# The problem is posed.


@kernel
def add_element(problem, block, element, interval):
    """Element number `element` belongs to `block`; interval: (width, span, shift). Returns the next number."""
    problem.block[element] = block
    problem.width[element], problem.span[element], problem.shift[element] = interval
    return element + 1


@kernel
def element_row(problem, m, element):
    """Row of G of an element."""
    block = problem.block[element]
    return 2 * block + 1 if block < m else m + block


@kernel
def choose_signs(G, slip, m, rows, elements, problem):
    """Take each direction of friction such that what it does without friction, `slip` by row, is positive.

    The problem treats the two ends of a cone differently. Where friction leaves more than one solution Lemke's method would end
    in another one if a direction were reversed, and a mechanism in a mirror would move otherwise. Where nothing slips what a
    normal force does decides. Both change sign with the direction, and neither depends on where the drawing came from.
    """
    sign, largest = problem.friction_sign, 0.0
    for e in range(elements):
        largest = max(largest, _cost(G, slip, element_row(problem, m, e)))
    for row in range(rows):
        sign[row] = 1.0
    for e in range(elements):
        row, block = element_row(problem, m, e), problem.block[e]
        direction = slip[row]
        if _cost(G, slip, row) <= NO_DIRECTION * NO_DIRECTION * largest and block < m:
            direction = G[row, 2 * block]
        if direction < 0.0:
            sign[row] = -1.0


@kernel
def _cost(G, slip, row):
    """What the row alone would cost to stop: the same in all units, and in a mirror."""
    return slip[row] * slip[row] / G[row, row] if G[row, row] > 0.0 else 0.0


@kernel
def fill_matrix(G, m, elements, problem):
    """The matrix above into `problem.A`, scaled by `problem.unit`; returns its size, m + 2 elements."""
    A, unit, block, sign = problem.A, problem.unit, problem.block, problem.friction_sign
    n = m + 2 * elements
    for i in range(n):
        for j in range(n):
            A[i, j] = 0.0
    for i in range(m):
        unit[i] = unit_scale(max(G[2 * i, 2 * i], G[2 * i + 1, 2 * i + 1]))
    for e in range(elements):
        if block[e] >= m:
            unit[block[e]] = unit_scale(G[m + block[e], m + block[e]])
    for line in range(m + elements):
        e = line - m
        row = 2 * line if e < 0 else element_row(problem, m, e)
        own = unit[line if e < 0 else block[e]]
        for j in range(m):
            N, T = sign[row] * G[row, 2 * j], sign[row] * sign[2 * j + 1] * G[row, 2 * j + 1]
            A[line, j] = own * unit[j] * (N - problem.drag[j] * T)
        for f in range(elements):
            column = element_row(problem, m, f)
            A[line, m + f] = own * unit[block[f]] * (sign[row] * sign[column] * G[row, column])
    for e in range(elements):
        A[m + e, m + elements + e] = 1.0
        A[m + elements + e, m + e] = -1.0
        if block[e] < m:
            A[m + elements + e, block[e]] = problem.width[e]
    return n


@kernel
def fill_rhs(b, m, elements, problem):
    """Right-hand side from the rows `b`: accelerations or velocities with each force at the constant part of its lower end."""
    for i in range(m):
        problem.rhs[i] = problem.unit[i] * b[2 * i]
    for e in range(elements):
        unit, row = problem.unit[problem.block[e]], element_row(problem, m, e)
        problem.rhs[m + e] = unit * (problem.friction_sign[row] * b[row])
        problem.rhs[m + elements + e] = problem.span[e] / unit


@kernel
def load_bearings(G, b, m, elements, bearings, problem):
    """The rows `b` with the bearings, whose elements come last, at the lower end of their friction, into `problem.loaded`."""
    for row in range(2 * m + bearings):
        problem.loaded[row] = b[row]
        for p in range(bearings):
            force = problem.friction_sign[2 * m + p] * problem.shift[elements - bearings + p]
            problem.loaded[row] += G[row, 2 * m + p] * force


@kernel
def read_forces(m, elements, problem, out_force):
    """Forces by row of G from the solution `problem.x`."""
    for i in range(m):
        normal = problem.unit[i] * problem.x[i]
        out_force[2 * i], out_force[2 * i + 1] = normal, -problem.drag[i] * normal
    for e in range(elements):
        block, row = problem.block[e], element_row(problem, m, e)
        above = problem.shift[e] + problem.unit[block] * problem.x[m + e]
        if block < m:
            above -= problem.drag[block] * out_force[2 * block]
        out_force[row] = problem.friction_sign[row] * above


# Which contacts jam: slide such that a normal force on them pulls their bodies together (Painlevé)?
#
# Where nothing presses such a contact, the laws have several solutions (docs/theory/method.md 2.6).


@kernel
def jams(G, drag, m, i, near=PAINLEVE):
    """True if contact i, all by itself, slides such that a normal force on it pulls its bodies together, or nearly so.

    `drag`: its friction per normal force, against its slip. `near`: the share of G_N by which the force may still part them.
    """
    own = G[2 * i, 2 * i]
    if own == 0.0 or own - drag * G[2 * i, 2 * i + 1] > near * own:
        return False
    for j in range(m):
        if j != i and (G[2 * i, 2 * j] != 0.0 or G[2 * i, 2 * j + 1] != 0.0 or G[2 * i + 1, 2 * j] != 0.0):
            return False
    return True


LEAST_BARE = 1e-7  # of a determinant: of a smaller one rounding leaves no share as small as `PAINLEVE`


@kernel
def share_left(G, along, rows, n, A):
    """How much less than without friction the forces in `rows[:n]` of G part their bodies: det(G - friction) / det(G).

    The same for contacts that hand forces on to each other as `jams` asks of one by itself, where it is 1 - mu G_c / G_N.
    `along`: friction per normal force of contacts that slide, against their slip, 0 where they stick. 1 where forces are
    redundant. Overwrites A.
    """
    bare = _determinant(G, along, rows, n, 0.0, A)
    return _determinant(G, along, rows, n, 1.0, A) / bare if bare > LEAST_BARE else 1.0


@kernel
def _determinant(G, along, rows, n, share, A):
    """Of G in those rows, scaled to a unit diagonal, with that share of the friction."""
    for i in range(n):
        for j in range(n):
            entry, column = G[rows[i], rows[j]], rows[j]
            if column % 2 == 0:
                entry -= share * along[column // 2] * G[rows[i], column + 1]
            A[i, j] = entry * unit_scale(G[rows[i], rows[i]]) * unit_scale(G[column, column])
    product = 1.0
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[best, k]):
                best = i
        if A[best, k] == 0.0:
            return 0.0
        if best != k:
            product = -product
            for j in range(n):
                A[k, j], A[best, j] = A[best, j], A[k, j]
        product *= A[k, k]
        for i in range(k + 1, n):
            factor = A[i, k] / A[k, k]
            for j in range(k + 1, n):
                A[i, j] -= factor * A[k, j]
    return product


@kernel
def press_unloaded(model, closed, m, elements, system, problem):
    """Settle what happens where nothing presses a contact that would jam as it slides; True if any is pressed.

    There the laws have more than one solution, and the rounding of a load that is zero would choose between them. Without
    slip the contact holds, as it would under any load however small: it is pressed by next to nothing. With slip it goes
    on without a force. The load pushes the bodies, not their gap alone: what else holds them might contradict that.
    """
    pressed, G = False, system.G
    for i in range(m):
        drag, slip = problem.friction_sign[2 * i + 1] * problem.drag[i], abs(problem.loaded[2 * i + 1])
        if not jams(G, drag, m, i) or not _is_unloaded(model, closed, i, system, problem.loaded[2 * i]):
            continue
        if problem.element[i] < 0:
            problem.rhs[i] = max(0.0, problem.rhs[i])
        elif slip != 0.0:
            load = NUDGE * slip / max(G[2 * i, 2 * i], abs(G[2 * i + 1, 2 * i]))
            for line in range(m + elements):
                row = 2 * line if line < m else element_row(problem, m, line - m)
                unit = problem.unit[line if line < m else problem.block[line - m]]
                problem.rhs[line] -= load * unit * problem.friction_sign[row] * G[row, 2 * i]
            pressed = True
    return pressed


@kernel
def _is_unloaded(model, closed, i, system, loaded):
    """True if gap i accelerates without its force (`loaded`, m/s²) by no more than rounding, also of its lever arms."""
    terms = closed.kin[i].bar_size
    for k in range(closed.slots[i]):
        j = closed.coord[i, k]
        arm = abs(closed.w_N[i, k]) + abs(closed.w_T[i, k])
        terms += arm * (abs(system.h[j]) + model.coordinates[j].load) * system.inverse[j]
    return abs(loaded) <= ACCELERATION_ROUNDING * terms


# The problem is solved, if not by the first method then by another one.


@kernel
def solve_contacts(m, elements, bearings, level, problem):
    """Solve `problem.A`, `problem.rhs` into `problem.x`; returns the `Solver` that did, FAILED if none. `level`: a `Level`.

    One after another: Lemke's method on the form above; on the copositive form, which always has a solution for impacts
    (Stewart & Trinkle 1996; Anitescu & Potra 1997); Lemke's method on other paths; enumeration of the modes of small sets. What
    solves the problem is checked against the first form. Where many contacts are redundant their loads are rounding errors that
    may contradict each other: then an end of Lemke's method is taken that misses by no more than a billionth of the load that
    drives the problem, else by a millionth. If nothing helps, the caller stops and keeps the problem.
    """
    last, n = problem.last, m + 2 * elements
    last.contacts, last.elements, last.bearings, last.level = m, elements, bearings, level
    if _is_known(n, level.value, problem):
        solver = _recall(n, level.value, problem)
    else:
        solver = _solve_anew(m, elements, problem)
        _keep_solution(n, level.value, solver, problem)
    problem.solvers[solver] += 1
    problem.sizes[size_class(n)] += 1
    return solver


@kernel
def _solve_anew(m, elements, problem):
    """The number of the `Solver`, see `solve_contacts`."""
    n = m + 2 * elements
    outcome = lemke_checked(problem.A, problem.rhs, n, problem.lcp, problem.x)
    problem.last.lemke = outcome
    solver = Solver.LEMKE
    if outcome != LcpOutcome.SOLVED:
        solver = Solver.FAILED
        if elements > 0 and _solve_copositive(m, elements, problem):
            solver = Solver.COPOSITIVE
        elif _detour(n, 0.0, problem):
            solver = Solver.DETOUR
        elif enumerate_modes(m, elements, problem):
            solver = Solver.ENUMERATED
        elif _detour(n, LCP_ROUGH, problem) or _detour(n, LCP_ROUGHEST, problem):
            solver = Solver.INEXACT
    return solver.value


# At one impact the compression is posed again for every rebound that ends, and the same modes are decided for each and once
# more when all is over: a problem that is the last one of its level to the bit has its solution.


@kernel
def _is_known(n, level, problem):
    """True if the problem of n unknowns is the last one solved at this level."""
    known = problem.known
    if known.size[level] != n:
        return False
    for i in range(n):
        if known.rhs[level, i] != problem.rhs[i]:
            return False
    for i in range(n):
        for j in range(n):
            if known.A[level, i, j] != problem.A[i, j]:
                return False
    return True


@kernel
def _recall(n, level, problem):
    """Its solution into `problem.x`; returns the number of the `Solver`."""
    known = problem.known
    for i in range(n):
        problem.x[i], problem.lcp.is_active[i] = known.x[level, i], known.is_active[level, i]
    problem.last.lemke = known.lemke[level]
    return known.solver[level]


@kernel
def _keep_solution(n, level, solver, problem):
    """Remember the problem just solved."""
    known = problem.known
    known.size[level], known.solver[level], known.lemke[level] = n, solver, problem.last.lemke
    for i in range(n):
        known.rhs[level, i], known.x[level, i], known.is_active[level, i] = (
            problem.rhs[i],
            problem.x[i],
            problem.lcp.is_active[i],
        )
        for j in range(n):
            known.A[level, i, j] = problem.A[i, j]


@kernel
def size_class(n):
    """The place in `sizes` for a problem of n unknowns."""
    place = 0
    while place < len(LARGEST) and n > LARGEST[place]:
        place += 1
    return place


@kernel
def keep_basis(b, m, elements, solver, problem):
    """Take back a small change of `problem.rhs`: the solution for the rows `b` with the same active unknowns, if it is one.

    `solver`: the one that solved the problem; only Lemke's method on its first path leaves what is active.
    """
    n, lcp = m + 2 * elements, problem.lcp
    fill_rhs(b, m, elements, problem)
    if solver != Solver.LEMKE:
        for i in range(n):
            lcp.is_active[i] = 1 if problem.x[i] > 0.0 else 0
    magnitude = scale(problem.A, problem.rhs, n, lcp)
    solve_active(n, lcp)
    if is_solution(n, lcp):
        unscale(n, magnitude, lcp, problem.x)


@kernel
def _detour(n, rough, problem):
    """True if Lemke's method reaches a solution from another start, then in `problem.x`: ties and rounding fall otherwise.

    `rough` > 0: the usual start counts, too, and so does what misses the conditions by no more than that share.
    """
    for path in range(0 if rough > 0.0 else 1, LCP_PATHS + 1):
        outcome = lemke_on_path(problem.A, problem.rhs, n, path, problem.lcp, problem.x)
        if outcome == LcpOutcome.SOLVED or (rough > 0.0 and outcome == LcpOutcome.INEXACT and solves(n, rough, problem.lcp)):
            return True
    return False


@kernel
def _fill_copositive(m, elements, problem):
    """The problem with unknowns x_N, beta_+, beta_-, sigma into `problem.B`, `problem.other_rhs`; returns its size.

    The friction force is the middle of its interval plus beta_+ - beta_-, beta_+ + beta_- within half the length, sigma the
    speed of slip.
    """
    A, B, rhs, other_rhs = problem.A, problem.B, problem.rhs, problem.other_rhs
    n = m + 3 * elements
    plus, minus, sigma = m, m + elements, m + 2 * elements
    for i in range(n):
        other_rhs[i] = 0.0
        for j in range(n):
            B[i, j] = 0.0
    for line in range(m + elements):
        other_rhs[line] = rhs[line]
        for j in range(m):
            B[line, j] = A[line, j]
        for e in range(elements):
            effect = A[line, m + e]
            B[line, plus + e], B[line, minus + e] = effect, -effect
            other_rhs[line] += 0.5 * rhs[m + elements + e] * effect
            if problem.block[e] < m:
                B[line, problem.block[e]] += 0.5 * problem.width[e] * effect
    for e in range(elements):
        other_rhs[minus + e] = -other_rhs[plus + e]
        for j in range(n):
            B[minus + e, j] = -B[plus + e, j]
        B[plus + e, sigma + e], B[minus + e, sigma + e] = 1.0, 1.0
        B[sigma + e, plus + e], B[sigma + e, minus + e] = -1.0, -1.0
        other_rhs[sigma + e] = 0.5 * rhs[m + elements + e]
        if problem.block[e] < m:
            B[sigma + e, problem.block[e]] = 0.5 * problem.width[e]
    return n


@kernel
def _solve_copositive(m, elements, problem):
    """True if the copositive form gives a solution of the first form, then in `problem.x`."""
    n, rhs, x, other_x = _fill_copositive(m, elements, problem), problem.rhs, problem.x, problem.other_x
    if lemke_checked(problem.B, problem.other_rhs, n, problem.lcp, other_x) != LcpOutcome.SOLVED:
        return False
    for i in range(m):
        x[i] = other_x[i]
    for e in range(elements):
        half = 0.5 * rhs[m + elements + e]
        if problem.block[e] < m:
            half += 0.5 * problem.width[e] * x[problem.block[e]]
        above = half + other_x[m + e] - other_x[m + elements + e]
        x[m + e] = above if above > LCP_ROUNDING * half else 0.0
    for e in range(elements):
        slip = rhs[m + e]
        for j in range(m + elements):
            slip += problem.A[m + e, j] * x[j]
        x[m + elements + e] = max(0.0, -slip)
    return _is_solved(m + 2 * elements, problem)


@kernel
def _is_solved(n, problem):
    """True if `problem.x` solves the first form, rounding errors in the place of zeros forgiven."""
    lcp = problem.lcp
    magnitude = scale(problem.A, problem.rhs, n, lcp)
    for i in range(n):
        value = problem.x[i] / (lcp.column_scale[i] * magnitude)
        lcp.trial[i] = value if value > LCP_ROUNDING else 0.0
    return is_solution(n, lcp)


@kernel
def enumerate_modes(m, elements, problem):
    """Try every set of modes (contact pressed or not; friction at one end, within, at the other end); True with `problem.x`."""
    n, sets, active = m + 2 * elements, 1.0, problem.lcp.is_active
    for _ in range(m):
        sets *= 2.0
    for _ in range(elements):
        sets *= 3.0
    if sets > MODE_SETS:
        return False
    magnitude = scale(problem.A, problem.rhs, n, problem.lcp)
    for number in range(int(sets)):
        rest = number
        for i in range(m):
            active[i] = rest % 2
            rest //= 2
        for e in range(elements):
            digit = rest % 3
            rest //= 3
            active[m + e] = 1 if digit > 0 else 0
            active[m + elements + e] = 1 if digit == 2 else 0
        solve_active(n, problem.lcp)
        if is_solution(n, problem.lcp):
            unscale(n, magnitude, problem.lcp, problem.x)
            return True
    return False
