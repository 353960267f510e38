"""What do the three complementarity problems with Coulomb friction have in common?

Their matrix. With F = F_T + mu F_N the friction law turns into complementarity of F with a slip measure, so that for the
acceleration level, for compression and for expansion alike (docs/method.md 2.5, 2.6)

    [ y_N ]   [ G_NN - G_NT d   G_NT   0 ] [ x_N  ]
    [ y_+ ] = [ G_TN - G_TT d   G_TT   1 ] [ x_+  ] + b
    [ x_- ]   [ 2 mu             -1    0 ] [ y_-  ]

where d = mu for contacts with tangential unknowns and mu times the direction of slip for those known to slide.
"""

from __future__ import annotations

from watchsim.jit import kernel


@kernel
def fill_matrix(work, m, tangents):
    """The matrix above in unit-diagonal scaling, size m + 2 tangents; needs G, drag, tangent. Fills `work.unit` too."""
    n = m + 2 * tangents
    for i in range(n):
        for j in range(n):
            work.A[i, j] = 0.0
    for i in range(m):
        largest = max(work.G[2 * i, 2 * i], work.G[2 * i + 1, 2 * i + 1])
        work.unit[i] = 1.0 / largest**0.5 if largest > 0.0 else 1.0
    for i in range(m):
        ti = work.tangent[i]
        for j in range(m):
            scale = work.unit[i] * work.unit[j]
            tj = work.tangent[j]
            work.A[i, j] = scale * (work.G[2 * i, 2 * j] - work.drag[j] * work.G[2 * i, 2 * j + 1])
            if tj >= 0:
                work.A[i, m + tj] = scale * work.G[2 * i, 2 * j + 1]
            if ti >= 0:
                work.A[m + ti, j] = scale * (work.G[2 * i + 1, 2 * j] - work.drag[j] * work.G[2 * i + 1, 2 * j + 1])
                if tj >= 0:
                    work.A[m + ti, m + tj] = scale * work.G[2 * i + 1, 2 * j + 1]
        if ti >= 0:
            work.A[m + ti, m + tangents + ti] = 1.0
            work.A[m + tangents + ti, i] = 2.0 * work.drag[i]
            work.A[m + tangents + ti, m + ti] = -1.0
    return n


@kernel
def fill_rhs(work, m, tangents, b):
    """Right-hand side from the N, T rows `b` (accelerations or velocities) in the same scaling; last block 0."""
    for i in range(m):
        work.rhs[i] = work.unit[i] * b[2 * i]
        t = work.tangent[i]
        if t >= 0:
            work.rhs[m + t] = work.unit[i] * b[2 * i + 1]
            work.rhs[m + tangents + t] = 0.0


@kernel
def read_forces(work, m, out_force):
    """Forces N, T from the solution `work.x` of the scaled problem."""
    for i in range(m):
        normal = work.unit[i] * work.x[i]
        t = work.tangent[i]
        out_force[2 * i] = normal
        out_force[2 * i + 1] = work.unit[i] * work.x[m + t] - work.drag[i] * normal if t >= 0 else -work.drag[i] * normal
