"""Which percussions keep the contacts apart and the friction within its bounds? Found by relaxation, one after another.

Each percussion is the projection of its own improvement onto what it may be: at least `low` along the normal; along the
tangent within ends[i, 0] + ends[i, 1] N and ends[i, 2] + ends[i, 3] N, where N is the normal percussion of its contact; in a
bearing within ends[m + k, 0] and ends[m + k, 2]. This is the prox form of the laws of Signorini and Coulomb, Gauss-Seidel
fashion. It shares no code with the complementarity solver of `dynamics`, so that the two can be held against each other.
"""

from __future__ import annotations

from watchsim.jit import kernel

SWEEPS = 20000  # at each pace
PACES = 4
# Largest change of a percussion in a sweep, as a share of the first guess or of what would stop the fastest contact.
SETTLED = 1e-13


@kernel
def cone(ends, i, friction):
    """Coulomb's law for contact i."""
    ends[i, 0], ends[i, 1], ends[i, 2], ends[i, 3] = 0.0, -friction, 0.0, friction


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


@kernel
def _improved(G, b, low, ends, m, rows, row, P):
    """P[row] changed by what would end its own rate, and put back where it may be."""
    rate = b[row]
    for column in range(rows):
        rate += G[row, column] * P[column]
    new = P[row] - rate / G[row, row]
    if row < 2 * m and row % 2 == 0:
        return max(low[row // 2], new)
    i, normal = row - m, 0.0
    if row < 2 * m:
        i, normal = row // 2, P[row - 1]
    return min(ends[i, 2] + ends[i, 3] * normal, max(ends[i, 0] + ends[i, 1] * normal, new))


@kernel
def residual(G, b, low, ends, m, bearings, P):
    """How far P is from its own projected improvement, as a share of the largest percussion or of what would stop the rates."""
    worst, scale, rows = 0.0, 0.0, 2 * m + bearings
    for row in range(rows):
        if G[row, row] <= 0.0:
            continue
        root = G[row, row] ** 0.5
        worst = max(worst, abs(_improved(G, b, low, ends, m, rows, row, P) - P[row]) * root)
        scale = max(scale, abs(P[row]) * root, abs(b[row]) / root)
    return worst / scale if scale > 0.0 else 0.0


@kernel
def _sweeps(G, b, low, ends, m, rows, pace, settled, out_P):
    """Sweep until no percussion changes by more than `settled`; returns the number of sweeps, SWEEPS + 1 if that fails."""
    for sweep in range(1, SWEEPS + 1):
        change = 0.0
        for row in range(rows):
            if G[row, row] <= 0.0:
                continue
            new = _improved(G, b, low, ends, m, rows, row, out_P)
            change = max(change, abs(new - out_P[row]) * G[row, row] ** 0.5)
            out_P[row] += pace * (new - out_P[row])
        if change <= settled:
            return sweep
    return SWEEPS + 1


@kernel
def relax(G, b, low, ends, m, bearings, out_P):
    """Percussions with P_N >= low, P_N - low and the rate complementary, P_T within its ends and at one of them where it slips.

    Rates are b + G P; out_P holds a first guess. Returns (number of sweeps, have they settled?). Where friction couples
    contacts strongly, full improvements can go round in circles; smaller ones then settle.
    """
    scale, rows, total = 0.0, 2 * m + bearings, 0
    for row in range(rows):
        if G[row, row] > 0.0:
            scale = max(scale, abs(b[row]) / G[row, row] ** 0.5, abs(out_P[row]) * G[row, row] ** 0.5)
    pace = 1.0
    for _ in range(PACES):
        sweeps = _sweeps(G, b, low, ends, m, rows, pace, SETTLED * scale, out_P)
        total += min(sweeps, SWEEPS)
        if sweeps <= SWEEPS:
            return total, True
        pace *= 0.4
    return total, False
