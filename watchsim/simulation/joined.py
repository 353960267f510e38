"""How do two parts of one motion become one trajectory?"""

from __future__ import annotations

import dataclasses

import numpy as np

from watchsim.simulation.trajectory import Trajectory


def joined(first: Trajectory, rest: Trajectory) -> Trajectory:
    """`first` up to its saved state and `rest`, which went on from there.

    What `first` holds beyond that state is the step its end cut short; `rest` holds the same stretch in whole steps.
    Sums and counts run through the saved state, so those of `rest` are those of both. Times on the clock add up.
    """
    saved, later = first.end_state, rest.end_state
    if saved is None:
        raise ValueError("the first part carries no end state")
    if later is not None:
        later = dataclasses.replace(later, rows=saved.rows + later.rows, events=saved.events + later.events)
    cut = saved.rows
    return dataclasses.replace(
        rest,
        t=np.concatenate([first.t[:cut], rest.t]),
        q=np.concatenate([first.q[:cut], rest.q]),
        u=np.concatenate([first.u[:cut], rest.u]),
        a=np.concatenate([first.a[:cut], rest.a]),
        events=np.concatenate([first.events[: saved.events], rest.events]),
        wall=first.wall + rest.wall,
        compile=first.compile + rest.compile,
        end_state=later,
    )
