"""What do the three complementarity problems with Coulomb friction have in common?

Their matrix. Every friction force lies in an interval from c - L x_N to c - L x_N + l x_N + l_0, where x_N is the normal
force of its contact: L = mu, l = 2 mu, c = l_0 = 0 for a contact at the acceleration level and in the compression; c = -T,
l_0 = 2 T for a bearing with dry friction T; the laws of the expansion are in expansion_friction.py. With x_+ the distance from
the lower end, the law turns into complementarity with a slip measure (docs/theory/method.md 2.5, 2.6):

    [ y_N ]   [ G_NN - G_NT L   G_NT   0 ] [ x_N  ]
    [ y_+ ] = [ G_TN - G_TT L   G_TT   1 ] [ x_+  ] + b
    [ x_- ]   [ l                -1    0 ] [ y_-  ]

For contacts known to slide L is mu times the direction of slip, and they have no element.
"""

from __future__ import annotations

from watchsim.dynamics.small_systems import unit_scale
from watchsim.jit import kernel


@kernel
def add_element(work, block, element, interval):
    """Element number `element` belongs to `block`; interval: (width, span, shift). Returns the next number."""
    work.block[element] = block
    work.width[element], work.span[element], work.shift[element] = interval
    return element + 1


@kernel
def element_row(work, m, element):
    """Row of G of an element."""
    block = work.block[element]
    return 2 * block + 1 if block < m else m + block


@kernel
def _fill_units(work, m, elements):
    for i in range(m):
        work.unit[i] = unit_scale(max(work.G[2 * i, 2 * i], work.G[2 * i + 1, 2 * i + 1]))
    for e in range(elements):
        block = work.block[e]
        if block >= m:
            work.unit[block] = unit_scale(work.G[m + block, m + block])


@kernel
def fill_matrix(work, m, elements):
    """The matrix above in unit-diagonal scaling, size m + 2 elements; needs G, drag and the elements. Fills `unit` too."""
    n = m + 2 * elements
    for i in range(n):
        for j in range(n):
            work.A[i, j] = 0.0
    _fill_units(work, m, elements)
    for line in range(m + elements):
        e = line - m
        row = 2 * line if e < 0 else element_row(work, m, e)
        unit = work.unit[line if e < 0 else work.block[e]]
        for j in range(m):
            work.A[line, j] = unit * work.unit[j] * (work.G[row, 2 * j] - work.drag[j] * work.G[row, 2 * j + 1])
        for f in range(elements):
            work.A[line, m + f] = unit * work.unit[work.block[f]] * work.G[row, element_row(work, m, f)]
    for e in range(elements):
        work.A[m + e, m + elements + e] = 1.0
        work.A[m + elements + e, m + e] = -1.0
        if work.block[e] < m:
            work.A[m + elements + e, work.block[e]] = work.width[e]
    return n


@kernel
def fill_rhs(work, m, elements, b):
    """Right-hand side from the rows `b`: accelerations or velocities with each force at the constant part of its lower end."""
    for i in range(m):
        work.rhs[i] = work.unit[i] * b[2 * i]
    for e in range(elements):
        unit = work.unit[work.block[e]]
        work.rhs[m + e] = unit * b[element_row(work, m, e)]
        work.rhs[m + elements + e] = work.span[e] / unit


@kernel
def read_forces(work, m, elements, out_force):
    """Forces by row of G from the solution `work.x` of the scaled problem."""
    for i in range(m):
        normal = work.unit[i] * work.x[i]
        out_force[2 * i], out_force[2 * i + 1] = normal, -work.drag[i] * normal
    for e in range(elements):
        block = work.block[e]
        above = work.shift[e] + work.unit[block] * work.x[m + e]
        out_force[element_row(work, m, e)] = above - work.drag[block] * out_force[2 * block] if block < m else above
