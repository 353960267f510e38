"""Which percussions keep the contacts apart and the friction in its cones? Found by relaxation, one contact after another.

Each percussion is the projection of its own improvement onto what it may be: at least `low` along the normal, within the
friction cone along the tangent (the prox form of the laws of Signorini and Coulomb, Gauss-Seidel fashion). It shares no code
with the complementarity solver of `dynamics`, so that the two can be held against each other.
"""

from __future__ import annotations

from watchsim.jit import kernel

SWEEPS = 20000
SETTLED = (
    1e-13  # largest change of a percussion in a sweep, as a share of the first guess or of what would stop the fastest contact
)


@kernel
def fill_mobility(closed, m, inverse, out_G):
    """Rates of the m contacts by unit percussions, rows N, T by contact; `inverse` is one over each coordinate's mass."""
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
def push(closed, m, P, inverse, out_u):
    """Add what the percussions P do to the velocities."""
    for i in range(m):
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            out_u[j] += inverse[j] * (closed.w_N[i, k] * P[2 * i] + closed.w_T[i, k] * P[2 * i + 1])


@kernel
def residual(G, b, low, friction, m, P):
    """How far P is from its own projected improvement, as a share of the largest percussion or of what would stop the rates."""
    worst, scale = 0.0, 0.0
    for row in range(2 * m):
        if G[row, row] <= 0.0:
            continue
        rate = b[row]
        for column in range(2 * m):
            rate += G[row, column] * P[column]
        new = P[row] - rate / G[row, row]
        bound = friction[row // 2] * P[2 * (row // 2)]
        new = max(low[row // 2], new) if row % 2 == 0 else min(bound, max(-bound, new))
        root = G[row, row] ** 0.5
        worst = max(worst, abs(new - P[row]) * root)
        scale = max(scale, abs(P[row]) * root, abs(b[row]) / root)
    return worst / scale if scale > 0.0 else 0.0


@kernel
def relax(G, b, low, friction, m, out_P):
    """Percussions with P_N >= low, P_N - low and the rate complementary, |P_T| <= friction P_N against the slip.

    Rates are b + G P; out_P holds a first guess. Returns the number of sweeps, SWEEPS + 1 if it has not settled.
    """
    scale = 0.0
    for row in range(2 * m):
        if G[row, row] > 0.0:
            scale = max(scale, abs(b[row]) / G[row, row] ** 0.5, abs(out_P[row]) * G[row, row] ** 0.5)
    for sweep in range(1, SWEEPS + 1):
        change = 0.0
        for i in range(m):
            for row in range(2 * i, 2 * i + 2):
                if G[row, row] <= 0.0:
                    continue
                rate = b[row]
                for column in range(2 * m):
                    rate += G[row, column] * out_P[column]
                new = out_P[row] - rate / G[row, row]
                if row == 2 * i:
                    new = max(low[i], new)
                else:
                    bound = friction[i] * out_P[2 * i]
                    new = min(bound, max(-bound, new))
                change = max(change, abs(new - out_P[row]) * G[row, row] ** 0.5)
                out_P[row] = new
        if change <= SETTLED * scale:
            return sweep
    return SWEEPS + 1
