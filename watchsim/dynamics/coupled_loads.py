"""Which forces do contacts bear, and bearings whose friction goes with the load, found as one problem?

Where finding loads and forces in turn (bearings.py) does not settle, the bound grip |R| of each bearing enters the
complementarity problem (friction.py): |R| is replaced by d·R, d the direction of R in the last round. That is linear in the
forces, and a round is a step of Newton's method (Josephy 1979). It also finds what obeys the laws where a force passes within
the circle of friction; where nothing does at the level of accelerations the bearing seizes (docs/theory/method.md 2.6).

A row of G belongs to each bearing; those at rest and those struck have an element, the ones that move only their friction.
"""

from __future__ import annotations

import math

from watchsim.dynamics.bearings import settled_share
from watchsim.dynamics.friction import element_row, fill_matrix, fill_rhs
from watchsim.jit import kernel
from watchsim.tolerances import LOAD_ROUGH, NUDGE, PARALLEL

NOT_LOADED = -1


@kernel
def trace_loads(model, closed, m, bearings, resting, system, problem):
    """Into `problem.pivots` what unit forces by row of G add to the loads of `bearings`, and what is there without them.

    `resting`: 1.0 with the forces of an instant, 0.0 for the impulses of an impact, which alone press.
    """
    pivots = problem.pivots
    for p in range(bearings):
        row, j, of = 2 * m + p, problem.bearing[p], NOT_LOADED
        for k in range(len(model.bearings)):
            of = k if model.bearings[k].coordinate == j else of
        pivots.load[p] = of
        pivots.fixed[p], pivots.grip[p] = resting * system.dry[j], 0.0
        pivots.start[p, 0], pivots.start[p, 1] = 0.0, 0.0
        for column in range(2 * m + bearings):
            pivots.lean[p, 0, column], pivots.lean[p, 1, column] = 0.0, 0.0
        if of == NOT_LOADED:
            continue
        bearing, x, y = model.bearings[of], system.arm[of, 0], system.arm[of, 1]
        weight = math.sqrt(bearing.weight_x * bearing.weight_x + bearing.weight_y * bearing.weight_y)
        pivots.grip[p], pivots.fixed[p] = bearing.grip, resting * (model.coordinates[j].coulomb - bearing.grip * weight)
        pivots.start[p, 0] = resting * (system.pull[of, 0] - y * system.b[row])
        pivots.start[p, 1] = resting * (system.pull[of, 1] + x * system.b[row])
        for column in range(2 * m + bearings):
            pivots.lean[p, 0, column] = -y * system.G[row, column]
            pivots.lean[p, 1, column] = x * system.G[row, column]
        for i in range(m):
            contact, kin = model.contacts[closed.ids[i]], closed.kin[i]
            a, b = model.primitives[contact.a].body, model.primitives[contact.b].body
            sign = (1.0 if b == bearing.body else 0.0) - (1.0 if a == bearing.body else 0.0)
            pivots.lean[p, 0, 2 * i] += sign * kin.nx
            pivots.lean[p, 1, 2 * i] += sign * kin.ny
            pivots.lean[p, 0, 2 * i + 1] -= sign * kin.ny
            pivots.lean[p, 1, 2 * i + 1] += sign * kin.nx


@kernel
def starts(m):
    """How many first directions `aim_first` knows."""
    return 1 + 3 * m


@kernel
def aim_first(closed, m, bearings, start, problem):
    """The directions d to begin with: as they are, or those of what one contact's force does, along its normal or cone.

    The edge of the cone against the slip comes first, so that a mirror image moves alike.
    """
    pivots, i, edge = problem.pivots, (start - 1) // 3, (start - 1) % 3
    if start == 0:
        return
    against = -1.0 if closed.kin[i].gT_dot > 0.0 else 1.0
    lean = (0.0, against, -against)[edge] * abs(problem.drag[i])
    for p in range(bearings):
        turn(
            p,
            pivots.lean[p, 0, 2 * i] + lean * pivots.lean[p, 0, 2 * i + 1],
            pivots.lean[p, 1, 2 * i] + lean * pivots.lean[p, 1, 2 * i + 1],
            pivots,
        )


@kernel
def turn(p, x, y, pivots):
    """Let the direction of bearing p be that of the load (x, y); without any it stays."""
    length = math.sqrt(x * x + y * y)
    if length > 0.0 and math.isfinite(length):
        pivots.way[p, 0], pivots.way[p, 1] = x / length, y / length


@kernel
def _along(p, column, pivots):
    """Friction that a unit force of row `column` adds to the bound of bearing p."""
    x, y = pivots.lean[p, 0, column], pivots.lean[p, 1, column]
    return pivots.grip[p] * (pivots.way[p, 0] * x + pivots.way[p, 1] * y)


@kernel
def _bound(m, p, share, force, pivots):
    """The bound of bearing p under the `force` of the contacts; `share` of what is there without any counts."""
    total = pivots.grip[p] * (pivots.way[p, 0] * pivots.start[p, 0] + pivots.way[p, 1] * pivots.start[p, 1])
    total = share * (total + pivots.fixed[p])
    for row in range(2 * m):
        total += _along(p, row, pivots) * force[row]
    return total


@kernel
def _spread(m, bearings, column, problem):
    """Into `pivots.made` the forces that one unit of unknown `column` makes by row of G; -1: those that no unknown makes."""
    pivots, sign = problem.pivots, problem.friction_sign
    for row in range(2 * m + bearings):
        pivots.made[row] = pivots.base[row] if column < 0 and row < 2 * m else 0.0
    if 0 <= column < m:
        pivots.made[2 * column] = problem.unit[column]
        pivots.made[2 * column + 1] = -sign[2 * column + 1] * problem.drag[column] * problem.unit[column]
    elif column >= m:
        row = element_row(problem, m, column - m)
        pivots.made[row] = sign[row] * problem.unit[problem.block[column - m]]
    for p in range(bearings):
        row = 2 * m + p
        against = pivots.slides[p] if pivots.slides[p] != 0.0 else sign[row]
        bound = _bound(m, p, 1.0 if column < 0 else 0.0, pivots.made, pivots)
        pivots.made[row] = (pivots.made[row] - against * bound) / (1.0 + against * _along(p, row, pivots))


@kernel
def fill_coupled(G, b, m, sizes, problem):
    """The problem with loads along `pivots.way` into `problem.A` and `problem.rhs`; rows without it into `problem.loaded`.

    `sizes`: (elements, bearings, those of them with an element). `pivots.base`: what contacts bear whatever is found.
    """
    (elements, bearings, bounded), pivots = sizes, problem.pivots
    fill_matrix(G, m, elements, problem)
    _spread(m, bearings, -1, problem)
    for row in range(2 * m + bounded):
        problem.loaded[row] = b[row]
        for p in range(bearings):
            problem.loaded[row] += G[row, 2 * m + p] * pivots.made[2 * m + p]
    for p in range(bounded):
        e = elements - bounded + p
        problem.span[e] = 2.0 * bound_found(m, p, pivots.made, pivots)
    fill_rhs(problem.loaded, m, elements, problem)
    for column in range(m + elements):
        _spread(m, bearings, column, problem)
        for line in range(m + elements):
            e = line - m
            row = 2 * line if e < 0 else element_row(problem, m, e)
            effect = 0.0
            for j in range(2 * m + bearings):
                effect += G[row, j] * pivots.made[j]
            problem.A[line, column] = problem.unit[line if e < 0 else problem.block[e]] * problem.friction_sign[row] * effect
        for p in range(bounded):
            e = elements - bounded + p
            bound = _bound(m, p, 0.0, pivots.made, pivots) + _along(p, 2 * m + p, pivots) * pivots.made[2 * m + p]
            own = 1.0 if column == m + e else 0.0
            problem.A[m + elements + e, column] = 2.0 * bound / problem.unit[m + p] - own


@kernel
def read_coupled(m, sizes, problem, out_force):
    """Forces by row of G, those of all bearings too, from the solution `problem.x`."""
    elements, bearings, _ = sizes
    rows = 2 * m + bearings
    _spread(m, bearings, -1, problem)
    for row in range(rows):
        out_force[row] = problem.pivots.made[row]
    for column in range(m + elements):
        if problem.x[column] != 0.0:
            _spread(m, bearings, column, problem)
            for row in range(rows):
                out_force[row] += problem.x[column] * problem.pivots.made[row]


@kernel
def bound_found(m, p, force, pivots):
    """Friction that bearing p may have under the forces found, by row of G."""
    return _bound(m, p, 1.0, force, pivots) + _along(p, 2 * m + p, pivots) * force[2 * m + p]


@kernel
def turn_to_loads(m, bearings, force, problem):
    """Turn each direction to the load under `force`, by row of G; returns by which share the largest bound changes.

    That of a bearing which holds with less than its friction may change: it is only a bound.
    """
    pivots, worst = problem.pivots, 0.0
    for p in range(bearings):
        x, y = pivots.start[p, 0], pivots.start[p, 1]
        for row in range(2 * m + bearings):
            x += pivots.lean[p, 0, row] * force[row]
            y += pivots.lean[p, 1, row] * force[row]
        load, rubs = math.sqrt(x * x + y * y), abs(force[2 * m + p])
        before = bound_found(m, p, force, pivots)
        after = pivots.fixed[p] + pivots.grip[p] * load
        if pivots.slides[p] != 0.0 or not rubs < (1.0 - LOAD_ROUGH) * min(before, after):
            worst = max(worst, settled_share(after - before, abs(pivots.fixed[p]) + pivots.grip[p] * load))
        turn(p, x, y, pivots)
    return worst


# Where nothing decides: a bearing that stops with the gap has moved all the time, and one that seizes has no approach to stop.


@kernel
def keep_turning(G, rates, m, sizes, problem):
    """Let bearings whose motion is a multiple of a gap rate end the compression still moving a little; True if any does."""
    elements, _, bounded = sizes
    found = False
    for p in range(bounded):
        row, e, parallel = 2 * m + p, elements - bounded + p, False
        for i in range(m):
            parallel = parallel or G[2 * i, row] ** 2 > (1.0 - PARALLEL) * G[2 * i, 2 * i] * G[row, row] > 0.0
        if parallel:
            problem.rhs[m + e] += NUDGE * (problem.friction_sign[row] * rates[row]) * problem.unit[m + p]
            found = True
    return found


@kernel
def approach_seized(G, rates, m, bearings, jam_speed, problem):
    """Let gaps that stand still approach by a little of what the bearings of their bodies do to them; True if any does."""
    found = False
    for i in range(m):
        share = 0.0
        for p in range(bearings):
            row = 2 * m + p
            if G[row, row] > 0.0:
                share += abs(G[2 * i, row] / G[row, row] * rates[row])
        if abs(rates[2 * i]) <= jam_speed < share:
            problem.rhs[i] -= NUDGE * share * problem.unit[i]
            found = True
    return found
