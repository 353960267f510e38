"""Which complementarity problems does a run solve, and what does one of each size take?

They are posed anew at the events of a walk: those of the compression and the expansion at impacts, and of the modes afterwards.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.bench.profile.repeated_work import COMPRESSION, EXPANSION, MODES, pose, problems_again
from watchsim.bench.profile.sampled_moments import Kind, Walk, seconds_each
from watchsim.dynamics.delassus import LARGEST
from watchsim.dynamics.lcp.lemke_pivoting import lcp_work

POSED = {Kind.IMPACT: (COMPRESSION, EXPANSION, MODES), Kind.CHANGE: (MODES,)}
REPEATS = 50

Array = NDArray[np.float64]
Problem = tuple[Array, Array]  # A, b


def problem_costs(walk: Walk) -> dict[str, float]:
    """Seconds for one problem of each size (`lcp_to_1`, ...) that the walk has met."""
    seconds: dict[str, list[float]] = {}
    for A, b in problems_met(walk):
        n = len(b)
        taken = seconds_each(problems_again, (A, b, n, lcp_work(n), np.zeros(n)), REPEATS)
        seconds.setdefault(size_name(n), []).append(taken)
    return {name: float(np.mean(found)) for name, found in seconds.items()}


def problems_met(walk: Walk) -> list[Problem]:
    """The problems at the events of a walk."""
    run, found = walk.run, []
    loop = run.compiled.model, run.finder.cells, run.state, run.options, run.scratch, walk.room
    for kind, posed in POSED.items():
        for moment in walk.moments[kind]:
            for which in posed:
                walk.at(moment)
                if n := pose(*loop, which):
                    found.append((run.scratch.work.A[:n, :n].copy(), run.scratch.work.rhs[:n].copy()))
    return found


def size_name(unknowns: int) -> str:
    """The name of the count of problems with that many unknowns."""
    return next((f"lcp_to_{size}" for size in LARGEST if unknowns <= size), "lcp_larger")
