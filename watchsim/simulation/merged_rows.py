"""Where do all systems of a scene stand when one of them has a row?

By the polynomials through their own rows before and after, those of `Trajectory.at`. Apart from systems.py, so that kernels
are compiled anew only where one of them has changed.
"""

from __future__ import annotations

import numpy as np

from watchsim.jit import entry, kernel


@kernel
def _between(s, h, left, right, noise):
    """q, u, a at the fraction s of a stretch of length h, of one coordinate: the polynomials of `Trajectory.at`."""
    (q0, u0, a0), (q1, u1, a1) = left, right
    d, u0, u1, a0, a1 = q1 - q0, h * u0, h * u1, h * h * a0, h * h * a1
    c3 = 10.0 * d - 6.0 * u0 - 4.0 * u1 - 1.5 * a0 + 0.5 * a1
    c4 = -15.0 * d + 8.0 * u0 + 7.0 * u1 + 1.5 * a0 - a1
    c5 = 6.0 * d - 3.0 * (u0 + u1) - 0.5 * (a0 - a1)
    q = q0 + s * (u0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))
    way = u1 - u0
    u = u0 + s * (a0 + s * (3.0 * way - 2.0 * a0 - a1 + s * (a0 + a1 - 2.0 * way)))
    missed = d - 0.5 * (u0 + u1) - (a0 - a1) / 12.0
    if abs(missed) > noise:
        u += 30.0 * missed * (s * (1.0 - s)) ** 2
    a = a0 + s * (6.0 * way - 4.0 * a0 - 2.0 * a1 + s * (3.0 * (a0 + a1) - 6.0 * way))
    return q, u / h, a / (h * h)


@entry
def merge_rows(times, twins, systems, columns, noise, own, out_rows):
    """Write q, u, a of all systems into rows at these times; `twins` counts times that are the same.

    Of system k in row k of `systems`: where its rows begin in `own`, how many there are, where its coordinates begin in
    `columns` and `noise`, how many there are.
    """
    width, at = (out_rows.shape[1] - 1) // 3, np.zeros(len(systems), np.int64)
    for row in range(len(times)):
        t, out_rows[row, 0] = times[row], times[row]
        for k in range(len(systems)):
            begin, count, first, n = systems[k]
            long, j = 1 + 3 * n, at[k]
            while j < count - 1 and own[begin + j * long] < t:
                j += 1
            at[k] = j
            for _ in range(twins[row]):
                if j < count - 1 and own[begin + (j + 1) * long] == t:
                    j += 1
            here = begin + j * long
            before = here - long if j > 0 and own[here] > t else here
            h = own[here] - own[before]
            for i in range(n):
                q, u, a = 1 + i, 1 + n + i, 1 + 2 * n + i
                found = own[here + q], own[here + u], own[here + a]
                if h > 0.0:
                    left = own[before + q], own[before + u], own[before + a]
                    found = _between((t - own[before]) / h, h, left, found, noise[first + i])
                to = 1 + columns[first + i]
                out_rows[row, to], out_rows[row, to + width], out_rows[row, to + 2 * width] = found
