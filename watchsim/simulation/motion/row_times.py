"""Which rows does a coupled step need, so that the motion within it can be interpolated from them?

Between rows the motion is taken for polynomials through q, u and a at both ends (see `Trajectory.sample`). Where these stray
from the step's continuous extension by more than the tolerance, rows are put between, as many as it takes: the error of
positions goes with the 6th power of the distance of rows, that of velocities with the 4th.
"""

from __future__ import annotations

import math

from watchsim.jit import kernel
from watchsim.simulation.motion.dense_output import dense, dense_value
from watchsim.simulation.record.write_buffers import is_kept

MOST_ROWS = 64


@kernel
def _pieces(model, options, end, step):
    """Into how many equal parts the step's first `end` seconds must be cut."""
    n = len(model.coordinates)
    most = 1.0
    for i in range(n):
        q0, u0, a0 = step.q[i], end * step.u[i], end * end * step.stages[0, n + i]
        speed, rate = dense(step, n + i, end)
        q1, u1, a1 = dense_value(step, i, end), end * speed, end * end * rate
        q = 0.5 * (q0 + q1) + 0.15625 * (u0 - u1) + 0.015625 * (a0 + a1)
        u = (0.5 * (u0 + u1) + 0.125 * (a0 - a1)) / end
        middle = dense_value(step, n + i, 0.5 * end)
        coordinate = model.coordinates[i]
        strays = abs(q - dense_value(step, i, 0.5 * end)) / (options.tolerance * coordinate.scale)
        off = abs(u - middle) / (options.tolerance * max(coordinate.scale * coordinate.rate, abs(middle)))
        most = max(most, strays ** (1.0 / 6.0), off**0.25)
    return int(min(math.ceil(most), MOST_ROWS))


@kernel
def keep_inner_rows(model, options, end, step, record):
    """Append the rows needed within the first `end` seconds of the coupled step just made, but not the one at their end."""
    if end <= 0.0 or not is_kept(record, step.span.start, end):
        return
    n = len(model.coordinates)
    pieces = _pieces(model, options, end, step)
    for piece in range(1, pieces):
        tau = end * piece / pieces
        if not is_kept(record, step.span.start + tau, 0.0):
            continue
        row = record.used.rows
        record.rows[row, 0] = step.span.start + tau
        for i in range(2 * n):
            record.rows[row, 1 + i] = dense_value(step, i, tau)
        for i in range(n):
            record.rows[row, 1 + 2 * n + i] = dense(step, n + i, tau)[1]
        record.used.rows = row + 1
