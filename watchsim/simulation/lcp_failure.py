"""What is known about a complementarity problem that nothing solved?

All that is needed to look at it elsewhere: the matrices, the contacts in words, and the state it arose in.
"""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from typing import Any

import numpy as np

from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.problem_kinds import Level
from watchsim.simulation.loop_state.scratch import Scratch
from watchsim.simulation.loop_state.state import State
from watchsim.simulation.record.contact_names import Pair

LEMKE_ENDS = {
    LcpOutcome.SOLVED: "a solution",
    LcpOutcome.RAY: "ray",
    LcpOutcome.TOO_MANY_PIVOTS: "too many pivots",
    LcpOutcome.INEXACT: "not a solution",
}
ADVICE = (
    "Less friction at the contacts named here: near mu |b| = |a| of a rotor's lever arms bodies jam.",
    "Restitution 0 at these contacts: then only the compression must be solved.",
    "A tighter tolerance, or a start a little away from this position.",
)
JAM = (
    "This is a jam: a driven body goes on whatever is in its way. See it with watchsim movie RUN --contacts. Let the other be "
    "out of the way by then, make room in the drawing, or drive by a torque instead"
)


def failure_of(state: State, scratch: Scratch, pairs: Sequence[Pair]) -> dict[str, Any]:
    """The last problem posed, as plain values. Units SI.

    level       of the problem: acceleration, compression or expansion
    contacts    bodies and primitives in words with contact number, mode, gap rate and slip; two rows of G each, N then T
    G, b        Delassus matrix and the accelerations or velocities of its rows without contact forces
    reversed    rows of G and b that A and rhs have with the opposite sign (dynamics/handedness.py)
    A, rhs      of y = A x + rhs in the scaling of dynamics/coulomb.py
    """
    work = scratch.work
    m, elements, bearings = int(work.posed.contacts), int(work.posed.elements), int(work.posed.bearings)
    level = Level(int(work.posed.level))
    closed = scratch.event.rest if level == Level.ACCELERATION else scratch.event.closed
    rows, n = 2 * m + bearings, m + 2 * elements
    return {
        "level": level.name.lower(),
        "lemke_ended_with": LEMKE_ENDS[LcpOutcome(int(work.posed.lemke))],
        "what_to_try": list(ADVICE),
        "t": float(state.clock.time),
        "q": state.q.tolist(),
        "u": state.u.tolist(),
        "contacts": [_contact(int(k), closed.kin[row], state, pairs) for row, k in enumerate(closed.ids[:m])],
        "bearings": work.dry[:bearings].tolist(),
        "G": work.G[:rows, :rows].tolist(),
        "b": work.b[:rows].tolist(),
        "reversed": np.flatnonzero(work.hand[:rows] < 0.0).tolist(),
        "A": work.A[:n, :n].tolist(),
        "rhs": work.rhs[:n].tolist(),
    }


def driven_into(failure: Mapping[str, Any] | None, pairs: Sequence[Pair], driven: Container[str]) -> str:
    """Which driven body jams which other, and what to change; "" where none takes part in the failed problem."""
    found: dict[str, None] = {}  # each sentence once, in order
    for contact in failure["contacts"] if failure else ():
        pair = pairs[contact["number"]]
        for own, other in ((pair.body_a, pair.body_b), (pair.body_b, pair.body_a)):
            if own in driven:
                found[f"{own}, which is driven, leaves {other} no way out at {pair}"] = None
    return f"{'; '.join(found)}. {JAM}" if found else ""


def _contact(k: int, kinematics: Any, state: State, pairs: Sequence[Pair]) -> dict[str, Any]:
    return {
        "number": k,
        "between": str(pairs[k]),
        "mode": int(state.mode[k]),
        "gap_m": float(kinematics.g),
        "gap_rate_m_per_s": float(kinematics.gN_dot),
        "slip_m_per_s": float(kinematics.gT_dot),
    }
