"""Which percussions obey the laws, where relaxation crawls? Newton's method on the same projections.

Who sticks, slips or parts is read from each row's projected improvement; in that mode the laws are linear equations, whose
solution is the next guess (P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92, 1991). Redundant contacts make the
equations singular: what they leave open stays as it was.
"""

from __future__ import annotations

from watchsim.dynamics.small_systems import copy, solve_small
from watchsim.jit import kernel
from watchsim.simulation.moreau.percussion_laws import bounds, improvement, size
from watchsim.tolerances import RANK

MODES = 20  # guesses of who sticks, slips or parts, before relaxation goes on


@kernel
def _equation(laws, m, rows, row):
    """The equation of one row for the change of `laws.trial`, as long as its mode; returns what the row is short of its law."""
    J, G, P = laws.J, laws.G, laws.trial
    own = G[row, row]
    for column in range(rows):
        J[row, column] = 0.0
    if own <= 0.0:
        J[row, row], laws.right[row], laws.scale[row] = 1.0, 0.0, 1.0
        return 0.0
    laws.scale[row] = 1.0 / own**0.5
    wanted = improvement(laws, rows, row, P)
    least, most = bounds(laws, m, row, P)
    if least < wanted < most:
        for column in range(rows):
            J[row, column] = G[row, column]
        laws.right[row] = own * (wanted - P[row])
        return abs(wanted - P[row]) * own**0.5
    end = least if wanted <= least else most
    J[row, row], laws.right[row] = own, own * (end - P[row])
    if row < 2 * m and row % 2 == 1:
        J[row, row - 1] = -own * laws.ends[row // 2, 1 if wanted <= least else 3]
    return abs(end - P[row]) * own**0.5


@kernel
def finish(laws, m, rows, settled):
    """Solve for the mode that `laws.P` suggests, and for those that follow; True, and a new `laws.P`, if they obey the laws.

    They do when their own projected improvements are below the share `settled` of their size.
    """
    copy(laws.P, laws.trial)
    for _ in range(MODES):
        short = 0.0
        for row in range(rows):
            short = max(short, _equation(laws, m, rows, row))
        if short <= settled * size(laws, rows, laws.trial):
            copy(laws.trial, laws.P)
            return True
        solve_small(laws.J, laws.right, rows, laws.scale, laws.order, laws.step, RANK)
        for row in range(rows):
            laws.trial[row] += laws.step[row]
    return False
