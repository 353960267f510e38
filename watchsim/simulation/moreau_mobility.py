"""What do percussions at contacts and in bearings do to velocities, and velocities to the rates there?"""

from __future__ import annotations

from watchsim.jit import kernel


@kernel
def fill_mobility(closed, m, dry, bearings, inverse, out_G):
    """Rates of m contacts (rows N, T by contact) and of bearings (their coordinates) by unit percussions.

    `inverse` is one over each coordinate's mass.
    """
    for row in range(2 * m):
        for column in range(row, 2 * m):
            i, j = row // 2, column // 2
            total = 0.0
            for k in range(closed.slots[i]):
                for q in range(closed.slots[j]):
                    if closed.coord[i, k] == closed.coord[j, q]:
                        left = closed.w_N[i, k] if row % 2 == 0 else closed.w_T[i, k]
                        right = closed.w_N[j, q] if column % 2 == 0 else closed.w_T[j, q]
                        total += left * right * inverse[closed.coord[i, k]]
            out_G[row, column], out_G[column, row] = total, total
    for b in range(bearings):
        row = 2 * m + b
        for column in range(2 * m + bearings):
            out_G[row, column], out_G[column, row] = 0.0, 0.0
        out_G[row, row] = inverse[dry[b]]
        for i in range(m):
            for k in range(closed.slots[i]):
                if closed.coord[i, k] == dry[b]:
                    normal, tangential = inverse[dry[b]] * closed.w_N[i, k], inverse[dry[b]] * closed.w_T[i, k]
                    out_G[row, 2 * i], out_G[2 * i, row] = normal, normal
                    out_G[row, 2 * i + 1], out_G[2 * i + 1, row] = tangential, tangential


@kernel
def rates_of(closed, m, u, out_rates):
    """Rates N, T of the m contacts at velocities u."""
    for i in range(m):
        normal, tangential = 0.0, 0.0
        for k in range(closed.slots[i]):
            normal += closed.w_N[i, k] * u[closed.coord[i, k]]
            tangential += closed.w_T[i, k] * u[closed.coord[i, k]]
        out_rates[2 * i], out_rates[2 * i + 1] = normal, tangential


@kernel
def push(closed, m, dry, bearings, P, inverse, out_u):
    """Add what the percussions P do to the velocities."""
    for i in range(m):
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            out_u[j] += inverse[j] * (closed.w_N[i, k] * P[2 * i] + closed.w_T[i, k] * P[2 * i + 1])
    for b in range(bearings):
        out_u[dry[b]] += inverse[dry[b]] * P[2 * m + b]
