"""What are the contact forces and accelerations now?

Inside a mode an equality system (`solve_mode`); at an event the acceleration-level LCP, which decides detachment and stick-slip
of contacts and of bearings with dry friction (`decide_modes`; Pfeiffer & Glocker 1996, ch. 5; docs/theory/method.md 2.4, 2.5).
"""

from __future__ import annotations

from watchsim.contact.gaps import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics.coupled_loads import bound_found, fill_coupled, read_coupled, trace_loads
from watchsim.dynamics.delassus import apply, fill_bearings, fill_delassus, inverse_mass, own_acceleration
from watchsim.dynamics.friction import (
    add_element,
    choose_signs,
    drops_at_once,
    fill_matrix,
    fill_rhs,
    friction_at,
    jams,
    keep_basis,
    law_of,
    load_bearings,
    press_unloaded,
    read_forces,
    share_left,
    solve_contacts,
)
from watchsim.dynamics.lcp import Level, Solver
from watchsim.dynamics.redundant import smallest_forces, solve_small, unit_scale
from watchsim.jit import hot_kernel, kernel
from watchsim.tolerances import ACCELERATION_ROUNDING, NO_ARM, PAINLEVE, RANK


@kernel
def gap_accelerations(model, closed, m, system):
    """b = Wᵀ M⁻¹ h + w̄ of the first m contacts into `system`, with the sum of its terms' magnitudes.

    A term that happens to vanish, as a pendulum's weight does when it hangs straight, still has the rounding of its vectors.
    """
    for i in range(m):
        kin = closed.kin[i]
        normal, tangential = kin.bar_N, kin.bar_T
        size_N, size_T = kin.bar_size, kin.bar_size
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            free = own_acceleration(model, system, j)
            normal += closed.w_N[i, k] * free
            tangential += closed.w_T[i, k] * free
            terms = abs(free) + model.coordinates[j].load * system.inverse[j]
            size_N += abs(closed.w_N[i, k]) * terms
            size_T += abs(closed.w_T[i, k]) * terms
        system.b[2 * i], system.b[2 * i + 1] = normal, tangential
        system.size[2 * i], system.size[2 * i + 1] = size_N, size_T


@kernel
def _pose(model, closed, m, system):
    """G, b and the scales of their rounding."""
    fill_delassus(closed, m, system.inverse, system.G)
    gap_accelerations(model, closed, m, system)
    for i in range(m):
        own = system.G[2 * i, 2 * i]
        system.normal_scale[i] = system.size[2 * i] / own if own > 0.0 else 0.0


@hot_kernel
def row_terms(system, drag, m, rows, row):
    """The sum of the magnitudes of its terms: the scale of its rounding.

    What another contact passes on has the rounding of that one's terms, even where these cancel and it passes on nothing.
    """
    total = system.size[row]
    for j in range(rows):
        total += abs(system.G[row, j] * system.force[j])
    for i in range(m):
        if i != row // 2:
            total += (abs(system.G[row, 2 * i]) + abs(drag[i] * system.G[row, 2 * i + 1])) * system.normal_scale[i]
    return total


@kernel
def accelerate(model, closed, m, system, out_a):
    """u' = M⁻¹ (h + W lambda); 0 where dry friction holds."""
    for j in range(len(out_a)):
        out_a[j] = own_acceleration(model, system, j)
    apply(closed, m, system.force, system.inverse, out_a)


@kernel
def solve_mode(model, closed, m, mode, lenience, system, modes):
    """Forces of the first m contacts in their decided modes into `system.force`; `system.h`, `system.inverse` are given.

    Fills the rest of `system`, `size` with the terms of the forces found; True if the forces are unique. `lenience`: what
    decides that is so many times `RANK`.
    """
    _pose(model, closed, m, system)
    n = m
    for i in range(m):
        state, law = mode[closed.ids[i]], law_of(model, closed.ids[i])
        friction = law.friction
        modes.unknown[i], modes.friction[i] = -1, friction
        modes.drag[i] = 0.0 if state == STICK else friction_at(law, state * closed.kin[i].gT_dot) * state
        modes.scale[i] = unit_scale(system.G[2 * i, 2 * i])
        if state == STICK and friction > 0.0:
            modes.unknown[i] = n
            modes.scale[n] = unit_scale(system.G[2 * i + 1, 2 * i + 1])
            n += 1
    for i in range(m):
        _equation(system, m, 2 * i, i, modes)
        if modes.unknown[i] >= 0:
            _equation(system, m, 2 * i + 1, modes.unknown[i], modes)
    rank = solve_small(modes.A, modes.rhs, n, modes.scale, modes.order, modes.x, RANK * lenience)
    if rank < n:
        smallest_forces(model, closed, m, n, rank, lenience, system, modes)
    for i in range(m):
        system.force[2 * i] = modes.x[i]
        t = modes.unknown[i]
        system.force[2 * i + 1] = modes.x[t] if t >= 0 else -modes.drag[i] * modes.x[i]
    for row in range(2 * m):
        system.size[row] = row_terms(system, modes.drag, m, 2 * m, row)
    return rank == n


@kernel
def _equation(system, m, row, line, modes):
    """One row of the equality system: the acceleration of gap `row` vanishes."""
    for j in range(m):
        modes.A[line, j] = system.G[row, 2 * j] - modes.drag[j] * system.G[row, 2 * j + 1]
        if modes.unknown[j] >= 0:
            modes.A[line, modes.unknown[j]] = system.G[row, 2 * j + 1]
    modes.rhs[line] = -system.b[row]


@kernel
def decide_modes(model, closed, m, bearings, speed_zero, system, problem, out_grip, out_mode):
    """Acceleration-level LCP over I_N, the first m closed contacts, and `problem.bearing[:bearings]`; is it solved?

    Contacts whose |g_T_dot| is below `speed_zero` may stick; the others slide as they do. Sets modes and grips, fills `system`
    and adds to `system.h` the dry friction of the bearings that begin to move. False: no finite force keeps the bodies apart
    (Painlevé's paradox, if a contact slides). In a coupled problem `problem.last.sliders` moving bearings follow in the list.
    """
    for i in range(len(model.coordinates)):
        system.inverse[i] = inverse_mass(model.coordinates[i])
    _pose(model, closed, m, system)
    rows = bearings + problem.last.sliders  # whose loads are solved with the rest: they have no element
    fill_bearings(closed, m, problem.bearing, rows, system.inverse, system.G)
    for p in range(rows):
        i, row = problem.bearing[p], 2 * m + p
        system.b[row] = system.h[i] * system.inverse[i]
        system.size[row] = abs(system.b[row])
    if problem.last.coupled:
        trace_loads(model, closed, m, rows, 1.0, system, problem)
    if problem.last.keeps == 0:
        problem.begun[:m] = STICK
    problem.last.keeps = problem.last.together = 0
    elements, begins = -1, True
    while begins:
        elements = _solve(model, closed, m, bearings, speed_zero, system, problem)
        if elements < 0:
            return False
        begins = _begin_sliding(model, closed, m, elements, rows, system, problem)
    for i in range(m):
        if problem.x[i] > 0.0 and _slides_into_jam(system, m, i, problem):
            return False
    for i in range(m):
        k = closed.ids[i]
        out_mode[k] = _mode_of(closed, i, m, elements, rows, system, problem)
        if problem.x[i] == 0.0 and out_mode[k] != STICK and jams(system.G, out_mode[k] * abs(problem.drag[i]), m, i):
            out_mode[k] = OPEN  # as it slides any force on it would grow without bound
    for i in range(m):
        if out_mode[closed.ids[i]] == OPEN:
            system.force[2 * i], system.force[2 * i + 1] = 0.0, 0.0
    if m > 1 and _slide_into_jam(closed, m, out_mode, system, problem):
        problem.last.together = 1
        return False
    _decide_grips(m, bearings, problem, system, out_grip)
    return True


@kernel
def _solve(model, closed, m, bearings, speed_zero, system, problem):
    """Pose the problem and solve it, forces into `system.force`; returns the number of elements, -1 without a solution."""
    elements = _elements(model, closed, m, bearings, speed_zero, system, problem)
    choose_signs(system.G, system.b, m, 2 * m + bearings, elements, problem)
    coupled, sizes = problem.last.coupled == 1, (elements, bearings + problem.last.sliders, bearings)
    if coupled:
        problem.pivots.base[:] = 0.0
        fill_coupled(system.G, system.b, m, sizes, problem)
    else:
        fill_matrix(system.G, m, elements, problem)
        load_bearings(system.G, system.b, m, elements, bearings, problem)
        fill_rhs(problem.loaded, m, elements, problem)
    pressed = press_unloaded(model, closed, m, elements, system, problem)
    solver = solve_contacts(m, elements, bearings, Level.ACCELERATION, problem)
    if pressed and solver == Solver.FAILED:
        fill_rhs(problem.loaded, m, elements, problem)
        pressed, solver = False, solve_contacts(m, elements, bearings, Level.ACCELERATION, problem)
    if solver == Solver.FAILED:
        return -1
    if pressed:
        keep_basis(problem.loaded, m, elements, solver, problem)
    if coupled:
        read_coupled(m, sizes, problem, system.force)
        for p in range(sizes[1]):
            system.dry[problem.bearing[p]] = bound_found(m, p, system.force, problem.pivots)
    else:
        read_forces(m, elements, problem, system.force)
    return elements


@kernel
def _begin_sliding(model, closed, m, elements, bearings, system, problem):
    """Note the contacts that static friction does not hold and that slide with less; True if any is new: solve again.

    What it holds goes on sticking, though sliding might be a solution, too (docs/theory/method.md 2.5).
    """
    found = False
    for i in range(m):
        if problem.element[i] < 0 or not drops_at_once(law_of(model, closed.ids[i])):
            continue
        mode = _mode_of(closed, i, m, elements, bearings, system, problem)
        if mode in (FORWARD, BACKWARD):
            problem.begun[i], found = mode, True
    return found


@kernel
def _elements(model, closed, m, bearings, speed_zero, system, problem):
    """The contacts that may stick, then the bearings; returns how many."""
    elements = 0
    for i in range(m):
        law, slip, begun = law_of(model, closed.ids[i]), closed.kin[i].gT_dot, problem.begun[i]
        friction, slides = law.friction, friction_at(law, abs(slip))
        problem.element[i] = -1
        problem.drag[i] = slides if begun == FORWARD or (slip > 0.0 and begun == STICK) else -slides
        if not (friction > 0.0 and abs(slip) <= speed_zero and begun == STICK):
            continue
        if _has_no_arm(system.G, i):
            problem.begun[i] = BACKWARD if system.b[2 * i + 1] < 0.0 else FORWARD
        else:
            problem.element[i], problem.drag[i] = elements, friction
            elements = add_element(problem, i, elements, (2.0 * friction, 0.0, 0.0))
    for p in range(bearings):
        dry = system.dry[problem.bearing[p]]
        elements = add_element(problem, m + p, elements, (0.0, 2.0 * dry, -dry))
    return elements


@kernel
def _has_no_arm(G, i):
    """True if forces across contact i move nothing but by rounding (method 2.6): nothing holds its slip."""
    return 0.0 < G[2 * i + 1, 2 * i + 1] <= NO_ARM * NO_ARM * G[2 * i, 2 * i]


@kernel
def _slides_into_jam(system, m, i, problem):
    return problem.element[i] < 0 and jams(system.G, problem.drag[i], m, i)


@kernel
def _slide_into_jam(closed, m, mode, system, problem):
    """The same for contacts that hand forces on to each other, one of which slid already."""
    n, slides = 0, False
    for i in range(m):
        problem.along[i] = 0.0
        if problem.x[i] > 0.0 and mode[closed.ids[i]] != OPEN:
            problem.pressed[n], n = 2 * i, n + 1
            if mode[closed.ids[i]] == STICK and problem.drag[i] != 0.0:
                problem.pressed[n], n = 2 * i + 1, n + 1
            elif mode[closed.ids[i]] != STICK:
                problem.along[i] = abs(problem.drag[i]) * mode[closed.ids[i]]
                slides = slides or (problem.element[i] < 0 and problem.drag[i] != 0.0)
    return slides and share_left(system.G, problem.along, problem.pressed, n, problem.B) <= PAINLEVE


@kernel
def _row_acceleration(system, rows, row):
    """g'' of row `row` under the forces just found."""
    total = system.b[row]
    for j in range(rows):
        total += system.G[row, j] * system.force[j]
    return total


@kernel
def _mode_of(closed, i, m, elements, bearings, system, problem):
    """The mode of contact i after the LCP.

    It slides only one way if the LCP has its friction at that end of the cone: where contacts are redundant, the slip of one
    whose friction is at the other end is what the LCP may miss.
    """
    N, T, rows, drag = 2 * i, 2 * i + 1, 2 * m + bearings, problem.drag
    pressed, e = problem.x[i] > 0.0, problem.element[i]
    if not pressed and _row_acceleration(system, rows, N) > ACCELERATION_ROUNDING * row_terms(system, drag, m, rows, N):
        return OPEN
    if problem.begun[i] != STICK:
        return problem.begun[i]
    if e < 0:
        return BACKWARD if closed.kin[i].gT_dot < 0.0 else FORWARD
    slip = problem.friction_sign[T] * _row_acceleration(system, rows, T)  # as the problem has it
    # lambda_T is the difference of terms as large as the friction cone.
    terms = abs(system.force[T]) + drag[i] * system.force[N]
    size = ACCELERATION_ROUNDING * (row_terms(system, drag, m, rows, T) + system.G[T, T] * terms)
    is_reversed = problem.friction_sign[T] < 0.0
    if slip > size and problem.x[m + e] == 0.0:
        return BACKWARD if is_reversed else FORWARD
    if slip < -size and problem.x[m + elements + e] > 0.0:
        return FORWARD if is_reversed else BACKWARD
    return STICK


AT_LIMIT = 1e-12  # of the friction of a bearing


@kernel
def _decide_grips(m, bearings, problem, system, out_grip):
    """The grips of the bearings that stood; those held get no inverse mass, those that begin to move their friction.

    One that contacts hold as well, at the limit of its friction, has that friction as a force. Else loads would be shared anew
    between it and the contacts, which may pass the limit at once, and the same would be decided again.
    """
    rows = 2 * m + bearings + problem.last.sliders
    for p in range(bearings):
        i, row = problem.bearing[p], 2 * m + p
        moves = _row_acceleration(system, rows, row)
        terms = row_terms(system, problem.drag, m, rows, row) + system.inverse[i] * system.dry[i]
        limit = abs(system.force[row]) >= (1.0 - AT_LIMIT) * system.dry[i]
        if not (abs(moves) > ACCELERATION_ROUNDING * terms or (m > 0 and limit)):
            continue
        # Friction is against the motion, also against one that is rounding.
        way = -system.force[row] if limit and system.dry[i] > 0.0 else moves
        out_grip[i] = FORWARD if way > 0.0 else BACKWARD
        system.h[i] -= out_grip[i] * system.dry[i]
    for p in range(problem.last.sliders):
        i = problem.bearing[bearings + p]
        system.h[i] -= out_grip[i] * system.dry[i]
    for p in range(bearings):
        if out_grip[problem.bearing[p]] == STICK:
            system.inverse[problem.bearing[p]] = 0.0
