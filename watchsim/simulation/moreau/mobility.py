"""What do percussions at contacts and in bearings do to velocities, and velocities to the rates there?

Rows as in `percussion_laws`: N, T of each of m closed contacts, then the bearings with dry friction.
"""

from __future__ import annotations

from watchsim.dynamics.delassus import apply, contact_velocities
from watchsim.jit import kernel


@kernel
def rates_of(work, m, bearings, u, out_rates):
    """Rates at velocities u."""
    contact_velocities(work.closed, m, u, out_rates)
    for k in range(bearings):
        out_rates[2 * m + k] = u[work.dry[k]]


@kernel
def push(work, m, bearings, P, out_u):
    """Add what the percussions P do to the velocities; `work.inverse` is one over each coordinate's mass."""
    apply(work.closed, m, P, work.inverse, out_u)
    for k in range(bearings):
        out_u[work.dry[k]] += work.inverse[work.dry[k]] * P[2 * m + k]


@kernel
def fill_mobility(work, m, bearings):
    """G of `work.laws`: the rates that unit percussions make, one after another."""
    laws, rows = work.laws, 2 * m + bearings
    laws.trial[:] = 0.0
    for column in range(rows):
        laws.trial[column] = 1.0
        work.change[:] = 0.0
        push(work, m, bearings, laws.trial, work.change)
        rates_of(work, m, bearings, work.change, laws.step)
        for row in range(rows):
            laws.G[row, column] = laws.step[row]
        laws.trial[column] = 0.0
